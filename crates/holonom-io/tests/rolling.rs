//! Discs that roll, up to where they cannot.

mod common;

use common::model;
use holonom::analysis::rank;
use holonom::simulation::{Simulation, Status, Verdict};

/// A disc that leans and is let go falls over the tangent where it touches, as an inverted pendulum, and lies flat after a time known by quadrature: no
/// step goes across to its other side, whatever its length, and the stop says why. With a little spin it turns round just above the plane instead.
#[test]
fn a_disc_that_lies_down_does_not_bounce() {
    let (radius, lean): (f64, f64) = (0.5, 20_f64.to_radians());
    let moment = (3.0 * radius * radius + 0.02 * 0.02) / 12.0 + radius * radius;
    // With φ² = lean − θ the integrand of ∫ dθ / θ̇ is smooth, also at the start.
    let (parts, last) = (1000, lean.sqrt());
    let duration = |phi: f64| 2.0 * phi / (2.0 * 9.81 * radius * (lean.sin() - (lean - phi * phi).sin()) / moment).sqrt();
    let falls: f64 = (0..parts).map(|k| duration((f64::from(k) + 0.5) * last / f64::from(parts)) * last / f64::from(parts)).sum();
    let disc = |spin: f64| {
        model(&format!(
            "gravity = [0, 0, -9.81]\n[body.disc]\nmass = 1\nshape = {{ cylinder = [{radius}, 0.02] }}\nposition = [0, 0, {}]\n\
             orientation = {{ axis = [1, 0, 0], angle = {lean} }}\nangular_velocity = [0, 0, {spin}]\naxes = {{ axle = [0, 0, 1] }}\n\
             [joint.contact]\ntype = \"rolling\"\nbetween = [\"ground\", \"disc\"]\nat = \"disc\"\naxis = \"disc.axle\"\n\
             normal = [0, 0, 1]\nradius = {radius}\n",
            radius * lean.sin()
        ))
    };
    let lying = disc(0.0);
    for of in ["conserving-ggl", "conserving", "conserving-projected", "generalized-alpha", "radau", "rk4"] {
        for step in [1e-3, 2e-3, 3e-3, 1e-2] {
            let mut simulation = common::simulation(&lying, of, step);
            let Status::Stopped { at, reason } = simulation.run(0.4, &mut |_: &Simulation| Verdict::GoOn) else {
                panic!("{of}, {step} s: it went on")
            };
            assert!(reason.contains("lies down flat on the plane"), "{of}, {step} s: {reason}");
            // Second-order methods err by the square of the longest step.
            assert!((at - falls).abs() <= 1e-4, "{of}, {step} s: {at} s for {falls}");
        }
    }
    let spinning = disc(0.3);
    for of in ["conserving-ggl", "conserving"] {
        common::run_every(&spinning, of, 2e-3, 0.6, 1);
    }
}

/// Wheels of a car: name, and place on the road from the middle of the rear axle, m.
const WHEELS: [(&str, f64, f64); 4] = [("rl", 0.0, 0.75), ("rr", 0.0, -0.75), ("fl", 2.6, 0.75), ("fr", 2.6, -0.75)];

/// How a car turns at the time t: 1/m.
fn curvature(t: f64) -> f64 {
    0.15 * (1.0 - t.cos())
}

/// A car on four wheels without slip, whose front wheels are steered by these angles.
fn car(angle: impl Fn(f64) -> String) -> holonom::model::Model {
    let mut text = "[body.car]\nmass = 1200\ninertia = [400, 1500, 1700]\nposition = [1.2, 0, 0.55]\nvelocity = [4, 0, 0]\n".to_string();
    for (name, x, y) in WHEELS {
        text += &format!(
            "[body.{name}]\nmass = 20\ninertia = [0.5, 1, 0.5]\nposition = [{x}, {y}, 0.3]\nvelocity = [4, 0, 0]\nangular_velocity = [0, \"4/0.3\", 0]\n\
             [joint.road-{name}]\ntype = \"rolling\"\nbetween = [\"ground\", \"{name}\"]\nat = \"{name}\"\naxis = [0, 1, 0]\nnormal = [0, 0, 1]\nradius = 0.3\n\
             [joint.hub-{name}]\nbetween = [\"car\", \"{name}\"]\nat = \"{name}\"\n"
        );
        text += &match x {
            0.0 => "type = \"revolute\"\naxis = [0, 1, 0]\n".to_string(),
            _ => format!(
                "type = \"universal\"\naxes = [[0, 0, 1], [0, 1, 0]]\n[drive.{name}-steering]\ntype = \"angle\"\njoint = \"hub-{name}.angle1\"\nprofile = \"{}\"\n",
                angle(y)
            ),
        };
    }
    model(&text)
}

/// Place of the middle of the rear axle, heading and speed after a time, of the one coordinate that is left (Kane's equation): all that the car does along
/// the way that its curvature leads.
fn driven(end: f64) -> [f64; 4] {
    let angle = |y: f64, t: f64| (2.6 * curvature(t)).atan2(1.0 - y * curvature(t));
    let derivative = |f: &dyn Fn(f64) -> f64, t: f64| (f(t + 1e-4) - f(t - 1e-4)) / 2e-4;
    let second = |f: &dyn Fn(f64) -> f64, t: f64| (f(t + 1e-3) - 2.0 * f(t) + f(t - 1e-3)) / 1e-6;
    // What a metre a second of the axle moves, squared, of masses and of what spins.
    let moves = |t: f64| {
        let k = curvature(t);
        let square = |x: f64, y: f64| (1.0 - y * k).powi(2) + (x * k).powi(2);
        1200.0 * square(1.2, 0.0) + WHEELS.iter().map(|&(_, x, y)| (20.0 + 1.0 / 0.09) * square(x, y)).sum::<f64>()
    };
    let rate = |t: f64, [_, _, heading, speed]: [f64; 4]| {
        let (k, about) = (curvature(t), 1700.0 + 4.0 * 0.5);
        let steered: f64 = [0.75, -0.75].iter().map(|&y| 0.5 * second(&|t| angle(y, t), t)).sum();
        let push = speed * (0.5 * derivative(&moves, t) + about * k * derivative(&curvature, t)) + k * steered;
        [speed * heading.cos(), speed * heading.sin(), speed * k, -push / (moves(t) + about * k * k)]
    };
    let (steps, mut state) = (2000, [0.0, 0.0, 0.0, 4.0]);
    let h = end / f64::from(steps);
    for step in 0..steps {
        let t = h * f64::from(step);
        let add = |by: f64, slope: [f64; 4]| std::array::from_fn(|i| state[i] + by * slope[i]);
        let first = rate(t, state);
        let second = rate(t + 0.5 * h, add(0.5 * h, first));
        let third = rate(t + 0.5 * h, add(0.5 * h, second));
        let last = rate(t + h, add(h, third));
        state = std::array::from_fn(|i| state[i] + h / 6.0 * (first[i] + 2.0 * second[i] + 2.0 * third[i] + last[i]));
    }
    state
}

/// At every moment all wheels go round one centre, and a third of what holds them follows from the rest; in the middle of a step their mean directions do not.
/// Steps leave out what follows, whichever way the car heads, and are as long and as exact as others.
#[test]
fn a_car_that_is_steered_takes_whole_steps() {
    let k = "(0.15*(1 - cos(t)))";
    let rolls = car(|y| format!("atan2(2.6*{k}, 1 - ({y})*{k})"));
    let end = 6.0;
    let [x, y, heading, speed] = driven(end);
    for of in ["conserving-ggl", "conserving", "generalized-alpha", "trapezoidal-projected", "radau"] {
        let errors = [0.02, 0.01].map(|step| {
            let (simulation, recording) = common::run_every(&rolls, of, step, end, 100);
            let work = simulation
                .summary("car", end, &Status::Completed, rank(&rolls.system, &simulation.state().x, end).size(&rolls.system))
                .work;
            assert!(work.rejected_steps <= 2 && work.iterations_per_step < 8.0, "{of}, {step} s: {work:?}");
            let last = |name: &str| common::last(&recording, name);
            let place = [last("car.x") - 1.2 * heading.cos(), last("car.y") - 1.2 * heading.sin()];
            assert!(
                (last("car.vx").hypot(last("car.vy")) / speed / (1.0 + (1.2 * curvature(end)).powi(2)).sqrt() - 1.0).abs() < 2e-3,
                "{of}, {step} s"
            );
            (place[0] - x).hypot(place[1] - y)
        });
        match of {
            "radau" => assert!(errors[1] < 1e-6, "{errors:?}"),
            _ => assert!(errors[1] < 5e-3 && errors[0] / errors[1] > 3.3, "{of}: {errors:?}"),
        }
    }
}

/// Front wheels that are turned by one and the same angle go round no common centre with the others: no step is taken as if one of them might slip.
#[test]
fn a_car_that_cannot_roll_stops() {
    let stuck = car(|_| "atan2(2.6*0.15*(1 - cos(t)), 1)".to_string());
    for of in ["conserving-ggl", "conserving", "generalized-alpha", "trapezoidal-projected", "radau"] {
        let mut simulation = common::simulation(&stuck, of, 0.01);
        let Status::Stopped { at, reason } = simulation.run(6.0, &mut |_: &Simulation| Verdict::GoOn) else { panic!("{of}: it went on") };
        assert!(at < 0.5, "{of}: {at} s, {reason}");
        assert!(reason.contains("as those of wheels that do not all go round one centre"), "{of}: {reason}");
    }
}

/// A car whose front wheels turn by one and the same angle, on knuckles of their own.
const STUCK_CAR: &str = r#"
[body.chassis]
mass = 1000
inertia = [300, 1200, 1300]
position = [0, 0, 0.5]
velocity = [5, 0, 0]

[body.wheel]
repeat = "i = 0 to 3"
mass = 20
inertia = [0.6, 0.6, 1]
position = ["2.5*floor(i/2) - 1.25", "0.75 - 1.5*mod(i, 2)", 0.3]
orientation = { axis = [1, 0, 0], angle = "-90*deg" }
velocity = [5, 0, 0]
angular_velocity = [0, "5/0.3", 0]

[body.knuckle]
repeat = "i = 2 to 3"
mass = 5
inertia = [0.1, 0.1, 0.1]
position = [1.25, "0.75 - 1.5*mod(i, 2)", 0.3]
velocity = [5, 0, 0]

[joint.road]
repeat = "i = 0 to 3"
type = "rolling"
between = ["ground", "wheel[i]"]
at = "wheel[i]"
axis = [0, 1, 0]
normal = [0, 0, 1]
radius = 0.3

[joint.rear]
repeat = "i = 0 to 1"
type = "revolute"
between = ["chassis", "wheel[i]"]
at = "wheel[i]"
axis = [0, 1, 0]

[joint.front]
repeat = "i = 2 to 3"
type = "revolute"
between = ["knuckle[i]", "wheel[i]"]
at = "wheel[i]"
axis = [0, 1, 0]

[joint.kingpin]
repeat = "i = 2 to 3"
type = "revolute"
between = ["chassis", "knuckle[i]"]
at = "wheel[i]"
axis = [0, 0, 1]

[drive.steering]
repeat = "i = 2 to 3"
type = "angle"
joint = "kingpin[i]"
profile = "atan(0.25*sin(t))"

"#;

/// Rows of accelerations alone, off which it drifts, let the car stand still all at once: what takes no energy by itself has lost it.
#[test]
fn energy_that_goes_nowhere_stops_a_run() {
    for step in [0.005, 0.01] {
        let mut simulation = common::simulation(&model(STUCK_CAR), "gauss", step);
        let Status::Stopped { at, reason } = simulation.run(0.2, &mut |_: &Simulation| Verdict::GoOn) else { panic!("it went on") };
        assert!(at <= 0.05 && reason.contains("of energy that could move went nowhere"), "{at} s: {reason}");
    }
}
