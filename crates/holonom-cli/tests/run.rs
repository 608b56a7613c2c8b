//! `holonom run`: what it prints, what it leaves, and how it goes on.

mod common;

use std::fs;

use common::*;
use serde_json::Value;

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
    assert_eq!(header, format!("{COMMON},{of_points},{accelerations},inner-rod.force,outer-rod.force"));
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
    assert_eq!(header, format!("{COMMON},m2.x,m2.y,m2.z,m2.vx,m2.vy,m2.vz,m2.ax,m2.ay,m2.az,inner-rod.force,outer-rod.force"));
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

#[test]
fn what_looks_like_a_slip_is_noted_by_run_and_check() {
    let folder = folder();
    let model = "[body.door]\nmass = 1\ninertia = [0, 0, 1]\ncheck_inertia = false\nposition = [0.5, 0, 0]\n\
                 [joint.hinge]\ntype = \"revolute\"\nbetween = [\"ground\", \"door\"]\nat = [0, 0, 0]\naxis = [0, 0, 1]\n\
                 [drive.motor]\ntype = \"angle\"\njoint = \"hinge\"\nprofile = \"max(t - 1, 0)\"\n\
                 [force.shaker]\ntype = \"torque\"\nbody = \"door\"\ntorque = [0, 0, \"cos(2*pi*100*t)\"]\n[simulation]\nend = 0.9\nstep = 0.01\n";
    fs::write(folder.path().join("door.toml"), model).unwrap();
    let notes = |words: &str| {
        let output = holonom(&folder, words);
        assert!(output.status.success(), "{words}");
        [text(&output.stdout), text(&output.stderr)].concat()
    };
    let inertia = "note: body.door.inertia: the moments 0, 0, 1 cannot belong to a body: 1 exceeds 0 + 0 by 1";
    let blow = "note: drive.motor.profile: its rate jumps by 1 per s at 1 s";
    let step = "note: simulation.step: the step of 5 s is longer than the run of 0.9 s";
    let unseen = "note: force.shaker.torque[2]: steps of 0.01 s do not see what this does within them: from 0 s to 0.01 s its mean is 0 and is taken to be -1 \
                  (a step of 0.005 s sees it, and so do steps by accuracy)";
    for (words, expected) in [
        ("run door.toml --no-report", [true, false, false, true]),
        ("run door.toml --no-report --end 1.2", [true, true, false, true]),
        ("run door.toml --no-report --step 5", [true, false, true, false]),
        ("run door.toml --no-report --step 0.001", [true, false, false, false]),
        ("run door.toml --no-report --accuracy 1e-4", [true, false, false, false]),
        ("run door.toml --no-report --quiet", [false, false, false, false]),
        ("check door.toml --set simulation.end=1.2", [true, true, false, true]),
        ("check door.toml --json --set simulation.step=5", [false, false, false, false]),
    ] {
        let said = notes(words);
        assert_eq!([inertia, blow, step, unseen].map(|note| said.contains(note)), expected, "{words}\n{said}");
    }
    assert_eq!(json(&folder, "check door.toml --json --set simulation.step=5")["notes"].as_array().unwrap().len(), 3);
}

/// What a drive moves needs no velocity of its own; one that was written and is another in the run is told.
#[test]
fn velocities_that_were_written_and_changed_are_told() {
    let folder = folder();
    let crank = |velocity: &str| {
        format!(
            "plane = \"xy\"\n[body.crank]\nmass = 1\ninertia = 1\nposition = [1, 0]\n{velocity}[joint.pin]\ntype = \"revolute\"\n\
             between = [\"ground\", \"crank\"]\nat = [0, 0]\n[drive.motor]\ntype = \"angle\"\njoint = \"pin\"\nprofile = \"2*t\"\n"
        )
    };
    for (velocity, told) in
        [("", ""), ("angular_velocity = 2\nvelocity = [0, 2]\n", ""), ("angular_velocity = 1\n", "`crank` by 2 m/s and 1 rad/s")]
    {
        fs::write(folder.path().join("m.toml"), crank(velocity)).unwrap();
        let notes = text(&holonom(&folder, "run m.toml --end 0.1 --step 0.01 --no-report --out a --force").stderr);
        assert_eq!((notes.contains("start velocities were changed"), notes.contains(told)), (!told.is_empty(), true), "{velocity}{notes}");
    }
}

/// A body that counts as a rod has no turn about itself: that one was written is not left out in silence, unless it is a rod by what is written.
#[test]
fn spins_of_rods_about_themselves_that_were_written_are_told() {
    let folder = folder();
    for (moment, told) in [("1e-6", false), ("1e-10", true), ("0", false)] {
        let text_of = format!(
            "gravity = [0, 0, 0]\n[body.needle]\nmass = 1\ninertia = [{moment}, 1, 1]\nposition = [0, 0, 0]\nangular_velocity = [7, 0, 0]\n"
        );
        fs::write(folder.path().join("m.toml"), text_of).unwrap();
        let notes = text(&holonom(&folder, "run m.toml --end 0.1 --step 0.01 --no-report --out a --force").stderr);
        assert_eq!(notes.contains("do not turn about themselves: `needle` by 7 rad/s was left out"), told, "{moment}: {notes}");
    }
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

/// A formula that is stiff beside the step makes energy that no balance shows: a ball that falls by 1 m comes up to 1 m, and no higher. A pulse of one
/// step and a step that is short for what a controller does are well.
#[test]
fn work_that_steps_get_wrong_is_told() {
    let folder = folder();
    let ball = "[point.ball]\nmass = 1\nposition = [0, 0, 1]\n[force.floor]\ntype = \"expression\"\npoint = \"ball\"\n\
                force = [0, 0, \"1e7*max(0, -z)\"]\n[measure.height]\nvalue = \"max(ball.z)\"\nunit = \"m\"\n[simulation]\nend = 5\nstep = 1e-3\n";
    let rope = "plane = \"xz\"\n[point.load]\nmass = 2\nposition = [1, 0]\nvelocity = [0.6, 0]\n[force.rope]\ntype = \"rope\"\n\
                between = [\"ground\", \"load\"]\nlength = \"1 + 0.2*sin(3*t)\"\nstiffness = 1e7\ndamping = 1000\n[simulation]\nend = 4\nstep = 0.01\n";
    let held = |effort: &str| {
        format!(
            "[body.arm]\nmass = 1\ninertia = [0.01, 0.1, 0.1]\nposition = [1, 0, 0]\n[joint.pin]\ntype = \"revolute\"\nbetween = [\"ground\", \"arm\"]\n\
             at = [0, 0, 0]\naxis = [0, 1, 0]\n[force.motor]\ntype = \"effort\"\njoint = \"pin\"\neffort = \"{effort}\"\n\
             [simulation]\nend = 4\nstep = 0.01\n"
        )
    };
    let notes = |model: &str, words: &str| {
        fs::write(folder.path().join("model.toml"), model).unwrap();
        text(&holonom(&folder, &format!("run model.toml --no-report --force --out a {words}")).stderr)
    };
    let told = |name: &str| format!(" J that could move, most of it that of `{name}`: steps are long for how it changes");
    for method in ["conserving", "conserving-ggl", "midpoint"] {
        let said = notes(ball, &format!("--method {method}"));
        assert!(said.contains(&told("floor")), "{method}: {said}");
        let said = notes(rope, &format!("--method {method}"));
        assert!(said.contains(&told("rope")), "{method}: {said}");
        for (model, words) in [
            (ball, "--step 1e-4"),
            (rope, "--step 1e-4"),
            (&held("-200*(q - 1) - 20*q_rate"), ""),
            (&held("100*(step(t - 0.5) - step(t - 0.51))"), ""),
        ] {
            let said = notes(model, &format!("--method {method} {words}"));
            assert!(!said.contains("may be wrong"), "{method}: {said}");
        }
    }
    // These damp it whatever the step is.
    for method in ["conserving", "conserving-ggl"] {
        let said = notes(&held("-2e4*(q - 1) - 2e3*q_rate"), &format!("--method {method}"));
        assert!(!said.contains("may be wrong"), "{method}: {said}");
    }
}

/// Two wheels on one axle hold it sideways twice, at positions and at velocities, which within a step ask for different motions: a method that takes it
/// in many small parts says so, one that stops names those that do not.
#[test]
fn steps_in_many_parts_are_told() {
    let folder = folder();
    let wheel = |name: &str, y: f64| {
        format!(
            "[body.{name}]\nmass = 1\nshape = {{ cylinder = [0.2, 0.02] }}\norientation = {{ axis = [1, 0, 0], angle = \"pi/2\" }}\n\
             position = [0, {y}, 0.2]\nvelocity = [{}, 0, 0]\nangular_velocity = [0, {}, 2]\n\
             [joint.axle-{name}]\ntype = \"revolute\"\nbetween = [\"cart\", \"{name}\"]\nat = \"{name}\"\naxis = [0, 1, 0]\n\
             [joint.tread-{name}]\ntype = \"rolling\"\nbetween = [\"ground\", \"{name}\"]\nat = \"{name}\"\naxis = [0, 1, 0]\n\
             normal = [0, 0, 1]\nradius = 0.2\n",
            2.0 - 2.0 * y,
            10.0 - 10.0 * y
        )
    };
    let cart = "[body.cart]\nmass = 20\ninertia = [2, 3, 4]\nposition = [0.3, 0, 0.3]\nvelocity = [2, 0.6, 0]\nangular_velocity = [0, 0, 2]\n\
                [joint.foot]\ntype = \"point-on-plane\"\nbetween = [\"ground\", \"cart\"]\nat = [0.8, 0, 0]\naxis = [0, 0, 1]\n";
    fs::write(folder.path().join("cart.toml"), format!("{cart}{}{}", wheel("left", 0.4), wheel("right", -0.4))).unwrap();
    let said = |words: &str| {
        let out = holonom(&folder, &format!("run cart.toml --no-report --force --out a {words}"));
        text(&out.stdout) + &text(&out.stderr)
    };
    let in_parts = "nominal steps failed as a whole and were taken in ";
    let slow = said("--method generalized-alpha --step 0.01 --end 0.05");
    assert!(slow.contains("completed") && slow.contains(in_parts), "{slow}");
    let stopped = said("--method trapezoidal-projected --step 0.02 --end 0.3");
    assert!(on_one_line(&stopped).contains("may ask for different motions within a step of this method"), "{stopped}");
    let well = said("--method conserving-ggl --step 0.01 --end 0.3");
    assert!(well.contains("completed") && !well.contains(in_parts), "{well}");
}

/// Steps that are long for what spins, and a method that loses much of the energy, are told beside figures that are all round-off.
#[test]
fn long_steps_are_told() {
    let folder = folder();
    let rotor = |drive: &str| {
        format!(
            "[body.top]\nmass = 1\ninertia = [0.01, 0.006, 0.006]\nposition = [0, 0, 0]\nangular_velocity = [600, 0, 0]\n\
             [joint.axle]\ntype = \"revolute\"\nbetween = [\"ground\", \"top\"]\nat = [0, 0, 0]\naxis = [1, 0, 0]\n{drive}\
             [simulation]\nend = 0.05\nstep = 1e-3\n"
        )
    };
    fs::write(folder.path().join("top.toml"), rotor("")).unwrap();
    let notes = |words: &str| text(&holonom(&folder, &format!("run top.toml --no-report --force --out a {words}")).stderr);
    let turns = "note: `axle.angle` comes on by 3 % less than its rate says: a method of order 2 lags";
    assert!(notes("").contains(turns), "{}", notes(""));
    assert!(!notes("--step 1e-4").contains("comes on by"), "{}", notes("--step 1e-4"));
    assert!(!notes("--method gauss").contains("comes on by"), "{}", notes("--method gauss"));
    // RATTLE turns by asin ωh, 0.6435 for 0.6.
    let turns = "note: `axle.angle` comes on by 7 % more than its rate says: a method of order 2 leads";
    assert!(notes("--method rattle").contains(turns), "{}", notes("--method rattle"));
    // So does what turns back on its way: from 600 rad/s to −600 rad/s.
    fs::write(folder.path().join("top.toml"), rotor("[force.motor]\ntype = \"effort\"\njoint = \"axle\"\neffort = -240\n")).unwrap();
    assert!(notes("").contains("`axle.angle` comes on by") && !notes("--step 1e-4").contains("comes on by"), "{}", notes(""));
    // Few rows of a rotor that turns back and forth at short steps say nothing of these.
    let spring = rotor("[force.spring]\ntype = \"torsion\"\njoint = \"axle\"\nstiffness = 100\n");
    fs::write(folder.path().join("top.toml"), spring).unwrap();
    let few = notes("--step 1e-4 --end 0.5 --every 60");
    assert!(!few.contains("comes on by"), "{few}");
    let free = "[body.top]\nmass = 1\ninertia = [0.01, 0.006, 0.006]\nposition = [0, 0, 0]\nangular_velocity = [600, 1, 0]\n\
                [simulation]\nend = 0.05\nstep = 1e-3\n";
    fs::write(folder.path().join("top.toml"), free).unwrap();
    // A body in space that no joint has an angle of: 0.6 rad a step, of which 2 atan 0.3 = 0.583 rad come on.
    assert!(notes("").contains("note: `top` comes on by 3 % less than its rate says"), "{}", notes(""));
    for words in ["--step 1e-4", "--method gauss", "--every 20", "--accuracy 1e-6"] {
        assert!(!notes(words).contains("comes on by"), "{words}: {}", notes(words));
    }
    // What goes round without turning itself, in units of any size, and on a carriage; a pendulum goes to and fro.
    let round = |size: f64, along: f64, end: &str| {
        format!(
            "plane = \"xy\"\ngravity = [0, {}]\n[point]\nq = {{ mass = 1, position = [0, 0], velocity = [{along}, {}] }}\n\
             p = {{ mass = 1, position = [{size}, 0], velocity = [{along}, {}] }}\n\
             [constraint]\nrod = {{ type = \"distance\", between = [\"q\", \"p\"] }}\n[simulation]\n{end}\n",
            -1e-6 * size,
            -300.0 * size,
            300.0 * size,
        )
    };
    for (size, along) in [(1.0, 0.0), (1e3, 0.0), (1e-3, 0.0), (1.0, 1e4)] {
        fs::write(folder.path().join("top.toml"), round(size, along, "end = 0.05\nstep = 1e-3")).unwrap();
        for (words, told) in [("", "3 % less"), ("--method rattle", "7 % more")] {
            let told = format!("comes on by {told} than its velocity says");
            assert!(notes(words).contains(&told), "{size} {along} {words}: {}", notes(words));
        }
        for words in ["--step 2e-4", "--method gauss"] {
            assert!(!notes(words).contains("comes on by"), "{words}: {}", notes(words));
        }
    }
    let swing = "plane = \"xy\"\ngravity = [0, -9.81]\n[point]\np = { mass = 1, position = [1, 0] }\n\
                 [constraint]\nrod = { type = \"distance\", between = [\"ground\", \"p\"] }\n[simulation]\nend = 20\nstep = 0.15\n";
    fs::write(folder.path().join("top.toml"), swing).unwrap();
    assert!(!notes("").contains("comes on by"), "{}", notes(""));
    fs::write(folder.path().join("top.toml"), free).unwrap();
    let lost = notes("--method radau --step 5e-3");
    assert!(lost.contains("note: the method has lost ") && lost.contains(" J that could move: shorter steps"), "{lost}");
    assert!(!notes("--method radau --accuracy 1e-6").contains("the method has"));
    // What is driven does not lag.
    fs::write(folder.path().join("top.toml"), rotor("[drive.motor]\ntype = \"angle\"\njoint = \"axle\"\nprofile = \"600*t\"\n")).unwrap();
    assert!(!notes("").contains("comes on by"), "{}", notes(""));
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

#[test]
fn a_row_at_a_dead_centre_has_no_forces_and_says_so() {
    let folder = folder();
    // A ram goes to where both links stretch at 1 s, and back.
    let model = "plane = \"xz\"\n[parameters]\nc = \"cos(10*deg)\"\ns = \"sin(10*deg)\"\n\
                 [body.upper]\nmass = 20\nshape = { rod = 0.4 }\nposition = [\"0.2*s\", \"-0.2*c\"]\norientation = { angle = \"10*deg - pi/2\" }\n\
                 [body.lower]\nmass = 20\nshape = { rod = 0.4 }\nposition = [\"0.2*s\", \"-0.6*c\"]\norientation = { angle = \"-10*deg - pi/2\" }\n\
                 [body.ram]\nmass = 150\ninertia = 4\nposition = [0, \"-0.8*c\"]\n\
                 [joint.head]\ntype = \"revolute\"\nbetween = [\"ground\", \"upper\"]\nat = [0, 0]\n\
                 [joint.knee]\ntype = \"revolute\"\nbetween = [\"upper\", \"lower\"]\nat = [\"0.4*s\", \"-0.4*c\"]\n\
                 [joint.wrist]\ntype = \"revolute\"\nbetween = [\"lower\", \"ram\"]\nat = \"ram\"\n\
                 [joint.guide]\ntype = \"prismatic\"\nbetween = [\"ground\", \"ram\"]\naxis = [0, -1]\n\
                 [drive.screw]\ntype = \"displacement\"\njoint = \"guide\"\nprofile = \"0.4*(1 - c)*(1 - cos(pi*t))\"\n\
                 [force.work]\ntype = \"effort\"\njoint = \"guide\"\neffort = -1e6\n\
                 [measure.root]\nvalue = \"sqrt(upper.z + 0.15)\"\n[measure.pin]\nvalue = \"wrist.fz\"\n";
    fs::write(folder.path().join("press.toml"), model).unwrap();
    let notes = on_one_line(&text(&holonom(&folder, "run press.toml --method radau --step 0.01 --end 2 --no-report --out a").stderr));
    for note in [
        "note: one row has no accelerations and no forces of joints and drives, first at 1 s: at a singular position they do not follow",
        "note: the measure `pin` has no finite value in 1 of 201 rows: what it reads has none in the first of them",
        "note: the measure `root` has no finite value in 201 of 201 rows: a formula is outside its domain there",
    ] {
        assert!(notes.contains(note), "{note}\n{notes}");
    }
}
