//! The comments at the head of a file.

use fgm_gcode::Machine;

use crate::settings::Settings;

/// Every setting and every entry of the printer's profile, as `section.key = value`.
pub(crate) fn lines(settings: &Settings, machine: &Machine) -> Vec<String> {
    let mut lines = Vec::new();
    let settings = Settings { machine: toml::Table::new(), ..settings.clone() };
    // A plain table of plain values: it cannot fail to be one.
    if let Ok(table) = toml::Table::try_from(settings) {
        flatten(&table, "", &mut lines);
    }
    lines.extend(machine_comments(machine));
    lines
}

/// Every entry of a printer's profile as `machine.section.key = value`: comments for the head of a
/// file, from which [`Head`](fgm_sim::Head) reads the profile again.
pub fn machine_comments(machine: &Machine) -> Vec<String> {
    let mut lines = Vec::new();
    if let Ok(table) = toml::Table::try_from(machine) {
        flatten(&table, "machine.", &mut lines);
    }
    lines
}

fn flatten(table: &toml::Table, prefix: &str, lines: &mut Vec<String>) {
    for (key, value) in table {
        match value {
            toml::Value::Table(inner) => flatten(inner, &format!("{prefix}{key}."), lines),
            // A text of many lines would break the comment.
            toml::Value::String(text) => lines.push(format!("{prefix}{key} = {text:?}")),
            value => lines.push(format!("{prefix}{key} = {value}")),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_setting_is_one_line() {
        let lines = lines(&Settings::default(), &Machine::default());
        assert!(lines.contains(&"layer.height = 0.2".to_owned()));
        assert!(lines.contains(&"slice.strategy = \"sectioned\"".to_owned()));
        assert!(lines.iter().any(|l| l.starts_with("machine.template.start = ")));
        assert!(lines.iter().all(|l| !l.contains('\n')));
    }
}
