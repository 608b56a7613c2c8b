//! What moves with a rope that is just taut, or with stops that are just touched, stays at the kinks of their forces but for rounding: steps by accuracy
//! neither end there nor stop. The truths are closed forms, in several units.

mod common;

use common::model;
use holonom::simulation::Choice;

const METHODS: [&str; 7] = ["conserving-ggl", "conserving", "trapezoidal-projected", "generalized-alpha", "radau", "ggl/bdf", "ode/dopri5"];

/// Lengths in metres and in other units, with masses in others, too.
const UNITS: [[f64; 2]; 3] = [[1.0, 1.0], [1e3, 1e-6], [1e-3, 1e6]];

/// Runs of a second that complete, in no more than `most` steps, with a column that ends within ten times the accuracy of what it should.
fn comes_to(text: &str, methods: &[&str], column: &str, [expected, length]: [f64; 2], most: u64) {
    let model = model(text);
    for method in methods {
        for accuracy in [1e-5, 1e-6] {
            let choice = Choice { accuracy: Some(accuracy), ..Choice::default().named(method) };
            let (simulation, recording) = common::run(&model, choice, 0.1, 1.0);
            let off = (common::last(&recording, column) - expected).abs();
            assert!(off <= 10.0 * accuracy * length, "{method}, {accuracy:e}, {length} m: off by {off:e} m");
            let taken = simulation.audit().work_summary(simulation.steps()).steps_taken;
            assert!(taken < most, "{method}, {accuracy:e}, {length} m: {taken} steps");
        }
    }
}

/// A point on a rod turns with 2 rad/s, and a damped rope lies along the rod.
#[test]
fn a_rope_beside_a_rod_is_no_matter() {
    for [l, m] in UNITS {
        let text = format!(
            "plane = \"xz\"\ngravity = [0, 0]\n[point.m]\nmass = {}\nposition = [{}, {}]\nvelocity = [{}, {}]\n\
             [constraint.rod]\ntype = \"distance\"\nbetween = [[0, 0], \"m\"]\n\
             [force.r]\ntype = \"rope\"\nbetween = [[0, 0], \"m\"]\nstiffness = {}\ndamping = {}\n",
            2.0 * m,
            0.6 * l,
            -0.8 * l,
            1.6 * l,
            1.2 * l,
            1e4 * m,
            3.0 * m
        );
        let (sin, cos) = 2.0_f64.sin_cos();
        comes_to(&text, &METHODS, "m.x", [(0.6 * cos + 0.8 * sin) * l, l], 10_000);
    }
}

/// The angle of a pendulum that starts with the rate 2 rad/s at `angle` (rad) from below, with g/l = 9.81/s², after a second, by the classical method of
/// order 4.
fn swung(angle: f64) -> f64 {
    let (mut angle, mut rate, steps) = (angle, 2.0, 10_000);
    let h = 1.0 / f64::from(steps);
    let pull = |angle: f64| -9.81 * angle.sin();
    for _ in 0..steps {
        let [a, u] = [rate, pull(angle)];
        let [b, v] = [rate + 0.5 * h * u, pull(angle + 0.5 * h * a)];
        let [c, w] = [rate + 0.5 * h * v, pull(angle + 0.5 * h * b)];
        let [d, z] = [rate + h * w, pull(angle + h * c)];
        (angle, rate) = (angle + h / 6.0 * (a + 2.0 * b + 2.0 * c + d), rate + h / 6.0 * (u + 2.0 * v + 2.0 * w + z));
    }
    angle
}

/// The same of a rod that swings: velocities that a method leaves off the row go to and fro along the rope, and are no motion of it.
#[test]
fn a_rope_beside_a_rod_that_swings_is_no_matter() {
    for ([l, m], [stiffness, damping]) in [(UNITS[0], [1e4, 3.0]), (UNITS[1], [1e6, 1e3]), (UNITS[2], [1e4, 100.0])] {
        let text = format!(
            "plane = \"xz\"\ngravity = [0, {}]\n[point.m]\nmass = {}\nposition = [{}, {}]\nvelocity = [{}, {}]\n\
             [constraint.rod]\ntype = \"distance\"\nbetween = [[0, 0], \"m\"]\n\
             [force.r]\ntype = \"rope\"\nbetween = [[0, 0], \"m\"]\nstiffness = {}\ndamping = {}\n",
            -9.81 * l,
            2.0 * m,
            0.6 * l,
            -0.8 * l,
            1.6 * l,
            1.2 * l,
            stiffness * m,
            damping * m
        );
        comes_to(&text, &METHODS, "m.x", [swung(0.6_f64.asin()).sin() * l, l], 12_000);
    }
}

/// Two bodies fly side by side with a damped rope between them, which is just taut.
#[test]
fn a_rope_between_what_flies_together_is_no_matter() {
    for [l, m] in UNITS {
        let body = |name: &str, place: [f64; 3]| {
            let place = place.map(|x| x * l);
            let velocity = [l, 2.0 * l, 3.0 * l];
            format!(
                "[body.{name}]\nmass = {m}\ninertia = [{0}, {0}, {0}]\nposition = {place:?}\nvelocity = {velocity:?}\n",
                0.1 * m * l * l
            )
        };
        let text = format!(
            "gravity = [0, 0, {}]\n{}{}[force.r]\ntype = \"rope\"\nbetween = [\"a\", \"b\"]\nstiffness = {}\ndamping = {}\n",
            -9.81 * l,
            body("a", [0.0, 0.0, 0.0]),
            body("b", [0.6, 0.3, 0.2]),
            1e4 * m,
            10.0 * m
        );
        comes_to(&text, &METHODS, "b.z", [(0.2 + 3.0 - 0.5 * 9.81) * l, l], 200);
    }
}

/// Ten bodies on a cart that moves, each at its stop.
#[test]
fn stops_on_a_cart_are_no_matter() {
    for [l, m] in UNITS {
        let text = format!(
            "gravity = [0, 0, 0]\n[body.cart]\nmass = {m}\ninertia = [{i}, {i}, {i}]\nposition = [0, 0, 0]\nvelocity = [{u}, {w}, 0]\n\
             [joint.rail]\ntype = \"prismatic\"\nbetween = [\"ground\", \"cart\"]\naxis = [0.8, 0.6, 0]\n\
             [body.b]\nrepeat = \"i = 0 to 9\"\nmass = \"{m}*(1 + i)\"\ninertia = [{i}, {i}, {i}]\n\
             position = [\"{l}*0.1*i\", \"{l}*0.37*i\", \"{l}*(0.3 + 0.1*i)\"]\nvelocity = [{u}, {w}, 0]\n\
             [joint.j]\nrepeat = \"i = 0 to 9\"\ntype = \"prismatic\"\nbetween = [\"cart\", \"b[i]\"]\naxis = [0.8, 0.6, 0]\n\
             [force.s]\nrepeat = \"i = 0 to 9\"\ntype = \"stop\"\njoint = \"j[i]\"\nlower = 0\nupper = \"{l}*0.1*(1 + i)\"\n\
             stiffness = {}\ndissipation = {}\n",
            1e5 * m,
            1.0 / l,
            i = m * l * l,
            u = 1.6 * l,
            w = 1.2 * l,
        );
        comes_to(&text, &METHODS, "b[7].x", [(0.7 + 1.6) * l, 3.0 * l], 200);
    }
}
