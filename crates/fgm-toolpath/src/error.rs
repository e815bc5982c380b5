use crate::Side;

/// What went wrong in planning toolpaths.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ToolpathError {
    /// A fill that does not exist.
    #[error("no fill `{name}`: concentric or rectilinear")]
    UnknownFill {
        /// What was asked for.
        name: String,
    },
    /// An infill pattern that does not exist.
    #[error(
        "no infill pattern `{name}`: rectilinear, aligned, grid, triangles, honeycomb, concentric or gyroid"
    )]
    UnknownPattern {
        /// What was asked for.
        name: String,
    },
    /// A density is not a number somewhere.
    #[error("the density of the infill is not a number at ({x:.4}, {y:.4}, {z:.4})")]
    Density {
        /// Where, mm.
        x: f64,
        /// Where, mm.
        y: f64,
        /// Where, mm.
        z: f64,
    },
    /// A layer has a number that is not one.
    #[error("layer {layer}: a {what} of piece {piece} is not finite")]
    NotFinite {
        /// The layer, from 0.
        layer: u32,
        /// The piece in printing order, from 0.
        piece: usize,
        /// Which of its numbers.
        what: &'static str,
    },
    /// An option of the purge towers is out of range.
    #[error("the {setting} of the purge towers is {value}; it has to be {least}")]
    BadTower {
        /// Which option.
        setting: &'static str,
        /// What it is.
        value: f64,
        /// The limit.
        least: &'static str,
    },
    /// Bounds are empty or not finite.
    #[error("the bounds of the {what} are empty or not finite")]
    BadBounds {
        /// Of what.
        what: &'static str,
    },
    /// The purge towers do not fit beside the part.
    #[error(
        "no room for {} of {spot:.1} x {spot:.1} mm: {fit} fit beside the part; {missing:.1} mm \
         more are needed on its {side}. Move or shrink the part, use fewer colours or a smaller \
         purge volume, or switch the purge off",
        towers(*colors)
    )]
    NoRoomForTowers {
        /// How many are needed.
        colors: usize,
        /// The most that fit.
        fit: usize,
        /// Side of a square one, mm.
        spot: f64,
        /// The least that would have to be added on one side of the part, mm.
        missing: f64,
        /// That side.
        side: Side,
    },
}

fn towers(count: usize) -> String {
    if count == 1 { "a purge tower".to_owned() } else { format!("{count} purge towers") }
}
