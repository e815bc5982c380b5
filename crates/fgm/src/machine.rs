use fgm_gcode::Machine;

use crate::error::SliceError;

/// A printer's profile with changes laid over it, table by table, as settings files and
/// `--set machine.section.key=value` give them.
///
/// # Errors
/// [`SliceError::MachineSetting`] where the profile is no TOML, or the changes do not fit it.
///
/// ```
/// let changes = "[retraction]\nlength = 0.5".parse()?;
/// let machine = fgm::machine("name = 'mine'", &changes)?;
/// assert_eq!(machine.retraction.length, 0.5);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn machine(profile: &str, changes: &toml::Table) -> Result<Machine, SliceError> {
    let wrong = |message: String| SliceError::MachineSetting { message };
    if changes.is_empty() {
        return Machine::from_toml(profile).map_err(|e| wrong(e.to_string()));
    }
    let mut table: toml::Table = profile.parse().map_err(|e| wrong(format!("{e}")))?;
    merge(&mut table, changes);
    // Read from text again: the checks of a profile name lines, which here are not the user's.
    let text = toml::to_string(&table).map_err(|e| wrong(e.to_string()))?;
    Machine::from_toml(&text).map_err(|e| wrong(e.message))
}

fn merge(under: &mut toml::Table, over: &toml::Table) {
    for (key, value) in over {
        match (under.get_mut(key), value) {
            (Some(toml::Value::Table(below)), toml::Value::Table(above)) => merge(below, above),
            _ => {
                under.insert(key.clone(), value.clone());
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_unknown_entry_is_named() {
        let changes = "[retraction]\nlenght = 0.5".parse().unwrap();
        let error = machine("name = 'mine'", &changes).unwrap_err().to_string();
        assert!(error.contains("lenght"), "{error}");
    }
}
