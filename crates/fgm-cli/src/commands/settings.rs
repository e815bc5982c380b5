use std::io::{self, Write};

use fgm::{SETTINGS, SettingInfo};

use crate::{args::SettingsArguments, failure::Failure};

/// Lists the settings, or prints a settings file.
pub(crate) fn run(arguments: &SettingsArguments) -> Result<(), Failure> {
    let wanted = |info: &&SettingInfo| match &arguments.filter {
        Some(word) => format!("{}.{}", info.section, info.key).contains(word.as_str()),
        None => true,
    };
    let chosen: Vec<_> = SETTINGS.iter().filter(wanted).collect();
    if chosen.is_empty() {
        return Err(Failure::usage(format!(
            "no setting's name contains `{}`; `fgm settings` lists them all",
            arguments.filter.as_deref().unwrap_or_default()
        )));
    }
    let mut out = io::stdout().lock();
    let printed =
        if arguments.toml { as_file(&chosen, &mut out) } else { as_list(&chosen, &mut out) };
    printed.or_else(|e| match e.kind() {
        // The reader has seen enough: `fgm settings | head`.
        io::ErrorKind::BrokenPipe => Ok(()),
        _ => Err(Failure::could_not(format!("could not print: {e}"))),
    })
}

fn as_list(chosen: &[&SettingInfo], out: &mut impl Write) -> io::Result<()> {
    let mut section = "";
    for info in chosen {
        if info.section != section {
            section = info.section;
            writeln!(out, "[{section}]")?;
        }
        let help = info.help.trim();
        writeln!(out, "  {} = {}  ({})", info.key, info.default, info.unit)?;
        writeln!(out, "      {help}")?;
    }
    writeln!(out, "[machine]")?;
    writeln!(out, "  any entry of the printer's profile, as `fgm printers show NAME` prints it")
}

/// A settings file: what has no default of its own is commented out.
fn as_file(chosen: &[&SettingInfo], out: &mut impl Write) -> io::Result<()> {
    let mut section = "";
    for info in chosen {
        if info.section != section {
            section = info.section;
            writeln!(out, "\n[{section}]")?;
        }
        writeln!(out, "# {} ({})", info.help.trim(), info.unit)?;
        match format!("v = {}", info.default).parse::<toml::Table>() {
            Ok(_) => writeln!(out, "{} = {}", info.key, info.default)?,
            Err(_) => writeln!(out, "# {} = ...   # {}", info.key, info.default)?,
        }
    }
    Ok(())
}
