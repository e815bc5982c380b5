use crate::{ColorId, Point2, Role};

/// One step of a print, in the order of printing. Positions are in the design's coordinates.
///
/// A print is a stream of these, layer after layer; nothing in it depends on a machine.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Motion {
    /// A new layer begins.
    Layer {
        /// From 0.
        index: u32,
        /// Height of the beads' tops, mm.
        z: f64,
        /// Thickness, mm.
        height: f64,
    },
    /// The beads of this layer rise: from one height to the layer's own, evenly along this length
    /// of them, and stay there. Their thickness is the layer's all the way. It comes after
    /// [`Motion::Layer`], before any bead.
    Rise {
        /// Height of the beads' tops where the first one begins, mm.
        from: f64,
        /// Length of the beads over which they rise, in the plane, mm.
        length: f64,
    },
    /// From here on the deposit is to have this colour.
    Color(ColorId),
    /// From here on the machine is told to make this colour. Written ahead of [`Motion::Color`]
    /// by the volume that lies between the mixing and the nozzle's tip.
    Command(ColorId),
    /// A move without extrusion.
    Travel {
        /// Where to, mm.
        to: Point2,
    },
    /// A straight bead.
    Extrude {
        /// Where to, mm.
        to: Point2,
        /// Width of the bead, mm.
        width: f64,
        /// What the bead is for.
        role: Role,
    },
}
