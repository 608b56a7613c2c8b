//! Implicit Runge–Kutta methods by collocation: Radau IIA with 1, 2, 3 stages and Gauss with 1, 2, 3 stages (Hairer and
//! Wanner 1996, §IV.5).

use super::{Integrator, Step, Work};
use crate::energy;
use crate::formulation::{Collocation, Failure, Newton, RowsAt, Sampling, SolveSettings, Stage, Timing, Workspace};
use crate::system::System;

/// Nodes c, weights b, and B = A⁻¹ of a collocation method.
pub(super) struct Tableau {
    nodes: Vec<f64>,
    weights: Vec<f64>,
    inverse: Vec<f64>,
    /// Weights of the stages' increments in the embedded method of order s, for the error estimate: with
    /// `slope` h ẏ_0 − Σ e_i z_i the estimated error (Hairer and Wanner 1996, §IV.8).
    error: Option<(f64, Vec<f64>)>,
}

impl Tableau {
    /// Radau IIA of order 1, 3 or 5: the last node is the end of the step.
    pub(super) fn radau(order: u8) -> Self {
        let r6 = 6f64.sqrt();
        let nodes = match order {
            1 => vec![1.0],
            3 => vec![1.0 / 3.0, 1.0],
            _ => vec![(4.0 - r6) / 10.0, (4.0 + r6) / 10.0, 1.0],
        };
        let mut tableau = Self::through(nodes);
        tableau.error = Some(tableau.embedded());
        tableau
    }

    /// Gauss of order 2, 4 or 6.
    pub(super) fn gauss(order: u8) -> Self {
        let (r3, r15) = (3f64.sqrt() / 6.0, 15f64.sqrt() / 10.0);
        Self::through(match order {
            2 => vec![0.5],
            4 => vec![0.5 - r3, 0.5 + r3],
            _ => vec![0.5 - r15, 0.5, 0.5 + r15],
        })
    }

    /// Collocation with the given nodes: a_ij and b_j are integrals of Lagrange's polynomials.
    fn through(nodes: Vec<f64>) -> Self {
        let s = nodes.len();
        let mut matrix = vec![0.0; s * s];
        let mut weights = vec![0.0; s];
        for j in 0..s {
            let polynomial = lagrange(&nodes, j);
            for i in 0..s {
                matrix[i * s + j] = integral(&polynomial, nodes[i]);
            }
            weights[j] = integral(&polynomial, 1.0);
        }
        let inverse = crate::linalg::inverse(s, &matrix);
        Self { nodes, weights, inverse, error: None }
    }

    /// The embedded method: a quadrature with the nodes 0, c_1 … c_s that is exact for polynomials of degree s − 1 and
    /// gives the start the weight γ_0, the inverse of the real eigenvalue of A⁻¹; its difference from the method in
    /// terms of the stages' increments.
    fn embedded(&self) -> (f64, Vec<f64>) {
        let s = self.nodes.len();
        let slope = match s {
            1 => 0.5,
            2 => 0.25,
            _ => 1.0 / 3.637_834_252_744_496,
        };
        // Σ_i w_i c_i^(k) = γ_0 0^k for k = 0 … s−1: the weights that undo the start's, in terms of slopes.
        let mut powers = vec![0.0; s * s];
        for k in 0..s {
            for i in 0..s {
                powers[k * s + i] = self.nodes[i].powi(k as i32);
            }
        }
        let solved = crate::linalg::inverse(s, &powers);
        let slopes: Vec<f64> = (0..s).map(|i| solved[i * s] * slope).collect();
        // Slopes are h ẏ_i = Σ B_ij z_j.
        let error = (0..s).map(|j| (0..s).map(|i| slopes[i] * self.inverse[i * s + j]).sum()).collect();
        (slope, error)
    }

    /// Its nodes with their weights.
    pub(super) fn looks(&self) -> Vec<[f64; 2]> {
        self.nodes.iter().zip(&self.weights).map(|(node, weight)| [*node, *weight]).collect()
    }

    fn stages(&self) -> usize {
        self.nodes.len()
    }

    /// Whether the last stage is the end of the step.
    fn ends_at_stage(&self) -> bool {
        self.nodes.last() == Some(&1.0)
    }
}

/// Coefficients, lowest first, of the polynomial that is one at node `j` and zero at the others.
fn lagrange(nodes: &[f64], j: usize) -> Vec<f64> {
    let mut polynomial = vec![1.0];
    for (_, &node) in nodes.iter().enumerate().filter(|&(k, _)| k != j) {
        let scale = 1.0 / (nodes[j] - node);
        let mut next = vec![0.0; polynomial.len() + 1];
        for (power, &coefficient) in polynomial.iter().enumerate() {
            next[power] -= coefficient * node * scale;
            next[power + 1] += coefficient * scale;
        }
        polynomial = next;
    }
    polynomial
}

fn integral(polynomial: &[f64], to: f64) -> f64 {
    polynomial.iter().enumerate().map(|(power, coefficient)| coefficient * to.powi(power as i32 + 1) / (power + 1) as f64).sum()
}

pub(super) struct RungeKutta {
    tableau: Tableau,
    stages: Collocation,
    /// Weights bᵀA⁻¹ of the stages in the end of the step, and of λ extrapolated there.
    end: Vec<f64>,
    extrapolated: Vec<f64>,
    /// Accelerations at the start (n).
    slopes: Vec<f64>,
}

impl RungeKutta {
    pub(super) fn new(system: &System, settings: &SolveSettings, tableau: Tableau) -> Self {
        let s = tableau.stages();
        let mut stages = Collocation::new(system, s, settings);
        stages.set_rate(tableau.inverse.iter().copied());
        let end = (0..s).map(|j| (0..s).map(|i| tableau.weights[i] * tableau.inverse[i * s + j]).sum()).collect();
        let at_end = |j| lagrange(&tableau.nodes, j).iter().sum();
        let extrapolated = (0..s).map(at_end).collect();
        Self { stages, end, extrapolated, slopes: vec![0.0; system.coordinates()], tableau }
    }

    /// Increments from the Taylor polynomial of the start.
    fn predict(&mut self, system: &System, h: f64, work: &Workspace) {
        let (s, n) = (self.tableau.stages(), system.coordinates());
        for i in 0..s {
            let c = self.tableau.nodes[i];
            let row: f64 = self.tableau.inverse[i * s..(i + 1) * s].iter().sum();
            for k in 0..n {
                let (v, a, change) = (work.start.v[k], work.a[k], work.prediction.a_change[k]);
                let at = i * n + k;
                self.stages.d[at] = c * h * (v + c * h * (0.5 * a + c * change / 6.0));
                self.stages.u[at] = h * (v + c * h * (a + 0.5 * c * change));
                self.stages.p[at] = 0.0;
                self.stages.r[at] = -row * h * v;
            }
        }
    }

    /// Estimated errors of the step, from slopes at the start and the increments of the stages.
    fn estimate(&self, h: f64, work: &mut Workspace) {
        let Some((slope, weights)) = &self.tableau.error else { return };
        let n = self.slopes.len();
        for k in 0..n {
            let (mut q, mut v) = (slope * h * work.start.v[k], slope * h * self.slopes[k]);
            for (i, weight) in weights.iter().enumerate() {
                q -= weight * self.stages.d[i * n + k];
                v -= weight * (self.stages.u[i * n + k] / h - work.start.v[k]);
            }
            work.estimate.q[k] = q;
            work.estimate.v[k] = v;
        }
    }
}

impl Integrator for RungeKutta {
    fn has_one_stage(&self) -> bool {
        false
    }

    fn carry(&self, carried: &mut Vec<f64>) {
        self.stages.carry(carried);
    }

    fn carry_on(&mut self, carried: &[f64]) {
        self.stages.carry_on(carried);
    }

    fn step(&mut self, system: &System, start: f64, h: f64, newton: &mut Newton, work: &mut Workspace) -> Result<Step, Failure> {
        let (s, n, r) = (self.tableau.stages(), system.coordinates(), system.constraints());
        self.predict(system, h, work);
        self.slopes.copy_from_slice(&work.a[..n]);
        let timing = Timing { start, step: h, nodes: &self.tableau.nodes };
        self.stages.solve(system, timing, newton, work)?;
        let mut done = 0.0;
        if work.is_worked_on() {
            for i in 0..s {
                let t = self.stages.place(system, timing, i, work);
                work.sample(system, t);
                let time = h * self.tableau.weights[i];
                done += time * energy::power(system, t, |work| &work.sampled, work);
                work.book_powers(time);
            }
        }
        let Workspace { end, a, .. } = work;
        system.place_known(start + h, &mut end.x, &mut end.v, a);
        for k in 0..n {
            let v0 = work.start.v[k];
            let (mut d, mut v, mut a) = (0.0, v0, 0.0);
            for i in 0..s {
                d += self.end[i] * self.stages.d[i * n + k];
                v += self.end[i] * (self.stages.u[i * n + k] / h - v0);
                a += self.extrapolated[i] * self.stages.a[i * n + k] / (h * h);
            }
            let last = (s - 1) * n + k;
            (work.d[k], work.end.v[k]) = if self.tableau.ends_at_stage() { (self.stages.d[last], self.stages.u[last] / h) } else { (d, v) };
            work.a[k] = a;
        }
        for k in 0..r {
            work.lambda[k] = (0..s).map(|i| self.extrapolated[i] * self.stages.lambda[i * r + k] / (h * h)).sum();
        }
        self.estimate(h, work);
        let stage = Stage { sampling: Sampling::End, rows: RowsAt::End, start, step: h, inertia: h * h, rate: 1.0 / h };
        Ok(Step { stage, work: Work::Sum(done), estimate: self.tableau.error.as_ref().map(|_| [2 * s as u8 - 1, s as u8]) })
    }
}
