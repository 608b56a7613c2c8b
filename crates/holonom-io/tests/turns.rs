//! Many turns a second: counted right however long the step, and how far a scheme lags behind.

mod common;

use common::model;
use holonom::simulation::{Choice, Method, Simulation, Status, Verdict};

const ROTOR: &str = "gravity = [0, 0, 0]\n[body.rotor]\nmass = 1\ninertia = [1, 1, 2]\nposition = [0, 0, 0]\nangular_velocity = [0, 0, SPIN]\n\
                     velocity = [0, 0, CLIMB]\n[joint.j]\nbetween = [\"ground\", \"rotor\"]\nat = [0, 0, 0]\naxis = [0, 0, 1]\n";

/// Values of the joint's coordinates and their rates at the end, and what was drifted of the energy.
fn run(text: &str, choice: Choice, step: f64, end: f64) -> (Vec<f64>, Vec<f64>, f64) {
    let model = model(text);
    let mut simulation = Simulation::new(model.system.clone(), Method::resolve(&choice).unwrap(), step).unwrap();
    assert_eq!(simulation.run(end, &mut |_: &Simulation| Verdict::GoOn), Status::Completed);
    let gauges = simulation.gauges();
    (gauges.value.clone(), gauges.rate.clone(), simulation.audit().energy_summary().max_drift)
}

/// The conserving schemes turn by 2 atan(ωh/2) a step; composed they lag far less.
#[test]
fn rotors_lag_by_what_is_known() {
    let text = ROTOR.replace("SPIN", "1").replace("CLIMB", "0") + "type = \"revolute\"\n";
    let lag = |choice: Choice, h: f64| 1.0 - run(&text, choice, h, 1000.0 * h).0[0] / (1000.0 * h);
    for h in [0.1_f64, 0.5] {
        for method in ["conserving-ggl", "conserving"] {
            let expected = 1.0 - 2.0 * (0.5 * h).atan() / h;
            assert!((lag(Choice::default().named(method), h) - expected).abs() < 1e-9, "{method} at ωh = {h}");
        }
        let composed = |order: u8| Choice {
            formulation: Some("ggl".into()),
            integrator: Some("conserving-ggl".into()),
            order: Some(order),
            ..Choice::default()
        };
        let [fourth, sixth] = [4, 6].map(|order| lag(composed(order), h));
        println!("ωh = {h}: order 4 lags by {fourth:.1e}, order 6 by {sixth:.1e}");
        assert!(fourth.abs() < 1e-3 * h.powi(4) && sixth.abs() < 1e-4 * h.powi(6), "ωh = {h}: {fourth:e} and {sixth:e}");
    }
}

/// At 15 rad a step the step is divided: turns follow the rate, and the screw advances with them.
#[test]
fn turns_are_counted_however_long_the_step() {
    let pitch = std::f64::consts::TAU * 0.1;
    let screw = ROTOR.replace("SPIN", "1500").replace("CLIMB", "150") + &format!("type = \"screw\"\npitch = {pitch}\n");
    for method in ["conserving-ggl", "conserving"] {
        let (values, rates, drift) = run(&screw, Choice::default().named(method), 0.01, 1.0);
        assert!((values[0] / 1500.0 - 1.0).abs() < 0.08, "{method}: {values:?}");
        assert!((values[1] - 0.1 * values[0]).abs() < 1e-9 * values[1], "{method}: {values:?}");
        assert!(
            (rates[0] - 1500.0).abs() < 1.0 && drift < 1e-11 * 0.5 * (2.0 * 1500.0 * 1500.0 + 150.0 * 150.0),
            "{method}: {rates:?}, {drift:e}"
        );
    }
    let driven = ROTOR.replace("SPIN", "400").replace("CLIMB", "0")
        + "type = \"revolute\"\n[drive.d]\ntype = \"angle\"\njoint = \"j\"\nprofile = \"400*t\"\n";
    for method in ["conserving-ggl", "conserving", "radau", "trapezoidal-projected"] {
        let (values, ..) = run(&driven, Choice::default().named(method), 0.01, 1.0);
        assert!((values[0] - 400.0).abs() < 1e-9, "{method}: {values:?}");
    }
}

/// Where a composed step turns a wheel too far it is taken in parts, and begins again where it began: ½ α t² of a constant torque, by half a turn a
/// step at the end, where the parts are too long for order 4 or 6 to show.
#[test]
fn composed_steps_that_are_too_long_are_taken_in_parts() {
    let text = ROTOR.replace("SPIN", "0").replace("CLIMB", "0")
        + "type = \"revolute\"\n[force.motor]\ntype = \"effort\"\njoint = \"j\"\neffort = 400\n";
    for (integrator, formulation, order) in [("conserving-ggl", "ggl", 4), ("conserving-ggl", "ggl", 6), ("conserving", "lagrange-3", 4)] {
        let [formulation, name] = [formulation, integrator].map(|name| Some(name.to_string()));
        let choice = Choice { formulation, integrator: name, order: Some(order), ..Choice::default() };
        let (values, _, drift) = run(&text, choice, 0.02, 1.0);
        assert!((values[0] - 100.0).abs() < 0.1 && drift < 1e-9 * 4e4, "{integrator}, order {order}: {values:?}, {drift:e}");
    }
}

/// A flat rotor has light directions, whose iteration ends by its residual: what that leaves adds up over steps.
#[test]
fn a_flat_rotor_keeps_its_energy_for_long() {
    let text = ROTOR.replace("SPIN", "1").replace("CLIMB", "0") + "type = \"revolute\"\n";
    for (order, bound) in [(2, 1e-12), (4, 2e-12)] {
        let choice =
            Choice { formulation: Some("ggl".into()), integrator: Some("conserving-ggl".into()), order: Some(order), ..Choice::default() };
        let drift = run(&text, choice, 0.1, 500.0).2;
        println!("order {order}: {drift:.1e} J of 1 J after 5000 steps");
        assert!(drift < bound, "order {order}: {drift:e}");
    }
}

/// The angle of a body in the plane is counted from the one that is written, whatever rounding makes of half a turn: a controller that leads it by 0.1 rad
/// finds it there.
#[test]
fn angles_of_bodies_count_from_what_is_written() {
    for degrees in [170.0, 180.0, -180.0, 181.0, 200.0, 450.0_f64] {
        let angle = degrees.to_radians();
        for reactions in ["", "[output]\nreactions = true\n"] {
            let model = common::model(&format!(
                "plane = \"xy\"\ngravity = [0, 0]\n[body.a]\nmass = 1\ninertia = 0.2\nposition = [{}, {}]\norientation = {{ angle_deg = {degrees} }}\n\
                 [joint.j]\ntype = \"revolute\"\nbetween = [\"ground\", \"a\"]\nat = [0, 0]\n\
                 [force.servo]\ntype = \"effort\"\njoint = \"j\"\neffort = \"20*({angle} + 0.1 - a.angle) - 9*q_rate\"\n{reactions}",
                0.5 * angle.cos(),
                0.5 * angle.sin()
            ));
            let recording = common::run(&model, Choice::default().named("radau"), 0.01, 10.0).1;
            let [first, last] = [recording.column("a.angle").unwrap()[0], common::last(&recording, "a.angle")];
            assert!((first - angle).abs() < 1e-12 && (last - angle - 0.1).abs() < 1e-9, "{degrees}°: {first}, then {last} rad");
        }
    }
    // A start that moves it counts on.
    let model = common::model(
        "plane = \"xy\"\n[body.a]\nmass = 1\ninertia = 1\nposition = [0, 0.5]\norientation = { angle_deg = 90 }\n\
         [joint.j]\ntype = \"revolute\"\nbetween = [\"ground\", \"a\"]\nat = [0, 0]\n[start.j]\nangle = \"120*deg\"\n",
    );
    let recording = common::run(&model, Choice::default(), 0.1, 0.1).1;
    assert!((recording.column("a.angle").unwrap()[0] - 210.0_f64.to_radians()).abs() < 1e-9);
}
