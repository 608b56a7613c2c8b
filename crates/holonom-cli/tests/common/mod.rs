//! The command as people type it, and what it leaves, for all tests of it.
#![allow(dead_code)] // each test uses its share

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use std::process::Output;

use assert_cmd::Command;
use serde_json::Value;
use tempfile::TempDir;

pub const PAPER: &str = "example:spherical-compound-pendulum";
pub const COMMON: &str = "t,energy,kinetic,potential,work,dE_integrator,dE_projection,phi,phi_dot,phi_ddot,iterations";
pub const NAMED: [&str; 7] =
    ["conserving-ggl", "conserving", "conserving-projected", "trapezoidal-projected", "trapezoidal", "generalized-alpha", "radau"];

/// Runs the command in a folder; `words` are split at blanks.
pub fn holonom(folder: &TempDir, words: &str) -> Output {
    Command::cargo_bin("holonom").unwrap().current_dir(folder).args(words.split_whitespace()).output().unwrap()
}

/// Runs the command and hands back what it prints, after looking at its exit status.
#[track_caller]
pub fn prints(folder: &TempDir, words: &str, status: i32) -> String {
    let output = holonom(folder, words);
    let (out, err) = (text(&output.stdout), text(&output.stderr));
    assert_eq!(output.status.code(), Some(status), "{words}\n{out}\n{err}");
    out
}

/// Runs a command that fails and hands back its message.
#[track_caller]
pub fn fails(folder: &TempDir, words: &str, status: i32) -> String {
    let output = holonom(folder, words);
    let message = text(&output.stderr);
    assert_eq!(output.status.code(), Some(status), "{words}\n{message}");
    assert!(output.stdout.is_empty() && message.contains("error:") && !message.contains("panicked"), "{words}\n{message}");
    message
}

/// What a command prints, as JSON.
#[track_caller]
pub fn json(folder: &TempDir, words: &str) -> Value {
    let out = prints(folder, words, 0);
    serde_json::from_str(&out).unwrap_or_else(|error| panic!("{words}: {error}\n{out}"))
}

pub fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).unwrap()
}

/// What is said, on one line: the screen breaks its lines between words.
pub fn on_one_line(said: &str) -> String {
    said.split_whitespace().collect::<Vec<_>>().join(" ")
}

pub fn folder() -> TempDir {
    tempfile::tempdir().unwrap()
}

pub fn read_json(path: impl AsRef<Path>) -> Value {
    serde_json::from_slice(&fs::read(path).unwrap()).unwrap()
}

/// Header and rows of a table.
pub fn csv(path: impl AsRef<Path>) -> (String, Vec<Vec<f64>>) {
    let text = fs::read_to_string(path).unwrap();
    let mut lines = text.lines();
    let header = lines.next().unwrap().to_string();
    (header, lines.map(|line| line.split(',').map(|cell| cell.parse().unwrap()).collect()).collect())
}

/// Names of the files in a folder.
pub fn files(path: impl AsRef<Path>) -> BTreeSet<String> {
    fs::read_dir(path).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect()
}

pub fn names(names: &[&str]) -> BTreeSet<String> {
    names.iter().map(|name| name.to_string()).collect()
}

/// The keys of `summary.json`: additions are allowed, these must be there.
#[track_caller]
pub fn assert_summary(summary: &Value) {
    let groups: [(&str, &[&str]); 8] = [
        (
            "",
            &["model", "status", "stopped_at", "reason", "step", "end", "steps", "coordinates", "constraints", "rank", "redundant", "dof"],
        ),
        ("/method", &["name", "formulation", "index", "integrator", "iteration", "projection"]),
        ("/method/projection", &["levels", "matrix", "solve"]),
        ("/energy", &["initial", "final", "max_drift", "max_rise", "integrator_total", "projection_total", "work_total", "audit_residual"]),
        ("/momentum", &["linear_drift", "angular_drift"]),
        ("/violation", &["position", "velocity", "acceleration"]),
        ("/work", &["iterations", "iterations_per_step", "factorizations", "rejected_steps"]),
        ("/time", &["cpu_s", "us_per_step", "realtime_factor"]),
    ];
    for (group, keys) in groups {
        let table = summary.pointer(group).and_then(Value::as_object).unwrap_or_else(|| panic!("no {group}"));
        keys.iter().for_each(|key| assert!(table.contains_key(*key), "no {group}/{key}"));
    }
}

/// Fails where files of two folders differ, other than in what tells when the run was, how it was typed and what it took.
#[track_caller]
pub fn assert_same(one: &Path, other: &Path, what: &str) {
    assert_eq!(files(one), files(other), "{what}");
    for name in files(one) {
        let [mut a, mut b] = [one, other].map(|folder| fs::read(folder.join(&name)).unwrap());
        if name == "report.html" {
            // All numbers of the recording; without the viewer there are none.
            [&mut a, &mut b].into_iter().for_each(|bytes| {
                let page = String::from_utf8(std::mem::take(bytes)).unwrap();
                let data = page.split_once(r#"id="holonom-data">"#).map(|(_, rest)| rest.split_once("</script>").unwrap().0);
                *bytes = data.unwrap_or("").as_bytes().to_vec();
            });
            assert!(!cfg!(feature = "viewer") || !a.is_empty());
        }
        if name.ends_with(".json") {
            [&mut a, &mut b].into_iter().for_each(|bytes| {
                let mut value: Value = serde_json::from_slice(bytes).unwrap();
                for key in ["/provenance/date", "/provenance/command", "/time"] {
                    value.pointer_mut(key).map(Value::take);
                }
                *bytes = serde_json::to_string_pretty(&value).unwrap().into_bytes();
            });
        }
        let at = a.iter().zip(&b).take_while(|(a, b)| a == b).count();
        let around = |bytes: &[u8]| String::from_utf8_lossy(&bytes[at.saturating_sub(60)..bytes.len().min(at + 60)]).into_owned();
        assert!(a == b, "{what}: {name} at byte {at}\n{}\n\n{}", around(&a), around(&b));
    }
}
