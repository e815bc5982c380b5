//! The values of settings that are neither plain numbers nor flags.

use std::{fmt, str::FromStr};

use serde::{Deserialize, Deserializer, Serialize, Serializer, de::Error as _};

/// How the part becomes paths.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Strategy {
    /// Strategy 1: ordinary walls, skins and infill, sectioned by colour.
    #[default]
    Sectioned,
    /// Strategy 2: every face of one colour filled against the gradient.
    Against,
}

/// What paths are sectioned by.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SectionBy {
    /// The material itself: boundaries are found along each path.
    #[default]
    Field,
    /// The faces of the layer, cut out by traced boundaries.
    Faces,
}

/// What the deposit is to come near to where commands are chosen for it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Aim {
    /// The design's own mixtures along every bead.
    Design,
    /// The palette's colours of the paths.
    Colors,
}

/// How many colours the palette has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ColorCount {
    /// As many as said.
    Count(usize),
    /// The most that keeps pieces printable.
    Auto,
}

/// How far neighbouring colours overlap.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Zipper {
    /// As a share of the whole gradient, 0..1.
    Share(f64),
    /// As a length along the gradient, mm.
    Length(f64),
}

impl Zipper {
    /// No overlap.
    pub const NONE: Self = Self::Share(0.0);
}

/// A word or number that is not one of the choices.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("`{found}` is not {wanted}")]
pub struct ChoiceError {
    /// What stands there.
    pub found: String,
    /// What could.
    pub wanted: &'static str,
}

fn not<T>(found: &str, wanted: &'static str) -> Result<T, ChoiceError> {
    Err(ChoiceError { found: found.to_owned(), wanted })
}

impl FromStr for Strategy {
    type Err = ChoiceError;
    fn from_str(text: &str) -> Result<Self, ChoiceError> {
        match text.trim() {
            "sectioned" | "1" => Ok(Self::Sectioned),
            "against" | "2" => Ok(Self::Against),
            other => not(other, "a strategy: sectioned (or 1), against (or 2)"),
        }
    }
}

impl FromStr for SectionBy {
    type Err = ChoiceError;
    fn from_str(text: &str) -> Result<Self, ChoiceError> {
        match text.trim() {
            "field" => Ok(Self::Field),
            "faces" => Ok(Self::Faces),
            other => not(other, "what to section by: field or faces"),
        }
    }
}

impl FromStr for Aim {
    type Err = ChoiceError;
    fn from_str(text: &str) -> Result<Self, ChoiceError> {
        match text.trim() {
            "design" => Ok(Self::Design),
            "colors" => Ok(Self::Colors),
            other => not(other, "what to aim at: design or colors"),
        }
    }
}

impl FromStr for ColorCount {
    type Err = ChoiceError;
    fn from_str(text: &str) -> Result<Self, ChoiceError> {
        match (text.trim(), text.trim().parse()) {
            ("auto", _) => Ok(Self::Auto),
            (_, Ok(count)) if count > 0 => Ok(Self::Count(count)),
            (other, _) => not(other, "a number of colours above 0, or auto"),
        }
    }
}

impl FromStr for Zipper {
    type Err = ChoiceError;
    fn from_str(text: &str) -> Result<Self, ChoiceError> {
        const WANTED: &str =
            "an overlap: a share of the gradient such as 0.05, or a length such as 15mm";
        let text = text.trim();
        let (number, length) = match text.strip_suffix("mm") {
            Some(number) => (number.trim_end(), true),
            None => (text, false),
        };
        match number.parse::<f64>() {
            Ok(value) if value.is_finite() && value >= 0.0 => {
                Ok(if length { Self::Length(value) } else { Self::Share(value) })
            }
            _ => not(text, WANTED),
        }
    }
}

impl fmt::Display for Strategy {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Sectioned => "sectioned",
            Self::Against => "against",
        })
    }
}

impl fmt::Display for SectionBy {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Field => "field",
            Self::Faces => "faces",
        })
    }
}

impl fmt::Display for Aim {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Design => "design",
            Self::Colors => "colors",
        })
    }
}

impl fmt::Display for ColorCount {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Count(count) => write!(f, "{count}"),
            Self::Auto => f.write_str("auto"),
        }
    }
}

impl fmt::Display for Zipper {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Share(share) => write!(f, "{share}"),
            Self::Length(length) => write!(f, "{length}mm"),
        }
    }
}

/// In files a choice may be a string or a bare number.
#[derive(Deserialize)]
#[serde(untagged)]
enum TextOrNumber {
    Integer(i64),
    Float(f64),
    Text(String),
}

fn choice<'de, T: FromStr<Err = ChoiceError>, D: Deserializer<'de>>(d: D) -> Result<T, D::Error> {
    match TextOrNumber::deserialize(d)? {
        TextOrNumber::Integer(number) => number.to_string().parse(),
        TextOrNumber::Float(number) => number.to_string().parse(),
        TextOrNumber::Text(text) => text.parse(),
    }
    .map_err(D::Error::custom)
}

macro_rules! as_text_or_number {
    ($($choice:ty),*) => {$(
        impl<'de> Deserialize<'de> for $choice {
            fn deserialize<D: Deserializer<'de>>(d: D) -> Result<Self, D::Error> {
                choice(d)
            }
        }
    )*};
}
as_text_or_number!(Strategy, SectionBy, Aim, ColorCount, Zipper);

impl Serialize for Strategy {
    fn serialize<S: Serializer>(&self, s: S) -> Result<S::Ok, S::Error> {
        s.collect_str(self)
    }
}

impl Serialize for SectionBy {
    fn serialize<S: Serializer>(&self, s: S) -> Result<S::Ok, S::Error> {
        s.collect_str(self)
    }
}

impl Serialize for Aim {
    fn serialize<S: Serializer>(&self, s: S) -> Result<S::Ok, S::Error> {
        s.collect_str(self)
    }
}

impl Serialize for ColorCount {
    fn serialize<S: Serializer>(&self, s: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Count(count) => s.serialize_u64(*count as u64),
            Self::Auto => s.collect_str(self),
        }
    }
}

impl Serialize for Zipper {
    fn serialize<S: Serializer>(&self, s: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Share(share) => s.serialize_f64(*share),
            Self::Length(_) => s.collect_str(self),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_and_numbers_are_read() {
        assert_eq!("2".parse(), Ok(Strategy::Against));
        assert_eq!("sectioned".parse(), Ok(Strategy::Sectioned));
        assert_eq!("faces".parse(), Ok(SectionBy::Faces));
        assert_eq!("colors".parse(), Ok(Aim::Colors));
        assert_eq!("auto".parse(), Ok(ColorCount::Auto));
        assert_eq!("12".parse(), Ok(ColorCount::Count(12)));
        assert_eq!("15mm".parse(), Ok(Zipper::Length(15.0)));
        assert_eq!("0.05".parse(), Ok(Zipper::Share(0.05)));
        for bad in ["-1", "NaN", "mm", "", "15 cm"] {
            assert!(bad.parse::<Zipper>().is_err(), "{bad}");
        }
        assert!("0".parse::<ColorCount>().is_err());
        assert!("palette".parse::<Aim>().is_err());
        assert!("three".parse::<Strategy>().is_err());
    }

    #[test]
    fn text_says_what_was_read() {
        for text in ["15mm", "0.05", "0"] {
            assert_eq!(text.parse::<Zipper>().unwrap().to_string(), text);
        }
        for text in ["design", "colors"] {
            assert_eq!(text.parse::<Aim>().unwrap().to_string(), text);
        }
        for text in ["auto", "7"] {
            assert_eq!(text.parse::<ColorCount>().unwrap().to_string(), text);
        }
    }
}
