//! `cargo xtask gallery`: the pictures of the book, of the gallery and of the chapter on joints. Each model is run, its report is
//! opened in headless Chromium, and the picture of the mechanism at a telling moment is saved.

mod browser;
mod shots;

use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};

use shots::{GALLERY, JOINTS, Shot};

/// Makes all pictures, or those with these names.
pub fn gallery(names: &[String]) -> ExitCode {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("xtask is a folder of the repository");
    match make(root, names) {
        Ok(()) => ExitCode::SUCCESS,
        Err(fault) => {
            eprintln!("{fault}");
            ExitCode::FAILURE
        }
    }
}

fn make(root: &Path, names: &[String]) -> Result<(), String> {
    let wanted = |shot: &&Shot| names.is_empty() || names.iter().any(|name| name == shot.name);
    if let Some(name) = names.iter().find(|&name| !GALLERY.iter().chain(JOINTS).any(|shot| shot.name == name)) {
        return Err(format!("there is no picture `{name}`"));
    }
    for shot in GALLERY.iter().filter(wanted) {
        picture(root, "gallery", shot, &root.join(format!("examples/{}.toml", shot.name)))?;
    }
    let chapter = read(&root.join("docs/joints.md"))?;
    for shot in JOINTS.iter().filter(wanted) {
        let model = root.join(format!("target/pictures/joints/{}.toml", shot.name));
        write(&model, example(&chapter, shot.name)?)?;
        picture(root, "joints", shot, &model)?;
    }
    Ok(())
}

/// The model in the section of a joint.
fn example<'a>(chapter: &'a str, joint: &str) -> Result<&'a str, String> {
    let section = chapter.split("\n### ").find(|section| section.starts_with(&format!("`{joint}`")));
    let model = section.and_then(|section| section.split_once("```toml\n")?.1.split_once("```"));
    model.map(|(model, _)| model).ok_or_else(|| format!("docs/joints.md has no section `{joint}` with a model"))
}

fn picture(root: &Path, part: &str, shot: &Shot, model: &Path) -> Result<(), String> {
    let results = root.join(format!("target/pictures/{part}/{}", shot.name));
    run(root, shot, model, &results)?;
    let report = read(&results.join("report.html"))?;
    let page = results.join("picture.html");
    write(&page, browser::page(&report, shot)?)?;
    let picture = root.join(format!("docs/figures/{part}/{}.png", shot.name));
    let bytes = browser::picture(&page, &root.join("target/pictures/profile"))?;
    println!("{part}/{}: {} kB", shot.name, bytes.len().div_ceil(1000));
    write(&picture, bytes)
}

fn run(root: &Path, shot: &Shot, model: &Path, results: &Path) -> Result<(), String> {
    let mut command = Command::new("cargo");
    command.current_dir(root).args(["run", "--release", "--quiet", "-p", "holonom-cli", "--", "run"]);
    command.arg(model).args(shot.run).args(["--quiet", "--force", "--out"]).arg(results);
    match command.status() {
        Ok(status) if status.success() => Ok(()),
        Ok(status) => Err(format!("the run of {} ended with {status}", model.display())),
        Err(error) => Err(format!("cargo does not start: {error}")),
    }
}

fn read(path: &Path) -> Result<String, String> {
    std::fs::read_to_string(path).map_err(|error| format!("{}: {error}", path.display()))
}

fn write(path: &PathBuf, bytes: impl AsRef<[u8]>) -> Result<(), String> {
    let fault = |error| format!("{}: {error}", path.display());
    std::fs::create_dir_all(path.parent().expect("a file is in a folder")).map_err(fault)?;
    std::fs::write(path, bytes).map_err(fault)
}
