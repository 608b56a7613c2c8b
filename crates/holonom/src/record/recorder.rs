//! An observer that records a run: the columns of `trajectory.csv`.

use nalgebra::UnitQuaternion;

use super::{Channels, Recording};
use crate::simulation::{Observer, Simulation, Verdict};
use crate::system::System;

/// The columns that every recording begins with.
pub const COLUMNS: [&str; 11] =
    ["t", "energy", "kinetic", "potential", "work", "dE_integrator", "dE_projection", "phi", "phi_dot", "phi_ddot", "iterations"];

/// Records the start, every `every`-th step and nothing else. ΔE_i and ΔE_p of the steps between are summed into the
/// row that follows them, so that the columns add up whatever is left out.
pub struct Recorder<'a> {
    channels: &'a Channels,
    every: u64,
    seen: u64,
    /// ΔE_i and ΔE_p since the last row, J.
    since: [f64; 2],
    has_reactions: bool,
    orientations: Vec<UnitQuaternion<f64>>,
    row: Vec<f64>,
    recording: Recording,
}

impl<'a> Recorder<'a> {
    /// Records channels of a system: motion, then the coordinates of joints and their rates, then with `reactions` the
    /// forces, where the simulation finds them.
    pub fn new(channels: &'a Channels, system: &System, every: u64, reactions: bool) -> Self {
        let common = COLUMNS.iter().map(|name| name.to_string());
        let gauges = system.gauges().iter().flat_map(|name| [name.clone(), format!("{name}_rate")]);
        let forces = if reactions { channels.reaction_columns(system.row_names()) } else { Vec::new() };
        let recording =
            Recording::new(common.chain(channels.motion_columns()).chain(gauges).chain(channels.effort_columns()).chain(forces));
        Self {
            row: Vec::with_capacity(recording.columns().len()),
            orientations: vec![UnitQuaternion::identity(); channels.bodies.len()],
            channels,
            every: every.max(1),
            seen: 0,
            since: [0.0; 2],
            has_reactions: reactions,
            recording,
        }
    }

    /// What was recorded so far.
    pub fn recording(&self) -> &Recording {
        &self.recording
    }

    /// Ends the recording.
    pub fn finish(self) -> Recording {
        self.recording
    }

    fn record(&mut self, simulation: &Simulation<'_>) {
        let (audit, state) = (simulation.audit(), simulation.state());
        self.row.clear();
        let lift = audit.lift;
        self.row.extend([state.t, audit.energy() + lift, audit.kinetic, audit.potential + lift, audit.work, self.since[0], self.since[1]]);
        self.since = [0.0; 2];
        self.row.extend([audit.phi, audit.phi_dot, audit.phi_ddot, audit.iterations as f64]);
        self.channels.motion(simulation, &mut self.orientations, &mut self.row);
        let gauges = simulation.gauges();
        gauges.value.iter().zip(&gauges.rate).for_each(|(&value, &rate)| self.row.extend([value, rate]));
        self.channels.efforts(simulation, &mut self.row);
        if self.has_reactions {
            self.channels.reactions(simulation, &mut self.row);
        }
        self.recording.push(&self.row);
    }
}

impl Observer for Recorder<'_> {
    fn after_step(&mut self, simulation: &Simulation<'_>) -> Verdict {
        self.since[0] += simulation.audit().integrator;
        self.since[1] += simulation.audit().projection;
        if self.seen.is_multiple_of(self.every) {
            self.record(simulation);
        }
        self.seen += 1;
        Verdict::GoOn
    }
}
