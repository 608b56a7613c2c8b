//! `holonom sweep`: its table, whatever the threads and the interruptions, and what it refuses.

mod common;

use std::fs;
use std::path::Path;
use std::process::{Child, Command as Process};
use std::time::{Duration, Instant};

use common::*;
use serde_json::Value;

/// A grid with runs of every kind: some complete, some stop, some are refused.
const GRID: &str = "sweep example:spherical-compound-pendulum --vary point.m1.mass=-1,1,2.5 --vary simulation.step=0.01..0.05:3 \
                    --vary simulation.iteration=newton,simultaneous --method trapezoidal --end 6 --set simulation.penalty=1e7 \
                    --set simulation.tolerance=1e-9 --set simulation.subdivide=false --quiet";

fn table(folder: &tempfile::TempDir, name: &str) -> String {
    fs::read_to_string(folder.path().join(name).join("sweep.csv")).unwrap()
}

/// Cells of the rows of a table, and the index of each column.
fn cells(text: &str) -> (Vec<String>, Vec<Vec<String>>) {
    let mut lines = text.lines().map(holonom_io::csv_cells);
    (lines.next().unwrap(), lines.collect())
}

fn column<'a>(header: &[String], rows: &'a [Vec<String>], name: &str) -> Vec<&'a str> {
    let k = header.iter().position(|column| column == name).unwrap_or_else(|| panic!("{name} in {header:?}"));
    rows.iter().map(|row| row[k].as_str()).collect()
}

#[test]
fn a_row_holds_what_the_run_alone_gives() {
    let folder = folder();
    let out = prints(&folder, &format!("sweep {PAPER} --vary point.m2.mass=1,3 --vary simulation.step=0.02,0.05 --end 1"), 0);
    assert!(out.contains("4 completed, 0 stopped, 0 refused"), "{out}");
    let results = folder.path().join("results/spherical-compound-pendulum-sweep");
    assert_eq!(files(&results), names(&["report.html", "sweep.csv", "sweep.journal"]));
    let (header, rows) = cells(&fs::read_to_string(results.join("sweep.csv")).unwrap());
    assert_eq!(column(&header, &rows, "run"), ["1", "2", "3", "4"]);
    assert_eq!(column(&header, &rows, "point.m2.mass"), ["1", "1", "3", "3"]);
    assert_eq!(column(&header, &rows, "simulation.step"), ["0.02", "0.05", "0.02", "0.05"]);

    let words = format!("run {PAPER} --end 1 --step 0.05 --set point.m2.mass=3 --json --no-report --out alone");
    let summary = json(&folder, &words);
    let number = |name: &str| column(&header, &rows, name)[3].parse::<f64>().unwrap();
    for (name, path) in [
        ("steps", "/steps"),
        ("energy_drift", "/energy/max_drift"),
        ("position_violation", "/violation/position"),
        ("velocity_violation", "/violation/velocity"),
        ("iterations_per_step", "/work/iterations_per_step"),
        ("rejected_steps", "/work/rejected_steps"),
    ] {
        assert_eq!(number(name), summary.pointer(path).and_then(Value::as_f64).unwrap(), "{name}");
    }
    let (names, trajectory) = csv(folder.path().join("alone/trajectory.csv"));
    // Of many runs accelerations are not recorded.
    let is_of_sweep = |name: &str| name == "energy" || (name.starts_with('m') && !name.contains(".a"));
    for (name, value) in names.split(',').zip(trajectory.last().unwrap()).filter(|(name, _)| is_of_sweep(name)) {
        assert_eq!(number(name).to_bits(), value.to_bits(), "{name}");
    }
}

#[test]
fn runs_that_stop_or_are_refused_are_rows_with_a_reason() {
    let folder = folder();
    let summary = json(&folder, &format!("{} --json --out a", GRID.replace("--quiet", "")));
    let (header, rows) = cells(&table(&folder, "a"));
    assert_eq!((rows.len(), &summary["runs"], &summary["refused"]), (18, &18.into(), &6.into()));
    let status = column(&header, &rows, "status");
    assert!(status[..6].iter().all(|status| *status == "refused"), "a mass of −1: {status:?}");
    let count = |word: &str| status.iter().filter(|status| **status == word).count();
    assert_eq!((&summary["completed"], &summary["stopped"]), (&count("completed").into(), &count("stopped").into()));
    assert!(count("stopped") > 0 && count("completed") > 0, "{status:?}");
    let (reasons, reached) = (column(&header, &rows, "reason"), column(&header, &rows, "stopped_at"));
    for k in 0..rows.len() {
        assert_eq!(reasons[k].is_empty(), status[k] == "completed", "{:?}", rows[k]);
        assert_eq!(!reached[k].is_empty(), status[k] == "stopped", "{:?}", rows[k]);
        assert_eq!(column(&header, &rows, "m1.x")[k].is_empty(), status[k] == "refused", "{:?}", rows[k]);
    }
    assert!(reasons[0].contains("point.m1.mass") && reasons[0].contains("-1"), "{}", reasons[0]);
}

#[test]
fn why_runs_did_not_complete_is_said_on_the_screen() {
    let folder = folder();
    let output = holonom(&folder, &format!("{} --out a", GRID.replace("--quiet", "")));
    let told = text(&output.stderr);
    let of_runs: Vec<&str> = told.lines().filter(|line| line.starts_with("run ")).collect();
    assert_eq!((output.status.code(), of_runs.len()), (Some(0), 5), "{told}");
    assert!(of_runs[0].starts_with("run 1 (point.m1.mass=-1, simulation.step=0.01, simulation.iteration=newton) refused: "), "{told}");
    let (header, rows) = cells(&table(&folder, "a"));
    let failed = column(&header, &rows, "status").iter().filter(|status| **status != "completed").count();
    assert!(failed > 6 && told.contains(&format!("and {} more", failed - 5)), "{told}");
    assert!(text(&holonom(&folder, &format!("{GRID} --out a")).stderr).is_empty(), "quiet is quiet where some completed");

    // Where none completes, also a quiet sweep says why, however often it is asked.
    for words in ["--vary point.m1.mass=-1,-2", "--vary point.m2.mass=1,2 --vary point.m1.mass=-1"] {
        for _ in 0..2 {
            let output = holonom(&folder, &format!("sweep {PAPER} {words} --end 1 --quiet --out none-{}", words.len()));
            let told = text(&output.stderr);
            assert_eq!((output.status.code(), output.stdout.is_empty()), (Some(3), true), "{words}\n{told}");
            assert!(told.contains("point.m1.mass=-1) refused: ") && told.ends_with("no run completed\n"), "{told}");
        }
    }
    // A run that stops has when and why.
    let words = "--set simulation.iteration=simultaneous --set simulation.penalty=1e7 --set simulation.tolerance=1e-9 --end 7";
    let words = format!("sweep {PAPER} --method trapezoidal --vary simulation.subdivide=false {words} --json --out stopped");
    let output = holonom(&folder, &words);
    assert_eq!((output.status.code(), serde_json::from_slice::<Value>(&output.stdout).unwrap()["stopped"].as_u64()), (Some(3), Some(1)));
    assert!(text(&output.stderr).contains("run 1 (simulation.subdivide=false) stopped at 5."), "{}", text(&output.stderr));
}

#[test]
fn the_table_is_the_same_for_any_threads_and_after_a_kill() {
    let folder = folder();
    prints(&folder, &format!("{GRID} --threads 1 --out one"), 0);
    prints(&folder, &format!("{GRID} --threads 2 --out two"), 0);
    let whole = table(&folder, "one");
    assert_eq!(whole, table(&folder, "two"));

    // As a kill leaves it: some lines, the last one torn, no table.
    let journal = fs::read_to_string(folder.path().join("two/sweep.journal")).unwrap();
    let lines: Vec<&str> = journal.split_inclusive('\n').collect();
    for torn in [String::new(), lines[0][..40].into(), lines[0].into(), lines[..8].concat() + &lines[8][..9]] {
        fs::remove_file(folder.path().join("two/sweep.csv")).unwrap();
        fs::write(folder.path().join("two/sweep.journal"), &torn).unwrap();
        prints(&folder, &format!("{GRID} --threads 2 --out two"), 0);
        assert_eq!(whole, table(&folder, "two"), "{torn}");
        let again = fs::read_to_string(folder.path().join("two/sweep.journal")).unwrap();
        assert_eq!(again.lines().count(), 19);
        assert!(torn.lines().count() < 2 || again.starts_with(&lines[..8].concat()), "finished runs are not run again");
    }
}

const LONG: &str = "sweep example:spherical-compound-pendulum --vary point.m1.mass=1..2:150 --end 20 --threads 2 --quiet";

/// Lines of a journal.
fn lines(folder: &Path) -> usize {
    fs::read(folder.join("sweep.journal")).map_or(0, |bytes| bytes.iter().filter(|&&byte| byte == b'\n').count())
}

/// A long sweep at work, with some more than `already` lines in its journal.
fn at_work(folder: &Path, already: usize) -> Child {
    let mut command = Process::new(assert_cmd::cargo::cargo_bin("holonom"));
    let child = command.current_dir(folder.parent().unwrap()).args(LONG.split_whitespace()).arg("--out").arg(folder).spawn().unwrap();
    let begun = Instant::now();
    while lines(folder) < already + 10 && begun.elapsed() < Duration::from_secs(60) {
        std::thread::sleep(Duration::from_millis(2));
    }
    child
}

#[test]
fn a_sweep_that_was_interrupted_and_killed_goes_on() {
    let folder = folder();
    let out = folder.path().join("broken");
    let mut child = at_work(&out, 0);
    Process::new("sh").args(["-c", &format!("kill -INT {}", child.id())]).status().unwrap();
    assert_eq!(child.wait().unwrap().code(), Some(3), "an interrupt ends it as it does a run");
    let interrupted = lines(&out);
    let mut child = at_work(&out, interrupted);
    child.kill().unwrap();
    child.wait().unwrap();
    let killed = lines(&out);
    assert!(10 <= interrupted && interrupted < killed && killed < 151 && !out.join("sweep.csv").exists(), "{interrupted} {killed}");
    prints(&folder, &format!("{LONG} --out broken"), 0);
    prints(&folder, &format!("{LONG} --out whole"), 0);
    assert_eq!(table(&folder, "broken"), table(&folder, "whole"));
}

#[test]
fn nothing_of_another_sweep_is_lost() {
    let folder = folder();
    let words = format!("sweep {PAPER} --end 0.5 --quiet --out a");
    prints(&folder, &format!("{words} --vary point.m1.mass=1,2"), 0);
    let before = table(&folder, "a");
    for other in ["--vary point.m1.mass=1,3", "--vary point.m1.mass=1,2 --step 0.01", "--vary point.m1.mass=1,2 --columns energy"] {
        let message = fails(&folder, &format!("{words} {other}"), 2);
        assert!(message.contains("another sweep") && message.contains("--out"), "{message}");
    }
    assert_eq!(before, table(&folder, "a"));
    // The same sweep again runs nothing, and may ask for another format.
    let summary = json(&folder, &format!("{words} --vary point.m1.mass=1,2 --json --threads 1"));
    assert_eq!((&summary["completed"], &summary["time"]["steps"], &summary["time"]["us_per_step"]), (&2.into(), &0.into(), &Value::Null));
    if cfg!(feature = "parquet") {
        prints(&folder, &format!("{words} --vary point.m1.mass=1,2 --format parquet"), 0);
        assert!(fs::read(folder.path().join("a/sweep.parquet")).unwrap().starts_with(b"PAR1"));
    }
    assert_eq!(before, table(&folder, "a"));
    // A table without its journal could be anybody's.
    fs::remove_file(folder.path().join("a/sweep.journal")).unwrap();
    assert!(fails(&folder, &format!("{words} --vary point.m1.mass=1,2"), 2).contains("sweep.csv"));
}

/// Results of a curve that was changed since are not those of this sweep, also of a curve that only some runs read.
#[test]
fn a_file_that_was_changed_makes_another_sweep() {
    let folder = folder();
    let model = "plane = \"xy\"\n[point.m]\nmass = 1\nposition = [0, 0]\n[table.push]\nfile = \"a.csv\"\n[drive.lead]\ntype = \"point\"\npoint = \"m\"\n\
                 profile = [\"push(t)\", \"0\"]\n[simulation]\nstep = 0.01\nend = 0.1\n";
    fs::write(folder.path().join("lead.toml"), model).unwrap();
    let curve = |name: &str, speed: f64| fs::write(folder.path().join(name), format!("t,x\n0,0\n1,{speed}\n")).unwrap();
    for words in ["--vary point.m.mass=1,2 --out masses", "--vary table.push.file=b.csv,a.csv --out curves"] {
        [("a.csv", 1.0), ("b.csv", 1.0)].iter().for_each(|(name, speed)| curve(name, *speed));
        let words = format!("sweep lead.toml {words} --columns m.x --no-report --quiet");
        prints(&folder, &words, 0);
        prints(&folder, &words, 0);
        curve("a.csv", 2.0);
        assert!(fails(&folder, &words, 2).contains("is of another sweep, which differs in: files"), "{words}");
        prints(&folder, &format!("{words} --force"), 0);
        let name = words.split_whitespace().find(|word| ["masses", "curves"].contains(word)).unwrap();
        let (header, rows) = cells(&table(&folder, name));
        let last: f64 = column(&header, &rows, "m.x")[1].parse().unwrap();
        assert!((last - 0.2).abs() < 1e-9, "{words}: {last}");
    }
}

#[test]
fn samples_follow_from_their_seed_alone() {
    let folder = folder();
    let words = format!("sweep {PAPER} --vary point.m1.mass=1..3 --vary simulation.method=conserving,radau --end 0.1 --quiet");
    for (name, options) in [
        ("a", "--samples 30 --seed 7 --threads 1"),
        ("b", "--samples 30 --seed 7 --threads 2"),
        ("c", "--samples 12 --seed 7"),
        ("d", "--samples 12 --seed 8"),
    ] {
        prints(&folder, &format!("{words} {options} --out {name}"), 0);
    }
    let a = table(&folder, "a");
    assert_eq!(a, table(&folder, "b"));
    assert!(a.starts_with(&table(&folder, "c")), "more samples only add to fewer");
    let (header, rows) = cells(&a);
    let mass: Vec<f64> = column(&header, &rows, "point.m1.mass").iter().map(|mass| mass.parse().unwrap()).collect();
    assert!(mass.iter().all(|mass| (1.0..3.0).contains(mass)) && mass.windows(2).all(|pair| pair[0] != pair[1]), "{mass:?}");
    let methods = column(&header, &rows, "simulation.method");
    assert!(methods.contains(&"conserving") && methods.contains(&"radau"), "{methods:?}");
    let (_, other) = cells(&table(&folder, "d"));
    assert_ne!(rows[0][1], other[0][1]);
}

#[test]
fn columns_are_chosen_and_joints_have_theirs() {
    let folder = folder();
    prints(&folder, "sweep example:slider-crank --vary simulation.step=0.001,0.002 --end 0.01 --quiet --out a", 0);
    let (header, _) = cells(&table(&folder, "a"));
    assert!(header.iter().any(|name| name.ends_with("_rate")) && !header.contains(&"phi_dot".to_string()), "{header:?}");
    prints(&folder, &format!("sweep {PAPER} --vary point.m1.mass=1,2 --end 0.1 --columns m2.x,phi --quiet --out b"), 0);
    let (header, rows) = cells(&table(&folder, "b"));
    assert_eq!(header[11..], ["rejected_steps", "m2.x", "phi"].map(String::from)[..], "{header:?}");
    assert_eq!(rows.len(), 2);
    prints(&folder, &format!("sweep {PAPER} --vary point.m1.mass=1,2 --end 0.1 --set output.points=[\"m2\"] --quiet --out c"), 0);
    let (header, _) = cells(&table(&folder, "c"));
    assert_eq!(header[12..].join(","), "energy,m2.x,m2.y,m2.z,m2.vx,m2.vy,m2.vz");
}

#[test]
fn a_parameter_may_change_what_the_mechanism_is_made_of() {
    let folder = folder();
    prints(&folder, "sweep example:four-bar --vary parameters.N=2,4 --end 0.1 --quiet --out a", 0);
    let (header, rows) = cells(&table(&folder, "a"));
    assert_eq!(column(&header, &rows, "status"), ["completed", "completed"]);
    assert!(rows.iter().all(|row| row.len() == header.len()));
}

#[test]
fn what_cannot_be_swept_is_refused_before_anything_runs() {
    let folder = folder();
    fs::write(folder.path().join("short.toml"), "[point.a]\nmass = 1\nposition = [1, 0, 0]\n").unwrap();
    fs::write(folder.path().join("wrong.toml"), "[point.a]\nmas = 1\nposition = [1, 0, 0]\n").unwrap();
    for (words, told) in [
        (PAPER.to_string(), "--vary"),
        (format!("{PAPER} --vary point.m1.mss=1,2"), "did you mean `mass`"),
        (format!("{PAPER} --vary point.m1.position[0]=1,2"), "a point has no key `position[0]`"),
        (format!("{PAPER} --vary point.m9.mass=1,2"), "`m9`"),
        (format!("{PAPER} --vary paramters.k=1,2"), "paramters"),
        ("example:four-bar --vary parameters.n=1,2".into(), "did you mean `N`"),
        (format!("{PAPER} --vary point.m1=1,2"), "point.m1.mass"),
        (format!("{PAPER} --vary title.x=1,2"), "not a table"),
        (format!("{PAPER} --vary point.m1.mass"), "no `=`"),
        (format!("{PAPER} --vary point.m1.mass=1..2"), "--samples"),
        (format!("{PAPER} --vary point.m1.mass=1..2:1"), "at least 2"),
        (format!("{PAPER} --vary point.m1.mass=20-30:5"), "looks like a range"),
        (format!("{PAPER} --vary point.m1.mass=1.."), "ends its range with nothing"),
        (format!("{PAPER} --vary point.m1.mass=3..1:5"), "write 1..3"),
        (format!("{PAPER} --vary point.m1.mass=1..2:5 --samples 9"), "--samples"),
        (format!("{PAPER} --vary point.m1.mass=1,2 --vary point.m1.mass=3,4"), "twice"),
        (format!("{PAPER} --vary point.m1.mass=1,2 --set point.m1.mass=3"), "set and varied"),
        (format!("{PAPER} --vary simulation.step=1,2 --step 0.1"), "set and varied"),
        (format!("{PAPER} --vary simulation.method=radau,bdf --method bdf"), "--method"),
        (format!("{PAPER} --vary point.m1.mass=1..2:9999 --vary point.m2.mass=1..2:9999"), "runs"),
        (format!("{PAPER} --vary point.m1.mass=1,2 --columns m1.z,m3.x"), "m3.x"),
        (format!("{PAPER} --vary point.m1.mass=1,2 --format npz"), "csv"),
        (format!("{PAPER} --vary point.m1.mass=1,2 --seed 3"), "--samples"),
        (format!("{PAPER} --vary point.m1.mass=1,2 --set simulation.method=fast"), "conserving-ggl"),
        ("short.toml --vary point.a.mass=1,2 --end 1".into(), "--step"),
        ("wrong.toml --vary point.a.mass=1,2 --end 1 --step 0.1".into(), "wrong.toml:2"),
    ] {
        let message = fails(&folder, &format!("sweep {words}"), 2);
        assert!(message.contains(told), "{words}\n{message}");
    }
    assert!(!folder.path().join("results").exists());
    // What only the runs have is enough.
    prints(&folder, "sweep short.toml --vary simulation.step=0.1,0.2 --end 1 --quiet --out a", 0);
    assert!(Path::new(&folder.path().join("a/sweep.csv")).exists());
}

/// Parameters that nothing uses are named, those that are varied as what makes no difference; what a varied formula or a column names is used.
#[test]
fn parameters_that_nothing_uses_are_named() {
    let folder = folder();
    let ball =
        "[parameters]\nh = 1\nidle = 2\nused = 3\n[point.ball]\nmass = 1\nposition = [0, 0, \"h\"]\n[simulation]\nend = 0.1\nstep = 0.01\n";
    fs::write(folder.path().join("ball.toml"), ball).unwrap();
    let told = |words: &str| text(&holonom(&folder, &format!("sweep ball.toml --no-report --out a --force {words}")).stderr);
    let both = told("--vary parameters.idle=1,2");
    assert!(both.contains("note: nothing uses the parameter `idle`, so that its values make no difference\n"), "{both}");
    assert!(both.contains("note: nothing uses the parameter `used`\n"), "{both}");
    let formula = told("--vary parameters.h=used,idle");
    assert!(!formula.contains("nothing uses"), "{formula}");
    let column = told("--vary parameters.h=1,2 --columns ball.z*used*idle");
    assert!(!column.contains("nothing uses"), "{column}");
    assert!(!told("--vary parameters.idle=1,2 --quiet").contains("nothing uses"));
}

/// So are notes that a run begins with: of a force that its steps do not see, of velocities that constraints change, and of the model with its numbers.
#[test]
fn what_runs_begin_with_is_in_the_table() {
    let folder = folder();
    let text = "plane = \"xy\"\ngravity = [0, 0]\n[parameters]\nf = 1\nv = 0\nlimit = 1\n\
                [body.slider]\nmass = 2\ninertia = 1\nposition = [0, 0]\nvelocity = [0, \"v\"]\n\
                [joint.guide]\ntype = \"prismatic\"\nbetween = [\"ground\", \"slider\"]\naxis = [1, 0]\n\
                [force.shaker]\ntype = \"effort\"\njoint = \"guide\"\neffort = \"10*cos(2*pi*f*t)\"\n\
                [force.buffer]\ntype = \"stop\"\njoint = \"guide\"\nupper = \"limit\"\nstiffness = 1e3\n\
                [simulation]\nend = 0.5\nstep = 0.01\n";
    fs::write(folder.path().join("shaken.toml"), text).unwrap();
    for (key, expected) in [
        ("f=1,100", "force.shaker.effort: steps of 0.01 s do not see what this does"),
        ("v=0,1", "to meet the constraints, start velocities were changed: `slider` by 1 m/s"),
        ("limit=1,-1", "force.buffer.upper: `guide.displacement` starts at 0, above its limit -1"),
    ] {
        holonom(&folder, &format!("sweep shaken.toml --vary parameters.{key} --no-report --out a --force"));
        let (header, rows) = cells(&table(&folder, "a"));
        let notes = column(&header, &rows, "notes");
        assert!(!notes[0].contains(expected) && notes[1].contains(expected), "{key}: {notes:?}");
    }
}

/// What is not sure of the runs of a sweep is in its table, and with slips on the screen, in the JSON and in the report: a contact of π √(m/k) = 4.44 ms that
/// steps of 8 ms see once, and those of 0.5 ms nine times.
#[test]
fn notes_of_runs_are_in_the_table_and_named() {
    let folder = folder();
    let text = "plane = \"xy\"\ngravity = [0, 0]\n[parameters]\nidle = 1\n[body.slider]\nmass = 2\ninertia = 1\nposition = [0, 0]\nvelocity = [1.5, 0]\n\
                [joint.guide]\ntype = \"prismatic\"\nbetween = [\"ground\", \"slider\"]\naxis = [1, 0]\n\
                [force.buffer]\ntype = \"stop\"\njoint = \"guide\"\nupper = 0.01234\nstiffness = 1e6\n\
                [simulation]\nend = 0.05\nstep = 8e-3\n";
    fs::write(folder.path().join("impact.toml"), text).unwrap();
    let output = holonom(&folder, "sweep impact.toml --vary simulation.step=5e-4,8e-3 --columns max(abs(buffer.effort)) --json --out a");
    let (said, summary): (String, Value) = (common::text(&output.stderr), serde_json::from_slice(&output.stdout).unwrap());
    let (header, rows) = cells(&table(&folder, "a"));
    let notes = column(&header, &rows, "notes");
    assert!(
        notes[0].is_empty() && notes[1].starts_with("forces act for so few steps") && notes[1].contains("`buffer` for 1 step at 0.016 s"),
        "{notes:?}"
    );
    let of_run = format!("1 of 2 runs has this note, as run 2 in the column `notes`: {}", notes[1]);
    let told = ["nothing uses the parameter `idle`".to_string(), of_run];
    assert_eq!(summary["notes"], serde_json::json!(told));
    let report = fs::read_to_string(folder.path().join("a/report.html")).unwrap();
    for one in told {
        assert!(said.contains(&format!("note: {one}\n")), "{said}");
        assert!(report.contains(&format!("<li><strong>note:</strong> {one}</li>")), "{one}");
    }
}

/// A note that all runs have does not hide that of some of them: each is told once, however its numbers differ. A mass on a spring sinks by m g/k into its
/// equilibrium, and steps of 10 ms see a push of a second and none of a millisecond.
#[test]
fn each_note_of_the_runs_is_told_once() {
    let folder = folder();
    let text = "[parameters]\nlong = 1\nk = 100\n[point.A]\nmass = 1\nposition = [0, 0, 0]\n\
                [force.spring]\ntype = \"spring\"\nbetween = [[0, 0, 1], \"A\"]\nstiffness = \"k\"\n[start]\nequilibrium = true\n\
                [force.push]\ntype = \"expression\"\npoint = \"A\"\nforce = [0, 0, \"100*step(t - 0.513)*step(0.513 + long - t)\"]\n\
                [simulation]\nend = 1\nstep = 1e-2\n";
    fs::write(folder.path().join("sunk.toml"), text).unwrap();
    let vary = "--vary parameters.k=100,200 --vary parameters.long=1,1e-3";
    let output = holonom(&folder, &format!("sweep sunk.toml {vary} --columns A.z --json --out a"));
    let (said, summary): (String, Value) = (common::text(&output.stderr), serde_json::from_slice(&output.stdout).unwrap());
    let told: Vec<&str> = summary["notes"].as_array().unwrap().iter().map(|note| note.as_str().unwrap()).collect();
    assert_eq!(told.len(), 2, "{said}");
    let of_start = "4 of 4 runs have this note, as run 1 in the column `notes`: start.equilibrium: the run begins where all forces balance; that has moved";
    let of_push = "2 of 4 runs have this note, as run 2 in the column `notes`: force.push.force[2]: steps of 0.01 s do not see";
    assert!(told[0].starts_with(of_start) && told[1].starts_with(of_push), "{said}");
}
