//! Singular configurations: the N-four-bar mechanism (IFToMM A02) loses N ranks twice a turn.

mod common;

use common::{four_bar, named, run};
use holonom::simulation::Status;

/// B0 at 10 s from the closed solution by elliptic functions, m.
const EXACT: [(usize, [f64; 2]); 3] = [
    (1, [0.478385057760971, 0.878150178791209]),
    (10, [0.204353560989771, 0.978897145828304]),
    (40, [0.180512226686728, 0.983572740582312]),
];

#[test]
fn four_bars_pass_every_singular_configuration() {
    for (n, exact) in EXACT {
        let system = four_bar(n);
        let energy_scale = 9.81 * (2 * n + 1) as f64;
        for (step, tolerance) in [(1e-2, 5e-3), (1e-3, 5e-5)] {
            for name in ["conserving", "conserving-ggl"] {
                let run = run(&system, &named(name), step, 10.0);
                assert_eq!(run.status, Status::Completed, "N = {n}, {name}, step {step}");
                let error = (run.position[0] - exact[0]).hypot(run.position[1] - exact[1]);
                let drift = run.summary.energy.max_drift / energy_scale;
                let rejected = run.summary.work.rejected_steps as f64 / run.summary.steps as f64;
                println!("N = {n}, {name}, step {step}: error {error:.1e}, drift {drift:.1e}, rejected {rejected:.4}");
                assert!(error <= tolerance, "N = {n}, {name}, step {step}: error {error}");
                assert!(drift <= 1e-8, "N = {n}, {name}, step {step}: drift {drift}");
                assert!(rejected < 0.02, "N = {n}, {name}, step {step}: rejected {rejected}");
            }
        }
    }
}
