//! `holonom sweep --columns`: functions of columns over each run.

mod common;

use std::f64::consts::TAU;
use std::fs;

use common::*;
use tempfile::TempDir;

/// A mass on a spring that makes `n` oscillations of 0.1 m about 1 m in a second: x = 1 + 0.1 cos(ωt) with ω = 2πn.
const OSCILLATOR: &str = r#"
plane = "xy"
gravity = [0, 0]
[parameters]
n = 1
[point.m]
mass = 2.0
position = [1.1, 0]
[force.strut]
type = "spring"
between = ["ground", "m"]
stiffness = "2*(2*pi*n)^2"
rest_length = 1.0
[simulation]
end = 1.0
step = 2.5e-3
method = "gauss"
order = 6
"#;

/// Runs the command with words that may hold blanks.
fn sweep(folder: &TempDir, model: &str, columns: &str, words: &str) -> std::process::Output {
    let mut command = assert_cmd::Command::cargo_bin("holonom").unwrap();
    command.current_dir(folder).args(["sweep", model, "--columns", columns]).args(words.split_whitespace()).output().unwrap()
}

/// A column of the table that a sweep leaves.
#[track_caller]
fn cells(folder: &TempDir, out: &str, name: &str) -> Vec<String> {
    let text = fs::read_to_string(folder.path().join(out).join("sweep.csv")).unwrap();
    let mut lines = text.lines().map(holonom_io::csv_cells);
    let header = lines.next().unwrap();
    let place = header.iter().position(|column| column == name).unwrap_or_else(|| panic!("{name} in {header:?}"));
    lines.map(|cells| cells[place].clone()).collect()
}

#[track_caller]
fn numbers(folder: &TempDir, out: &str, name: &str) -> Vec<f64> {
    cells(folder, out, name).iter().map(|cell| cell.parse().unwrap()).collect()
}

#[test]
fn functions_over_an_oscillation_are_those_of_the_closed_form() {
    let folder = folder();
    fs::write(folder.path().join("oscillator.toml"), OSCILLATOR).unwrap();
    let columns = "max(abs(strut.force)), min(m.vx), rms(m.vx), mean(m.x), at(m.x, 0.1234), max(m.ax), last(m.x), abs(m.vy), m.x";
    // How often rows are recorded in a run does not matter.
    for words in ["--out every", "--out tenth --set output.every=10"] {
        let output = sweep(&folder, "oscillator.toml", columns, &format!("--vary parameters.n=1,2,4 --quiet {words}"));
        assert!(output.status.success(), "{}", text(&output.stderr));
    }
    let table = |out: &str| fs::read_to_string(folder.path().join(out).join("sweep.csv")).unwrap();
    assert_eq!(table("every"), table("tenth"));
    let header = table("every").lines().next().unwrap().to_string();
    assert_eq!(holonom_io::csv_cells(&header)[12..].join(";"), columns.replace(", ", ";").replace("m.x;0.1234", "m.x, 0.1234"));
    for (k, omega) in [1.0, 2.0, 4.0].map(|n| n * TAU).into_iter().enumerate() {
        let is = |name: &str, exact: f64, within: f64| {
            let found = numbers(&folder, "every", name)[k];
            assert!((found - exact).abs() <= within * exact.abs().max(1e-12), "{name}: {found} and {exact}");
        };
        is("max(abs(strut.force))", 2.0 * omega * omega * 0.1, 1e-12);
        is("min(m.vx)", -0.1 * omega, 1e-8);
        // Straight from step to step: h/3 (a² + ab + b²) of a sine over whole periods.
        is("rms(m.vx)", 0.1 * omega * ((2.0 + (omega * 2.5e-3).cos()) / 6.0).sqrt(), 1e-8);
        is("mean(m.x)", 1.0, 1e-9);
        is("at(m.x, 0.1234)", 1.0 + 0.1 * (omega * 0.1234).cos(), 1e-7);
        is("max(m.ax)", 0.1 * omega * omega, 1e-8);
        is("last(m.x)", 1.1, 1e-8);
        is("abs(m.vy)", 0.0, 1.0);
    }
    assert_eq!(cells(&folder, "every", "last(m.x)"), cells(&folder, "every", "m.x"));
}

#[test]
fn forces_of_joints_accelerations_and_efforts_are_those_of_the_run_alone() {
    let folder = folder();
    let words = "--end 0.2 --step 0.002";
    prints(&folder, &format!("run example:robot-arm {words} --quiet --no-report --out alone"), 0);
    let (header, rows) = csv(folder.path().join("alone/trajectory.csv"));
    let names: Vec<&str> = header.split(',').collect();
    let ending = |ending: &str| *names.iter().find(|name| name.ends_with(ending)).unwrap_or_else(|| panic!("{ending} in {header}"));
    for column in [ending(".effort"), ending(".power"), ending(".fz"), ending(".ty"), ending(".ax"), ending(".alphaz"), "kinetic"] {
        let place = names.iter().position(|name| *name == column).unwrap();
        let values: Vec<f64> = rows.iter().map(|row| row[place]).collect();
        let out = format!("only-{column}");
        let columns = format!("max({column}),min({column}),max(abs({column})),at({column},0.1),{column}");
        let output = sweep(&folder, "example:robot-arm", &columns, &format!("--vary simulation.step=0.002 --end 0.2 --quiet --out {out}"));
        assert!(output.status.success(), "{column}: {}", text(&output.stderr));
        let (most, least) = (values.iter().copied().fold(f64::MIN, f64::max), values.iter().copied().fold(f64::MAX, f64::min));
        let size = most.max(-least);
        for (name, value) in [
            (format!("max({column})"), most),
            (format!("min({column})"), least),
            (format!("max(abs({column}))"), size),
            (format!("at({column},0.1)"), values[50]),
            (column.to_string(), values[100]),
        ] {
            let found = numbers(&folder, &out, &name)[0];
            assert!((found - value).abs() <= 1e-11 * size, "{name}: {found} and {value}");
        }
    }
}

/// Of the two quaternions of an orientation rows have the one near the row before: after half a turn that is not the one near the start.
#[test]
fn the_last_orientation_is_that_of_the_run_alone_whatever_else_is_asked() {
    let folder = folder();
    prints(&folder, "run example:heavy-top --end 0.2 --step 0.001 --quiet --no-report --out alone", 0);
    let (header, rows) = csv(folder.path().join("alone/trajectory.csv"));
    let place = header.split(',').position(|name| name == "top.qw").unwrap();
    let (first, last) = (rows[0][place], rows[rows.len() - 1][place]);
    assert!(first * last < 0.0, "it has turned: {first} {last}");
    for (out, columns) in
        [("a", "top.qw"), ("b", "top.qw,min(top.qw),at(top.qw, 0.2)"), ("c", "top.qw,top.ax"), ("d", "top.qw,max(top.ax)")]
    {
        let words = format!("--vary simulation.step=0.001 --end 0.2 --quiet --out {out}");
        assert!(sweep(&folder, "example:heavy-top", columns, &words).status.success());
        assert_eq!(numbers(&folder, out, "top.qw"), [last], "{columns}");
    }
    assert_eq!(numbers(&folder, "b", "at(top.qw, 0.2)"), [last]);
}

/// Measures are columns like any other: running ones see every step, and forces are found where they read them.
#[test]
fn measures_are_those_of_the_run_alone() {
    let folder = folder();
    let model = example("slider-crank");
    let measures = [
        ("pull", "sqrt(B.fx^2 + B.fy^2 + B.fz^2)"),
        ("peak", "max(pull)"),
        ("mean-square", "rms(slider.vx)"),
        ("way", "integral(abs(slider.vx))"),
        ("double", "2*slider.x"),
    ];
    let measures: String = measures.iter().map(|(name, value)| format!("[measure.{name}]\nvalue = \"{value}\"\n")).collect();
    fs::write(folder.path().join("crank.toml"), model + &measures).unwrap();
    prints(&folder, "run crank.toml --end 0.2 --quiet --no-report --out alone", 0);
    let (header, rows) = csv(folder.path().join("alone/trajectory.csv"));
    let alone = |name: &str| {
        let place = header.split(',').position(|known| known == name).unwrap_or_else(|| panic!("{name} in {header}"));
        rows.iter().map(|row| row[place]).collect::<Vec<f64>>()
    };
    let names = ["pull", "peak", "mean-square", "way", "double"];
    let words = "--vary parameters.spin=6,7 --end 0.2 --quiet --out";
    prints(&folder, &format!("sweep crank.toml {words} usual"), 0);
    assert!(sweep(&folder, "crank.toml", "pull,peak,mean-square,way,double", &format!("{words} asked")).status.success());
    assert!(sweep(&folder, "crank.toml", "max(pull),rms(slider.vx),min(way),B.f", &format!("{words} functions")).status.success());
    let is = |out: &str, name: &str, value: f64| {
        let found = numbers(&folder, out, name)[0];
        assert!((found - value).abs() <= 1e-11 * value.abs(), "{out}: {name}: {found} and {value}");
    };
    for name in names {
        let last = *alone(name).last().unwrap();
        assert!(last.is_finite() && last != 0.0, "{name}");
        is("usual", name, last);
        is("asked", name, last);
    }
    is("functions", "B.f", *alone("pull").last().unwrap());
    is("functions", "max(pull)", *alone("peak").last().unwrap());
    is("functions", "rms(slider.vx)", *alone("mean-square").last().unwrap());
    assert_eq!(numbers(&folder, "functions", "min(way)"), [0.0, 0.0]);
    let usual = fs::read_to_string(folder.path().join("usual/sweep.csv")).unwrap();
    assert!(!usual.lines().next().unwrap().contains("B.fx"), "of forces only what measures make of them: {usual}");
}

/// The text of an example.
fn example(name: &str) -> String {
    fs::read_to_string(std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../../examples/{name}.toml"))).unwrap()
}

#[test]
fn the_table_is_the_same_for_any_threads_and_after_a_kill() {
    let folder = folder();
    let columns = "max(abs(B.fx)),rms(slider.ax),at(slider.x, 0.0333),mean(kinetic),slider.x";
    let run = |out: &str| {
        let words = format!("--vary parameters.spin=5..7:5 --vary simulation.step=1e-3,2e-3 --end 0.1 --quiet {out}");
        let output = sweep(&folder, "example:slider-crank", columns, &words);
        assert!(output.status.success(), "{}", text(&output.stderr));
    };
    let table = |out: &str| fs::read_to_string(folder.path().join(out).join("sweep.csv")).unwrap();
    run("--threads 1 --out one");
    run("--threads 2 --out two");
    assert_eq!((table("one"), table("one").lines().count()), (table("two"), 11));
    let report = |out: &str| fs::read_to_string(folder.path().join(out).join("report.html")).unwrap();
    assert_eq!(report("one"), report("two"));
    let journal = folder.path().join("two/sweep.journal");
    let whole = fs::read_to_string(&journal).unwrap();
    let lines: Vec<&str> = whole.split_inclusive('\n').collect();
    fs::remove_file(folder.path().join("two/sweep.csv")).unwrap();
    fs::write(&journal, lines[..4].concat() + &lines[4][..20]).unwrap();
    run("--threads 2 --out two");
    assert_eq!(table("one"), table("two"));
}

#[test]
fn the_report_shows_what_was_asked_for() {
    let folder = folder();
    fs::write(folder.path().join("oscillator.toml"), OSCILLATOR).unwrap();
    let columns = "max(abs(strut.force)), at(m.x, 0.5)";
    let words = "--vary parameters.n=1..4:4 --set simulation.step=0.005 --quiet --out";
    for words in [format!("{words} a"), format!("{words} b --no-report"), format!("{words} c --vary point.m.mass=-1,1,2")] {
        assert!(sweep(&folder, "oscillator.toml", columns, &words).status.success());
    }
    assert_eq!(files(folder.path().join("b")), names(&["sweep.csv", "sweep.journal"]));
    let report = |out: &str| fs::read_to_string(folder.path().join(out).join("report.html")).unwrap();
    let curve = report("a");
    for told in ["<h1>oscillator</h1>", "max(abs(strut.force)) <small>N</small>", "at(m.x, 0.5) <small>m</small>", "simulation.step=0.005"]
    {
        assert!(curve.contains(told), "{told}");
    }
    assert_eq!((curve.matches("class=\"curve\"").count(), curve.matches("<circle").count()), (2, 8));
    let map = report("c");
    assert_eq!((map.matches("<title>run ").count(), map.matches("class=\"failed\" d=").count()), (24, 8));
    assert!(map.contains("12 runs · 8 completed · 4 refused · grid of parameters.n, point.m.mass"));
}

#[test]
fn cells_are_empty_where_a_run_has_no_such_value() {
    let folder = folder();
    // The last of four bars is not there in a model of two.
    let output = sweep(&folder, "example:four-bar", "max(P[3].x),max(P[1].x)", "--vary parameters.N=4,2 --end 0.1 --quiet --out bars");
    assert!(output.status.success(), "{}", text(&output.stderr));
    assert_eq!(cells(&folder, "bars", "max(P[3].x)").iter().map(String::is_empty).collect::<Vec<_>>(), [false, true]);
    assert!(cells(&folder, "bars", "max(P[1].x)").iter().all(|cell| !cell.is_empty()));
    // A formula of what is not there is no formula.
    let output = sweep(&folder, "example:four-bar", "max(P[3].x - P[1].x)", "--vary parameters.N=4,2 --end 0.1 --quiet --out formula");
    assert!(output.status.success(), "{}", text(&output.stderr));
    assert_eq!(cells(&folder, "formula", "status"), ["completed", "refused"]);
    assert_eq!(cells(&folder, "formula", "reason")[1], "`max(P[3].x - P[1].x)`: the name `P[3].x` is not known here");
    // A run that ends before a time has no value there.
    let output = sweep(&folder, PAPER, "at(m1.x, 0.5),max(m1.x)", "--vary simulation.end=0.4,0.5,1 --quiet --out ends");
    assert!(output.status.success(), "{}", text(&output.stderr));
    assert_eq!(cells(&folder, "ends", "at(m1.x, 0.5)").iter().map(String::is_empty).collect::<Vec<_>>(), [true, false, false]);
    assert!(cells(&folder, "ends", "max(m1.x)").iter().all(|cell| !cell.is_empty()));
}

/// The oscillation has twice its amplitude from one end to the other, and a speed of ω times that through the middle.
#[test]
fn formulas_of_columns_are_columns() {
    let folder = folder();
    fs::write(folder.path().join("oscillator.toml"), OSCILLATOR).unwrap();
    let columns = "max(m.x) - min(m.x), max(sqrt(m.vx^2 + m.vy^2)), at(2*m.x - n, 0.5), mean(distance(ground, m)),max(abs(1 - m.x))";
    let output = sweep(&folder, "oscillator.toml", columns, "--vary parameters.n=1,2 --quiet --out formulas");
    assert!(output.status.success(), "{}", text(&output.stderr));
    for (k, n) in [1.0, 2.0].into_iter().enumerate() {
        for (name, exact, within) in [
            ("max(m.x) - min(m.x)", 0.2, 1e-8),
            ("max(sqrt(m.vx^2 + m.vy^2))", 0.1 * TAU * n, 1e-8),
            ("at(2*m.x - n, 0.5)", 2.0 + 0.2 * (0.5 * TAU * n).cos() - n, 1e-7),
            ("mean(distance(ground, m))", 1.0, 1e-9),
            ("max(abs(1 - m.x))", 0.1, 1e-8),
        ] {
            let found = numbers(&folder, "formulas", name)[k];
            assert!((found - exact).abs() <= within, "{name}: {found} and {exact}");
        }
    }
}

#[test]
fn columns_that_there_are_not_are_refused_before_anything_runs() {
    let folder = folder();
    for (columns, told) in [
        ("max(m1.xx)", "did you mean `m1.x`"),
        ("max(energie)", "did you mean `energy`"),
        ("max(m2.qw)", "did you mean `m2.x`, `m2.y` or `m2.z`?"),
        ("max(m1.x),max(m1.x)", "twice"),
        ("max(m1.x),,m2.x", "empty place"),
        ("max(m1.x", "closes it"),
        ("maxx(m1.x)", "did you mean `max`?"),
        ("at(m1.x, 21)", "after the end of the runs, 20 s"),
        ("at(m1.x, soon)", "seconds"),
        ("max(rod1.lambda)", "cure"),
        ("max(m1.x - m2.xx)", "`max(m1.x - m2.xx)`: the name `m2.xx` is not known here"),
        ("m1.x-m2.x", "write a difference with blanks, `m1.x - m2.x`"),
    ] {
        let output = sweep(&folder, PAPER, columns, "--vary point.m1.mass=1,2");
        let message = text(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{columns}\n{message}");
        assert!(message.contains(told) && message.contains("cure:") && !message.contains("formula_of_column"), "{columns}\n{message}");
    }
    let output = sweep(&folder, "example:slider-crank", "max(B.fx)", "--vary parameters.spin=1,2 --set output.reactions=false");
    let message = text(&output.stderr);
    assert!(message.contains("do not record `B.fx`") && message.contains("output.reactions=true"), "{message}");
    let output = sweep(&folder, "example:slider-crank", "max(B.force)", "--vary parameters.spin=1,2");
    let message = String::from_utf8(output.stderr).unwrap();
    assert!(message.contains("there is no column `B.force`") && message.contains("did you mean `B.f`, its size?"), "{message}");
    assert!(!folder.path().join("results").exists());
}

/// An event ends the run of a ball from 0.5 m after 0.32 s, and that from 2 m after 0.64 s.
#[test]
fn times_that_runs_do_not_come_to_are_told() {
    let folder = folder();
    let ball = "[parameters]\nh = 1\n[point.ball]\nmass = 1\nposition = [0, 0, \"h\"]\n[event.lands]\nwhen = \"ball.z\"\nstop = true\n\
                [simulation]\nend = 2\nstep = 0.01\n";
    fs::write(folder.path().join("ball.toml"), ball).unwrap();
    let told = |columns: &str| text(&sweep(&folder, "ball.toml", columns, "--vary parameters.h=0.5,2 --out a --force --no-report").stderr);
    assert!(
        told("at(ball.z, 0.5)").contains("note: `at(ball.z, 0.5)` has no value in one run of 2, which ended before 0.5 s"),
        "{}",
        told("at(ball.z, 0.5)")
    );
    assert!(told("at(ball.z, 0.7)").contains("note: `at(ball.z, 0.7)` has no value in 2 runs of 2, which"), "{}", told("at(ball.z, 0.7)"));
    assert!(!told("at(ball.z, 0.3)").contains("has no value"), "{}", told("at(ball.z, 0.3)"));
}

/// `t` in a formula is the time, and no parameter.
#[test]
fn parameters_called_like_columns_are_refused_in_formulas() {
    let folder = folder();
    fs::write(folder.path().join("m.toml"), OSCILLATOR.replace("n = 1", "n = 1\nt = 5")).unwrap();
    let output = sweep(&folder, "m.toml", "max(2*t)", "--vary parameters.n=1,2");
    let message = text(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{message}");
    assert!(
        message.contains("`t` could be the parameter of this name or the column of results")
            && message.contains("cure: give the parameter another name"),
        "{message}"
    );
}

/// A measure may be called as a column that every table has: two of one name tell nobody which is which.
#[test]
fn no_two_columns_have_one_name() {
    let folder = folder();
    fs::write(folder.path().join("m.toml"), format!("{OSCILLATOR}[measure.steps]\nvalue = \"m.x\"\n")).unwrap();
    for columns in ["m.x, steps", "steps"] {
        let output = sweep(&folder, "m.toml", columns, "--vary parameters.n=1,2");
        let message = text(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{columns}\n{message}");
        assert!(message.contains("two columns `steps`") && message.contains("last(steps)"), "{columns}\n{message}");
    }
    assert!(sweep(&folder, "m.toml", "last(steps)", "--vary parameters.n=1,2 --out a --quiet").status.success());
    assert_eq!(cells(&folder, "a", "steps"), ["400"; 2]);
    assert!(numbers(&folder, "a", "last(steps)").iter().all(|x| (x - 1.1).abs() < 1e-6));
}

/// What was asked for is on the screen: for each of a few runs, and of many where each column is least and largest.
#[test]
fn columns_that_were_asked_for_are_shown() {
    let folder = folder();
    fs::write(folder.path().join("oscillator.toml"), OSCILLATOR).unwrap();
    let shown = |words: &str| text(&sweep(&folder, "oscillator.toml", "max(m.x), min(m.vx)", words).stdout);
    let few = shown("--vary parameters.n=1,2 --out few");
    let line = |text: &str, begins: &str| -> Vec<String> {
        let line = text.lines().find(|line| line.starts_with(begins)).unwrap_or_else(|| panic!("{begins} in\n{text}"));
        line.split_whitespace().map(str::to_string).collect()
    };
    assert_eq!(line(&few, "parameters.n"), ["parameters.n", "max(m.x)", "(m)", "min(m.vx)", "(m/s)"]);
    let second = line(&few, "2 ");
    assert_eq!(second[1], "1.1");
    assert!((second[2].parse::<f64>().unwrap() + 0.1 * 2.0 * TAU).abs() < 1e-2, "{few}");

    let many = shown("--vary parameters.n=1..3:21 --out many --no-report");
    assert_eq!(line(&many, "min(m.vx) largest (m/s)")[4], "parameters.n=1");
    assert_eq!(line(&many, "min(m.vx) least (m/s)")[4], "parameters.n=3");
    let columns = serde_json::from_str::<serde_json::Value>(&shown("--vary parameters.n=1..3:21 --out json --no-report --json")).unwrap();
    let of_speed = &columns["columns"]["min(m.vx)"];
    assert_eq!((&of_speed["min_run"], &of_speed["max_run"]), (&21.into(), &1.into()));
    // Without a question there is no answer.
    assert!(!prints(&folder, "sweep oscillator.toml --vary parameters.n=1,2 --out plain", 0).contains("max(m.x)"));
}

/// When an event happens is a column, empty where it does not.
#[test]
fn times_of_events_are_columns() {
    let folder = folder();
    // From 0.1 m beside the middle it comes there after a quarter of its period.
    fs::write(folder.path().join("m.toml"), format!("{OSCILLATOR}[event.middle]\nwhen = \"1 - m.x\"\n")).unwrap();
    let output = sweep(&folder, "m.toml", "time(middle), max(m.x)", "--vary parameters.n=0.125,1,2 --out a --quiet");
    assert!(output.status.success(), "{}", text(&output.stderr));
    let times = cells(&folder, "a", "time(middle)");
    assert_eq!(times[0], "");
    for (time, n) in times[1..].iter().zip([1.0, 2.0]) {
        assert!((time.parse::<f64>().unwrap() - 0.25 / n).abs() < 1e-6, "{times:?}");
    }
    let refused = sweep(&folder, "m.toml", "time(midle)", "--vary parameters.n=1,2 --out b");
    assert!(text(&refused.stderr).contains("did you mean `middle`?"), "{}", text(&refused.stderr));
    // One with a period happens at 0 first, and is taken before any step: what it sets counts from there.
    fs::write(folder.path().join("m.toml"), format!("{OSCILLATOR}[input.k]\n[event.tick]\nevery = 0.3\nset = {{ k = \"k + 1\" }}\n"))
        .unwrap();
    let output = sweep(&folder, "m.toml", "time(tick), at(k, 0), last(k)", "--vary parameters.n=1,2 --out c --quiet");
    assert!(output.status.success(), "{}", text(&output.stderr));
    let [times, at_start, last] = ["time(tick)", "at(k, 0)", "last(k)"].map(|name| numbers(&folder, "c", name));
    assert_eq!((times, at_start, last), (vec![0.0; 2], vec![1.0; 2], vec![4.0; 2]));
}
