//! What the velocity projection can do to the energy: the matrix D of (30) and the growth bound of methods §3.

use crate::formulation::Workspace;
use crate::linalg::{inverse, relative_eigenvalues, symmetric_eigenvalues};
use crate::projection::Projection;
use crate::system::System;

/// The quadratic form ΔE_p = q̇ᵀ D q̇ of a projection at the start of a model.
#[derive(Clone, Debug, PartialEq)]
pub struct ProjectionForm {
    /// Largest and smallest eigenvalue of the symmetric part of D, kg.
    pub largest: f64,
    pub smallest: f64,
    /// Whether the projection can never add energy: no eigenvalue above round-off.
    pub dissipative: bool,
    /// Condition number κ of M⁻¹A.
    pub condition: f64,
    /// Largest factor by which one projection can raise the kinetic energy, (κ + 1)²/4κ.
    pub growth_bound: f64,
}

/// Forms D = ½ (1 + P)ᵀ M (1 − P) with P = 1 + α A⁻¹ GᵀG (28) at the start of a system. `None` when the mass matrix is
/// not positive definite. Dense: meant for up to some hundred coordinates.
pub fn projection_form(system: &System, projection: &Projection, alpha: f64, step: f64) -> Option<ProjectionForm> {
    let (n, dim, free) = (system.coordinates(), system.dimension(), system.free_nodes());
    let mut work = Workspace::new(system);
    work.x1.copy_from_slice(system.start_position());
    work.v1.copy_from_slice(system.start_velocity());
    work.sample_end(system, 0.0);
    projection.assemble(system, 0.0, step, &mut work);
    let at = |i: usize| work.kkt.coordinate(i / dim, 0, i % dim);
    let a: Vec<f64> = (0..n * n).map(|k| work.kkt.solver.entry(at(k / n), at(k % n))).collect();
    let mut m = vec![0.0; n * n];
    for node in 0..free {
        for (other, mass) in system.mass().row(node).filter(|&(other, _)| other < free) {
            (0..dim).for_each(|c| m[(node * dim + c) * n + other * dim + c] = mass);
        }
    }
    let rows = system.constraints();
    let mut g = vec![0.0; rows * n];
    for (row, slots) in work.kkt.row_slots.iter().enumerate() {
        for s in slots.clone().filter(|&s| (work.kkt.slot_nodes[s] as usize) < free) {
            let node = work.kkt.slot_nodes[s] as usize * dim;
            (0..dim).for_each(|c| g[row * n + node + c] += work.at_end.gradient[s * dim + c]);
        }
    }
    let times =
        |a: &[f64], b: &[f64]| -> Vec<f64> { (0..n * n).map(|k| (0..n).map(|l| a[k / n * n + l] * b[l * n + k % n]).sum()).collect() };
    let gram: Vec<f64> = (0..n * n).map(|k| (0..rows).map(|r| g[r * n + k / n] * g[r * n + k % n]).sum()).collect();
    // P = 1 + X, so that D = −½ (2 + X)ᵀ M X.
    let x: Vec<f64> = times(&inverse(n, &a), &gram).iter().map(|x| alpha * x).collect();
    let mx = times(&m, &x);
    let sum: Vec<f64> = (0..n * n).map(|k| x[k % n * n + k / n] + if k / n == k % n { 2.0 } else { 0.0 }).collect();
    let d: Vec<f64> = times(&sum, &mx).iter().map(|d| -0.5 * d).collect();
    let symmetric: Vec<f64> = (0..n * n).map(|k| 0.5 * (d[k] + d[k % n * n + k / n])).collect();
    let eigenvalues = symmetric_eigenvalues(n, &symmetric)?;
    let relative = relative_eigenvalues(n, &a, &m)?;
    let (smallest, largest) = (*eigenvalues.first()?, *eigenvalues.last()?);
    let condition = relative.last()? / relative.first()?;
    Some(ProjectionForm {
        largest,
        smallest,
        dissipative: largest <= 1e-12 * smallest.abs().max(f64::MIN_POSITIVE),
        condition,
        growth_bound: (condition + 1.0).powi(2) / (4.0 * condition),
    })
}
