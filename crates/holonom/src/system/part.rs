//! The parts that functions are sums of, at a position and between two.

use std::sync::Arc;

use super::angle::{angle_at, angle_between};
use super::derive::{Place, chord, difference, quotient};
use super::{Derivatives, Followed, InvariantId, MAX_ARGUMENTS, Pfaffian, Signal, Smooth};

/// A summand of a function.
#[derive(Clone)]
pub enum Part {
    /// An invariant.
    Invariant(InvariantId),
    /// The angle whose cosine and sine are two invariants, times whatever they have in common. It is counted over any
    /// number of turns from where it was.
    Angle {
        /// ρ cos θ, with any ρ > 0.
        cosine: InvariantId,
        /// ρ sin θ, with the same ρ.
        sine: InvariantId,
        /// It is counted from the angle nearest to this at the start, rad.
        near: f64,
    },
    /// A function of one coordinate: of an invariant, an angle or a followed number.
    Curve {
        /// The coordinate.
        of: Box<Self>,
        /// Its value and two derivatives by the coordinate.
        curve: Arc<dyn Signal>,
    },
    /// A smooth function of some invariants.
    Smooth {
        /// Its arguments, in order.
        of: Vec<InvariantId>,
        /// Its value and derivatives by them.
        function: Arc<dyn Smooth>,
    },
    /// A condition on the rates of some invariants.
    Pfaffian {
        /// The invariants π_i, in order.
        of: Vec<InvariantId>,
        /// The coefficients f_i(π) in Σ f_i π̇_i = 0.
        form: Arc<dyn Pfaffian>,
    },
    /// A function of some invariants with a number that is followed.
    Followed {
        /// Its arguments, in order.
        of: Vec<InvariantId>,
        /// Finds the number, and value and derivatives where it is known.
        function: Arc<dyn Followed>,
    },
}

impl Part {
    /// The invariants that it depends on, in order.
    pub(super) fn arguments(&self) -> Vec<InvariantId> {
        match self {
            Self::Invariant(id) => vec![*id],
            Self::Angle { cosine, sine, .. } => vec![*cosine, *sine],
            Self::Curve { of, .. } => of.arguments(),
            Self::Smooth { of, .. } | Self::Followed { of, .. } | Self::Pfaffian { of, .. } => of.clone(),
        }
    }

    /// Whether it has a number that is followed, as the turns of an angle.
    pub(super) fn is_followed(&self) -> bool {
        self.followed_from().is_some()
    }

    /// Where the number that is followed is looked for at the start.
    pub(super) fn followed_from(&self) -> Option<f64> {
        match self {
            Self::Curve { of, .. } => of.followed_from(),
            Self::Angle { near, .. } => Some(*near),
            Self::Followed { .. } => Some(0.0),
            _ => None,
        }
    }

    /// Value and derivatives at the invariants `pi`. What is followed is the first of `followed`, and is found from there.
    pub(super) fn at(&self, pi: &[f64], followed: &mut [f64]) -> Derivatives {
        match self {
            Self::Invariant(id) => identity(pi[id.0 as usize]),
            Self::Angle { cosine, sine, .. } => {
                let part = angle_at(pi[cosine.0 as usize], pi[sine.0 as usize], followed[0]);
                followed[0] = part.value;
                part
            }
            Self::Curve { of, curve } => {
                let inner = of.at(pi, followed);
                let [value, slope, bend] = curve.at(inner.value);
                inner.chained(value, slope, |k| bend * inner.gradient[k])
            }
            Self::Smooth { of, function } => function.derivatives(&pick(of, pi)[..of.len()]),
            Self::Pfaffian { of, form } => form.derivatives(&pick(of, pi)[..of.len()]),
            Self::Followed { of, function } => {
                let value = &pick(of, pi)[..of.len()];
                followed[0] = function.locate(value, followed[0]);
                function.derivatives(value, followed[0])
            }
        }
    }

    /// What happens where a step between these invariants goes across a corner.
    pub(super) fn corner(&self, pi: [&[f64]; 2]) -> Option<&'static str> {
        let Self::Smooth { of, function } = self else { return None };
        let [from, to] = pi.map(|pi| pick(of, pi));
        function.corner(&from[..of.len()], &to[..of.len()])
    }

    /// The discrete derivative between two positions; what is followed is the first of `followed` at each.
    pub(super) fn between(&self, pi: [&[f64]; 2], followed: [&[f64]; 2]) -> Derivatives {
        match self {
            Self::Invariant(_) => identity(0.0),
            Self::Angle { cosine, sine, .. } => angle_between(pi.map(|pi| [pi[cosine.0 as usize], pi[sine.0 as usize]])),
            Self::Curve { of, curve } => {
                let end = |k: usize| of.at(pi[k], &mut first_of(followed[k]));
                let [from, to] = [0, 1].map(end);
                // Formulas of angles are of the size that they have in one radian, and rounded as that.
                let size = if matches!(**of, Self::Angle { .. }) { 1.0 } else { 0.0 };
                let (slope, turn) = chord(curve.as_ref(), from.value, to.value, size);
                of.between(pi, followed).chained(0.0, slope, |k| turn * to.gradient[k])
            }
            // The mean of the ends: momenta and energy need no more, as Σ f_i Δπ_i vanishes.
            Self::Pfaffian { of, form } => {
                let [start, end] = pi.map(|pi| form.derivatives(&pick(of, pi)[..of.len()]));
                let mut mean = Derivatives::default();
                for i in 0..of.len() {
                    mean.gradient[i] = 0.5 * (start.gradient[i] + end.gradient[i]);
                    mean.hessian[i] = end.hessian[i].map(|h| 0.5 * h);
                }
                mean
            }
            Self::Followed { of, function } => {
                let ([start, end], m) = (pi.map(|pi| pick(of, pi)), of.len());
                let at = followed.map(|followed| followed[0]);
                quotient(&start[..m], &end[..m], function.least_change(), |place, value| match place {
                    Place::Start => function.derivatives(value, at[0]),
                    Place::End => function.derivatives(value, at[1]),
                    Place::Middle => function.derivatives(value, function.locate(value, 0.5 * (at[0] + at[1]))),
                })
            }
            Self::Smooth { of, function } => {
                let [from, to] = pi.map(|pi| pick(of, pi));
                difference(function.as_ref(), &from[..of.len()], &to[..of.len()])
            }
        }
    }
}

/// The first of some numbers, if there is one.
pub(super) fn first_of(numbers: &[f64]) -> [f64; 1] {
    [numbers.first().copied().unwrap_or_default()]
}

fn pick(ids: &[InvariantId], values: &[f64]) -> [f64; MAX_ARGUMENTS] {
    let mut picked = [0.0; MAX_ARGUMENTS];
    ids.iter().zip(&mut picked).for_each(|(id, out)| *out = values[id.0 as usize]);
    picked
}

fn identity(value: f64) -> Derivatives {
    let mut out = Derivatives { value, ..Derivatives::default() };
    out.gradient[0] = 1.0;
    out
}
