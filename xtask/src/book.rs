//! `cargo xtask book`: the chapter "Which method?", whose figures and numbers come from runs of `holonom compare`.
//! With `--check` the runs are repeated, every claim is measured again, and nothing is written.

pub mod chapter;
pub mod draw;
pub mod figure;
mod figures;
mod measure;
mod results;
mod runs;
pub mod table;

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use chapter::Chapter;
use figure::{Figure, Measurement};
use figures::FIGURES;
use results::Results;

use crate::performance;

/// Draws the figures and fills in the chapter's tables, or checks that both still hold.
pub fn book(check: bool) -> ExitCode {
    match if check { repeat() } else { make() } {
        Ok(()) => ExitCode::SUCCESS,
        Err(fault) => {
            eprintln!("{fault}\n`cargo xtask book` writes and draws anew");
            ExitCode::FAILURE
        }
    }
}

const CHAPTER: &str = "which-method.md";

pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("xtask is a folder of the repository").to_path_buf()
}

fn make() -> Result<(), String> {
    let results = Results::of(&root(), "target/book")?;
    let folder = root().join("docs/figures");
    std::fs::create_dir_all(&folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    for figure in FIGURES {
        let path = folder.join(format!("{}.svg", figure.name));
        std::fs::write(&path, draw::svg(figure, &results)?).map_err(|error| format!("{}: {error}", path.display()))?;
    }
    let mut chapter = Chapter::read(&root(), CHAPTER)?;
    for (name, table) in tables(&results)? {
        chapter.fill(&name, &table)?;
    }
    chapter.write()?;
    all_hold(report(&results))
}

fn repeat() -> Result<(), String> {
    let results = Results::of(&root(), "target/book-check")?;
    let chapter = Chapter::read(&root(), CHAPTER)?;
    let mut faults = report(&results);
    faults.extend(performance::faults(&root())?);
    faults.extend(FIGURES.iter().filter_map(|figure| chapter.shows(figure.name).err()));
    faults.extend(tables(&results)?.iter().filter_map(|(name, table)| chapter.agrees(name, table).err()));
    all_hold(faults)
}

fn all_hold(faults: Vec<String>) -> Result<(), String> {
    if faults.is_empty() { Ok(()) } else { Err(faults.join("\n")) }
}

/// The chapter's tables: one of all methods, and what was measured for each figure.
fn tables(results: &Results) -> Result<Vec<(String, String)>, String> {
    let measured = FIGURES.iter().map(|figure| (figure.name.to_string(), table::measured(figure, results)));
    Ok(std::iter::once(("methods".to_string(), table::methods(results)?)).chain(measured).collect())
}

/// Prints every claim with its figures, and gives the claims that do not hold.
fn report(results: &Results) -> Vec<String> {
    let mut faults = Vec::new();
    for figure in FIGURES {
        println!("{}: {}", figure.name, figure.claim);
        for measurement in figure.measurements {
            let value = (measurement.measure)(results);
            let holds = measurement.holds(value);
            println!("  {} {}: {value:.4e}, claimed {}", if holds { "✓" } else { "✗" }, measurement.what, measurement.claimed());
            if !holds {
                faults.push(fault(figure, measurement, value));
            }
        }
    }
    faults
}

fn fault(figure: &Figure, measurement: &Measurement, value: f64) -> String {
    format!("the claim of figure `{}` no longer holds: {} is {value:.4e}, not {}", figure.name, measurement.what, measurement.claimed())
}
