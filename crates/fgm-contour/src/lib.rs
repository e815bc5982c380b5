//! Contours.

mod cases;
mod contact;
mod contour;
mod error;
mod graph;
mod grid;
mod lattice;
mod lines;
mod march;
mod mesh;
mod nest;
mod options;
mod place;
mod probe;
mod prune;
mod refine;
mod root;
mod simplify;
mod sweep;

pub use contour::{Contourer, LevelLines, isolines, outline};
pub use error::ContourError;
pub use grid::Grid;
pub use mesh::{DEFAULT_GAP, Issue, MeshIssues, MeshSlicer, Section, SectionWarning};
pub use nest::nest;
pub use options::{ContourOptions, MAX_CELLS_A_SIDE, MAX_CROSSINGS, MAX_LEVELS, MAX_TRIANGLES};
pub use simplify::{simplify_line, simplify_polygons, simplify_ring};
