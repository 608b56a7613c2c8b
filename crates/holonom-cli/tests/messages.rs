//! What a run says of models that are sound as files and cannot move as they are meant to.

mod common;

use std::fs;

use common::{folder, holonom, text};

/// All that a run of a model says, and its exit status.
fn run(model: &str) -> (String, Option<i32>) {
    let folder = folder();
    fs::write(folder.path().join("model.toml"), model).unwrap();
    let output = holonom(&folder, "run model.toml --no-report");
    (format!("{}{}", text(&output.stderr), text(&output.stdout)), output.status.code())
}

#[track_caller]
fn says(model: &str, words: &[&str], status: i32) {
    let (said, code) = run(model);
    assert_eq!(code, Some(status), "{said}");
    for word in words {
        assert!(said.contains(word), "{word} is missing in\n{said}");
    }
}

#[test]
fn friction_that_is_hardly_smoothed_is_named() {
    let block = |speed: &str| {
        format!(
            "plane = \"xz\"\n[body.block]\nmass = 1\ninertia = 0.1\nposition = [0, 0]\nvelocity = [1, 0]\n\
             [joint.rail]\ntype = \"prismatic\"\nbetween = [\"ground\", \"block\"]\naxis = [1, 0]\n\
             [force.rust]\ntype = \"friction\"\njoint = \"rail\"\neffort = 3\nspeed = {speed}\n[simulation]\nend = 1\nstep = 0.01\n"
        )
    };
    says(&block("1e-9"), &["stopped at", "`rust` turns round within 1.0e-9 m/s or rad/s", "larger `speed`"], 3);
    says(&block("1e-3"), &["completed"], 0);
}

#[test]
fn points_in_a_line_are_not_told_of_as_a_door() {
    let point = |name: &str, x: f64| format!("[point.{name}]\nmass = 1\nposition = [{x}, 0, 0]\n");
    let rod = |name: &str, ends: &str| format!("[constraint.{name}]\ntype = \"distance\"\nbetween = {ends}\n");
    let text = format!(
        "{}{}{}{}{}[simulation]\nend = 1\nstep = 0.01\n",
        point("a", 1.0),
        point("b", 2.0),
        rod("one", "[\"ground\", \"a\"]"),
        rod("two", "[\"a\", \"b\"]"),
        rod("three", "[\"ground\", \"b\"]"),
    );
    says(&text, &["stopped at", "(redundant)", "three distances along a line"], 3);
}
