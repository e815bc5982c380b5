//! Where the old colour may go.

use std::fmt;

use serde::{Deserialize, Serialize};

/// How purge towers stand beside the part.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum PurgeLayout {
    /// One tower that all colours share.
    One,
    /// A spot for each colour.
    Spots,
}

/// What takes the old colour.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum PurgeInto {
    /// The towers.
    #[default]
    Tower,
    /// Filling hidden in the part, and the towers where there is too little of it.
    Infill,
}

impl fmt::Display for PurgeLayout {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::One => "one",
            Self::Spots => "spots",
        })
    }
}
