//! Bars as sides of joints in the plane, against closed forms and against bodies that are rods.

mod common;

use common::{last, model, model_with_forces, run_every};

const METHODS: [&str; 4] = ["conserving-ggl", "conserving", "generalized-alpha", "radau"];

/// What a motor exerts that turns a bar of 3 kg and 2 m from rest by 2 t² is that of a rod about its end, whichever side is the ground.
#[test]
fn a_motor_turns_a_bar_about_its_end() {
    for (between, sense) in [("\"ground\", \"crank\"", 1.0), ("\"crank\", \"ground\"", -1.0)] {
        let text = format!(
            "plane = \"xy\"\ngravity = [0, -9.81]\n[point.tip]\nposition = [3, 1]\n[bar.crank]\nbetween = [[1, 1], \"tip\"]\nmass = 3\n\
             [joint.shaft]\ntype = \"revolute\"\nbetween = [{between}]\nat = [1, 1]\n\
             [drive.motor]\ntype = \"angle\"\njoint = \"shaft\"\nprofile = \"{sense}*2*t^2\"\n"
        );
        let model = model(&text);
        assert_eq!(common::freedom(&model), [0, 0]);
        for method in METHODS {
            let (_, recording) = run_every(&model, method, 1e-3, 0.5, 1);
            let torque = 3.0 * 4.0 / 3.0 * 4.0 + 3.0 * 9.81 * 0.5_f64.cos();
            let found = last(&recording, "motor.effort");
            assert!((sense * found - torque).abs() < 1e-9 * torque, "{method}: {found} N m, and {torque} N m by hand");
            assert!((last(&recording, "shaft.angle") - sense * 0.5).abs() < 1e-12);
            assert!(recording.column("shaft.fx").is_none(), "what bars share has no force of its own");
        }
    }
}

/// A crank, a rod and a rocker of bars or of bodies, with a motor, a torsion spring and a start elsewhere.
fn four_bar(of_bars: bool) -> String {
    let parts =
        [("crank", 1.0, [[0.0, 0.0], [0.1, 0.0]]), ("rod", 2.0, [[0.1, 0.0], [0.4, 0.3]]), ("rocker", 1.5, [[0.4, 0.3], [0.5, 0.0]])];
    let part = |&(name, mass, [a, b]): &(&str, f64, [[f64; 2]; 2])| {
        let (x, y) = (b[0] - a[0], b[1] - a[1]);
        match of_bars {
            true => {
                let end = |[x, y]: [f64; 2]| match (x, y) {
                    (0.0, 0.0) | (0.5, 0.0) => format!("[{x}, {y}]"),
                    _ => format!("\"P{}\"", if x < 0.2 { 1 } else { 2 }),
                };
                format!("[bar.{name}]\nbetween = [{}, {}]\nmass = {mass}\n", end(a), end(b))
            }
            false => format!(
                "[body.{name}]\nmass = {mass}\nshape = {{ rod = {} }}\nposition = [{}, {}]\norientation = {{ angle = {} }}\n",
                x.hypot(y),
                0.5 * (a[0] + b[0]),
                0.5 * (a[1] + b[1]),
                y.atan2(x)
            ),
        }
    };
    let points = if of_bars { "[point.P1]\nposition = [0.1, 0]\n[point.P2]\nposition = [0.4, 0.3]\n" } else { "" };
    let joint =
        |name: &str, between: &str, at: [f64; 2]| format!("[joint.{name}]\ntype = \"revolute\"\nbetween = [{between}]\nat = {at:?}\n");
    let joints = [
        joint("shaft", "\"ground\", \"crank\"", [0.0, 0.0]),
        joint("knee", "\"crank\", \"rod\"", [0.1, 0.0]),
        joint("far", "\"rod\", \"rocker\"", [0.4, 0.3]),
        joint("foot", "\"rocker\", \"ground\"", [0.5, 0.0]),
    ];
    format!(
        "plane = \"xy\"\ngravity = [0, -9.81]\n{points}{}{}[start.shaft]\nangle = 0.4\nangle_rate = 2\n\
         [force.motor]\ntype = \"effort\"\njoint = \"shaft\"\neffort = \"3 - 0.2*'shaft.angle_rate'\"\n\
         [force.twist]\ntype = \"torsion\"\njoint = \"knee\"\nstiffness = 4\ndamping = 0.02\n",
        parts.iter().map(part).collect::<String>(),
        joints.concat()
    )
}

#[test]
fn bars_move_as_bodies_that_are_rods() {
    let [bars, bodies] = [true, false].map(|of_bars| model_with_forces(&four_bar(of_bars)));
    for method in METHODS {
        let [bars, bodies] = [&bars, &bodies].map(|model| run_every(model, method, 1e-3, 0.5, 1).1);
        for name in ["shaft.angle", "knee.angle", "far.angle", "foot.angle", "knee.angle_rate", "motor.power", "twist.effort"] {
            let [bars, bodies] = [&bars, &bodies].map(|recording| recording.column(name).unwrap());
            let largest = bodies.iter().fold(0.0_f64, |largest, value| largest.max(value.abs()));
            let off = bars.iter().zip(bodies).fold(0.0_f64, |off, (a, b)| off.max((a - b).abs()));
            // The tolerance of the iteration leaves generalized-alpha 1e-11 of rates.
            assert!(off < 1e-10 * largest, "{method}: {name} is {off:.1e} off");
        }
    }
}

/// A block of 1 kg on a level bar that turns at 2 rad/s about its end without weight: r̈ = ω² r, and the block is pushed across by 2 ω ṙ.
#[test]
fn a_block_slides_along_a_bar() {
    for between in ["\"bar\", \"block\"", "\"block\", \"bar\""] {
        let text = format!(
            "plane = \"xy\"\ngravity = [0, 0]\n[point.tip]\nposition = [3, 0]\n[bar.bar]\nbetween = [[0, 0], \"tip\"]\nmass = 3\n\
             [body.block]\nmass = 1\ninertia = 0.01\nposition = [1, 0]\nvelocity = [0, 2]\nangular_velocity = 2\n\
             [joint.shaft]\ntype = \"revolute\"\nbetween = [\"ground\", \"bar\"]\nat = [0, 0]\n\
             [joint.slide]\ntype = \"prismatic\"\nbetween = [{between}]\nat = [1, 0]\naxis = [1, 0]\n\
             [drive.motor]\ntype = \"angle\"\njoint = \"shaft\"\nprofile = \"2*t\"\n"
        );
        let (_, recording) = run_every(&model(&text), "radau", 1e-3, 0.5, 1);
        let is_second = between.ends_with("\"block\"");
        let sense = if is_second { 1.0 } else { -1.0 };
        // r = cosh ω t
        let way = 1.0_f64.cosh() - 1.0;
        let found = last(&recording, "slide.displacement");
        assert!((sense * found - way).abs() < 1e-10, "{found} m, and {way} m by hand");
        let push = 2.0 * 2.0 * 2.0 * 1.0_f64.sinh();
        let [x, y] = ["slide.fx", "slide.fy"].map(|name| sense * last(&recording, name));
        let (sine, cosine) = 1.0_f64.sin_cos();
        assert!((x + push * sine).abs() < 1e-8 && (y - push * cosine).abs() < 1e-8, "({x}, {y}) N, and {push} N across by hand");
    }
}

/// A bar between places of bodies has an angle against them, and nothing else changes: what moves has one degree of freedom.
#[test]
fn bars_that_end_at_bodies_have_angles_against_them() {
    let text = "plane = \"xy\"\n[body.crank]\nmass = 1\nposition = [0.05, 0]\nshape = { rod = 0.1 }\n[body.crank.points]\ntip = [0.05, 0]\n\
                [body.slider]\nmass = 1\ninertia = 0.01\nposition = [0.4, 0]\nvelocity = [0, 0]\n\
                [bar.rod]\nbetween = [\"crank.tip\", \"slider\"]\nmass = 2\n\
                [joint.shaft]\ntype = \"revolute\"\nbetween = [\"ground\", \"crank\"]\nat = [0, 0]\n\
                [joint.rail]\ntype = \"prismatic\"\nbetween = [\"ground\", \"slider\"]\nat = [0.4, 0]\naxis = [1, 0]\n\
                [joint.wrist]\ntype = \"revolute\"\nbetween = [\"slider\", \"rod\"]\nat = \"slider\"\n\
                [drive.motor]\ntype = \"angle\"\njoint = \"shaft\"\nprofile = \"10*t\"\n";
    let model = model_with_forces(text);
    assert_eq!(common::freedom(&model), [0, 0]);
    let (_, recording) = run_every(&model, "conserving-ggl", 1e-3, 0.4, 1);
    let [turned, angle] = ["shaft.angle", "wrist.angle"].map(|name| last(&recording, name));
    // The rod of 0.3 m falls by what the crank rises.
    let expected = -(0.1 * turned.sin() / 0.3).asin();
    assert!((angle - expected).abs() < 1e-12, "{angle} rad, and {expected} rad by hand");
    let forces = ["rail.fy", "shaft.fx"].map(|name| last(&recording, name));
    assert!(forces.iter().all(|force| force.is_finite() && force.abs() > 1.0), "{forces:?}");
}

/// A bar of 2 m on a pin in its middle, with a box that hangs at its end off its own middle: the pin bears what a rod's pin does.
#[test]
fn a_pin_in_the_middle_of_a_bar_has_its_force() {
    let rest = "plane = \"xy\"\ngravity = [0, -9.81]\n[body.box]\nmass = 2\ninertia = 0.05\nposition = [1.2, -0.1]\n[body.box.points]\nhook = [-0.2, 0.1]\n\
                [joint.far]\ntype = \"revolute\"\nbetween = [\"ground\", \"box2\"]\nat = [3, 0]\n\
                [body.box2]\nmass = 1\ninertia = 0.2\nposition = [3.5, 0]\n";
    let joint = |name: &str, between: &str, x: f64| format!("[joint.{name}]\ntype = \"revolute\"\nbetween = [{between}]\nat = [{x}, 0]\n");
    let bar = format!(
        "{rest}[point.free]\nposition = [-1, 0]\n[bar.beam]\nbetween = [\"free\", \"box.hook\"]\nmass = 3\n{}",
        joint("pin", "\"ground\", \"beam\"", 0.0)
    );
    let rod = format!(
        "{rest}[body.beam]\nmass = 3\nshape = {{ rod = 2 }}\nposition = [0, 0]\n{}{}",
        joint("pin", "\"ground\", \"beam\"", 0.0),
        joint("hook", "\"beam\", \"box\"", 1.0)
    );
    let [bar, rod] = [bar, rod].map(|text| run_every(&model_with_forces(&text), "radau", 1e-3, 0.5, 1).1);
    for name in ["pin.fx", "pin.fy", "pin.angle", "box.ax", "far.fx"] {
        let [bar, rod] = [&bar, &rod].map(|recording| last(recording, name));
        assert!((bar - rod).abs() < 1e-9 * rod.abs() && rod.abs() > 1e-3, "{name}: {bar}, and {rod} of a rod");
    }
}
