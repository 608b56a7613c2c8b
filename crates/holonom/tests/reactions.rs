//! Forces of the constraints against second derivatives found by hand.

mod common;

use common::*;
use holonom::simulation::{Choice, Method, Simulation, Status, Verdict};

/// Position and velocity of the inner mass of the pendulum at t = 2 s in 113-bit arithmetic, m and m/s.
const PLACE: [f64; 3] = [-0.636148174954829, -0.476858277906993, -0.606565480631083];
const VELOCITY: [f64; 3] = [1.66085502896847, 0.459000717856033, -2.10270486558312];

/// Forces of the rod on both masses, N: with 5 ë = 3 (g − (g·e) e) − 5 |ė|² e for the direction e of the rod, the masses
/// at e and 2e are accelerated by ë and 2ë.
fn forces() -> [f64; 6] {
    let (e, rate, g) = (PLACE, VELOCITY, [0.0, 0.0, -9.81]);
    let dot = |a: [f64; 3], b: [f64; 3]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let turning: [f64; 3] = std::array::from_fn(|c| 0.6 * (g[c] - dot(g, e) * e[c]) - dot(rate, rate) * e[c]);
    std::array::from_fn(|k| if k < 3 { turning[k] - g[k] } else { 2.0 * turning[k - 3] - g[k - 3] })
}

fn error(choice: &Choice, step: f64) -> f64 {
    let system = pendulum();
    let mut simulation = Simulation::new(system.clone(), Method::resolve(choice).unwrap(), step).unwrap();
    assert_eq!(simulation.run(2.0, &mut |_: &Simulation| Verdict::GoOn), Status::Completed);
    simulation.find_reactions();
    let found = simulation.constraint_forces().unwrap();
    found.iter().zip(forces()).map(|(found, force)| (found - force).abs()).fold(0.0, f64::max)
}

/// With every integrator and formulation whose order the table gives as two or more, the forces on both masses are of
/// order two or better, although one of the five rows is redundant and single multipliers mean nothing.
#[test]
fn rod_forces_are_of_second_order() {
    let mut methods = 0;
    for (name, choice) in every_method() {
        let method = Method::resolve(&choice).unwrap();
        let [.., claimed] = method.convergence();
        // The penalty formulations have forces of their own, and the paper's loops the same as Newton's iteration.
        if claimed < 2 || method.formulation.soft || method.iteration != "newton" || method.accuracy.is_some() {
            continue;
        }
        let (coarse, fine) = (error(&choice, 0.01), error(&choice, 0.005));
        let order = (coarse / fine).log2();
        assert!(order > 1.8 || fine < 1e-8, "{name}: errors {coarse:.1e} and {fine:.1e} N, order {order:.2}");
        methods += 1;
    }
    println!("{methods} methods");
    assert!(methods > 100);
}
