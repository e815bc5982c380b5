//! The words that the `fgm` crates share, and the traits at the seams between them.
//!
//! Little here computes anything worth naming: the crates that do (`fgm-field`, `fgm-contour`,
//! `fgm-arrange`, `fgm-palette`, `fgm-toolpath`, `fgm-gcode`) depend on this one and not on each
//! other, so that each can be used alone and each can be swapped.
//!
//! # The cast
//!
//! | group | items |
//! |---|---|
//! | space | [`Point2`], [`Point3`], [`Bounds2`], [`Bounds3`], [`Interval`] |
//! | shapes | [`Ring`], [`Polyline`], [`Polygon`], [`TriangleMesh`], [`long_chords`] |
//! | material | [`Mixture`], [`ColorId`], [`Band`] |
//! | printing | [`Role`], [`Motion`], [`Climb`], [`bead`] |
//! | seams | [`Field`], [`PlanarField`], [`MaterialField`], [`Sectioner`] |
//!
//! # Conventions
//!
//! Millimetres, seconds, radians, cubic millimetres; `f64` everywhere. Distances are negative
//! inside. Outer rings run anticlockwise, holes clockwise, seen from +z.
//!
//! # Example
//!
//! Any closure-like type becomes a field with one method; everything else has defaults:
//!
//! ```
//! use fgm_core::{Field, PlanarField, Point2, Point3};
//!
//! struct Ball;
//! impl Field for Ball {
//!     fn eval(&self, p: Point3) -> f64 {
//!         p.length() - 10.0
//!     }
//! }
//!
//! let layer = Ball.at_z(6.0);
//! assert_eq!(layer.eval(Point2::new(8.0, 0.0)), 0.0);
//! ```

pub mod bead;
mod bounds;
mod chord;
mod climb;
mod color;
mod field;
mod interval;
mod mesh;
mod mixture;
mod motion;
mod polygon;
mod role;
mod section;

pub use bounds::{Bounds2, Bounds3};
pub use chord::long_chords;
pub use climb::Climb;
pub use color::{Band, ColorId};
pub use field::{Field, MaterialError, MaterialField, PlanarField, Slice};
pub use interval::Interval;
pub use mesh::TriangleMesh;
pub use mixture::{MAX_MATERIALS, Mixture, MixtureError};
pub use motion::Motion;
pub use polygon::{Polygon, Polyline, Ring};
pub use role::Role;
pub use section::{Sectioner, Span, point_at, slice_path};

/// A point or vector in the plane of a layer, mm.
pub type Point2 = glam::DVec2;
/// A point or vector in space, mm; z is up.
pub type Point3 = glam::DVec3;

/// The README's example runs as a test.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
