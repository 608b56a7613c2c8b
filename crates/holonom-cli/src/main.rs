//! The command `holonom`.

use std::process::ExitCode;

fn main() -> ExitCode {
    // Who reads no further, as `head` does, ends the command without a word.
    sigpipe::reset();
    holonom_cli::command(std::env::args_os())
}
