//! The command `holonom`.

mod checkpoint;
mod clock;
mod columns;
mod commands;
mod comparison;
mod failure;
mod folder;
mod interpolation;
mod items;
mod keeper;
mod load;
mod message;
mod options;
mod output;
mod progress;
mod provenance;
mod sweep;
mod table;

use std::process::ExitCode;

use clap::Parser;

use options::{Cli, Command};

fn main() -> ExitCode {
    // Who reads no further, as `head` does, ends the command without a word.
    sigpipe::reset();
    let cli = Cli::parse();
    let outcome = match &cli.command {
        Command::Run(arguments) => commands::run::run(arguments),
        Command::Compare(arguments) => commands::compare::compare(arguments),
        Command::Sweep(arguments) => commands::sweep::sweep(arguments),
        Command::Stability(arguments) => commands::stability::stability(arguments),
        Command::Check(arguments) => commands::check::check(arguments),
        Command::Methods(arguments) => commands::methods::methods(arguments),
        Command::Examples(arguments) => commands::examples::examples(arguments),
        Command::View(arguments) => commands::view::view(arguments),
        Command::Schema => commands::schema::schema(),
        Command::Completions(arguments) => commands::completions::completions(arguments),
    };
    outcome.unwrap_or_else(|failure| {
        message::say(&failure.to_string());
        failure.exit_code()
    })
}
