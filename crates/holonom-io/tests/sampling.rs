//! Events with a period: controllers that look at a mechanism at a fixed rate and hold what they say, against the exact motion between.

mod common;

use common::model;
use holonom::simulation::{Choice, Method, Simulation, Status};

const GAINS: [f64; 3] = [30.0, 8.0, 20.0];

/// A mass of 2 kg that a PID controller with samples brings to x = 1.
fn cart(period: f64) -> String {
    let [p, d, i] = GAINS;
    format!(
        r#"
gravity = [0, 0, 0]
[point.cart]
mass = 2
position = [0, 0, 0]
velocity = [0.5, 0, 0]
[input.push]
[input.sum]
[measure.missing]
value = "1 - cart.x"
[event.controller]
every = {period}
set = {{ push = "{p}*missing - {d}*cart.vx + {i}*sum", sum = "sum + missing*{period}" }}
[force.motor]
type = "expression"
point = "cart"
force = ["push", 0, 0]
"#
    )
}

/// Position, velocity and sum of the errors at a time: between samples the force is constant, and nothing is rounded but numbers.
fn exact(period: f64, end: f64) -> [f64; 3] {
    let [p, d, i] = GAINS;
    let [mut x, mut v, mut sum] = [0.0, 0.5, 0.0];
    let mut k = 0.0;
    loop {
        let push = p * (1.0 - x) - d * v + i * sum;
        sum += (1.0 - x) * period;
        let h = (end - k * period).min(period);
        x += v * h + 0.25 * push * h * h;
        v += 0.5 * push * h;
        k += 1.0;
        if k * period > end - 1e-9 {
            return [x, v, sum];
        }
    }
}

fn begin(text: &str, method: &str, step: f64) -> Simulation {
    let method = Method::resolve(&Choice::default().named(method)).unwrap();
    Simulation::new(model(text).system, method, step).unwrap()
}

#[test]
fn a_sampled_controller_moves_a_mass_as_the_discrete_system_says() {
    // Steps that divide the period, that it divides, and that have nothing to do with it.
    for (period, step) in [(0.01, 0.01), (0.01, 0.0025), (0.01, 0.04), (0.01, 0.0037), (0.013, 0.01), (0.5, 0.01)] {
        for method in ["conserving-ggl", "conserving", "generalized-alpha", "radau", "trapezoidal"] {
            let mut simulation = begin(&cart(period), method, step);
            let end = 1.2345;
            assert_eq!(simulation.step_to(end), Status::Completed, "{method}");
            let [x, v, sum] = exact(period, end);
            let state = simulation.state();
            let apart = (state.x[0] - x).abs().max((state.v[0] - v).abs()).max((simulation.input("sum").unwrap() - sum).abs());
            assert!(apart < 1e-11, "{method} with steps of {step} and samples every {period}: {apart}");
            assert!(simulation.events().is_empty(), "samples are no news");
        }
    }
}

#[test]
fn what_is_sampled_at_a_nominal_time_is_there_at_that_time() {
    let mut simulation = begin(&cart(0.1), "conserving-ggl", 0.05);
    let mut pushes = Vec::new();
    let mut look = |now: &Simulation| {
        pushes.push(now.input("push").unwrap());
        holonom::simulation::Verdict::GoOn
    };
    assert_eq!(simulation.run(0.2, &mut look), Status::Completed);
    assert_eq!(pushes.len(), 5);
    assert_eq!(pushes[0], GAINS[0] - 0.5 * GAINS[1], "the first sample is at the start");
    assert_eq!([pushes[0], pushes[2]], [pushes[1], pushes[3]], "which is held");
    assert!(pushes[2] != pushes[1] && pushes[4] != pushes[3]);
}

/// A sample and a condition at 0.375 s, a number that binary fractions have, in either order.
#[test]
fn samples_and_conditions_at_one_time_happen_in_the_order_of_the_file() {
    let sample = "[event.sample]\nevery = 0.125\nset = { n = \"2*n + 1\" }\n";
    let of = |condition: &str| format!("[event.once]\nwhen = \"{condition}\"\nset = {{ n = \"n + 100\" }}\n");
    let mass = "gravity = [0, 0, 0]\n[point.p]\nmass = 1\nposition = [0, 0, 0]\nvelocity = [1, 0, 0]\n[input.n]\n";
    for condition in ["t - 0.375", "2*t - 0.75"] {
        let once = of(condition);
        for (events, n) in [(format!("{sample}{once}"), 115.0), (format!("{once}{sample}"), 215.0)] {
            for (method, step) in [("conserving-ggl", 0.0625), ("radau", 0.0625), ("trapezoidal", 0.25), ("ode/rk4", 0.03125)] {
                let mut simulation = begin(&format!("{mass}{events}"), method, step);
                assert_eq!(simulation.step_to(0.4375), Status::Completed, "{method}");
                assert_eq!(simulation.input("n"), Some(n), "{method} with steps of {step} s\n{events}");
                assert_eq!(simulation.events().len(), 1);
            }
        }
    }
}

fn steps(simulation: &mut Simulation, count: usize) {
    (0..count).for_each(|_| assert_eq!(simulation.step(), Status::Completed));
}

#[test]
fn samples_go_on_to_the_same_bits() {
    for (method, step) in [("conserving-ggl", 0.004), ("generalized-alpha", 0.01), ("radau", 0.0037)] {
        let text = cart(0.01);
        let mut whole = begin(&text, method, step);
        steps(&mut whole, 57);
        let checkpoint = whole.checkpoint();
        steps(&mut whole, 60);
        let method = Method::resolve(&Choice::default().named(method)).unwrap();
        let mut rest = Simulation::resume(model(&text).system, method, step, checkpoint).unwrap();
        steps(&mut rest, 60);
        assert_eq!((whole.state(), whole.input("sum")), (rest.state(), rest.input("sum")));
    }
}

#[test]
fn a_sample_without_a_value_stops_the_run() {
    let text = cart(0.01).replace("sum + missing*0.01", "sqrt(0.3 - cart.x)");
    let mut simulation = begin(&text, "conserving-ggl", 0.01);
    let Status::Stopped { at, reason } = simulation.step_to(2.0) else { panic!("it went on") };
    assert!(at > 0.1 && at < 1.0 && reason.contains("what the event `controller` sets an input to has no value"), "{at} {reason}");
}

/// Samples far closer than a millionth of the nominal step are taken all the same.
#[test]
fn no_sample_is_left_out() {
    let text =
        "gravity = [0, 0, 0]\n[point.p]\nmass = 1\nposition = [0, 0, 0]\n[input.n]\n[event.e]\nevery = PERIOD\nset = { n = \"n + 1\" }\n";
    for (period, step, end, expected) in [("1e-3", 2000.0, 10.0, 10_001.0), ("9e-7", 1.0, 0.01, 11_112.0), ("1.01e-6", 1.0, 0.01, 9_901.0)]
    {
        let mut simulation = begin(&text.replace("PERIOD", period), "conserving-ggl", step);
        assert_eq!(simulation.run(end, &mut |_: &Simulation| holonom::simulation::Verdict::GoOn), Status::Completed);
        assert_eq!(simulation.input("n"), Some(expected), "every {period} s");
    }
}
