//! Contours of planar fields, arrays and triangle meshes: rings, polylines and filled bands, on the
//! true curve, with sharp corners.
//!
//! # Do I need this?
//!
//! For the outline of an implicit shape at one height, the lines along which a material's share
//! has given values, or a plane section of a mesh: yes. It needs no more than a closure. For
//! noding lines into faces see `fgm-arrange`.
//!
//! # The cast
//!
//! | for | use |
//! |---|---|
//! | the region where a field is negative | [`outline`] |
//! | the lines at given levels of a field | [`isolines`], [`LevelLines`] |
//! | the regions between levels | [`isobands`], [`Band`] |
//! | those lines closed along the window's edge | [`Contourer::below`] |
//! | all of these layer after layer | [`Contourer`], which keeps its memory |
//! | all of these for rows of samples and masks | [`Grid`], [`Sample`] |
//! | grid after grid, or without a copy | [`GridContourer`], [`LineRef`] |
//! | plane sections of a mesh | [`MeshSlicer`], [`Section`], [`MeshIssues`] |
//! | rings to polygons | [`nest`] |
//! | fewer vertices | [`simplify_ring`], [`simplify_line`], [`simplify_polygons`] |
//! | how finely | [`ContourOptions`] |
//! | what can go wrong | [`ContourError`], [`SectionWarning`] |
//!
//! # Conventions
//!
//! Millimetres. A value at the level counts as above it. Lower values lie on the left of the
//! direction of travel, so that a region's outer rings run anticlockwise and its holes clockwise.
//!
//! # Example
//!
//! ```
//! use fgm_contour::{ContourOptions, outline};
//! use fgm_core::{Bounds2, Point2};
//!
//! // A ring of 10 mm outer and 6 mm inner radius.
//! let ring = |p: Point2| (p.length() - 8.0).abs() - 2.0;
//! let window = Bounds2::new(Point2::splat(-11.0), Point2::splat(11.0));
//! let region = outline(&ring, &window, &ContourOptions::default())?;
//! assert_eq!((region.len(), region[0].holes.len()), (1, 1));
//! let exact = std::f64::consts::PI * (100.0 - 36.0);
//! assert!((region[0].area() / exact - 1.0).abs() < 2e-3);
//! # Ok::<(), fgm_contour::ContourError>(())
//! ```
//!
//! # How it works
//!
//! With fields:
//!
//! 1. A quadtree over the window drops the blocks that the field's bounds rule out (`prune`).
//! 2. The rest is sampled band by band, each lattice point once (`sweep`), and marched through at
//!    all levels in one visit to each cell, saddles by the asymptotic decider (`march`, `cases`).
//!    A crossing is known by its lattice edge: rows hand their upper edges on to the next, so that
//!    stitching is following links (`graph`).
//! 3. All crossings are put on the curve by bracketed searches that share batched evaluations
//!    (`place`, `root`).
//! 4. Where the line turns enough for the curve to be off a chord, vertices on the curve and
//!    corners are added (`refine`, `probe`). What leaves its cell is checked against all other
//!    segments (`contact`) and taken back where it would touch one.
//! 5. Vertices within the tolerance go, again checked (`simplify`).
//!
//! With grids:
//!
//! 1. Rows are classified sixteen samples at a time by how many levels they are at or above; where
//!    all are in one class nothing more is looked at (`grid/classes`).
//! 2. The other cells are visited once for all levels between their corners (`grid/sweep`).
//!    Crossings join strands, of which few grow at a time (`grid/strands`), and strands lines.
//!
//! Bands go along lines and border from one to the other, so that neighbours share their lines to
//! the last bit (`bands`). In grids without holes, what is around a ring is known from the
//! crossing to the left of its first one, and no point is looked for in polygons.

mod bands;
mod cases;
mod contact;
mod contour;
mod crossings;
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
mod rim;
mod root;
mod simplify;
mod sweep;

pub use bands::Band;
pub use contour::{Contourer, LevelLines, isobands, isolines, outline};
pub use crossings::{Crossing, Crossings};
pub use error::ContourError;
pub use grid::{Grid, GridContourer, LineRef, Sample};
pub use mesh::{DEFAULT_GAP, Issue, MeshIssues, MeshSlicer, Section, SectionWarning};
pub use nest::nest;
pub use options::{ContourOptions, MAX_CELLS_A_SIDE, MAX_CROSSINGS, MAX_LEVELS, MAX_TRIANGLES};
pub use simplify::{simplify_line, simplify_polygons, simplify_ring};

/// The README's example is run with the tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
