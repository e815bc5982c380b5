//! Graded designs from files: `.vcad`, STL, OBJ and 3MF to a signed distance and volume fractions.
//!
//! # The cast
//!
//! | item | what it is for |
//! |---|---|
//! | [`load`] | a file to a design, whatever its format |
//! | [`parse_vcad`] | a text in the .vcad language (`docs/vcad.md` in the repository) to a design |
//! | [`LoadOptions`] | volume fractions for a mesh, the size to scale to |
//! | [`Loaded`] | the [`Design`](fgm_field::Design) and its [`Warning`]s |
//! | [`read_stl`], [`read_obj`], [`read_3mf`] | bytes to a [`TriangleMesh`](fgm_core::TriangleMesh) |
//! | [`DesignError`], [`Problem`], [`Location`] | what went wrong, and where |
//!
//! A mesh that stands under one `fgrade`, moved, turned and scaled as it may be, stays a mesh and
//! can be cut exactly; a mesh combined with anything else becomes a distance.
//!
//! Nothing a file holds makes a function here panic, and every limit on size is named:
//! [`MAX_TEXT_BYTES`], [`MAX_MESH_BYTES`], [`MAX_TRIANGLES`], [`MAX_NODES`], [`MAX_NAMES`],
//! [`MAX_DEPTH`], [`MAX_REACH`].
//!
//! # Example
//!
//! ```
//! use std::path::Path;
//! use fgm_design::{LoadOptions, parse_vcad};
//!
//! let text = r#"fgrade(["x/10", "1 - x/10"], ["blue", "yellow"]) {
//!   cilinder(5, 20);
//! }"#;
//! let error = parse_vcad(text, Path::new("."), &LoadOptions::default()).unwrap_err();
//! assert_eq!(error.to_string(), "<vcad>:2:3: unknown node `cilinder`; did you mean `cylinder`?");
//!
//! let text = text.replace("cilinder", "cylinder");
//! let design = parse_vcad(&text, Path::new("."), &LoadOptions::default())?.design;
//! assert_eq!(design.bounds.size().z, 20.0);
//! # Ok::<(), fgm_design::DesignError>(())
//! ```

mod error;
mod extent;
mod load;
mod mesh;
mod palette;
mod problem;
mod source;
mod vcad;
mod warning;

pub use error::DesignError;
pub use load::{LoadOptions, Loaded, load, parse_vcad};
pub use mesh::obj::read_obj;
pub use mesh::stl::read_stl;
pub use mesh::threemf::read_3mf;
pub use problem::{
    MAX_DEPTH, MAX_MESH_BYTES, MAX_NAMES, MAX_NODES, MAX_REACH, MAX_TEXT_BYTES, MAX_TRIANGLES,
    Problem,
};
pub use source::Location;
pub use warning::Warning;

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
