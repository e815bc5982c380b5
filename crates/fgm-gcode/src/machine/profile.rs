use std::fmt;

use crate::{GcodeError, Machine};

/// Why a profile cannot be read, and where.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MachineError {
    /// Line of the text, from 1.
    pub line: usize,
    /// Column of the line, from 1, in characters.
    pub column: usize,
    /// What is wrong.
    pub message: String,
}

impl fmt::Display for MachineError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "line {}, column {}: {}", self.line, self.column, self.message)
    }
}

impl std::error::Error for MachineError {}

impl Machine {
    /// Reads a profile. Fields left out have their defaults.
    ///
    /// # Errors
    /// [`MachineError`] for what is not TOML, an unknown field, a value of the wrong type or out
    /// of range, and an unknown template variable.
    ///
    /// ```
    /// use fgm_gcode::Machine;
    /// let machine = Machine::from_toml("name = 'mine'\n[bed]\nsize = [220, 220, 240]")?;
    /// assert_eq!(machine.bed.bounds().max.z, 240.0);
    /// let error = Machine::from_toml("name = 'mine'\n[bed]\nsise = 3").unwrap_err();
    /// assert_eq!((error.line, error.column), (3, 1));
    /// # Ok::<(), fgm_gcode::MachineError>(())
    /// ```
    pub fn from_toml(text: &str) -> Result<Self, MachineError> {
        let machine: Self = toml::from_str(text).map_err(|error| {
            let at = error.span().map_or(0, |span| span.start);
            let (line, column) = position(text, at);
            MachineError { line, column, message: error.message().to_owned() }
        })?;
        let valid = machine.validate().and_then(|()| machine.validate_dialect());
        valid.map_err(|error| locate(text, &error))?;
        Ok(machine)
    }
}

/// Line and column, from 1, of a byte offset.
fn position(text: &str, at: usize) -> (usize, usize) {
    let before = text.get(..at).unwrap_or(text);
    let line_start = before.rfind('\n').map_or(0, |i| i + 1);
    (before.matches('\n').count() + 1, before[line_start..].chars().count() + 1)
}

/// The place of the field that a value error is about.
fn locate(text: &str, error: &GcodeError) -> MachineError {
    let (line, column) = match error {
        GcodeError::Setting { name, .. } => find_key(text, name),
        GcodeError::DialectMismatch { .. } => find_key(text, "dialect.name"),
        GcodeError::Template { template, line, column, .. } => {
            let (key_line, key_column) = find_key(text, &format!("template.{template}"));
            let multiline = text
                .lines()
                .nth(key_line - 1)
                .is_some_and(|l| l.contains("\"\"\"") || l.contains("'''"));
            // A multi-line string begins on the line below its quotes.
            if multiline { (key_line + line, *column) } else { (key_line, key_column) }
        }
        _ => (1, 1),
    };
    MachineError { line, column, message: error.to_string() }
}

/// Where `section.key` is set; the top where it is not (its default is then at fault).
fn find_key(text: &str, path: &str) -> (usize, usize) {
    let (section, key) = path.split_once('.').unwrap_or(("", path));
    let mut current = "";
    for (i, line) in text.lines().enumerate() {
        let bare = line.trim();
        if let Some(name) = bare.strip_prefix('[').and_then(|l| l.split(']').next()) {
            current = name.trim();
            continue;
        }
        let (set, _) = bare.split_once('=').unwrap_or((bare, ""));
        let found = set.trim();
        if (current == section && found == key) || (current.is_empty() && found == path) {
            return (i + 1, line.len() - line.trim_start().len() + 1);
        }
    }
    (1, 1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn errors_point_at_the_place() {
        for (text, line, column, words) in [
            ("name = ", 1, 8, ""),
            ("name = 'a'\n\n[lead]\n  volume = 'x'\n", 4, 12, "string"),
            ("kind = 'mixing'\nkin = 3\n", 2, 1, "unknown field"),
            ("[bed]\nsize = [1, 2]\n", 2, 8, "array of length 3"),
            ("[dialect]\nname = 'klingon'\n", 2, 8, "marlin-mixing"),
            ("[bed]\nsize = [100, 0, 100]\n", 2, 1, "bed.size"),
            ("name = 'a'\nfilament_density = 0.0\n", 2, 1, "filament_density"),
            ("[speed]\n travel = nan\n", 2, 2, "speed.travel"),
            ("inputs = 0\n", 1, 1, "inputs"),
            ("inputs = 9\n", 1, 1, "8 filaments"),
            ("kind = 'foaming'\n[dialect]\nname = 'kalico'\n", 3, 1, "foaming does"),
            ("kind = 'tool-changer'\n", 1, 1, "tool-change"),
            ("inputs = 7\n[dialect]\nname = 'marlin-direct'\n", 1, 1, "6 motors"),
            ("[lead]\nvolume = -1.0\n", 2, 1, "lead.volume"),
            ("[template]\nstart = \"\"\"\nG28\nM104 S{heat}\n\"\"\"\n", 4, 7, "heat"),
        ] {
            let error = Machine::from_toml(text).unwrap_err();
            assert_eq!((error.line, error.column), (line, column), "{text:?}: {error}");
            assert!(error.message.contains(words), "{text:?}: {error}");
        }
    }

    proptest! {
        #[test]
        fn any_text_is_read_or_refused(text in "\\PC{0,60}", cut in 0usize..4000) {
            let _ = Machine::from_toml(&text);
            let profile = Machine::builtin_toml("snmf-4").unwrap();
            let mut broken: String = profile.chars().take(cut).collect();
            broken.push_str(&text);
            if let Err(error) = Machine::from_toml(&broken) {
                prop_assert!(error.line <= broken.lines().count().max(1) + 1, "{}", error);
            }
        }
    }

    #[test]
    fn a_profile_survives_writing_and_reading() {
        let machine = Machine { name: "mine".into(), max_flow: Some(11.0), ..Machine::default() };
        let text = toml::to_string(&machine).unwrap();
        assert_eq!(Machine::from_toml(&text), Ok(machine));
    }
}
