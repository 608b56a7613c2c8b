//! `holonom stability` as people type it: what it prints and what it leaves in its folder.

mod common;

use std::fs;

use common::*;
use serde_json::Value;

const WORDS: &str = "stability example:simple-pendulum --end 1 --method conserving --method trapezoidal";

#[test]
fn stability_finds_the_largest_steps() {
    let folder = folder();
    let words = format!("stability {PAPER} --end 2 --method conserving-projected --method trapezoidal");
    let out = prints(&folder, &words, 0);
    for word in ["method", "completes s", "conserving-projected", "trapezoidal"] {
        assert!(out.contains(word), "{word}\n{out}");
    }
    let found = json(&folder, &format!("{words} --json"));
    let projected = found[0]["completes"].as_f64().unwrap();
    assert_eq!((found.as_array().unwrap().len(), &found[0]["method"]), (2, &"conserving-projected".into()));
    assert!(projected > 0.0 && found[0]["runs"].as_u64().unwrap() > 0);
    if let Some(fails) = found[0]["fails"].as_f64() {
        assert!(fails > projected, "{fails} {projected}");
    }
}

#[test]
fn leaves_numbers_and_a_report() {
    let folder = folder();
    let out = prints(&folder, WORDS, 0);
    assert!(out.contains("completes s") && out.contains("results in results/simple-pendulum-stability"), "{out}");
    let results = folder.path().join("results/simple-pendulum-stability");
    assert_eq!(files(&results), names(&["report.html", "stability.json"]));

    let found: Value = read_json(results.join("stability.json"));
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
    let folder = folder();
    let printed: Value = json(&folder, &format!("{WORDS} --json --no-report --out a"));
    let written: Value = read_json(folder.path().join("a/stability.json"));
    assert_eq!(printed, written);
    assert_eq!(files(folder.path().join("a")), names(&["stability.json"]));
    assert_eq!(prints(&folder, &format!("{WORDS} --quiet --out b"), 0), "");
    assert!(folder.path().join("b/report.html").exists());
}

#[test]
fn what_cannot_be_done_is_said_before_the_search() {
    let folder = folder();
    assert_eq!(holonom(&folder, &format!("{WORDS} --method fast")).status.code(), Some(2));
    assert!(!folder.path().join("results").exists());
    fs::write(folder.path().join("file"), "").unwrap();
    let output = holonom(&folder, &format!("{WORDS} --out file/results"));
    assert_eq!(output.status.code(), Some(4));
    assert!(String::from_utf8_lossy(&output.stderr).contains("cannot create file/results"));
}

/// An accuracy chooses the steps of a run, and of a search there is nothing to choose.
#[test]
fn a_model_with_an_accuracy_is_searched_with_equal_steps() {
    let folder = folder();
    let found = |more: &str| {
        let words = format!(
            "stability example:simple-pendulum --method trapezoidal --method conserving --end 2 --json --no-report --out s --force {more}"
        );
        json(&folder, &words).as_array().unwrap().iter().map(|one| one["completes"].clone()).collect::<Vec<_>>()
    };
    assert_eq!(found("--set simulation.accuracy=1e-6"), found(""));
}
