//! One method at work on one mechanism, and whether it keeps its promises.

use cpu_time::ThreadTime;
use holonom::analysis;
use holonom::model::Model;
use holonom::simulation::{Choice, Method, NAMED, Named, Observer, Simulation, StartError, Status, Verdict};
use holonom::system::Evaluation;

use crate::mechanism::{Mechanism, STEPS};
use crate::natural;

/// Largest energy, momentum or violation of a row that no promise allows, over what it is measured by.
pub const BROKEN: f64 = 1e-9;

/// Share of the weight times its distance from the origin, and of the largest potential energy, that rounding may give or take as energy
/// in a run.
const ROUNDED: f64 = 1e-12;

/// Share of the kinetic energy of all mass at the speed of the mechanism that rounding of increments may give or take.
const STIRRED: f64 = 1e-20;

/// Share of the mechanism's speed by which velocities are measured where nothing moves: what rounding leaves of increments.
const SLOWEST: f64 = 1e-2;

/// Gradient of a row over its natural size beside which rounding of Φ alone, which goes with that size, comes to what is broken:
/// 1e3 roundings.
const VANISHED: f64 = 1e3 * f64::EPSILON / BROKEN;

/// Share of a step over which ∂Φ/∂t is taken: what the fourth order and rounding leave is far below what is broken.
const SPAN: f64 = 0.02;

/// How a run ended.
#[derive(Clone, Debug, PartialEq)]
pub enum Ending {
    /// With every promise kept.
    Kept,
    /// Before its end or its start, with a reason: honest.
    Stopped(String),
    Refused(String),
    /// Completed, with a promise broken.
    Broken(String),
    Slow(String),
    Panicked(String),
}

/// Worst figures of a completed run: energy, momentum, Φ and Φ̇ over what they are measured by.
#[derive(Clone, Copy, Debug)]
pub struct Figures {
    pub over_their_units: [f64; 4],
    /// The units, in those of the promises: J, kg·m/s, m and m/s.
    pub units: [f64; 4],
}

/// What the figures are of, as the table of methods calls it.
pub const PROMISES: [&str; 4] = ["energy", "momenta", "Φ", "Φ̇"];

/// A run with a method.
#[derive(Clone, Debug)]
pub struct Run {
    pub ending: Ending,
    pub figures: Option<Figures>,
    /// Of a processor, s.
    pub seconds: f64,
}

impl Run {
    pub fn without_figures(ending: Ending) -> Self {
        Self { ending, figures: None, seconds: 0.0 }
    }
}

/// Runs a method on a model that is given `limit` seconds.
pub fn run(mechanism: &Mechanism, model: &Model, named: &Named, limit: f64) -> Run {
    let method = Method::resolve(&Choice { method: Some(named.name.into()), ..Choice::default() }).expect("a method with a name");
    let clock = ThreadTime::now();
    let mut simulation = match Simulation::new(model.system.clone(), method, mechanism.step()) {
        Ok(simulation) => simulation,
        Err(error) => return Run::without_figures(Ending::Refused(refusal(&error).into())),
    };
    if mechanism.reactions {
        simulation.find_reactions();
    }
    let mut watch = Watch::new(mechanism, model, clock, limit);
    let status = simulation.run(mechanism.end(), &mut watch);
    let seconds = clock.elapsed().as_secs_f64();
    let slow = || Ending::Slow(format!("more than {limit} s, at step {} of {STEPS}", simulation.steps()));
    match status {
        _ if watch.is_late => Run { ending: slow(), figures: None, seconds },
        Status::Stopped { reason, .. } => Run { ending: Ending::Stopped(reason), figures: None, seconds },
        Status::Completed => {
            let figures = watch.figures(mechanism, model, &simulation);
            Run { ending: ending(&figures, named), figures: Some(figures), seconds }
        }
    }
}

fn refusal(error: &StartError) -> &'static str {
    match error {
        StartError::Position { .. } => "positions at the start cannot be corrected",
        StartError::Velocity { .. } => "velocities at the start cannot be corrected",
        StartError::Nonholonomic { .. } => "rows that hold velocities",
        StartError::Step { .. } => "a step that leads nowhere",
        StartError::Crowded { .. } => "too many rows on one node",
        StartError::Acceleration => "accelerations at the start cannot be found",
        StartError::NotFinite { .. } => "forces at the start are not finite",
        StartError::NoNumber => "a state that is not finite",
        StartError::Other => "a state of another system",
    }
}

/// Whether a method has kept what it promises in the table of methods.
fn ending(figures: &Figures, named: &Named) -> Ending {
    let choice = Choice { method: Some(named.name.into()), ..Choice::default() };
    let promises = Method::resolve(&choice).expect("a named method goes together").promises();
    let promised = |promise: &str| promises.iter().any(|kept| kept.words() == promise);
    let is_broken = |&(promise, figure): &(&str, f64)| promised(promise) && (figure.is_nan() || figure > BROKEN);
    let broken: Vec<String> = PROMISES
        .into_iter()
        .zip(figures.over_their_units)
        .filter(is_broken)
        .map(|(promise, figure)| format!("{promise} {figure:.1e}"))
        .collect();
    if broken.is_empty() { Ending::Kept } else { Ending::Broken(broken.join(", ")) }
}

/// Looks at every step.
struct Watch<'a> {
    model: &'a Model,
    clock: ThreadTime,
    limit: f64,
    is_late: bool,
    at: Evaluation,
    phi: Vec<f64>,
    /// Time over which ∂Φ/∂t is taken where rows depend on it, s, and that of each row.
    span: Option<f64>,
    by_time: Vec<f64>,
    /// Largest |Φ|, |Φ̇| and gradient of each row so far.
    rows: Vec<[f64; 3]>,
    speed: f64,
    kinetic: f64,
    work: f64,
    potential: [f64; 2],
}

impl<'a> Watch<'a> {
    fn new(mechanism: &Mechanism, model: &'a Model, clock: ThreadTime, limit: f64) -> Self {
        let system = &model.system;
        let rows = system.constraints();
        Self {
            model,
            clock,
            limit,
            is_late: false,
            at: system.evaluation(),
            phi: vec![0.0; rows],
            span: mechanism.depends_on_time().then(|| SPAN * mechanism.step()),
            by_time: vec![0.0; rows],
            rows: vec![[0.0; 3]; rows],
            speed: 0.0,
            kinetic: 0.0,
            work: 0.0,
            potential: [f64::INFINITY, f64::NEG_INFINITY],
        }
    }
}

impl Observer for Watch<'_> {
    fn after_step(&mut self, simulation: &Simulation) -> Verdict {
        let (system, state, audit) = (&self.model.system, simulation.state(), simulation.audit());
        // Between nominal steps, which may be taken in parts, angles may make half a turn and more.
        self.at.count_on(&state.angle);
        system.evaluate_again(&state.x, state.t, &mut self.at);
        system.constraint_values(&self.at, state.t, &mut self.phi);
        self.take_by_time(simulation);
        let gradients = analysis::constraint_jacobian(system, &state.x, state.t);
        for (((worst, gradient), phi), by_time) in self.rows.iter_mut().zip(&gradients).zip(&self.phi).zip(&self.by_time) {
            let rate: f64 = by_time + gradient.iter().zip(simulation.velocities()).map(|(g, v)| g * v).sum::<f64>();
            *worst = [larger(worst[0], *phi), larger(worst[1], rate), larger(worst[2], natural::length(gradient))];
        }
        self.speed = simulation.velocities().iter().fold(self.speed, |m, v| larger(m, *v));
        (self.kinetic, self.work) = (larger(self.kinetic, audit.kinetic), larger(self.work, audit.work));
        self.potential = [self.potential[0].min(audit.potential), self.potential[1].max(audit.potential)];
        self.is_late = self.clock.elapsed().as_secs_f64() > self.limit;
        if self.is_late { Verdict::Stop } else { Verdict::GoOn }
    }
}

/// The larger of a size and that of a number; what is no number is largest.
fn larger(size: f64, number: f64) -> f64 {
    if number.is_nan() || number.abs() > size { number.abs() } else { size }
}

impl Watch<'_> {
    /// ∂Φ/∂t with all nodes held, where rows depend on time: differences of fourth order, which are none of
    /// the engine's, forward as splines begin at the start.
    fn take_by_time(&mut self, simulation: &Simulation) {
        let Some(span) = self.span else { return };
        let (system, state) = (&self.model.system, simulation.state());
        let mut phi = vec![0.0; self.phi.len()];
        self.by_time.fill(0.0);
        for (places, weight) in [(0.0, -25.0), (1.0, 48.0), (2.0, -36.0), (3.0, 16.0), (4.0, -3.0)] {
            let t = state.t + places * span;
            system.evaluate_again(&state.x, t, &mut self.at);
            system.constraint_values(&self.at, t, &mut phi);
            self.by_time.iter_mut().zip(&phi).for_each(|(rate, phi)| *rate += weight * phi / (12.0 * span));
        }
    }

    /// Energy is measured by what was exchanged: the largest kinetic energy, the range of the potential one and the work.
    /// What rounding of weights and increments may come to counts where next to nothing is, as with structures and with
    /// light parts beside heavy ones. Rows are measured in lengths, by their gradients or, where these vanish, by what they are
    /// elsewhere, and over the size and the speed of the mechanism. Rows that hold nothing anywhere are left out.
    fn figures(&self, mechanism: &Mechanism, model: &Model, simulation: &Simulation) -> Figures {
        let audit = simulation.audit();
        let mass: f64 = model.bodies.iter().map(|body| body.mass).chain(model.points.iter().map(|point| point.mass)).sum();
        let nominal = mechanism.size * mechanism.rate;
        let stored = self.potential[0].abs().max(self.potential[1].abs());
        let rounded = ROUNDED * (mechanism.weight + stored) + STIRRED * mass * nominal * nominal;
        let exchanged = self.kinetic + (self.potential[1] - self.potential[0]) + self.work;
        let speed = self.speed.max(SLOWEST * nominal);
        let units = [exchanged + rounded / BROKEN, mass * speed, mechanism.size, speed];
        let drift = audit.momentum_summary();
        let momentum = drift.linear_drift + drift.angular_drift / mechanism.size;
        let natural = natural::gradients(&model.system, mechanism.size);
        let worst = |which: usize| {
            let in_lengths = |(row, natural): (&[f64; 3], &f64)| row[which] / if row[2] > VANISHED * natural { row[2] } else { *natural };
            self.rows.iter().zip(&natural).map(in_lengths).fold(0.0, larger)
        };
        let figures = [audit.energy_summary().max_drift, momentum, worst(0), worst(1)];
        Figures { over_their_units: std::array::from_fn(|k| figures[k] / units[k]), units }
    }
}

/// The methods that are run: the two that keep energy, or all that have a name.
pub fn methods(all: bool) -> impl Iterator<Item = &'static Named> {
    NAMED.iter().filter(move |named| all || ["conserving-ggl", "conserving"].contains(&named.name))
}
