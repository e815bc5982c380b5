use std::io;

use clap::CommandFactory;

use crate::{
    args::{Arguments, CompletionsArguments},
    failure::Failure,
};

/// Prints a completion script.
pub(crate) fn run(arguments: &CompletionsArguments) -> Result<(), Failure> {
    clap_complete::generate(arguments.shell, &mut Arguments::command(), "fgm", &mut io::stdout());
    Ok(())
}
