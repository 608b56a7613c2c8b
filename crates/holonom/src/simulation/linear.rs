//! The equations of motion of a mechanism that is at rest, linearised there and reduced to its freedoms.

use super::places::Places;
use super::rest::{FIRST, GOLDEN, PUSH};
use super::start::StartError;

/// How far what is left of the forces would move the mechanism while their whole would move it by its size, over that: more is no rest.
const BALANCED: f64 = 1e-9;

/// Share of a motion's size that is left of it when it follows from those before.
const FOLLOWS: f64 = 1e-6;

/// Why motions about a state are not those of small vibrations.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum NoRest {
    /// Forces do not balance there.
    Unbalanced,
    /// Something that moves has no mass.
    Massless,
    /// The matrix of a step has no inverse.
    Singular,
}

/// Independent motions q (n each) that the rows allow, with qᵀ M q = 1 each and 0 of two, and M q of each.
pub(crate) struct Motions {
    pub basis: Vec<Vec<f64>>,
    momenta: Vec<Vec<f64>>,
}

impl Places {
    /// Puts the mechanism at the start of its system, and sees that it is at rest there. Hands back how fast its motions may be, as far as forces tell,
    /// 1/s; 0 without forces.
    pub fn rest(&mut self) -> Result<f64, NoRest> {
        let x = self.system.start_position().to_vec();
        let unmet = |_: StartError| NoRest::Unbalanced;
        self.put(&x).map_err(unmet)?;
        self.begin_at_end();
        let (whole, size) = (self.pushed_at_most(), self.work.scales.length);
        let push = self.pushed().map_err(unmet)?;
        let ahead: Vec<f64> = x.iter().zip(&push).map(|(x, push)| x + push).collect();
        self.put(&ahead).map_err(unmet)?;
        self.begin_at_end();
        // How fast forces drive back what is pushed, and dampers brake what moves.
        let driven = self.pushed_at_most() / PUSH;
        let braked = self.work.resistance(&self.system, 0.0, &push);
        let braked = self.work.farthest(&self.system, &braked[..self.system.coordinates()]) / (PUSH * size);
        self.put(&x).map_err(unmet)?;
        self.begin_at_end();
        let h = (FIRST * size / whole).sqrt();
        if whole > 0.0 && self.step(h).is_none_or(|way| way > BALANCED * FIRST * size) {
            return Err(NoRest::Unbalanced);
        }
        if whole == 0.0 {
            self.work.lambda.fill(0.0);
        }
        Ok((driven.max(whole) / size).sqrt().max(braked))
    }

    /// The motions that the mechanism is free for.
    pub fn motions(&mut self) -> Result<Motions, NoRest> {
        let n = self.system.coordinates();
        let freedom = n + self.redundant_rows() - self.system.constraints();
        let mut found = Motions { basis: Vec::new(), momenta: Vec::new() };
        let lambda = self.work.lambda.clone();
        self.work.end.x.copy_from_slice(&self.work.start.x);
        self.system.evaluate_again(&self.work.end.x, 0.0, &mut self.work.end.at);
        if !self.newton.factor_inertia(&self.work) {
            return Err(NoRest::Singular);
        }
        for motion in 0..freedom {
            let push: Vec<f64> = (motion * n..(motion + 1) * n).map(scattered).collect();
            let momentum = self.momentum(&push);
            let mut q = self.newton.solve_along_rows(&momentum);
            let mut left = 0.0;
            // What rounding leaves of the others after once is gone after twice.
            for _ in 0..2 {
                let whole = dot(&q, &self.momentum(&q));
                for (other, momentum) in found.basis.iter().zip(&found.momenta) {
                    let share = dot(&q, momentum);
                    q.iter_mut().zip(other).for_each(|(q, other)| *q -= share * other);
                }
                let own = dot(&q, &self.momentum(&q));
                if own.is_nan() || own <= FOLLOWS * FOLLOWS * whole {
                    return Err(NoRest::Massless);
                }
                left = own.sqrt();
            }
            q.iter_mut().for_each(|q| *q /= left);
            found.momenta.push(self.momentum(&q));
            found.basis.push(q);
        }
        self.work.lambda = lambda;
        Ok(found)
    }

    /// M q of the free coordinates.
    fn momentum(&self, q: &[f64]) -> Vec<f64> {
        let mut all = q.to_vec();
        all.resize(self.work.end.x.len(), 0.0);
        let mut out = vec![0.0; q.len()];
        self.system.mass.times(self.system.dim, &all, &mut out);
        out
    }

    /// What a step of implicit Euler of length h makes of the shares of the motions in positions, and in velocities times h (2f × 2f, row-major).
    pub fn propagator(&mut self, motions: &Motions, h: f64) -> Result<Vec<f64>, NoRest> {
        let f = motions.basis.len();
        let lambda = self.work.lambda.clone();
        let stage = self.start_step(h);
        self.work.lambda.copy_from_slice(&lambda);
        self.newton.factor_there(&self.system, &stage, &mut self.work).map_err(|_| NoRest::Singular)?;
        let mut out = vec![0.0; 4 * f * f];
        for (j, (motion, momentum)) in motions.basis.iter().zip(&motions.momenta).enumerate() {
            let mut v = motion.clone();
            v.resize(self.work.end.x.len(), 0.0);
            let resisted = self.work.resistance(&self.system, stage.time(), &v);
            let of_position: Vec<f64> = momentum.iter().zip(&resisted).map(|(momentum, force)| momentum + h * force).collect();
            for (column, right) in [(j, &of_position), (f + j, momentum)] {
                let q = self.newton.solve_along_rows(right);
                for (i, momentum) in motions.momenta.iter().enumerate() {
                    let share = dot(&q, momentum);
                    out[i * 2 * f + column] = share;
                    // The velocity is the way over the step.
                    out[(f + i) * 2 * f + column] = share - f64::from(u8::from(i == column));
                }
            }
        }
        Ok(out)
    }
}

/// Numbers between −½ and ½ without order: fractional parts of squares times an irrational number.
fn scattered(k: usize) -> f64 {
    ((k * k) as f64 * GOLDEN).fract() - 0.5
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
