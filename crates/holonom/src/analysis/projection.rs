//! What the velocity projection can do to the energy: the matrix D of (30) and the growth bound of methods §18.

use crate::formulation::{ALL, Kkt, Workspace};
use crate::linalg::{inverse, relative_eigenvalues};
use crate::projection::Projection;
use crate::system::System;

/// The quadratic form ΔE_p = q̇ᵀ D q̇ of a projection at the start of a model.
#[derive(Clone, Debug, PartialEq)]
pub struct ProjectionForm {
    /// Largest factor by which the projection raises the kinetic energy of any velocity at this state.
    pub growth: f64,
    /// Whether D is negative semidefinite: no velocity gains energy.
    pub dissipative: bool,
    /// Condition number κ of M⁻¹A.
    pub condition: f64,
    /// Bound on that factor at any state, (κ + 1)²/4κ.
    pub growth_bound: f64,
}

/// Growth above one that counts as round-off: a penalty of 1e7 leaves nine digits of the inverse of P.
const ROUND_OFF: f64 = 1e-7;

/// Examines D = ½ (1 + P)ᵀ M (1 − P) with P = 1 + α A⁻¹ GᵀG (28) at the start of a system. `None` when the mass matrix is
/// not positive definite. Dense: meant for up to some hundred coordinates.
pub fn projection_form(system: &System, projection: &Projection, alpha: f64, step: f64) -> Option<ProjectionForm> {
    let (n, dim, free) = (system.coordinates(), system.dimension(), system.free_nodes());
    let mut work = Workspace::new(system);
    work.end.x.copy_from_slice(system.start_position());
    work.end.v.copy_from_slice(system.start_velocity());
    work.sample_end(system, 0.0);
    let mut kkt = Kkt::new(system, &work.scales, 1, ALL);
    projection.assemble(system, 0.0, step, &mut kkt, &mut work);
    let at = |i: usize| kkt.coordinate(i / dim, 0, i % dim);
    let a: Vec<f64> = (0..n * n).map(|k| kkt.solver.entry(at(k / n), at(k % n))).collect();
    let mut m = vec![0.0; n * n];
    for node in 0..free {
        for (other, mass) in system.mass().row(node).filter(|&(other, _)| other < free) {
            (0..dim).for_each(|c| m[(node * dim + c) * n + other * dim + c] = mass.m);
            if mass.s != 0.0 {
                m[node * dim * n + other * dim + 1] = -mass.s;
                m[(node * dim + 1) * n + other * dim] = mass.s;
            }
        }
    }
    let rows = system.constraints();
    let mut g = vec![0.0; rows * n];
    for (row, slots) in system.slots.rows.iter().enumerate() {
        for s in slots.clone().filter(|&s| (system.slots.nodes[s] as usize) < free) {
            let node = system.slots.nodes[s] as usize * dim;
            (0..dim).for_each(|c| g[row * n + node + c] += work.end.at.gradient[s * dim + c]);
        }
    }
    let times =
        |a: &[f64], b: &[f64]| -> Vec<f64> { (0..n * n).map(|k| (0..n).map(|l| a[k / n * n + l] * b[l * n + k % n]).sum()).collect() };
    let gram: Vec<f64> = (0..n * n).map(|k| (0..rows).map(|r| g[r * n + k / n] * g[r * n + k % n]).sum()).collect();
    // P = 1 + α A⁻¹ GᵀG (28). D is indefinite exactly when some incoming velocity leaves with more energy, and seen from
    // there the form is bounded whatever α is.
    let mut p: Vec<f64> = times(&inverse(n, &a), &gram).iter().map(|x| alpha * x).collect();
    (0..n).for_each(|i| p[i * n + i] += 1.0);
    let back = inverse(n, &p);
    let transposed: Vec<f64> = (0..n * n).map(|k| back[k % n * n + k / n]).collect();
    let left = times(&transposed, &times(&m, &back));
    let symmetric: Vec<f64> = (0..n * n).map(|k| 0.5 * (left[k] + left[k % n * n + k / n])).collect();
    let growth = *relative_eigenvalues(n, &symmetric, &m)?.last()?;
    let relative = relative_eigenvalues(n, &a, &m)?;
    let condition = relative.last()? / relative.first()?;
    Some(ProjectionForm {
        growth,
        dissipative: growth <= 1.0 + ROUND_OFF,
        condition,
        growth_bound: (condition + 1.0).powi(2) / (4.0 * condition),
    })
}
