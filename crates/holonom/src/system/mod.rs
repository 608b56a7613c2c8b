//! What is simulated: nodes, invariants, the laws acting on them, constant mass and known motion.
//!
//! A *node* is a point in space (or in the plane). Free nodes come first, nodes of known motion behind them, in one
//! vector `x = [q | known]` of `D` numbers a node, so that no formula asks which of the two a node is. Fixed places are
//! folded into the invariants as constants.

mod angle;
mod bends;
mod builder;
mod custom;
mod derive;
mod evaluate;
mod event;
mod function;
mod gauge;
mod invariant;
mod kinks;
mod law;
mod mass;
mod motion;
mod part;
mod potential;
mod reading;
mod respond;
mod rounding;
mod slots;
mod switches;
mod terms;

pub(crate) use bends::{Bending, Bends, Seen};
pub use builder::{NodeId, Place, SystemBuilder, Term};
pub use custom::{ConstraintFunction, CustomRows, Differences, Differentiated, ForceFunction, Number, SIZE};
pub(crate) use derive::NO_CHANGE;
pub use derive::{Derivatives, Followed, FollowedFunction, Pfaffian, PfaffianForm, Smooth, SmoothFunction};
pub use evaluate::{Between, Evaluation};
pub(crate) use evaluate::{Direction, Local, gather};
pub(crate) use event::PAST;
pub use event::{Crossing, Event, Indicator, Trigger};
pub use function::{FunctionId, Quantity};
pub(crate) use function::{FunctionValues, Functions};
pub(crate) use gauge::Gauges;
pub(crate) use gauge::Measured;
pub use gauge::{Form, GaugeValues};
pub(crate) use invariant::{HessianBlock, cross, skew};
pub use invariant::{InvariantId, Invariants};
pub use law::{Bend, Law, Load, MAX_ARGUMENTS, Reach, Response};
pub use mass::{Mass, MassBlock};
pub use motion::{Constant, EvenZeros, Signal};
pub(crate) use motion::{HalfSquare, Shifted};
pub use part::Part;
pub(crate) use reading::{Look, Slopes};
pub use reading::{Reading, Sense};
pub(crate) use rounding::Rounding;
pub(crate) use slots::RowSlot;
pub(crate) use slots::{Slots, add_along_rows, along, scatter, scatter_rows};
pub(crate) use switches::zeros;
pub(crate) use terms::{place_of, rate_of};

use std::borrow::Cow;
use std::sync::Arc;

use crate::linalg::Plans;

/// A constraint row Φ_k = π_k − c_k(t).
#[derive(Clone)]
pub(crate) struct Row {
    pub quantity: Quantity,
    target: Target,
    /// Whether nobody has written it as a constraint: it keeps the nodes of one thing where they are in that.
    pub is_implied: bool,
}

/// c of a row.
#[derive(Clone)]
enum Target {
    Constant(f64),
    Signal(Arc<dyn Signal>),
}

impl Row {
    pub fn new(quantity: Quantity, target: Arc<dyn Signal>) -> Self {
        let target = if target.is_constant() { Target::Constant(target.at(0.0)[0]) } else { Target::Signal(target) };
        Self { quantity, target, is_implied: false }
    }

    /// c, ċ and c̈ at a time.
    #[inline]
    pub fn target(&self, t: f64) -> [f64; 3] {
        match &self.target {
            Target::Constant(value) => [*value, 0.0, 0.0],
            Target::Signal(signal) => signal.at(t),
        }
    }

    pub fn is_constant(&self) -> bool {
        matches!(self.target, Target::Constant(_))
    }
}

/// A law acting on the quantities `arguments`, which depend on `invariants`, one after the other.
#[derive(Clone)]
pub(crate) struct LawEntry {
    pub name: String,
    pub arguments: Vec<Quantity>,
    pub invariants: Vec<InvariantId>,
    pub law: Arc<dyn Law>,
}

/// A load that acts on what it reads.
#[derive(Clone)]
pub(crate) struct LoadEntry {
    pub name: String,
    pub reading: Reading,
    /// The nodes that it reads, then those of its quantities.
    pub nodes: Vec<NodeId>,
    pub load: Arc<dyn Load>,
}

/// Constraint rows given as functions of coordinates and time.
#[derive(Clone)]
pub(crate) struct CustomEntry {
    pub name: String,
    pub nodes: Vec<NodeId>,
    pub rows: Arc<dyn CustomRows>,
}

/// How many do work on a system that its energy does not show: laws without a potential and loads, as [`System::working_forces`] numbers them, then
/// the rows that depend on time, then the nodes that move as time has it.
#[derive(Clone, Copy)]
pub(crate) struct Workers([usize; 4]);

impl Workers {
    pub fn count(self) -> usize {
        self.0.iter().sum()
    }

    /// Numbers of all of them as those of laws, loads, rows and nodes.
    #[inline]
    pub fn split(self, numbers: &mut [f64]) -> [&mut [f64]; 4] {
        let [laws, loads, rows, _] = self.0;
        let (of_laws, numbers) = numbers.split_at_mut(laws);
        let (of_loads, numbers) = numbers.split_at_mut(loads);
        let (of_rows, of_nodes) = numbers.split_at_mut(rows);
        [of_laws, of_loads, of_rows, of_nodes]
    }
}

/// A mechanism ready to be simulated. It never changes during a run.
#[derive(Clone)]
pub struct System {
    pub(crate) dim: usize,
    pub(crate) free: usize,
    pub(crate) mass: Mass,
    /// The weight on each node is (m 1 − s J) g, kg.
    pub(crate) weighing: Vec<[f64; 2]>,
    /// Whether each node is a point and not a direction.
    pub(crate) is_point: Vec<bool>,
    /// Where points are counted from, m: positions of systems far away lose no digits.
    pub(crate) origin: [f64; 3],
    pub(crate) gravity: [f64; 3],
    pub(crate) invariants: Invariants,
    pub(crate) functions: Functions,
    pub(crate) gauges: Gauges,
    /// The rows that hold velocities only: nonholonomic ones.
    pub(crate) velocity_rows: Vec<u32>,
    /// The rows that are no invariants but functions of them.
    pub(crate) function_rows: Vec<u32>,
    /// The rows that depend on time.
    pub(crate) driven_rows: Vec<u32>,
    /// How many laws have no potential.
    pub(crate) dissipative: usize,
    pub(crate) rows: Vec<Row>,
    pub(crate) custom: Vec<CustomEntry>,
    pub(crate) laws: Vec<LawEntry>,
    pub(crate) loads: Vec<LoadEntry>,
    pub(crate) motions: Vec<[Arc<dyn Signal>; 3]>,
    /// Functions of time at whose zeros forces or motions change abruptly.
    pub(crate) switches: Vec<Arc<dyn Signal>>,
    /// The laws and loads whose forces bend.
    pub(crate) bending: Bending,
    /// Names of the numbers from outside, and what they are until they are set.
    pub(crate) inputs: Vec<(String, f64)>,
    pub(crate) events: Vec<Event>,
    pub(crate) row_names: Vec<String>,
    pub(crate) start_position: Vec<f64>,
    pub(crate) start_velocity: Vec<f64>,
    /// What the momentum of all parts as written is more than that of the nodes with the start velocity, N·s; zero where no node
    /// is shared by parts that are written to move differently.
    pub(crate) start_impulse: Vec<f64>,
    /// Potential energy of what has weight and never moves, J.
    pub(crate) fixed_energy: f64,
    /// Largest mass that never moves, kg.
    pub(crate) fixed_mass: f64,
    /// Size of the mechanism as far as its nodes do not show it, m.
    pub(crate) size: f64,
    pub(crate) slots: Arc<Slots>,
    /// Of the eliminations that methods do with this system.
    pub(crate) plans: Arc<Plans>,
}

/// What has a corner.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Cornered {
    /// A row of the constraints.
    Row(usize),
    /// A law.
    Law(usize),
}

impl System {
    /// Takes part in the plans that other systems made and will make. Where systems have the same structure and differ in numbers
    /// only, such as the runs of a sweep, the elimination is planned once for all of them.
    pub fn share_plans(&mut self, plans: &Arc<Plans>) {
        self.plans = plans.clone();
    }

    /// Coordinates a node: 3 in space, 2 in the plane.
    pub fn dimension(&self) -> usize {
        self.dim
    }

    /// Number of unknown coordinates n.
    pub fn coordinates(&self) -> usize {
        self.dim * self.free
    }

    /// Number of nodes, free and known.
    pub fn nodes(&self) -> usize {
        self.free + self.motions.len()
    }

    /// Number of free nodes.
    pub fn free_nodes(&self) -> usize {
        self.free
    }

    /// Whether some rows hold velocities only.
    pub fn is_nonholonomic(&self) -> bool {
        !self.velocity_rows.is_empty()
    }

    /// The first row or law with a corner that a step between these evaluations goes across, and what happens there, in words.
    pub(crate) fn corner(&self, [from, to]: [&Evaluation; 2]) -> Option<(Cornered, &'static str)> {
        let across = |quantity: &Quantity| match quantity {
            Quantity::Function(id) => self.functions.corner(*id, [&from.value, &to.value]),
            Quantity::Invariant(_) => None,
        };
        let mut rows = self.function_rows.iter().map(|&row| row as usize);
        let row = rows.find_map(|row| Some((Cornered::Row(row), across(&self.rows[row].quantity)?)));
        let mut laws = self.laws.iter().enumerate();
        row.or_else(|| laws.find_map(|(k, law)| Some((Cornered::Law(k), law.arguments.iter().find_map(across)?))))
    }

    /// The name of what has a corner.
    pub(crate) fn cornered(&self, of: Cornered) -> &str {
        match of {
            Cornered::Row(row) => &self.row_names()[row],
            Cornered::Law(law) => &self.laws[law].name,
        }
    }

    /// Whether there is nothing but masses, weight and rows that are quadratic.
    pub fn has_only_quadratic_rows(&self) -> bool {
        self.laws.is_empty() && self.loads.is_empty() && self.custom.is_empty() && self.function_rows.is_empty()
    }

    /// Number of constraint rows r.
    pub fn constraints(&self) -> usize {
        self.row_names.len()
    }

    /// Gives the k-th row another target c(t).
    pub(crate) fn retarget(&mut self, row: usize, target: Arc<dyn Signal>) {
        self.rows[row] = Row::new(self.rows[row].quantity, target);
        self.find_driven_rows();
    }

    /// Notes which rows depend on time, as any that is a function of coordinates and time may.
    pub(crate) fn find_driven_rows(&mut self) {
        let known = self.rows.len();
        let driven = (0..self.constraints()).filter(|&row| row >= known || !self.rows[row].is_constant());
        self.driven_rows = driven.map(|row| row as u32).collect();
    }

    /// Names of the constraint rows (r), as `constraint` or `constraint[component]`.
    pub fn row_names(&self) -> &[String] {
        &self.row_names
    }

    /// Whether anything does work on the system that its energy does not show: known motion, dissipation, loads, rows
    /// that depend on time.
    pub(crate) fn is_worked_on(&self) -> bool {
        self.workers().count() > 0
    }

    /// Whether rows or nodes move as time has it.
    pub fn is_driven(&self) -> bool {
        !(self.driven_rows.is_empty() && self.motions.is_empty())
    }

    /// What does work on the system that its energy does not show.
    #[inline]
    pub(crate) fn workers(&self) -> Workers {
        Workers([self.dissipative, self.loads.len(), self.driven_rows.len(), self.motions.len()])
    }

    /// Names of the events that happen on a condition, and not with a period.
    pub fn conditions(&self) -> impl Iterator<Item = &str> {
        let of_condition = self.events.iter().filter(|event| matches!(event.trigger, Trigger::When(..)));
        of_condition.map(|event| event.name.as_str())
    }

    /// Names of the events.
    pub fn event_names(&self) -> impl Iterator<Item = &str> {
        self.events.iter().map(|event| event.name.as_str())
    }

    /// Names of the forces that do work beside the energy: dissipative laws, then loads.
    pub fn working_forces(&self) -> impl Iterator<Item = &str> {
        let laws = self.laws.iter().filter(|law| !law.law.conservative()).map(|law| law.name.as_str());
        laws.chain(self.loads.iter().map(|load| load.name.as_str()))
    }

    /// Where the coordinates of points are counted from, m, in the world; its origin but for systems that are far from it.
    pub fn origin(&self) -> [f64; 3] {
        self.origin
    }

    /// Positions of all nodes in the world (D × nodes), m, from those of a state.
    pub fn in_world<'x>(&self, x: &'x [f64]) -> Cow<'x, [f64]> {
        if self.origin == [0.0; 3] {
            return Cow::Borrowed(x);
        }
        let mut world = x.to_vec();
        for (x, _) in world.chunks_exact_mut(self.dim).zip(&self.is_point).filter(|(_, is_point)| **is_point) {
            x.iter_mut().zip(self.origin).for_each(|(x, origin)| *x += origin);
        }
        Cow::Owned(world)
    }

    /// A place in the world as the system counts it, m.
    pub fn of_world(&self, place: [f64; 3]) -> [f64; 3] {
        std::array::from_fn(|c| place[c] - self.origin[c])
    }

    /// Positions of all nodes as the model gives them (D × nodes), m, from [`System::origin`].
    pub fn start_position(&self) -> &[f64] {
        &self.start_position
    }

    /// Velocities of all nodes as the model gives them (D × nodes), m/s.
    pub fn start_velocity(&self) -> &[f64] {
        &self.start_velocity
    }

    /// Constant mass matrix over nodes.
    pub fn mass(&self) -> &Mass {
        &self.mass
    }

    /// Writes position, velocity and acceleration of the known nodes at time `t` into the tails of `x`, `v`, `a`.
    pub fn place_known(&self, t: f64, x: &mut [f64], v: &mut [f64], a: &mut [f64]) {
        let n = self.coordinates();
        for (k, motion) in self.motions.iter().enumerate() {
            for c in 0..self.dim {
                let [position, velocity, acceleration] = motion[c].at(t);
                let i = n + k * self.dim + c;
                x[i] = position - self.origin[c];
                v[i] = velocity;
                a[i] = acceleration;
            }
        }
    }
}
