//! Toolpaths for graded parts: walls, skins, infill, sectioning by colour, zippers, fills against the gradient, purge towers, ordering.

mod path;
mod section;
mod section_runs;
mod zipper;

pub use path::{Path, Piece};
pub use section::{SectionOptions, section};
