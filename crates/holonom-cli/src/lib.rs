//! The command `holonom`, and runs of models as it makes them, for those who call it from elsewhere.

mod checkpoint;
mod clock;
mod columns;
mod commands;
mod comparison;
mod desk;
mod failure;
mod folder;
mod found;
mod interpolation;
mod items;
mod keeper;
mod load;
mod message;
mod notes;
mod options;
mod output;
mod progress;
mod provenance;
mod spins;
mod sweep;
mod table;

use std::ffi::OsString;
use std::process::ExitCode;

use clap::Parser;

pub use commands::check::checked;
pub use commands::compare::{side_by_side, write_side_by_side};
pub use commands::modes::Vibrations;
pub use commands::run::describe;
pub use commands::stability::largest_steps;
pub use failure::Failure;
pub use found::Found;
pub use load::{Loaded, example, require_key, run_failure};
pub use notes::notes;
use options::{Cli, Command};
pub use output::{Finished, Order, simulate, table_writers};
pub use sweep::{Complaint, Ending, Line, Plan, Store, Study, Vary};

/// Does what was typed, of which the first word is the program, and says how that ended.
pub fn command(words: impl IntoIterator<Item = OsString>) -> ExitCode {
    let cli = match Cli::try_parse_from(words) {
        Ok(cli) => cli,
        Err(error) => {
            // What cannot be written, as the help to a reader that is gone, is not needed.
            let _ = error.print();
            return ExitCode::from(error.exit_code() as u8);
        }
    };
    let outcome = match &cli.command {
        Command::Run(arguments) => commands::run::run(arguments),
        Command::Compare(arguments) => commands::compare::compare(arguments),
        Command::Sweep(arguments) => commands::sweep::sweep(arguments),
        Command::Stability(arguments) => commands::stability::stability(arguments),
        Command::Check(arguments) => commands::check::check(arguments),
        Command::Modes(arguments) => commands::modes::modes_of(arguments),
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
