//! Functions that a program gives, called by formulas of forces and constraints.

mod common;

use common::run_every;
use holonom::model::{External, ExternalFunction, Kinds};
use holonom_io::Source;

/// A driven pendulum whose spring and measure are formulas, or call these two functions.
const CALLING: &str = r#"
plane = "xz"
[body.arm]
mass = 2
inertia = 0.3
position = [0.4, 0]
[joint.pin]
type = "revolute"
between = ["ground", "arm"]
at = [0, 0]
[force.motor]
type = "effort"
joint = "pin"
effort = "MOMENT"
[force.wind]
type = "expression"
point = "tip"
force = ["FORCE0", "FORCE1"]
[point.tip]
mass = 0.1
position = [0.8, 0]
[constraint.string]
type = "distance"
between = ["arm", "tip"]
[measure.twice]
value = "2*MOMENT"
[event.level]
when = "MOMENT - 1"
"#;

struct Spring;

impl ExternalFunction for Spring {
    fn arguments(&self) -> usize {
        2
    }

    fn call(&self, arguments: &[f64], values: &mut [f64]) {
        values[0] = 3.0 * (-arguments[0]).sin() - 0.2 * arguments[1];
    }
}

struct Drag;

impl ExternalFunction for Drag {
    fn arguments(&self) -> usize {
        2
    }

    fn values(&self) -> usize {
        2
    }

    fn call(&self, v: &[f64], values: &mut [f64]) {
        let speed = (v[0] * v[0] + v[1] * v[1]).sqrt();
        values.copy_from_slice(&[-0.1 * speed * v[0], -0.1 * speed * v[1]]);
    }

    fn gradient(&self, v: &[f64], gradient: &mut [f64]) {
        let speed = (v[0] * v[0] + v[1] * v[1]).sqrt();
        let over = if speed > 0.0 { 1.0 / speed } else { 0.0 };
        for (i, j) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
            gradient[2 * i + j] = -0.1 * (v[i] * v[j] * over + if i == j { speed } else { 0.0 });
        }
    }
}

#[test]
fn functions_of_a_program_are_formulas_of_a_file() {
    let text = |moment: &str, force: [&str; 2]| CALLING.replace("MOMENT", moment).replace("FORCE0", force[0]).replace("FORCE1", force[1]);
    let drag = |k: usize| ["-0.1*sqrt(vx^2 + vz^2)*vx", "-0.1*sqrt(vx^2 + vz^2)*vz"][k];
    let written = text("3*sin(-pin.angle) - 0.2*pin.angle_rate", [drag(0), drag(1)]);
    let called = text("spring(pin.angle, pin.angle_rate)", ["drag[0](vx, vz)", "drag[1](vx, vz)"]);
    let mut kinds = Kinds::default();
    kinds.functions.insert("spring".into(), External::new(Spring));
    kinds.functions.insert("drag".into(), External::new(Drag));
    let read = |text: &str| Source::read("own.toml", text.as_bytes()).unwrap().knowing(kinds.clone()).model().unwrap();
    for method in ["conserving-ggl", "generalized-alpha", "radau"] {
        let [(one, _), (other, _)] = [&written, &called].map(|text| run_every(&read(text), method, 0.01, 1.0, 1));
        let apart = one.state().x.iter().zip(&other.state().x).fold(0.0_f64, |most, (one, other)| most.max((one - other).abs()));
        assert!(apart < 1e-12, "{method}: {apart}");
        assert_eq!(one.events().len(), 1);
        assert!((one.events()[0].t - other.events()[0].t).abs() < 1e-11, "{method}");
    }
    for (wrong, words) in [
        ("spring(pin.angle)", "`spring` takes 2 arguments, and these are 1"),
        ("drag(1, 2)", "`drag` has 2 values"),
        ("drag[2](1, 2)", "write drag[0](…) to drag[1](…)"),
        ("spring", "the function `spring` needs its arguments"),
        ("spring(pin.angle, t", "a closing bracket is missing"),
        ("sprin(1, 2)", "did you mean `spring`?"),
    ] {
        let wrong = text(wrong, ["0", "0"]);
        let message = Source::read("own.toml", wrong.as_bytes()).unwrap().knowing(kinds.clone()).model().err().unwrap();
        assert!(message.contains(words), "{words} is missing in\n{message}");
    }
    let mut taken = kinds.clone();
    taken.functions.insert("sin".into(), External::new(Spring));
    let message = Source::read("own.toml", written.as_bytes()).unwrap().knowing(taken).model().err().unwrap();
    assert!(message.contains("`sin` is a constant or a function of every expression"), "{message}");
}

/// The square of a length, with the derivatives that are given.
struct Square([f64; 2]);

impl ExternalFunction for Square {
    fn arguments(&self) -> usize {
        2
    }

    fn call(&self, x: &[f64], values: &mut [f64]) {
        values[0] = x[0] * x[0] + x[1] * x[1];
    }

    fn gradient(&self, x: &[f64], gradient: &mut [f64]) {
        gradient.copy_from_slice(&[self.0[0] * x[0], self.0[1] * x[1]]);
    }
}

/// Forces of a constraint would act along them, and do work that nothing accounts for.
#[test]
fn wrong_derivatives_of_constraints_are_refused() {
    for size in [1e-6, 1.0, 1e6] {
        let read = |given: [f64; 2]| {
            let text = format!(
                "plane = \"xy\"\n[point.P]\nmass = 1\nposition = [{}, {}]\n[constraint.rod]\ntype = \"expression\"\nvalue = \"square(P.x, P.y) - {}\"\n",
                3.0 * size,
                4.0 * size,
                25.0 * size * size
            );
            let mut kinds = Kinds::default();
            kinds.functions.insert("square".into(), External::new(Square(given)));
            Source::read("own.toml", text.as_bytes()).unwrap().knowing(kinds).model()
        };
        assert!(read([2.0, 2.0]).is_ok(), "{size} m");
        for wrong in [[2.0, 0.0], [2.5, 2.0], [-2.0, 2.0]] {
            let message = read(wrong).err().unwrap();
            assert!(message.contains("a function that this formula calls has a wrong derivative"), "{size} m: {message}");
        }
    }
}

/// A sine that bends within a millimetre, ten kilometres from the origin: differences over a share of that distance tell nothing of it.
struct Wave;

impl ExternalFunction for Wave {
    fn arguments(&self) -> usize {
        1
    }

    fn call(&self, x: &[f64], values: &mut [f64]) {
        values[0] = 1e-3 * ((x[0] - 1e4) / 1e-3).sin();
    }

    fn gradient(&self, x: &[f64], gradient: &mut [f64]) {
        gradient[0] = ((x[0] - 1e4) / 1e-3).cos();
    }
}

#[test]
fn right_derivatives_of_what_bends_much_are_taken() {
    let text = "plane = \"xy\"\n[point.P]\nmass = 1\nposition = [1e4, 0]\n[constraint.track]\ntype = \"expression\"\nvalue = \"P.y - wave(P.x)\"\n";
    let mut kinds = Kinds::default();
    kinds.functions.insert("wave".into(), External::new(Wave));
    Source::read("own.toml", text.as_bytes()).unwrap().knowing(kinds).model().unwrap_or_else(|message| panic!("{message}"));
}
