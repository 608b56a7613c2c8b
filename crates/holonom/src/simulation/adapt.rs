//! Steps by accuracy at work: attempts, rejected ones taken back, and results between the steps of integrators with dense
//! output.

use super::control::Control;
use super::{Audit, Method, Simulation, State};
use crate::formulation::Failure;
use crate::integrator::{Estimate, Step, Work};
use crate::projection::{Metric, Projection, Solve};

/// Smallest step over the length of the run that an accuracy may ask for: below it times no longer tell steps apart.
const SMALLEST_SHARE: f64 = 1e-13;

/// A state, the velocities and accelerations shown of it, and what is booked of the run up to it.
struct Moment {
    state: State,
    v: Vec<f64>,
    a: Vec<f64>,
    audit: Audit,
}

impl Moment {
    fn keep(&mut self, simulation: &Simulation<'_>) {
        self.state.copy_from(&simulation.state);
        self.v.copy_from_slice(&simulation.shown_v);
        self.a.copy_from_slice(&simulation.shown_a);
        self.audit.clone_from(&simulation.audit);
    }

    /// Puts a simulation back here.
    fn restore(&self, simulation: &mut Simulation<'_>) {
        simulation.state.copy_from(&self.state);
        simulation.shown_v.copy_from_slice(&self.v);
        simulation.shown_a.copy_from_slice(&self.a);
        simulation.audit.clone_from(&self.audit);
        let work = &mut simulation.work;
        work.start.at.functions.angle.copy_from_slice(&self.state.angle);
        simulation.system.evaluate_again(&self.state.x, self.state.t, &mut work.start.at);
    }
}

/// What chooses the steps, and the moments to go back to.
pub(super) struct Pilot {
    control: Control,
    end: f64,
    /// The projection that smooths velocities for the estimate from the steps before, where nothing else does.
    smooth: Option<Projection>,
    /// Velocities (D × nodes) that errors are estimated from.
    v: Vec<f64>,
    /// The start of the last step, and its end, where integration goes on.
    before: Moment,
    front: Moment,
    last: Option<(Step, f64)>,
}

impl Pilot {
    pub(super) fn new(method: &Method, state: &State, audit: &Audit, coordinates: usize) -> Option<Box<Self>> {
        let moment = || Moment { state: state.clone(), v: state.v.clone(), a: state.a.clone(), audit: audit.clone() };
        let control = Control::new(method.accuracy?, method.order(), method.integrator.estimate, coordinates);
        let smooth = smoothing(method);
        Some(Box::new(Self { control, end: state.t, smooth, v: state.v.clone(), before: moment(), front: moment(), last: None }))
    }
}

fn smoothing(method: &Method) -> Option<Projection> {
    let rough = method.formulation.is_at_position() && !method.projection.velocity;
    (rough && method.integrator.estimate == Estimate::History).then_some(Projection {
        velocity: true,
        acceleration: false,
        metric: Metric::Mass,
        solve: Solve::Exact,
        strength: 1.0,
        shadow: true,
    })
}

impl Simulation<'_> {
    /// Begins to choose steps for a run to `end` (s).
    pub(super) fn begin_adapting(&mut self, end: f64) {
        let Some(mut pilot) = self.pilot.take() else { return };
        pilot.end = end;
        pilot.v.copy_from_slice(&self.shown_v);
        pilot.control.begin(&self.state, &pilot.v, end - self.state.t, self.work.scales.length);
        pilot.front.keep(self);
        self.work.estimate.allowed = pilot.control.allowed();
        self.pilot = Some(pilot);
    }

    /// Goes to `target` in equal steps no longer than the accuracy allows.
    pub(super) fn land(&mut self, target: f64, pilot: &mut Pilot) -> Result<(), Failure> {
        while self.state.t < target {
            let left = target - self.state.t;
            let parts = (left / pilot.control.step - 1e-9).ceil().max(1.0);
            let step = left / parts;
            self.attempt(step, if parts == 1.0 { target } else { self.state.t + step }, pilot)?;
        }
        Ok(())
    }

    /// Goes on in steps as long as the accuracy allows, and reads what is at `target` between the ends of the last one.
    pub(super) fn cruise(&mut self, target: f64, pilot: &mut Pilot) -> Result<(), Failure> {
        let shown = self.audit.clone();
        pilot.front.restore(self);
        let mut outcome = Ok(());
        while self.state.t < target && outcome.is_ok() {
            // The last two steps are alike.
            let left = pilot.end - self.state.t;
            let parts = (left / pilot.control.step - 1e-9).ceil().max(1.0);
            let step = if parts <= 2.0 { left / parts } else { pilot.control.step };
            outcome = self.attempt(step, if parts == 1.0 { pilot.end } else { self.state.t + step }, pilot);
        }
        pilot.front.keep(self);
        if self.state.t > target
            && let Some((taken, length)) = pilot.last
        {
            pilot.before.restore(self);
            self.interpolate(target, taken, length)?;
        }
        self.audit.follow(&shown);
        outcome
    }

    /// Puts the state at a time inside the last step, which took `length` s.
    fn interpolate(&mut self, target: f64, taken: Step, length: f64) -> Result<(), Failure> {
        let (system, start) = (self.system, self.state.t);
        let share = (target - start) / length;
        self.state.load(&mut self.work);
        self.integrator.interpolate(system, start, length, share, &mut self.newton, &mut self.work)?;
        let work = match taken.work {
            Work::Sum(done) => Work::Sum(share * done),
            other => other,
        };
        self.finish(Step { work, ..taken }, share * length, target).map(|_| ())
    }

    /// One attempt at a step; a step whose error is too large, or that fails, is taken back and the next one shorter.
    fn attempt(&mut self, step: f64, target: f64, pilot: &mut Pilot) -> Result<(), Failure> {
        if step < SMALLEST_SHARE * pilot.control.span {
            return Err(Failure::TooSmall);
        }
        pilot.before.keep(self);
        let outcome = self.substep(step, target).and_then(|taken| {
            self.smooth(step, pilot)?;
            Ok(taken)
        });
        let ratio = match &outcome {
            Ok(taken) => pilot.control.ratio(taken, step, self.state.t, &pilot.v, &mut self.work),
            Err(_) => f64::INFINITY,
        };
        if let (Ok(taken), true) = (outcome, ratio <= 1.0) {
            pilot.control.remember(self.state.t, &pilot.v);
            pilot.control.accept(step, ratio);
            pilot.last = Some((taken, step));
            return Ok(());
        }
        pilot.before.restore(self);
        self.audit.reject(&self.newton);
        pilot.control.reject(step, ratio);
        Ok(())
    }

    /// The velocities that errors are estimated from: those shown, or where the method leaves them off the constraints
    /// their projections.
    fn smooth(&mut self, step: f64, pilot: &mut Pilot) -> Result<(), Failure> {
        pilot.v.copy_from_slice(&self.shown_v);
        let Some(projection) = &pilot.smooth else { return Ok(()) };
        // The end of the step is the start of the next already.
        let work = &mut self.work;
        work.end.at.copy_from(&work.start.at);
        projection.apply(self.system, self.state.t, step, &mut self.newton, work)?;
        pilot.v.copy_from_slice(&work.end.v);
        Ok(())
    }
}
