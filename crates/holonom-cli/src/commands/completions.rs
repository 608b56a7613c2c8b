//! `holonom completions`.

use std::process::ExitCode;

use clap::CommandFactory;

use crate::failure::Failure;
use crate::options::{Cli, CompletionsArguments};

/// Prints what makes a shell complete commands and options.
pub fn completions(arguments: &CompletionsArguments) -> Result<ExitCode, Failure> {
    clap_complete::generate(arguments.shell, &mut Cli::command(), "holonom", &mut std::io::stdout());
    Ok(ExitCode::SUCCESS)
}
