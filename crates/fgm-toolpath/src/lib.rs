//! Toolpaths for graded parts: walls, skins, infill, sectioning by colour, zippers, fills against the gradient, purge towers, ordering.

mod path;

pub use path::{Path, Piece};
