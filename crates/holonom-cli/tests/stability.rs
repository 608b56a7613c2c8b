//! `holonom stability` as people type it: what it prints and what it leaves in its folder.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use std::process::Output;

use assert_cmd::Command;
use serde_json::Value;

const WORDS: &str = "stability example:simple-pendulum --end 1 --method conserving --method trapezoidal";

fn holonom(folder: &Path, words: &str) -> Output {
    Command::cargo_bin("holonom").unwrap().current_dir(folder).args(words.split_whitespace()).output().unwrap()
}

/// What a command prints that succeeds.
#[track_caller]
fn prints(folder: &Path, words: &str) -> String {
    let output = holonom(folder, words);
    assert!(output.status.success(), "{words}\n{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

fn files(folder: &Path) -> BTreeSet<String> {
    fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect()
}

#[test]
fn leaves_numbers_and_a_report() {
    let folder = tempfile::tempdir().unwrap();
    let out = prints(folder.path(), WORDS);
    assert!(out.contains("completes s") && out.contains("results in results/simple-pendulum-stability"), "{out}");
    let results = folder.path().join("results/simple-pendulum-stability");
    assert_eq!(files(&results), BTreeSet::from(["report.html".to_string(), "stability.json".to_string()]));

    let found: Value = serde_json::from_slice(&fs::read(results.join("stability.json")).unwrap()).unwrap();
    assert_eq!((&found[0]["method"], &found[1]["method"]), (&"conserving".into(), &"trapezoidal".into()));
    assert_eq!((&found[0]["model"], &found[0]["end"], &found[0]["limit"]), (&"simple-pendulum".into(), &1.0.into(), &0.1.into()));
    assert_eq!(found[0]["completes"], 0.1, "the conserving scheme reaches the limit");

    let report = fs::read_to_string(results.join("report.html")).unwrap();
    for told in
        ["Largest step that completes 1 s", "limit of the search 0.1 s", ">conserving<", ">trapezoidal<", "≥ 0.1 s", "[point.", "2 methods"]
    {
        assert!(report.contains(told), "{told}");
    }
}

#[test]
fn json_is_all_that_is_printed_and_what_is_written() {
    let folder = tempfile::tempdir().unwrap();
    let printed: Value = serde_json::from_str(&prints(folder.path(), &format!("{WORDS} --json --no-report --out a"))).unwrap();
    let written: Value = serde_json::from_slice(&fs::read(folder.path().join("a/stability.json")).unwrap()).unwrap();
    assert_eq!(printed, written);
    assert_eq!(files(&folder.path().join("a")), BTreeSet::from(["stability.json".to_string()]));
    assert_eq!(prints(folder.path(), &format!("{WORDS} --quiet --out b")), "");
    assert!(folder.path().join("b/report.html").exists());
}

#[test]
fn what_cannot_be_done_is_said_before_the_search() {
    let folder = tempfile::tempdir().unwrap();
    assert_eq!(holonom(folder.path(), &format!("{WORDS} --method fast")).status.code(), Some(2));
    assert!(!folder.path().join("results").exists());
    fs::write(folder.path().join("file"), "").unwrap();
    let output = holonom(folder.path(), &format!("{WORDS} --out file/results"));
    assert_eq!(output.status.code(), Some(4));
    assert!(String::from_utf8_lossy(&output.stderr).contains("cannot create file/results"));
}
