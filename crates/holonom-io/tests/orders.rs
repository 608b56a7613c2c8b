//! Every combination of formulation, integrator, order, iteration and projection on four models: it runs, comes to the
//! reference solutions computed elsewhere in 113-bit arithmetic, and converges with the order that the table documents.

mod common;

use std::collections::BTreeMap;

use common::example;
use holonom::model::Model;
use holonom::simulation::{Choice, Method, Simulation, Status, Verdict, combinations};

/// A model and how it is run.
struct Problem {
    model: &'static str,
    /// Length of the run for methods of order 1 and 2, 3 and 4, 5 and 6, 8, s: so long that errors stay above round-off.
    ends: [f64; 4],
    /// Penalty of the penalty formulations: so soft that the steps resolve its vibration.
    penalty: f64,
    /// Reference in 113-bit arithmetic: time, and the first coordinates of the model's free points.
    time: f64,
    place: &'static [f64],
}

const PROBLEMS: [Problem; 4] = [
    Problem {
        model: "spherical-compound-pendulum",
        ends: [0.5, 1.0, 1.0, 4.0],
        penalty: 100.0,
        time: 0.5,
        place: &[0.722991489655185, 0.210003143628563, -0.65816562167307],
    },
    Problem { model: "four-bar", ends: [0.5, 0.5, 0.45, 0.52], penalty: 100.0, time: 0.5, place: &[0.701512678910477, 0.712656973113886] },
    Problem {
        model: "spring-pendulum",
        ends: [0.1, 0.2, 0.3, 0.8],
        penalty: 100.0,
        time: 0.1,
        place: &[0.998936556730746, -0.0490275158370918],
    },
    Problem {
        model: "car-axis",
        ends: [0.25, 0.25, 0.5, 1.5],
        penalty: 0.05,
        time: 0.25,
        place: &[-0.029902854199771, 0.498757629634518, 0.966380366794061, 0.584895563009745],
    },
];

/// Errors are the mean over this many equally spaced times, so that no zero crossing passes for an order.
const SAMPLES: u32 = 2;

/// Errors below these shares of positions, velocities and forces are round-off.
const FLOOR: [f64; 3] = [3e-12, 1e-10, 1e-10];

/// Tolerance of the paper's loops here, m, and how much higher round-off is with it.
const LOOP_TOLERANCE: f64 = 1e-12;
const LOOP_FLOOR: f64 = 3e2;

/// Frequency of the stabilised formulations, 1/s: slow against the steps.
const OMEGA: f64 = 2.0;

/// Most steps that are tried.
const MOST: u32 = 8192;

/// Most steps for errors of order 0: they change sign from step to step and nothing damps them, so that at thousands of
/// steps the round-off of all steps comes to their size.
const MOST_UNDAMPED: u32 = 2048;

/// How far a measured order may lie from the documented one. Of order 8 double precision shows two or three halvings; all
/// but the reactions of the stabilised penalty on the four-bar (7.4) are within 0.2 all the same.
fn tolerance(order: u8) -> f64 {
    if order <= 6 { 0.2 } else { 0.65 }
}

const QUANTITIES: [&str; 3] = ["positions", "velocities", "reactions"];

/// Positions, velocities and forces of the constraints at the sampled times.
type Samples = [Vec<f64>; 3];

fn run(model: &Model, choice: &Choice, steps: u32, end: f64) -> Option<Samples> {
    let method = Method::resolve(choice).unwrap();
    let mut simulation = Simulation::new(model.system.clone(), method, end / f64::from(steps)).unwrap();
    simulation.find_reactions();
    let n = model.system.coordinates();
    let mut samples = Samples::default();
    let status = simulation.run(end, &mut |simulation: &Simulation| {
        if simulation.steps() > 0 && simulation.steps().is_multiple_of(u64::from(steps / SAMPLES)) {
            samples[0].extend_from_slice(&simulation.state().x[..n]);
            samples[1].extend_from_slice(&simulation.velocities()[..n]);
            samples[2].extend_from_slice(&simulation.constraint_forces().expect("they were asked for")[..n]);
        }
        Verdict::GoOn
    });
    (status == Status::Completed).then_some(samples)
}

/// Root of the mean square.
fn size(values: impl ExactSizeIterator<Item = f64>) -> f64 {
    let count = values.len() as f64;
    (values.map(|x| x * x).sum::<f64>() / count).sqrt()
}

/// Numbers of steps 2, 4, 6, 8, 12, 16, 24 …
fn ladder() -> impl Iterator<Item = u32> {
    let powers = (0..16_u32).flat_map(|k| [2_u32 << k, 3 << k]);
    powers.filter(|steps| steps.is_multiple_of(SAMPLES)).take_while(|steps| *steps <= MOST)
}

/// Errors of a method against the same formulation (or the eliminated one, where all agree) by Dormand and Prince's
/// method of order 8 with 1024 steps, for rising numbers of steps until all are round-off.
fn errors(model: &Model, choice: &Choice, exact: &Samples, end: f64, floor: &[f64; 3]) -> Vec<(u32, [f64; 3])> {
    let mut errors = Vec::new();
    for steps in ladder() {
        let Some(found) = run(model, choice, steps, end) else { continue };
        let error: [f64; 3] = std::array::from_fn(|c| size(found[c].iter().zip(&exact[c]).map(|(a, b)| a - b)));
        errors.push((steps, error));
        if (0..3).all(|c| error[c].is_nan() || error[c] <= floor[c]) {
            break;
        }
    }
    errors
}

/// Slope between an error above round-off and that of half as many steps. Where parts of an error cancel, single slopes
/// are off on both sides: of the last three the one nearest to the documented order counts.
fn slope(errors: &[(u32, [f64; 3])], floor: f64, c: usize, documented: f64) -> Option<f64> {
    let most = if documented == 0.0 { MOST_UNDAMPED } else { MOST };
    let errors = errors.iter().map(|(steps, error)| (*steps, error[c]));
    let valid: Vec<(u32, f64)> = errors.take_while(|(steps, error)| *error > floor && *steps <= most).collect();
    let coarse = |steps: u32| valid.iter().find(|(other, _)| 2 * other == steps);
    let slopes = valid.iter().rev().filter_map(|&(steps, fine)| Some((coarse(steps)?.1 / fine).log2())).take(3);
    slopes.min_by(|a, b| (a - documented).abs().total_cmp(&(b - documented).abs()))
}

/// Measured orders of one combination on one model; what falls short of the documented ones goes to `short`.
fn measure(problem: &Problem, model: &Model, mut choice: Choice, short: &mut Vec<String>) -> (String, [Option<bool>; 3]) {
    let loops = choice.iteration.as_deref() != Some("newton");
    choice.subdivide = Some(false);
    choice.omega = Some(OMEGA);
    choice.tolerance = loops.then_some(LOOP_TOLERANCE);
    let method = Method::resolve(&choice).unwrap();
    let soft = method.formulation.soft;
    choice.penalty = soft.then_some(problem.penalty);
    let of = method.parameters.order;
    let end = problem.ends[[0, 0, 0, 1, 1, 2, 2, 3, 3][of as usize]];
    let reference = if soft { format!("{}/dop853", method.formulation.full_name()) } else { "ode/dop853/velocity".into() };
    let reference = Choice { method: Some(reference), penalty: choice.penalty, omega: choice.omega, ..Choice::default() };
    let exact = run(model, &reference, 1024, end).expect("the reference completes");
    let floor: [f64; 3] = std::array::from_fn(|c| FLOOR[c] * size(exact[c].iter().copied()) * if loops { LOOP_FLOOR } else { 1.0 });
    let errors = errors(model, &choice, &exact, end, &floor);
    // Without rows every formulation is the plain differential equation.
    let documented = if model.system.constraints() == 0 { [of; 3] } else { method.convergence() };
    let name = format!("{}, {}", method.name, method.iteration);
    let met = std::array::from_fn(|c| {
        if exact[c].iter().all(|x| *x == 0.0) {
            return None;
        }
        let found = slope(&errors, floor[c], c, f64::from(documented[c]));
        let allowed = tolerance(of);
        if found.is_none_or(|found| found < f64::from(documented[c]) - allowed) {
            short.push(format!("{}: {name}: {} of order {}, measured {found:.2?}", problem.model, QUANTITIES[c], documented[c]));
        }
        found.map(|found| found <= f64::from(documented[c]) + allowed)
    });
    (name, met)
}

/// What one model shows: which documented orders are met exactly, by name of the combination and quantity.
fn walk(problem: &Problem, short: &mut Vec<String>) -> BTreeMap<(String, usize), bool> {
    let model = example(problem.model);
    let mut exact = BTreeMap::new();
    for choice in combinations() {
        let (name, met) = measure(problem, &model, choice, short);
        for (c, met) in met.into_iter().enumerate() {
            if let Some(met) = met {
                exact.insert((name.clone(), c), met);
            }
        }
    }
    exact
}

/// Documented orders are what can be relied upon: no model shows less, and at least one shows no more.
#[test]
fn every_combination_has_its_order() {
    let found: Vec<_> = std::thread::scope(|scope| {
        let walk = |problem| {
            move || {
                let mut short = Vec::new();
                (walk(problem, &mut short), short)
            }
        };
        let threads: Vec<_> = PROBLEMS.iter().map(|problem| scope.spawn(walk(problem))).collect();
        threads.into_iter().map(|thread| thread.join().expect("no combination panics")).collect()
    });
    let short: Vec<String> = found.iter().flat_map(|(_, short)| short.clone()).collect();
    let mut exact: BTreeMap<(String, usize), bool> = BTreeMap::new();
    for (key, met) in found.into_iter().flat_map(|(met, _)| met) {
        *exact.entry(key).or_default() |= met;
    }
    // Velocities that are off across the constraints only leave the reactions alone, which are then better than can be
    // relied upon.
    let understated: Vec<String> = exact
        .iter()
        .filter(|((_, c), met)| !**met && *c < 2)
        .map(|((name, c), _)| format!("{name}: {} are better than documented", QUANTITIES[*c]))
        .collect();
    println!("{} combinations on {} models", combinations().len(), PROBLEMS.len());
    assert!(short.is_empty(), "{} fall short\n{}", short.len(), short.join("\n"));
    assert!(understated.is_empty(), "{} understated\n{}", understated.len(), understated.join("\n"));
}

/// Generalized-α has order 2 in everything for any ρ∞, and so has HHT; Newmark with γ > 1/2 has order 1.
#[test]
fn parameters_decide_on_the_order() {
    let problem = &PROBLEMS[0];
    let model = example(problem.model);
    let choice = |method: &str| Choice::default().named(method);
    let rho = |rho: f64| Choice { rho: Some(rho), ..choice("lagrange-3/generalized-alpha") };
    let alpha = |alpha: f64| Choice { alpha: Some(alpha), ..choice("lagrange-3/hht") };
    let newmark = Choice { beta: Some(0.3025), gamma: Some(0.6), ..choice("lagrange-3/newmark") };
    let mut short = Vec::new();
    for mut choice in [rho(1.0), rho(0.8), rho(0.5), rho(0.0), alpha(0.05), alpha(0.3), newmark] {
        choice.iteration = Some("newton".into());
        let (name, met) = measure(problem, &model, choice.clone(), &mut short);
        println!("{name}, ρ∞ {:?}, α {:?}, γ {:?}: {met:?}", choice.rho, choice.alpha, choice.gamma);
        assert_eq!(met, [Some(true); 3], "{name}");
    }
    assert!(short.is_empty(), "{}", short.join("\n"));
}

/// The solutions that orders are measured against are those of the references computed elsewhere.
#[test]
fn the_measure_agrees_with_the_references() {
    for problem in &PROBLEMS {
        let model = example(problem.model);
        let choice = Choice::default().named("ode/dop853/velocity");
        let found = run(&model, &choice, 512, problem.time).unwrap();
        let last = &found[0][found[0].len() / SAMPLES as usize..];
        for (found, place) in last.iter().zip(problem.place) {
            assert!((found - place).abs() < 2e-14, "{}: {found} and not {place}", problem.model);
        }
    }
}

/// The penalty formulation comes to the constraint as its penalty grows: ten times the penalty, a tenth of the error.
#[test]
fn penalties_come_to_the_constraint() {
    let model = example("spherical-compound-pendulum");
    let exact = run(&model, &Choice::default().named("ode/dop853/velocity"), 1024, 0.5).unwrap();
    let error = |formulation: &str, penalty: f64| {
        let choice = Choice { method: Some(format!("{formulation}/radau")), penalty: Some(penalty), ..Choice::default() };
        let found = run(&model, &choice, 512, 0.5).unwrap();
        size(found[0].iter().zip(&exact[0]).map(|(a, b)| a - b))
    };
    for formulation in ["penalty", "penalty-stabilized"] {
        let ratio = error(formulation, 1e6) / error(formulation, 1e7);
        println!("{formulation}: {ratio:.2}");
        assert!((5.0..20.0).contains(&ratio), "{formulation}: {ratio}");
    }
}
