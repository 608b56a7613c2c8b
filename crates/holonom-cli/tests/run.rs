//! `holonom run`: what it prints, what it leaves, and how it goes on.

mod common;

use std::fs;

use common::*;
use serde_json::Value;

/// What the constraints of the paper's pendulum exert.
const OF_ROWS: &str = "inner-rod.force,outer-rod.force,straight.m1.fx,straight.m1.fy,straight.m1.fz,straight.m2.fx,straight.m2.fy,straight.m2.fz,\
                       straight.m1.f,straight.m2.f";

#[test]
fn run_leaves_what_is_documented() {
    let folder = folder();
    let out = prints(&folder, &format!("run {PAPER} --end 0.5"), 0);
    for word in ["Spherical compound pendulum", "completed", "degrees of freedom", "drift", "results in"] {
        assert!(out.contains(word), "{word}\n{out}");
    }
    let results = folder.path().join("results/spherical-compound-pendulum-conserving-ggl");
    assert_eq!(files(&results), names(&["checkpoint.json", "columns.json", "report.html", "summary.json", "trajectory.csv"]));

    let summary = read_json(results.join("summary.json"));
    assert_summary(&summary);
    assert_eq!((&summary["status"], &summary["steps"], &summary["stopped_at"]), (&"completed".into(), &20.into(), &Value::Null));
    assert_eq!((&summary["coordinates"], &summary["constraints"], &summary["rank"]), (&6.into(), &5.into(), &4.into()));
    assert_eq!((&summary["redundant"], &summary["dof"]), (&1.into(), &2.into()));

    let (header, rows) = csv(results.join("trajectory.csv"));
    let of_points = "m1.x,m1.y,m1.z,m1.vx,m1.vy,m1.vz,m2.x,m2.y,m2.z,m2.vx,m2.vy,m2.vz";
    let accelerations = "m1.ax,m1.ay,m1.az,m2.ax,m2.ay,m2.az";
    assert_eq!(header, format!("{COMMON},{of_points},{accelerations},{OF_ROWS}"));
    assert_eq!(rows.len(), 21);
    assert_eq!(rows[0][0], 0.0);
    assert_eq!(&rows[0][11..17], [1.0, 0.0, 0.0, 0.0, 0.5, 0.0]);
    assert_eq!(rows[20][0], 0.5);

    let checkpoint = &read_json(results.join("checkpoint.json"))["state"];
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
fn what_was_run_stands_with_the_results() {
    let folder = folder();
    let text = prints(&folder, "examples four-bar", 0);
    fs::write(folder.path().join("four bar.toml"), &text).unwrap();
    let words = ["run", "four bar.toml", "--set", "parameters.N=3", "--set", "parameters.N=1+1", "--set", "output.reactions=true"];
    let more = ["--step", "0.02", "--end", "0.1", "--method", "conserving", "--every", "2", "--quiet", "--out", "a"];
    let mut command = assert_cmd::Command::cargo_bin("holonom").unwrap();
    command.current_dir(&folder).args(words).args(more).assert().success();

    let summary = read_json(folder.path().join("a/summary.json"));
    let found = &summary["provenance"];
    assert_eq!(*found, read_json(folder.path().join("a/checkpoint.json"))["provenance"]);
    assert_eq!((&found["model"], &found["version"]), (&text.as_str().into(), &env!("CARGO_PKG_VERSION").into()));
    let typed = "holonom run 'four bar.toml' --set 'parameters.N=3' --set 'parameters.N=1+1' --set 'output.reactions=true' --step 0.02 \
                 --end 0.1 --method conserving --every 2 --quiet --out a";
    assert_eq!(found["command"], typed);
    assert_eq!(
        (&found["method"], &found["step"], &found["end"], &found["every"]),
        (&"conserving".into(), &0.02.into(), &0.1.into(), &2.into())
    );
    // Years of four digits, in UTC.
    let date = found["date"].as_str().unwrap();
    let shape: String = date.chars().map(|c| if c.is_ascii_digit() { '0' } else { c }).collect();
    assert_eq!(shape, "0000-00-00T00:00:00Z", "{date}");
    let changes: Vec<[&Value; 3]> =
        found["overrides"].as_array().unwrap().iter().map(|change| ["key", "file", "run"].map(|key| &change[key])).collect();
    let expected = serde_json::json!([
        ["parameters.N", 1, "1+1"],
        ["output.reactions", null, true],
        ["simulation.step", 0.01, 0.02],
        ["simulation.end", 10, 0.1],
        ["simulation.method", null, "conserving"],
        ["output.every", null, 2],
    ]);
    let expected: Vec<[&Value; 3]> = expected.as_array().unwrap().iter().map(|row| [&row[0], &row[1], &row[2]]).collect();
    assert_eq!(changes, expected);
    let report = fs::read_to_string(folder.path().join("a/report.html")).unwrap();
    assert!(report.contains("<th scope=\"row\">parameters.N</th><td>1</td><td>1+1</td>"));

    // Nothing is said of the machine: neither where the program is, nor whose home it is.
    let home = folder.path().join("home of ada");
    fs::create_dir(&home).unwrap();
    let mut command = assert_cmd::Command::cargo_bin("holonom").unwrap();
    let model = home.join("four.toml");
    fs::write(&model, &text).unwrap();
    let words = [model.as_os_str(), "--end".as_ref(), "0.01".as_ref(), "--out".as_ref(), "b".as_ref()];
    command.current_dir(&folder).env("HOME", &home).arg("run").args(words).assert().success();
    for file in files(folder.path().join("b")) {
        let bytes = fs::read(folder.path().join("b").join(&file)).unwrap();
        assert!(!bytes.windows(11).any(|part| part == b"home of ada"), "{file}");
    }
    assert_eq!(read_json(folder.path().join("b/summary.json"))["provenance"]["command"], "holonom run ~/four.toml --end 0.01 --out b");
}

#[test]
fn files_of_the_model_are_known_by_their_sums() {
    let folder = folder();
    // A tetrahedron; the sum is that of sha256sum.
    let solid = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
    fs::write(folder.path().join("part.obj"), solid).unwrap();
    let model = "[body.b]\nposition = [0, 0, 0]\ndensity = 1000\nshape = { mesh = \"part.obj\" }\n";
    fs::write(folder.path().join("model.toml"), model).unwrap();
    let summary = json(&folder, "run model.toml --step 0.1 --end 0.2 --json --no-report");
    let sum = "b391f08159e507ad3a0fa80558bdb046e150e38868378c9972072d54ad65f858";
    assert_eq!(summary["provenance"]["files"], serde_json::json!({ "part.obj": sum }));
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
    assert_eq!(files(&out), names(&["checkpoint.json", "columns.json", "summary.json", "trajectory.csv", "trajectory.npz"]));
    let times: Vec<f64> = csv(out.join("trajectory.csv")).1.iter().map(|row| row[0]).collect();
    assert_eq!(times, [0.0, 0.125, 0.25, 0.375, 0.5]);
    assert!(fs::read(out.join("trajectory.npz")).unwrap().starts_with(b"PK"));

    prints(&folder, &format!("run {PAPER} --end 0.1 --out b --format npz --no-report"), 0);
    // A run goes on from a table in CSV of all columns.
    assert_eq!(
        files(folder.path().join("b")),
        names(&["checkpoint.json", "columns.json", "recording.csv", "summary.json", "trajectory.npz"])
    );

    if cfg!(feature = "parquet") {
        prints(&folder, &format!("run {PAPER} --end 0.1 --out b --format parquet --no-report"), 0);
        assert!(fs::read(folder.path().join("b/trajectory.parquet")).unwrap().starts_with(b"PAR1"));
    }

    let message = fails(&folder, &format!("run {PAPER} --end 0.1 --out c --format xls"), 2);
    assert!(message.contains("xls") && message.contains("csv") && message.contains("npz"), "{message}");
    assert!(!folder.path().join("c").exists(), "nothing is begun for a format that is not there");
}

#[test]
fn output_says_which_points_and_rows() {
    let folder = folder();
    prints(&folder, &format!("run {PAPER} --end 0.5 --out a --set output.points=[\"m2\"] --set output.every=10"), 0);
    let (header, rows) = csv(folder.path().join("a/trajectory.csv"));
    assert_eq!(header, format!("{COMMON},m2.x,m2.y,m2.z,m2.vx,m2.vy,m2.vz,m2.ax,m2.ay,m2.az,{OF_ROWS}"));
    assert_eq!((rows.len(), &rows[0][11..20]), (3, &[2.0, 0.0, 0.0, 0.0, 1.0, 0.0, -0.5, 0.0, -11.772][..]));

    prints(&folder, "run example:double-pendulum --end 0.1 --out b --set output.points=[\"m2\",\"m1\"]", 0);
    assert_eq!(
        csv(folder.path().join("b/trajectory.csv")).0,
        format!("{COMMON},m2.x,m2.y,m2.vx,m2.vy,m2.ax,m2.ay,m1.x,m1.y,m1.vx,m1.vy,m1.ax,m1.ay,upper-rod.force,lower-rod.force")
    );
}

#[test]
fn output_takes_bodies_and_their_places_as_points() {
    let folder = folder();
    let text = r#"
plane = "xy"
[point.p]
mass = 1
position = [0, 1]
[body.b]
mass = 1
inertia = 1
position = [0, 0]
points = { q = [1, 0] }
[simulation]
end = 0.1
step = 0.1
"#;
    fs::write(folder.path().join("model.toml"), text).unwrap();
    for (points, kept) in [("\"b\"", ["b."].as_slice()), ("\"b.q\",\"p\"", &["b.q.", "p."])] {
        prints(&folder, &format!("run model.toml --set output.points=[{points}] --quiet --no-report --out a --force"), 0);
        let header = csv(folder.path().join("a/trajectory.csv")).0;
        let of = |name: &str| name.rsplit_once('.').map(|(owner, _)| format!("{owner}."));
        let mut owners: Vec<String> = header.split(',').filter_map(of).collect();
        owners.dedup();
        assert_eq!(owners, kept, "{header}");
    }
    let message = fails(&folder, "run model.toml --set output.points=[\"b.r\"]", 2);
    assert!(message.contains("there is no point `b.r`") && message.contains("b.q"), "{message}");
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
    let quiet = holonom(&folder, &format!("run {PAPER} --method trapezoidal {words} --out b --quiet --no-report"));
    let (told, reason) = (text(&quiet.stderr), read_json(folder.path().join("b/summary.json"))["reason"].clone());
    assert_eq!((quiet.status.code(), quiet.stdout.len(), told.lines().count()), (Some(3), 0, 1), "{told}");
    assert!(told.starts_with("stopped at ") && told.contains(reason.as_str().unwrap()), "{told}");
    let results = folder.path().join("a");
    assert_eq!(files(&results), names(&["checkpoint.json", "columns.json", "report.html", "summary.json", "trajectory.csv"]));
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

/// Patterns choose columns of the tables, whatever the order of the patterns; a run that was ended goes on to the same bytes.
#[test]
fn output_chooses_columns_by_patterns() {
    let folder = folder();
    let model = "[point.a]\nmass = 1\nposition = [1, 0, 0]\n[point.b]\nmass = 1\nposition = [2, 0, 0]\n\
                 [force.s-1]\ntype = \"spring\"\nbetween = [\"ground\", \"a\"]\nstiffness = 100\n\
                 [force.s-2]\ntype = \"spring\"\nbetween = [\"a\", \"b\"]\nstiffness = 100\n\
                 [measure.far]\nvalue = \"max(b.x)\"\n[simulation]\nend = 1\nstep = 0.01\n";
    for (output, header) in [
        ("columns = [\"*.force\", \"energy\", \"b.?\"]", "t,energy,b.x,b.y,b.z,s-1.force,s-2.force"),
        ("columns = [\"far\"]", "t,far"),
        ("columns = []", "t"),
        (
            "columns = [\"*\", \"t\"]\npoints = [\"b\"]\nreactions = false",
            &format!(
                "{COMMON},b.x,b.y,b.z,b.vx,b.vy,b.vz,s-1.length,s-1.length_rate,s-1.force,s-1.power,s-2.length,s-2.length_rate,s-2.force,s-2.power,far"
            ),
        ),
    ] {
        fs::write(folder.path().join("m.toml"), format!("{model}[output]\n{output}\n")).unwrap();
        prints(&folder, "run m.toml --quiet --no-report --out whole --force", 0);
        assert_eq!(csv(folder.path().join("whole/trajectory.csv")).0, header, "{output}");
        let peaks = read_json(folder.path().join("whole/summary.json"))["peaks"].clone();
        assert!(peaks["forces"].as_array().unwrap().len() == 2 && peaks["measures"][0]["name"] == "far", "{peaks}");
        prints(&folder, "run m.toml --quiet --no-report --end 0.5 --out parts --force", 0);
        prints(&folder, "run m.toml --quiet --no-report --resume parts", 0);
        let table = |name: &str| fs::read(folder.path().join(name).join("trajectory.csv")).unwrap();
        assert!(table("whole") == table("parts"), "{output}");
    }
}

/// A motor turns a wheel of 0.1 kg·m² up to 10 rad/s against a damper of 0.3 N·m·s/rad and a spring of 0.08 N·m/rad: they take 5 J, 0.3 ∫ (10t)² dt and ½ 0.08 5².
#[test]
fn the_work_of_drives_and_forces_is_told() {
    let folder = folder();
    let model = "plane = \"xy\"\n[body.wheel]\nmass = 1\ninertia = 0.1\nposition = [0, 0]\n\
                 [joint.shaft]\ntype = \"revolute\"\nbetween = [\"ground\", \"wheel\"]\nat = [0, 0]\n\
                 [drive.motor]\ntype = \"angle\"\njoint = \"shaft\"\nprofile = \"5*t^2\"\n\
                 [force.oil]\ntype = \"torsion\"\njoint = \"shaft\"\ndamping = 0.3\n\
                 [force.coil]\ntype = \"torsion\"\njoint = \"shaft\"\nstiffness = 0.08\n[simulation]\nend = 1\nstep = 1e-3\n";
    fs::write(folder.path().join("m.toml"), model).unwrap();
    let told = prints(&folder, "run m.toml --every 1000 --out out", 0);
    let lines: Vec<&str> = told.lines().skip_while(|line| !line.starts_with("  work ")).take(4).map(str::trim).collect();
    assert_eq!(lines[..3], ["work       motor   16 J", "oil    -10 J", "coil    -1 J; holds 1 J more than at the start"], "{told}");
    assert!(lines[3].starts_with("size"), "{told}");
    let summary = read_json(folder.path().join("out/summary.json"));
    let all = ["drives", "forces"].map(|sort| summary["work_by"][sort].as_array().unwrap().clone()).concat();
    let sum: f64 = all.iter().map(|own| own["work"].as_f64().unwrap() + own["stored"].as_f64().unwrap()).sum();
    assert!((sum - summary["energy"]["work_total"].as_f64().unwrap()).abs() < 1e-12, "{summary}");
    let report = fs::read_to_string(folder.path().join("out/report.html")).unwrap();
    let table = report.split_once("Work in the run</caption>").unwrap().1.split_once("</table>").unwrap().0;
    assert!(table.contains("coil</th>") && table.contains("holds 1&nbsp;J more"), "{table}");
    // Over a whole turn without friction a motor gives what it takes back, and all of it is round-off.
    let round = model.split_once("[force.oil]").unwrap().0.replace("5*t^2", "sin(2*pi*t) - 2*pi*t");
    fs::write(folder.path().join("round.toml"), round + "[simulation]\nend = 1\nstep = 1e-3\n").unwrap();
    assert!(prints(&folder, "run round.toml --no-report", 0).contains("work       motor  0 J\n"));
}

/// Swings as cos 2πt: 20 times through its middle in 9.9 s, and what happens once is not lost behind them.
#[test]
fn events_are_told_by_their_names() {
    let folder = folder();
    let model = "plane = \"xy\"\ngravity = [0, 0]\n[point.m]\nmass = 1\nposition = [1, 0]\n\
                 [force.spring]\ntype = \"spring\"\nbetween = [\"ground\", \"m\"]\nalong = [1, 0]\nrest_length = 0\nstiffness = \"(2*pi)^2\"\n\
                 [event.middle]\nwhen = \"m.x\"\n[event.rare]\nwhen = \"t - 7.3\"\n[event.over]\nwhen = \"t - 9.9\"\nstop = true\n\
                 [event.far]\nwhen = \"m.x - 5\"\n[event.fast]\nwhen = \"m.vx - 50\"\n[input.u]\n[event.clock]\nevery = 0.5\nset = { u = \"t\" }\n\
                 [simulation]\nend = 20\nstep = 0.01\nmethod = \"gauss\"\norder = 6\n";
    std::fs::write(folder.path().join("swing.toml"), model).unwrap();
    let told = prints(&folder, "run swing.toml --no-report", 0);
    let lines: Vec<&str> = told.lines().skip_while(|line| !line.contains("events")).take(4).map(str::trim).collect();
    assert_eq!(
        lines,
        [
            "events     middle 20 times, first at 0.25 s and last at 9.75 s",
            "rare at 7.3 s",
            "over at 9.9 s, where the run ended",
            "far, fast did not happen"
        ],
        "{told}"
    );
    let beside = prints(&folder, "compare swing.toml --variant simulation.step=0.02 --no-report", 0);
    assert!(beside.contains("ended at 9.9 s by the event `over`"), "{beside}");
}

/// A run that ends at its start needs no step, and says where it is not at rest.
#[test]
fn the_start_alone_has_forces() {
    let folder = folder();
    let model = "plane = \"xz\"\n[point.bob]\nmass = 2\nposition = [3, 4]\n[constraint.rod]\ntype = \"distance\"\nbetween = [\"ground\", \"bob\"]\n";
    fs::write(folder.path().join("bob.toml"), model).unwrap();
    let run = |words: &str| json(&folder, &format!("run bob.toml --end 0 --no-report --json {words}"));
    let notes = |summary: &serde_json::Value| summary["notes"].to_string();
    // It falls, and the rod bears the share of its weight along it.
    let falls = run("--out falls");
    assert_eq!((&falls["steps"], &falls["status"]), (&0.into(), &"completed".into()));
    assert!((falls["peaks"]["joints"][0]["value"].as_f64().unwrap() + 0.8 * 2.0 * 9.81).abs() < 1e-12, "{falls:#}");
    assert!(notes(&falls).contains("forces do not balance at the start"), "{falls:#}");
    let hangs = run("--out hangs --set start.equilibrium=true");
    assert!((hangs["peaks"]["joints"][0]["value"].as_f64().unwrap() - 2.0 * 9.81).abs() < 1e-12, "{hangs:#}");
    assert!(!notes(&hangs).contains("balance at the start"), "{hangs:#}");
    let thrown = run("--out thrown --set point.bob.velocity=[4,-3]");
    assert!(!notes(&thrown).contains("balance at the start"), "{thrown:#}");
    let told = fails(&folder, "stability bob.toml --end 0", 2);
    assert!(told.contains("takes no step") && told.contains("--end"), "{told}");
    let told = fails(&folder, "sweep bob.toml --end 0 --vary point.bob.mass=1,2 --columns bob.magnitude", 2);
    assert!(told.contains("there is no column `bob.magnitude`"), "{told}");
}
