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

/// Wheels of the car: place on the road from the middle of the rear axle, m, and mass with that of the knuckle, kg.
const WHEELS: [[f64; 3]; 4] = [[0.0, 0.75, 20.0], [0.0, -0.75, 20.0], [2.5, 0.75, 25.0], [2.5, -0.75, 25.0]];

/// How a car turns at the time t: 1/m.
fn curvature(t: f64) -> f64 {
    0.15 * (1.0 - t.cos())
}

/// Place of the middle of the rear axle, heading and speed after a time, of the one coordinate that is left (Kane's equation): all that the car does along
/// the way that its curvature leads.
fn driven(end: f64) -> [f64; 4] {
    let angle = |y: f64, t: f64| (2.5 * curvature(t)).atan2(1.0 - y * curvature(t));
    let derivative = |f: &dyn Fn(f64) -> f64, t: f64| (f(t + 1e-4) - f(t - 1e-4)) / 2e-4;
    let second = |f: &dyn Fn(f64) -> f64, t: f64| (f(t + 1e-3) - 2.0 * f(t) + f(t - 1e-3)) / 1e-6;
    // What a metre a second of the axle moves, squared, of masses and of what spins.
    let moves = |t: f64| {
        let k = curvature(t);
        let square = |x: f64, y: f64| (1.0 - y * k).powi(2) + (x * k).powi(2);
        1000.0 * square(1.25, 0.0) + WHEELS.iter().map(|&[x, y, mass]| (mass + 1.0 / 0.09) * square(x, y)).sum::<f64>()
    };
    let rate = |t: f64, [_, _, heading, speed]: [f64; 4]| {
        let (k, about) = (curvature(t), 1300.0 + 4.0 * 0.6 + 2.0 * 0.1);
        let steered: f64 = [0.75, -0.75].iter().map(|&y| (0.6 + 0.1) * second(&|t| angle(y, t), t)).sum();
        let push = speed * (0.5 * derivative(&moves, t) + about * k * derivative(&curvature, t)) + k * steered;
        [speed * heading.cos(), speed * heading.sin(), speed * k, -push / (moves(t) + about * k * k)]
    };
    let (steps, mut state) = (2000, [0.0, 0.0, 0.0, 3.5]);
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
    let rolls = common::car(3.5, &format!("atan2(2.5*{k}, 1 - (0.75 - 1.5*mod(i, 2))*{k})"));
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
            let place = [last("chassis.x") - 1.25 * (heading.cos() - 1.0), last("chassis.y") - 1.25 * heading.sin()];
            assert!(
                (last("chassis.vx").hypot(last("chassis.vy")) / speed / (1.0 + (1.25 * curvature(end)).powi(2)).sqrt() - 1.0).abs() < 2e-3,
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
    let stuck = common::car(4.0, "atan2(2.5*0.15*(1 - cos(t)), 1)");
    for of in ["conserving-ggl", "conserving", "generalized-alpha", "trapezoidal-projected", "radau"] {
        let mut simulation = common::simulation(&stuck, of, 0.01);
        let Status::Stopped { at, reason } = simulation.run(6.0, &mut |_: &Simulation| Verdict::GoOn) else { panic!("{of}: it went on") };
        assert!(at < 0.5, "{of}: {at} s, {reason}");
        assert!(reason.contains("as those of wheels that do not all go round one centre"), "{of}: {reason}");
    }
}

/// Rows of accelerations alone, off which it drifts, let the car stand still all at once: what takes no energy by itself has lost it.
#[test]
fn energy_that_goes_nowhere_stops_a_run() {
    for step in [0.005, 0.01] {
        let mut simulation = common::simulation(&common::car(5.0, "atan(0.25*sin(t))"), "gauss", step);
        let Status::Stopped { at, reason } = simulation.run(0.2, &mut |_: &Simulation| Verdict::GoOn) else { panic!("it went on") };
        assert!(at <= 0.05 && reason.contains("of energy that could move went nowhere"), "{at} s: {reason}");
    }
}
