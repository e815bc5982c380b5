//! Palettes: mixture space divided into colours, with print orders of least change and zipper
//! overlaps.
//!
//! A graded part is printed in a number of discrete states: mixing ratios, toolheads, nozzle
//! temperatures. A [`Palette`] says which mixtures each of these *colours* stands for, what its
//! state is, at which mixtures a layer has to be cut into regions, and in what order a layer's
//! colours are printed.
//!
//! # The cast
//!
//! | item | what it is |
//! |---|---|
//! | [`Palette::new`] | equal parts: an interval of the gradient each for two materials, the cells between the planes `f_i = j / k` for more |
//! | [`Palette::pure`] | one colour a material, unmixed; the greatest fraction wins |
//! | [`Palette::with_overlap`] | a zipper: near a boundary, paths alternate between two colours |
//! | [`Palette::band`] | mixture to colour, or to the two colours of an overlap |
//! | [`Palette::band_within`] | the same where the overlap differs from place to place |
//! | [`Palette::boundaries`], [`Palette::levels`] | where the band changes: what to contour |
//! | [`Palette::order`], [`Palette::order_of`] | the print order of a layer, with all colours or those that occur |
//! | [`PaletteError`] | what cannot be, with the limit |
//!
//! The divisions and orders are those of the gradient-slicing paper (two materials: its section on
//! palettes; three: its figure 12), continued to more materials.
//!
//! # Example
//!
//! ```
//! use fgm_core::{Band, ColorId, Mixture};
//! use fgm_palette::Palette;
//!
//! let palette = Palette::new(2, 4)?;
//! assert_eq!(palette.levels(0), [0.25, 0.5, 0.75]);
//! assert_eq!(palette.state(ColorId(3)).fractions(), [0.875, 0.125]);
//! assert_eq!(palette.band(&Mixture::from_weights(&[0.3, 0.7])?), Band::pure(ColorId(1)));
//! assert_eq!(palette.order(1), [3, 2, 1, 0].map(ColorId));
//!
//! // Ten colours of three materials there are not; nine and sixteen there are.
//! assert!(Palette::new(3, 10).is_err());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod cells;
mod error;
mod palette;
mod path;
mod tour;

pub use error::PaletteError;
pub use palette::{Boundary, MAX_COLORS, Measure, Palette};
