//! Chores of the repository: `cargo xtask ci` runs every check, the same here and elsewhere; `cargo xtask book` draws the
//! figures of the book, `cargo xtask gallery` takes its pictures, `cargo xtask performance` writes its chapter on time, `cargo xtask python`
//! tests the Python package.

mod book;
mod gallery;
mod performance;
mod python;

use std::process::{Command, ExitCode};

/// One check: what it is called and what it runs.
struct Check {
    name: &'static str,
    command: &'static [&'static str],
}

const CHECKS: &[Check] = &[
    Check { name: "format", command: &["cargo", "fmt", "--all", "--check"] },
    Check { name: "lints", command: &["cargo", "clippy", "--workspace", "--all-targets", "--", "-D", "warnings"] },
    Check { name: "documentation", command: &["cargo", "doc", "--workspace", "--no-deps", "--quiet"] },
    Check { name: "tests", command: &["cargo", "test", "--workspace", "--no-fail-fast"] },
    Check { name: "python", command: &["cargo", "xtask", "python"] },
    Check { name: "book", command: &["cargo", "xtask", "book", "--check"] },
];

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    match arguments.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        ["ci"] => ci(),
        ["book"] => book::book(false),
        ["book", "--check"] => book::book(true),
        ["gallery", ..] => gallery::gallery(&arguments[1..]),
        ["python"] => python::python(),
        ["performance", ..] => performance::performance(&arguments[1..]),
        _ => {
            eprintln!("usage: cargo xtask ci | book | book --check | gallery [NAME ...] | performance [--peers FOLDER ...] | python");
            ExitCode::from(2)
        }
    }
}

fn ci() -> ExitCode {
    if !(is_there("node") && is_there("npm")) {
        eprintln!("the report's viewer is bundled with Node 20 or newer and npm: install them first");
        return ExitCode::FAILURE;
    }
    if !is_there("chromium") && !install_chromium() {
        eprintln!("the report is tested in Chromium: install the package `chromium` first");
        return ExitCode::FAILURE;
    }
    if !is_there("python3") {
        eprintln!("the Python package is tested with Python 3.10 or newer: install it first");
        return ExitCode::FAILURE;
    }
    for check in CHECKS {
        println!("── {}", check.name);
        if !run(check.command) {
            eprintln!("── {} failed: {}", check.name, check.command.join(" "));
            return ExitCode::FAILURE;
        }
    }
    println!("── all {} checks passed", CHECKS.len());
    ExitCode::SUCCESS
}

/// Debian's package, where there is a package manager that may be used.
fn install_chromium() -> bool {
    println!("── installing chromium");
    run(&["apt-get", "update", "--quiet"]) && run(&["apt-get", "install", "--yes", "--quiet", "chromium"])
}

fn is_there(program: &str) -> bool {
    Command::new(program).arg("--version").output().is_ok_and(|output| output.status.success())
}

fn run(command: &[&str]) -> bool {
    // Documentation with a broken link is no documentation.
    Command::new(command[0]).args(&command[1..]).env("RUSTDOCFLAGS", "-D warnings").status().is_ok_and(|status| status.success())
}
