//! Where everything of the matrix goes, and in what order it is eliminated.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

use nalgebra::{Matrix3, Matrix6, Vector6};
use smallvec::SmallVec;

use super::{Augmented, Body, Lone, Motion, Outer, Twists, turned, turns};
use crate::formulation::scales::{LIGHT, Scales};
use crate::linalg::{Plan, Solver, fill_reducing_order};
use crate::system::{MassBlock, NodeId, Quantity, RowSlot, System};

/// Neighbours from which on a body or node fills the matrix densely, as all rows of what hangs on it wait for it.
const HUB: usize = 100;

/// What products of edges may be off the rows that keep them, over their size.
const SAME: f64 = 1e-9;

/// What moves as one, a body or a node of none: its unknowns.
type Carrier = Range<u32>;

/// The numbers of the unknowns.
struct Numbering {
    motions: Vec<Motion>,
    carriers: Vec<Carrier>,
    /// The carrier of each free node; bodies come first.
    carrier_of: Vec<usize>,
    /// First of the multipliers.
    coordinates: u32,
}

impl Numbering {
    fn new(system: &System, bodies: &[Body]) -> Self {
        let (dim, free) = (system.dim, system.free);
        let mut motions = vec![Motion { moves: None, turns: None }; free];
        let (mut carriers, mut carrier_of) = (Vec::<Carrier>::new(), vec![usize::MAX; free]);
        let mut end = 0;
        let mut take = |count: usize| {
            end += count as u32;
            end - count as u32
        };
        for body in bodies {
            let [moves, turning] = [take(dim), take(turns(dim))];
            for (k, node) in (0..body.count).map(|k| body.node(k)).enumerate() {
                carrier_of[node] = carriers.len();
                motions[node] = Motion { moves: system.is_point[node].then_some(moves), turns: (k > 0).then_some(turning) };
            }
            carriers.push(moves..turning + turns(dim) as u32);
        }
        for node in 0..free {
            if carrier_of[node] == usize::MAX {
                let moves = take(dim);
                carrier_of[node] = carriers.len();
                motions[node] = Motion { moves: Some(moves), turns: None };
                carriers.push(moves..moves + dim as u32);
            }
        }
        Self { motions, carriers, carrier_of, coordinates: end }
    }

    /// Bodies and nodes by least fill-in, each row right after the last of its own; none where a row would wait for a hub. `carriers_of` has those
    /// of each row, and `edges` the pairs that share a block.
    fn order(&self, mut edges: Vec<(u32, u32)>, carriers_of: &[Vec<u32>]) -> Option<Vec<u32>> {
        for own in carriers_of {
            own.iter().for_each(|&a| edges.extend(own.iter().map(|&b| (a, b))));
        }
        edges.retain(|(a, b)| a < b);
        edges.sort_unstable();
        edges.dedup();
        let count = self.carriers.len();
        let mut neighbours = vec![0; count];
        edges.iter().flat_map(|&(a, b)| [a, b]).for_each(|carrier| neighbours[carrier as usize] += 1);
        if neighbours.iter().any(|&count| count >= HUB) {
            return None;
        }
        let order = fill_reducing_order(count, &edges);
        let mut place = vec![0; count];
        order.iter().enumerate().for_each(|(k, &carrier)| place[carrier as usize] = k);
        let mut rows_after = vec![Vec::new(); count + 1];
        for (row, own) in (self.coordinates..).zip(carriers_of) {
            let last = own.iter().map(|&carrier| place[carrier as usize] + 1).max().unwrap_or(0);
            rows_after[last].push(row);
        }
        let mut unknowns = std::mem::take(&mut rows_after[0]);
        for (&carrier, rows) in order.iter().zip(&rows_after[1..]) {
            unknowns.extend(self.carriers[carrier as usize].clone().chain(rows.iter().copied()));
        }
        Some(unknowns)
    }
}

/// All pairs of some unknowns.
fn square(all: &[u32]) -> impl Iterator<Item = (u32, u32)> {
    all.iter().flat_map(move |&a| all.iter().map(move |&b| (a, b)))
}

impl Twists {
    /// Plans the matrix of a system with the nodes of its rigid bodies, each of which has its own, in the order of the rows that keep them rigid,
    /// which come first. `None` where that is not so, and where one of them has so many neighbours that the rows at these should not wait for it.
    pub fn new(system: &System, scales: &Scales, bodies: &[Vec<NodeId>]) -> Option<Self> {
        let (dim, free) = (system.dim, system.free);
        let Rigid { bodies, masses, rows: inner_rows } = rigid(system, bodies)?;
        let numbering = Numbering::new(system, &bodies);
        let Numbering { motions, carriers, carrier_of, coordinates } = &numbering;
        let rows = inner_rows..system.constraints();
        let multiplier = |row: usize| coordinates + (row - inner_rows) as u32;
        let nodes_of = |row: usize| {
            system.slots.rows[row].clone().map(|slot| (slot, system.slots.nodes[slot] as usize)).filter(|&(_, node)| node < free)
        };
        let lone: Vec<(usize, usize, MassBlock)> = (0..free)
            .filter(|&node| carrier_of[node] >= bodies.len())
            .flat_map(|a| system.mass.row(a).filter(|&(b, _)| b < free).map(move |(b, block)| (a, b, block)))
            .collect();
        let edges = lone.iter().map(|&(a, b, _)| (carrier_of[a] as u32, carrier_of[b] as u32)).collect();
        let carriers_of: Vec<Vec<u32>> = rows
            .clone()
            .map(|row| {
                let own: BTreeSet<u32> = nodes_of(row).map(|(_, node)| carrier_of[node] as u32).collect();
                own.into_iter().collect()
            })
            .collect();
        let order = numbering.order(edges, &carriers_of)?;
        // A row touches velocities and angular velocities, each by the first of its unknowns.
        let (mut touched, mut slots, mut touches_of) = (BTreeMap::<(usize, u32), u32>::new(), Vec::new(), Vec::new());
        for (row, (slot, node)) in rows.clone().flat_map(|row| nodes_of(row).map(move |of| (row, of))) {
            let touches = [motions[node].moves, motions[node].turns].map(|first| {
                let next = touched.len() as u32;
                first.map(|first| *touched.entry((row, first)).or_insert(next))
            });
            slots.push(RowSlot { row: row as u32, slot: slot as u32, node: node as u32 });
            touches_of.push(touches);
        }
        let mut of_touches: Vec<(usize, u32)> = vec![(0, 0); touched.len()];
        touched.iter().for_each(|(&key, &touch)| of_touches[touch as usize] = key);
        let mut is_turn = vec![false; *coordinates as usize];
        motions.iter().filter_map(|motion| motion.turns).for_each(|first| is_turn[first as usize] = true);
        let all_of = |first: u32| first..first + if is_turn[first as usize] { turns(dim) } else { dim } as u32;
        let coordinates_of =
            |row: usize| -> Vec<u32> { touched.range((row, 0)..(row + 1, 0)).flat_map(|(&(_, first), _)| all_of(first)).collect() };
        let block = |a: usize, b: usize| {
            let [a, b] = [a, b].map(|node| motions[node].moves.expect("it is no body's"));
            (0..dim as u32).flat_map(move |c| (0..dim as u32).map(move |d| (a + c, b + d)))
        };
        let own: Vec<Vec<u32>> = carriers.iter().map(|carrier| carrier.clone().collect()).collect();
        let mobility = Mobility::new(system, scales, &bodies, &masses, &numbering, rows.clone());
        let is_light = |row: &usize| scales.has_light[*row] && mobility.of_rows[row - inner_rows].is_none();
        let light: Vec<(usize, Vec<u32>)> = rows.clone().filter(is_light).map(|row| (row, coordinates_of(row))).collect();
        let mut entries: Vec<(u32, u32)> = own.iter().chain(light.iter().map(|(_, own)| own)).flat_map(|own| square(own)).collect();
        entries.extend(lone.iter().flat_map(|&(a, b, _)| block(a, b)));
        for &(row, first) in &of_touches {
            entries.extend(all_of(first).flat_map(|q| [(q, multiplier(row)), (multiplier(row), q)]));
        }
        entries.extend(rows.clone().map(|row| (multiplier(row), multiplier(row))));
        let size = *coordinates as usize + rows.len();
        let plan = Plan::new(&system.plans, size, &entries, &order);
        drop(entries);
        let places = plan.places();
        let at = |(row, column): (u32, u32)| places.position(row as usize, column as usize);
        let beside = |q: u32, row: usize| [at((q, multiplier(row))), at((multiplier(row), q))];
        let diagonal = |row: usize| at((multiplier(row), multiplier(row)));
        let outer = |(row, alone): (usize, &Option<f64>)| {
            let alone = alone.unwrap_or(scales.softness[row]);
            Outer { row: row as u32, unknown: multiplier(row), diagonal: diagonal(row), alone }
        };
        let augmented = |(row, own): &(usize, Vec<u32>)| Augmented {
            weight: 1.0 / scales.softness[*row],
            row: multiplier(*row),
            diagonal: diagonal(*row),
            pairs: square(own).map(at).collect(),
            column: vec![0.0; own.len()],
            entries: own.iter().map(|&q| (q, beside(q, *row))).map(|(q, [column, row])| [q, column, row]).collect(),
        };
        let mut twists = Self {
            dim,
            is_even: mobility.is_even,
            augmented: light.iter().map(augmented).collect(),
            touches: of_touches.iter().map(|&(row, first)| all_of(first).map(|q| beside(q, row)).collect()).collect(),
            lone: lone.iter().map(|&(a, b, mass)| Lone { mass, places: block(a, b).map(at).collect() }).collect(),
            places: own[..bodies.len()].iter().flat_map(|own| square(own)).map(at).collect(),
            bodies,
            masses,
            outer: rows.zip(&mobility.of_rows).map(outer).collect(),
            gradients: vec![[0.0; 3]; of_touches.len()],
            slots,
            touched: touches_of,
            solver: Solver::new(plan.clone()),
            arms: vec![0.0; free * dim],
            inner: vec![0.0; system.nodes() * dim],
            inertial: vec![0.0; free * dim],
            reduced: vec![0.0; size],
            agility: vec![0.0; *coordinates as usize],
            unknowns: vec![0.0; system.coordinates() + system.constraints()],
            motions: numbering.motions,
        };
        twists.set_units(system, scales, &mobility);
        Some(twists)
    }

    /// Rows of the matrix are compared by the roots of masses and of moments of inertia, and of what multipliers move. Sets what makes an acceleration
    /// of a number, too.
    fn set_units(&mut self, system: &System, scales: &Scales, mobility: &Mobility) {
        let mut units = vec![f64::INFINITY; self.reduced.len()];
        let agility = &mut self.agility;
        let mut lower = |first: u32, count: usize, unit: f64, length: f64| {
            for own in first as usize..first as usize + count {
                if unit < units[own] {
                    (units[own], agility[own]) = (unit, unit * unit * length);
                }
            }
        };
        let x = |node: usize| &system.start_position[node * self.dim..(node + 1) * self.dim];
        for (motion, held) in self.motions.iter().zip(&scales.held) {
            if let Some(first) = motion.moves {
                lower(first, self.dim, held.sqrt(), 1.0);
            }
        }
        for (body, own) in self.bodies.iter().zip(&mobility.of_turns) {
            for node in (1..body.count).map(|k| body.node(k)) {
                let Motion { moves, turns: Some(first) } = self.motions[node] else { continue };
                let from = if moves.is_some() { x(body.node(0)) } else { &[0.0; 3][..self.dim] };
                let length = x(node).iter().zip(from).map(|(x, from)| (x - from).powi(2)).sum::<f64>().sqrt();
                lower(first, turns(self.dim), own.map_or(scales.held[node].sqrt() / length, f64::sqrt), length);
            }
        }
        self.outer.iter().for_each(|outer| units[outer.unknown as usize] = 1.0 / outer.alone.sqrt());
        self.solver.set_units(&units);
    }
}

/// How far bodies and rows give way, 1 over inertia, where none of the bodies is light. One is light that rows move, or that turns, far more easily
/// than what is beside it: the pivots of its rows are differences of numbers that far apart, as methods §13 has it of nodes.
struct Mobility {
    /// Of turns of each body, 1/(kg·m²).
    of_turns: Vec<Option<f64>>,
    /// G M⁻¹ Gᵀ of each row between bodies where these are free.
    of_rows: Vec<Option<f64>>,
    /// Whether no body is light.
    is_even: bool,
}

/// Of what moves as one: the gradient of a row by its motion, and how far it moves.
struct Moved {
    carrier: usize,
    gradient: Vector6<f64>,
    mobility: f64,
}

impl Mobility {
    fn new(system: &System, scales: &Scales, bodies: &[Body], masses: &[MassBlock], numbering: &Numbering, rows: Range<usize>) -> Self {
        let (dim, x, Numbering { motions, carriers, carrier_of, .. }) = (system.dim, &system.start_position, numbering);
        let mut at = system.evaluation();
        system.evaluate_again(x, 0.0, &mut at);
        let mut arms = vec![0.0; system.free * dim];
        let is_held = |node: usize| scales.held[node] * system.mass.diagonal(node) < 0.5;
        let mut is_light = vec![false; carriers.len()];
        (0..system.free).filter(|&node| motions[node].moves.is_some()).for_each(|node| is_light[carrier_of[node]] |= is_held(node));
        let (mut inverses, mut inertias, mut others) = (Vec::new(), Vec::new(), masses);
        for (body, is_light) in bodies.iter().zip(&mut is_light) {
            let (mass, rest) = others.split_at(body.count.pow(2));
            others = rest;
            let block = match dim {
                2 => body.inertia_at::<2>(mass, motions, x, &mut arms),
                _ => body.inertia_at::<3>(mass, motions, x, &mut arms),
            };
            let size = dim + turns(dim);
            let matrix = Matrix6::from_fn(|i, j| if i.max(j) < size { block[i][j] } else { f64::from(u8::from(i == j)) });
            let inverse = matrix.try_inverse();
            *is_light |= inverse.is_none();
            inverses.push(inverse.unwrap_or_default());
            inertias.push([block[0][0], (dim..size).map(|k| block[k][k]).sum()]);
        }
        let moved_by = |row: usize| {
            let mut moved = SmallVec::<[Moved; 4]>::new();
            for slot in system.slots.rows[row].clone() {
                let node = system.slots.nodes[slot] as usize;
                let Some(&carrier) = carrier_of.get(node) else { continue };
                let gradient = &at.gradient[slot * dim..(slot + 1) * dim];
                let k = moved.iter().position(|moved| moved.carrier == carrier).unwrap_or_else(|| {
                    moved.push(Moved { carrier, gradient: Vector6::zeros(), mobility: 0.0 });
                    moved.len() - 1
                });
                let sum = &mut moved[k].gradient;
                if motions[node].moves.is_some() {
                    (0..dim).for_each(|c| sum[c] += gradient[c]);
                }
                if motions[node].turns.is_some() {
                    let moment = turned(&arms[node * dim..(node + 1) * dim], gradient);
                    (0..turns(dim)).for_each(|c| sum[dim + c] += moment[c]);
                }
                if carrier >= bodies.len() {
                    moved[k].mobility = sum.norm_squared() * scales.held[node];
                }
            }
            for moved in moved.iter_mut().filter(|moved| moved.carrier < bodies.len()) {
                moved.mobility = moved.gradient.dot(&(inverses[moved.carrier] * moved.gradient));
            }
            moved
        };
        for row in rows.clone() {
            let moved = moved_by(row);
            for of in moved.iter().filter(|of| of.carrier < bodies.len()) {
                let [mass, inertia] = inertias[of.carrier];
                let square = |range: Range<usize>| range.map(|c| of.gradient[c].powi(2)).sum::<f64>();
                let plain = square(0..dim) / mass + square(dim..6) / inertia;
                let beside = moved.iter().filter(|other| other.carrier != of.carrier).map(|other| other.mobility);
                is_light[of.carrier] |= beside.fold(plain, f64::min) < LIGHT * of.mobility;
            }
        }
        let of_row = |row: usize| {
            let moved = moved_by(row);
            let is_plain = moved.iter().all(|of| !is_light[of.carrier] && of.mobility > 0.0);
            is_plain.then(|| moved.iter().map(|of| of.mobility).sum()).filter(|sum: &f64| *sum > 0.0 && sum.is_finite())
        };
        let of_turns = inertias.iter().zip(&is_light).map(|([_, inertia], is_light)| (!is_light).then(|| turns(dim) as f64 / inertia));
        Self { of_turns: of_turns.collect(), of_rows: rows.map(of_row).collect(), is_even: !is_light.contains(&true) }
    }
}

/// The rigid bodies of a system.
struct Rigid {
    bodies: Vec<Body>,
    /// The blocks of their mass matrices.
    masses: Vec<MassBlock>,
    /// How many rows keep them rigid.
    rows: usize,
}

fn rigid(system: &System, bodies: &[Vec<NodeId>]) -> Option<Rigid> {
    let (dim, x) = (system.dim, &system.start_position);
    let mut at = system.evaluation();
    system.evaluate_again(x, 0.0, &mut at);
    let (mut taken, mut row, mut found, mut masses) = (vec![false; system.free], 0, Vec::new(), Vec::new());
    for nodes in bodies {
        let nodes: Vec<usize> = nodes.iter().map(|node| node.index()).collect();
        let is_own = nodes.iter().all(|&node| node < system.free && !std::mem::replace(&mut taken[node], true));
        let moves_alone = |node: &usize| system.mass.row(*node).all(|(other, _)| nodes.contains(&other));
        if !is_own || !(2..=4).contains(&nodes.len()) || !system.is_point[nodes[0]] || !nodes.iter().all(moves_alone) {
            return None;
        }
        let edge = |k: usize, c: usize| {
            let node = nodes[k + 1];
            x[node * dim + c] - if system.is_point[node] { x[nodes[0] * dim + c] } else { 0.0 }
        };
        let inner = row;
        for i in 0..nodes.len() - 1 {
            for j in i..nodes.len() - 1 {
                let product: f64 = (0..dim).map(|c| edge(i, c) * edge(j, c)).sum();
                let lengths: f64 = [i, j].map(|k| (0..dim).map(|c| edge(k, c).powi(2)).sum::<f64>().sqrt()).iter().product();
                let expected = if i == j { 0.5 * product } else { product };
                let own = system.rows.get(row).filter(|own| own.is_constant())?;
                let Quantity::Invariant(id) = own.quantity else { return None };
                let is_own = system.slots.rows[row].clone().all(|slot| nodes.contains(&(system.slots.nodes[slot] as usize)));
                if !is_own || (at.value[id.0 as usize] - expected).abs() > SAME * lengths {
                    return None;
                }
                row += 1;
            }
        }
        let block =
            |a: usize, b: usize| system.mass.row(a).find(|&(other, _)| other == b).map_or(MassBlock { m: 0.0, s: 0.0 }, |(_, block)| block);
        masses.extend(nodes.iter().flat_map(|&a| nodes.iter().map(move |&b| (a, b))).map(|(a, b)| block(a, b)));
        let count = nodes.len();
        let nodes = std::array::from_fn(|k| nodes.get(k).map_or(0, |&node| node as u32));
        found.push(Body { nodes, count, inner: inner as u32, reciprocal: Matrix3::identity() });
    }
    Some(Rigid { bodies: found, masses, rows: row })
}
