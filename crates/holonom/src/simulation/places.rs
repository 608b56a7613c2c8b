//! A mechanism that is put at one place after the other, without a run.

use super::Method;
use super::crowd::require_few_rows;
use super::method::Choice;
use super::start::{Asked, Start, StartError, correct_velocities, put};
use crate::formulation::{Independence, Newton, Scales, Workspace};
use crate::system::{GaugeValues, Signal, System};
use std::sync::Arc;

/// Seconds in which velocities that move nothing by more than its rounding are none.
const STEP: f64 = 1e-3;

/// A system with the room for its places and velocities, at the time 0. Its targets may change, and nothing is planned or allocated again.
pub(crate) struct Places {
    pub(super) system: System,
    pub(super) newton: Newton,
    pub(super) work: Workspace,
    /// From which turns are counted, rad: of the equations, and of what is measured.
    pub(super) angles: Vec<f64>,
    pub(super) gauges: GaugeValues,
}

impl Places {
    /// Of a system, where its start is.
    ///
    /// # Errors
    /// When too many rows are on one node.
    pub fn new(system: System) -> Result<Self, StartError> {
        require_few_rows(&system)?;
        let settings = Method::resolve(&Choice::default()).expect("the default method goes with everything").settings;
        let work = Workspace::new(&system);
        let newton = Newton::new(&system, &work.scales, settings);
        Ok(Self { angles: work.start.at.functions.angle.clone(), gauges: system.gauge_values(), newton, work, system })
    }

    /// Puts the nodes near `x` (D × nodes) and there on all rows.
    ///
    /// # Errors
    /// When the rows are missed by too much.
    pub fn put(&mut self, x: &[f64]) -> Result<(), StartError> {
        let asked = Asked { x, angles: Some([&self.angles, self.gauges.counted()]), ..Asked::of(&self.system, STEP) };
        put(&self.system, &asked, &mut self.newton, &mut self.work, &mut Start::default())
    }

    /// The velocities of all nodes there (D × nodes), per second, that meet all rows and are nearest to those of the system.
    ///
    /// # Errors
    /// When there are none.
    pub fn velocities(&mut self) -> Result<&[f64], StartError> {
        let Self { system, newton, work, .. } = self;
        let asked = Asked::of(system, STEP);
        work.end.v.copy_from_slice(asked.v);
        system.place_known(asked.t, &mut work.end.x, &mut work.end.v, &mut work.a);
        correct_velocities(system, &asked, newton, work, &mut Start::default())?;
        Ok(&work.end.v)
    }

    /// Has turns counted and sizes measured from where the nodes are now (D × nodes).
    pub fn keep(&mut self) -> &[f64] {
        self.system.start_position.copy_from_slice(&self.work.end.x);
        self.angles.copy_from_slice(&self.work.end.at.functions.angle);
        self.system.measure(&self.work.end.x, &self.work.end.v, &mut self.gauges);
        self.work.scales = Scales::new(&self.system);
        self.system.start_position()
    }

    /// Gives the k-th row another target.
    pub fn retarget(&mut self, row: usize, target: Arc<dyn Signal>) {
        self.system.retarget(row, target);
    }

    /// Size of the mechanism, m.
    pub fn length(&self) -> f64 {
        self.work.scales.length
    }

    /// How many rows follow from others at the place.
    pub fn redundant_rows(&self) -> usize {
        let end = &self.work.end;
        Independence::like(&self.system, &self.newton.kkt).count_redundant(&self.system, &end.x, &end.at.functions.angle, 0.0)
    }

    /// How many motions the rows leave free at the place.
    pub fn freedom(&self) -> usize {
        self.system.coordinates() + self.redundant_rows() - self.system.constraints()
    }

    /// The system, at the place that was kept last.
    pub fn system(&self) -> &System {
        &self.system
    }

    /// Angles of the equations and of what is measured at the place that was kept last, rad.
    pub fn angles(&self) -> [&[f64]; 2] {
        [&self.angles, self.gauges.counted()]
    }
}
