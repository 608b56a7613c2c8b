//! Explicit Runge–Kutta methods on the accelerations that a formulation gives: the classical one of order 4 and those of
//! Dormand and Prince (Hairer, Nørsett and Wanner 1993, §II.1 and §II.5).

use super::dop853;
use super::{Integrator, Step, Work};
use crate::energy;
use crate::formulation::{Failure, Newton, RowsAt, Sampling, Stage, Workspace};
use crate::system::{Look, System};

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
    dense: Dense,
}

/// The polynomial through a step.
enum Dense {
    None,
    /// Coefficients of θ, θ² … of the weights of the stages and the end of the step.
    Weights(&'static [[f64; 4]]),
    /// Further stages, and the weights of all of them beyond the cubic through both ends.
    Stages {
        nodes: &'static [f64],
        rows: &'static [&'static [f64]],
        weights: &'static [&'static [f64]],
    },
}

impl Tableau {
    /// Its nodes with their weights.
    pub(super) fn looks(&self) -> Vec<[f64; 2]> {
        self.nodes.iter().zip(self.rows[self.nodes.len()]).map(|(node, weight)| [*node, *weight]).collect()
    }
}

/// The classical method of order 4.
pub(super) const RK4: Tableau = Tableau {
    nodes: &[0.0, 0.5, 0.5, 1.0],
    rows: &[&[], &[0.5], &[0.0, 0.5], &[0.0, 0.0, 1.0], &[1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0]],
    error: &[],
    tempering: &[],
    orders: None,
    dense: Dense::None,
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
    dense: Dense::Weights(DOPRI5_WEIGHTS),
};

/// Dense output of order 4 of the same (Shampine 1986).
const DOPRI5_WEIGHTS: &[[f64; 4]] = &[
    [1.0, -8_048_581_381.0 / 2_820_520_608.0, 8_663_915_743.0 / 2_820_520_608.0, -12_715_105_075.0 / 11_282_082_432.0],
    [0.0; 4],
    [0.0, 131_558_114_200.0 / 32_700_410_799.0, -68_118_460_800.0 / 10_900_136_933.0, 87_487_479_700.0 / 32_700_410_799.0],
    [0.0, -1_754_552_775.0 / 470_086_768.0, 14_199_869_525.0 / 1_410_260_304.0, -10_690_763_975.0 / 1_880_347_072.0],
    [0.0, 127_303_824_393.0 / 49_829_197_408.0, -318_862_633_887.0 / 49_829_197_408.0, 701_980_252_875.0 / 199_316_789_632.0],
    [0.0, -282_668_133.0 / 205_662_961.0, 2_019_193_451.0 / 616_988_883.0, -1_453_857_185.0 / 822_651_844.0],
    [0.0, 40_617_522.0 / 29_380_423.0, -110_615_467.0 / 29_380_423.0, 69_997_945.0 / 29_380_423.0],
];

/// Dormand and Prince, order 8(5,3).
pub(super) const DOP853: Tableau = Tableau {
    nodes: dop853::C.split_at(12).0,
    rows: dop853::A.split_at(13).0,
    error: dop853::E5,
    tempering: dop853::E3,
    orders: Some([8, 7]),
    dense: Dense::Stages { nodes: dop853::C.split_at(13).1, rows: dop853::A.split_at(13).1, weights: dop853::D },
};

pub(super) struct Explicit {
    tableau: Tableau,
    /// v_i and a_i of the stages and the end of the step, n numbers each.
    rates: Vec<f64>,
    slopes: Vec<f64>,
    /// The power of what does work there, W, each time followed by that of each worker.
    powers: Vec<f64>,
    /// Whether the further stages of the dense output are those of the last step.
    extended: bool,
    /// Multipliers at the start (r).
    lambda: Vec<f64>,
}

impl Explicit {
    pub(super) fn new(system: &System, tableau: Tableau) -> Self {
        let further = if let Dense::Stages { nodes, .. } = tableau.dense { nodes.len() } else { 0 };
        let stages = tableau.nodes.len() + 1 + further;
        let room = vec![0.0; stages * system.coordinates()];
        Self {
            tableau,
            rates: room.clone(),
            slopes: room,
            powers: vec![0.0; stages * (1 + system.workers().count())],
            extended: false,
            lambda: vec![0.0; system.constraints()],
        }
    }

    /// Puts the workspace at stage `i` (the one after the last is the end of the step), with the weights `row` of the
    /// stages before, and keeps its velocity, acceleration and power.
    fn take(
        &mut self,
        system: &System,
        (i, row): (usize, &[f64]),
        t: f64,
        h: f64,
        newton: &mut Newton,
        work: &mut Workspace,
    ) -> Result<(), Failure> {
        let n = system.coordinates();
        let Workspace { end, a, .. } = work;
        system.place_known(t, &mut end.x, &mut end.v, a);
        for k in 0..n {
            let (mut x, mut v) = (0.0, 0.0);
            for (j, weight) in row.iter().enumerate() {
                x += weight * self.rates[j * n + k];
                v += weight * self.slopes[j * n + k];
            }
            work.d[k] = h * x;
            work.end.x[k] = work.start.x[k] + work.d[k];
            work.end.v[k] = work.start.v[k] + h * v;
        }
        newton.accelerate(system, t, work)?;
        self.rates[i * n..(i + 1) * n].copy_from_slice(&work.end.v[..n]);
        self.slopes[i * n..(i + 1) * n].copy_from_slice(&work.a[..n]);
        let each = 1 + work.shares.len();
        if let [all, shares @ ..] = &mut self.powers[i * each..(i + 1) * each] {
            *all = if work.is_worked_on() { energy::power_with(system, t, &work.end.v, &work.a, work, shares) } else { 0.0 };
        }
        Ok(())
    }

    /// Σ e_i k_i of coordinate `k`, times h: errors of position and velocity.
    fn error(&self, weights: &[f64], n: usize, h: f64, k: usize) -> [f64; 2] {
        let sum = |values: &[f64]| weights.iter().enumerate().map(|(i, e)| e * values[i * n + k]).sum::<f64>() * h;
        [sum(&self.rates), sum(&self.slopes)]
    }

    /// The integral from the start to the share `x` of the step of what the stages hold of number `k` of `n`, over the step.
    fn through(&self, values: &[f64], n: usize, k: usize, x: f64) -> f64 {
        let at = |i: usize| values[i * n + k];
        match self.tableau.dense {
            Dense::None => unreachable!("the table promises no dense output"),
            Dense::Weights(weights) => {
                let weight = |[a, b, c, d]: [f64; 4]| x * (a + x * (b + x * (c + x * d)));
                weights.iter().enumerate().map(|(i, row)| weight(*row) * at(i)).sum()
            }
            Dense::Stages { weights, .. } => {
                let end = self.tableau.nodes.len();
                let whole: f64 = self.tableau.rows[end].iter().enumerate().map(|(i, weight)| weight * at(i)).sum();
                let further = weights.iter().map(|row| row.iter().enumerate().map(|(i, weight)| weight * at(i)).sum());
                let cubic = [whole, at(0) - whole, 2.0 * whole - at(end) - at(0)];
                let coefficients = cubic.into_iter().chain(further);
                // x (c_0 + (1 − x) (c_1 + x (c_2 + (1 − x) (c_3 + …
                let mut factor = x;
                let term = |(i, coefficient): (usize, f64)| {
                    let term = factor * coefficient;
                    factor *= if i % 2 == 0 { 1.0 - x } else { x };
                    term
                };
                coefficients.enumerate().map(term).sum()
            }
        }
    }

    fn estimate(&self, n: usize, h: f64, work: &mut Workspace) {
        let (mut size, mut tempering) = (0.0, 0.0);
        for k in 0..n {
            let [q, v] = self.error(self.tableau.error, n, h, k);
            (work.estimate.q[k], work.estimate.v[k]) = (q, v);
            let [q3, v3] = self.error(self.tableau.tempering, n, h, k);
            size += q * q + h * h * v * v;
            tempering += q3 * q3 + h * h * v3 * v3;
        }
        if !self.tableau.tempering.is_empty() && size > 0.0 {
            let factor = (size / (size + 0.01 * tempering)).sqrt();
            work.estimate.q.iter_mut().chain(&mut work.estimate.v).for_each(|error| *error *= factor);
        }
    }
}

impl Integrator for Explicit {
    fn has_one_stage(&self) -> bool {
        false
    }

    fn carry(&self, carried: &mut Vec<f64>) {
        carried.push(f64::from(u8::from(self.extended)));
    }

    fn carry_on(&mut self, carried: &[f64]) {
        self.extended = carried == [1.0];
    }

    fn step(&mut self, system: &System, start: f64, h: f64, newton: &mut Newton, work: &mut Workspace) -> Result<Step, Failure> {
        let (n, stages) = (system.coordinates(), self.tableau.nodes.len());
        work.estimate.stages.clear();
        let is_looked_at = work.estimate.allowed > 0.0 && system.has_bends();
        for i in 0..stages {
            let t = start + self.tableau.nodes[i] * h;
            self.take(system, (i, self.tableau.rows[i]), t, h, newton, work)?;
            if is_looked_at && i > 0 {
                let Workspace { end, inputs, .. } = &*work;
                let look = Look { x: &end.x, v: &end.v, t, at: &end.at, inputs, span: None };
                work.estimate.stages.push(system.see(look));
            }
        }
        let each = 1 + work.shares.len();
        let weights = self.tableau.rows[stages];
        let done = |k: usize| weights.iter().enumerate().map(|(i, weight)| h * weight * self.powers[i * each + k]).sum();
        work.shares.iter_mut().enumerate().for_each(|(k, share)| *share = done(1 + k));
        let done = done(0);
        self.take(system, (stages, self.tableau.rows[stages]), start + h, h, newton, work)?;
        self.extended = false;
        newton.iterations += stages as u64 + 1;
        self.estimate(n, h, work);
        let stage = Stage { sampling: Sampling::End, rows: RowsAt::End, start, step: h, inertia: h * h, rate: 1.0 / h };
        Ok(Step { stage, work: Work::Sum(done), estimate: self.tableau.orders })
    }

    fn interpolate(
        &mut self,
        system: &System,
        start: f64,
        h: f64,
        share: f64,
        newton: &mut Newton,
        work: &mut Workspace,
    ) -> Result<f64, Failure> {
        let n = system.coordinates();
        if let Dense::Stages { nodes, rows, .. } = self.tableau.dense
            && !self.extended
        {
            // Multipliers are found from those at the start, the first time and later.
            self.lambda.copy_from_slice(&work.lambda);
            for (k, (node, row)) in nodes.iter().zip(rows).enumerate() {
                self.take(system, (self.tableau.rows.len() + k, row), start + node * h, h, newton, work)?;
            }
            self.extended = true;
            work.lambda.copy_from_slice(&self.lambda);
        }
        let Workspace { end, a, .. } = work;
        system.place_known(start + share * h, &mut end.x, &mut end.v, a);
        for k in 0..n {
            work.d[k] = h * self.through(&self.rates, n, k, share);
            work.end.x[k] = work.start.x[k] + work.d[k];
            work.end.v[k] = work.start.v[k] + h * self.through(&self.slopes, n, k, share);
        }
        newton.accelerate(system, start + share * h, work)?;
        let each = 1 + work.shares.len();
        let done = |k: usize| h * self.through(&self.powers, each, k, share);
        work.shares.iter_mut().enumerate().for_each(|(k, share)| *share = done(1 + k));
        Ok(done(0))
    }
}
