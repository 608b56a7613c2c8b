//! Every combination of formulation, integrator, iteration and projection on four models: it runs, comes to the reference
//! solutions computed elsewhere in 113-bit arithmetic, and converges with the order that the table documents.

use holonom::integrator::INTEGRATORS;
use holonom::model::Model;
use holonom::simulation::{Choice, Method, ProjectionChoice, Simulation, Status, Verdict};
use holonom_io::Source;

struct Problem {
    model: &'static str,
    /// Length of the run for methods of order 1 and 2, of order 3 to 6, and above, s.
    ends: [f64; 3],
    /// Penalty of the penalty formulations: so soft that its vibration is slow.
    penalty: f64,
}

/// Times at which errors are taken, as shares of the run: the mean over them hides no zero crossing.
const SAMPLES: u32 = 4;

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
const FLOOR: [f64; 3] = [1e-11, 3e-11, 3e-10];

/// Most steps that are tried.
const MOST: u32 = 8192;

/// Slope of the last steps above round-off, and their error.
fn order(errors: &[[f64; 3]], scale: &[f64; 3], c: usize) -> Option<(f64, f64)> {
    let valid: Vec<f64> = errors.iter().map(|e| e[c]).take_while(|e| *e > FLOOR[c] * scale[c]).collect();
    let [.., a, b] = valid[..] else { return None };
    Some(((a / b).log2(), b / scale[c]))
}

fn walk(problem: &Problem) {
    let model = example(problem.model);
    let (mut combinations, mut wrong) = (0, 0);
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
                            penalty: full.starts_with("penalty").then_some(problem.penalty),
                            projection: Some(ProjectionChoice { levels: Some(levels.iter().map(|l| l.to_string()).collect()), ..ProjectionChoice::default() }),
                            ..Choice::default()
                        };
                        let Ok(method) = Method::resolve(&choice) else { continue };
                        if *iteration != "newton" { continue; }
                        combinations += 1;
                        let expected = method.convergence();
                        let end = problem.ends[match of { 1 | 2 => 0, 3..=6 => 1, _ => 2 }];
                        let formulation = if method.formulation.soft { full.to_string() } else { "ode".into() };
                        let exact = Choice { formulation: Some(formulation), integrator: Some("dop853".into()), penalty: choice.penalty, ..Choice::default() };
                        let exact = run(&model, &exact, 1024, end).unwrap();
                        let scale = [size(&exact[0]), size(&exact[1]), size(&exact[2])];
                        let mut errors: Vec<[f64; 3]> = Vec::new();
                        let mut steps = SAMPLES;
                        while steps <= MOST {
                            if let Some(found) = run(&model, &choice, steps, end) {
                                let e = std::array::from_fn(|c| error(&found[c], &exact[c]));
                                errors.push(e);
                                if (0..3).all(|c| !(e[c] > 30.0 * FLOOR[c] * scale[c])) { break; }
                            }
                            steps *= 2;
                        }
                        for c in 0..3 {
                            if c == 2 && scale[2] == 0.0 { continue; }
                            let p = f64::from(expected[c]);
                            match order(&errors, &scale, c) {
                                Some((found, _)) if (found - p).abs() <= 0.2 => {}
                                found => {
                                    wrong += 1;
                                    println!("{} {full} {}-{of} {levels:?}: {} {p} is {found:?} steps {steps}", problem.model, entry.name, ["q", "v", "λ"][c]);
                                }
                            }
                        }
                    }
                }
            }
        }
    }
    println!("{}: {combinations} combinations, {wrong} wrong", problem.model);
}

#[test]
fn pendulum() { walk(&Problem { model: "spherical-compound-pendulum", ends: [0.5, 1.0, 2.0], penalty: 100.0 }); }
#[test]
fn four_bar() { walk(&Problem { model: "four-bar", ends: [0.5, 0.5, 0.7], penalty: 100.0 }); }
#[test]
fn spring() { walk(&Problem { model: "spring-pendulum", ends: [0.1, 0.2, 0.4], penalty: 100.0 }); }
#[test]
fn car() { walk(&Problem { model: "car-axis", ends: [0.25, 0.25, 0.5], penalty: 0.05 }); }
