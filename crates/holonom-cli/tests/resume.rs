//! `holonom run --resume`: what was ended goes on as if nothing had been.

mod common;

use std::fs;

use common::*;

/// Runs to `first` and goes on to `end`, and to `end` in one go, and compares.
#[track_caller]
fn in_parts(model: &str, options: &str, first: &[&str], end: &str) {
    let folder = folder();
    let run = |words: &str| prints(&folder, &format!("run {model} {options} --quiet {words}"), 0);
    run(&format!("--end {} --out parts", first[0]));
    first[1..].iter().chain([&end]).for_each(|end| drop(run(&format!("--end {end} --resume parts"))));
    run(&format!("--end {end} --out whole"));
    assert_same(&folder.path().join("parts"), &folder.path().join("whole"), &format!("{model} {options} {first:?} {end}"));
}

#[test]
fn a_run_in_parts_has_the_bytes_of_an_unbroken_one() {
    for method in NAMED {
        in_parts(PAPER, &format!("--method {method} --no-report"), &["1"], "2");
    }
    let formats = if cfg!(feature = "parquet") { "--format csv --format npz --format parquet" } else { "--format csv --format npz" };
    in_parts("example:four-bar", formats, &["0.1", "0.25"], "0.4");
    in_parts("example:four-bar", "--format npz --no-report", &["0.1"], "0.3");
    in_parts("example:double-pendulum", "--set output.points=[\"m2\"]", &["0.1"], "0.3");
    in_parts("example:slider-crank", "--set output.reactions=true --every 7 --no-report", &["0.1", "0.15"], "0.3");
    in_parts("example:robot-arm", "--set output.reactions=false --no-report", &["0.1"], "0.3");
    // Bodies that share nodes have forces of joints that are found beside the run.
    in_parts("example:spatial-four-bar", "--no-report", &["0.1"], "0.3");
    in_parts("example:heavy-top", "--no-report", &["0.1"], "0.2");
    in_parts("example:rolling-disc", "--no-report", &["0.1"], "0.2");
    in_parts("example:flyball-governor", "--no-report", &["0.1"], "0.2");
}

/// What is noted of a run that goes on is that of the unbroken one: of two drives of one freedom, which is found at the start, of a pulse between two
/// steps that comes after the end of the first part, and of a contact of four steps in the middle of which the first part ends.
#[test]
fn a_run_in_parts_has_the_notes_of_an_unbroken_one() {
    let text = "[input.u]\n[point.ball]\nmass = 1\nposition = [0, 0, 5]\n\
                [force.pulse]\ntype = \"expression\"\npoint = \"ball\"\nforce = [\"10*step(t - 1.503)*step(1.507 - t)\", 0, 0]\n\
                [force.floor]\ntype = \"expression\"\npoint = \"ball\"\nforce = [0, 0, \"1e4*max(0, 0.105 - z)\"]\n\
                [body.a]\nmass = 1\ninertia = [0.1, 0.1, 0.1]\nposition = [1, 0, 0]\n\
                [body.b]\nmass = 1\ninertia = [0.1, 0.1, 0.1]\nposition = [-1, 0, 0]\n\
                [joint.left]\ntype = \"revolute\"\nbetween = [\"ground\", \"a\"]\nat = [0, 0, 0]\naxis = [0, 0, 1]\n\
                [joint.right]\ntype = \"revolute\"\nbetween = [\"ground\", \"b\"]\nat = [0, 0, 0]\naxis = [0, 0, 1]\n\
                [joint.gear]\ntype = \"gear\"\njoints = [\"left\", \"right\"]\nratio = 1\n\
                [drive.one]\ntype = \"angle\"\njoint = \"left\"\nprofile = \"t\"\n\
                [drive.two]\ntype = \"angle\"\njoint = \"right\"\nprofile = \"t\"\n\
                [simulation]\nend = 2\nstep = 0.01\n";
    let folder = folder();
    let path = folder.path().join("pulse.toml");
    fs::write(&path, text).unwrap();
    let model = path.to_str().unwrap();
    let summary = json(&folder, &format!("run {model} --no-report --json"));
    let notes = summary["notes"].to_string();
    assert!(
        notes.contains("lead the same freedom") && notes.contains("pulse") && notes.contains("`floor` for 4 steps at 1.02 s"),
        "{notes}"
    );
    in_parts(model, "--no-report", &["1"], "2");
}

/// Ends that are no whole number of steps, or are one but for rounding: the last step is shorter, and is taken once more.
#[test]
fn an_end_between_steps_leaves_no_trace() {
    for method in ["conserving-ggl", "radau", "trapezoidal", "generalized-alpha", "lagrange-2/bdf-2/velocity"] {
        in_parts(PAPER, &format!("--method {method} --step 0.1 --no-report"), &["0.3", "0.75", "0.76", "1.01"], "1.5");
        in_parts(PAPER, &format!("--method {method} --step 0.1 --every 3 --no-report"), &["0.05", "0.55", "0.67"], "1.45");
    }
}

#[test]
fn a_run_goes_on_in_its_folder_or_in_another() {
    let folder = folder();
    let at = |name: &str| folder.path().join(name);
    prints(&folder, &format!("run {PAPER} --end 1 --quiet --out a --format npz --format csv"), 0);
    let half = fs::read(at("a/trajectory.csv")).unwrap();
    prints(&folder, &format!("run {PAPER} --end 2 --quiet --resume a/checkpoint.json --out b"), 0);
    prints(&folder, &format!("run {PAPER} --end 2 --quiet --out whole"), 0);
    assert_same(&at("b"), &at("whole"), "another folder");
    assert_eq!(half, fs::read(at("a/trajectory.csv")).unwrap(), "the first stays as it is");
    // The report is of the whole run.
    assert!(fs::read_to_string(at("b/report.html")).unwrap().contains("80 steps"));
    // What is not asked for any more would be of the shorter run.
    let out = prints(&folder, &format!("run {PAPER} --end 2 --no-report --resume a --out ./a --force"), 0);
    assert!(out.ends_with("results in a\n"), "{out}");
    assert_eq!(files(at("a")), names(&["checkpoint.json", "columns.json", "summary.json", "trajectory.csv"]));
    assert_eq!(fs::read(at("a/trajectory.csv")).unwrap(), fs::read(at("whole/trajectory.csv")).unwrap());

    // In the folder itself, from another table to the usual one.
    let mut here = assert_cmd::Command::cargo_bin("holonom").unwrap();
    prints(&folder, &format!("run {PAPER} --end 1 --quiet --out c --format npz --no-report"), 0);
    here.current_dir(at("c")).args(["run", PAPER, "--end", "2", "--quiet", "--resume", "checkpoint.json"]).assert().success();
    assert_same(&at("c"), &at("whole"), "from another table");
    // A folder with results of another run is not one to go on in.
    let message = fails(&folder, &format!("run {PAPER} --end 3 --resume whole --out b"), 2);
    assert!(message.contains("b holds the results of another run") && message.contains("--force"), "{message}");
}

const CRANE: &str = "plane = \"xz\"\n[simulation]\nstep = 0.01\nend = 2\n[input.command]\ndefault = 2\n\
    [body.trolley]\nmass = 100\ninertia = 10\nposition = [0, 0]\n[body.load]\nmass = 300\ninertia = 30\nposition = [0.5, -5]\n\
    [joint.rail]\ntype = \"prismatic\"\nbetween = [\"ground\", \"trolley\"]\naxis = [1, 0]\n\
    [joint.pivot]\ntype = \"revolute\"\nbetween = [\"trolley\", \"load\"]\nat = [0, 0]\n\
    [force.controller]\ntype = \"effort\"\njoint = \"rail\"\neffort = \"80*(command - q) - 150*q_rate\"\n\
    [measure.sway]\nvalue = \"load.x - trolley.x\"\n[measure.most]\nvalue = \"max(abs(sway))\"\n\
    [measure.rms]\nvalue = \"rms(sway)\"\n[measure.sum]\nvalue = \"integral(sway)\"\n\
    [event.later]\nwhen = \"t - 0.555\"\nset = { command = 3 }\n";

#[test]
fn running_measures_and_inputs_that_were_set_go_on() {
    let file = std::env::temp_dir().join(format!("holonom-crane-{}.toml", std::process::id()));
    fs::write(&file, CRANE).unwrap();
    for method in ["conserving-ggl", "radau", "generalized-alpha"] {
        for options in ["--no-report", "--every 7 --no-report"] {
            let model = file.display();
            in_parts(
                &model.to_string(),
                &format!("--method {method} {options}"),
                &["0.3", "0.5", "0.55", "0.555", "0.56", "0.8123"],
                "1.5",
            );
        }
    }
    fs::remove_file(file).unwrap();
}

/// What is no number, or infinite, is written in a checkpoint and read again.
#[test]
fn running_measures_of_what_is_no_number_go_on() {
    let folder = folder();
    let text = "[point.m]\nmass = 1\nposition = [1, 0, 0]\nvelocity = [1, 0, 0]\n\
                [simulation]\nstep = 0.01\nend = 1\n\
                [measure.lost]\nvalue = \"max(sqrt(1.05 - m.x))\"\n\
                [measure.far]\nvalue = \"integral(1/max(0, m.x - 1.2))\"\n\
                [measure.least]\nvalue = \"min(-1/max(0, 1.1 - m.x))\"\n";
    let model = folder.path().join("m.toml");
    fs::write(&model, text).unwrap();
    in_parts(&model.display().to_string(), "--no-report", &["0.02", "0.3", "0.31"], "0.5");
}

/// An unbroken run to a later end does not pass it, either.
#[test]
fn an_event_that_ended_a_run_is_not_passed() {
    let folder = folder();
    // The third is a hair behind the end of a step, where the run ends.
    for (time, at, last) in [("0.5", "0.5", "2"), ("0.512", "0.512", "2"), ("0.500000001", "0.5", "2"), ("0.512", "0.512", "0.515")] {
        fs::write(folder.path().join("m.toml"), format!("{CRANE}[event.end]\nwhen = \"t - {time}\"\nstop = true\n")).unwrap();
        prints(&folder, &format!("run m.toml --end {last} --quiet --no-report --out a --force"), 0);
        let trajectory = |name: &str| fs::read(folder.path().join(name).join("trajectory.csv")).unwrap();
        if last == "2" {
            let before = trajectory("a");
            let message = fails(&folder, "run m.toml --end 3 --resume a", 2);
            assert!(message.contains(&format!("an event or a failed step ended at {at}")), "{message}");
            assert!(before == trajectory("a"), "{time} {last}");
        } else {
            // The last step was cut short before the event: it is taken again, and the event happens again.
            prints(&folder, "run m.toml --end 3 --quiet --no-report --resume a", 0);
            prints(&folder, "run m.toml --end 3 --quiet --no-report --out b", 0);
            assert!(trajectory("a") == trajectory("b"), "{time} {last}");
        }
    }
}

/// An event and the one that it causes, which ends the run, a hair before, at and behind the nominal time from which the run goes on: the last row is
/// what both left, also where the first part has written a row of that time.
#[test]
fn an_event_where_a_run_goes_on_ends_it_with_the_row_that_it_leaves() {
    let formats = if cfg!(feature = "parquet") { "--format csv --format npz --format parquet" } else { "--format csv --format npz" };
    for at in ["0.9999999999", "1", "1.0000000001", "1.005"] {
        for every in [1, 7] {
            let text = format!(
                "gravity = [0, 0, 0]\n[point.p]\nmass = 1\nposition = [0, 0, 0]\nvelocity = [1, 0, 0]\n[input.n]\n\
                 [event.a]\nwhen = \"p.x - {at}\"\nset = {{ n = 1 }}\n[event.b]\nwhen = \"n - 0.5\"\nstop = true\n\
                 [measure.most]\nvalue = \"max(n)\"\n[simulation]\nstep = 0.01\nend = 2\n[output]\nevery = {every}\n"
            );
            let folder = folder();
            fs::write(folder.path().join("m.toml"), text).unwrap();
            let run = |words: &str| prints(&folder, &format!("run m.toml {formats} --quiet {words}"), 0);
            run("--end 0.99 --out parts");
            // Where the event is before the end of the second part, that is the last.
            run("--end 1 --resume parts");
            if at.parse::<f64>().unwrap() > 1.0 {
                run("--end 2 --resume parts");
            }
            run("--end 2 --out whole");
            let of = format!("{at}, every {every}");
            let whole = fs::read_to_string(folder.path().join("whole/trajectory.csv")).unwrap();
            let last: Vec<&str> = whole.lines().last().unwrap().split(',').collect();
            assert_eq!(&last[last.len() - 2..], ["1", "1"], "{of}");
            let [one, other] = ["parts", "whole"].map(|name| fs::read_to_string(folder.path().join(name).join("trajectory.csv")).unwrap());
            assert_eq!(one, other, "{of}");
            if at.parse::<f64>().unwrap() > 1.0 {
                assert_same(&folder.path().join("parts"), &folder.path().join("whole"), &of);
            }
        }
    }
}
