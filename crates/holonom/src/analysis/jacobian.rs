//! The gradients of the rows as a dense matrix, for those who want to judge it by other means.

use crate::system::System;

/// Gradients of the rows by the coordinates (r lists of n) at the positions `x` of all nodes and time `t`, in the units of
/// the rows over m.
pub fn constraint_jacobian(system: &System, x: &[f64], t: f64) -> Vec<Vec<f64>> {
    let (n, dim) = (system.coordinates(), system.dimension());
    let mut at = system.evaluation();
    system.evaluate_again(x, t, &mut at);
    let dense = |slots: &std::ops::Range<usize>| {
        let mut line = vec![0.0; n];
        for s in slots.clone() {
            let node = system.slots.nodes[s] as usize;
            (0..dim).filter(|_| node < system.free_nodes()).for_each(|c| line[node * dim + c] += at.gradient[s * dim + c]);
        }
        line
    };
    system.slots.rows.iter().map(dense).collect()
}
