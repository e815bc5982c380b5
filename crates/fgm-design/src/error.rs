use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::{Location, Problem};

/// Why there is no design.
///
/// Its text is complete by itself: the file, for text files the line and column, what is wrong,
/// and the limit where one is broken. For a message that shows the line, take
/// [`location`](Self::location) and [`source_text`](Self::source_text).
#[derive(Debug, thiserror::Error)]
pub enum DesignError {
    /// A file cannot be read.
    #[error("cannot read {}: {error}", path.display())]
    Read {
        /// Which.
        path: PathBuf,
        /// Why.
        #[source]
        error: io::Error,
    },
    /// A file's name does not end in one of the formats.
    #[error(
        "{}: designs end in .vcad, .stl, .obj or .3mf, not in `{extension}`",
        path.display()
    )]
    UnknownFormat {
        /// Which file.
        path: PathBuf,
        /// What comes after its last point; empty for none.
        extension: String,
    },
    /// A file, or what a compressed one unpacks to, is larger than what is read.
    #[error("{}: more than {limit} bytes", path.display())]
    FileTooLarge {
        /// Which.
        path: PathBuf,
        /// The most that is read.
        limit: u64,
    },
    /// Something at a place of a text.
    #[error("{at}: {problem}")]
    Source {
        /// Where.
        at: Box<Location>,
        /// The whole text that `at` points into.
        text: Arc<str>,
        /// What.
        #[source]
        problem: Box<Problem>,
    },
    /// Something in a binary file, or in the whole of a file.
    #[error("{}: {problem}", path.display())]
    File {
        /// Which; the name of the format in angle brackets where bytes were read.
        path: PathBuf,
        /// What.
        #[source]
        problem: Box<Problem>,
    },
}

impl DesignError {
    /// The place it points at: for errors in text formats and expressions.
    pub fn location(&self) -> Option<Location> {
        match self {
            Self::Source { at, .. } => Some((**at).clone()),
            _ => None,
        }
    }

    /// The text that [`location`](Self::location) points into.
    pub fn source_text(&self) -> Option<&str> {
        match self {
            Self::Source { text, .. } => Some(text),
            _ => None,
        }
    }

    /// What is wrong, without the place; none where a file was not read at all.
    pub fn problem(&self) -> Option<&Problem> {
        match self {
            Self::Source { problem, .. } | Self::File { problem, .. } => Some(problem),
            _ => None,
        }
    }

    pub(crate) fn file(path: &Path, problem: Problem) -> Self {
        Self::File { path: path.to_path_buf(), problem: Box::new(problem) }
    }
}
