//! The equations of motion of a mechanism that is at rest, linearised there and reduced to its freedoms.

use super::conflict::unmet;
use super::fall::Fall;
use super::golden::GOLDEN;
use super::motions::{FOLLOWS, Motions, Slow, dot};
use super::places::Places;
use super::rest::{FIRST, PUSH};
use crate::energy;
use crate::formulation::Workspace;
use crate::linalg::{eigenpairs, largest};
use crate::system::{Look, System};

/// Lengths of the step that forces at rest are found by, over that which is tried first.
const TRIES: [f64; 5] = [1.0, 0.1, 10.0, 0.01, 100.0];

/// Share of the forces that may be left at rest.
const BALANCED: f64 = 1e-6;

/// A long step over the time of the fastest motion.
const LONG: f64 = 1e4;

/// By what share of a move forces drive it on in a long step that is no rounding, and what share of it that leaves.
const DRIVEN: f64 = 1e-5;
const LEAST: f64 = 1e-10;

/// Freedoms of which all motions are looked at for one that falls. Of more, motions that show one: some without order, and as many as come of steps of them.
const MOST_FREEDOMS: usize = 200;
const SOME: usize = 10;
const FEW: usize = 60;

/// Lengths of these steps in the time of the fastest motion, one of which is about as long as a fall takes.
const LENGTHS: [f64; 10] = [0.1, 1.0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8];

/// How far the places are beside it and each other, over the mechanism's size; how many times that the way back to rest may be; and by how much rounding
/// may have them off.
const BESIDE: f64 = 1e-13;
const BACK: f64 = 10.0;
const ROUNDED: f64 = 4.0 * f64::EPSILON;

/// How far beside it kinks of forces are looked for, over the mechanism's size.
const NEAR: f64 = 1e-8;

/// Share of what a motion would bend rows by, were all of the mechanism as fast as its fastest node, that is left at a singular position. Elsewhere hardly
/// any rounding is.
const FORKS: f64 = 1e-8;

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

    /// How fast forces drive, or dampers brake where these are far stronger: what the others drive on is slow then.
    fn undamped(&self) -> f64 {
        self.driven.max(self.speed / LONG)
    }
}

/// A place (full), with the multipliers that balance the forces there.
pub(crate) struct Spot {
    x: Vec<f64>,
    lambda: Vec<f64>,
}

impl Places {
    /// Puts the mechanism at a place, and sees that it is at rest there.
    pub fn rest(&mut self, x: Vec<f64>) -> Result<Rest, NoRest> {
        let (here, left) = self.first_balance(x)?;
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

    /// How fast forces at a place make from rest what they move most there, m/s²: 0 where they balance.
    ///
    /// # Errors
    /// When that cannot be told.
    pub fn set_off(&mut self, x: Vec<f64>) -> Result<f64, NoRest> {
        let left = self.first_balance(x)?.1;
        Ok(if left > BALANCED { left * self.pushed_at_most() } else { 0.0 })
    }

    /// The multipliers that balance all forces at a place that the mechanism was not at before, and what share of the forces is left.
    fn first_balance(&mut self, x: Vec<f64>) -> Result<(Spot, f64), NoRest> {
        self.put(&x).map_err(|_| NoRest::Unbalanced)?;
        // Which rows are redundant is known from here.
        if !self.newton.factor_inertia(&self.work) {
            return Err(NoRest::Singular);
        }
        self.balance(x)
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

    /// The forces, by name, that jump or have kinks where a mechanism at rest was put last, and one of its motions goes through it.
    pub fn kinked(&self, motions: &Motions, rest: &Rest) -> Vec<String> {
        let Workspace { end, inputs, scales, .. } = &self.work;
        let mut found: Vec<String> = Vec::new();
        for motion in &motions.basis {
            let mut v = motion.clone();
            v.resize(end.x.len(), 0.0);
            let fast = self.system.largest_of_points(&v).max(scales.length * self.system.largest_of_directions(&v));
            let way = NEAR * scales.length / fast;
            let seen = self.system.see(Look { x: &end.x, v: &v, t: 0.0, at: &end.at, inputs, span: None });
            let open = self.system.open(&end.at, self.system.rounding(&end.x, &v, None));
            for name in self.system.kinked(&seen, &open, [way, way * rest.speed]) {
                if !found.iter().any(|known| known == name) {
                    found.push(name.into());
                }
            }
        }
        found
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

    /// Whether a motion that all rows allow is none as soon as it goes on: there is no acceleration with which all rows would go along. So it is at singular
    /// positions, as where bars lie in a line, and there alone, whatever rows follow from others. The motions are those at the place.
    pub fn forks(&mut self, motions: &Motions) -> bool {
        // Independent rows have accelerations for whatever bends them.
        if self.redundant_rows() == 0 {
            return false;
        }
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

    /// How a mechanism at rest, where it was put last, may fall: along moves that forces drive on, those first that they drive on most. Rounding may make
    /// some of what is none.
    ///
    /// # Errors
    /// When its motions cannot be told.
    pub fn falls(&mut self) -> Result<Vec<Fall>, NoRest> {
        let rest = self.rest(self.work.end.x.clone())?;
        let freedom = self.freedom();
        if rest.speed == 0.0 || freedom == 0 {
            return Ok(Vec::new());
        }
        let are_all = freedom <= MOST_FREEDOMS;
        let starts = self.motions(if are_all { freedom } else { SOME })?;
        let (mut falls, mut is_seen) = (Vec::new(), false);
        for length in LENGTHS {
            let h = length / rest.undamped();
            let found = if are_all { self.falls_in(&starts, &rest, h) } else { self.slow_falls(&starts, &rest, h) };
            // A step that cannot be solved shows nothing.
            if let Ok(found) = found {
                is_seen = true;
                falls.extend(found);
            }
        }
        if is_seen { Ok(falls) } else { Err(NoRest::Singular) }
    }

    /// The same, of moves that are sums of slow motions, which steps of length h make of these.
    fn slow_falls(&mut self, starts: &Motions, rest: &Rest, h: f64) -> Result<Vec<Fall>, NoRest> {
        let mut slow = Slow::default();
        self.slow_motions(&mut slow, starts, FEW, &rest.spots[0], h)?;
        self.falls_in(&slow.motions, rest, h)
    }

    /// The same, of moves that are sums of these motions, with a step of length h.
    fn falls_in(&mut self, motions: &Motions, rest: &Rest, h: f64) -> Result<Vec<Fall>, NoRest> {
        let freedom = motions.basis.len();
        // A long step leaves a share of each move, (I + h C + h² K)⁻¹ (I + h C): less than all of it, but of what forces drive on.
        let whole = self.propagator(motions, &rest.spots[0], h)?;
        let of_position: Vec<f64> = whole.chunks_exact(2 * freedom).take(freedom).flat_map(|line| &line[..freedom]).copied().collect();
        let pairs = eigenpairs(freedom, &of_position).ok_or(NoRest::Singular)?;
        // Where forces have no potential they drive a motion aside as well: what they do more of that with runs in circles.
        let of_one = |([re, im], shares): ([f64; 2], _)| (1.0 - (re + im.abs()) / (re * re + im * im), shares);
        let driven = pairs.into_iter().filter(|([re, im], _)| re.hypot(*im) > LEAST).map(of_one);
        let mut falling: Vec<_> = driven.filter(|(on, _)| *on > DRIVEN).collect();
        falling.sort_by(|(a, _), (b, _)| b.total_cmp(a));
        let fall = |(on, shares): (f64, Vec<[f64; 2]>)| {
            let mut push = vec![0.0; self.work.end.x.len()];
            for (motion, [share, _]) in motions.basis.iter().zip(shares) {
                push.iter_mut().zip(motion).for_each(|(push, q)| *push += share * q);
            }
            let by = PUSH * self.work.scales.length / largest(&push) * self.side(&push);
            push.iter_mut().for_each(|push| *push *= by);
            Fall::new(push, on, h)
        };
        Ok(falling.into_iter().map(fall).collect())
    }

    /// 1 or −1, so that a motion (full) times that has momenta to the same side whatever nodes it is told of.
    fn side(&self, push: &[f64]) -> f64 {
        let mut parts = vec![0.0; push.len()];
        let momenta = energy::momenta(&self.system, &self.work.end.x, push, &mut parts);
        let [linear, angular] = [0, 3].map(|k| momenta[k] + GOLDEN * (momenta[k + 1] + GOLDEN * momenta[k + 2]));
        let whole: f64 = parts.iter().map(|part| part.abs()).sum();
        if linear.abs() > FOLLOWS * whole { linear.signum() } else { angular.signum() }
    }

    /// What a step of implicit Euler of length h makes of the shares of the motions in positions, and in velocities times h (2f × 2f, row-major).
    pub fn propagator(&mut self, motions: &Motions, spot: &Spot, h: f64) -> Result<Vec<f64>, NoRest> {
        let f = motions.basis.len();
        self.factor_step(spot, h)?;
        let mut out = vec![0.0; 4 * f * f];
        let mut way = |right: &[f64]| self.newton.solve_along_rows(right).ok_or(NoRest::Singular);
        for (j, (motion, momentum)) in motions.basis.iter().zip(&motions.momenta).enumerate() {
            let pushed = self.work.pushed_on(&self.system, motion, momentum, h);
            let of_velocity = way(momentum)?;
            // Without dampers both are the same.
            let of_position = if pushed == *momentum { of_velocity.clone() } else { way(&pushed)? };
            for (column, q) in [(j, &of_position), (f + j, &of_velocity)] {
                for (i, momentum) in motions.momenta.iter().enumerate() {
                    let share = dot(q, momentum);
                    out[i * 2 * f + column] = share;
                    // The velocity is the way over the step.
                    out[(f + i) * 2 * f + column] = share - f64::from(u8::from(i == column));
                }
            }
        }
        Ok(out)
    }

    /// Factors the matrix of a step of implicit Euler of length h from rest.
    pub(super) fn factor_step(&mut self, spot: &Spot, h: f64) -> Result<(), NoRest> {
        self.work.start.x.copy_from_slice(&spot.x);
        let stage = self.start_step(h);
        self.work.lambda.copy_from_slice(&spot.lambda);
        self.newton.factor_there(&self.system, &stage, &mut self.work).map_err(|_| NoRest::Singular)
    }
}

impl Workspace {
    /// What a step of length h starts from, (M + h C) q, where M q is known and no velocity.
    pub(super) fn pushed_on(&mut self, system: &System, q: &[f64], momentum: &[f64], h: f64) -> Vec<f64> {
        let mut v = q.to_vec();
        v.resize(self.end.x.len(), 0.0);
        let resisted = self.resistance(system, 0.0, &v);
        momentum.iter().zip(&resisted).map(|(momentum, force)| momentum + h * force).collect()
    }
}
