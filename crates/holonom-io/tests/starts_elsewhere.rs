//! Starts at coordinates of joints, `[start.JOINT]`.

mod common;

use common::model_with_forces;
use std::f64::consts::PI;

use holonom::model::Model;
use holonom::record::{Recorder, Recording};
use holonom::simulation::{Choice, Method, Simulation, Status};

fn run(model: &Model, step: f64, end: f64) -> Recording {
    let method = Method::resolve(&Choice::default().named("radau")).unwrap();
    let mut simulation = Simulation::new(model.system.clone(), method, step).unwrap();
    assert_eq!(simulation.start().moved, 0.0);
    model.find_reactions(&mut simulation);
    let mut recorder = Recorder::new(&model.channels, &model.system, 1, model.output.constraints());
    assert_eq!(simulation.run(end, &mut recorder), Status::Completed);
    recorder.finish()
}

/// A slider-crank that hangs, with its crank at an angle from the pose along x: written there by hand, or moved there by `start`.
fn crank(written: f64, start: &str, output: &str) -> String {
    let (r, l) = (0.1, 0.4);
    let (sine, cosine) = written.sin_cos();
    let tilt = -(r / l * sine).asin();
    let (pin, wrist) = ([r * cosine, r * sine], r * cosine + l * tilt.cos());
    format!(
        "plane = \"xz\"\n[body]\ncrank = {{ mass = 1.2, inertia = 0.001, position = [{}, {}], orientation = {{ angle = {written} }} }}\n\
         rod = {{ mass = 0.8, inertia = 0.01, position = [{}, {}], orientation = {{ angle = {tilt} }} }}\n\
         piston = {{ mass = 2, inertia = 0.01, position = [{wrist}, 0] }}\n\
         [joint]\nmain = {{ type = \"revolute\", between = [\"ground\", \"crank\"], at = [0, 0] }}\n\
         pin = {{ type = \"revolute\", between = [\"crank\", \"rod\"], at = [{}, {}] }}\n\
         wrist = {{ type = \"revolute\", between = [\"rod\", \"piston\"], at = [{wrist}, 0] }}\n\
         guide = {{ type = \"prismatic\", between = [\"ground\", \"piston\"], axis = [1, 0] }}\n{start}{output}",
        pin[0] / 2.0,
        pin[1] / 2.0,
        (pin[0] + wrist) / 2.0,
        pin[1] / 2.0,
        pin[0],
        pin[1],
    )
}

/// The moved mechanism moves as the one that is written there, from a dead centre too, and its coordinates count from the pose that is written.
#[test]
fn a_moved_mechanism_is_the_one_that_is_written_there() {
    for output in ["", "[output]\nreactions = true\n"] {
        for (written, angle) in [(0.0, 2.1), (0.4, 1.7), (2.1, -1.3), (0.0, -3.1)] {
            let moved = run(&model_with_forces(&crank(written, &format!("[start]\nmain.angle = {angle}\n"), output)), 1e-3, 0.2);
            let by_hand = run(&model_with_forces(&crank(written + angle, "", output)), 1e-3, 0.2);
            for column in ["crank.x", "rod.z", "piston.x", "piston.vx", "main.fx", "guide.fz", "energy", "kinetic"] {
                let [a, b] = [&moved, &by_hand].map(|recording| recording.column(column).unwrap());
                let size = b.iter().fold(1e-3, |size: f64, b| size.max(b.abs()));
                for (a, b) in a.iter().zip(b) {
                    assert!((a - b).abs() < 1e-9 * size, "{column}: {a} and {b} from {written} by {angle} rad");
                }
            }
            assert!((moved.column("main.angle").unwrap()[0] - angle).abs() < 1e-14);
        }
    }
}

/// A drive counts from where the joint is at the start.
#[test]
fn a_driven_joint_begins_elsewhere() {
    let drive = "[drive.motor]\ntype = \"angle\"\njoint = \"main\"\nprofile = \"20*t + 5*t^2\"\n";
    for output in ["", "[output]\nreactions = true\n"] {
        let moved = run(&model_with_forces(&crank(0.3, &format!("[start]\nmain.angle = 1.1\n{drive}"), output)), 1e-3, 0.2);
        let by_hand = run(&model_with_forces(&crank(1.4, drive, output)), 1e-3, 0.2);
        for column in ["crank.x", "piston.x", "piston.vx", "main.fx", "guide.fz", "motor.effort", "motor.power", "work"] {
            let [a, b] = [&moved, &by_hand].map(|recording| recording.column(column).unwrap());
            let size = b.iter().fold(1e-3, |size: f64, b| size.max(b.abs()));
            assert!(a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-9 * size), "{column}");
        }
        for (t, angle) in moved.column("t").unwrap().iter().zip(moved.column("main.angle").unwrap()) {
            assert!((angle - (1.1 + 20.0 * t + 5.0 * t * t)).abs() < 1e-12, "{t}: {angle}");
        }
    }
}

/// The second arm of a double pendulum turns as it does where it has no angular momentum of its own, dθ₂ = −3/2 cos(θ₁ − θ₂) dθ₁, on all of the way,
/// wherever the pendulum stands.
#[test]
fn what_is_left_free_moves_as_little_as_it_can_on_all_of_the_way() {
    for (end, steps) in [(1.0_f64, 1e4), (2.0, 1e4), (-3.0, 1e4)] {
        let h = end / steps;
        let slope = |first: f64, second: f64| -1.5 * (first - second).cos();
        // The midpoint rule, whose error is some h².
        let expected = (0..steps as u32).fold(0.0, |second, k| {
            let first = h * f64::from(k);
            second + h * slope(first + 0.5 * h, second + 0.5 * h * slope(first, second))
        });
        let mut found = Vec::new();
        for away in [0.0, 5.0, -3000.0] {
            let arm = |name: &str, x: f64| format!("[body.{name}]\nmass = 1\ninertia = {}\nposition = [{}, 1]\n", 1.0 / 12.0, away + x);
            let hinge = |name: &str, between: &str, x: f64| {
                format!("[joint.{name}]\ntype = \"revolute\"\nbetween = [{between}]\nat = [{}, 1]\n", away + x)
            };
            let hinges = hinge("j1", "\"ground\", \"a\"", 0.0) + &hinge("j2", "\"a\", \"b\"", 1.0);
            let text = format!("plane = \"xy\"\n{}{}{hinges}[start.j1]\nangle = {end}\n", arm("a", 0.5), arm("b", 1.5));
            let (_, recording) = common::run_every(&model_with_forces(&text), "radau", 1e-3, 1e-3, 1);
            found.push(recording.column("b.angle").unwrap()[0]);
        }
        assert!((found[0] - expected).abs() < 1e-6, "{end} rad: {} for {expected} rad", found[0]);
        assert!(found.iter().all(|angle| (angle - found[0]).abs() < 1e-10), "{end} rad: {found:?}");
    }
}

/// What is not named moves as little as it can: a wheel on the moved arm of a tree keeps its place in the joint.
#[test]
fn coordinates_of_a_tree_in_space_are_all_reached() {
    let text = "[body.column]\nmass = 10\nshape = { cylinder = [0.1, 1] }\nposition = [0, 0, 0.5]\n\
                [body.arm]\nmass = 3\nshape = { box = [1, 0.1, 0.1] }\nposition = [0.5, 0, 1]\n\
                [body.slide]\nmass = 1\nshape = { box = [0.2, 0.1, 0.1] }\nposition = [1, 0, 1]\n\
                [joint.turn]\ntype = \"revolute\"\nbetween = [\"ground\", \"column\"]\nat = [0, 0, 0]\naxis = [0, 0, 1]\n\
                [joint.lift]\ntype = \"revolute\"\nbetween = [\"column\", \"arm\"]\nat = [0, 0, 1]\naxis = [0, -1, 0]\n\
                [joint.out]\ntype = \"prismatic\"\nbetween = [\"arm\", \"slide\"]\naxis = [1, 0, 0]\n\
                [start]\nturn.angle = \"100*deg\"\nlift.angle = 0.7\nout.displacement = 0.3\n";
    for away in ["", "[output]\nreactions = true\n"] {
        let recording = run(&model_with_forces(&format!("{text}{away}")), 1e-3, 0.01);
        let first = |name: &str| recording.column(name).unwrap()[0];
        let (turn, lift, reach) = (100.0 * PI / 180.0, 0.7_f64, 1.3);
        let expected = [reach * lift.cos() * turn.cos(), reach * lift.cos() * turn.sin(), 1.0 + reach * lift.sin()];
        for (name, expected) in ["slide.x", "slide.y", "slide.z"].into_iter().zip(expected) {
            assert!((first(name) - expected).abs() < 1e-12, "{name}: {} and {expected}", first(name));
        }
        let values = [("turn.angle", turn), ("lift.angle", lift), ("out.displacement", 0.3)];
        values.into_iter().for_each(|(name, value)| assert!((first(name) - value).abs() < 1e-13, "{name}"));
    }
}

/// A gear turns the other joint further than half a turn, on the way and at the start, and the joint counts that.
#[test]
fn a_gear_may_turn_another_joint_more_than_half_a_turn() {
    for angle in [0.5, 1.0, -2.9, 3.1] {
        let model = model_with_forces(&format!(
            "gravity = [0, 0, 0]\n\
             [body.a]\nmass = 1\ninertia = [1, 1, 1]\nposition = [0, 0, 0]\n[body.b]\nmass = 1\ninertia = [1, 1, 1]\nposition = [2, 0, 0]\n\
             [joint.slow]\ntype = \"revolute\"\nbetween = [\"ground\", \"a\"]\nat = [0, 0, 0]\naxis = [0, 0, 1]\n\
             [joint.fast]\ntype = \"revolute\"\nbetween = [\"ground\", \"b\"]\nat = [2, 0, 0]\naxis = [0, 0, 1]\n\
             [joint.gear]\ntype = \"gear\"\njoints = [\"slow\", \"fast\"]\nratio = 0.25\n\
             [force.motor]\ntype = \"effort\"\njoint = \"slow\"\neffort = 1\n[start.slow]\nangle = {angle}\n"
        ));
        let recording = run(&model, 0.01, 0.1);
        let first = |name: &str| recording.column(name).unwrap()[0];
        assert!((first("slow.angle") - angle).abs() < 1e-12 && (first("fast.angle") - 4.0 * angle).abs() < 1e-11, "{angle} rad");
        // 1 + 4² kg m² along the slow one.
        let end = *recording.column("slow.angle").unwrap().last().unwrap();
        assert!((end - angle - 0.5 * 0.01 / 17.0).abs() < 1e-9, "{angle} rad: {end}");
    }
}

/// An arm of two links on two cylinders: the cylinder of the joint that is moved gets as long as it takes and counts its stroke from there, the other
/// one keeps its length. The distance itself may be given there in place of a stroke.
#[test]
fn cylinders_follow_the_joints_that_they_hold() {
    let (angle, boom, stick) = (0.4_f64, [0.5, -0.5], [0.5, -0.4]);
    // From the eye of a cylinder to that on the arm, which turns about the joint.
    let length = |[eye, foot]: [f64; 2], q: f64| ((eye * q.cos()).powi(2) + (eye * q.sin() - foot).powi(2)).sqrt();
    for (moved, profile) in [("boom", false), ("boom", true), ("stick", false)] {
        let [of_boom, of_stick] = ["boom", "stick"].map(|joint| if joint == moved { angle } else { 0.0 });
        let stroke = match profile {
            true => format!("profile = \"{} + 0.1*t^2\"", length(boom, angle)),
            false => "stroke = \"0.1*t^2\"".to_string(),
        };
        let model = model_with_forces(&format!(
            "plane = \"xz\"\n[body.a]\nmass = 10\ninertia = 1\nposition = [0.5, 0]\npoints = {{ eye = [0, 0], foot = [0.5, -0.4], end = [0.5, 0] }}\n\
             [body.b]\nmass = 5\ninertia = 0.5\nposition = [1.5, 0]\npoints = {{ eye = [0, 0] }}\n\
             [joint.boom]\ntype = \"revolute\"\nbetween = [\"ground\", \"a\"]\nat = [0, 0]\n\
             [joint.stick]\ntype = \"revolute\"\nbetween = [\"a\", \"b\"]\nat = [1, 0]\n\
             [drive.lift]\ntype = \"distance\"\nbetween = [[0, -0.5], \"a.eye\"]\n{stroke}\n\
             [drive.curl]\ntype = \"distance\"\nbetween = [\"a.foot\", \"b.eye\"]\nstroke = \"0\"\n\
             [start]\n{moved}.angle = {angle}\n"
        ));
        let recording = run(&model, 0.01, 0.1);
        let [lift, curl] = [length(boom, of_boom), length(stick, of_stick)];
        for (column, row, expected) in [
            ("boom.angle", 0, of_boom),
            ("stick.angle", 0, of_stick),
            ("lift.length", 0, lift),
            ("curl.length", 0, curl),
            ("lift.length", recording.rows() - 1, lift + 0.001),
            ("curl.length", recording.rows() - 1, curl),
        ] {
            let found = recording.column(column).unwrap()[row];
            assert!((found - expected).abs() < 1e-12, "{moved} moved, {column} in row {row}: {found} and not {expected}");
        }
        // Both links and their cylinders hang at the ground: forces are those of the whole weight.
        assert!(recording.column("lift.effort").unwrap()[0] > 15.0 * 9.81);
    }
}

/// A crank that turns at the start moves all else as its geometry says, from the pose that is written and from another one.
#[test]
fn a_mechanism_starts_at_the_rate_of_a_joint() {
    let (r, l, rate) = (0.1_f64, 0.4_f64, 7.0);
    for output in ["", "[output]\nreactions = true\n"] {
        for (written, angle, start) in [(0.6, 0.0, "main.angle_rate = 7\n"), (0.4, 1.7, "main = { angle = 1.7, angle_rate = 7 }\n")] {
            let recording = run(&model_with_forces(&crank(written, &format!("[start]\n{start}"), output)), 1e-3, 0.01);
            let first = |name: &str| recording.column(name).unwrap()[0];
            let (sine, cosine) = (written + angle).sin_cos();
            let speed = -r * sine * rate - r * r * sine * cosine * rate / (l * l - r * r * sine * sine).sqrt();
            assert!((first("main.angle_rate") - rate).abs() < 1e-12 && (first("main.angle") - angle).abs() < 1e-12);
            assert!((first("piston.vx") - speed).abs() < 1e-12, "{start}: {} and not {speed}", first("piston.vx"));
            assert!(first("phi_dot") < 1e-12);
        }
    }
}

/// All other velocities change as little as they can, in the metric of the mass.
#[test]
fn the_smallest_change_of_velocities_leaves_momenta() {
    // Two parts that float, with a hinge between them: the rate is made by an impulse between the two, which leaves both momenta.
    let text = "gravity = [0, 0, 0]\n[body.a]\nmass = 3\ninertia = [1, 2, 1.5]\nposition = [0, 0, 0]\nvelocity = [0.5, 0, 0.2]\n\
                [body.b]\nmass = 1\ninertia = [0.3, 0.2, 0.1]\nposition = [1, 0, 0]\nvelocity = [0.5, 0, 0.2]\n\
                [joint.hinge]\ntype = \"revolute\"\nbetween = [\"a\", \"b\"]\nat = [0.6, 0, 0]\naxis = [0, 0, 1]\n";
    for output in ["", "[output]\nreactions = true\n"] {
        let model = model_with_forces(&format!("{text}[start]\nhinge.angle_rate = 2\n{output}"));
        let simulation = model_simulation(&model);
        assert!((simulation.coordinate("hinge.angle").unwrap()[1] - 2.0).abs() < 1e-13);
        let expected = [2.0, 0.0, 0.8];
        let momenta = simulation.audit().momenta;
        assert!((0..3).all(|k| (momenta[k] - expected[k]).abs() < 1e-12), "{momenta:?}");
        // About the origin: m r × v of the part b, at x = 1 m.
        let turning = [0.0, -0.2, 0.0];
        assert!((0..3).all(|k| (momenta[3 + k] - turning[k]).abs() < 1e-12), "{momenta:?}");
    }
}

fn model_simulation(model: &Model) -> Simulation {
    Simulation::new(model.system.clone(), Method::resolve(&Choice::default()).unwrap(), 1e-3).unwrap()
}

/// A cylinder gets as long as it takes, also where a motor turns another joint that begins elsewhere: its drive waits for it there.
#[test]
fn a_cylinder_follows_beside_a_motor() {
    let arm = "plane = \"xz\"\n[body.a]\nmass = 1\ninertia = 1\nposition = [0.5, 0]\npoints = { lug = [0, 0.3] }\n\
               [body.b]\nmass = 1\ninertia = 1\nposition = [1, 0.5]\npoints = { eye = [0, 0] }\n\
               [joint.shoulder]\ntype = \"revolute\"\nbetween = [\"ground\", \"a\"]\nat = [0, 0]\n\
               [joint.elbow]\ntype = \"revolute\"\nbetween = [\"a\", \"b\"]\nat = [1, 0]\n\
               [drive.motor]\ntype = \"angle\"\njoint = \"shoulder\"\nprofile = \"0.2*t\"\n\
               [drive.cylinder]\ntype = \"distance\"\nbetween = [\"a.lug\", \"b.eye\"]\nstroke = \"0.1*t\"\n\
               [start]\nshoulder.angle = 0.5\nelbow.angle = 0.3\n";
    let recording = run(&common::model(arm), 1e-2, 0.5);
    let column = |name: &str| recording.column(name).unwrap();
    let [shoulder, elbow, length] = ["shoulder.angle", "elbow.angle", "cylinder.length"].map(column);
    let far = |elbow: f64| (0.5 - 0.5 * elbow.sin()).hypot(0.5 * elbow.cos() - 0.3);
    for (k, t) in column("t").iter().enumerate() {
        assert!((shoulder[k] - 0.5 - 0.2 * t).abs() < 1e-12 && (length[k] - far(0.3) - 0.1 * t).abs() < 1e-12, "{t} s");
        assert!((far(elbow[k]) - length[k]).abs() < 1e-12, "{t} s");
    }
    assert!((elbow[0] - 0.3).abs() < 1e-12);
}

/// What no joint ties to the ground is moved by a start, and a note says by how much: both parts of a platform with a turret turn against each other.
#[test]
fn a_start_says_what_it_moves_that_nothing_ties() {
    let parts = |between: &str| {
        format!(
            "gravity = [0, 0, 0]\n[body.platform]\nmass = 10\ninertia = [1, 1, 1]\nposition = [0, 0, 0]\n[body.turret]\nmass = 10\n\
             inertia = [1, 1, 1]\nposition = [0, 0, 0]\n[joint.slew]\ntype = \"revolute\"\nbetween = [\"platform\", \"turret\"]\nat = [0, 0, 0]\n\
             axis = [0, 0, 1]\n{between}[start.slew]\nangle = 1.0\n"
        )
    };
    let notes = common::model(&parts("")).notes;
    assert!(notes.iter().any(|note| note.contains("`platform` by 0.5 rad, `turret` by 0.5 rad")), "{notes:?}");
    let tied = "[joint.base]\ntype = \"revolute\"\nbetween = [\"ground\", \"platform\"]\nat = [0, 0, 0]\naxis = [0, 0, 1]\n";
    let notes = common::model(&parts(tied)).notes;
    assert!(notes.len() == 1 && notes[0].contains("joints that [start] does not name were moved, too"), "{notes:?}");
    assert!(notes[0].contains(": `base.angle` is -0.5 rad (name them"), "{notes:?}");
    for whole in ["[start.base]\nangle = 0.0\n", "[start.base]\nangle = 0.2\n"] {
        assert!(common::model(&parts(&format!("{tied}{whole}"))).notes.is_empty());
    }
    // Rates of a joint alone set off the others, too, as an impulse between the two bodies does.
    for (rate, other) in [("1.0", "-0.5"), ("2e-9", "-1e-9")] {
        let rate = format!("angle_rate = {rate}");
        let notes = common::model(&parts(&format!("{tied}[start.base]\nangle = 0.0\n")).replace("angle = 1.0", &rate)).notes;
        assert!(notes.len() == 1 && notes[0].contains(&format!("`base.angle_rate` is {other} rad/s")), "{notes:?}");
    }
}

/// What the joints that are named take along is no choice of theirs, and cannot be named with 0: of a crank with its slider, on which a pendulum hangs,
/// and of a screw's nut the note tells what else is free.
#[test]
fn a_start_does_not_say_what_must_follow() {
    let slider = "plane = \"xy\"\n[body.crank]\nmass = 1\ninertia = 0.1\nposition = [0.5, 0]\n[body.slider]\nmass = 1\ninertia = 0.1\nposition = [3, 0]\n\
                  [body.bob]\nmass = 1\ninertia = 0.1\nposition = [3, -1]\n\
                  [joint.main]\ntype = \"revolute\"\nbetween = [\"ground\", \"crank\"]\nat = [0, 0]\n\
                  [joint.guide]\ntype = \"prismatic\"\nbetween = [\"ground\", \"slider\"]\naxis = [1, 0]\n\
                  [joint.rod]\ntype = \"distance\"\nbetween = [\"crank\", \"slider\"]\nat = [[1, 0], [3, 0]]\n\
                  [joint.pivot]\ntype = \"revolute\"\nbetween = [\"slider\", \"bob\"]\nat = [3, 0]\n[start.main]\nangle = 0.5\nangle_rate = 2\n";
    let screw = "gravity = [0, 0, 0]\n[body.arm]\nmass = 1\ninertia = [1, 1, 1]\nposition = [0.5, 0, 0]\n[body.nut]\nmass = 1\ninertia = [1, 1, 1]\n\
                 position = [1, 0, 0]\n[joint.hinge]\ntype = \"revolute\"\nbetween = [\"ground\", \"arm\"]\nat = [0, 0, 0]\naxis = [0, 0, 1]\n\
                 [joint.spindle]\ntype = \"screw\"\nbetween = [\"arm\", \"nut\"]\nat = [1, 0, 0]\naxis = [0, 0, 1]\npitch = 0.5\n\
                 [start.spindle]\nangle = 1.0\nangle_rate = 1.0\n";
    for (text, free) in [(slider, "`pivot.angle` is 0.16"), (screw, "`hinge.angle` is -0.")] {
        let notes = common::model(text).notes;
        let [note] = &notes[..] else { panic!("{notes:?}") };
        let told = note.split("of the mass: ").nth(1).unwrap_or_default();
        assert!(told.starts_with(free) && told.contains("rad (name") && !told.contains("more"), "{note}");
    }
}

/// Where the joints that are named leave nothing free the others follow, and there is nothing to say of it.
#[test]
fn a_start_that_leaves_nothing_free_is_not_noted() {
    let four_bar = "plane = \"xy\"\n[body.crank]\nmass = 1\ninertia = 0.1\nposition = [0, 0.5]\n[body.rod]\nmass = 1\ninertia = 0.1\nposition = [1, 1.2]\n\
                    [body.rocker]\nmass = 1\ninertia = 0.1\nposition = [2, 0.7]\n\
                    [joint.a]\ntype = \"revolute\"\nbetween = [\"ground\", \"crank\"]\nat = [0, 0]\n\
                    [joint.b]\ntype = \"revolute\"\nbetween = [\"crank\", \"rod\"]\nat = [0, 1]\n\
                    [joint.c]\ntype = \"revolute\"\nbetween = [\"rod\", \"rocker\"]\nat = [2, 1.4]\n\
                    [joint.d]\ntype = \"revolute\"\nbetween = [\"ground\", \"rocker\"]\nat = [2, 0]\n\
                    [start.a]\nangle = 0.3\nangle_rate = 2\n";
    // Without the ground the loop floats, and all of its angles still follow from one of them.
    let floating =
        four_bar.replace("\"ground\", \"rocker\"", "\"base\", \"rocker\"").replace("\"ground\", \"crank\"", "\"base\", \"crank\"");
    let base = "[body.base]\nmass = 3\ninertia = 0.3\nposition = [1, 0]\n";
    for text in [four_bar.to_string(), format!("{}{base}", floating.replace("angle = 0.3\n", ""))] {
        let notes = common::model(&text).notes;
        assert!(notes.is_empty(), "{notes:?}");
    }
}

/// Coordinates of joints with several: a plate on a table and a shaft at a universal joint begin where they are put.
#[test]
fn joints_with_several_coordinates_begin_where_they_are_put() {
    let text = "gravity = [0, 0, 0]\n[body.plate]\nmass = 1\ninertia = [0.1, 0.1, 0.2]\nposition = [0, 0, 0]\n\
                [body.shaft]\nmass = 1\ninertia = [0.1, 0.1, 0.2]\nposition = [2, 0, 0]\n\
                [joint.table]\ntype = \"planar\"\nbetween = [\"ground\", \"plate\"]\nat = [0, 0, 0]\naxis = [0, 0, 1]\n\
                [joint.cross]\ntype = \"universal\"\nbetween = [\"ground\", \"shaft\"]\nat = [2, 0, 0]\naxes = [[1, 0, 0], [0, 1, 0]]\n\
                [start.table]\nx = 0.1\ny = -0.2\nangle = 0.3\ny_rate = 0.5\n[start.cross]\nangle1 = 0.4\nangle2 = -0.2\nangle2_rate = 2\n";
    let recording = run(&model_with_forces(text), 0.01, 0.01);
    let first = |name: &str| recording.column(name).unwrap()[0];
    let expected = [
        ("table.x", 0.1),
        ("table.y", -0.2),
        ("table.angle", 0.3),
        ("table.y_rate", 0.5),
        ("table.x_rate", 0.0),
        ("cross.angle1", 0.4),
        ("cross.angle2", -0.2),
        ("cross.angle2_rate", 2.0),
    ];
    for (name, value) in expected {
        assert!((first(name) - value).abs() < 1e-12, "{name}: {}", first(name));
    }
}

/// A step of a run, whose first row is where it begins.
fn begun(text: &str) -> Recording {
    common::run_every(&common::model(text), "radau", 1e-2, 0.01, 1).1
}

/// Wheels roll to where a run begins: one on a rail by its radius times the angle, and the two of a cart on circles about one middle.
#[test]
fn wheels_roll_to_the_start() {
    let wheel = |name: &str, y: f64| {
        format!(
            "[body.{name}]\nmass = 1\nshape = {{ cylinder = [0.2, 0.02] }}\norientation = {{ axis = [1, 0, 0], angle = \"pi/2\" }}\n\
             position = [0, {y}, 0.2]\n\
             [joint.axle-{name}]\ntype = \"revolute\"\nbetween = [\"cart\", \"{name}\"]\nat = \"{name}\"\naxis = [0, 1, 0]\n\
             [joint.tread-{name}]\ntype = \"rolling\"\nbetween = [\"ground\", \"{name}\"]\nat = \"{name}\"\naxis = [0, 1, 0]\n\
             normal = [0, 0, 1]\nradius = 0.2\n"
        )
    };
    let cart = "[body.cart]\nmass = 20\ninertia = [2, 3, 4]\nposition = [0.3, 0, 0.3]\n";
    let rail = "[joint.rail]\ntype = \"prismatic\"\nbetween = [\"ground\", \"cart\"]\naxis = [1, 0, 0]\n";
    for motor in ["", "[drive.motor]\ntype = \"angle\"\njoint = \"axle-one\"\nprofile = \"7*t\"\n"] {
        for (start, way) in [("axle-one.angle = 3", 0.6), ("axle-one.angle = -0.1", -0.02), ("rail.displacement = 1", 1.0)] {
            if !motor.is_empty() && start.starts_with("rail") {
                continue;
            }
            let recording = begun(&format!("{cart}{rail}{}{motor}[start]\n{start}\n", wheel("one", 0.1)));
            let first = |name: &str| recording.column(name).unwrap()[0];
            assert!((first("rail.displacement") - way).abs() < 1e-11, "{start}: {}", first("rail.displacement"));
            // The wheel turns by more than half a turn for a way of 1 m: its angle goes on.
            assert!((0.2 * first("axle-one.angle") - way).abs() < 1e-11, "{start}: {}", first("axle-one.angle"));
        }
    }
    let foot = "[joint.foot]\ntype = \"point-on-plane\"\nbetween = [\"ground\", \"cart\"]\nat = [0.8, 0, 0]\naxis = [0, 0, 1]\n";
    let text = format!("{cart}{}{}{foot}[start]\naxle-left.angle = 0.5\n", wheel("left", 0.4), wheel("right", -0.4));
    let recording = begun(&text);
    let first = |name: &str| recording.column(name).unwrap()[0];
    let ways = ["left", "right"].map(|name| 0.2 * first(&format!("axle-{name}.angle")));
    assert!((ways[0] - 0.1).abs() < 1e-12 && ways[1] > 0.0);
    let (mean, yaw) = (0.5 * (ways[0] + ways[1]), (ways[1] - ways[0]) / 0.8);
    let expected = [mean / yaw * yaw.sin(), mean / yaw * (1.0 - yaw.cos())];
    for (k, axis) in ["x", "y"].into_iter().enumerate() {
        let middle = 0.5 * (first(&format!("left.{axis}")) + first(&format!("right.{axis}")));
        assert!((middle - expected[k]).abs() < 1e-11, "{axis}: {middle} and not {}", expected[k]);
    }
}

/// A start may be many times farther than the mechanism is large, and begin where nothing shows how large it is.
#[test]
fn starts_are_as_far_as_they_are_written() {
    let trolley = "[body.trolley]\nmass = 1\nshape = { box = [0.2, 0.2, 0.2] }\nposition = [0, 0, 0]\n\
                   [joint.rail]\ntype = \"prismatic\"\nbetween = [\"ground\", \"trolley\"]\naxis = [0, 1, 0]\n[start]\nrail.displacement = 1e4\n";
    let bead = "plane = \"xy\"\n[point.bead]\nmass = 1\nposition = [0, 0]\n[joint.wire]\ntype = \"point-on-line\"\nbetween = [\"ground\", \"bead\"]\n\
                at = [0, 0]\naxis = [0, 1]\n[start]\nwire.displacement = 1\n";
    for (text, column, place) in [(trolley, "trolley.y", 1e4), (bead, "bead.y", 1.0)] {
        let recording = begun(text);
        assert!((recording.column(column).unwrap()[0] - place).abs() < 1e-12 * place);
    }
    let corners: Vec<String> = (0..24).map(|k| (15.0 * f64::from(k)).to_radians().sin_cos()).map(|(s, c)| format!("[{c}, {s}]")).collect();
    for way in [2.0, 2.9, 3.0, 4.0, -4.0, 6.0, 10.0] {
        let text = format!(
            "plane = \"xy\"\n[point.bead]\nmass = 1\nposition = [1, 0]\n[joint.ring]\ntype = \"point-on-curve\"\nbetween = [\"ground\", \"bead\"]\n\
             at = [1, 0]\nclosed = true\ncurve = [{}]\n[start]\nring.displacement = {way}\n",
            corners.join(", ")
        );
        let recording = begun(&text);
        let first = |name: &str| recording.column(name).unwrap()[0];
        assert!((first("ring.displacement") - way).abs() < 1e-11);
        // The spline is off the circle by 1e-5 of its radius, and shorter by less than 3e-3 in all.
        assert!((first("bead.x") - way.cos()).abs() < 0.03 && (first("bead.y") - way.sin()).abs() < 0.03, "{way} m");
    }
}

/// Forces are none of the way's business: one that has no value in the pose that is written, nor on most of the way, acts where the run begins.
#[test]
fn forces_without_values_on_the_way_do_not_keep_a_mechanism_from_its_start() {
    let text = "plane = \"xy\"\n[body.a]\nmass = 1\ninertia = 0.1\nposition = [0.5, 0]\n[joint.j]\ntype = \"revolute\"\n\
                between = [\"ground\", \"a\"]\nat = [0, 0]\n[force.m]\ntype = \"effort\"\njoint = \"j\"\neffort = \"sqrt(j.angle - 1.5)\"\n\
                [start.j]\nangle = 2\nangle_rate = 0.5\n";
    let recording = run(&model_with_forces(text), 1e-3, 0.01);
    let first = |name: &str| recording.column(name).unwrap()[0];
    assert!((first("j.angle") - 2.0).abs() < 1e-14 && (first("j.angle_rate") - 0.5).abs() < 1e-14);
    // The arm's inertia about the hinge is 0.1 + 0.5² kg·m².
    assert!((first("a.alpha") - 0.5_f64.sqrt() / 0.35).abs() < 1e-12, "{}", first("a.alpha"));
}
