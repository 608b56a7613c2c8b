//! `holonom compare`: several runs in one report.

mod common;

use std::fs;

use common::*;

#[test]
fn compare_puts_every_method_and_step_into_one_report() {
    let folder = folder();
    let words = "--end 0.2 --method conserving --method trapezoidal-projected --step 0.01 --step 0.02 --out a";
    let out = prints(&folder, &format!("compare {PAPER} {words}"), 0);
    let results = folder.path().join("a");
    let report = fs::read_to_string(results.join("report.html")).unwrap();
    let tables = ["conserving-0.01s", "conserving-0.02s", "trapezoidal-projected-0.01s", "trapezoidal-projected-0.02s"];
    for label in ["conserving, 0.01 s", "trapezoidal-projected, 0.01 s", "conserving, 0.02 s", "trapezoidal-projected, 0.02 s"] {
        assert!(out.contains(label) && report.contains(label), "{label}\n{out}");
    }
    let tables: Vec<String> = tables.iter().map(|name| format!("{name}.csv")).collect();
    let expected: Vec<&str> = tables.iter().map(String::as_str).chain(["columns.json", "report.html", "summary.json"]).collect();
    assert_eq!(files(&results), names(&expected));
    assert_eq!(csv(results.join("conserving-0.02s.csv")).1.len(), 11);
    let summaries = read_json(results.join("summary.json"));
    assert_eq!(summaries.as_array().unwrap().len(), 4);
    summaries.as_array().unwrap().iter().for_each(assert_summary);

    let all = json(&folder, "compare example:simple-pendulum --end 0.1 --no-report --json");
    let found: Vec<&str> = all.as_array().unwrap().iter().map(|summary| summary["method"]["name"].as_str().unwrap()).collect();
    assert_eq!(found, NAMED);
    assert!(!folder.path().join("results/simple-pendulum-compare/report.html").exists());
}

#[test]
fn notes_of_runs_say_of_which() {
    let told = holonom(&folder(), &format!("compare {PAPER} --method conserving --method trapezoidal --no-report"));
    assert!(text(&told.stderr).starts_with("note: trapezoidal: the method has made "), "{}", text(&told.stderr));
}

#[test]
fn compare_shows_runs_that_stop() {
    let folder = folder();
    let words = "--method trapezoidal --method conserving --set simulation.subdivide=false --set simulation.iteration=simultaneous \
                 --set simulation.penalty=1e7 --set simulation.tolerance=1e-9 --end 7 --json --no-report";
    let all = json(&folder, &format!("compare {PAPER} {words}"));
    assert_eq!((&all[0]["status"], &all[1]["status"]), (&"stopped".into(), &"completed".into()));
}

#[test]
fn methods_that_cannot_have_the_accuracy_of_a_model_are_left_out() {
    let folder = folder();
    let output = holonom(&folder, "compare example:simple-pendulum --end 0.1 --set simulation.accuracy=1e-4 --no-report --json --out a");
    let (out, told) = (text(&output.stdout), text(&output.stderr));
    assert!(output.status.success() && told.contains("trapezoidal is left out") && told.contains("gives an accuracy"), "{told}");
    let labels: Vec<String> =
        serde_json::from_str::<Vec<serde_json::Value>>(&out).unwrap().iter().map(|one| one["label"].as_str().unwrap().into()).collect();
    assert_eq!(labels, NAMED.into_iter().filter(|name| *name != "trapezoidal").collect::<Vec<_>>());
    // Where it is asked for it is refused.
    fails(&folder, "compare example:simple-pendulum --end 0.1 --set simulation.accuracy=1e-4 --method trapezoidal", 2);
}
