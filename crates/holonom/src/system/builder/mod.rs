//! From nodes, invariants and laws, one call each, to a [`System`](super::System).

mod finish;

use std::sync::Arc;

use super::function::{FunctionId, Functions, Quantity};
use super::gauge::{Form, Gauges};
use super::part::Part;
use super::{
    Constant, CustomEntry, CustomRows, Event, InvariantId, Invariants, Law, LawEntry, Load, LoadEntry, MAX_ARGUMENTS, MassBlock, Reading,
    Row, Sense, Signal,
};

/// A node of a [`SystemBuilder`] and of the system it makes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct NodeId(pub(crate) u32);

impl NodeId {
    /// Position of the node in the vector `x = [q | known]`, in nodes.
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// Something with a position: a node, or a place that never moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Place {
    /// Where a node is.
    Node(NodeId),
    /// World coordinates (the first D are used), m.
    Fixed([f64; 3]),
}

/// A summand of a point or direction: f x + g J x, with J the quarter turn of a planar model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Term {
    /// x: a node, or a place that never moves.
    pub place: Place,
    /// f
    pub factor: f64,
    /// g, 0 in space.
    pub turn: f64,
}

impl From<(Place, f64)> for Term {
    fn from((place, factor): (Place, f64)) -> Self {
        Self { place, factor, turn: 0.0 }
    }
}

fn terms<T: Into<Term> + Copy>(terms: &[T]) -> Vec<Term> {
    terms.iter().map(|&term| term.into()).collect()
}

/// Collects a system piece by piece. Free nodes must be added before known ones.
#[derive(Clone)]
pub struct SystemBuilder {
    dim: usize,
    free: usize,
    gravity: [f64; 3],
    mass: Vec<(u32, u32, MassBlock)>,
    weight: Vec<(u32, [f64; 2])>,
    invariants: Invariants,
    functions: Functions,
    pub(super) gauges: Gauges,
    rows: Vec<Row>,
    row_names: Vec<String>,
    custom: Vec<CustomEntry>,
    laws: Vec<LawEntry>,
    loads: Vec<LoadEntry>,
    motions: Vec<[Arc<dyn Signal>; 3]>,
    switches: Vec<Arc<dyn Signal>>,
    inputs: Vec<(String, f64)>,
    events: Vec<Event>,
    directions: Vec<u32>,
    position: Vec<f64>,
    velocity: Vec<f64>,
    /// Parts that are written with velocities of their own.
    moving: Vec<Moving>,
    /// Σ m x of what has weight at places that never move, kg·m.
    fixed_moment: [f64; 3],
    /// Largest mass at such a place, kg.
    fixed_mass: f64,
    size: f64,
}

/// A part of the mass matrix with the velocity of its second node as it is written for this part.
#[derive(Clone)]
struct Moving {
    a: u32,
    b: Place,
    block: MassBlock,
    /// m/s
    velocity: [f64; 3],
}

impl SystemBuilder {
    /// An empty system of `dim` = 2 or 3 coordinates a node with gravity in its axes, m/s².
    pub fn new(dim: usize, gravity: [f64; 3]) -> Self {
        assert!(dim == 2 || dim == 3, "a node has two or three coordinates");
        Self {
            dim,
            free: 0,
            gravity,
            mass: Vec::new(),
            weight: Vec::new(),
            invariants: Invariants::new(dim),
            functions: Functions::default(),
            gauges: Gauges::new(dim),
            rows: Vec::new(),
            row_names: Vec::new(),
            custom: Vec::new(),
            laws: Vec::new(),
            loads: Vec::new(),
            motions: Vec::new(),
            switches: Vec::new(),
            inputs: Vec::new(),
            events: Vec::new(),
            directions: Vec::new(),
            position: Vec::new(),
            velocity: Vec::new(),
            moving: Vec::new(),
            fixed_moment: [0.0; 3],
            fixed_mass: 0.0,
            size: 0.0,
        }
    }

    /// The size of the mechanism that was set, m.
    pub fn size(&self) -> f64 {
        self.size
    }

    /// Sets the size of the mechanism (m) where its nodes may not show it, as those of a single body at the origin.
    pub fn set_size(&mut self, size: f64) {
        self.size = size;
    }

    /// Coordinates a node.
    pub fn dimension(&self) -> usize {
        self.dim
    }

    /// Nodes so far whose motion is sought.
    pub fn free_nodes(&self) -> usize {
        self.free
    }

    /// Adds a node whose motion is sought, with its position (m) and velocity (m/s) at the start.
    ///
    /// # Panics
    /// When a known node has been added before.
    pub fn free_node(&mut self, position: [f64; 3], velocity: [f64; 3]) -> NodeId {
        assert!(self.motions.is_empty(), "free nodes come before known ones");
        self.position.extend_from_slice(&position[..self.dim]);
        self.velocity.extend_from_slice(&velocity[..self.dim]);
        self.free += 1;
        NodeId(self.free as u32 - 1)
    }

    /// Adds a node that is a direction and not a point: it turns with the mechanism and does not move along with it.
    ///
    /// # Panics
    /// When a known node has been added before.
    pub fn free_direction(&mut self, direction: [f64; 3], rate: [f64; 3]) -> NodeId {
        let node = self.free_node(direction, rate);
        self.directions.push(node.0);
        node
    }

    /// Adds a node whose motion is a known function of time, one signal a coordinate (m).
    pub fn known_node(&mut self, motion: [Arc<dyn Signal>; 3]) -> NodeId {
        for signal in &motion[..self.dim] {
            let [position, velocity, _] = signal.at(0.0);
            self.position.push(position);
            self.velocity.push(velocity);
        }
        self.motions.push(motion);
        NodeId((self.free + self.motions.len()) as u32 - 1)
    }

    /// Adds the block m 1 + s J (kg) to (a, b) of the mass matrix, and its transpose to (b, a), of something that moves as if `a` and `b` had these
    /// velocities at the start, m/s; without weight.
    pub fn couple(&mut self, [a, b]: [Place; 2], m: f64, s: f64, [of_a, of_b]: [[f64; 3]; 2]) {
        self.inertia(a, b, m, s);
        self.moves(a, b, m, s, of_b);
        if a != b {
            self.moves(b, a, m, -s, of_a);
        }
    }

    /// Adds `m` (kg) of points to the entries (a, b) and (b, a) of the mass matrix, once when a = b, and its weight to
    /// both. What belongs to a fixed place never moves: of it only the weight is kept.
    pub fn mass(&mut self, a: Place, b: Place, m: f64) {
        self.couple([a, b], m, 0.0, [a, b].map(|place| self.velocity_of(place)));
        self.weight((a, 1.0).into(), m);
        if a != b {
            self.weight((b, 1.0).into(), m);
        }
    }

    /// Whether a node is a direction.
    pub fn is_direction(&self, node: NodeId) -> bool {
        // They are known in the order in which they were added.
        self.directions.binary_search(&node.0).is_ok()
    }

    /// Position of a node at the start, m.
    pub fn position_of(&self, node: NodeId) -> [f64; 3] {
        let mut position = [0.0; 3];
        position[..self.dim].copy_from_slice(&self.position[node.index() * self.dim..(node.index() + 1) * self.dim]);
        position
    }

    /// Velocity of a place at the start as it is known so far, m/s.
    pub fn velocity_of(&self, place: Place) -> [f64; 3] {
        let mut velocity = [0.0; 3];
        if let Place::Node(node) = place {
            velocity[..self.dim].copy_from_slice(&self.velocity[node.index() * self.dim..(node.index() + 1) * self.dim]);
        }
        velocity
    }

    /// Adds the block m 1 + s J (kg) to (a, b) of the mass matrix, and its transpose to (b, a), without weight. In space
    /// there is no J.
    pub fn inertia(&mut self, a: Place, b: Place, m: f64, s: f64) {
        match (a, b) {
            (Place::Node(a), Place::Node(b)) => {
                self.mass.push((a.0, b.0, MassBlock { m, s }));
                if a != b {
                    self.mass.push((b.0, a.0, MassBlock { m, s: -s }));
                }
            }
            (Place::Fixed(_), Place::Fixed(_)) => self.fixed_mass = self.fixed_mass.max(m),
            _ => (),
        }
    }

    /// Says that at the start the part that has the block m 1 + s J (kg) between `a` and `b` in the mass matrix moves as if the
    /// velocity of `b` were `velocity`, m/s. Where parts that share `b` are written with different velocities, the start changes
    /// all of them as little as possible, in the metric of their masses.
    pub fn moves(&mut self, a: Place, b: Place, m: f64, s: f64, velocity: [f64; 3]) {
        if let Place::Node(a) = a {
            self.moving.push(Moving { a: a.0, b, block: MassBlock { m, s }, velocity });
        }
    }

    /// Adds the weight of `m` (kg) at f x + g J x to the forces on a node; at a place that never moves it only has an energy.
    pub fn weight(&mut self, term: Term, m: f64) {
        match term.place {
            Place::Node(node) => self.weight.push((node.0, [m * term.factor, m * term.turn])),
            Place::Fixed(x) => {
                let [f, g] = [m * term.factor, m * term.turn];
                let parts = [f * x[0] - g * x[1], f * x[1] + g * x[0], f * x[2]];
                self.fixed_moment.iter_mut().zip(parts).for_each(|(sum, part)| *sum += part);
            }
        }
    }

    /// π = ½ |Σ u_a x_a|².
    pub fn square<T: Into<Term> + Copy>(&mut self, u: &[T]) -> InvariantId {
        self.invariants.square(&terms(u))
    }

    /// π = (Σ u_a x_a) · (Σ w_b x_b).
    pub fn dot<T: Into<Term> + Copy, U: Into<Term> + Copy>(&mut self, u: &[T], w: &[U]) -> InvariantId {
        self.invariants.dot(&terms(u), &terms(w))
    }

    /// π = e · (Σ u_a x_a): one component of a sum of points.
    pub fn linear<T: Into<Term> + Copy>(&mut self, e: [f64; 3], u: &[T]) -> InvariantId {
        self.dot(u, &[(Place::Fixed(e), 1.0)])
    }

    /// π = e · ((Σ u_a x_a) × (Σ w_b x_b)); in the plane the scalar cross product, and `e` is not read.
    ///
    /// In space a row of this kind is only equivariant: it may cost angular momentum (methods §8).
    pub fn cross<T: Into<Term> + Copy, U: Into<Term> + Copy>(&mut self, e: [f64; 3], u: &[T], w: &[U]) -> InvariantId {
        self.invariants.cross(e, &terms(u), &terms(w))
    }

    /// Value of an invariant at the start.
    pub fn value(&self, invariant: InvariantId) -> f64 {
        self.invariants.value_of(invariant, &self.position)
    }

    /// A joint coordinate as a part of functions.
    pub fn part(&mut self, form: &Form) -> Part {
        form.part(&mut self.invariants)
    }

    /// Whether any of the nodes of a point has mass.
    pub fn has_inertia(&self, terms: &[Term]) -> bool {
        let is = |term: &Term, node: u32| term.place == Place::Node(NodeId(node));
        self.mass.iter().any(|&(a, b, block)| a == b && block.m > 0.0 && terms.iter().any(|term| is(term, a)))
    }

    /// Number of free nodes.
    pub fn free(&self) -> usize {
        self.free
    }

    /// Number of rows so far, without custom ones.
    pub fn rows(&self) -> usize {
        self.rows.len()
    }

    /// The sum of some parts, each with its factor.
    ///
    /// # Panics
    /// When the parts depend on more than [`MAX_ARGUMENTS`] invariants.
    pub fn sum(&mut self, parts: &[(Part, f64)]) -> FunctionId {
        self.functions.add(&self.invariants, parts)
    }

    /// Adds the row Φ = π − c(t).
    pub fn row(&mut self, name: impl Into<String>, quantity: impl Into<Quantity>, target: Arc<dyn Signal>) {
        self.row_names.push(name.into());
        self.rows.push(Row::new(quantity.into(), target));
    }

    /// Gives the k-th row another target c(t).
    pub fn retarget(&mut self, row: usize, target: Arc<dyn Signal>) {
        self.rows[row] = Row::new(self.rows[row].quantity, target);
    }

    /// Takes the k-th row out; those behind it move up.
    pub(crate) fn remove_row(&mut self, row: usize) {
        self.rows.remove(row);
        self.row_names.remove(row);
    }

    /// Adds such a row with a constant c that no constraint has asked for: it keeps the nodes of one thing where they are in that.
    pub(crate) fn implied_row(&mut self, name: String, invariant: InvariantId, target: f64) {
        self.constant_row(name, invariant, target);
        self.rows.last_mut().expect("a row was added").is_implied = true;
    }

    /// Adds the row Φ = π − c with a constant c.
    pub fn constant_row(&mut self, name: impl Into<String>, quantity: impl Into<Quantity>, target: f64) {
        self.row(name, quantity, Arc::new(Constant(target)));
    }

    /// Adds a potential or dissipative law of some quantities.
    ///
    /// # Panics
    /// When they depend on more than [`MAX_ARGUMENTS`] invariants.
    pub fn law(&mut self, name: impl Into<String>, arguments: &[impl Into<Quantity> + Copy], law: Arc<dyn Law>) {
        let arguments: Vec<Quantity> = arguments.iter().map(|&argument| argument.into()).collect();
        let invariants: Vec<InvariantId> = arguments.iter().flat_map(|&argument| self.base(argument)).collect();
        assert!(invariants.len() <= MAX_ARGUMENTS, "a law depends on at most {MAX_ARGUMENTS} invariants");
        self.laws.push(LawEntry { name: name.into(), arguments, invariants, law });
    }

    /// The invariants that a quantity depends on.
    fn base(&self, quantity: Quantity) -> Vec<InvariantId> {
        match quantity {
            Quantity::Invariant(id) => vec![id],
            Quantity::Function(id) => self.functions.base(id).to_vec(),
        }
    }

    /// Number of laws so far.
    pub(crate) fn laws(&self) -> usize {
        self.laws.len()
    }

    /// Number of loads so far.
    pub(crate) fn loads(&self) -> usize {
        self.loads.len()
    }

    /// Adds a function of time at whose zeros forces or motions change abruptly: steps by accuracy end there.
    pub fn switch(&mut self, of_time: Arc<dyn Signal>) {
        self.switches.push(of_time);
    }

    /// Adds a load on nodes.
    pub fn load(&mut self, name: impl Into<String>, nodes: &[NodeId], load: Arc<dyn Load>) {
        self.load_reading(name, Reading { nodes: nodes.to_vec(), senses: Vec::new() }, load);
    }

    /// Adds a load on nodes and quantities, which may depend on all that it reads.
    pub fn load_reading(&mut self, name: impl Into<String>, reading: Reading, load: Arc<dyn Load>) {
        let mut nodes = reading.nodes.clone();
        for sense in &reading.senses {
            let Sense::Quantity(quantity) = *sense else { continue };
            for s in self.base(quantity).into_iter().flat_map(|id| self.invariants.slots_of(id)) {
                let node = NodeId(self.invariants.node_of(s));
                if !nodes.contains(&node) {
                    nodes.push(node);
                }
            }
        }
        self.loads.push(LoadEntry { name: name.into(), reading, nodes, load });
    }

    /// Adds a number from outside, which loads may read, and says what it is until it is set.
    pub fn input(&mut self, name: impl Into<String>, default: f64) -> Sense {
        self.inputs.push((name.into(), default));
        Sense::Input(self.inputs.len() - 1)
    }

    /// Adds a condition whose times simulations find.
    pub fn event(&mut self, event: Event) {
        self.events.push(event);
    }

    /// Number of custom rows so far, which come behind the others.
    pub(crate) fn custom_rows_so_far(&self) -> usize {
        self.custom.iter().map(|entry| entry.rows.rows()).sum()
    }

    /// Adds rows that are functions of the coordinates of `nodes` and of time.
    pub fn custom_rows(&mut self, name: impl Into<String>, nodes: &[NodeId], rows: Arc<dyn CustomRows>) {
        self.custom.push(CustomEntry { name: name.into(), nodes: nodes.to_vec(), rows });
    }

    /// Whether a part is written with a velocity.
    pub fn is_moving(&self) -> bool {
        self.velocity[..self.free * self.dim]
            .iter()
            .chain(self.moving.iter().flat_map(|part| &part.velocity))
            .any(|velocity| *velocity != 0.0)
    }

    /// Where the nodes are; D numbers each, m.
    pub fn position(&self) -> &[f64] {
        &self.position
    }

    /// Puts the nodes elsewhere; D numbers each, m. Angles of the equations and of what is measured are the nearest to those given, rad.
    pub fn move_to(&mut self, position: &[f64], [angles, measured]: [&[f64]; 2]) {
        self.position.copy_from_slice(position);
        self.functions.begin_at(angles);
        self.gauges.begin_at(measured);
    }

    /// Gives the nodes other velocities, D numbers each, m/s; those of parts are then what follows from these.
    pub fn set_velocity(&mut self, velocity: &[f64]) {
        self.velocity.copy_from_slice(velocity);
        self.moving.clear();
    }
}
