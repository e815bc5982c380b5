use std::fmt;
use std::str::FromStr;

use crate::ToolpathError;

/// The arrangements of infill lines.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum Pattern {
    /// Parallel lines, turned by a quarter on every other layer.
    #[default]
    Rectilinear,
    /// Parallel lines, the same way on every layer.
    Aligned,
    /// Lines both ways on every layer.
    Grid,
    /// Lines three ways on every layer, which meet in the corners of triangles.
    Triangles,
    /// Hexagonal cells, the same on every layer.
    Honeycomb,
    /// Loops along the border.
    Concentric,
    /// A triply periodic surface without straight lines: equally strong every way.
    Gyroid,
    /// Branches that hold up what is above and nothing else, by
    /// [`infill_lightning`](crate::infill_lightning); by itself, all of them.
    Lightning,
}

impl Pattern {
    /// Every pattern.
    pub const ALL: [Self; 8] = [
        Self::Rectilinear,
        Self::Aligned,
        Self::Grid,
        Self::Triangles,
        Self::Honeycomb,
        Self::Concentric,
        Self::Gyroid,
        Self::Lightning,
    ];

    /// Its name in settings.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Rectilinear => "rectilinear",
            Self::Aligned => "aligned",
            Self::Grid => "grid",
            Self::Triangles => "triangles",
            Self::Honeycomb => "honeycomb",
            Self::Concentric => "concentric",
            Self::Gyroid => "gyroid",
            Self::Lightning => "lightning",
        }
    }
}

impl fmt::Display for Pattern {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

/// By the name, exactly.
impl FromStr for Pattern {
    type Err = ToolpathError;

    fn from_str(name: &str) -> Result<Self, ToolpathError> {
        let found = Self::ALL.into_iter().find(|p| p.name() == name);
        found.ok_or_else(|| ToolpathError::UnknownPattern { name: name.into() })
    }
}
