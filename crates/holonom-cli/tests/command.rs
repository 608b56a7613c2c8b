//! The command as people type it: what it prints, what it writes, and the exit status it ends with.

use std::collections::BTreeSet;
use std::fs;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::path::Path;
use std::process::{Child, Command as Process, Output, Stdio};

use assert_cmd::Command;
use serde_json::Value;
use tempfile::TempDir;

const PAPER: &str = "example:spherical-compound-pendulum";
const COMMON: &str = "t,energy,kinetic,potential,work,dE_integrator,dE_projection,phi,phi_dot,phi_ddot,iterations";
const NAMED: [&str; 7] =
    ["conserving-ggl", "conserving", "conserving-projected", "trapezoidal-projected", "trapezoidal", "generalized-alpha", "radau"];

/// Runs the command in a folder; `words` are split at blanks.
fn holonom(folder: &TempDir, words: &str) -> Output {
    Command::cargo_bin("holonom").unwrap().current_dir(folder).args(words.split_whitespace()).output().unwrap()
}

/// Runs the command and hands back what it prints, after looking at its exit status.
#[track_caller]
fn prints(folder: &TempDir, words: &str, status: i32) -> String {
    let output = holonom(folder, words);
    let (out, err) = (text(&output.stdout), text(&output.stderr));
    assert_eq!(output.status.code(), Some(status), "{words}\n{out}\n{err}");
    out
}

/// Runs a command that fails and hands back its message.
#[track_caller]
fn fails(folder: &TempDir, words: &str, status: i32) -> String {
    let output = holonom(folder, words);
    let message = text(&output.stderr);
    assert_eq!(output.status.code(), Some(status), "{words}\n{message}");
    assert!(output.stdout.is_empty() && message.contains("error:") && !message.contains("panicked"), "{words}\n{message}");
    message
}

/// What a command prints, as JSON.
#[track_caller]
fn json(folder: &TempDir, words: &str) -> Value {
    let out = prints(folder, words, 0);
    serde_json::from_str(&out).unwrap_or_else(|error| panic!("{words}: {error}\n{out}"))
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).unwrap()
}

fn folder() -> TempDir {
    tempfile::tempdir().unwrap()
}

fn read_json(path: impl AsRef<Path>) -> Value {
    serde_json::from_slice(&fs::read(path).unwrap()).unwrap()
}

/// Header and rows of a table.
fn csv(path: impl AsRef<Path>) -> (String, Vec<Vec<f64>>) {
    let text = fs::read_to_string(path).unwrap();
    let mut lines = text.lines();
    let header = lines.next().unwrap().to_string();
    (header, lines.map(|line| line.split(',').map(|cell| cell.parse().unwrap()).collect()).collect())
}

/// Names of the files in a folder.
fn files(path: impl AsRef<Path>) -> BTreeSet<String> {
    fs::read_dir(path).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect()
}

fn names(names: &[&str]) -> BTreeSet<String> {
    names.iter().map(|name| name.to_string()).collect()
}

/// The keys of `summary.json`: additions are allowed, these must be there.
#[track_caller]
fn assert_summary(summary: &Value) {
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

#[test]
fn run_leaves_what_is_documented() {
    let folder = folder();
    let out = prints(&folder, &format!("run {PAPER} --end 0.5"), 0);
    for word in ["Spherical compound pendulum", "completed", "degrees of freedom", "drift", "results in"] {
        assert!(out.contains(word), "{word}\n{out}");
    }
    let results = folder.path().join("results/spherical-compound-pendulum-conserving-ggl");
    assert_eq!(files(&results), names(&["checkpoint.json", "report.html", "summary.json", "trajectory.csv"]));

    let summary = read_json(results.join("summary.json"));
    assert_summary(&summary);
    assert_eq!((&summary["status"], &summary["steps"], &summary["stopped_at"]), (&"completed".into(), &20.into(), &Value::Null));
    assert_eq!((&summary["coordinates"], &summary["constraints"], &summary["rank"]), (&6.into(), &5.into(), &4.into()));
    assert_eq!((&summary["redundant"], &summary["dof"]), (&1.into(), &2.into()));

    let (header, rows) = csv(results.join("trajectory.csv"));
    let of_points = "m1.x,m1.y,m1.z,m1.vx,m1.vy,m1.vz,m2.x,m2.y,m2.z,m2.vx,m2.vy,m2.vz";
    assert_eq!(header, format!("{COMMON},{of_points}"));
    assert_eq!(rows.len(), 21);
    assert_eq!(rows[0][0], 0.0);
    assert_eq!(&rows[0][11..17], [1.0, 0.0, 0.0, 0.0, 0.5, 0.0]);
    assert_eq!(rows[20][0], 0.5);

    let checkpoint = read_json(results.join("checkpoint.json"));
    assert_eq!(checkpoint["t"], 0.5);
    for (key, size) in [("x", 6), ("v", 6), ("a", 6), ("lambda", 5)] {
        assert_eq!(checkpoint[key].as_array().unwrap().len(), size, "{key}");
    }
    let end: Vec<f64> = checkpoint["x"].as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect();
    let last = [&rows[20][11..14], &rows[20][17..20]].concat();
    assert!(last.iter().zip(&end).all(|(a, b)| (a - b).abs() < 1e-15), "{last:?} {end:?}");

    let report = fs::read_to_string(results.join("report.html")).unwrap();
    assert!(report.contains("Spherical compound pendulum") && report.contains("inner-rod"));
}

#[test]
fn json_is_all_that_is_printed() {
    let folder = folder();
    let summary = json(&folder, &format!("run {PAPER} --end 0.1 --json --out a"));
    assert_summary(&summary);
    assert_eq!(summary, read_json(folder.path().join("a/summary.json")));
    assert_eq!(prints(&folder, &format!("run {PAPER} --end 0.1 --quiet --out b"), 0), "");
}

#[test]
fn formats_rows_and_report_are_chosen() {
    let folder = folder();
    prints(&folder, &format!("run {PAPER} --end 0.5 --out a --format npz --format csv --every 5 --no-report"), 0);
    let out = folder.path().join("a");
    assert_eq!(files(&out), names(&["checkpoint.json", "summary.json", "trajectory.csv", "trajectory.npz"]));
    let times: Vec<f64> = csv(out.join("trajectory.csv")).1.iter().map(|row| row[0]).collect();
    assert_eq!(times, [0.0, 0.125, 0.25, 0.375, 0.5]);
    assert!(fs::read(out.join("trajectory.npz")).unwrap().starts_with(b"PK"));

    prints(&folder, &format!("run {PAPER} --end 0.1 --out b --format npz --no-report"), 0);
    assert_eq!(files(folder.path().join("b")), names(&["checkpoint.json", "summary.json", "trajectory.npz"]));

    let message = fails(&folder, &format!("run {PAPER} --end 0.1 --out c --format xls"), 2);
    assert!(message.contains("xls") && message.contains("csv") && message.contains("npz"), "{message}");
    assert!(!folder.path().join("c").exists(), "nothing is begun for a format that is not there");
}

#[test]
fn output_says_which_points_and_rows() {
    let folder = folder();
    prints(&folder, &format!("run {PAPER} --end 0.5 --out a --set output.points=[\"m2\"] --set output.every=10"), 0);
    let (header, rows) = csv(folder.path().join("a/trajectory.csv"));
    assert_eq!(header, format!("{COMMON},m2.x,m2.y,m2.z,m2.vx,m2.vy,m2.vz"));
    assert_eq!((rows.len(), &rows[0][11..]), (3, &[2.0, 0.0, 0.0, 0.0, 1.0, 0.0][..]));

    prints(&folder, "run example:double-pendulum --end 0.1 --out b --set output.points=[\"m2\",\"m1\"]", 0);
    assert_eq!(csv(folder.path().join("b/trajectory.csv")).0, format!("{COMMON},m2.x,m2.y,m2.vx,m2.vy,m1.x,m1.y,m1.vx,m1.vy"));
}

#[test]
fn any_key_of_the_model_can_be_set() {
    let folder = folder();
    let summary = json(&folder, "run example:four-bar --end 0.1 --json --no-report --set parameters.N=3");
    assert_eq!((&summary["coordinates"], &summary["constraints"], &summary["dof"]), (&8.into(), &7.into(), &1.into()));
    let summary = json(&folder, "run example:four-bar --end 1/10 --step 1/N --json --no-report --set parameters.N=20");
    assert_eq!((&summary["step"], &summary["steps"]), (&0.05.into(), &2.into()));
    let summary = json(&folder, &format!("run {PAPER} --end 0.1 --json --no-report --set simulation.method=conserving"));
    assert_eq!(summary["method"]["name"], "conserving");
}

#[test]
fn a_run_that_stops_keeps_its_results() {
    let folder = folder();
    let words = "--set simulation.iteration=simultaneous --set simulation.penalty=1e7 --set simulation.tolerance=1e-9 \
                 --set simulation.subdivide=false";
    let out = prints(&folder, &format!("run {PAPER} --method trapezoidal {words} --out a"), 3);
    assert!(out.contains("stopped at"), "{out}");
    let results = folder.path().join("a");
    assert_eq!(files(&results), names(&["checkpoint.json", "report.html", "summary.json", "trajectory.csv"]));
    let summary = read_json(results.join("summary.json"));
    assert_summary(&summary);
    let at = summary["stopped_at"].as_f64().unwrap();
    assert_eq!(summary["status"], "stopped");
    assert!(at > 1.0 && at < 6.5, "{at}");
    assert!(!summary["reason"].as_str().unwrap().is_empty());
    let (_, rows) = csv(results.join("trajectory.csv"));
    assert_eq!(rows.len() as u64, summary["steps"].as_u64().unwrap() + 1);
    assert!((rows.last().unwrap()[0] - at).abs() < 1e-9);
}

#[test]
fn wrong_use_ends_with_two_and_says_what_there_is() {
    let folder = folder();
    let message = fails(&folder, &format!("run {PAPER} --method fast"), 2);
    NAMED.iter().for_each(|name| assert!(message.contains(name), "{message}"));
    for command in ["compare", "stability"] {
        assert!(fails(&folder, &format!("{command} {PAPER} --end 0.5 --method fast"), 2).contains("trapezoidal-projected"));
    }
    for (words, told) in [
        (format!("run {PAPER} --set simulation.step"), "no `=`"),
        (format!("run {PAPER} --set simulation.stp=1"), "did you mean `step`"),
        (format!("run {PAPER} --set title.x=1"), "not a table"),
        (format!("run {PAPER} --set simulation.step=-1"), "above 0"),
        (format!("run {PAPER} --step abc"), "abc"),
        (format!("run {PAPER} --end 0.5 --set simulation.integrator=euler"), "conserving-ggl"),
        (format!("check {PAPER} --set simulation.projection.matrix=unit"), "identity"),
        (format!("check {PAPER} --set simulation.projection.matrix=custom"), "weight"),
        ("run example:nothing".into(), "four-bar"),
        ("examples nothing".into(), "four-bar"),
        ("methods nothing".into(), "holonom methods"),
        (format!("run {PAPER} --every 0"), "--every"),
        (format!("run {PAPER} --nonsense"), "--nonsense"),
    ] {
        let message = fails(&folder, &words, 2);
        assert!(message.contains(told), "{words}\n{message}");
    }
    assert!(!folder.path().join("results").exists(), "nothing is written for wrong use");
}

#[test]
fn a_wrong_model_is_answered_with_every_fault() {
    let folder = folder();
    let model = "[point.a]\nmas = 1\nposition = [1, 0]\n\n[constraint.rod]\ntype = \"distance\"\nbetween = [\"ground\", \"b\"]\n";
    fs::write(folder.path().join("wrong.toml"), model).unwrap();
    for command in ["run", "check", "compare", "stability"] {
        let message = fails(&folder, &format!("{command} wrong.toml"), 2);
        for told in ["wrong.toml:2", "did you mean `mass`", "wrong.toml:3", "wrong.toml:7", "`b`"] {
            assert!(message.contains(told), "{told}\n{message}");
        }
    }
    fs::write(folder.path().join("broken.toml"), "[point.a\n").unwrap();
    assert!(fails(&folder, "run broken.toml", 2).contains("broken.toml:1"));
    let sound = "[point.a]\nmass = 1\nposition = [1, 0, 0]\n";
    fs::write(folder.path().join("short.toml"), sound).unwrap();
    assert!(fails(&folder, "run short.toml --end 1", 2).contains("--step"));
    assert!(fails(&folder, "run short.toml --step 0.1", 2).contains("--end"));
    prints(&folder, "run short.toml --step 0.1 --end 1", 0);
}

#[test]
fn files_that_cannot_be_used_end_with_four() {
    let folder = folder();
    fs::write(folder.path().join("file"), "").unwrap();
    for (words, told) in [
        ("run nothing.toml".to_string(), "cannot read nothing.toml"),
        ("check nothing.toml".into(), "cannot read nothing.toml"),
        (format!("run {PAPER} --end 0.1 --resume nothing.json"), "cannot read nothing.json"),
        (format!("run {PAPER} --end 0.1 --out file/results"), "cannot create file/results"),
        (format!("compare {PAPER} --end 0.1 --method conserving --out file/results"), "cannot create file/results"),
        ("examples chain --copy file/results".into(), "cannot create file/results"),
        ("view nothing".into(), "report.html"),
    ] {
        let message = fails(&folder, &words, 4);
        assert!(message.contains(told), "{words}\n{message}");
    }
}

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
    let expected: Vec<&str> = tables.iter().map(String::as_str).chain(["report.html", "summary.json"]).collect();
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
fn compare_shows_runs_that_stop() {
    let folder = folder();
    let words = "--method trapezoidal --method conserving --set simulation.subdivide=false --set simulation.iteration=simultaneous \
                 --set simulation.penalty=1e7 --set simulation.tolerance=1e-9 --end 7 --json --no-report";
    let all = json(&folder, &format!("compare {PAPER} {words}"));
    assert_eq!((&all[0]["status"], &all[1]["status"]), (&"stopped".into(), &"completed".into()));
}

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
fn check_says_what_a_model_is_made_of() {
    let folder = folder();
    let out = prints(&folder, &format!("check {PAPER}"), 0);
    for word in ["6 coordinates, 5 rows of rank 4", "2 degrees of freedom", "straight[", "singular", "residual", "(0, 0, -9.81) m/s²"] {
        assert!(out.contains(word), "{word}\n{out}");
    }
    let found = json(&folder, &format!("check {PAPER} --json"));
    assert_eq!((&found["rank"], &found["redundant"], &found["dof"]), (&4.into(), &1.into(), &2.into()));
    assert!(found["redundant_rows"][0].as_str().unwrap().starts_with("straight["));
    assert!(found["near_singular"].is_null() && found.get("projection").is_none());
    assert!(prints(&folder, &format!("check {PAPER} --set gravity=[0,0,0]"), 0).contains("none acts"));

    let model = "plane = \"xy\"\n[point.a]\nmass = 1\nposition = [1, 0]\n[point.b]\nmass = 1\nposition = [2, 0.003]\n\
                 [constraint.one]\ntype = \"distance\"\nbetween = [\"ground\", \"a\"]\n\
                 [constraint.two]\ntype = \"distance\"\nbetween = [\"a\", \"b\"]\n\
                 [constraint.three]\ntype = \"distance\"\nbetween = [\"ground\", \"b\"]\n";
    fs::write(folder.path().join("straight.toml"), model).unwrap();
    assert!(json(&folder, "check straight.toml --json")["near_singular"].is_array());
    assert!(prints(&folder, "check straight.toml", 0).contains("singular   yes"));
}

#[test]
fn only_the_mass_matrix_never_adds_energy() {
    let folder = folder();
    let heavy = "--set point.m2.mass=10 --projection";
    let projection = |matrix: &str| {
        let found = json(&folder, &format!("check {PAPER} {heavy} --json --set simulation.projection.matrix={matrix}"));
        found["projection"].clone()
    };
    let custom = |m1: f64, m2: f64| {
        let weights = format!("--set simulation.projection.weights.m1={m1} --set simulation.projection.weights.m2={m2}");
        projection(&format!("custom {weights}"))
    };
    let (mass, identity, like_mass, other) = (projection("mass"), projection("identity"), custom(1.0, 10.0), custom(3.0, 1.0));
    for (form, dissipative) in [(&mass, true), (&identity, false), (&like_mass, true), (&other, false)] {
        assert_eq!(form["dissipative"], dissipative, "{form}");
    }
    assert!((mass["condition"].as_f64().unwrap() - 1.0).abs() < 1e-9);
    assert!((identity["condition"].as_f64().unwrap() - 10.0).abs() < 1e-9);
    assert!((identity["growth_bound"].as_f64().unwrap() - 3.025).abs() < 1e-9);
    assert!(prints(&folder, &format!("check {PAPER} {heavy}"), 0).contains("never adds energy"));
    let out = prints(&folder, &format!("check {PAPER} {heavy} --set simulation.projection.matrix=identity"), 0);
    assert!(out.contains("can add energy"), "{out}");
}

#[test]
fn methods_are_listed_and_explained() {
    let folder = folder();
    let out = prints(&folder, "methods", 0);
    for word in NAMED.iter().chain(&["augmented-lagrangian", "penalty", "midpoint", "newton", "nested", "identity", "exact"]) {
        assert!(out.contains(word), "{word}\n{out}");
    }
    let one = prints(&folder, "methods midpoint", 0);
    assert!(one.contains("midpoint") && !one.contains("newmark"), "{one}");
}

#[test]
fn the_gallery_is_listed_shown_copied_and_runs() {
    let folder = folder();
    let list = prints(&folder, "examples", 0);
    let gallery = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples");
    for file in files(&gallery) {
        let name = file.strip_suffix(".toml").unwrap();
        assert!(list.contains(name), "{name} is not in the gallery\n{list}");
        let text = fs::read_to_string(gallery.join(&file)).unwrap();
        assert_eq!(prints(&folder, &format!("examples {name}"), 0), text);
        prints(&folder, &format!("examples {name} --copy copies"), 0);
        assert_eq!(fs::read_to_string(folder.path().join("copies").join(&file)).unwrap(), text);
        prints(&folder, &format!("check example:{name}"), 0);
        let summary = json(&folder, &format!("run copies/{file} --end 0.05 --json"));
        assert_eq!((&summary["status"], &summary["model"]), (&"completed".into(), &name.into()));
        assert!(summary["energy"]["max_drift"].as_f64().unwrap() < 1e-6, "{name}");
        let report = folder.path().join(format!("results/{name}-{}/report.html", summary["method"]["name"].as_str().unwrap()));
        assert!(report.is_file(), "{}", report.display());
    }
    fails(&folder, "examples --copy copies", 2);
}

#[test]
fn the_schema_is_json_and_knows_every_section() {
    let schema = json(&folder(), "schema");
    assert_eq!(schema["$schema"], "https://json-schema.org/draft/2020-12/schema");
    for section in ["title", "gravity", "plane", "parameters", "point", "bar", "constraint", "force", "simulation", "output"] {
        assert!(schema["properties"][section].is_object(), "{section}");
    }
}

/// The chapter of the book names every key and kind that the reader knows.
#[test]
fn the_model_file_chapter_is_complete() {
    let chapter = fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/model-file.md")).unwrap();
    let schema = json(&folder(), "schema");
    let mut known = BTreeSet::new();
    collect_keys(&schema, &mut known);
    assert!(known.contains("constraint_at") && known.contains("rest_length") && known.contains("point-on-plane"));
    let missing: Vec<&String> = known.iter().filter(|key| !chapter.contains(&format!("`{key}`"))).collect();
    assert!(missing.is_empty(), "docs/model-file.md does not name {missing:?}");
}

/// Names of all properties and of all kinds.
fn collect_keys(schema: &Value, known: &mut BTreeSet<String>) {
    if let Some(properties) = schema["properties"].as_object() {
        known.extend(properties.keys().cloned());
    }
    known.extend(schema["const"].as_str().map(str::to_string));
    match schema {
        Value::Object(table) => table.values().for_each(|value| collect_keys(value, known)),
        Value::Array(items) => items.iter().for_each(|value| collect_keys(value, known)),
        _ => (),
    }
}

/// Every example of the chapter is read, and what is marked as a whole model runs.
#[test]
fn the_models_of_the_chapter_are_sound() {
    let chapter = fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/model-file.md")).unwrap();
    let folder = folder();
    let models = chapter.split("```toml\n").skip(1).map(|rest| rest.split("```").next().unwrap());
    let mut count = 0;
    for (k, model) in models.enumerate() {
        fs::write(folder.path().join(format!("m{k}.toml")), model).unwrap();
        prints(&folder, &format!("run m{k}.toml --end 0.02 --step 0.01 --no-report"), 0);
        count += 1;
    }
    assert!(count >= 10, "{count}");
}

#[test]
fn a_resumed_run_ends_where_one_long_run_does() {
    for method in NAMED {
        let folder = folder();
        let run = |words: &str| prints(&folder, &format!("run {PAPER} --method {method} --quiet --no-report {words}"), 0);
        run("--end 1 --out half");
        run("--end 2 --out rest --resume half/checkpoint.json");
        run("--end 2 --out whole");
        let state = |name: &str| read_json(folder.path().join(name).join("checkpoint.json"));
        let (rest, whole) = (state("rest"), state("whole"));
        assert_eq!(rest["t"], 2.0);
        for key in ["x", "v"] {
            for (a, b) in rest[key].as_array().unwrap().iter().zip(whole[key].as_array().unwrap()) {
                let (a, b) = (a.as_f64().unwrap(), b.as_f64().unwrap());
                assert!((a - b).abs() < 1e-9, "{method} {key}: {a} {b}");
            }
        }
        let (_, rows) = csv(folder.path().join("rest/trajectory.csv"));
        assert_eq!((rows[0][0], rows.len()), (1.0, 41));
    }
}

#[test]
fn a_checkpoint_that_does_not_fit_is_refused() {
    let folder = folder();
    prints(&folder, &format!("run {PAPER} --end 1 --quiet --no-report --out a"), 0);
    fs::write(folder.path().join("no.json"), "{}").unwrap();
    for (words, told) in [
        ("run example:four-bar --end 2 --resume a/checkpoint.json".to_string(), "another model"),
        (format!("run {PAPER} --end 2 --resume no.json"), "no checkpoint"),
        (format!("run {PAPER} --end 0.5 --resume a/checkpoint.json"), "later --end"),
    ] {
        let message = fails(&folder, &words, 2);
        assert!(message.contains(told), "{words}\n{message}");
    }
}

/// A process that ends with its test.
struct Ends(Child);

impl Drop for Ends {
    fn drop(&mut self) {
        // It may have ended by itself; then there is nothing to end.
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

#[test]
fn view_serves_the_report_on_this_machine() {
    let folder = folder();
    prints(&folder, &format!("run {PAPER} --end 0.1 --quiet --out a"), 0);
    let mut process = Process::new(env!("CARGO_BIN_EXE_holonom"));
    let mut server = Ends(process.current_dir(&folder).args(["view", "a"]).stdout(Stdio::piped()).spawn().unwrap());
    let mut line = String::new();
    BufReader::new(server.0.stdout.take().unwrap()).read_line(&mut line).unwrap();
    let address = line.trim().strip_prefix("http://").unwrap_or_else(|| panic!("{line}"));
    assert!(address.starts_with("127.0.0.1:"), "{address}");
    let get = |path: &str| {
        let mut stream = TcpStream::connect(address).unwrap();
        write!(stream, "GET {path} HTTP/1.1\r\nHost: {address}\r\nConnection: close\r\n\r\n").unwrap();
        let mut answer = Vec::new();
        stream.read_to_end(&mut answer).unwrap();
        text(&answer)
    };
    let (page, missing) = (get("/"), get("/summary.json"));
    assert!(page.starts_with("HTTP/1.1 200") && page.contains("text/html"), "{}", &page[..page.len().min(300)]);
    assert!(page.ends_with(&fs::read_to_string(folder.path().join("a/report.html")).unwrap()) || page.contains("chunked"));
    assert!(missing.starts_with("HTTP/1.1 404"), "{missing}");
}
