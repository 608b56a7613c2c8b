//! The gradients of the rows as a dense matrix, for those who want to judge it by other means.

use crate::system::System;

/// Gradients of the rows by the coordinates (r lists of n) at the positions `x` of all nodes and time `t`, in the units of
/// the rows over m.
pub fn constraint_jacobian(system: &System, x: &[f64], t: f64) -> Vec<Vec<f64>> {
    let (n, dim) = (system.coordinates(), system.dimension());
    let mut at = system.evaluation();
    system.evaluate_again(x, t, &mut at);
    let nodes: Vec<usize> = system.slot_nodes().collect();
    let dense = |slots: std::ops::Range<usize>| {
        let mut line = vec![0.0; n];
        for s in slots.filter(|&s| nodes[s] < system.free_nodes()) {
            (0..dim).for_each(|c| line[nodes[s] * dim + c] += at.gradient[s * dim + c]);
        }
        line
    };
    system.row_slots().into_iter().map(dense).collect()
}
