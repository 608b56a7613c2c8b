//! Forces of constraints that are no joints, in every run: against statics, Newton's law and motions that are known.

mod common;

use common::{column, model, near};
use holonom::model::{Model, constraints};
use holonom::record::Recording;

const G: f64 = 9.81;

fn run_of(model: &Model, method: &str, end: f64) -> Recording {
    common::run_every(model, method, 0.002, end, 1).1
}

fn run(text: &str, end: f64) -> Recording {
    run_of(&model(text), "conserving-ggl", end)
}

/// The first row of some columns.
#[track_caller]
fn at_start(recording: &Recording, expected: &[(&str, f64)]) {
    expected.iter().for_each(|(name, expected)| near(name, column(recording, name)[0], *expected, 1e-11));
}

/// What is kept fixed bears its own weight and the tension of the rod that hangs on it, as the speed of the bob tells it.
#[test]
fn a_fixed_point_bears_what_hangs_on_it() {
    for plane in [true, false] {
        let [head, at, bob, axes] = match plane {
            true => ["plane = \"xz\"\n", "[0.2, 3]", "[1.4, 1.4]", "xz"],
            false => ["", "[0.2, 7, 3]", "[1.4, 7, 1.4]", "xyz"],
        };
        let text = format!(
            "{head}[point.pivot]\nmass = 0.5\nposition = {at}\n[point.bob]\nmass = 2\nposition = {bob}\n\
             [constraint.hook]\ntype = \"fixed\"\npoint = \"pivot\"\n[constraint.rod]\ntype = \"distance\"\nbetween = [\"pivot\", \"bob\"]\n"
        );
        let recording = run_of(&model(&text), "conserving-ggl", 1.0);
        for k in 0..recording.rows() {
            let of = |name: &str| column(&recording, name)[k];
            let (x, z) = (of("bob.x") - 0.2, of("bob.z") - 3.0);
            let tension = 2.0 * (of("bob.vx").powi(2) + of("bob.vz").powi(2) - G * z) / 2.0;
            near("along x", of("hook.fx"), -tension * x / 2.0, 1e-10);
            near("along z", of("hook.fz"), 0.5 * G - tension * z / 2.0, 1e-10);
            near("in all", of("hook.f"), of("hook.fx").hypot(of("hook.fz")), 1e-14);
            if !plane {
                near("along y", of("hook.fy"), 0.0, 1e-12);
            }
        }
        let names = axes.chars().map(|axis| format!("hook.f{axis}"));
        for name in names.chain(["hook.f".into()]) {
            assert_eq!(recording.find(&name).unwrap().heading.unit, "N", "{name}");
        }
        assert_eq!(&*recording.find("hook.fz").unwrap().heading.meaning, "force of the constraint on the point, along z of the world");
    }
}

/// A hand that goes up and down carries a mass: what it pushes with is on the second point of the two.
#[test]
fn two_points_that_stay_together_push_each_other() {
    for (between, sign) in [("[\"hand\", \"load\"]", 1.0), ("[\"load\", \"hand\"]", -1.0)] {
        let text = format!(
            "plane = \"xz\"\n[point.hand]\nmotion = [0, \"0.1*sin(7*t)\"]\n[point.load]\nmass = 3\nposition = [0.4, 0.3]\nvelocity = [0, 0.7]\n\
             [constraint.grip]\ntype = \"fixed\"\nbetween = {between}\n"
        );
        let recording = run(&text, 1.0);
        for (k, t) in column(&recording, "t").iter().enumerate() {
            near("grip", column(&recording, "grip.fz")[k], sign * 3.0 * (G - 4.9 * (7.0 * t).sin()), 1e-10);
        }
        assert_eq!(
            &*recording.find("grip.fx").unwrap().heading.meaning,
            "force of the constraint on the second point, along x of the world"
        );
    }
}

/// A bead slides down a wedge without friction, and the wedge on the floor: the wedge pushes it with m g cos α/(1 + m/M sin² α), and the floor
/// bears both but for what falls.
#[test]
fn lines_push_what_slides_on_them() {
    let (bead, wedge, slope) = (2.0, 3.0, 0.7_f64);
    let push = bead * G * slope.cos() / (1.0 + bead / wedge * slope.sin().powi(2));
    for plane in [true, false] {
        let [head, zero, high, x, along] = match plane {
            true => ["plane = \"xz\"\n", "[0, 0]", "[\"-cos(0.7)\", \"sin(0.7)\"]", "[1, 0]", "[\"cos(0.7)\", \"-sin(0.7)\"]"],
            false => ["", "[0, 0, 0]", "[\"-cos(0.7)\", 0, \"sin(0.7)\"]", "[5, 0, 0]", "[\"cos(0.7)\", 0, \"-sin(0.7)\"]"],
        };
        let text = format!(
            "{head}[point.wedge]\nmass = {wedge}\nposition = {zero}\n[point.bead]\nmass = {bead}\nposition = {high}\n\
             [constraint.floor]\ntype = \"point-on-line\"\npoint = \"wedge\"\ndirection = {x}\n\
             [constraint.slide]\ntype = \"point-on-line\"\npoint = \"bead\"\ndirection = {along}\nthrough = \"wedge\"\n"
        );
        let recording = run(&text, 0.5);
        for k in 0..recording.rows() {
            let of = |name: &str| column(&recording, name)[k];
            near("slide, x", of("slide.fx"), push * slope.sin(), 1e-11);
            near("slide, z", of("slide.fz"), push * slope.cos(), 1e-11);
            near("slide", of("slide.f"), push, 1e-11);
            near("floor", of("floor.fz"), wedge * G + push * slope.cos(), 1e-11);
            near("floor, along itself", of("floor.fx"), 0.0, 1e-11);
            // Either gives the other what it gets.
            near("wedge", wedge * of("wedge.ax"), -of("slide.fx"), 1e-11);
        }
    }
}

/// A spring along the line pulls a bead, and does not change what the line pushes with; a puck on a plane that is tilted.
#[test]
fn lines_and_planes_push_across_themselves() {
    let text = "[point.bead]\nmass = 2\nposition = [3, 0, -4]\nvelocity = [0.3, 0, -0.4]\n[constraint.rail]\ntype = \"point-on-line\"\n\
                point = \"bead\"\ndirection = [3, 0, -4]\n[force.spring]\ntype = \"spring\"\nbetween = [\"ground\", \"bead\"]\nstiffness = 50\n\
                [point.puck]\nmass = 1.5\nposition = [1, 2, 3]\nvelocity = [0.2, 0, 0]\n[constraint.ramp]\ntype = \"point-on-plane\"\n\
                point = \"puck\"\nnormal = [0, -6, 8]\n";
    let recording = run(text, 0.5);
    for k in 0..recording.rows() {
        let of = |name: &str| column(&recording, name)[k];
        // Across the line, of the weight.
        [("rail.fx", 0.48), ("rail.fy", 0.0), ("rail.fz", 0.36)]
            .into_iter()
            .for_each(|(name, share)| near(name, of(name), 2.0 * G * share, 1e-10));
        [("ramp.fx", 0.0), ("ramp.fy", -0.48), ("ramp.fz", 0.64)]
            .into_iter()
            .for_each(|(name, share)| near(name, of(name), 1.5 * G * share, 1e-10));
        near("ramp.f", of("ramp.f"), 1.5 * G * 0.8, 1e-10);
    }
}

/// A bead on a rod that is turned evenly flies out as r = r₀ cosh Ω t, and the rod pushes it across itself with 2 m Ω ṙ: by one row, by the two of places
/// that slide, on either side of the line.
#[test]
fn a_line_that_turns_pushes_a_bead() {
    let (mass, spin) = (0.4, 3.0_f64);
    for plane in [true, false] {
        let zero = if plane { "" } else { ", 0" };
        let head = if plane { "plane = \"xy\"\ngravity = [0, 0]\n" } else { "gravity = [0, 0, 0]\n" };
        let bodies = format!(
            "{head}[point.tip]\nmotion = [\"cos({spin}*t)\", \"sin({spin}*t)\"{zero}]\n[point.bead]\nmass = {mass}\nposition = [0.2, 0{zero}]\n\
             velocity = [0, 0.6{zero}]\n"
        );
        for line in ["[\"ground\", \"tip\"]", "[\"tip\", \"ground\"]", "[\"tip\", [0, 0]]"] {
            let line = line.replace("[0, 0]", &format!("[0, 0{zero}]"));
            let text = format!("{bodies}[constraint.rod]\ntype = \"point-on-line\"\npoint = \"bead\"\nline = {line}\n");
            let recording = run_of(&model(&text), "radau", 0.6);
            for (k, t) in column(&recording, "t").iter().enumerate() {
                let (along, push) = (spin * t, 2.0 * mass * spin.powi(2) * 0.2 * (spin * t).sinh());
                near("rod.fx", column(&recording, "rod.fx")[k], -push * along.sin(), 1e-8);
                near("rod.fy", column(&recording, "rod.fy")[k], push * along.cos(), 1e-8);
            }
        }
        let text = format!("{bodies}[constraint.rod]\ntype = \"collinear\"\npoints = [\"ground\", \"bead\", \"tip\"]\n");
        let recording = run_of(&model(&text), "radau", 0.6);
        let last = recording.rows() - 1;
        let [t, fx, fy] = ["t", "rod.bead.fx", "rod.bead.fy"].map(|name| column(&recording, name)[last]);
        let push = 2.0 * mass * spin.powi(2) * 0.2 * (spin * t).sinh();
        near("collinear, x", fx, -push * (spin * t).sin(), 1e-8);
        near("collinear, y", fy, push * (spin * t).cos(), 1e-8);
        // By the lever of the bead about the origin.
        let lever = 0.2 * (spin * t).cosh();
        near("on the tip", column(&recording, "rod.tip.f")[last], push * lever, 1e-8);
    }
}

/// Two masses on a straight line that is let go level: the line keeps the outer one back, by 0.2 of its weight, with 0.4 of that on the inner one.
#[test]
fn a_straight_line_bends_what_falls() {
    for plane in [true, false] {
        let zero = if plane { "" } else { "0, " };
        let head = if plane { "plane = \"xz\"\n" } else { "" };
        let text = |second: &str, line: &str| {
            format!(
                "{head}[point.P]\nrepeat = \"i = 1 to 2\"\nmass = 1\nposition = [\"i\", {zero}0]\n[constraint.first]\ntype = \"distance\"\n\
                 between = [\"ground\", \"P[1]\"]\n[constraint.second]\ntype = \"distance\"\nbetween = {second}\n[constraint.line]\n{line}\n"
            )
        };
        let lines = ["[\"ground\", \"P[1]\", \"P[2]\"]", "[\"P[2]\", \"P[1]\", \"ground\"]"];
        // With three rows in space, one of them redundant, where the distances are those of the row of points, and else with two.
        for (second, points) in
            ["[\"ground\", \"P[2]\"]", "[\"P[1]\", \"P[2]\"]"].map(|second| lines.map(|points| (second, points))).concat()
        {
            let recording = run(&text(second, &format!("type = \"collinear\"\npoints = {points}")), 0.01);
            let expected = [("line.P[1].fx", 0.0), ("line.P[1].fz", 0.4 * G), ("line.P[2].fx", 0.0), ("line.P[2].fz", -0.2 * G)];
            at_start(&recording, &expected);
            assert!(!recording.columns().iter().any(|column| column.heading.name.starts_with("line.ground")));
            let recording = run(&text(second, "type = \"point-on-line\"\npoint = \"P[1]\"\nline = [\"ground\", \"P[2]\"]"), 0.01);
            at_start(&recording, &[("line.fx", 0.0), ("line.fz", 0.4 * G)]);
        }
    }
}

/// Two arms at a right angle, one level and one upright: the level one falls and takes the other along, with a moment as it has inertia.
#[test]
fn a_right_angle_turns_both_arms() {
    let (level, upright) = (2.0, 3.0);
    let moment = 4.0 * upright * level * G / (level + 4.0 * upright);
    for plane in [true, false] {
        let [head, zero] = if plane { ["plane = \"xz\"\n", ""] } else { ["", "0, "] };
        let keep =
            ["a", "b"].map(|name| format!("[constraint.flat-{name}]\ntype = \"point-on-plane\"\npoint = \"{name}\"\nnormal = [0, 1, 0]\n"));
        for (first, second, sign) in [("a", "b", 1.0), ("b", "a", -1.0)] {
            let text = format!(
                "{head}[point.a]\nmass = {level}\nposition = [1, {zero}0]\n[point.b]\nmass = {upright}\nposition = [0, {zero}-2]\n\
                 [constraint.one]\ntype = \"distance\"\nbetween = [\"ground\", \"a\"]\n[constraint.two]\ntype = \"distance\"\nbetween = [\"ground\", \"b\"]\n\
                 [constraint.square]\ntype = \"perpendicular\"\nfirst = [\"ground\", \"{first}\"]\nsecond = [\"ground\", \"{second}\"]\n{}",
                if plane { String::new() } else { keep.concat() }
            );
            let recording = run(&text, 0.01);
            // From x to z, in space about −y; the moment on the level arm is the other way.
            match plane {
                true => at_start(&recording, &[("square.t", -sign * moment)]),
                false => {
                    at_start(&recording, &[("square.tx", 0.0), ("square.ty", sign * moment), ("square.tz", 0.0), ("square.t", moment)])
                }
            }
            let name = if plane { "square.t" } else { "square.ty" };
            assert_eq!(recording.find(name).unwrap().heading.unit, "N·m");
            assert!(recording.column("square.fx").is_none());
        }
    }
}

/// A circle as a formula pulls as the rod of a pendulum does, however the formula is written.
#[test]
fn a_circle_pulls_as_a_rod() {
    let pendulum = |constraint: &str| {
        run(
            &format!(
                "plane = \"xz\"\n[point.bob]\nmass = 2\nposition = [0.6, -0.8]\nvelocity = [0.8, 0.6]\n[constraint.c]\n{constraint}\n"
            ),
            1.0,
        )
    };
    let rod = pendulum("type = \"distance\"\nbetween = [\"ground\", \"bob\"]");
    for value in ["bob.x^2 + bob.z^2 - 1", "7 - 7*sqrt(bob.x^2 + bob.z^2)", "distance(bob, ground) - 1"] {
        let recording = pendulum(&format!("type = \"expression\"\nvalue = \"{}\"", value));
        for k in 0..recording.rows() {
            let (tension, of) = (column(&rod, "c.force")[k], |name: &str| column(&recording, name)[k]);
            let expected = [-tension * column(&rod, "bob.x")[k], -tension * column(&rod, "bob.z")[k]];
            near(value, of("c.bob.fx"), expected[0], 1e-6);
            near(value, of("c.bob.fz"), expected[1], 1e-6);
            // To round-off by its own motion.
            near(value, of("c.bob.fx"), 2.0 * of("bob.ax"), 1e-11);
            near(value, of("c.bob.fz"), 2.0 * (of("bob.az") + G), 1e-11);
        }
        assert_eq!(&*recording.find("c.bob.fz").unwrap().heading.meaning, "force of the constraint on this place, along z of the world");
    }
}

/// A formula of two places, one of them of a body, that moves over time: each is pushed by what Newton's law says, also where the formula reads a measure.
#[test]
fn a_formula_pushes_all_that_it_names() {
    let text = "[point.a]\nmass = 2\nposition = [0, 0, 1]\n[body.beam]\nmass = 3\ninertia = [1, 2, 3]\nposition = [5, 0, 3]\npoints = { tip = [-1, 0, 0] }\n\
                [measure.gap]\nvalue = \"beam.tip.z - 2*a.z\"\n[constraint.lift]\ntype = \"expression\"\nvalue = \"gap - 1 - 0.3*sin(2*t)\"\n";
    let recording = run_of(&model(text), "radau", 0.4);
    for k in 0..recording.rows() {
        let of = |name: &str| column(&recording, name)[k];
        near("a", of("lift.a.fz"), 2.0 * (of("a.az") + G), 1e-10);
        near("tip", of("lift.beam.tip.fz"), 3.0 * (of("beam.az") + G), 1e-10);
        near("both", of("lift.a.fz"), -2.0 * of("lift.beam.tip.fz"), 1e-12);
        near("along x", of("lift.a.fx").abs() + of("lift.beam.tip.fx").abs(), 0.0, 1e-15);
    }
    // At the tip, and so 1 m beside the middle of the beam: about y with 2 kg·m².
    near("turns", 2.0 * column(&recording, "beam.alphay")[0], column(&recording, "lift.beam.tip.fz")[0], 1e-10);
}

/// A bead on a dome as a formula: the force is along the slope of the dome, and leaves the bead with no power.
#[test]
fn constraints_without_time_do_no_work() {
    let example = |name: &str| constraints::KINDS.iter().find(|kind| kind.name == name).unwrap().example;
    let recording = run(&example("expression").replace("[1, 0, 0.5]", "[1, 0, 0.5]\nvelocity = [0, 1, 0]"), 0.5);
    for k in 0..recording.rows() {
        let of = |name: &str| column(&recording, name)[k];
        let [force, v] = [["dome.bead.fx", "dome.bead.fy", "dome.bead.fz"], ["bead.vx", "bead.vy", "bead.vz"]].map(|names| names.map(of));
        near("power", force[0] * v[0] + force[1] * v[1] + force[2] * v[2], 0.0, 1e-9);
        near("slope", force[0], of("bead.x") * force[2], 1e-12);
        near("slope", force[1], of("bead.y") * force[2], 1e-12);
    }
}
