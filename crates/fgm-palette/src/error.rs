use fgm_core::{MAX_MATERIALS, MixtureError};

use crate::MAX_COLORS;

/// Why a palette cannot be.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PaletteError {
    /// A palette mixes 2 to [`MAX_MATERIALS`] materials.
    #[error("a palette of {count} materials, where 2 to {MAX_MATERIALS} are possible")]
    Materials {
        /// How many were asked for.
        count: usize,
    },
    /// A palette has 1 to [`MAX_COLORS`] colours.
    #[error("a palette of {colors} colours, where 1 to {MAX_COLORS} are possible")]
    Colors {
        /// How many were asked for.
        colors: usize,
    },
    /// Three or more materials divide into certain numbers of colours only.
    #[error(
        "{materials} materials do not divide into {colors} equal colours; the nearest numbers are \
         {below}{}", above.map(|n| format!(" and {n}")).unwrap_or_default()
    )]
    Division {
        /// How many materials there are.
        materials: usize,
        /// How many colours were asked for.
        colors: usize,
        /// The nearest smaller number that is possible.
        below: usize,
        /// The nearest greater one, if it is within [`MAX_COLORS`].
        above: Option<usize>,
    },
    /// A zipper's overlap has to be narrower than a colour's band.
    #[error(
        "a zipper overlap of {overlap:.4} of the gradient, where it has to be at least 0 and below \
         {limit}, the width of a colour"
    )]
    Overlap {
        /// What was asked for.
        overlap: f64,
        /// The width of a band.
        limit: f64,
    },
    /// A state is not a mixture.
    #[error("a colour's state is not a mixture")]
    State(#[from] MixtureError),
}
