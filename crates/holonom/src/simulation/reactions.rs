//! Forces of the constraints, by the index-1 system (3) at the states shown (methods §17).

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::Arc;

use serde::{Deserialize, Serialize};

use super::start::on_rows;
use super::{Method, Simulation};
use crate::formulation::{Newton, Sure, Twists, Workspace};
use crate::system::{Evaluation, NodeId, Quantity, Sense, System, Term, place_of, rate_of};

/// Forces of the constraints at a state, of the order of its positions and velocities.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Reactions {
    /// Multipliers λ (r).
    #[serde(with = "super::any_number")]
    pub lambda: Vec<f64>,
    /// Accelerations of all nodes (D × nodes), m/s².
    #[serde(with = "super::any_number")]
    pub a: Vec<f64>,
}

/// The same mechanism as that of a system in which bodies share nodes, with nodes of its own for each body: what the shared ones stand
/// for are rows here, whose multipliers tell the forces of all joints.
#[derive(Clone)]
pub struct Apart {
    system: Arc<System>,
    /// Each free node as a sum of the nodes of the other system.
    nodes: Arc<[Vec<Term>]>,
    /// The nodes of each rigid body, in the order of the rows that keep them rigid.
    bodies: Arc<[Vec<NodeId>]>,
}

impl Apart {
    /// # Panics
    /// When there is not one sum for each free node.
    pub(crate) fn new(system: Arc<System>, nodes: Vec<Vec<Term>>, bodies: Vec<Vec<NodeId>>) -> Self {
        assert_eq!(nodes.len(), system.free, "a sum for each free node");
        Self { system, nodes: nodes.into(), bodies: bodies.into() }
    }

    /// The system with nodes of its own for each body.
    pub fn system(&self) -> &System {
        &self.system
    }
}

/// What the angles of a system are counted for, whose turns decide on forces and slopes: rows, laws or loads of one name, without the index of a row
/// or of a repeated entry, as bodies that share nodes have fewer rows.
#[derive(PartialEq, Eq, PartialOrd, Ord)]
enum Counts<'s> {
    Rows(&'s str),
    Laws(&'s str),
    Loads(&'s str),
}

/// Places of the angles whose turns are counted, of one function after the other, by what has them.
fn counted(system: &System) -> BTreeMap<Counts<'_>, Vec<Range<usize>>> {
    fn entry(name: &str) -> &str {
        name.split('[').next().unwrap_or(name)
    }
    let of_rows = system.rows.iter().zip(&system.row_names).map(|(row, name)| (Counts::Rows(entry(name)), row.quantity));
    let of_laws = system.laws.iter().flat_map(|law| law.arguments.iter().map(|&argument| (Counts::Laws(entry(&law.name)), argument)));
    let senses = system.loads.iter().flat_map(|load| load.reading.senses.iter().map(|sense| (Counts::Loads(entry(&load.name)), sense)));
    let of_loads = senses.filter_map(|(of, sense)| if let Sense::Quantity(quantity) = sense { Some((of, *quantity)) } else { None });
    let mut found = BTreeMap::<_, Vec<_>>::new();
    for (of, quantity) in of_rows.chain(of_laws).chain(of_loads) {
        let Quantity::Function(function) = quantity else { continue };
        let angles = system.functions.angles_of(function);
        if !angles.is_empty() {
            found.entry(of).or_default().push(angles);
        }
    }
    found
}

/// Has angles of a system counted on from those of another one, of which both have places.
fn count_on(counted: &[[Range<usize>; 2]], work: &mut Workspace, other: &[f64]) {
    for [own, others] in counted {
        work.start.at.functions.angle[own.clone()].copy_from_slice(&other[others.clone()]);
    }
}

/// Where the forces of the constraints are found apart from the steps: in another system than the one that moves, or in the same.
pub(super) struct Elsewhere {
    own: Arc<System>,
    /// The other system.
    pub apart: Option<Apart>,
    /// Places of the angles whose turns are counted, there and in the system that moves.
    counted: Vec<[Range<usize>; 2]>,
    matrix: Matrix,
    sure: Option<Sure>,
    work: Workspace,
}

/// The matrix of the system in which forces are found: in the twists of its bodies, or in the coordinates of all nodes.
enum Matrix {
    Twists(Box<Twists>),
    Nodes(Box<Newton>),
}

impl Elsewhere {
    /// In the system that moves, of which is known what rows must add to be sure.
    fn in_own(own: &Arc<System>, method: &Method, sure: Option<Sure>) -> Self {
        let mut work = Workspace::new(own);
        let matrix = Matrix::Nodes(Box::new(Newton::new(own, &work.scales, method.settings)));
        let all = 0..own.functions.values().angle.len();
        work.leave_steps();
        Self { own: Arc::clone(own), apart: None, counted: vec![[all.clone(), all]], sure, work, matrix }
    }

    fn new(apart: Apart, own: &Arc<System>, method: &Method) -> Self {
        let mut work = Workspace::new(&apart.system);
        let mut matrix = match Twists::new(&apart.system, &work.scales, &apart.bodies) {
            Some(twists) => Matrix::Twists(Box::new(twists)),
            None => Matrix::Nodes(Box::new(Newton::new(&apart.system, &work.scales, method.settings))),
        };
        let (mine, mut theirs) = (counted(&apart.system), counted(own));
        let alike = mine.into_iter().filter_map(|(of, mine)| Some((mine, theirs.remove(&of)?)));
        let alike = alike.filter(|(mine, theirs)| mine.len() == theirs.len());
        let pairs = alike.flat_map(|(mine, theirs)| mine.into_iter().zip(theirs).map(|(mine, theirs)| [mine, theirs]));
        let counted: Vec<_> = pairs.filter(|[mine, theirs]| mine.len() == theirs.len()).collect();
        count_on(&counted, &mut work, &own.functions.values().angle);
        work.end.x.copy_from_slice(&work.start.x);
        apart.system.evaluate(&work.end.x, 0.0, &work.start.at, &mut work.end.at);
        let sure = match &mut matrix {
            Matrix::Twists(twists) => twists.sure(&apart.system, &work),
            Matrix::Nodes(newton) => newton.sure(&apart.system, &work),
        };
        work.leave_steps();
        Self { own: Arc::clone(own), apart: Some(apart), counted, sure, work, matrix }
    }

    /// Puts its nodes where those of the system that moves are and finds the forces.
    fn react(&mut self, Snapshot { t, x, v, angles, inputs }: Snapshot<'_>, reactions: &mut Reactions) {
        let Self { own, apart, counted, matrix, sure, work } = self;
        let system = match apart {
            None => {
                work.end.x.copy_from_slice(x);
                work.end.v.copy_from_slice(v);
                &**own
            }
            Some(Apart { system, nodes, .. }) => {
                let (dim, x) = (system.dim, own.in_world(x));
                for (k, terms) in nodes.iter().enumerate() {
                    let origin = if system.is_point[k] { system.origin } else { [0.0; 3] };
                    let (position, velocity) = (place_of(terms, &x, dim), rate_of(terms, v, dim));
                    for c in 0..dim {
                        work.end.x[k * dim + c] = position[c] - origin[c];
                        work.end.v[k * dim + c] = velocity[c];
                    }
                }
                &**system
            }
        };
        system.place_known(t, &mut work.end.x, &mut work.end.v, &mut work.a);
        count_on(counted, work, angles);
        work.inputs.copy_from_slice(inputs);
        system.evaluate(&work.end.x, t, &work.start.at, &mut work.end.at);
        work.start.at.functions.angle.copy_from_slice(&work.end.at.functions.angle);
        work.lambda.fill(0.0);
        let outcome = match matrix {
            Matrix::Twists(twists) => twists.show_reactions(sure.as_ref(), system, t, work),
            Matrix::Nodes(newton) => newton.show_reactions(sure.as_ref(), system, t, work),
        };
        reactions.take(outcome == Ok(true), work);
    }

    /// What was found there last.
    fn found<'a>(&'a self, reactions: Option<&'a Reactions>) -> Found<'a> {
        let Self { own, apart, work, .. } = self;
        let system = apart.as_ref().map_or(own, |apart| &apart.system);
        Found { system, at: &work.end.at, x: &work.end.x, v: &work.end.v, reactions, is_apart: apart.is_some() }
    }
}

/// A state as far as forces of the constraints follow from it.
#[derive(Clone, Copy)]
struct Snapshot<'a> {
    /// s
    t: f64,
    /// Positions of all nodes from the origin of their system (D × nodes), m, and their velocities, m/s.
    x: &'a [f64],
    v: &'a [f64],
    /// Of all functions, with their turns.
    angles: &'a [f64],
    inputs: &'a [f64],
}

/// Forces of the constraints: the system that they are found in, at a state, and what was found there.
#[derive(Clone, Copy)]
pub(crate) struct Found<'a> {
    pub system: &'a System,
    /// Its values and gradients.
    pub at: &'a Evaluation,
    /// Positions of its nodes from its origin (D × nodes), m, and their velocities, m/s.
    x: &'a [f64],
    pub v: &'a [f64],
    /// `None` unless they were asked for.
    pub reactions: Option<&'a Reactions>,
    /// Whether it is another system than the one that moves.
    pub is_apart: bool,
}

impl<'a> Found<'a> {
    /// Positions of all nodes in the world (D × nodes), m.
    pub fn positions(&self) -> Cow<'a, [f64]> {
        self.system.in_world(self.x)
    }

    /// As [`Simulation::wrench`] has it.
    pub fn wrench(&self, rows: Range<usize>, nodes: &[(NodeId, bool)], about: [f64; 3]) -> Option<([f64; 3], [f64; 3])> {
        let Self { system, at, x, reactions, .. } = self;
        Some(wrench(system, rows, &(*reactions)?.lambda, &at.gradient, nodes, system.of_world(about), x))
    }

    /// As [`Simulation::constraint_forces`] has it.
    pub fn constraint_forces(&self) -> Option<Vec<f64>> {
        let Reactions { lambda, a } = self.reactions?;
        let mut force = vec![0.0; a.len()];
        self.system.slots.add_forces(self.system.dim, lambda, &self.at.gradient, &mut force);
        force.iter_mut().for_each(|force| *force = -*force);
        Some(force)
    }
}

/// Finds the forces of the constraints of a simulation apart from it, at states that it was shown one after the other.
pub struct Finder {
    elsewhere: Box<Elsewhere>,
    reactions: Reactions,
    /// How many numbers a snapshot has of positions, velocities, angles and inputs.
    lengths: [usize; 4],
}

impl Finder {
    /// Finds them at the time `t` of a [snapshot](Simulation::append_snapshot).
    pub(crate) fn find(&mut self, t: f64, snapshot: &[f64]) {
        let mut rest = snapshot;
        let [x, v, angles, inputs] = self.lengths.map(|length| rest.split_off(..length).expect("a snapshot has all of it"));
        self.elsewhere.react(Snapshot { t, x, v, angles, inputs }, &mut self.reactions);
    }

    /// What was found last.
    pub(crate) fn found(&self) -> Found<'_> {
        self.elsewhere.found(Some(&self.reactions))
    }

    /// Of the last state.
    pub(crate) fn reactions(&self) -> &Reactions {
        &self.reactions
    }
}

impl Reactions {
    fn new(system: &System) -> Self {
        let (r, all) = (system.constraints(), system.nodes() * system.dim);
        Self { lambda: vec![0.0; r], a: vec![0.0; all] }
    }

    fn take(&mut self, are_known: bool, work: &Workspace) {
        if !are_known {
            return self.forget();
        }
        self.lambda.copy_from_slice(&work.lambda);
        self.a.copy_from_slice(&work.a);
    }

    fn forget(&mut self) {
        self.lambda.fill(f64::NAN);
        self.a.fill(f64::NAN);
    }
}

impl Simulation {
    /// Has the forces of the constraints found at the start and after the steps whose [observer](super::Observer) wants them. A run that is
    /// resumed has them already where the one before had them.
    pub fn find_reactions(&mut self) {
        if self.reactions.is_none() {
            self.reactions = Some(Reactions::new(&self.system));
            self.update_reactions();
        }
    }

    /// The same for a system in which bodies share nodes, by one in which they do not: multipliers and accelerations are then those of that
    /// system.
    pub fn find_reactions_apart(&mut self, apart: &Apart) {
        self.apart = Some(Box::new(Elsewhere::new(apart.clone(), &self.system, &self.method)));
        let kept = self.reactions.replace(Reactions::new(&apart.system)).filter(|kept| kept.lambda.len() == apart.system.constraints());
        self.update_reactions();
        self.reactions = kept.or(self.reactions.take());
    }

    /// Lends what finds the forces of the constraints apart from the steps. Until it is [back](Simulation::take_back), no forces are found here. `None`
    /// where they were not asked for, and where they are those of a penalty, which are of the steps.
    pub(crate) fn lend_finder(&mut self) -> Option<Finder> {
        if self.method.formulation.soft && self.apart.is_none() {
            return None;
        }
        let reactions = self.reactions.take()?;
        let elsewhere = match self.apart.take() {
            Some(elsewhere) => elsewhere,
            None => {
                // A resumed run has not asked for it yet.
                self.find_what_is_sure();
                Box::new(Elsewhere::in_own(&self.system, &self.method, self.sure.take().flatten()))
            }
        };
        let (nodes, at) = (self.system.nodes() * self.system.dim, &self.work.start.at);
        let lengths = [nodes, nodes, at.functions.angle.len(), self.state.inputs.len()];
        Some(Finder { elsewhere, reactions, lengths })
    }

    /// Takes back what was lent.
    pub(crate) fn take_back(&mut self, finder: Finder) {
        self.reactions = Some(finder.reactions);
        match finder.elsewhere.apart {
            Some(_) => self.apart = Some(finder.elsewhere),
            None => self.sure = Some(finder.elsewhere.sure),
        }
    }

    /// Appends what a [finder](Finder) needs of the present state.
    pub(crate) fn append_snapshot(&self, to: &mut Vec<f64>) {
        let angles = &self.work.start.at.functions.angle;
        [&self.state.x, &self.shown_v, angles, &self.state.inputs].into_iter().for_each(|numbers| to.extend_from_slice(numbers));
    }

    /// Forces of the constraints where they are found, if they were asked for.
    pub(crate) fn found(&self) -> Found<'_> {
        let reactions = self.reactions.as_ref();
        match &self.apart {
            Some(elsewhere) => elsewhere.found(reactions),
            None => Found { system: &self.system, at: &self.work.start.at, x: &self.state.x, v: &self.shown_v, reactions, is_apart: false },
        }
    }

    /// Forces of the constraints after the last step, if they were asked for. What was set since counts once they are
    /// [found anew](Simulation::update_reactions).
    pub fn reactions(&self) -> Option<&Reactions> {
        self.reactions.as_ref()
    }

    /// Positions of the nodes of the system whose forces of the constraints are found, on its rows and nearest to the present ones, m: methods with a
    /// penalty, and others that do not hold positions, leave the rows.
    pub(crate) fn reacting_x_on_rows(&self) -> Vec<f64> {
        let Found { system, at, x, .. } = self.found();
        on_rows(system, x, self.state.t, &at.functions.angle)
    }

    /// Positions of all nodes in the world (D × nodes), m, of the system whose forces of the constraints are found.
    pub fn reacting_positions(&self) -> Cow<'_, [f64]> {
        self.found().positions()
    }

    /// Forces of the constraints on the nodes of the [reacting](Simulation::reacting_positions) system, −Gᵀλ (D × nodes), N, at the present state.
    /// Redundant rows leave λ undetermined, not these. `None` unless they were asked for.
    pub fn constraint_forces(&self) -> Option<Vec<f64>> {
        self.found().constraint_forces()
    }

    /// Force (3) and moment about a place (3) of some rows on some nodes, points or directions, at the present state, N
    /// and N·m. `None` unless forces of the constraints were asked for.
    pub fn wrench(&self, rows: Range<usize>, nodes: &[(NodeId, bool)], about: [f64; 3]) -> Option<([f64; 3], [f64; 3])> {
        self.found().wrench(rows, nodes, about)
    }

    /// Finds the forces of the constraints at the present state, where they were asked for.
    pub fn update_reactions(&mut self) {
        let Self { reactions: Some(reactions), apart, state, shown_v, .. } = self else { return };
        if let Some(elsewhere) = apart {
            let angles = &self.work.start.at.functions.angle;
            elsewhere.react(Snapshot { t: state.t, x: &state.x, v: shown_v, angles, inputs: &state.inputs }, reactions);
            return;
        }
        if reactions.lambda.len() != self.system.constraints() {
            // A resumed run of which nobody has said where its forces are found.
            return reactions.forget();
        }
        // A penalty's force is its own; that of every other formulation errs, and the constraints' is meant.
        let is_own = self.method.formulation.soft;
        if !is_own {
            self.find_what_is_sure();
        }
        let (system, newton, work, state) = (&*self.system, &mut self.newton, &mut self.work, &self.state);
        let counters = (newton.iterations, newton.factorizations);
        work.end.x.copy_from_slice(&state.x);
        work.end.v.copy_from_slice(&self.shown_v);
        work.a.copy_from_slice(&state.a);
        work.lambda.fill(0.0);
        system.place_known(state.t, &mut work.end.x, &mut work.end.v, &mut work.a);
        let outcome = match is_own {
            true => newton.accelerate(system, state.t, work),
            false => {
                work.end.at.copy_from(&work.start.at);
                newton.show_reactions(self.sure.as_ref().and_then(Option::as_ref), system, state.t, work)
            }
        };
        if let Some(reactions) = &mut self.reactions {
            reactions.take(outcome == Ok(true), work);
        }
        self.go_on_from(counters);
    }

    /// Finds what rows must add to be sure, by what they add at the start, unless that is known.
    fn find_what_is_sure(&mut self) {
        if self.sure.is_some() {
            return;
        }
        let (system, newton, work) = (&*self.system, &mut self.newton, &mut self.work);
        let counters = (newton.iterations, newton.factorizations);
        work.end.x.copy_from_slice(&system.start_position);
        system.evaluate(&work.end.x, 0.0, &work.start.at, &mut work.end.at);
        self.sure = Some(newton.sure(system, work));
        self.go_on_from(counters);
    }

    /// Has the next step be the same as if nobody had looked, with these numbers of iterations and factorisations.
    fn go_on_from(&mut self, counters: (u64, u64)) {
        self.hints.restore(&mut self.newton, &mut *self.integrator);
        (self.newton.iterations, self.newton.factorizations) = counters;
    }
}

/// Force (3) and moment about a place (3) of some rows with the multipliers `lambda` and gradients (D a slot) on some nodes,
/// points or directions, at the positions `x`.
pub(crate) fn wrench(
    system: &System,
    rows: Range<usize>,
    lambda: &[f64],
    gradient: &[f64],
    nodes: &[(NodeId, bool)],
    about: [f64; 3],
    x: &[f64],
) -> ([f64; 3], [f64; 3]) {
    let (dim, slots) = (system.dim, &system.slots);
    let (mut force, mut moment) = ([0.0; 3], [0.0; 3]);
    for &(node, is_point) in nodes {
        let (mut push, mut arm) = ([0.0; 3], [0.0; 3]);
        for row in rows.clone() {
            for s in slots.rows[row].clone().filter(|&s| slots.nodes[s] as usize == node.index()) {
                push.iter_mut().zip(&gradient[s * dim..(s + 1) * dim]).for_each(|(push, g)| *push -= lambda[row] * g);
            }
        }
        (0..dim).for_each(|c| arm[c] = x[node.index() * dim + c] - if is_point { about[c] } else { 0.0 });
        for c in 0..3 {
            let (i, j) = ((c + 1) % 3, (c + 2) % 3);
            force[c] += if is_point { push[c] } else { 0.0 };
            moment[c] += arm[i] * push[j] - arm[j] * push[i];
        }
    }
    (force, moment)
}
