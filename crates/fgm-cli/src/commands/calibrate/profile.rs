//! A printer's profile with some entries changed and all else left as it is.

use std::{fs, io::Write, path::Path};

use fgm::gcode::Machine;
use toml_edit::{Array, DocumentMut, Item, Table, Value, value};

use crate::{
    args::ProfileArguments, commands::slice::unknown_printer, failure::Failure, output::Output,
};

/// A profile's text while it is changed.
pub(super) struct Profile {
    pub(super) machine: Machine,
    document: DocumentMut,
}

impl Profile {
    /// Reads the profile that is named.
    pub(super) fn read(arguments: &ProfileArguments) -> Result<Self, Failure> {
        let name = &arguments.printer;
        let path = Path::new(name);
        let text = match Machine::builtin_toml(name) {
            Some(text) => text.to_owned(),
            None if name.ends_with(".toml") || path.is_file() => {
                fs::read_to_string(path).map_err(|e| Failure::read(path, &e))?
            }
            None => return Err(unknown_printer(name)),
        };
        let machine = Machine::from_toml(&text)
            .map_err(|e| Failure::at_line(path, &text, e.line, e.column, &e.message))?;
        let document = text.parse().map_err(|e| Failure::usage(format!("{name}: {e}")))?;
        Ok(Self { machine, document })
    }

    /// Sets `section.key`; other keys of the section that would go before it are taken out.
    pub(super) fn set(
        &mut self,
        section: &str,
        key: &str,
        number: f64,
        instead_of: &[&str],
    ) -> Result<(), Failure> {
        let table = self.section(section)?;
        instead_of.iter().for_each(|other| drop(table.remove(other)));
        keep_comment(table, key, value(rounded(number)));
        Ok(())
    }

    /// Sets a list of numbers.
    pub(super) fn set_list(
        &mut self,
        section: &str,
        key: &str,
        numbers: &[f64],
    ) -> Result<(), Failure> {
        let list: Array = numbers.iter().copied().collect();
        keep_comment(self.section(section)?, key, value(list));
        Ok(())
    }

    fn section(&mut self, name: &str) -> Result<&mut Table, Failure> {
        let item = self.document.entry(name).or_insert_with(|| Item::Table(Table::new()));
        if !item.is_table() {
            // Written inline, as `lead = { volume = 3.0 }`.
            let inline = std::mem::take(item);
            *item = Item::Table(inline.into_table().unwrap_or_default());
        }
        item.as_table_mut().ok_or_else(|| Failure::usage(format!("[{name}] is no table")))
    }

    /// Writes the profile where that was asked for, if it is still a good one.
    pub(super) fn write(&self, arguments: &ProfileArguments) -> Result<(), Failure> {
        let Some(path) = &arguments.output else { return Ok(()) };
        let text = self.document.to_string();
        Machine::from_toml(&text)
            .map_err(|e| Failure::usage(format!("the result is no good profile: {}", e.message)))?;
        let mut output = Output::create(path)?;
        output.write_all(text.as_bytes()).map_err(|e| Failure::write(path, &e))?;
        output.finish()
    }
}

/// Replaces a value, with the comment behind it.
fn keep_comment(table: &mut Table, key: &str, mut item: Item) {
    let decor = table.get(key).and_then(Item::as_value).map(|old: &Value| old.decor().clone());
    if let (Some(decor), Some(new)) = (decor, item.as_value_mut()) {
        *new.decor_mut() = decor;
    }
    table.insert(key, item);
}

/// To a millionth: more digits were not measured.
fn rounded(number: f64) -> f64 {
    (number * 1e6).round() / 1e6
}
