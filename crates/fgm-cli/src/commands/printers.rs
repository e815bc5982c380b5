use std::io::{self, Write};

use fgm::gcode::Machine;

use crate::{
    args::{PrintersArguments, PrintersCommand},
    commands::slice::unknown_printer,
    failure::Failure,
};

/// Lists the built-in printers or prints one's profile.
pub(crate) fn run(arguments: &PrintersArguments) -> Result<(), Failure> {
    let text = match &arguments.command {
        None => list(),
        Some(PrintersCommand::Show { name }) => {
            Machine::builtin_toml(name).ok_or_else(|| unknown_printer(name))?.to_owned()
        }
    };
    match io::stdout().lock().write_all(text.as_bytes()) {
        Err(e) if e.kind() != io::ErrorKind::BrokenPipe => {
            Err(Failure::could_not(format!("could not print: {e}")))
        }
        _ => Ok(()),
    }
}

fn list() -> String {
    let machines: Vec<_> = Machine::builtin_names().filter_map(Machine::builtin).collect();
    let width = machines.iter().map(|m| m.name.len()).max().unwrap_or(0);
    machines.iter().map(|m| format!("{:width$}  {}\n", m.name, m.title)).collect()
}
