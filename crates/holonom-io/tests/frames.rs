//! Bodies whose axes do not begin at their centre of mass, and bars that end at bodies: against the same mechanisms written otherwise.

mod common;

use common::{model, run};
use holonom::record::Recording;
use holonom::simulation::Choice;

/// The largest difference of two recordings in columns that both have.
fn difference(a: &Recording, b: &Recording, prefixes: &[&str]) -> f64 {
    let mut compared = 0;
    let mut worst = 0.0_f64;
    for column in a.columns().iter().filter(|column| prefixes.iter().any(|prefix| column.heading.name.starts_with(prefix))) {
        let other = b.column(&column.heading.name).unwrap_or_else(|| panic!("no {}", column.heading.name));
        assert_eq!(column.values.len(), other.len());
        worst = column.values.iter().zip(other).fold(worst, |worst, (a, b)| worst.max((a - b).abs()));
        compared += 1;
    }
    assert!(compared > 4, "{compared} columns");
    worst
}

/// The same body by its centre of mass and by the origin of a drawing, turned, spinning, on a spring and a hinge.
#[test]
fn a_body_may_be_written_by_the_origin_of_its_axes() {
    // A quarter turn about z takes the centre (0.3, 0.1, 0.2) of body axes to (−0.1, 0.3, 0.2).
    let rest = "orientation = { axis = [0, 0, 1], angle_deg = 90 }\nangular_velocity = [1, -2, 3]\nmass = 2\ninertia = [0.1, 0.2, 0.25, 0.01, 0, 0]\n\
                [force.spring]\ntype = \"spring\"\nbetween = [[0, 0, 1], \"box.lug\"]\nstiffness = 50\nrest_length = 0.5\n\
                [force.thrust]\ntype = \"force\"\nbody = \"box\"\naxes = \"body\"\nforce = [1, \"vx\", 0]\n";
    let by_origin = format!(
        "[body.box]\ncom = [0.3, 0.1, 0.2]\nposition = [1, 2, 0.5]\nvelocity = [0.5, 0, 1]\npoints = {{ lug = [0.5, 0, 0], origin = [0, 0, 0] }}\n{rest}"
    );
    // ω × (−0.1, 0.3, 0.2) = (−2·0.2 − 3·0.3, 3·(−0.1) − 1·0.2, 1·0.3 − 2·0.1)
    let by_centre = format!(
        "[body.box]\nposition = [0.9, 2.3, 0.7]\nvelocity = [{}, {}, {}]\npoints = {{ lug = [0.2, -0.1, -0.2], origin = [-0.3, -0.1, -0.2] }}\n{rest}",
        0.5 - 0.4 - 0.9,
        -0.3 - 0.2,
        1.0 + 0.3 - 0.2
    );
    let [(_, a), (_, b)] = [by_origin, by_centre].map(|text| run(&model(&text), Choice::default().named("radau"), 0.01, 1.0));
    let off = difference(&a, &b, &["box.", "spring.", "thrust."]);
    assert!(off < 1e-10, "{off}");
    let start = ["x", "y", "z", "vx", "vy", "vz"].map(|c| a.column(&format!("box.origin.{c}")).unwrap()[0]);
    assert!(start.iter().zip([1.0, 2.0, 0.5, 0.5, 0.0, 1.0]).all(|(found, given)| (found - given).abs() < 1e-15), "{start:?}");
}

#[test]
fn a_planar_body_may_be_written_by_the_origin_of_its_axes() {
    let rest = "orientation = { angle_deg = 90 }\nangular_velocity = 2\nmass = 2\ninertia = 0.1\n\
                [joint.hinge]\ntype = \"revolute\"\nbetween = [\"ground\", \"arm\"]\nat = \"arm.pin\"\n";
    let by_origin =
        format!("plane = \"xz\"\n[body.arm]\ncom = [0.5, 0]\nposition = [1, 1]\npoints = {{ pin = [0, 0], tip = [1, 0] }}\n{rest}");
    let by_centre = format!(
        "plane = \"xz\"\n[body.arm]\nposition = [1, 1.5]\nvelocity = [-1, 0]\npoints = {{ pin = [-0.5, 0], tip = [0.5, 0] }}\n{rest}"
    );
    let [(_, a), (_, b)] = [by_origin, by_centre].map(|text| run(&model(&text), Choice::default().named("radau"), 0.01, 1.0));
    assert!(difference(&a, &b, &["arm.", "hinge."]) < 1e-12);
}

/// Bodies at points of others are where the arithmetic of angles has them, whatever the order in the file.
#[test]
fn a_body_may_be_placed_at_a_point_of_another() {
    let link = |name: &str, place: &str, degrees: i32| {
        format!(
            "[body.{name}]\nmass = 1\ninertia = 0.1\ncom = [0.5, 0.25]\nposition = \"{place}\"\norientation = {{ angle_deg = {degrees} }}\n\
             points = {{ tip = [2, 0] }}\n"
        )
    };
    let pivot = "[point.pivot]\nposition = [1, 2]\nfixed = true\n".to_string();
    let mut parts = [pivot, link("a", "pivot", 90), link("b", "a.tip", 0), link("c", "b", -90)];
    for _ in 0..2 {
        let (_, found) = run(&model(&format!("plane = \"xy\"\n{}", parts.concat())), Choice::default().named("radau"), 0.01, 0.01);
        let places = ["a.x", "a.y", "b.x", "b.y", "c.x", "c.y"].map(|name| found.column(name).unwrap()[0]);
        let expected = [0.75, 2.5, 1.5, 4.25, 1.75, 3.75];
        assert!(places.iter().zip(expected).all(|(found, place)| (found - place).abs() < 1e-14), "{places:?}");
        parts.reverse();
    }
}

/// So are points, those of bodies and bodies of points.
#[test]
fn a_point_may_be_placed_at_another_or_at_a_body() {
    let text = "plane = \"xy\"\n[point.last]\nmass = 1\nposition = \"arm\"\n[point.first]\nfixed = true\nposition = [1, 2]\n\
                [point.hook]\nmass = 1\nposition = \"arm.tip\"\n[point.base]\nfixed = true\nposition = \"first\"\n\
                [body.arm]\nmass = 1\ninertia = 0.1\ncom = [0.5, 0.25]\nposition = \"base\"\norientation = { angle_deg = 90 }\npoints = { tip = [2, 0] }\n";
    let (_, found) = run(&model(text), Choice::default().named("radau"), 0.01, 0.01);
    let places = ["last.x", "last.y", "hook.x", "hook.y"].map(|name| found.column(name).unwrap()[0]);
    let expected = [0.75, 2.5, 1.0, 4.0];
    assert!(places.iter().zip(expected).all(|(found, place)| (found - place).abs() < 1e-14), "{places:?}");
}

/// A bar between two bodies moves as a body that is a rod, on two balls.
#[test]
fn bars_end_at_places_of_bodies() {
    for (plane, ball) in [("", "spherical"), ("plane = \"xz\"\n", "revolute")] {
        let at = |x: f64, z: f64| if plane.is_empty() { format!("[{x}, 0, {z}]") } else { format!("[{x}, {z}]") };
        // A parallelogram, in which the rod moves as its ends do: (0.2, 1, 0) × (0.1, 0, 1).
        let (spin, velocity) = if plane.is_empty() { ("[0.2, 1, 0]", "[1, -0.2, -0.1]") } else { ("-1", "[1, -0.1]") };
        let hinge = |name: &str, x: f64| {
            let axis = if plane.is_empty() { "axis = [0.2, 1, 0]\n" } else { "" };
            format!(
                "[body.{name}]\nmass = 1\nshape = {{ box = [0.2, 0.1, 1] }}\nposition = {}\nangular_velocity = {spin}\nvelocity = {}\n\
                 points = {{ tip = {}, centre = {} }}\n[joint.{name}-hinge]\ntype = \"revolute\"\nbetween = [\"ground\", \"{name}\"]\nat = {}\n{axis}",
                at(x, 0.5),
                if plane.is_empty() { "[0.5, -0.1, 0]" } else { "[0.5, 0]" },
                at(0.1, 0.5),
                at(0.0, 0.0),
                at(x, 0.0)
            )
        };
        let bodies = format!("{plane}{}{}", hinge("left", 0.0), hinge("right", 1.5));
        let bar = format!("{bodies}[bar.rod]\nbetween = [\"left.tip\", \"right.tip\"]\nmass = 3\n");
        let joint = |name: &str, second: &str, x: f64| {
            format!("[joint.{name}]\ntype = \"{ball}\"\nbetween = [\"{second}\", \"rod\"]\nat = {}\n", at(x, 1.0))
        };
        let body = format!(
            "{bodies}[body.rod]\nmass = 3\nshape = {{ rod = 1.5 }}\nposition = {}\nvelocity = {velocity}\n{}{}",
            at(0.85, 1.0),
            joint("a", "left", 0.1),
            joint("b", "right", 1.6)
        );
        for method in ["radau", "conserving-ggl"] {
            let (one, a) = run(&model(&bar), Choice::default().named(method), 2e-3, 1.0);
            let (other, b) = run(&model(&body), Choice::default().named(method), 2e-3, 1.0);
            let off = difference(&a, &b, &["left", "right"]);
            let energies = [&one, &other].map(|simulation| simulation.audit().energy_summary());
            println!("{plane:?} {method}: {off:e} {energies:?}");
            assert!(off < 1e-8, "{method}: {off}");
            assert!((energies[0].initial - energies[1].initial).abs() < 1e-12, "{energies:?}");
            assert!(method == "radau" || energies[0].max_drift < 1e-12);
        }
    }
}

/// The momentum of bodies with a bar between them stays in free flight.
#[test]
fn bars_between_free_bodies_keep_momenta() {
    for plane in [true, false] {
        let [head, zero, a, b, spin, tip] = match plane {
            true => ["plane = \"xy\"\n", "[0, 0]", "[0, 0]", "[2, 1]", "3", "[0.3, 0.2]"],
            false => ["", "[0, 0, 0]", "[0, 0, 0]", "[2, 1, 0.5]", "[1, -2, 3]", "[0.3, 0.2, 0.1]"],
        };
        let text = format!(
            "{head}gravity = {zero}\n\
             [body.A]\nmass = 1\nshape = {{ box = [1, 0.5, 0.3] }}\nposition = {a}\nangular_velocity = {spin}\npoints = {{ tip = {tip} }}\n\
             [body.B]\nmass = 2\nshape = {{ box = [0.5, 0.5, 0.3] }}\nposition = {b}\npoints = {{ tip = {tip} }}\n\
             [bar.rod]\nbetween = [\"A.tip\", \"B\"]\nmass = 0.5\n"
        );
        let (simulation, _) = run(&model(&text), Choice::default().named("conserving-ggl"), 5e-3, 2.0);
        let (energy, momentum) = (simulation.audit().energy_summary(), simulation.audit().momentum_summary());
        assert!(energy.max_drift < 1e-12 && momentum.linear_drift < 1e-12 && momentum.angular_drift < 1e-12, "{energy:?} {momentum:?}");
    }
}

/// A bead of a thousandth of a hair between two hinges that are close together, with its centre five times as far off: nothing turns it or the
/// boxes beside it about the axis.
#[test]
fn a_small_body_spins_at_the_end_of_a_long_arm() {
    let body = |name: &str, shape: &str, x: f64, spin: &str| {
        format!("[body.{name}]\nmass = 1\nshape = {{ {shape} }}\nposition = [{x}, 0, 0]\nangular_velocity = {spin}\n")
    };
    let hinge = |name: &str, between: &str, x: f64| {
        format!("[joint.{name}]\ntype = \"revolute\"\nbetween = {between}\nat = [{x}, 0, 0]\naxis = [1, 0, 0]\n")
    };
    let text = [
        "gravity = [0, 0, 0]\n".to_string(),
        body("arm", "box = [0.1, 0.02, 0.02]", -0.1, "[60, 0, 0]"),
        body("bead", "sphere = 4.6e-8", 0.03, "[20, 5, 0]"),
        body("hand", "box = [0.1, 0.02, 0.02]", 0.1, "[-40, 0, 7]"),
        hinge("a", "[\"arm\", \"bead\"]", 0.0),
        hinge("b", "[\"bead\", \"hand\"]", 0.006),
    ];
    let recording = run(&model(&text.concat()), Choice::default(), 1e-4, 0.01).1;
    for (name, rate) in [("a.angle_rate", -40.0), ("b.angle_rate", -60.0)] {
        let found = recording.column(name).expect("the hinge has a rate").last().copied().expect("there are rows");
        assert!((found - rate).abs() < 1e-6, "{name}: {found} rad/s of {rate}");
    }
}
