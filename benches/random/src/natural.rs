//! How large the gradients of rows are by nature: where they vanish they say nothing of a row.

use holonom::analysis;
use holonom::system::System;

/// Gradient, over that of rows of lengths or of numbers, whichever is less, that may be round-off wherever the nodes are.
const NOTHING: f64 = 1e-9;

/// A further move, over the mechanism's size, and the largest share that a gradient which is no round-off changes by.
const FURTHER: f64 = 1e-9;
const CHANGED: f64 = 1e-3;

/// Length of the gradient of each row where all nodes are moved by the size of the mechanism, here and there. It is infinite for
/// rows that hold nothing, as what they are of cancels whatever the positions: an angle between parts that share their nodes.
pub fn gradients(system: &System, size: f64) -> Vec<f64> {
    let moved = |share: f64| {
        let start = system.start_position().iter().enumerate();
        let x: Vec<f64> = start.map(|(k, x)| x + share * size * (78.233 * (k as f64 + 1.0)).sin()).collect();
        analysis::constraint_jacobian(system, &x, 0.0)
    };
    let natural = |(there, further): (&Vec<f64>, &Vec<f64>)| {
        let change: Vec<f64> = there.iter().zip(further).map(|(there, further)| there - further).collect();
        let natural = length(there);
        let is_round_off = natural <= NOTHING * size.min(1.0) || length(&change) > CHANGED * natural;
        if is_round_off { f64::INFINITY } else { natural }
    };
    moved(1.0).iter().zip(&moved(1.0 + FURTHER)).map(natural).collect()
}

pub fn length(row: &[f64]) -> f64 {
    row.iter().map(|g| g * g).sum::<f64>().sqrt()
}
