//! Exact plane sections of triangle meshes.

mod chain;
mod issues;
mod section;
mod shells;
mod slabs;
mod slicer;
mod topology;
mod union;
mod weld;

pub use issues::{Issue, MeshIssues};
pub use section::{Section, SectionWarning};
pub use slicer::{DEFAULT_GAP, MeshSlicer};
