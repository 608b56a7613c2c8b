//! What forces do: how long a spring is and how it pulls, what acts along a coordinate, what a load exerts, and their power.

use std::ops::Range;
use std::sync::Arc;

use smallvec::SmallVec;

use super::heading::{Heading, Units};
use crate::simulation::Simulation;
use crate::system::{FunctionId, LawEntry, LoadEntry, Look, MAX_ARGUMENTS, Quantity, Response, Sense, System, Term, place_of};

/// A force whose effect is recorded.
#[derive(Clone)]
pub struct RecordedForce {
    /// With its index where it is repeated.
    pub name: String,
    /// Its laws and its loads among those of the system.
    pub(crate) laws: Range<usize>,
    pub(crate) loads: Range<usize>,
    pub(crate) shows: Shows,
}

/// What is shown of a force beside its power.
#[derive(Clone)]
pub enum Shows {
    /// Nothing.
    Power,
    /// Length, its rate and the tension.
    Tension {
        /// What the tension acts along, in the order of the lengths; the coordinate of a drum last.
        quantities: Vec<Quantity>,
        /// How the length follows from them.
        lengths: Lengths,
        /// Distances below this count as this, m, as the laws have it.
        shortest: f64,
    },
    /// What its laws exert along some coordinates.
    Along(Vec<Along>),
    /// What is on the far side of a cut through the middle of an element exerts on the near side: its laws along displacements along the mean axes of
    /// both ends, then along the rotation vector. The displacements depend on the ways along these axes over the length, the first on all of them, the others
    /// on those across, before they depend on turns.
    Section {
        /// Displacements, then rotations.
        coordinates: Vec<Along>,
        /// Of the element at the start, m.
        length: f64,
    },
    /// What a bushing exerts along and about the axes of its first body, which are those of the model at the start.
    Bushing {
        /// Displacements, then sines of rotations.
        coordinates: Vec<Along>,
        /// The axes of both bodies.
        axes: [Vec<Vec<Term>>; 2],
    },
    /// What its load exerts.
    Load {
        /// Whether it is a moment (N·m) and not a force (N).
        is_moment: bool,
        /// Finds it.
        exerts: Arc<dyn Exerts>,
    },
}

/// How the length follows from the arguments of the laws.
#[derive(Clone, Debug, PartialEq)]
pub enum Lengths {
    /// They are half the squares of lengths that add up to it.
    Distances {
        /// How often each of them counts.
        factors: Vec<f64>,
        /// What is added to them, m.
        fixed: f64,
        /// The drum, whose coordinate is the argument behind them.
        drum: Option<Along>,
    },
    /// It is the argument itself, along an axis.
    Along,
}

/// A coordinate that laws act along.
#[derive(Clone, Debug, PartialEq)]
pub struct Along {
    /// The first argument of the laws, or that behind the lengths of a rope.
    pub coordinate: FunctionId,
    /// Suffix of the column of the coordinate itself, and what it is in words, where it is shown.
    pub value: Option<[String; 2]>,
    /// Suffix of the column of the effort along it, and what that is in words.
    pub effort: [String; 2],
    /// Whether it is an angle, or counts as one, and not a displacement.
    pub is_angle: bool,
}

/// A force or moment that follows from what a load reads.
pub trait Exerts: Send + Sync {
    /// The force or moment in the axes of the model, in the plane a moment last, at what the load [reads](crate::system::Reading), `x`, its
    /// rates `v` and the time `t`.
    fn exerted(&self, x: &[f64], v: &[f64], t: f64) -> [f64; 3];
}

/// The state that forces are looked at in.
struct At<'a> {
    system: &'a System,
    look: Look<'a>,
    /// Whether their power is wanted, and the rates that only tell that.
    with_power: bool,
}

impl At<'_> {
    /// Rates of the arguments of a law, and its forces along them. A law with a potential does not depend on them: without power they are left out.
    fn response(&self, law: &LawEntry) -> [[f64; MAX_ARGUMENTS]; 2] {
        let Look { at, v, t, .. } = self.look;
        let mut out = Response::default();
        if self.with_power || !law.law.conservative() {
            return [self.system.respond(law, at, v, t, &mut out), out.force];
        }
        let (values, rates, m) = (self.system.arguments(law, at), [0.0; MAX_ARGUMENTS], law.arguments.len());
        law.law.at(&values[..m], &rates[..m], t, &mut out);
        [rates, out.force]
    }

    fn rate(&self, quantity: Quantity) -> f64 {
        let along = || self.system.along(&self.system.slots_of(quantity), &self.system.slots.nodes, self.look.at, self.look.v);
        if self.with_power { along() } else { f64::NAN }
    }

    fn value(&self, quantity: Quantity) -> f64 {
        self.look.at.value[self.system.value_index(quantity)]
    }

    /// What a load exerts on each number that it reads, and what it does, W.
    fn exerted(&self, load: &LoadEntry) -> (Vec<f64>, f64) {
        let [x, v] = &self.system.read(&load.reading, self.look);
        let mut force = vec![0.0; x.len()];
        load.load.force(x, v, self.look.t, &mut force);
        let power = force.iter().zip(v).map(|(force, v)| force * v).sum();
        (force, power)
    }

    /// What a load exerts along a quantity that it reads.
    fn along(&self, load: &LoadEntry, quantity: Quantity) -> f64 {
        let own = load.reading.nodes.len() * self.system.dim;
        let place = load.reading.senses.iter().position(|sense| *sense == Sense::Quantity(quantity));
        place.map_or(0.0, |k| self.exerted(load).0[own + k])
    }
}

impl Along {
    fn effort_heading(&self, of: &dyn Fn(&str, &'static str, String) -> Heading) -> Heading {
        let [suffix, words] = &self.effort;
        of(suffix, Units::of(self.is_angle).effort, words.clone())
    }
}

/// What a component of a force in a section is a component of.
pub(super) fn quantity(suffix: &str) -> &str {
    suffix.split('_').next().unwrap_or(suffix)
}

impl RecordedForce {
    /// Its columns, for a model with these axes.
    pub(super) fn headings(&self, axes: &str) -> Vec<Heading> {
        let of = |suffix: &str, unit, meaning: String| Heading::new(format!("{}.{suffix}", self.name), unit, meaning);
        let mut headings = Vec::new();
        match &self.shows {
            Shows::Power => (),
            Shows::Tension { lengths, .. } => {
                let what = match lengths {
                    Lengths::Distances { factors, .. } if factors.len() == 1 => "distance of its ends",
                    Lengths::Distances { .. } => "length from end to end",
                    Lengths::Along => "way from its first to its second end along its axis",
                };
                headings.extend([
                    of("length", "m", what.into()),
                    of("length_rate", "m/s", "rate of the length".into()),
                    of("force", "N", "tension: above zero it pulls its ends together".into()),
                ]);
                if let Lengths::Distances { drum: Some(drum), .. } = lengths {
                    headings.push(drum.effort_heading(&of));
                }
            }
            Shows::Along(coordinates) | Shows::Section { coordinates, .. } | Shows::Bushing { coordinates, .. } => {
                // A bushing shows the sines of its angles.
                let of_angle = if matches!(self.shows, Shows::Bushing { .. }) { "1" } else { Units::of(true).value };
                let unit = |along: &Along| if along.is_angle { of_angle } else { Units::of(false).value };
                let shown = |along: &Along| along.value.clone().map(|[suffix, words]| of(&suffix, unit(along), words));
                headings.extend(coordinates.iter().filter_map(shown));
                headings.extend(coordinates.iter().map(|along| along.effort_heading(&of)));
            }
            Shows::Load { is_moment, .. } => {
                let [letter, unit, what] = if *is_moment { ["t", "N·m", "moment"] } else { ["f", "N", "force"] };
                match (axes.len(), is_moment) {
                    (2, true) => headings.push(of("t", unit, "moment that it exerts".into())),
                    _ => headings.extend(
                        axes.chars()
                            .map(|axis| of(&format!("{letter}{axis}"), unit, format!("{what} that it exerts, along {axis} of the world"))),
                    ),
                }
            }
        }
        headings.push(of("power", "W", "power that it gives to the mechanism".into()));
        headings
    }

    /// The columns of what it exerts, those together that are components of one force or one moment.
    pub fn acts(&self, axes: &str) -> Vec<Vec<String>> {
        let column = |suffix: &str| format!("{}.{suffix}", self.name);
        match &self.shows {
            Shows::Power => Vec::new(),
            Shows::Tension { .. } => vec![vec![column("force")]],
            Shows::Along(coordinates) => coordinates.iter().map(|along| vec![column(&along.effort[0])]).collect(),
            Shows::Section { coordinates, .. } => {
                // Components along y and z are those of one.
                let of_one = coordinates.chunk_by(|a, b| quantity(&a.effort[0]) == quantity(&b.effort[0]));
                of_one.map(|of_one| of_one.iter().map(|along| column(&along.effort[0])).collect()).collect()
            }
            Shows::Bushing { coordinates, .. } => {
                let (forces, moments) = coordinates.split_at(axes.len());
                [forces, moments].map(|of| of.iter().map(|along| column(&along.effort[0])).collect()).into()
            }
            Shows::Load { is_moment, .. } => {
                let letter = if *is_moment { 't' } else { 'f' };
                match (axes.len(), is_moment) {
                    (2, true) => vec![vec![column("t")]],
                    _ => vec![axes.chars().map(|axis| column(&format!("{letter}{axis}"))).collect()],
                }
            }
        }
    }

    /// The beam that it is an element of, if it is one.
    pub(crate) fn beam(&self) -> Option<&str> {
        matches!(self.shows, Shows::Section { .. }).then(|| self.name.rfind('[').map_or(&*self.name, |at| &self.name[..at]))
    }

    /// The columns of the sines of a bushing's rotations; none of other forces.
    pub fn sines(&self) -> Vec<String> {
        let Shows::Bushing { coordinates, .. } = &self.shows else { return Vec::new() };
        let of_angles = coordinates.iter().filter(|along| along.is_angle).filter_map(|along| along.value.as_ref());
        of_angles.map(|[suffix, _]| format!("{}.{suffix}", self.name)).collect()
    }

    fn values(&self, at: &At<'_>, dim: usize, row: &mut Vec<f64>) {
        let (laws, loads) = (&at.system.laws[self.laws.clone()], &at.system.loads[self.loads.clone()]);
        let responses: SmallVec<[_; 2]> = laws.iter().map(|law| at.response(law)).collect();
        match &self.shows {
            Shows::Power => (),
            Shows::Tension { quantities, lengths, shortest } => {
                let of = |quantity: &Quantity| [at.value(*quantity), at.rate(*quantity)];
                let force = |k: usize| {
                    let of_loads = loads.iter().map(|load| at.along(load, quantities[k]));
                    responses.iter().map(|[_, force]| force[k]).sum::<f64>() - of_loads.sum::<f64>()
                };
                match lengths {
                    Lengths::Distances { factors, fixed, drum } => {
                        let stretches = quantities[..factors.len()].iter();
                        let each: SmallVec<[[f64; 2]; 4]> = stretches.map(|stretch| length(of(stretch), *shortest)).collect();
                        let tension = force(0) * each[0][0] / factors[0];
                        let sum = |k: usize| each.iter().zip(factors).map(|(one, factor)| factor * one[k]).sum::<f64>();
                        row.extend([fixed + sum(0), sum(1), tension]);
                        row.extend(drum.as_ref().map(|_| 0.0 - force(factors.len())));
                    }
                    Lengths::Along => {
                        let [length, rate] = of(&quantities[0]);
                        row.extend([length, rate, force(0)]);
                    }
                }
            }
            Shows::Along(coordinates) | Shows::Section { coordinates, .. } | Shows::Bushing { coordinates, .. } => {
                let sign = if matches!(self.shows, Shows::Section { .. }) { 1.0 } else { -1.0 };
                let shown = coordinates.iter().filter(|along| along.value.is_some());
                row.extend(shown.map(|along| at.value(along.coordinate.into())));
                let first = row.len();
                row.extend(coordinates.iter().map(|along| {
                    let own = |law: &LawEntry| law.arguments.first() == Some(&along.coordinate.into());
                    let efforts = laws.iter().zip(&responses).filter(|(law, _)| own(law)).map(|(_, [_, force])| sign * force[0]);
                    let of_loads = loads.iter().map(|load| at.along(load, along.coordinate.into()));
                    0.0 + efforts.sum::<f64>() + of_loads.sum::<f64>()
                }));
                match &self.shows {
                    Shows::Bushing { axes, .. } => moments(axes, &at.system.in_world(at.look.x), &mut row[first + dim..]),
                    Shows::Section { length, .. } => {
                        let slopes = |along: &Along| &at.look.at.functions.local[along.coordinate.0 as usize].gradient;
                        let turn: SmallVec<[f64; 3]> = coordinates[dim..].iter().map(|along| at.value(along.coordinate.into())).collect();
                        let slopes: SmallVec<[_; 3]> = coordinates[..dim].iter().map(slopes).collect();
                        in_the_middle(&slopes, *length, &turn, &mut row[first..first + dim]);
                    }
                    _ => (),
                }
            }
            Shows::Load { is_moment, exerts } => {
                let Some(load) = loads.first() else { return };
                let [x, v] = &at.system.read(&load.reading, at.look);
                let exerted = exerts.exerted(x, v, at.look.t);
                row.extend_from_slice(if dim == 2 && *is_moment { &exerted[2..] } else { &exerted[..dim] });
            }
        }
        if !at.with_power {
            row.push(f64::NAN);
            return;
        }
        let of_law = |(law, [rates, force]): (&LawEntry, &[[f64; MAX_ARGUMENTS]; 2])| -> f64 {
            (0..law.arguments.len()).map(|k| -force[k] * rates[k]).sum()
        };
        let of_laws: f64 = laws.iter().zip(&responses).map(of_law).sum();
        let of_loads: f64 = loads.iter().map(|load| at.exerted(load).1).sum();
        row.push(0.0 + of_laws + of_loads);
    }
}

/// Makes moments about the axes e(A) of the first body from efforts f along the sines s_k = ½ (e_j(A)·e_i(B) − e_i(A)·e_j(B)), (i, j, k)
/// cyclic. With R = e(A)·e(B)ᵀ a rotation δθ of B about the axes of A changes them by δs_k = ½ (tr R δθ_k − Σ R_km δθ_m).
fn moments([first, second]: &[Vec<Vec<Term>>; 2], x: &[f64], efforts: &mut [f64]) {
    let dim = first.len();
    let [first, second] = [first, second].map(|axes| axes.iter().map(|axis| place_of(axis, x, dim)).collect::<Vec<_>>());
    let r = |k: usize, m: usize| (0..dim).map(|c| first[k][c] * second[m][c]).sum::<f64>();
    let trace: f64 = (0..dim).map(|k| r(k, k)).sum();
    match efforts {
        // Both normals stay the same.
        [about_normal] => *about_normal *= 0.5 * trace,
        all => {
            let of_sines = [all[0], all[1], all[2]];
            for (m, moment) in all.iter_mut().enumerate() {
                *moment = 0.5 * (trace * of_sines[m] - (0..3).map(|k| of_sines[k] * r(k, m)).sum::<f64>());
            }
        }
    }
}

/// Makes forces along the axes in the middle of an element, half way of the rotation vector between those of its ends, from efforts along its
/// displacements. Ways along m_k = ½ (a_k + b_k), over the `length`, change these by their `slopes`, those across all of them; and m_k are the axes there,
/// but that what goes across the rotation is shorter by the cosine of half of it.
fn in_the_middle(slopes: &[&[f64; MAX_ARGUMENTS]], length: f64, turn: &[f64], efforts: &mut [f64]) {
    let along: SmallVec<[f64; 3]> = efforts.iter().map(|effort| effort / length).collect();
    let of_others = |k: usize| (1..along.len()).map(|j| slopes[j][k - 1] * along[j]).sum::<f64>();
    efforts.iter_mut().enumerate().for_each(|(k, effort)| *effort = slopes[0][k] * along[0] + if k > 0 { of_others(k) } else { 0.0 });
    let angle = turn.iter().map(|turn| turn * turn).sum::<f64>().sqrt();
    let cosine = (0.5 * angle).cos();
    // In the plane the rotation goes across all.
    let of_axis = if turn.len() < 3 || angle == 0.0 { 0.0 } else { (1.0 - cosine) / (angle * angle) * dot(turn, efforts) };
    efforts.iter_mut().enumerate().for_each(|(k, effort)| *effort = cosine * *effort + of_axis * turn.get(k).unwrap_or(&0.0));
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// A length and its rate, from half its square and the rate of that, where a distance counts as `shortest` at least (m).
fn length([half_square, rate]: [f64; 2], shortest: f64) -> [f64; 2] {
    let length = (2.0 * half_square).sqrt();
    // Also taken when rounding has made the square negative.
    let length = if length > shortest { length } else { shortest };
    [length, rate / length]
}

/// Appends what forces do at the present state; their power and rates of lengths are no numbers unless it is wanted.
pub(super) fn append(forces: &[RecordedForce], simulation: &Simulation, with_power: bool, row: &mut Vec<f64>) {
    let (system, state) = (simulation.system(), simulation.state());
    let look = Look { x: &state.x, v: simulation.velocities(), t: state.t, at: simulation.evaluation(), inputs: &state.inputs, span: None };
    let at = At { system, look, with_power };
    forces.iter().for_each(|force| force.values(&at, system.dim, row));
}
