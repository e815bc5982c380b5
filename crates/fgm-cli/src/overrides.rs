//! Settings from a file, from the named options and from `--set`, laid over each other.

use std::{fs, path::Path};

use toml::{Table, Value};

use crate::failure::Failure;

/// Puts `value` at `section.key`, making tables on the way.
pub(crate) fn put(table: &mut Table, path: &[&str], value: Value) {
    let [section @ .., key] = path else { return };
    let mut at = table;
    for name in section {
        let entry = at.entry(*name).or_insert_with(|| Value::Table(Table::new()));
        if !entry.is_table() {
            *entry = Value::Table(Table::new());
        }
        let Value::Table(inner) = entry else { return };
        at = inner;
    }
    at.insert((*key).to_owned(), value);
}

/// Reads `section.key=value` into `table`. A value that is no TOML is taken as a string, so that
/// words need no quotes.
pub(crate) fn set(table: &mut Table, text: &str) -> Result<(), Failure> {
    let wrong = || {
        Failure::usage(format!("--set {text}: write SECTION.KEY=VALUE, as in --set infill.angle=0"))
    };
    let (path, value) = text.split_once('=').ok_or_else(wrong)?;
    let path: Vec<&str> = path.split('.').map(str::trim).collect();
    if path.len() < 2 || path.iter().any(|name| name.is_empty()) {
        return Err(wrong());
    }
    let value = value.trim();
    let parsed = format!("v = {value}").parse::<Table>().ok().and_then(|mut t| t.remove("v"));
    put(table, &path, parsed.unwrap_or_else(|| Value::String(value.to_owned())));
    Ok(())
}

/// Reads a TOML file of the user's; `check` finds what is wrong in it beyond the syntax, with its
/// place.
pub(crate) fn read<T>(
    path: &Path,
    check: impl FnOnce(&str) -> Result<T, toml::de::Error>,
) -> Result<T, Failure> {
    let text = fs::read_to_string(path).map_err(|e| Failure::read(path, &e))?;
    check(&text).map_err(|e| {
        let span = e.span().unwrap_or(0..0);
        Failure::at(path, &text, span, e.message())
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_need_no_quotes() {
        let mut table = Table::new();
        for text in ["infill.pattern=gyroid", "infill.angle = 30", "machine.retraction.length=0.5"]
        {
            set(&mut table, text).unwrap();
        }
        let wanted = "[infill]\npattern = 'gyroid'\nangle = 30\n[machine.retraction]\nlength = 0.5";
        assert_eq!(table, wanted.parse().unwrap());
        for bad in ["infill", "infill=3", ".=3", "infill.=3"] {
            assert!(set(&mut table, bad).is_err(), "{bad}");
        }
    }
}
