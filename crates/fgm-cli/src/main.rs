//! `fgm`: slices graded designs into G-code. See `fgm --help`.

mod args;
mod commands;
mod failure;
mod output;
mod overrides;
mod progress;
mod show;

use std::process::ExitCode;

use clap::Parser;

use args::{Arguments, Command};

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    let done = match arguments.command {
        Command::Slice(slice) => commands::slice::run(&slice),
        Command::Calibrate(calibrate) => commands::calibrate::run(&calibrate),
        Command::Check(check) => commands::check::run(&check),
        Command::Inspect(inspect) => commands::inspect::run(&inspect),
        Command::Printers(printers) => commands::printers::run(&printers),
        Command::Settings(settings) => commands::settings::run(&settings),
        Command::Completions(completions) => commands::completions::run(&completions),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            show::failure(&failure);
            failure.exit_code()
        }
    }
}
