//! `holonom run --resume`: what was ended or killed goes on as if nothing had been, and nothing goes on from another run.

mod common;

use std::fs;
use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Child, Command as Process, Stdio};
use std::time::{Duration, Instant};

use common::*;
use serde_json::Value;

/// Fails where files of two folders differ, other than in what tells when the run was, how it was typed and what it took.
#[track_caller]
fn assert_same(one: &Path, other: &Path, what: &str) {
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

/// The errors that are allowed in a step depend on the length of the run.
#[test]
fn a_run_by_accuracy_is_noted_to_differ() {
    let folder = folder();
    let words = format!("run {PAPER} --accuracy 1e-4 --no-report");
    prints(&folder, &format!("{words} --end 1 --out a"), 0);
    let output = holonom(&folder, &format!("{words} --end 2 --resume a"));
    assert!(output.status.success() && text(&output.stderr).contains("an accuracy is that of the whole run"), "{}", text(&output.stderr));
    // Without a step, it follows from the end.
    let words = "run example:double-pendulum --set simulation.accuracy=1e-4 --no-report --quiet";
    fs::write(folder.path().join("model.toml"), prints(&folder, "examples double-pendulum", 0).replace("\nstep", "\n# step")).unwrap();
    let words = words.replace("example:double-pendulum", "model.toml");
    prints(&folder, &format!("{words} --end 1 --out b"), 0);
    let message = fails(&folder, &format!("{words} --end 2 --resume b"), 2);
    assert!(
        message.contains("`simulation.step` was 0.005 and is 0.01") && message.contains("give --step 0.005, which followed from"),
        "{message}"
    );
    prints(&folder, &format!("{words} --end 2 --step 0.005 --resume b"), 0);
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

#[test]
fn another_run_is_refused_with_what_differs() {
    let folder = folder();
    let model = prints(&folder, "examples four-bar", 0);
    fs::write(folder.path().join("m.toml"), &model).unwrap();
    prints(&folder, "run m.toml --set parameters.N=2 --end 0.1 --quiet --no-report --out a", 0);
    let before: Vec<Vec<u8>> =
        files(folder.path().join("a")).iter().map(|name| fs::read(folder.path().join("a").join(name)).unwrap()).collect();
    fs::write(folder.path().join("no.json"), "{}").unwrap();
    fs::write(folder.path().join("torn.json"), "{\"provenance\": {").unwrap();
    let edit = |name: &str, from: &str, to: &str| {
        let text = fs::read_to_string(folder.path().join("a/checkpoint.json")).unwrap();
        assert!(text.contains(from), "{from}");
        fs::write(folder.path().join(name), text.replacen(from, to, 1)).unwrap();
    };
    let version = format!("\"version\":\"{}\"", env!("CARGO_PKG_VERSION"));
    edit("version.json", &version, "\"version\":\"0.0.7\"");
    edit("build.json", "\"a_squares\"", "\"squares\"");
    edit("old.json", "\"provenance\":{", "\"origin\":{");
    edit("rows.json", "\"rows\":11", "\"rows\":12");
    fs::copy(folder.path().join("a/trajectory.csv"), folder.path().join("trajectory.csv")).unwrap();
    fs::write(folder.path().join("heavy.toml"), model.replace("mass = 1", "mass = 3")).unwrap();
    for (words, told) in [
        ("m.toml --end 0.2 --resume a", vec!["`parameters.N` was 2 and is 1", "without --resume"]),
        ("m.toml --end 0.2 --set parameters.N=3 --resume a", vec!["`parameters.N` was 2 and is 3"]),
        ("m.toml --end 0.2 --set parameters.N=2 --step 0.02 --resume a", vec!["`simulation.step` was 0.01 and is 0.02"]),
        ("m.toml --end 0.2 --set parameters.N=2 --every 2 --resume a", vec!["`output.every` was 1 and is 2"]),
        ("m.toml --end 0.2 --set parameters.N=2 --method radau --resume a", vec!["the method was \"conserving-ggl\" and is \"radau\""]),
        (
            "m.toml --end 0.2 --set parameters.N=2 --set simulation.tolerance=1e-9 --resume a",
            vec!["`simulation.tolerance` was not there and is 1e-9"],
        ),
        (
            "m.toml --end 0.2 --set parameters.N=2 --set output.reactions=true --resume a",
            vec!["`output.reactions` was not there and is true"],
        ),
        ("heavy.toml --end 0.2 --set parameters.N=2 --resume a", vec!["mass", "and is 3"]),
        (&format!("{PAPER} --end 0.2 --resume a"), vec!["`parameters.N` was 2 and is not there", " more"]),
        ("m.toml --set parameters.N=2 --end 0.05 --resume a", vec!["a/checkpoint.json is at 0.1 s", "later --end"]),
        ("m.toml --set parameters.N=2 --end 0.1 --resume a", vec!["later --end"]),
        ("m.toml --set parameters.N=2 --end 0.2 --resume no.json", vec!["no.json is no checkpoint"]),
        ("m.toml --set parameters.N=2 --end 0.2 --resume torn.json", vec!["torn.json is no checkpoint"]),
        ("m.toml --set parameters.N=2 --end 0.2 --resume version.json", vec!["is of version 0.0.7, and this is"]),
        (
            "m.toml --set parameters.N=2 --end 0.2 --resume build.json",
            vec!["build.json was written by another build of holonom", "`a_squares`", "or with the build of holonom that wrote it"],
        ),
        ("m.toml --set parameters.N=2 --end 0.2 --resume old.json", vec!["is of a version before"]),
        ("m.toml --set parameters.N=2 --end 0.2 --resume rows.json", vec!["trajectory.csv has not the 12 rows", "row 12 is missing"]),
    ] {
        let message = fails(&folder, &format!("run {words}"), 2);
        told.iter().for_each(|told| assert!(message.contains(told), "{words}: {told}\n{message}"));
    }
    let after: Vec<Vec<u8>> =
        files(folder.path().join("a")).iter().map(|name| fs::read(folder.path().join("a").join(name)).unwrap()).collect();
    assert!(before == after, "nothing is touched");
    // Comments, the title, and how a number was given do not matter.
    fs::write(folder.path().join("m.toml"), model.replace("N = 1", "N = 2").replace("title = \"", "# More.\ntitle = \"My ")).unwrap();
    prints(&folder, "run m.toml --end 0.2 --quiet --no-report --resume a", 0);

    // Two points that change places would change their numbers with each other.
    let point = |name: &str, x: u32| format!("[point.{name}]\nmass = 1\nposition = [{x}, 0, 0]\n");
    let end = "[simulation]\nstep = 0.1\nend = 1\n";
    fs::write(folder.path().join("two.toml"), [point("a", 1), point("b", 2), end.into()].concat()).unwrap();
    prints(&folder, "run two.toml --quiet --no-report --out two", 0);
    fs::write(folder.path().join("two.toml"), [point("b", 2), point("a", 1), end.into()].concat()).unwrap();
    assert!(fails(&folder, "run two.toml --end 2 --resume two", 2).contains("another order"));
}

/// An unbroken run stops there, too, and so must one that goes on.
#[test]
fn a_run_that_stopped_of_itself_stays_stopped() {
    let folder = folder();
    let words = format!(
        "run {PAPER} --method trapezoidal --set simulation.iteration=simultaneous --set simulation.penalty=1e7 \
                         --set simulation.tolerance=1e-9 --set simulation.subdivide=false --no-report --quiet"
    );
    prints(&folder, &format!("{words} --out a"), 3);
    prints(&folder, &format!("{words} --end 25 --resume a"), 3);
    prints(&folder, &format!("{words} --end 25 --out whole"), 3);
    // Attempts at the step that fails are counted each time, so only the table is the same.
    let [a, whole] = ["a", "whole"].map(|name| fs::read(folder.path().join(name).join("trajectory.csv")).unwrap());
    assert!(a == whole);
    // Too small an error for so long a run: the last step is left in its midst.
    let words = "run example:double-pendulum --set simulation.accuracy=1e-6 --no-report --quiet --step 0.01 --end 2500";
    prints(&folder, &format!("{words} --out b"), 3);
    let message = fails(&folder, &format!("{words} --resume b"), 2);
    assert!(message.contains("an event or a failed step ended at "), "{message}");
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

#[test]
fn a_table_that_was_changed_is_refused_and_is_another_run() {
    let folder = folder();
    let model = "[table.law]\nfile = \"law.csv\"\n[point.p]\nmass = 1\nposition = [0, 0, 1]\n\
                 [force.f]\ntype = \"spring\"\nbetween = [\"ground\", \"p\"]\nstiffness = 1\nforce = \"law(rate)\"\n\
                 [simulation]\nstep = 0.01\nend = 0.1\n";
    fs::write(folder.path().join("m.toml"), model).unwrap();
    for (number, law) in ["v,f\n-1,-1\n1,1\n", "v,f\n-1,-2\n1,2\n"].iter().enumerate() {
        fs::write(folder.path().join("law.csv"), law).unwrap();
        if number == 1 {
            assert!(fails(&folder, "run m.toml --end 1 --resume results/m-conserving-ggl", 2).contains("the file `law.csv` was changed"));
        }
        prints(&folder, "run m.toml --quiet --no-report", 0);
        assert_eq!(files(folder.path().join("results")).len(), number + 1);
    }
}

#[test]
fn a_mesh_that_was_changed_is_refused() {
    let folder = folder();
    let solid = |size: u32| format!("v 0 0 0\nv {size} 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
    let model = "[body.b]\nposition = [0, 0, 0]\ndensity = 1000\nshape = { mesh = \"part.obj\" }\n[simulation]\nstep = 0.1\nend = 0.2\n";
    fs::write(folder.path().join("model.toml"), model).unwrap();
    fs::write(folder.path().join("part.obj"), solid(1)).unwrap();
    prints(&folder, "run model.toml --quiet --no-report --out a", 0);
    fs::write(folder.path().join("part.obj"), solid(2)).unwrap();
    assert!(fails(&folder, "run model.toml --end 1 --resume a", 2).contains("the file `part.obj` was changed"));
}

/// Starts a run that takes long and waits until it has been saved and has come beyond `t` (s).
fn at_work(folder: &Path, words: &str, t: f64) -> Child {
    let mut process = Process::new(env!("CARGO_BIN_EXE_holonom"));
    let child = process.current_dir(folder).arg("run").args(words.split_whitespace()).spawn().unwrap();
    let begun = Instant::now();
    let is_beyond = || reached(&folder.join("a")).is_some_and(|reached| reached > t);
    while !is_beyond() && begun.elapsed() < Duration::from_secs(120) {
        std::thread::sleep(Duration::from_millis(20));
    }
    child
}

/// The time of the checkpoint in a folder, s.
fn reached(folder: &Path) -> Option<f64> {
    let value: Value = serde_json::from_slice(&fs::read(folder.join("checkpoint.json")).ok()?).unwrap();
    value["state"]["t"].as_f64()
}

/// As where a run is interrupted that was interrupted later before.
/// A kill may come after the last step.
#[test]
fn a_run_that_was_killed_before_its_results_were_written_writes_them() {
    let folder = folder();
    for (words, without) in [("--end 2", "summary.json"), ("--end 0.33 --format npz", "trajectory.npz")] {
        let run = |more: &str| prints(&folder, &format!("run {PAPER} {words} --quiet {more}"), 0);
        let [parts, whole] = ["parts", "whole"].map(|name| format!("{name}-of-{without}"));
        run(&format!("--out {parts}"));
        run(&format!("--out {whole}"));
        for name in ["summary.json", "report.html", without] {
            let _ = fs::remove_file(folder.path().join(&parts).join(name));
        }
        fs::write(folder.path().join(&parts).join("report.html.new"), "<html").unwrap();
        run(&format!("--resume {parts}"));
        assert_same(&folder.path().join(&parts), &folder.path().join(&whole), words);
    }
}

/// Files that may not grow beyond a size stand for a full disk.
#[cfg(unix)]
#[test]
fn a_resumed_run_that_cannot_be_written_leaves_the_rows_up_to_its_checkpoint() {
    let folder = folder();
    let run = |more: &str| prints(&folder, &format!("run {PAPER} --quiet {more}"), 0);
    run("--end 1 --out a");
    let out = folder.path().join("a");
    let (table, checkpoint) = (fs::read(out.join("trajectory.csv")).unwrap(), fs::read(out.join("checkpoint.json")).unwrap());
    // The limit is in blocks of 512 bytes, and ends within the rows to come.
    let command = format!(
        "trap '' XFSZ; ulimit -f {}; exec {} run {PAPER} --quiet --end 3 --resume a",
        table.len() / 512 + 8,
        env!("CARGO_BIN_EXE_holonom")
    );
    let output = Process::new("sh").current_dir(&folder).args(["-c", &command]).output().unwrap();
    let message = text(&output.stderr);
    assert!(output.status.code().is_some_and(|code| code != 0) && message.contains("cannot write"), "{message}");
    assert_eq!(files(&out), names(&["checkpoint.json", "columns.json", "trajectory.csv"]));
    assert!(fs::read(out.join("trajectory.csv")).unwrap() == table && fs::read(out.join("checkpoint.json")).unwrap() == checkpoint);
    run("--end 3 --resume a");
    run("--end 3 --out whole");
    assert_same(&out, &folder.path().join("whole"), "after a full disk");
}

#[test]
fn a_shorter_part_of_a_run_does_not_replace_a_longer_one() {
    let folder = folder();
    let out = folder.path().join("a");
    prints(&folder, &format!("run {PAPER} --end 1 --quiet --out a"), 0);
    let mut checkpoint = read_json(out.join("checkpoint.json"));
    checkpoint["state"]["t"] = 7.5.into();
    fs::write(out.join("checkpoint.json"), checkpoint.to_string()).unwrap();
    let content = || -> Vec<Vec<u8>> { files(&out).iter().map(|name| fs::read(out.join(name)).unwrap()).collect() };
    let before = content();
    let output = holonom(&folder, &format!("run {PAPER} --end 1 --out a"));
    assert_eq!((output.status.code(), text(&output.stderr).as_str()), (Some(0), "note: a holds the same run up to 7.5 s, which stays\n"));
    assert!(before == content());
}

#[test]
fn a_run_that_was_killed_or_interrupted_goes_on_to_the_same_bytes() {
    let folder = folder();
    let out = folder.path().join("a");
    let words = format!("{PAPER} --every 50 --quiet --no-report --set simulation.step=0.01");
    let long = "--end 1e9";
    let mut child = at_work(folder.path(), &format!("{words} {long} --out a"), 0.0);
    // While it is at work nobody else goes on from there, or writes there.
    for other in ["--resume a", "--out a --force"] {
        assert!(fails(&folder, &format!("run {words} {long} {other}"), 2).contains("another run is writing to a"));
    }
    child.kill().unwrap();
    child.wait().unwrap();
    assert_eq!(files(&out), names(&["checkpoint.json", "columns.json", "trajectory.csv"]));
    let killed = reached(&out).unwrap();
    // A run from the start may take the folder, but as long as it is behind, what is there stays.
    let before = fs::read(out.join("checkpoint.json")).unwrap();
    let mut process = Process::new(env!("CARGO_BIN_EXE_holonom"));
    let again = format!("run {words} {long} --out a").replace("--quiet ", "");
    let mut child =
        process.current_dir(&folder).args(again.split_whitespace()).stderr(Stdio::piped()).stdout(Stdio::null()).spawn().unwrap();
    let mut note = String::new();
    BufReader::new(child.stderr.take().unwrap()).read_line(&mut note).unwrap();
    assert!(
        note.starts_with("note: a holds this run up to ") && note.ends_with("where it was killed; --resume a goes on from there\n"),
        "{note}"
    );
    child.kill().unwrap();
    child.wait().unwrap();
    assert_eq!(before, fs::read(out.join("checkpoint.json")).unwrap());

    // Every whole line can be read, and a kill may tear the last one.
    let mut table = fs::read(out.join("trajectory.csv")).unwrap();
    assert!(table.iter().filter(|&&byte| byte == b'\n').count() as f64 > killed / 0.5);
    table.extend(b"1.5,2.");
    fs::write(out.join("trajectory.csv"), table).unwrap();

    let mut child = at_work(folder.path(), &format!("{words} {long} --resume a"), killed);
    Process::new("sh").args(["-c", &format!("kill -INT {}", child.id())]).status().unwrap();
    assert_eq!(child.wait().unwrap().code(), Some(3));
    assert_eq!(read_json(out.join("summary.json"))["status"], "stopped");
    let interrupted = reached(&out).unwrap();
    assert!(interrupted > killed && killed > 0.0);

    let end = interrupted.ceil() + 5.0;
    prints(&folder, &format!("run {words} --end {end} --resume a"), 0);
    prints(&folder, &format!("run {words} --end {end} --out whole"), 0);
    assert_same(&out, &folder.path().join("whole"), "killed");
}
