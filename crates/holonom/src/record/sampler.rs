//! What rows need to know of a state, taken after the step that reached it: numbers that may be put together elsewhere and later.

use std::sync::Arc;

use nalgebra::{Quaternion, UnitQuaternion};
use serde::{Deserialize, Serialize};

use super::{Channels, force};
use crate::simulation::{Divisions, Simulation};

/// What is made of a sample.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// A row.
    Row,
    /// A row in place of the last one.
    InPlaceOfLast,
    /// Measures and the largest values of forces see it.
    Beside {
        /// With forces of the constraints.
        with_forces: bool,
    },
    /// The largest values of forces see it: it has the time and what forces exert.
    Forces,
}

/// Samples in their order.
#[derive(Default)]
pub struct Samples {
    pub(super) numbers: Vec<f64>,
    /// Of each what is made of it, and where it ends.
    kinds: Vec<(Kind, usize)>,
}

impl Samples {
    /// Numbers that they have.
    pub fn size(&self) -> usize {
        self.numbers.len()
    }

    /// How many there are.
    pub fn count(&self) -> usize {
        self.kinds.len()
    }

    /// Forgets them, and keeps their room.
    pub fn clear(&mut self) {
        self.numbers.clear();
        self.kinds.clear();
    }

    fn end(&mut self, kind: Kind) {
        self.kinds.push((kind, self.numbers.len()));
    }

    pub(super) fn iter(&self) -> impl Iterator<Item = (Kind, &[f64])> {
        let mut from = 0;
        self.kinds.iter().map(move |&(kind, end)| (kind, &self.numbers[std::mem::replace(&mut from, end)..end]))
    }
}

/// What a sampler goes on from when a run is resumed.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct SamplerMark {
    /// Steps seen, the start included.
    seen: u64,
    /// ΔE_i and ΔE_p since the last row, J, and those in it.
    since: [f64; 2],
    last: [f64; 2],
    /// Quaternions (w, x, y, z) of the bodies in the last row, of two signs the one near the row before.
    orientations: Vec<[f64; 4]>,
}

/// Takes samples of the start, of every `every`-th step, and of what is looked at between them.
pub struct Sampler {
    channels: Arc<Channels>,
    every: u64,
    seen: u64,
    /// ΔE_i and ΔE_p since the last row, J.
    since: [f64; 2],
    last: [f64; 2],
    resumed: bool,
    /// Time of the step that was seen last, s, and that of the last row.
    seen_at: f64,
    last_row: Option<f64>,
    /// Where it looks beside the rows.
    divisions: Divisions,
    /// Whether forces are looked at there.
    looks_at_forces: bool,
    /// Whether samples have what forces of the constraints are found with.
    pub(super) is_for_finder: bool,
    orientations: Vec<UnitQuaternion<f64>>,
}

impl Sampler {
    pub(super) fn new(channels: Arc<Channels>, every: u64, divisions: Divisions, looks_at_forces: bool) -> Self {
        Self {
            every: every.max(1),
            seen: 0,
            since: [0.0; 2],
            last: [0.0; 2],
            resumed: false,
            seen_at: f64::NAN,
            last_row: None,
            divisions,
            looks_at_forces,
            is_for_finder: false,
            orientations: vec![UnitQuaternion::identity(); channels.bodies.len()],
            channels,
        }
    }

    pub(super) fn resume(&mut self, mark: &SamplerMark) {
        (self.seen, self.since, self.last, self.resumed) = (mark.seen, mark.since, mark.last, true);
        for (own, [w, x, y, z]) in self.orientations.iter_mut().zip(&mark.orientations) {
            *own = UnitQuaternion::new_unchecked(Quaternion::new(*w, *x, *y, *z));
        }
    }

    /// The last row that is there already is of this time, s.
    pub(super) fn go_on_after(&mut self, last_row: Option<f64>) {
        self.last_row = last_row;
    }

    /// What a resumed run goes on from.
    pub fn mark(&self) -> SamplerMark {
        let orientations = self.orientations.iter().map(|q| [q.w, q.i, q.j, q.k]).collect();
        SamplerMark { seen: self.seen, since: self.since, last: self.last, orientations }
    }

    pub(super) fn follow(&mut self, simulation: &Simulation) {
        self.channels.follow(simulation, &mut self.orientations);
    }

    /// Whether the simulation is to find forces of the constraints for the sample after the step to come.
    pub fn wants_forces(&self) -> bool {
        self.divisions == Divisions::Inside || self.seen.is_multiple_of(self.every)
    }

    /// Where it looks inside of steps.
    pub fn divisions(&self) -> Divisions {
        self.divisions
    }

    /// Samples the state inside a nominal step.
    pub fn at_division(&mut self, simulation: &Simulation, samples: &mut Samples) {
        if !self.channels.measures.is_empty() {
            self.sample(simulation, Kind::Beside { with_forces: self.divisions == Divisions::Inside }, samples);
        } else if self.looks_at_forces {
            samples.numbers.push(simulation.state().t);
            force::append(&self.channels.forces, simulation, false, &mut samples.numbers);
            samples.end(Kind::Forces);
        }
    }

    /// Samples the state after a step.
    pub fn after_step(&mut self, simulation: &Simulation, samples: &mut Samples) {
        let t = simulation.state().t;
        let before = std::mem::replace(&mut self.seen_at, t);
        if before == t && simulation.ended_by().is_some() {
            // The end of a run at the time of the step that was seen last takes the place of its row where there is one.
            return match self.last_row == Some(t) {
                true => self.sample(simulation, Kind::InPlaceOfLast, samples),
                false => self.sample_next(simulation, samples),
            };
        }
        if std::mem::take(&mut self.resumed) {
            // Where the run was left, that row is the first once more, unless it is there.
            if self.last_row.is_none() && (self.seen.max(1) - 1).is_multiple_of(self.every) {
                self.sample(simulation, Kind::Row, samples);
            }
            return;
        }
        self.since[0] += simulation.audit().integrator;
        self.since[1] += simulation.audit().projection;
        match self.seen.is_multiple_of(self.every) || simulation.ended_by().is_some() {
            true => self.sample_next(simulation, samples),
            false => self.at_division(simulation, samples),
        }
        self.seen += 1;
    }

    /// Samples the next row.
    fn sample_next(&mut self, simulation: &Simulation, samples: &mut Samples) {
        self.last = std::mem::take(&mut self.since);
        self.sample(simulation, Kind::Row, samples);
    }

    fn sample(&mut self, simulation: &Simulation, kind: Kind, samples: &mut Samples) {
        self.append(simulation, &mut samples.numbers);
        if self.is_for_finder && kind != (Kind::Beside { with_forces: false }) {
            simulation.append_snapshot(&mut samples.numbers);
        }
        samples.end(kind);
        if matches!(kind, Kind::Row | Kind::InPlaceOfLast) {
            self.last_row = Some(self.seen_at);
        }
    }

    /// Samples the present state as a row after the step before it.
    pub(super) fn look(&mut self, simulation: &Simulation, samples: &mut Samples) {
        self.last = [simulation.audit().integrator, simulation.audit().projection];
        self.append(simulation, &mut samples.numbers);
    }

    /// The part of that before the forces.
    pub(super) fn look_at_motion(&mut self, simulation: &Simulation, samples: &mut Samples) {
        self.last = [simulation.audit().integrator, simulation.audit().projection];
        self.append_motion(simulation, &mut samples.numbers);
    }

    /// Appends what a row needs of the present state beside the forces of constraints.
    fn append(&mut self, simulation: &Simulation, to: &mut Vec<f64>) {
        self.append_motion(simulation, to);
        if !self.channels.forces.is_empty() {
            force::append(&self.channels.forces, simulation, true, to);
        }
        to.extend_from_slice(&simulation.state().inputs);
    }

    fn append_motion(&mut self, simulation: &Simulation, to: &mut Vec<f64>) {
        let (audit, lift) = (simulation.audit(), simulation.audit().lift);
        let [integrator, projection] = self.last;
        to.extend([simulation.state().t, audit.energy() + lift, audit.kinetic, audit.potential + lift, audit.work, integrator, projection]);
        to.extend([audit.phi, audit.phi_dot, audit.phi_ddot, audit.iterations as f64]);
        self.channels.motion(simulation, &mut self.orientations, to);
        let gauges = simulation.gauges();
        gauges.value.iter().zip(&gauges.rate).for_each(|(&value, &rate)| to.extend([value, rate]));
    }
}
