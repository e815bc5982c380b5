use std::path::{Path, PathBuf};

use crate::Location;

/// Something odd that did not stop a design from being read.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Warning {
    /// A mesh that does not enclose a volume everywhere.
    #[error("{}: the mesh is not closed: {edges} edge(s) without a partner", file.display())]
    OpenMesh {
        /// The mesh's file.
        file: PathBuf,
        /// Edges whose triangles do not pair up.
        edges: usize,
    },
    /// A closed mesh whose triangles face inwards; they were turned.
    #[error("{}: the mesh was inside out; turned", file.display())]
    InsideOut {
        /// The mesh's file.
        file: PathBuf,
    },
    /// A material named twice in one list; the first counts.
    #[error("{}: material `{name}` is named twice; the first counts", place(file, at.as_ref()))]
    DuplicateMaterial {
        /// The design's or the palette's file.
        file: PathBuf,
        /// Where in it, if known.
        at: Option<Location>,
        /// Which.
        name: String,
    },
    /// The design has one material only; a second one that is nowhere was added.
    #[error("the design has one material only, `{name}`")]
    OneMaterial {
        /// Which.
        name: String,
    },
    /// A palette that cannot be read; colours are the usual ones.
    #[error("{}: {reason}; its colours are not used", file.display())]
    Palette {
        /// The palette's file.
        file: PathBuf,
        /// Why.
        reason: String,
    },
    /// A palette without one of the design's materials.
    #[error("{}: no colour for material `{name}`", file.display())]
    NoColor {
        /// The palette's file.
        file: PathBuf,
        /// Which.
        name: String,
    },
    /// A part of a 3MF file that was left out.
    #[error("{}: {what}", file.display())]
    LeftOut {
        /// The 3MF file.
        file: PathBuf,
        /// What was left out.
        what: String,
    },
}

fn place(file: &Path, at: Option<&Location>) -> String {
    at.map_or_else(|| file.display().to_string(), ToString::to_string)
}
