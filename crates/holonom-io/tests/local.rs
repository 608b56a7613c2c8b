//! Components of vectors in the axes of bodies, against what is known of them.

mod common;

use common::model;
use holonom::record::Recording;

fn run(text: &str, method: &str, end: f64) -> Recording {
    common::run_every(&model(text), method, 0.01, end, 1).1
}

fn each(recording: &Recording, name: &str, expected: impl Fn(usize) -> f64) {
    let column = recording.column(name).unwrap_or_else(|| panic!("there is no column {name}"));
    for (row, found) in column.iter().enumerate() {
        let expected = expected(row);
        assert!((found - expected).abs() <= 1e-8 * (1.0 + expected.abs()), "{name} in row {row}: {found}, and {expected} by hand");
    }
}

/// Of a free top with moments (A, A, C) the spin ω₃ stays, and (ω₁, ω₂) turns at (C − A)/A ω₃ about the axis of the body; the angular momentum
/// in its axes is (A ω₁, A ω₂, C ω₃) wherever it has turned.
#[test]
fn a_free_top_has_the_rates_of_euler() {
    let (a, c, spin) = (0.4, 0.6, 3.0);
    let text = format!(
        "gravity = [0, 0, 0]\n[body.top]\nmass = 2\ninertia = [{a}, {a}, {c}]\nposition = [1, 2, 3]\nvelocity = [1, 0.5, -2]\n\
         orientation = {{ axis = [1, 2, -1], angle = 0.7 }}\nangular_velocity = [0, 0, 0]\n\
         [measure.w1]\nvalue = \"local(top, top.wx)\"\n[measure.w2]\nvalue = \"local(top, top.wy)\"\n[measure.w3]\nvalue = \"local(top, top.wz)\"\n"
    );
    // In the axes of the body (1, 0, spin), turned into the world.
    let turn = nalgebra::Rotation3::new(nalgebra::Vector3::new(1.0, 2.0, -1.0).normalize() * 0.7);
    let omega = turn * nalgebra::Vector3::new(1.0, 0.0, spin);
    let text = text.replace("angular_velocity = [0, 0, 0]", &format!("angular_velocity = [{}, {}, {}]", omega.x, omega.y, omega.z));
    let recording = run(&text, "ode/dop853/velocity", 2.0);
    let rate = (c - a) / a * spin;
    each(&recording, "w1", |row| (rate * 0.01 * row as f64).cos());
    each(&recording, "w2", |row| (rate * 0.01 * row as f64).sin());
    each(&recording, "w3", |_| spin);
}

/// On an arm that turns at Ω a place at R has Ω² R towards the pin, whatever plane it turns in, and the pin bears the mass times that along it.
#[test]
fn an_arm_that_turns_bears_what_is_thrown_out() {
    for (plane, forward) in [("xy", 1.0), ("xz", 1.0), ("yz", 1.0)] {
        let [first, second] = [&plane[..1], &plane[1..]];
        let text = format!(
            "plane = \"{plane}\"\ngravity = [0, 0]\n[body.arm]\nmass = 3\ninertia = 0.2\nposition = [0.4, 0.3]\norientation = {{ angle = 0.6435011087932844 }}\n\
             angular_velocity = 2\nvelocity = [-0.6, 0.8]\n[joint.pin]\ntype = \"revolute\"\nbetween = [\"ground\", \"arm\"]\nat = [0, 0]\n\
             [measure.inward]\nvalue = \"local(arm, arm.a{first})\"\n[measure.across]\nvalue = \"local(arm, arm.v{second})\"\n\
             [measure.borne]\nvalue = \"local(arm, pin.f{first})\"\n[output]\nreactions = true\n"
        );
        let recording = run(&text, "conserving-ggl", 1.0);
        each(&recording, "inward", |_| -2.0 * 2.0 * 0.5 * forward);
        each(&recording, "across", |_| 2.0 * 0.5);
        each(&recording, "borne", |_| -3.0 * 2.0);
    }
}

/// What `local` is not of is said where it is written.
#[test]
fn local_is_of_bodies_and_components() {
    let refused = |value: &str| {
        let text = format!(
            "[point.p]\nmass = 1\nposition = [0, 0, 0]\n[body.b]\nmass = 1\ninertia = [1, 1, 1]\nposition = [1, 0, 0]\n[measure.m]\nvalue = \"{value}\"\n"
        );
        common::source(&text).model().err().expect("it is refused")
    };
    for (value, word) in [
        ("local(c, b.vx)", "no place `c`"),
        ("local(b)", "takes a body and a component"),
        ("local(b, b)", "is no component along an axis"),
        ("local(p, p.vx)", "`p` is none"),
        ("local(b, b.qx)", "is no component along an axis"),
    ] {
        let message = refused(value);
        println!("{value}: {message}");
        assert!(message.contains(word), "{value}: {message}");
    }
}
