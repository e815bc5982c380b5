use fgm_core::{Mixture, Point3, Role};

/// What a line of G-code makes the machine do, as far as the deposit depends on it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Event {
    /// A layer begins.
    Layer(Layer),
    /// Filament is pushed out, along a straight line or in place.
    Bead(Bead),
    /// A move without extrusion, retracting ones included.
    Travel(Travel),
    /// The machine stands still, or moves its filament only.
    Pause {
        /// How long, at the commanded speed, s.
        seconds: f64,
        /// How far the filament moves meanwhile, mm: negative where it is pulled back.
        filament: f64,
    },
    /// A nozzle has another temperature to reach.
    Heat(Heat),
}

/// A layer, as tags name it or as a greater height of beads shows it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Layer {
    /// From 0.
    pub index: u32,
    /// Height of the beads' tops over the bed where the tags tell it, mm.
    pub z: Option<f64>,
    /// Thickness where the tags tell it, mm.
    pub height: Option<f64>,
}

/// A straight bead as commanded. Positions are the nozzle's on the bed, at the top of the bead.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bead {
    /// The line of the file, from 1.
    pub line: u64,
    /// From 0; none before the first layer.
    pub layer: Option<u32>,
    /// Where it begins, mm.
    pub from: Point3,
    /// Where it ends, mm; the same where filament is pushed out in place.
    pub to: Point3,
    /// Filament fed, mm³.
    pub fed: f64,
    /// Thickness, mm: as tagged, else the layer's, else what the height over the layer below
    /// tells.
    pub height: f64,
    /// Width, mm: as tagged, else that of the capsule of the fed volume.
    pub width: f64,
    /// What it is for; none where no tag says so.
    pub role: Option<Role>,
    /// The head, from 0.
    pub head: u16,
    /// The mixture that the machine is told.
    pub mixture: Mixture,
    /// The temperature that the nozzle is told, °C; none before the first command.
    pub celsius: Option<f64>,
    /// How long it takes at the commanded speed, s.
    pub seconds: f64,
}

impl Bead {
    /// Length, mm; 0 in place.
    pub fn length(&self) -> f64 {
        self.from.distance(self.to)
    }

    /// Whether it belongs to the part: laid along a line, in a layer, and for nothing else.
    pub fn is_part(&self) -> bool {
        self.layer.is_some() && self.from != self.to && self.role.is_none_or(Role::is_part)
    }
}

/// A move without extrusion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Travel {
    /// The line of the file, from 1.
    pub line: u64,
    /// Where it begins, mm; the last known place after a change of heads.
    pub from: Point3,
    /// Where it ends, mm.
    pub to: Point3,
    /// Whether it is known where it begins.
    pub known: bool,
    /// How long it takes at the commanded speed, s.
    pub seconds: f64,
}

impl Travel {
    /// Length in the plane, mm; 0 where it is not known where it begins.
    pub fn length(&self) -> f64 {
        if self.known { self.from.truncate().distance(self.to.truncate()) } else { 0.0 }
    }
}

/// Another temperature for a nozzle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Heat {
    /// The head, from 0.
    pub head: u16,
    /// °C.
    pub celsius: f64,
    /// Whether the machine waits until it is reached.
    pub wait: bool,
}
