//! Every combination of formulation, integrator, iteration and projection on four models: it runs, comes to the reference
//! solutions computed elsewhere in 113-bit arithmetic, and converges with the order that the table documents.

use holonom::integrator::INTEGRATORS;
use holonom::model::Model;
use holonom::simulation::{Choice, Method, ProjectionChoice, Simulation, Status, Verdict};
use holonom_io::Source;

struct Problem {
    model: &'static str,
    /// Length of the run for methods of order 1 and 2, of order 3 to 6, and above, s.
    ends: [f64; 4],
    /// Penalty of the penalty formulations: so soft that its vibration is slow.
    penalty: f64,
}

/// Times at which errors are taken, as shares of the run: the mean over them hides no zero crossing.
const SAMPLES: u32 = 2;

fn example(name: &str) -> Model {
    let path = format!("{}/../../examples/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    let source = Source::read(name, &std::fs::read(path).unwrap()).unwrap_or_else(|message| panic!("{message}"));
    source.model().unwrap_or_else(|message| panic!("{message}"))
}

/// Positions, velocities and forces of the constraints at the sampled times.
type Samples = [Vec<f64>; 3];

fn run(model: &Model, choice: &Choice, steps: u32, end: f64) -> Option<Samples> {
    let method = Method::resolve(choice).unwrap();
    let mut simulation = Simulation::new(&model.system, method, end / f64::from(steps)).unwrap();
    simulation.find_reactions();
    let n = model.system.coordinates();
    let mut samples: Samples = Default::default();
    let status = simulation.run(end, &mut |simulation: &Simulation<'_>| {
        if simulation.steps() > 0 && simulation.steps().is_multiple_of(u64::from(steps / SAMPLES)) {
            samples[0].extend_from_slice(&simulation.state().x[..n]);
            samples[1].extend_from_slice(&simulation.velocities()[..n]);
            samples[2].extend_from_slice(&simulation.reactions().unwrap().force[..n]);
        }
        Verdict::GoOn
    });
    (status == Status::Completed).then_some(samples)
}

fn size(values: &[f64]) -> f64 {
    (values.iter().map(|x| x * x).sum::<f64>() / values.len() as f64).sqrt()
}

fn error(a: &[f64], b: &[f64]) -> f64 {
    size(&a.iter().zip(b).map(|(a, b)| a - b).collect::<Vec<_>>())
}

/// Errors below this share of the values are round-off.
const FLOOR: [f64; 3] = [3e-12, 1e-11, 1e-10];

/// Tolerance of the paper's loops here, m, and how much higher round-off is with it.
const LOOP_TOLERANCE: f64 = 1e-11;
const LOOP_FLOOR: f64 = 3e3;

/// Most steps that are tried.
const MOST: u32 = 8192;

/// Steps of a run: 2, 4, 6, 8, 12, 16, 24 …
fn ladder() -> impl Iterator<Item = u32> {
    (0..26_u32).map(|k| if k.is_multiple_of(2) { 2 << (k / 2) } else { 3 << (k / 2) }).filter(|steps: &u32| steps.is_multiple_of(SAMPLES))
}

/// Slope between an error above round-off and that of half as many steps: the middle one of the last three such pairs.
fn order(errors: &[(u32, [f64; 3])], scale: &[f64; 3], floor: f64, c: usize) -> Option<f64> {
    let valid: Vec<(u32, f64)> = errors.iter().map(|(steps, e)| (*steps, e[c])).take_while(|(_, e)| *e > floor * FLOOR[c] * scale[c]).collect();
    let coarse = |steps: u32| valid.iter().find(|(other, _)| 2 * other == steps);
    let mut slopes: Vec<f64> = valid.iter().rev().filter_map(|&(steps, fine)| Some((coarse(steps)?.1 / fine).log2())).take(3).collect();
    slopes.sort_by(f64::total_cmp);
    slopes.get(slopes.len() / 2).copied()
}

fn walk(problem: &Problem) {
    let model = example(problem.model);
    let (mut combinations, mut wrong, mut met, mut above) = (0, 0, 0, 0);
    let mut above_list = Vec::new();
    for entry in INTEGRATORS {
        for full in entry.formulations {
            for &of in entry.orders {
                for iteration in entry.iterations {
                    for levels in [&[][..], &["velocity"], &["velocity", "acceleration"]] {
                        let choice = Choice {
                            formulation: Some(full.to_string()),
                            integrator: Some(entry.name.into()),
                            order: Some(of),
                            iteration: Some(iteration.to_string()),
                            subdivide: Some(false),
                            tolerance: (*iteration != "newton").then_some(LOOP_TOLERANCE),
                            penalty: full.starts_with("penalty").then_some(problem.penalty),
                            omega: Some(2.0),
                            projection: Some(ProjectionChoice { levels: Some(levels.iter().map(|l| l.to_string()).collect()), ..ProjectionChoice::default() }),
                            ..Choice::default()
                        };
                        let Ok(method) = Method::resolve(&choice) else { continue };
                                                combinations += 1;
                        let expected = if model.system.constraints() == 0 { [of; 3] } else { method.convergence() };
                        let end = problem.ends[match of { 1 | 2 => 0, 3 | 4 => 1, 5 | 6 => 2, _ => 3 }];
                        let formulation = if method.formulation.soft { full.to_string() } else { "ode".into() };
                        let exact = Choice { formulation: Some(formulation), integrator: Some("dop853".into()), penalty: choice.penalty, omega: choice.omega, ..Choice::default() };
                        let exact = run(&model, &exact, 1024, end).unwrap();
                        let scale = [size(&exact[0]), size(&exact[1]), size(&exact[2])];
                        let mut errors: Vec<(u32, [f64; 3])> = Vec::new();
                        let floor = if *iteration == "newton" { 1.0 } else { LOOP_FLOOR };
                        for steps in ladder().take_while(|steps| *steps <= MOST) {
                            if let Some(found) = run(&model, &choice, steps, end) {
                                let e: [f64; 3] = std::array::from_fn(|c| error(&found[c], &exact[c]));
                                errors.push((steps, e));
                                if (0..3).all(|c| !(e[c] > floor * FLOOR[c] * scale[c])) { break; }
                            }
                        }
                        if std::env::var("SHOW").is_ok_and(|w| format!("{full} {} {levels:?}", entry.name).contains(&w)) { println!("{of} {levels:?} {errors:?}"); }
                        for c in 0..3 {
                            if c == 2 && scale[2] == 0.0 { continue; }
                            let p = f64::from(expected[c]);
                            match order(&errors, &scale, floor, c) {
                                Some(found) if found >= p - 0.2 => { if found < p + 0.2 {met += 1} else {above += 1; if found < 99.0 {above_list.push(format!("{} {full} {}-{of} {levels:?} {iteration}: {} {p} {found:.2}", problem.model, entry.name, ["q","v","l"][c])); }} }
                                found => {
                                    wrong += 1;
                                    println!("{} {full} {}-{of} {levels:?} {iteration}: {} {p} is {found:?}", problem.model, entry.name, ["q", "v", "λ"][c]);
                                }
                            }
                        }
                    }
                }
            }
        }
    }
    println!("{}: {combinations} combinations, {wrong} wrong {met} met {above} above", problem.model); for a in above_list { println!("ABOVE {a}"); }
}

#[test]
fn pendulum() { walk(&Problem { model: "spherical-compound-pendulum", ends: [0.5, 1.0, 2.0, 4.0], penalty: 100.0 }); }
#[test]
fn four_bar() { walk(&Problem { model: "four-bar", ends: [0.5, 0.5, 0.5, 0.7], penalty: 100.0 }); }
#[test]
fn spring() { walk(&Problem { model: "spring-pendulum", ends: [0.1, 0.2, 0.4, 0.8], penalty: 100.0 }); }
#[test]
fn car() { walk(&Problem { model: "car-axis", ends: [0.25, 0.25, 0.5, 1.0], penalty: 0.05 }); }
