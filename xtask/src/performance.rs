//! `cargo xtask performance`: the chapter on computing time, from the results that the scripts in `benches` left. With
//! `--peers FOLDER` the scripts run first; what follows the folder goes to `benches/side-by-side/run.py`.

mod plots;
mod results;
mod tables;

use std::path::Path;
use std::process::{Command, ExitCode};

use crate::book::chapter::Chapter;
use crate::book::root;
use results::Results;

const CHAPTER: &str = "performance.md";

/// Measures if it is told where the peers are, draws the figures and fills in the chapter's tables.
pub fn performance(arguments: &[String]) -> ExitCode {
    match measure(arguments).and_then(|()| write(&root())) {
        Ok(()) => ExitCode::SUCCESS,
        Err(fault) => {
            eprintln!("{fault}");
            ExitCode::FAILURE
        }
    }
}

fn measure(arguments: &[String]) -> Result<(), String> {
    let (folder, options) = match arguments {
        [] => return Ok(()),
        [option, folder, options @ ..] if option == "--peers" => (folder, options),
        _ => return Err("usage: cargo xtask performance [--peers FOLDER [options of benches/side-by-side/run.py]]".into()),
    };
    // The scripts are called from the root, wherever this is.
    let folder = Path::new(folder).canonicalize().map_err(|error| format!("{folder}: {error}"))?;
    run(Command::new("cargo").args(["build", "--release", "--package", "holonom-cli"]))?;
    run(Command::new("python3").arg("benches/counts/run.py"))?;
    run(Command::new("python3").arg("benches/side-by-side/run.py").arg("--peers").arg(folder).args(options))
}

fn run(command: &mut Command) -> Result<(), String> {
    match command.current_dir(root()).status() {
        Ok(status) if status.success() => Ok(()),
        Ok(status) => Err(format!("{command:?} ended with {status}")),
        Err(error) => Err(format!("{command:?} does not start: {error}")),
    }
}

fn write(root: &Path) -> Result<(), String> {
    let results = Results::read(root)?;
    let folder = root.join("docs/figures/performance");
    std::fs::create_dir_all(&folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    for (name, picture) in plots::all(&results)? {
        let path = folder.join(format!("{name}.svg"));
        std::fs::write(&path, picture).map_err(|error| format!("{}: {error}", path.display()))?;
    }
    let mut chapter = Chapter::read(root, CHAPTER)?;
    for (name, table) in tables::all(&results) {
        chapter.fill(name, &table)?;
    }
    chapter.write()
}

/// Where the chapter is not what the results say.
pub fn faults(root: &Path) -> Result<Vec<String>, String> {
    let results = Results::read(root)?;
    let chapter = Chapter::read(root, CHAPTER)?;
    let shown = plots::all(&results)?.into_iter().map(|(name, _)| chapter.shows(&format!("performance/{name}")));
    let filled = tables::all(&results).into_iter().map(|(name, table)| chapter.agrees(name, &table));
    let faults = shown.chain(filled).filter_map(Result::err);
    Ok(faults.map(|fault| format!("{CHAPTER}: {fault}; `cargo xtask performance` writes it")).collect())
}
