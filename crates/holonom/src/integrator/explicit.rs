//! Explicit Runge–Kutta methods on the accelerations that a formulation gives: the classical one of order 4 and those of
//! Dormand and Prince (Hairer, Nørsett and Wanner, Solving Ordinary Differential Equations I, §II.1 and §II.5).

use super::dop853;
use super::{Integrator, Step, Work};
use crate::energy;
use crate::formulation::{Failure, RowsAt, Sampling, SolveSettings, Stage, Workspace};
use crate::system::System;

/// An explicit method: the row after the last stage is that of the end of the step.
pub(super) struct Tableau {
    nodes: &'static [f64],
    /// a_ij, a row a stage, then b.
    rows: &'static [&'static [f64]],
    /// Weights of the error estimate over the stages and the end of the step; of a second one that tempers it.
    error: &'static [f64],
    tempering: &'static [f64],
    /// Order, and that of the estimate.
    orders: Option<[u8; 2]>,
}

/// The classical method of order 4.
pub(super) const RK4: Tableau = Tableau {
    nodes: &[0.0, 0.5, 0.5, 1.0],
    rows: &[&[], &[0.5], &[0.0, 0.5], &[0.0, 0.0, 1.0], &[1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0]],
    error: &[],
    tempering: &[],
    orders: None,
};

/// Dormand and Prince 1980, order 5(4).
pub(super) const DOPRI5: Tableau = Tableau {
    nodes: &[0.0, 0.2, 0.3, 0.8, 8.0 / 9.0, 1.0],
    rows: &[
        &[],
        &[0.2],
        &[3.0 / 40.0, 9.0 / 40.0],
        &[44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0],
        &[19372.0 / 6561.0, -25360.0 / 2187.0, 64448.0 / 6561.0, -212.0 / 729.0],
        &[9017.0 / 3168.0, -355.0 / 33.0, 46732.0 / 5247.0, 49.0 / 176.0, -5103.0 / 18656.0],
        &[35.0 / 384.0, 0.0, 500.0 / 1113.0, 125.0 / 192.0, -2187.0 / 6784.0, 11.0 / 84.0],
    ],
    error: &[71.0 / 57600.0, 0.0, -71.0 / 16695.0, 71.0 / 1920.0, -17253.0 / 339_200.0, 22.0 / 525.0, -1.0 / 40.0],
    tempering: &[],
    orders: Some([5, 4]),
};

/// Dormand and Prince, order 8(5,3).
pub(super) const DOP853: Tableau =
    Tableau { nodes: dop853::C.split_at(12).0, rows: dop853::A.split_at(13).0, error: dop853::E5, tempering: dop853::E3, orders: Some([8, 7]) };

pub(super) struct Explicit {
    tableau: Tableau,
    /// v_i and a_i of the stages and the end of the step, n numbers each.
    rates: Vec<f64>,
    slopes: Vec<f64>,
}

impl Explicit {
    pub(super) fn new(system: &System, tableau: Tableau) -> Self {
        let room = vec![0.0; (tableau.nodes.len() + 1) * system.coordinates()];
        Self { tableau, rates: room.clone(), slopes: room }
    }

    /// Puts the workspace at stage `i` (or the end of the step) and keeps its velocity and acceleration. Says the power
    /// of what does work there.
    fn take(&mut self, system: &System, i: usize, t: f64, h: f64, settings: &SolveSettings, work: &mut Workspace) -> Result<f64, Failure> {
        let n = system.coordinates();
        let Workspace { x1, v1, a1, .. } = work;
        system.place_known(t, x1, v1, a1);
        for k in 0..n {
            let (mut x, mut v) = (0.0, 0.0);
            for (j, weight) in self.tableau.rows[i].iter().enumerate() {
                x += weight * self.rates[j * n + k];
                v += weight * self.slopes[j * n + k];
            }
            work.d[k] = h * x;
            work.x1[k] = work.x0[k] + work.d[k];
            work.v1[k] = work.v0[k] + h * v;
        }
        work.accelerate(system, t, settings)?;
        self.rates[i * n..(i + 1) * n].copy_from_slice(&work.v1[..n]);
        self.slopes[i * n..(i + 1) * n].copy_from_slice(&work.a1[..n]);
        match work.is_worked_on() {
            true => Ok(energy::power(system, t, &work.v1, &work.a1, work)),
            false => Ok(0.0),
        }
    }

    /// Σ e_i k_i of coordinate `k`, times h: errors of position and velocity.
    fn error(&self, weights: &[f64], n: usize, h: f64, k: usize) -> [f64; 2] {
        let sum = |values: &[f64]| weights.iter().enumerate().map(|(i, e)| e * values[i * n + k]).sum::<f64>() * h;
        [sum(&self.rates), sum(&self.slopes)]
    }

    fn estimate(&self, n: usize, h: f64, work: &mut Workspace) {
        let (mut size, mut tempering) = (0.0, 0.0);
        for k in 0..n {
            let [q, v] = self.error(self.tableau.error, n, h, k);
            (work.error_q[k], work.error_v[k]) = (q, v);
            let [q3, v3] = self.error(self.tableau.tempering, n, h, k);
            size += q * q + h * h * v * v;
            tempering += q3 * q3 + h * h * v3 * v3;
        }
        if !self.tableau.tempering.is_empty() && size > 0.0 {
            let factor = (size / (size + 0.01 * tempering)).sqrt();
            work.error_q.iter_mut().chain(&mut work.error_v).for_each(|error| *error *= factor);
        }
    }
}

impl Integrator for Explicit {
    fn step(&mut self, system: &System, start: f64, h: f64, settings: &SolveSettings, work: &mut Workspace) -> Result<Step, Failure> {
        let (n, stages) = (system.coordinates(), self.tableau.nodes.len());
        let mut done = 0.0;
        for i in 0..stages {
            let power = self.take(system, i, start + self.tableau.nodes[i] * h, h, settings, work)?;
            done += h * self.tableau.rows[stages].get(i).unwrap_or(&0.0) * power;
        }
        self.take(system, stages, start + h, h, settings, work)?;
        self.estimate(n, h, work);
        let stage = Stage { sampling: Sampling::End, rows: RowsAt::End, start, step: h, inertia: h * h, rate: 1.0 / h };
        Ok(Step { iterations: stages + 1, stage, work: Work::Sum(done), estimate: self.tableau.orders })
    }
}
