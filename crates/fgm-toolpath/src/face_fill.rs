use std::{fmt, str::FromStr};

use crate::ToolpathError;

/// What lies inside the first loop of a face.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum FaceFill {
    /// More loops, until nothing is left.
    #[default]
    Concentric,
    /// Straight lines.
    Rectilinear,
}

impl FaceFill {
    /// Every fill.
    pub const ALL: [Self; 2] = [Self::Concentric, Self::Rectilinear];

    /// Its name in settings.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Concentric => "concentric",
            Self::Rectilinear => "rectilinear",
        }
    }
}

impl fmt::Display for FaceFill {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

/// By the name, exactly.
impl FromStr for FaceFill {
    type Err = ToolpathError;

    fn from_str(name: &str) -> Result<Self, ToolpathError> {
        let found = Self::ALL.into_iter().find(|fill| fill.name() == name);
        found.ok_or_else(|| ToolpathError::UnknownFill { name: name.into() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_read_and_written() {
        for fill in FaceFill::ALL {
            assert_eq!(fill.to_string().parse::<FaceFill>(), Ok(fill));
        }
        assert!("zigzag".parse::<FaceFill>().is_err());
    }
}
