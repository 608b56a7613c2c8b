//! A fixed number of iterations a step: what is measured of it and what does not go with it.

mod common;

use common::*;
use serde_json::Value;

#[test]
fn every_step_takes_as_many_iterations_as_asked_for_and_is_timed() {
    let folder = folder();
    for (method, parts) in [
        ("conserving-ggl", 1.0),
        ("trapezoidal-projected", 1.0),
        ("ggl/radau-5", 1.0),
        ("penalty/conserving", 1.0),
        ("lagrange-3/conserving-4", 5.0),
    ] {
        for count in [1.0, 3.0] {
            let words = format!("run {PAPER} --end 1 --step 0.005 --method {method} --set simulation.iterations={count} --no-report");
            let summary = json(&folder, &format!("{words} --json --force --out a"));
            assert_eq!(
                (&summary["status"], &summary["work"]["iterations_per_step"]),
                (&"completed".into(), &(parts * count).into()),
                "{method}"
            );
            assert_eq!(summary["work"]["rejected_steps"], 0);
            // New factors in each iteration: what a step costs is the same.
            assert!(summary["work"]["factorizations"].as_f64().unwrap() >= parts * count * 200.0, "{method}");
            let (_, rows) = csv(folder.path().join("a/trajectory.csv"));
            assert!(rows[1..].iter().all(|row| row[10] == parts * count), "{method}: the same in each step");
            let time = |key: &str| summary["time"]["step_us"][key].as_f64().unwrap_or_else(|| panic!("{method}: {key}"));
            let sorted = [0.0, time("median"), time("p90"), time("p99"), time("max")];
            assert!(sorted[1] > 0.0 && sorted.windows(2).all(|pair| pair[0] <= pair[1]), "{sorted:?}");
        }
    }
    let out = prints(&folder, &format!("run {PAPER} --end 0.1 --set simulation.iterations=2 --no-report --out b"), 0);
    assert!(out.contains("one step") && out.contains("longest"), "{out}");
    let summary = json(&folder, &format!("run {PAPER} --end 0.1 --no-report --json --out c"));
    assert_eq!(summary["time"]["step_us"], Value::Null, "no clock where nobody asks for it");
}

/// At this step the first iterations leave errors that show, and each one leaves less.
#[test]
fn more_iterations_come_nearer_to_the_solution() {
    let folder = folder();
    let last = |words: &str| {
        prints(&folder, &format!("run {PAPER} --end 2 --step 0.0625 --quiet --no-report --force --out a {words}"), 0);
        csv(folder.path().join("a/trajectory.csv")).1.last().unwrap()[11..14].to_vec()
    };
    let solution = last("");
    let error = |count: u32| {
        let found = last(&format!("--set simulation.iterations={count}"));
        found.iter().zip(&solution).fold(0.0, |m: f64, (a, b)| m.max((a - b).abs()))
    };
    let errors = [1, 2, 3].map(error);
    assert!(errors[0] > 1e-6 && errors[1] < 1e-3 * errors[0] && errors[1] > 1e-13 && errors[2] < 1e-3 * errors[1], "{errors:?}");
}

#[test]
fn what_does_not_go_with_a_fixed_number_is_refused() {
    let folder = folder();
    for (words, told) in [
        ("--accuracy 1e-6", "equal steps"),
        ("--set simulation.iteration=nested --method conserving", "newton"),
        ("--method ode/rk4", "radau"),
        ("--set simulation.iterations=0", "at least 1"),
        ("--set simulation.iterations=1.5", "whole number"),
    ] {
        let given = if words.contains("iterations") { String::new() } else { "--set simulation.iterations=2".into() };
        let message = fails(&folder, &format!("run {PAPER} --end 0.1 {given} {words}"), 2);
        assert!(message.contains(told) && message.contains("iterations"), "{words}\n{message}");
    }
}
