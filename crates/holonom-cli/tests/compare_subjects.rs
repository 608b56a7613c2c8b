//! `holonom compare` of several models, variants, earlier results and measured data, and how far they are from the first.

mod common;

use std::fmt::Write;
use std::fs;

use common::*;
use serde_json::Value;
use tempfile::TempDir;

/// A mass of 1 kg on a spring of 1 m, let go at 1.1 m: x = 1 + 0.1 cos(ωt) with ω = √k.
const OSCILLATOR: &str = r#"
title = "Oscillator"
plane = "xy"
gravity = [0, 0]
[parameters]
k = 100
[point.m]
mass = 1.0
position = [1.1, 0]
[force.strut]
type = "spring"
between = ["ground", "m"]
stiffness = "k"
rest_length = 1.0
[simulation]
end = 2.0
step = 2e-3
method = "gauss"
order = 6
"#;

fn x(t: f64, k: f64) -> f64 {
    1.0 + 0.1 * (k.sqrt() * t).cos()
}

/// A folder with the oscillator, one of another spring, and what was measured of the first at other times.
fn prepared() -> TempDir {
    let folder = folder();
    fs::write(folder.path().join("a.toml"), OSCILLATOR).unwrap();
    fs::write(folder.path().join("b.toml"), OSCILLATOR.replace("k = 100", "k = 81")).unwrap();
    let mut text = "time,m.x,temperature\n".to_string();
    for n in 0..=70 {
        let t = 0.03 * f64::from(n) + 0.001;
        // 0.01 m too much at one time, no value at others.
        let value = if n % 7 == 3 { String::new() } else { (x(t, 100.0) + if n == 40 { 0.01 } else { 0.0 }).to_string() };
        writeln!(text, "{t},{value},20").unwrap();
    }
    fs::write(folder.path().join("measured.csv"), text).unwrap();
    folder
}

#[track_caller]
fn number(value: &Value, path: &str) -> f64 {
    value.pointer(path).and_then(Value::as_f64).unwrap_or_else(|| panic!("{path} in {value:#}"))
}

#[test]
fn models_results_and_measured_data_stand_side_by_side() {
    let folder = prepared();
    prints(&folder, "run b.toml --step 4e-3 --quiet --no-report --out results/old.run", 0);
    let words = "compare a.toml b.toml results/old.run measured.csv --columns m.x,strut.force --out all";
    let out = prints(&folder, words, 0);
    for told in ["a · b · old.run · measured", "difference", "to a", "m.x (m)", "strut.force (N)"] {
        assert!(out.contains(told), "{told}\n{out}");
    }
    let results = folder.path().join("all");
    assert_eq!(files(&results), names(&["a.csv", "b.csv", "columns.json", "report.html", "summary.json"]));
    let summaries = read_json(results.join("summary.json"));
    let labels: Vec<&str> = summaries.as_array().unwrap().iter().map(|one| one["label"].as_str().unwrap()).collect();
    assert_eq!(labels, ["a", "b", "old.run", "measured"]);
    assert_eq!((&summaries[0]["method"]["name"], &summaries[0]["differences"]), (&"ode/gauss-6".into(), &Value::Null));

    // Of the two models from the closed form, in steps so small that nothing is missed.
    let steps = || (0..=20_000).map(|n| 1e-4 * f64::from(n));
    let exact = |t: f64| (x(t, 81.0) - x(t, 100.0)).abs();
    let (largest, at) = steps().map(|t| (exact(t), t)).max_by(|a, b| a.0.total_cmp(&b.0)).unwrap();
    let rms = (steps().map(|t| exact(t) * exact(t)).sum::<f64>() / 20_000.0).sqrt();
    for k in [1, 2] {
        let found = |key: &str| number(&summaries[k], &format!("/differences/m.x/{key}"));
        assert!((found("largest") - largest).abs() < 1e-5 && (found("at") - at).abs() < 5e-3, "{summaries:#} {largest} {at}");
        // Straight between rows 4 ms apart, with 10 rad/s: (ωh)²/12 too little.
        assert!((found("rms") - rms).abs() < 2e-4 * rms, "{summaries:#} {rms}");
    }
    // At the time that is 0.01 m off; elsewhere the rows are met by cubics between the steps of the run.
    let found = |key: &str| number(&summaries[3], &format!("/differences/m.x/{key}"));
    assert!((found("largest") - 0.01).abs() < 1e-8 && (found("at") - 1.201).abs() < 1e-12, "{summaries:#}");
    assert!(summaries[3]["differences"].get("strut.force").is_none(), "it was not measured");

    let report = fs::read_to_string(results.join("report.html")).unwrap();
    for told in ["a · b · old.run · measured", "4 runs compared", "# a\n", "# b\n", "differences.m.x.largest"] {
        assert!(report.contains(told), "{told}");
    }
    if cfg!(feature = "viewer") {
        let (_, data) = report.split_once(r#"id="holonom-data">"#).unwrap();
        let data: Value = serde_json::from_str(data.split_once("</script>").unwrap().0).unwrap();
        assert_eq!(data["columns"], serde_json::json!(["m.x", "strut.force"]));
        for k in 0..4 {
            let channels = data["runs"][k]["channels"].as_array().unwrap();
            let unit = channels.iter().find(|channel| channel["name"] == "m.x").map(|channel| channel["unit"].as_str().unwrap());
            assert_eq!((unit, &data["runs"][k]["sound"]), (Some("m"), &true.into()), "{k}: a curve over the others");
        }
    }
}

/// Of what was measured the answers are told that its columns have.
#[test]
fn measured_data_have_answers() {
    let folder = prepared();
    fs::write(folder.path().join("c.toml"), format!("{OSCILLATOR}\n[measure.reach]\nvalue = \"m.x\"\nunit = \"m\"\n")).unwrap();
    fs::write(folder.path().join("rig.csv"), "t,reach,strut.force,m.vx\n0,1.1,-11,0\n0.1,1.2,7,1\n0.2,,8,2\n0.3,0.7,-9,3\n").unwrap();
    let out = prints(&folder, "compare c.toml rig.csv --no-report --out s", 0);
    let told = |answer: &str| out.lines().find(|line| line.starts_with(answer)).unwrap_or_else(|| panic!("no {answer}\n{out}")).to_string();
    for (answer, value) in
        [("reach least (m)", "0.7"), ("reach largest (m)", "1.2"), ("reach last (m)", "0.7"), ("strut largest (N)", "11")]
    {
        let line = told(answer);
        assert!(line.contains(&format!(" {value}")) && !line.contains('–'), "{line}");
    }
    let peaks = &read_json(folder.path().join("s/summary.json"))[1]["peaks"];
    assert_eq!(peaks["measures"][0]["max_at"], 0.1);
    assert_eq!((&peaks["forces"][0]["value"], &peaks["forces"][0]["at"]), (&(-11.0).into(), &0.0.into()));
}

#[test]
fn measured_times_in_other_units_are_noticed() {
    let folder = prepared();
    let rows: String = (0..=100).map(|n| format!("{n},{}\n", 3.0 * x(1e-3 * f64::from(n), 100.0))).collect();
    fs::write(folder.path().join("ms.csv"), format!("time,m.x\n{rows}")).unwrap();
    let out = prints(&folder, "compare a.toml ms.csv --columns m.x --no-report --out ms", 0);
    assert!(out.contains("rows of ms are at times that a has: times are in s"), "{out}");
    assert!(!prints(&folder, "compare a.toml measured.csv --columns m.x --no-report --out s", 0).contains("times are in s"));
}

/// A name that is spelled otherwise has no curve beside it.
#[test]
fn measured_data_that_nothing_is_beside_are_told() {
    let folder = prepared();
    fs::write(folder.path().join("rig.csv"), "time,M.x,temperature\n0,1.1,20\n1,1,20\n").unwrap();
    let noted = |words: &str| {
        let output = holonom(&folder, &format!("compare {words} --no-report --out rig --force"));
        assert!(output.status.success(), "{}", text(&output.stderr));
        text(&output.stderr)
    };
    let told = noted("a.toml rig.csv");
    assert!(told.contains("nothing is beside the columns of rig") && told.contains("did you mean `m.x` by `M.x`?"), "{told}");
    assert_eq!((noted("a.toml measured.csv"), noted("a.toml rig.csv --quiet"), noted("measured.csv")), Default::default());
    // Nor has one at other times.
    fs::write(folder.path().join("late.csv"), "t,m.x\n3,1.1\n4,1\n").unwrap();
    let out = prints(&folder, "compare a.toml late.csv --no-report --out late", 0);
    assert!(out.contains("only 0 of 2 rows of late are at times that a has"), "{out}");
}

#[test]
fn a_model_of_standard_input_has_a_name() {
    let folder = prepared();
    let mut command = assert_cmd::Command::cargo_bin("holonom").unwrap();
    let words = "compare - --method radau --method gauss --end 0.1 --no-report";
    let output = command.current_dir(&folder).args(words.split(' ')).write_stdin(OSCILLATOR).output().unwrap();
    assert!(output.status.success(), "{}", text(&output.stderr));
    assert_eq!(files(folder.path().join("results")), names(&["stdin-compare"]));
}

/// Where the table of a run has some columns only, or another format, the recording beside it has all.
#[test]
fn a_folder_has_all_columns_whatever_its_table_has() {
    let folder = prepared();
    for (k, with) in ["--format npz", "--set output.columns=[\"strut.*\"]"].iter().enumerate() {
        prints(&folder, &format!("run a.toml --quiet --no-report {with} --out old{k}"), 0);
        let all = json(&folder, &format!("compare a.toml old{k} --columns m.x --json --no-report --out c{k}"));
        assert_eq!(number(&all[1], "/differences/m.x/largest"), 0.0, "{all:#}");
    }
    fs::remove_file(folder.path().join("old0/summary.json")).unwrap();
    let message = fails(&folder, "compare a.toml old0", 2);
    assert!(message.contains("old0 has no summary.json") && message.contains("name old0/recording.csv"), "{message}");
}

#[test]
fn variants_are_further_runs_of_each_model() {
    let folder = prepared();
    let labels = |words: &str| -> Vec<String> {
        let all = json(&folder, &format!("compare {words} --json --no-report --set simulation.end=0.1 --out v --force"));
        all.as_array().unwrap().iter().map(|one| one["label"].as_str().unwrap().to_string()).collect()
    };
    assert_eq!(
        labels("a.toml --variant parameters.k=50,point.m.mass=0.5 --variant parameters.k=49"),
        ["a", "parameters.k=50,point.m.mass=0.5", "parameters.k=49"]
    );
    assert_eq!(
        labels("a.toml b.toml --variant point.m.position=[1.2,0] --method radau --method gauss")[2..6],
        ["a, point.m.position=[1.2,0], radau", "a, point.m.position=[1.2,0], gauss", "b, radau", "b, gauss"]
    );
    assert_eq!(labels("a.toml b.toml --step 1e-2 --step 2e-2"), ["a, 0.01 s", "a, 0.02 s", "b, 0.01 s", "b, 0.02 s"]);
    assert_eq!(labels("a.toml a.toml"), ["a.toml", "a.toml (2)"]);
    // The same frequency: half the mass on half the spring.
    let words = "compare a.toml --variant parameters.k=50,point.m.mass=0.5 --columns m.x,strut.force --json --no-report --out w";
    let all = json(&folder, words);
    assert!(number(&all[1], "/differences/m.x/largest") < 1e-12, "{all:#}");
    assert!((number(&all[1], "/differences/strut.force/largest") - 5.0).abs() < 1e-9, "{all:#}");
}

#[test]
fn results_and_measured_data_are_enough_without_a_model() {
    let folder = prepared();
    prints(&folder, "run a.toml --quiet --no-report --out old", 0);
    let all = json(&folder, "compare measured.csv old --columns m.x --json");
    assert!((number(&all[1], "/differences/m.x/largest") - 0.01).abs() < 1e-8, "{all:#}");
    assert_eq!(files(folder.path().join("results/measured-compare")), names(&["report.html", "summary.json"]));
    // What a run said of itself is still there.
    assert_eq!((&all[1]["status"], &all[1]["label"], &all[1]["steps"]), (&"completed".into(), &"old".into(), &1000.into()));
}

/// What was measured is not a result, although a curve is called like its file; a table is one, whatever its run is called.
#[test]
fn measured_data_in_the_folder_of_the_results_stay() {
    let folder = prepared();
    fs::create_dir(folder.path().join("rig")).unwrap();
    fs::rename(folder.path().join("measured.csv"), folder.path().join("rig/measured.csv")).unwrap();
    let all = |more: &str| prints(&folder, &format!("compare a.toml rig/measured.csv b.toml {more} --quiet --no-report --out rig"), 0);
    all("--end 0.2");
    assert_eq!(files(folder.path().join("rig")), names(&["a.csv", "b.csv", "columns.json", "measured.csv", "summary.json"]));
    prints(&folder, "compare a.toml rig/measured.csv --end 0.1 --quiet --no-report --out rig --force", 0);
    assert_eq!(files(folder.path().join("rig")), names(&["a.csv", "columns.json", "measured.csv", "summary.json"]));

    // Neither are tables written over other files.
    fs::write(folder.path().join("a.csv"), "mine").unwrap();
    let message = fails(&folder, "compare a.toml b.toml --end 0.1 --out . --force", 2);
    assert!(message.contains("over ./a.csv, which is no result") && message.contains("--out"), "{message}");
    assert_eq!(fs::read(folder.path().join("a.csv")).unwrap(), b"mine");

    // A name of 640 letters.
    let variant = (1..=40).map(|n| format!("parameters.k={n}")).collect::<Vec<_>>().join(",");
    all(&format!("--end 0.1 --force --variant {variant}"));
    let found = files(folder.path().join("rig"));
    assert_eq!(found.iter().filter(|name| name.ends_with(".csv")).count(), 5, "{found:?}");
}

#[test]
fn what_cannot_be_compared_is_refused_before_anything_runs() {
    let folder = prepared();
    fs::create_dir(folder.path().join("empty")).unwrap();
    for (name, text) in [
        ("words.csv", "t,m.x\n0,1\n1,one\n"),
        ("backwards.csv", "t,m.x\n1,1\n0,1\n"),
        ("german.csv", "t;m.x\n0,0;1,0\n"),
        ("tabs.csv", "t\tm.x\n0\t1\n1\t2\n"),
        ("windows.csv", "t,m.x\r\n\r\n0,1\r\n1,one\r\n"),
        ("uneven.csv", "t,m.x\n0,1\n1\n"),
        ("short.csv", "t,m.x\n0,1\n"),
        ("nameless.csv", "0,1\n1,2\n2,\n"),
    ] {
        fs::write(folder.path().join(name), text).unwrap();
    }
    for (words, told) in [
        ("a.toml words.csv", "line 3 has `one` in the column `m.x`"),
        ("a.toml backwards.csv", "line 3 is not after"),
        ("a.toml german.csv", "put commas between columns"),
        ("a.toml tabs.csv", "put commas between columns"),
        ("a.toml windows.csv", "line 4 has `one` in the column `m.x`"),
        ("a.toml uneven.csv", "line 3 has 1 cells"),
        ("a.toml short.csv", "1 row,"),
        ("a.toml nameless.csv", "numbers where the names of the columns should be"),
        ("a.toml empty", "not the folder of a run"),
        ("a.toml b.toml --columns m.xx", "did you mean `m.x`"),
        ("a.toml measured.csv --columns strut.force", "only `a` has a column `strut.force`"),
        ("measured.csv a.toml --columns strut.force", "there is no column `strut.force`"),
        ("a.toml b.toml --columns m.x,m.x", "twice"),
        ("a.toml --method radau --columns m.x", "one run only"),
        ("a.toml --variant k", "`k` in --variant has no `=`"),
        ("a.toml --variant parameters.k=1,,point.m.mass=2", "`` in --variant has no `=`"),
        ("a.toml --variant simulation.step=0.1 --step 0.2", "both set `simulation.step`"),
        ("a.toml --variant simulation.method=radau --method bdf", "both set `simulation.method`"),
        ("a.toml --variant point.n.mass=1", "`n`"),
        ("measured.csv --step 0.1", "nothing is run"),
        ("measured.csv measured.csv --variant parameters.k=1", "nothing is run"),
        ("measured.csv measured.csv --every 4", "--every is for runs"),
        ("measured.csv measured.csv --format npz", "--format is for runs"),
    ] {
        let message = fails(&folder, &format!("compare {words}"), 2);
        assert!(message.contains(told) && message.contains("cure"), "{words}\n{message}");
    }
    // What a kill leaves of a run's table: the last row has not all of its digits.
    prints(&folder, "run a.toml --quiet --no-report --out torn", 0);
    let table = folder.path().join("torn/trajectory.csv");
    let whole = fs::read(&table).unwrap();
    fs::write(&table, &whole[..whole.len() - 3]).unwrap();
    for torn in ["torn", "torn/trajectory.csv"] {
        let message = fails(&folder, &format!("compare a.toml {torn}"), 2);
        assert!(message.contains("cut off within its last row") && message.contains("cure"), "{message}");
    }
    fails(&folder, "compare a.toml missing.csv", 4);
    fails(&folder, "compare missing.toml b.toml", 4);
    assert!(!folder.path().join("results").exists());
}
