//! Natural frequencies over keys: columns of modes in a sweep, beside closed forms.

mod common;

use std::f64::consts::TAU;
use std::fs;

use common::*;
use tempfile::TempDir;

const G: f64 = 9.81;

/// A mass that hangs on a spring and a damper.
const HANGING: &str = "gravity = [0, 0, -9.81]\n[parameters]\nk = 50\nc = 0\n[body.m]\nmass = 2\nshape = { sphere = 0.1 }\nposition = [0, 0, 0]\n\
                       [joint.r]\ntype = \"prismatic\"\nbetween = [\"ground\", \"m\"]\naxis = [0, 0, 1]\n\
                       [force.k]\ntype = \"torsion\"\njoint = \"r\"\nstiffness = \"k\"\ndamping = \"c\"\n[start]\nequilibrium = true\n";

/// Two masses that hang below each other.
const DOUBLE: &str = "plane = \"xz\"\n[parameters]\nl = 1\n[point.a]\nmass = 1\nposition = [0, -1]\n[point.b]\nmass = 1\nposition = [0, \"-1 - l\"]\n\
                      [constraint.upper]\ntype = \"distance\"\nbetween = [\"ground\", \"a\"]\n\
                      [constraint.lower]\ntype = \"distance\"\nbetween = [\"a\", \"b\"]\n";

/// A link that stands on a spring of 100 N·m/rad under a load, beside a mass on a spring of its own.
const COLUMN: &str = "plane = \"xz\"\ngravity = [0, 0]\n[parameters]\nP = 0\n[body.a]\nmass = 2\ninertia = \"1/6\"\nposition = [0, 0.5]\n\
                      points = { top = [0, 0.5] }\n[joint.pin]\ntype = \"revolute\"\nbetween = [\"ground\", \"a\"]\nat = [0, 0]\n\
                      [force.k]\ntype = \"torsion\"\njoint = \"pin\"\nstiffness = 100\n\
                      [force.load]\ntype = \"constant\"\npoint = \"a.top\"\nforce = [0, \"-P\"]\n\
                      [body.b]\nmass = 1\ninertia = 1\nposition = [3, 0]\n[joint.rail]\ntype = \"prismatic\"\nbetween = [\"ground\", \"b\"]\naxis = [1, 0]\n\
                      [force.spring]\ntype = \"torsion\"\njoint = \"rail\"\nstiffness = 400\n";

/// The table that a sweep leaves, and what it said on standard error.
struct Swept {
    header: Vec<String>,
    rows: Vec<Vec<String>>,
    said: String,
}

impl Swept {
    #[track_caller]
    fn words(&self, name: &str) -> Vec<&str> {
        let k = self.header.iter().position(|column| column == name).unwrap_or_else(|| panic!("{name} in {:?}", self.header));
        self.rows.iter().map(|row| row[k].as_str()).collect()
    }

    /// The numbers of a column; NaN where there is none.
    #[track_caller]
    fn numbers(&self, name: &str) -> Vec<f64> {
        self.words(name).iter().map(|cell| if cell.is_empty() { f64::NAN } else { cell.parse().unwrap() }).collect()
    }

    /// That a column has the numbers of closed forms, and none where these are not numbers.
    #[track_caller]
    fn assert(&self, name: &str, expected: impl IntoIterator<Item = f64>) {
        let (found, expected) = (self.numbers(name), expected.into_iter().collect::<Vec<f64>>());
        assert_eq!(found.len(), expected.len());
        let is_near =
            |(found, expected): (&f64, &f64)| (found - expected).abs() <= 1e-9 * expected.abs() || found.is_nan() && expected.is_nan();
        assert!(found.iter().zip(&expected).all(is_near), "{name}: {found:?} for {expected:?}");
    }
}

/// Sweeps a model with words that are split at blanks.
#[track_caller]
fn sweep(folder: &TempDir, model: &str, words: &str, status: i32) -> Swept {
    fs::write(folder.path().join("m.toml"), model).unwrap();
    let output = holonom(folder, &format!("sweep m.toml {words} --out out --force"));
    let said = on_one_line(&text(&output.stderr));
    assert_eq!(output.status.code(), Some(status), "{said}");
    let table = fs::read_to_string(folder.path().join("out/sweep.csv")).unwrap_or_default();
    let mut lines = table.lines().map(holonom_io::csv_cells);
    Swept { header: lines.next().unwrap_or_default(), rows: lines.collect(), said }
}

/// 2 z'' + c z' + k z = 0. Without a spring the mass falls, and those runs alone say so.
#[test]
fn a_mass_on_a_spring_over_stiffness_and_damping() {
    let folder = folder();
    let words = "--vary parameters.k=0,50,5e7 --vary parameters.c=4,40 --columns frequency(1),damping(1),growth(1) --threads";
    let found = sweep(&folder, HANGING, &format!("{words} 2"), 0);
    let over = |of: fn(f64, f64) -> f64| {
        [(f64::NAN, 4.0), (f64::NAN, 40.0), (50.0, 4.0), (50.0, 40.0), (5e7, 4.0), (5e7, 40.0)].map(|(k, c)| of(k, c))
    };
    // Roots of a negative square are no numbers.
    found.assert("frequency(1)", over(|k, c| (k / 2.0 - c * c / 16.0).sqrt() / TAU));
    found.assert("damping(1)", over(|k, c| (c / (8.0 * k).sqrt()).acos().cos()));
    found.assert("growth(1)", over(|k, c| -0.25 * c + (c * c / 16.0 - k / 2.0).max(0.0 * k).sqrt()));
    let status = found.words("status");
    assert_eq!(status, ["refused", "refused", "completed", "completed", "completed", "completed"]);
    let (reason, said) = (found.words("reason")[0], &found.said);
    assert!(reason.contains("does not come to rest") && said.contains("run 1 (parameters.k=0, parameters.c=4) refused"), "{said}");
    assert!(said.contains("`frequency(1)` has no value in one run of 6, where mode 1 does not vibrate"), "{said}");
    let table = fs::read(folder.path().join("out/sweep.csv")).unwrap();
    sweep(&folder, HANGING, &format!("{words} 1"), 0);
    assert_eq!(fs::read(folder.path().join("out/sweep.csv")).unwrap(), table);
}

/// ω² of M = [[2, l], [l, l²]] and K = g diag(2, l); the report has their curves.
#[test]
fn a_double_pendulum_over_a_length() {
    let folder = folder();
    let found = sweep(&folder, DOUBLE, "--vary parameters.l=0.1,0.5,1,10,1e3 --columns frequency(1),frequency(2)", 0);
    let square = |l: f64, sign: f64| G * ((1.0 + l) + sign * (1.0 + l * l).sqrt()) / l;
    for (name, sign) in [("frequency(1)", -1.0), ("frequency(2)", 1.0)] {
        found.assert(name, [0.1, 0.5, 1.0, 10.0, 1e3].map(|l| square(l, sign).sqrt() / TAU));
    }
    let report = fs::read_to_string(folder.path().join("out/report.html")).unwrap();
    for number in [1, 2] {
        assert!(
            report.contains(&format!("frequency({number}) <small>Hz</small>"))
                && report.contains(&format!("frequency({number}) over parameters.l"))
        );
    }
}

/// (2/3) θ'' = (P − 100) θ: the frequency falls to zero at 100 N. Beyond it there is an exponent that grows and no frequency, and the other mode keeps its number.
#[test]
fn a_column_buckles() {
    let folder = folder();
    let loads = [0.0, 50.0, 99.0, 99.9999, 100.0, 101.0, 200.0];
    let given = loads.map(|load| load.to_string()).join(",");
    let columns = "frequency(1),damping(1),growth(1),frequency(2),growth(2),frequency(3),growth(3)";
    let found = sweep(&folder, COLUMN, &format!("--vary parameters.P={given} --columns {columns}"), 0);
    let square = |load: f64| 1.5 * (100.0 - load);
    found.assert("frequency(1)", loads.map(|load| if load < 100.0 { square(load).sqrt() / TAU } else { f64::NAN }));
    found.assert("damping(1)", loads.map(|load| if load < 100.0 { 0.0 } else { f64::NAN }));
    found.assert("growth(1)", loads.map(|load| if load > 100.0 { (-square(load)).sqrt() } else { 0.0 }));
    found.assert("frequency(2)", loads.map(|_| 20.0 / TAU));
    found.assert("growth(2)", loads.map(|_| 0.0));
    found.assert("frequency(3)", loads.map(|_| f64::NAN));
    found.assert("growth(3)", loads.map(|_| f64::NAN));
    let notes = found.words("notes");
    assert!(
        notes[..5].iter().all(|note| note.is_empty()) && notes[6].contains("not stable, as mode 1 grows by the factor e in 0.08165 s"),
        "{notes:?}"
    );
    assert!(found.said.contains("2 of 7 runs have this note, as run 6"), "{}", found.said);
}

/// Two masses on end, on rods of different lengths: both grow, by √(g/l), and neither is hidden by what falls off.
#[test]
fn all_that_grows_is_counted() {
    let folder = folder();
    let model = "plane = \"xz\"\n[parameters]\nl = 1\n[point.a]\nmass = 1\nposition = [0, 1]\n[point.b]\nmass = 3\nposition = [5, \"l\"]\n\
                 [constraint.left]\ntype = \"distance\"\nbetween = [\"ground\", \"a\"]\n\
                 [constraint.right]\ntype = \"distance\"\nbetween = [[5, 0], \"b\"]\n";
    let found = sweep(&folder, model, "--vary parameters.l=0.1,0.25,4 --columns growth(1),growth(2),growth(3)", 0);
    found.assert("growth(1)", [0.1, 0.25, 1.0].map(|l| (G / l).sqrt()));
    found.assert("growth(2)", [1.0, 1.0, 4.0].map(|l| (G / l).sqrt()));
    found.assert("growth(3)", [f64::NAN; 3]);
}

/// Beside columns of a run, and without one where none asks for it.
#[test]
fn runs_are_made_where_columns_ask_for_them() {
    let folder = folder();
    let message = on_one_line(&sweep(&folder, HANGING, "--vary parameters.k=50,200 --columns frequency(1),max(m.z)", 2).said);
    assert!(message.contains("the model has no `step`"), "{message}");
    let both = sweep(&folder, HANGING, "--vary parameters.k=50,200 --columns frequency(1),max(m.z) --end 1 --step 0.01", 0);
    both.assert("frequency(1)", [5.0 / TAU, 10.0 / TAU]);
    both.assert("steps", [100.0, 100.0]);
    both.assert("max(m.z)", [-2.0 * G / 50.0, -2.0 * G / 200.0]);
    let alone = sweep(&folder, HANGING, "--vary parameters.k=50,200 --vary simulation.step=0.01,0.02 --columns frequency(1) --end 1", 0);
    alone.assert("frequency(1)", [5.0, 5.0, 10.0, 10.0].map(|omega| omega / TAU));
    alone.assert("steps", [f64::NAN; 4]);
    assert!(alone.said.contains("take no run, so that `simulation.step`, `simulation.end` make no difference"), "{}", alone.said);
}

/// A blade on a hub that turns: drives stand still for modes, and where they would not it is said.
#[test]
fn drives_that_move_are_told() {
    let folder = folder();
    let model = "plane = \"xy\"\n[parameters]\nw = 10\n[body.hub]\nmass = 1\ninertia = 1\nposition = [0, 0]\n\
                 [body.blade]\nmass = 2\ninertia = 0.01\nposition = [1, 0]\n\
                 [joint.shaft]\ntype = \"revolute\"\nbetween = [\"ground\", \"hub\"]\nat = [0, 0]\n\
                 [joint.flap]\ntype = \"revolute\"\nbetween = [\"hub\", \"blade\"]\nat = [0.2, 0]\n\
                 [force.k]\ntype = \"torsion\"\njoint = \"flap\"\nstiffness = 5\n\
                 [drive.motor]\ntype = \"angle\"\njoint = \"shaft\"\nprofile = \"w*t + 0.3*(1 - cos(20*t))\"\n";
    let found = sweep(&folder, model, "--vary parameters.w=0,1e-3,10 --columns frequency(1)", 0);
    found.assert("frequency(1)", [(5.0_f64 / 1.29).sqrt() / TAU; 3]);
    assert_eq!(
        found.words("notes").iter().map(|note| note.contains("drives move at the start, and stand still")).collect::<Vec<bool>>(),
        [false, true, true]
    );
    assert!(prints(&folder, "modes m.toml", 0).contains("centrifugal"));
    assert_eq!(json(&folder, "modes m.toml --set parameters.w=0 --json")["driven"], false);
}

/// A damper that is harder one way than the other has two slopes at rest: the one that counts is told to be one of two.
#[test]
fn kinks_at_rest_are_told() {
    let folder = folder();
    let model = "plane = \"xz\"\n[table.law]\npoints = [[-1, -800], [0, 0], [1, 300]]\n[body.car]\nmass = 300\ninertia = 1\nposition = [0, 0]\n\
                 [joint.strut]\ntype = \"prismatic\"\nbetween = [\"ground\", \"car\"]\naxis = [0, 1]\n\
                 [force.spring]\ntype = \"torsion\"\njoint = \"strut\"\nstiffness = 2e4\n\
                 [force.damper]\ntype = \"effort\"\njoint = \"strut\"\neffort = \"-law(q_rate)\"\n[start]\nequilibrium = true\n";
    let found = sweep(&folder, model, "--vary force.spring.stiffness=1e4,2e4 --columns damping(1)", 0);
    assert!(found.words("notes").iter().all(|note| note.contains("a force has a kink") && note.ends_with("`damper`")), "{}", found.said);
    assert!(prints(&folder, "modes m.toml", 0).contains("modes are others: `damper`"));
    assert_eq!(json(&folder, "modes m.toml --set table.law.points=[[-1,-300],[1,300]] --json")["kinked"], serde_json::json!([]));
}

#[test]
fn what_is_not_at_rest_is_told_how_it_may_be() {
    let folder = folder();
    let found = sweep(&folder, HANGING, "--vary parameters.k=50,60 --columns frequency(1) --set start.equilibrium=false", 3);
    assert!(found.said.contains("forces do not balance at the start") && found.said.contains("write equilibrium = true"), "{}", found.said);
    let message = sweep(&folder, HANGING, "--vary parameters.k=50,60 --columns sqrt(frequency(1))", 2).said;
    assert!(message.contains("frequency"), "{message}");
}
