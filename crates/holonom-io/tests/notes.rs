//! What looks like a slip in a model and is taken all the same: it is noted, and the model moves as it is written.

mod common;

use common::{model, run};
use holonom::model::Model;
use holonom::simulation::Choice;
use holonom_io::Source;

fn read(text: &str) -> Result<Model, String> {
    Source::read("model.toml", text.as_bytes()).and_then(|source| source.model())
}

/// A free body that no body has: the last moment exceeds the sum of the others.
const MOMENTS: [f64; 3] = [0.5, 1.0, 2.0];
const SPIN: [f64; 3] = [0.3, 1.5, 0.4];

fn top(waived: &str) -> String {
    format!("gravity = [0, 0, 0]\n[body.top]\nmass = 3\ninertia = {MOMENTS:?}\nposition = [0, 0, 0]\nangular_velocity = {SPIN:?}\n{waived}")
}

/// Angular velocity in world axes by Euler's equations and the quaternion's, with the rule of Runge and Kutta in small steps.
fn euler(end: f64) -> [f64; 3] {
    let rate = |y: [f64; 7]| {
        let ([q, a, b, c], w) = ([y[0], y[1], y[2], y[3]], [y[4], y[5], y[6]]);
        let turn = |k: usize| {
            let (i, j) = ((k + 1) % 3, (k + 2) % 3);
            (MOMENTS[i] - MOMENTS[j]) / MOMENTS[k] * w[i] * w[j]
        };
        [
            0.5 * (-a * w[0] - b * w[1] - c * w[2]),
            0.5 * (q * w[0] + b * w[2] - c * w[1]),
            0.5 * (q * w[1] + c * w[0] - a * w[2]),
            0.5 * (q * w[2] + a * w[1] - b * w[0]),
            turn(0),
            turn(1),
            turn(2),
        ]
    };
    let steps = 20_000;
    let h = end / f64::from(steps);
    let mut y = [1.0, 0.0, 0.0, 0.0, SPIN[0], SPIN[1], SPIN[2]];
    for _ in 0..steps {
        let after = |slope: [f64; 7], h: f64| std::array::from_fn(|k| y[k] + h * slope[k]);
        let first = rate(y);
        let second = rate(after(first, 0.5 * h));
        let third = rate(after(second, 0.5 * h));
        let fourth = rate(after(third, h));
        y = std::array::from_fn(|k| y[k] + h / 6.0 * (first[k] + 2.0 * second[k] + 2.0 * third[k] + fourth[k]));
    }
    let turn = nalgebra::UnitQuaternion::new_normalize(nalgebra::Quaternion::new(y[0], y[1], y[2], y[3]));
    (turn * nalgebra::Vector3::new(y[4], y[5], y[6])).into()
}

#[test]
fn an_inertia_that_no_body_has_moves_as_it_is_written() {
    assert!(read(&top("")).err().expect("it is checked").contains("check_inertia = false"));
    let model = model(&top("check_inertia = false\n"));
    assert_eq!(model.notes, ["body.top.inertia: the moments 0.5, 1, 2 cannot belong to a body: 2 exceeds 0.5 + 1 by 0.5"]);
    let expected = euler(3.0);
    for method in ["radau", "conserving-ggl", "conserving", "generalized-alpha"] {
        let choice = Choice::default().named(method);
        let (simulation, recording) = run(&model, choice, 1e-3, 3.0);
        let found = ["top.wx", "top.wy", "top.wz"].map(|column| *recording.column(column).unwrap().last().unwrap());
        let off = found.iter().zip(expected).fold(0.0, |worst: f64, (found, expected)| worst.max((found - expected).abs()));
        println!("{method}: {off:e}, {:e} J", simulation.audit().energy_summary().max_drift);
        assert!(off < 1e-5, "{method}: {found:?} and {expected:?}");
    }
}

/// A moment about the axis alone, as people write it of what only turns there.
#[test]
fn a_door_may_have_a_moment_about_its_hinge_alone() {
    let door = "[body.door]\nmass = 2\ninertia = [0, 0, 0.3]\nposition = [0.5, 0, 0]\nangular_velocity = [0, 0, 1]\nvelocity = [0, 0.5, 0]\n\
                check_inertia = false\n[joint.hinge]\ntype = \"revolute\"\nbetween = [\"ground\", \"door\"]\nat = [0, 0, 0]\naxis = [0, 0, 1]\n\
                [force.closer]\ntype = \"torsion\"\njoint = \"hinge\"\nstiffness = 2\n";
    let model = model(door);
    let (simulation, recording) = run(&model, Choice::default(), 1e-3, 2.0);
    let omega = (2.0_f64 / (0.3 + 2.0 * 0.25)).sqrt();
    let (t, angle) = (recording.column("t").unwrap(), recording.column("hinge.angle").unwrap());
    let off = t.iter().zip(angle).fold(0.0, |worst: f64, (t, angle)| worst.max((angle - (omega * t).sin() / omega).abs()));
    assert!(off < 1e-6 && simulation.audit().energy_summary().max_drift < 1e-12, "{off}");
}

#[test]
fn negative_moments_are_refused_all_the_same() {
    let text = top("check_inertia = false\n").replace("[0.5, 1.0, 2.0]", "[0.5, -1.0, 2.0]");
    assert!(read(&text).err().expect("it is wrong").contains("-1 is negative"));
}

/// A crank that is driven and a rod, with a run.
fn driven(profile: &str, length: &str, run: &str) -> Vec<String> {
    let text = format!(
        "[body.crank]\nrepeat = \"i = 1 to 3\"\nmass = 1\nshape = {{ box = [1, 0.1, 0.1] }}\nposition = [\"i\", 0, 0]\n\
         [joint.hinge]\nrepeat = \"i = 1 to 3\"\ntype = \"revolute\"\nbetween = [\"ground\", \"crank[i]\"]\nat = [\"i\", 0, 0]\naxis = [0, 0, 1]\n\
         [drive.motor]\nrepeat = \"i = 1 to 3\"\ntype = \"angle\"\njoint = \"hinge[i]\"\nprofile = \"{profile}\"\n\
         [point.bob]\nmass = 1\nposition = [0, 0, -1]\n[constraint.rod]\ntype = \"distance\"\nbetween = [\"ground\", \"bob\"]\nlength = \"{length}\"\n\
         [force.push]\ntype = \"effort\"\njoint = \"hinge[1]\"\neffort = \"step(t - 0.5)\"\n[simulation]\n{run}\n"
    );
    model(&text).notes
}

#[test]
fn motions_that_jump_and_long_steps_are_noted() {
    let run = "end = 2\nstep = 0.01";
    assert_eq!(driven("sin(t)", "1 + 0.1*t^2", run), [""; 0]);
    assert_eq!(driven("step(t - 3)", "1", run), [""; 0], "it is after the end");
    assert_eq!(
        driven("i*step(t - 1)", "1 + 0.1*max(t - 0.5, 0)", run),
        [
            "constraint.rod.length: its rate jumps by 0.1 per s at 0.5 s, which is a blow: round it off",
            "drive.motor.profile: it jumps by 1 at 1 s, which nothing can follow: let it change over some steps"
        ]
    );
    assert_eq!(driven("0", "1", "end = 2\nstep = 3"), ["simulation.step: the step of 3 s is longer than the run of 2 s"]);
    assert_eq!(driven("step(t - 1)", "1", "step = 3"), [""; 0], "the end is not known");
}

/// A table that ends with a slope, and the run with it: its last row has the rate of the slope.
#[test]
fn what_jumps_where_the_run_ends_is_not_noted() {
    let notes = |end: f64| {
        model(&format!(
            "plane = \"xy\"\n[table.way]\npoints = [[0, 0], [1, 0.5], [2, 0.7]]\ninterpolation = \"cubic\"\n\
             [body.a]\nmass = 1\ninertia = 1\nposition = [0, 0]\n\
             [joint.rail]\ntype = \"prismatic\"\nbetween = [\"ground\", \"a\"]\naxis = [1, 0]\n\
             [drive.push]\ntype = \"displacement\"\njoint = \"rail\"\nprofile = \"way(t)\"\n[simulation]\nend = {end}\nstep = 0.1\n"
        ))
        .notes
    };
    assert_eq!(notes(2.0), [""; 0]);
    assert_eq!(notes(2.1), ["drive.push.profile: its rate jumps by -0.125 per s at 2 s, which is a blow: round it off"]);
}

/// A spline through points at uneven distances, of a table as of a drive's own profile; other interpolations stay within what is written.
#[test]
fn splines_that_swing_are_noted() {
    let points = "[[0, 0], [0.02, 1], [0.04, 0], [1, 0], [2, 0]]";
    let noted = |table: &str, profile: &str| {
        let text = format!(
            "plane = \"xy\"\n{table}[body.a]\nmass = 1\ninertia = 1\nposition = [0, 0]\n\
             [joint.rail]\ntype = \"prismatic\"\nbetween = [\"ground\", \"a\"]\naxis = [1, 0]\n\
             [drive.push]\ntype = \"displacement\"\njoint = \"rail\"\nprofile = {profile}\n"
        );
        model(&text).notes.into_iter().filter(|note| note.contains("between its points this goes from -12.1344 to 4.10643")).count()
    };
    assert_eq!(noted("", &format!("{{ table = {points} }}")), 1);
    for (interpolation, notes) in [("cubic", 1), ("monotone", 0), ("linear", 0)] {
        let table = format!("[table.way]\npoints = {points}\ninterpolation = \"{interpolation}\"\n");
        assert_eq!(noted(&table, "\"0*t + 1e-9*way(t)\""), notes, "{interpolation}");
    }
}

/// A stop that is in contact from the start is noted, also where a start has moved its joint.
#[test]
fn a_stop_that_pushes_from_the_start_is_noted() {
    let flap = |stop: &str, start: &str| {
        let text = format!(
            "plane = \"xy\"\n[body.flap]\nmass = 1\ninertia = 0.1\nposition = [0.5, 0]\n\
             [joint.h]\ntype = \"revolute\"\nbetween = [\"ground\", \"flap\"]\nat = [0, 0]\n\
             [force.s]\ntype = \"stop\"\njoint = \"h\"\nstiffness = 1e4\n{stop}\n{start}"
        );
        model(&text).notes
    };
    let lower = "force.s.lower: `h.angle` starts at 0, below its limit 0.1: the stop pushes with 1000 N·m from the start";
    assert_eq!(flap("lower = 0.1", ""), [lower]);
    let upper = "force.s.upper: `h.angle` starts at 0.5, above its limit 0.2: the stop pushes with 3000 N·m from the start";
    assert_eq!(flap("lower = 0.1\nupper = 0.2", "[start.h]\nangle = 0.5\n"), [upper]);
    assert_eq!(flap("lower = -0.1\nupper = 0", ""), [""; 0]);
}

/// So is one that pushes because the start of another joint moves its own there, and one that does not push there any more is not.
#[test]
fn a_stop_is_noted_where_the_start_takes_it() {
    let slider = |limits: &str, start: &str| {
        let text = format!(
            "plane = \"xy\"\n[body.crank]\nmass = 1\ninertia = 0.1\nposition = [0.5, 0]\n[body.slider]\nmass = 1\ninertia = 0.1\nposition = [3, 0]\n\
             [joint.main]\ntype = \"revolute\"\nbetween = [\"ground\", \"crank\"]\nat = [0, 0]\n\
             [joint.guide]\ntype = \"prismatic\"\nbetween = [\"ground\", \"slider\"]\naxis = [1, 0]\n\
             [joint.rod]\ntype = \"distance\"\nbetween = [\"crank\", \"slider\"]\nat = [[1, 0], [3, 0]]\n\
             [force.s]\ntype = \"stop\"\njoint = \"guide\"\nstiffness = 1e4\n{limits}\n{start}"
        );
        model(&text).notes
    };
    // With the crank at a right angle the slider is √(2² − 1²) from the ground.
    let start = "[start.main]\nangle = \"90*deg\"\n";
    let lower = "force.s.lower: `guide.displacement` starts at -1.26795, below its limit -1: the stop pushes with 2679.49 N from the start";
    assert_eq!(slider("lower = -1", start), [lower]);
    assert_eq!(slider("lower = \"sqrt(3) - 3\"\nupper = -1", start), [""; 0]);
}

/// Degrees where radians are meant are taken as they are written, and noted.
#[test]
fn orientations_of_more_than_a_turn_are_noted() {
    let notes = |orientation: &str| {
        let text = format!("[body.a]\nmass = 1\ninertia = [1, 1, 1]\nposition = [0, 0, 0]\norientation = {{ {orientation} }}\n");
        model(&text).notes
    };
    let note = |key: &str, angle: f64| {
        format!("body.a.orientation.{key}: {angle} rad is more than a full turn; degrees are written as `{key}_deg`")
    };
    assert_eq!(notes("axis = [0, 0, 1], angle = 90"), [note("angle", 90.0)]);
    assert_eq!(notes("rpy = [0, 0, -90]"), [note("rpy", -90.0)]);
    for right in ["axis = [0, 0, 1], angle = \"-tau\"", "axis = [0, 0, 1], angle_deg = 90", "rpy_deg = [0, 0, 90]", "rpy = [0, 3, 6]"] {
        assert_eq!(notes(right), [""; 0], "{right}");
    }
    // Who writes the unit means it.
    for right in ["axis = [0, 0, 1], angle = \"400*deg\"", "rpy = [\"400*deg\", 0, \"-2*200*deg\"]"] {
        assert_eq!(notes(right), [""; 0], "{right}");
    }
    assert_eq!(notes("rpy = [\"400*deg\", 0, \"2*90\"]"), [note("rpy", 180.0)]);
    // So does who writes it in a parameter, or in one that others are made of.
    let tilted = |tilt: &str| {
        model(&format!(
            "[parameters]\ntilt = {tilt}\ntwice = \"2*tilt\"\n[body.a]\nmass = 1\ninertia = [1, 1, 1]\nposition = [0, 0, 0]\n\
             orientation = {{ rpy = [\"tilt\", 0, \"twice\"] }}\n"
        ))
        .notes
    };
    assert_eq!(tilted("\"400*deg\""), [""; 0]);
    assert_eq!(tilted("\"4*100\""), [note("rpy", 400.0)]);
    let planar = "plane = \"xy\"\n[body.a]\nmass = 1\ninertia = 1\nposition = [0, 0]\norientation = { angle = 45 }\n";
    assert_eq!(model(planar).notes, [note("angle", 45.0)]);
}

#[test]
fn gravity_across_the_plane_is_noted() {
    let notes = |head: &str| model(&format!("{head}\n[point.a]\nmass = 1\nposition = [0, 0]\n")).notes;
    let note = |across: &str| {
        format!("gravity: its {across} m/s² is across the plane xz of the model and does not act: write two numbers, or take another plane")
    };
    assert_eq!(notes("plane = \"xz\"\ngravity = [0, 3, -9.81]"), [note("y = 3")]);
    assert_eq!(notes("plane = \"xz\"\ngravity = [0, -9.81, 0]"), [note("y = -9.81")]);
    for right in ["gravity = [0, 0, -9.81]", "gravity = [1, -9.81]", ""] {
        assert_eq!(notes(&format!("plane = \"xz\"\n{right}")), [""; 0], "{right}");
    }
}

/// A radius in millimetres.
#[test]
fn sections_larger_than_their_beam_are_noted() {
    let notes = |radius: f64| {
        model(&format!("[beam.b]\nfrom = [0, 0, 0]\nto = [1, 0, 0]\nsection = {{ circle = {radius} }}\nmodulus = 2e11\ndensity = 7800\n"))
            .notes
    };
    assert_eq!(notes(0.4), [""; 0]);
    assert_eq!(notes(3.0), ["beam.b.section: the section is 6 m across, and the beam 1 m long: check units"]);
}

/// A planet on an elastic pin: a gear of angles pushes the pin by nothing, so that it does not yield. On one carrier nothing is noted.
#[test]
fn gears_on_bearings_that_yield_are_noted() {
    let text = |pin: &str| {
        format!(
            "[body.carrier]\nmass = 6\nshape = {{ cylinder = [0.1, 0.02] }}\nposition = [0, 0, 0]\n\
             [body.sun]\nmass = 2\nshape = {{ cylinder = [0.05, 0.04] }}\nposition = [0, 0, 0]\n\
             [body.pin]\nmass = 0.3\ninertia = [2e-4, 2e-4, 1e-4]\nposition = [0.1, 0, 0]\n\
             [body.planet]\nmass = 1\nshape = {{ cylinder = [0.05, 0.04] }}\nposition = [0.1, 0, 0]\n\
             [joint.main]\ntype = \"revolute\"\nbetween = [\"ground\", \"carrier\"]\nat = [0, 0, 0]\naxis = [0, 0, 1]\n\
             [joint.input]\ntype = \"revolute\"\nbetween = [\"carrier\", \"sun\"]\nat = [0, 0, 0]\naxis = [0, 0, 1]\n\
             [joint.bearing]\ntype = \"revolute\"\nbetween = [\"{pin}\", \"planet\"]\nat = [0.1, 0, 0]\naxis = [0, 0, 1]\n\
             [joint.mesh]\ntype = \"gear\"\njoints = [\"input\", \"bearing\"]\nratio = -1\n\
             [force.seat]\ntype = \"bushing\"\nbetween = [\"pin\", \"carrier\"]\nat = [0.1, 0, 0]\nstiffness = [5e7, 5e7, 5e7, 1e5, 1e5, 1e5]\n"
        )
    };
    let notes = model(&text("pin")).notes;
    assert_eq!(notes.len(), 1, "{notes:?}");
    assert!(notes[0].contains("the wheels of `mesh` yield here against each other"), "{notes:?}");
    assert_eq!(model(&text("carrier")).notes, Vec::<String>::new());
}
