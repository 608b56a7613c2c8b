//! What is drawn of the runs and measured on them.

use super::figure::Curve;
use super::results::{Results, Series, largest, smallest};
use super::runs::STEPS;

/// A quantity of a run against time.
pub fn over_time(results: &Results, curve: &Curve, quantity: impl Fn(&Series) -> Vec<f64>) -> Vec<(f64, f64)> {
    let run = results.of_run(curve.runs, curve.method);
    run.times().iter().copied().zip(quantity(run)).collect()
}

/// Distance of the energy from where it started, J.
pub fn energy_distance(run: &Series) -> Vec<f64> {
    run.energy_change().iter().map(|change| change.abs()).collect()
}

/// ‖Φ‖ at twice a time over ‖Φ‖ at that time: 2 where it grows linearly, 4 where it grows with the square.
pub fn growth(results: &Results, method: &str, time: f64) -> f64 {
    let run = results.pendulum(method);
    run.at(2.0 * time, "phi") / run.at(time, "phi")
}

/// Largest ‖Φ‖ of the second 10 s over that of the first.
pub fn later_over_earlier(results: &Results, method: &str) -> f64 {
    let run = results.pendulum(method);
    let [earlier, later] = [(0.0, 10.0), (10.0, 20.0)].map(|(from, to)| largest(&run.between(from, to, run.column("phi"))));
    later / earlier
}

/// Position of m2 at 2 s, m, by refinement of the step (the repository's benchmark of the paper's pendulum).
const REFERENCE: [f64; 3] = [-1.27229634990966, -0.953716555813986, -1.21313096126217];

/// Below this an error is round-off and the digits of [`REFERENCE`], m.
const SMALLEST_ERROR: f64 = 2e-12;

/// Distance of m2 from [`REFERENCE`] at 2 s, m.
pub fn error(results: &Results, method: &str, step: &str) -> f64 {
    let run = results.of_step("accuracy", method, step);
    let difference = ["m2.x", "m2.y", "m2.z"].iter().zip(REFERENCE).map(|(column, place)| run.last(column) - place);
    difference.map(|d| d * d).sum::<f64>().sqrt()
}

/// Step and error, where the error is more than round-off.
pub fn errors(results: &Results, method: &str) -> Vec<(f64, f64)> {
    let size = |step: &str| step.parse().expect("a step is a number");
    STEPS.iter().map(|step| (size(step), error(results, method, step))).filter(|(_, error)| *error > SMALLEST_ERROR).collect()
}

/// Measured order, from the two smallest steps whose errors are more than round-off.
pub fn slope(results: &Results, method: &str) -> f64 {
    match errors(results, method)[..] {
        [.., (large, error_large), (small, error_small)] => (error_large / error_small).ln() / (large / small).ln(),
        _ => f64::NAN,
    }
}

pub fn iterations(results: &Results, method: &str, step: &str) -> f64 {
    results.of_step("accuracy", method, step).column("iterations").iter().sum()
}

/// Largest ‖Φ‖ of a smaller penalty over that of a larger one.
pub fn softer(results: &Results, small: &str, large: &str) -> f64 {
    let [small, large] = [small, large].map(|runs| results.of_run(runs, "penalty/conserving").largest("phi"));
    small / large
}

/// How far the spring's length ranges in the last 2 s, m.
pub fn range_of_stretch(results: &Results, runs: &str, method: &str) -> f64 {
    let run = results.of_run(runs, method);
    let late = run.between(8.0, 10.0, &run.stretch());
    largest(&late) - smallest(&late)
}

/// How often the spring vibrates: it passes the middle of its range twice each time.
pub fn vibrations(results: &Results, runs: &str, method: &str) -> f64 {
    let stretch = results.of_run(runs, method).stretch();
    let middle = (largest(&stretch) + smallest(&stretch)) / 2.0;
    stretch.windows(2).filter(|pair| (pair[0] > middle) != (pair[1] > middle)).count() as f64 / 2.0
}
