//! `cargo xtask python`: installs the Python package into an environment of its own below `target`, as `pip install .` does but without
//! optimising it for long, and runs its tests.

use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};

use crate::book::root;

/// What the package is built and tested with. The checkers of types come with what they know of others, and need nothing else.
const TOOLS: [&str; 11] = [
    "maturin>=1.9,<2",
    "numpy",
    "pytest",
    "pandas",
    "pandas-stubs",
    "matplotlib",
    "gymnasium",
    "scipy",
    "anywidget",
    "mypy",
    "pyright>=1.1.414",
];

/// Compiled as `cargo build` does it, as little is gained by more.
const BUILD: &str = "--config-settings=build-args=--profile dev";

/// Builds, installs and tests the package.
pub fn python() -> ExitCode {
    let target = std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| root().join("target"), PathBuf::from);
    let environment = target.join("python");
    let programs = environment.join(if cfg!(windows) { "Scripts" } else { "bin" });
    let python = programs.join("python");
    let install = |what: &[&str]| {
        let pip = ["-m", "pip", "install", "--quiet", "--disable-pip-version-check"];
        run(Command::new(&python).args(pip).args(what).env("PATH", path_with(&programs)))
    };
    let is_done = (programs.exists() || make(&environment))
        && install(&TOOLS)
        && install(&["--no-build-isolation", "--no-deps", "--force-reinstall", BUILD, "."])
        && run(Command::new(&python).args(["-m", "pytest", "--quiet", "-p", "no:cacheprovider"]));
    if is_done { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

/// Where programs are looked for: first in the environment, which has what builds the package.
fn path_with(programs: &Path) -> OsString {
    let others = std::env::var_os("PATH").unwrap_or_default();
    let folders = std::iter::once(programs.to_path_buf()).chain(std::env::split_paths(&others));
    std::env::join_paths(folders).unwrap_or(others)
}

/// The environment. Debian has what makes it in a package of its own.
fn make(environment: &Path) -> bool {
    let make = || run(Command::new("python3").args(["-m", "venv", "--clear"]).arg(environment));
    make() || (install_venv() && make())
}

fn install_venv() -> bool {
    println!("── installing python3-venv");
    run(Command::new("apt-get").args(["update", "--quiet"]))
        && run(Command::new("apt-get").args(["install", "--yes", "--quiet", "python3-venv"]))
}

fn run(command: &mut Command) -> bool {
    // Compiled Python beside the sources would be packed.
    command.current_dir(root()).env("PYTHONDONTWRITEBYTECODE", "1").status().is_ok_and(|status| status.success())
}
