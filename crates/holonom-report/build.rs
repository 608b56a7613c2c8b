//! Bundles the browser viewer (`viewer/`, TypeScript) into `OUT_DIR/bundle/viewer.{js,css}`, which `src/page.rs` embeds, and into
//! `OUT_DIR/bundle/live.js`, which `src/live.rs` does.
//!
//! Everything happens on a copy inside `OUT_DIR`: the source tree never sees `node_modules` or a generated file. Without the
//! feature `viewer` there is nothing to do.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::{env, fs, io};

/// Where `node_modules` belongs to: when these change, the packages are installed again.
const PACKAGE_FILES: [&str; 3] = ["package.json", "package-lock.json", ".npmrc"];

const CURE: &str = "\
The viewer of the HTML report is bundled when holonom-report is built. That needs Node 20 or newer with npm:
  Debian, Ubuntu   apt install nodejs npm
  macOS            brew install node
  others           the installer of the Node project
To build without it (reports then have no picture and no plots): cargo build --no-default-features --features parquet";

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    if env::var_os("CARGO_FEATURE_VIEWER").is_none() {
        return;
    }
    let source = PathBuf::from(env::var_os("CARGO_MANIFEST_DIR").unwrap()).join("viewer");
    let out = PathBuf::from(env::var_os("OUT_DIR").unwrap());
    for name in PACKAGE_FILES.iter().chain(&["src"]) {
        println!("cargo::rerun-if-changed={}", source.join(name).display());
    }
    if let Err(fault) = bundle(&source, &out.join("viewer"), &out.join("bundle")) {
        for line in fault.lines().chain([""]).chain(CURE.lines()) {
            println!("cargo::error={line}");
        }
        std::process::exit(1);
    }
}

fn bundle(source: &Path, copy: &Path, bundle: &Path) -> Result<(), String> {
    require_node()?;
    let changed = copy_sources(source, copy).map_err(|e| format!("copying {}: {e}", source.display()))?;
    if changed || !copy.join("node_modules").is_dir() {
        let flags = ["ci", "--omit=dev", "--ignore-scripts", "--no-audit", "--no-fund", "--loglevel=error"];
        run(Command::new(npm()).args(flags).current_dir(copy), "npm ci")?;
    }
    for (script, file) in [("bundle", "viewer.js"), ("bundle-live", "live.js")] {
        let outfile = format!("--outfile={}", bundle.join(file).display());
        run(Command::new(npm()).args(["run", "--silent", script, "--", &outfile]).current_dir(copy), "esbuild")?;
    }
    let script = fs::read_to_string(bundle.join("viewer.js")).map_err(|e| format!("reading the bundle: {e}"))?;
    // Either would end or derail the <script> element that the bundle is put into.
    match ["</script", "<!--"].iter().find(|mark| script.contains(**mark)) {
        Some(mark) => Err(format!("the bundle contains {mark:?} and cannot stand inside a <script> element")),
        None => Ok(()),
    }
}

fn require_node() -> Result<(), String> {
    let version = Command::new("node").arg("--version").output().map_err(|e| format!("cannot start `node`: {e}"))?;
    let version = String::from_utf8_lossy(&version.stdout).trim().to_owned();
    let major = version.trim_start_matches('v').split('.').next().and_then(|n| n.parse::<u32>().ok());
    match major {
        Some(major) if major >= 20 => Ok(()),
        _ => Err(format!("`node --version` says {version:?}, and 20 or newer is needed")),
    }
}

/// Brings the copy up to date; true when the list of packages differs from the one installed there.
fn copy_sources(source: &Path, copy: &Path) -> io::Result<bool> {
    fs::create_dir_all(copy)?;
    let mut changed = false;
    for name in PACKAGE_FILES {
        let (new, old) = (fs::read(source.join(name))?, fs::read(copy.join(name)).unwrap_or_default());
        if new != old {
            changed = true;
            fs::write(copy.join(name), new)?;
        }
    }
    if copy.join("src").exists() {
        fs::remove_dir_all(copy.join("src"))?;
    }
    copy_folder(&source.join("src"), &copy.join("src"))?;
    Ok(changed)
}

fn copy_folder(from: &Path, to: &Path) -> io::Result<()> {
    fs::create_dir_all(to)?;
    for entry in fs::read_dir(from)? {
        let entry = entry?;
        let target = to.join(entry.file_name());
        if entry.file_type()?.is_dir() {
            copy_folder(&entry.path(), &target)?;
        } else {
            fs::copy(entry.path(), target)?;
        }
    }
    Ok(())
}

fn run(command: &mut Command, name: &str) -> Result<(), String> {
    let output = command.output().map_err(|e| format!("cannot start `{name}`: {e}"))?;
    if output.status.success() {
        return Ok(());
    }
    let (stdout, stderr) = (String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    Err(format!("`{name}` failed ({}):\n{stdout}{stderr}", output.status))
}

/// On Windows npm is a command file, which has to be named in full.
fn npm() -> &'static str {
    if cfg!(windows) { "npm.cmd" } else { "npm" }
}
