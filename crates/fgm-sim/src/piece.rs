use fgm_core::{Mixture, Point3, Role};

/// A straight piece of a bead as it is laid down.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Piece {
    /// The line of the file, from 1.
    pub line: u64,
    /// From 0; none before the first layer.
    pub layer: Option<u32>,
    /// Where it begins: on the bed, at the bead's top, mm.
    pub from: Point3,
    /// Where it ends, mm; the same where filament is pushed out in place.
    pub to: Point3,
    /// Volume laid down, mm³: foam counts as it lies there.
    pub volume: f64,
    /// Filament fed for it, mm³.
    pub fed: f64,
    /// Thickness, mm.
    pub height: f64,
    /// Width, mm.
    pub width: f64,
    /// What it is for; none where no tag says so.
    pub role: Option<Role>,
    /// The head, from 0.
    pub head: u16,
    /// The mixture that is commanded while it is laid down.
    pub commanded: Mixture,
    /// The mixture laid down where it begins and where it ends; it changes evenly between.
    pub deposited: [Mixture; 2],
    /// Temperature of what is laid down, °C, for a foaming filament.
    pub celsius: Option<f64>,
}

impl Piece {
    /// Length, mm; 0 in place.
    pub fn length(&self) -> f64 {
        self.from.distance(self.to)
    }

    /// Whether it belongs to the part: laid along a line, in a layer, and for nothing else.
    pub fn is_part(&self) -> bool {
        self.layer.is_some() && self.from != self.to && self.role.is_none_or(Role::is_part)
    }

    /// The place at a share of its length, 0 to 1.
    pub fn at(&self, share: f64) -> Point3 {
        self.from + (self.to - self.from) * share
    }

    /// The mixture laid down at a share of its length, 0 to 1.
    pub fn mixture_at(&self, share: f64) -> Mixture {
        let [a, b] = &self.deposited;
        if a == b {
            return *a;
        }
        let mut weights = [0.0; fgm_core::MAX_MATERIALS];
        for ((weight, a), b) in weights.iter_mut().zip(a.fractions()).zip(b.fractions()) {
            *weight = a + (b - a) * share;
        }
        Mixture::from_weights(&weights[..a.materials()]).unwrap_or(*a)
    }
}
