//! The promises of ARCHITECTURE.md that can be read off the sources.

use std::fs;
use std::path::{Path, PathBuf};

/// Rooms of the engine and their floors; a file imports only from floors below its own room's.
const FLOORS: &[(&str, u8)] = &[
    ("linalg", 0),
    ("system", 1),
    ("formulation", 2),
    ("energy", 3),
    ("integrator", 4),
    ("projection", 4),
    ("simulation", 5),
    ("record", 6),
    ("analysis", 6),
    ("model", 6),
    ("run", 7),
];

/// What the model may import: it is compiled down to a system, drawn as a scene, says by what method it is run, and nothing else knows it.
const MODEL_IMPORTS: &[&str] = &["system", "record", "model", "simulation"];

fn sources(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).expect("the folder is there") {
        let path = entry.expect("the entry can be read").path();
        if path.is_dir() {
            found.extend(sources(&path));
        } else if path.extension().is_some_and(|ending| ending == "rs") {
            found.push(path);
        }
    }
    found
}

fn engine() -> Vec<(String, PathBuf, String)> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let room = |path: &Path| {
        let first = path.strip_prefix(&root).unwrap().components().next().unwrap();
        first.as_os_str().to_string_lossy().trim_end_matches(".rs").to_string()
    };
    let is_engine = |path: &PathBuf| !path.ends_with("src/lib.rs") && !path.ends_with("tests.rs");
    let files = sources(&root).into_iter().filter(is_engine);
    files.map(|path| (room(&path), path.clone(), fs::read_to_string(&path).unwrap())).collect()
}

/// Rooms that a source imports.
fn imports(text: &str) -> Vec<&str> {
    let rooms = text.match_indices("crate::").map(|(at, _)| &text[at + "crate::".len()..]);
    rooms.map(|rest| rest.split(|c: char| !c.is_alphanumeric() && c != '_').next().unwrap_or("")).filter(|room| !room.is_empty()).collect()
}

#[test]
fn no_file_imports_from_its_own_floor_or_above() {
    let floor = |room: &str| FLOORS.iter().find(|(name, _)| *name == room).map(|(_, floor)| *floor);
    let mut files = 0;
    for (room, path, text) in engine() {
        files += 1;
        for import in imports(&text) {
            if room == "model" {
                assert!(MODEL_IMPORTS.contains(&import), "{} imports `{import}`", path.display());
            } else if import != room {
                let (own, other) = (floor(&room), floor(import));
                assert!(own.is_some(), "{} is in no room of the table", path.display());
                assert!(other.is_some() && other < own, "{} climbs to `{import}`", path.display());
            }
        }
    }
    assert!(files > 30, "the sources were found");
}

#[test]
fn the_engine_opens_no_file_asks_no_clock_and_prints_nothing() {
    for (_, path, text) in engine() {
        let code = text.split("#[cfg(test)]").next().unwrap();
        for forbidden in ["std::fs", "std::io", "std::time", "std::thread", "println!", "print!"] {
            assert!(!code.contains(forbidden), "{} has `{forbidden}`", path.display());
        }
    }
}

#[test]
fn only_linalg_names_the_linear_algebra_library() {
    for (room, path, text) in engine() {
        assert!(room == "linalg" || !text.contains("faer"), "{} names it", path.display());
    }
}
