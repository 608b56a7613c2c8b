//! The equations of motion of a mechanism that is at rest, linearised there and reduced to its freedoms.

use super::conflict::unmet;
use super::golden::GOLDEN;
use super::places::Places;
use super::rest::{FIRST, PUSH};
use crate::energy;
use crate::formulation::Workspace;
use crate::linalg::{eigenpairs, largest};
use crate::system::Look;

/// Lengths of the step that forces at rest are found by, over that which is tried first.
const TRIES: [f64; 5] = [1.0, 0.1, 10.0, 0.01, 100.0];

/// Share of the forces that may be left at rest.
const BALANCED: f64 = 1e-6;

/// A long step over the time of the fastest motion.
const LONG: f64 = 1e4;

/// By what share of a move forces drive it on in a long step that is no rounding.
const DRIVEN: f64 = 1e-5;

/// How far the places are beside it and each other, over the mechanism's size; how many times that the way back to rest may be; and by how much rounding
/// may have them off.
const BESIDE: f64 = 1e-13;
const BACK: f64 = 10.0;
const ROUNDED: f64 = 4.0 * f64::EPSILON;

/// Share of a motion's size that is left of it when it follows from those before.
const FOLLOWS: f64 = 1e-6;

/// Share of what a motion would bend rows by, were all of the mechanism as fast as its fastest node, that is left at a singular position. Elsewhere hardly
/// any rounding is.
const FORKS: f64 = 1e-8;

/// The golden ratio in 64 bits.
const MIXING: u64 = 0x9e37_79b9_7f4a_7c15;

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

/// A mechanism at rest.
pub(crate) struct Rest {
    /// How fast its motions may be, as far as forces tell, 1/s; 0 without forces.
    pub speed: f64,
    /// The same without dampers.
    driven: f64,
    /// Two places a little beside that at rest, where other numbers are rounded.
    pub spots: Vec<Spot>,
}

impl Rest {
    /// A step that is long for all motions but very slow ones, s.
    pub fn long_step(&self) -> f64 {
        LONG / self.speed
    }

    /// A longer one where dampers are stronger than other forces: what these drive on is slow then.
    fn longer_step(&self) -> f64 {
        LONG / self.driven.max(self.speed / LONG)
    }
}

/// A place (full), with the multipliers that balance the forces there.
pub(crate) struct Spot {
    x: Vec<f64>,
    lambda: Vec<f64>,
}

/// Independent motions q (n each) that the rows allow, with qᵀ M q = 1 each and 0 of two, and M q of each.
pub(crate) struct Motions {
    pub basis: Vec<Vec<f64>>,
    momenta: Vec<Vec<f64>>,
}

impl Places {
    /// Puts the mechanism at a place, and sees that it is at rest there.
    pub fn rest(&mut self, x: Vec<f64>) -> Result<Rest, NoRest> {
        self.put(&x).map_err(|_| NoRest::Unbalanced)?;
        // Which rows are redundant is known from here.
        if !self.newton.factor_inertia(&self.work) {
            return Err(NoRest::Singular);
        }
        let (here, left) = self.balance(x)?;
        if left.is_nan() || left > BALANCED {
            return Err(NoRest::Unbalanced);
        }
        let (whole, size) = (self.pushed_at_most(), self.work.scales.length);
        let push = self.pushed().map_err(|_| NoRest::Unbalanced)?;
        let beside = |by: f64| here.x.iter().zip(&push).map(|(x, push)| x + by * push).collect::<Vec<f64>>();
        // How fast forces drive back what is pushed, and dampers brake what moves.
        let driven = match self.put(&beside(1.0)) {
            Ok(()) => {
                self.begin_at_end();
                self.pushed_at_most() / PUSH
            }
            Err(_) => 0.0,
        };
        let braked = self.work.resistance(&self.system, 0.0, &push);
        let braked = self.work.farthest(&self.system, &braked[..self.system.coordinates()]) / (PUSH * size);
        let driven = (driven.max(whole) / size).sqrt();
        let mut rest = Rest { speed: driven.max(braked), driven, spots: Vec::new() };
        let places = [1.0, 2.0].map(|times| beside(times * BESIDE / PUSH));
        let rounding: Vec<f64> = push.iter().map(|push| ROUNDED / PUSH * push).collect();
        for x in self.eased(&places, &rounding, rest.long_step()).unwrap_or(places) {
            rest.spots.push(self.balance(x)?.0);
        }
        self.put(&here.x).map_err(|_| NoRest::Unbalanced)?;
        Ok(rest)
    }

    /// Where what is stiff has come to rest again beside places: what little it is stretched there may be more than what it bears. The second place is off by
    /// what rounding may be. `None` where that leads farther away, or to the other side of a kink that the mechanism is at.
    fn eased(&mut self, places: &[Vec<f64>; 2], rounding: &[f64], h: f64) -> Option<[Vec<f64>; 2]> {
        let farthest = BACK * BESIDE * self.work.scales.length;
        let mut ease = |x: &Vec<f64>, times: f64| {
            self.put(x).ok()?;
            let sides = self.sides();
            self.begin_at_end();
            let way = self.step(h)?;
            let x: Vec<f64> = self.work.end.x.iter().zip(rounding).map(|(x, rounding)| x + times * rounding).collect();
            self.put(&x).ok()?;
            (way <= farthest && self.sides() == sides).then_some(x)
        };
        Some([ease(&places[0], 0.0)?, ease(&places[1], 1.0)?])
    }

    /// On which sides of their corners forces are, where the mechanism is.
    fn sides(&self) -> Vec<[bool; 2]> {
        let Workspace { end, inputs, .. } = &self.work;
        let seen = self.system.see(Look { x: &end.x, v: &vec![0.0; end.v.len()], t: 0.0, at: &end.at, inputs, span: None });
        self.system.bends(&seen).corners.iter().map(|corner| [*corner > 0.0, *corner < 0.0]).collect()
    }

    /// The multipliers that balance all forces at a place, as far as they do, and what share of the forces is left.
    fn balance(&mut self, x: Vec<f64>) -> Result<(Spot, f64), NoRest> {
        self.put(&x).map_err(|_| NoRest::Unbalanced)?;
        self.begin_at_end();
        let (whole, size) = (self.pushed_at_most(), self.work.scales.length);
        if whole == 0.0 {
            return Ok((Spot { x, lambda: self.work.lambda.clone() }, 0.0));
        }
        let first = (FIRST * size / whole).sqrt();
        let way = TRIES.iter().find_map(|by| Some((by * first, self.step(by * first)?)));
        let (h, way) = way.ok_or(NoRest::Singular)?;
        Ok((Spot { x, lambda: self.work.lambda.clone() }, way / (h * h * whole)))
    }

    /// The motions that the mechanism is free for, where it was put last.
    pub fn motions(&mut self) -> Result<Motions, NoRest> {
        let (n, freedom) = (self.system.coordinates(), self.freedom());
        let mut found = Motions { basis: Vec::new(), momenta: Vec::new() };
        if !self.newton.factor_inertia(&self.work) {
            return Err(NoRest::Singular);
        }
        for motion in 0..freedom {
            // As large as nodes are heavy: what light ones do is then no rounding of the others.
            let weight = |k: usize| self.system.mass.diagonal(k / self.system.dim).sqrt();
            let momentum: Vec<f64> = (0..n).map(|k| weight(k) * scattered(motion * n + k)).collect();
            let mut q = self.newton.solve_along_rows(&momentum).ok_or(NoRest::Singular)?;
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
        Ok(found)
    }

    /// Whether a motion that all rows allow is none as soon as it goes on: there is no acceleration with which all rows would go along. So it is at singular
    /// positions, as where bars lie in a line, and there alone, whatever rows follow from others. The motions are those at the place.
    pub fn forks(&mut self, motions: &Motions) -> bool {
        let Self { system, newton, work, .. } = self;
        let mut bent = vec![0.0; system.constraints()];
        motions.basis.iter().any(|motion| {
            let mut v = motion.clone();
            v.resize(work.end.x.len(), 0.0);
            system.constraint_curvatures(&work.end.at, &work.end.x, &v, 0.0, &mut work.turned.half, &mut bent);
            // Drives stand still.
            bent.iter_mut().zip(&system.rows).for_each(|(bent, row)| *bent += row.target(0.0)[2]);
            let whole = largest(&v).powi(2) / work.scales.length;
            let left = unmet(system, newton, work, &bent);
            left.iter().zip(&work.scales.gradient).any(|(left, gradient)| left.abs() > FORKS * gradient * whole)
        })
    }

    /// A small move along which forces drive a mechanism at rest on, where it was put last, if there is one.
    ///
    /// # Errors
    /// When its motions cannot be told.
    pub fn falls(&mut self) -> Result<Option<Vec<f64>>, NoRest> {
        let rest = self.rest(self.work.end.x.clone())?;
        let motions = self.motions()?;
        let freedom = motions.basis.len();
        if rest.speed == 0.0 || freedom == 0 {
            return Ok(None);
        }
        // A long step leaves a share of each move, (I + h C + h² K)⁻¹ (I + h C): less than all of it, but of what forces drive on.
        let whole = self.propagator(&motions, &rest.spots[0], rest.longer_step())?;
        let of_position: Vec<f64> = whole.chunks_exact(2 * freedom).take(freedom).flat_map(|line| &line[..freedom]).copied().collect();
        let pairs = eigenpairs(freedom, &of_position).ok_or(NoRest::Singular)?;
        let driven = pairs.into_iter().map(|([share, _], shares)| (1.0 - 1.0 / share, shares));
        let falling = driven.filter(|(on, _)| *on > DRIVEN).max_by(|(a, _), (b, _)| a.total_cmp(b));
        let Some((_, shares)) = falling else { return Ok(None) };
        let mut push = vec![0.0; self.work.end.x.len()];
        for (motion, [share, _]) in motions.basis.iter().zip(shares) {
            push.iter_mut().zip(motion).for_each(|(push, q)| *push += share * q);
        }
        let by = PUSH * self.work.scales.length / largest(&push) * self.side(&push);
        push.iter_mut().for_each(|push| *push *= by);
        Ok(Some(push))
    }

    /// 1 or −1, so that a motion (full) times that has momenta to the same side whatever nodes it is told of.
    fn side(&self, push: &[f64]) -> f64 {
        let mut parts = vec![0.0; push.len()];
        let momenta = energy::momenta(&self.system, &self.work.end.x, push, &mut parts);
        let [linear, angular] = [0, 3].map(|k| momenta[k] + GOLDEN * (momenta[k + 1] + GOLDEN * momenta[k + 2]));
        let whole: f64 = parts.iter().map(|part| part.abs()).sum();
        if linear.abs() > FOLLOWS * whole { linear.signum() } else { angular.signum() }
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
    pub fn propagator(&mut self, motions: &Motions, spot: &Spot, h: f64) -> Result<Vec<f64>, NoRest> {
        let f = motions.basis.len();
        self.work.start.x.copy_from_slice(&spot.x);
        let stage = self.start_step(h);
        self.work.lambda.copy_from_slice(&spot.lambda);
        self.newton.factor_there(&self.system, &stage, &mut self.work).map_err(|_| NoRest::Singular)?;
        let mut out = vec![0.0; 4 * f * f];
        for (j, (motion, momentum)) in motions.basis.iter().zip(&motions.momenta).enumerate() {
            let mut v = motion.clone();
            v.resize(self.work.end.x.len(), 0.0);
            let resisted = self.work.resistance(&self.system, stage.time(), &v);
            let of_position: Vec<f64> = momentum.iter().zip(&resisted).map(|(momentum, force)| momentum + h * force).collect();
            for (column, right) in [(j, &of_position), (f + j, momentum)] {
                let q = self.newton.solve_along_rows(right).ok_or(NoRest::Singular)?;
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

/// Numbers between −½ and ½ without order. Fractional parts of squares have one: such vectors may follow from each other.
fn scattered(k: usize) -> f64 {
    let mixed = (0..3).fold(k as u64 + 1, |bits, _| (bits ^ (bits >> 32)).wrapping_mul(MIXING));
    mixed as f64 / u64::MAX as f64 - 0.5
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
