//! Sizes that belong to a mechanism, from its start: what numbers of different nodes and rows are compared by.

use nalgebra::{Complex, DMatrix};

use super::independence::{extent, natural_sizes};
use crate::linalg::largest;
use crate::system::{Quantity, System};

/// A node is light when its mass, with all others yielding, is below this share of the heaviest of its mechanism. What its rows add is then
/// lost beside what heavier nodes add: the rows enter its part of the matrix (methods §13).
pub(super) const LIGHT: f64 = 1e-4;

/// Smallest share of what a light node counts as that its own mass may be.
const LEAST_SHARE: f64 = 1e-12;

/// Rows shorter than this share of the mechanism are in a singular position rather than short.
const SHORT: f64 = 1e-6;

/// Share of what a gradient becomes when the mechanism moves by its own size that it counts with where it is less.
const LEAST: f64 = 1e-3;

/// Of a node that has mass in common with more others these are not looked at: bodies without number share it, and it is not light.
const MOST_AROUND: usize = 32;

/// Share of a node's mass that is round-off.
const ROUNDED: f64 = 1e-14;

/// Sizes of a mechanism, its nodes and its rows.
#[derive(Clone, Debug)]
pub struct Scales {
    /// Diagonal of the box around the origin and all nodes at the start, m.
    pub length: f64,
    /// The unit of increments, m: `length` or, where every mechanism has gone farther from the origin, how far at least, as positions are rounded there.
    pub unit: f64,
    /// Mechanism of each free node, which rows and mass hold together, and how far each reaches.
    mechanism: Vec<usize>,
    farthest: Vec<f64>,
    dim: usize,
    /// Largest diagonal entry of the mass matrix, kg; where nothing that moves has a mass, what stands in for it.
    pub heaviest: f64,
    /// Length of the shortest row that turns, the gradient of an invariant over its curvature, over `length`, at most 1.
    pub shortest: f64,
    /// 1 over the mass of each free node, 1/kg; directions that are light count as the heaviest node, as their bodies hold them.
    pub agility: Vec<f64>,
    /// Mass of each free node that has none, or none to speak of, as its body holds it, kg; else zero.
    pub massless: Vec<f64>,
    /// 1 over the mass of each free node or, where it is light, of the heaviest of its mechanism, 1/kg.
    pub held: Vec<f64>,
    /// Whether a row has a light node (r).
    pub has_light: Vec<bool>,
    /// Whether any has.
    pub are_light: bool,
    /// Whether a light node is a point: it moves by itself, where a direction of a slender rod goes where rows hold it.
    pub are_points_light: bool,
    /// Size of each row of G M⁻¹ Gᵀ with the masses of `held` (r), 1/kg in the row's units.
    pub softness: Vec<f64>,
    /// Length of each row's gradient (r), 1 in the row's units over m.
    pub gradient: Vec<f64>,
    /// How far the step of a row's multiplier moves the node that it moves farthest, over the mechanism's size (r), 1/(kg·m) in
    /// the row's units.
    pub reach: Vec<f64>,
}

impl Scales {
    /// Measures a system at its start.
    pub fn new(system: &System) -> Self {
        let (free, rows) = (system.free, system.constraints());
        let own: Vec<f64> = (0..free).map(|node| system.mass.diagonal(node)).collect();
        let heaviest = heaviest(system, &own);
        let (mechanism, mechanisms) = mechanisms(system);
        let around = around(system, &own, &mechanism);
        let length = extent(system);
        let yielding: Vec<f64> = (0..free).map(|node| yielding(system, node)).collect();
        let is_light = |node: usize| yielding[node] < LIGHT * around[node];
        let filled = |node: usize, mass: f64| 1.0 / if mass > 0.0 { mass } else { around[node].max(f64::MIN_POSITIVE) };
        let mut scales = Self {
            length,
            unit: length,
            mechanism,
            farthest: vec![0.0; mechanisms],
            dim: system.dim,
            heaviest,
            shortest: 1.0,
            held: (0..free).map(|node| filled(node, if is_light(node) { around[node] } else { own[node] })).collect(),
            agility: (0..free)
                .map(|node| filled(node, if is_light(node) && !system.is_point[node] { around[node] } else { own[node] }))
                .collect(),
            massless: (0..free).map(|node| if own[node] <= LEAST_SHARE * around[node] { around[node] } else { 0.0 }).collect(),
            has_light: vec![false; rows],
            are_light: false,
            are_points_light: (0..free).any(|node| system.is_point[node] && is_light(node)),
            softness: vec![0.0; rows],
            gradient: vec![0.0; rows],
            reach: vec![0.0; rows],
        };
        scales.measure_rows(system, is_light);
        scales
    }

    /// Sets the unit of increments for positions x (full), m.
    pub(super) fn measure_from(&mut self, x: &[f64]) {
        self.farthest.fill(0.0);
        for (node, &mechanism) in x.chunks_exact(self.dim).zip(&self.mechanism) {
            self.farthest[mechanism] = self.farthest[mechanism].max(largest(node));
        }
        let least = self.farthest.iter().copied().reduce(f64::min);
        self.unit = least.filter(|least| least.is_finite()).map_or(self.length, |least| least.max(self.length));
    }

    fn measure_rows(&mut self, system: &System, is_light: impl Fn(usize) -> bool) {
        let dim = system.dim;
        let (natural, at) = natural_sizes(system);
        let mut longest = vec![0.0_f64; self.softness.len()];
        for slot in system.slots.by_row.iter().filter(|slot| (slot.node as usize) < system.free) {
            let (row, node) = (slot.row as usize, slot.node as usize);
            let gradient = &at.gradient[slot.slot as usize * dim..(slot.slot as usize + 1) * dim];
            let least = LEAST * natural[row];
            let square = gradient.iter().map(|g| g * g).sum::<f64>().max(least * least);
            self.has_light[row] |= is_light(node);
            self.softness[row] += square * self.held[node];
            self.gradient[row] += square;
            self.reach[row] = self.reach[row].max(square.sqrt() * self.agility[node] / self.length);
            longest[row] = longest[row].max(largest(gradient));
        }
        for (row, &size) in longest[..system.rows.len()].iter().enumerate() {
            let Quantity::Invariant(id) = system.rows[row].quantity else { continue };
            // Rows have any unit: what a gradient turns by is its length over the curvature.
            let curved = system.invariants.hessian(id).into_iter().filter(|&(a, b, _)| (a.max(b) as usize) < system.free);
            let curvature = curved.map(|(.., block)| block.size()).fold(0.0, f64::max);
            let share = size / (curvature * self.length);
            if share > SHORT && share < self.shortest {
                self.shortest = share;
            }
        }
        self.are_light = self.has_light.contains(&true);
        // A row of known nodes alone holds nothing.
        self.softness.iter_mut().filter(|s| **s == 0.0).for_each(|s| *s = 1.0 / self.heaviest.max(f64::MIN_POSITIVE));
        self.gradient.iter_mut().for_each(|g| *g = if *g > 0.0 { g.sqrt() } else { 1.0 });
    }
}

/// The mechanism that each free node belongs to, all that rows and mass hold together, and how many there are.
fn mechanisms(system: &System) -> (Vec<usize>, usize) {
    let free = system.free;
    let mut root: Vec<usize> = (0..free).collect();
    let mut join = |a: usize, b: usize| {
        let (a, b) = (find(&mut root, a), find(&mut root, b));
        root[a.max(b)] = a.min(b);
    };
    let mut first = vec![None; system.constraints()];
    for slot in system.slots.by_row.iter().filter(|slot| (slot.node as usize) < free) {
        join(*first[slot.row as usize].get_or_insert(slot.node as usize), slot.node as usize);
    }
    for node in 0..free {
        system.mass.row(node).filter(|&(other, _)| other < free).for_each(|(other, _)| join(node, other));
    }
    let mut number = vec![0; free];
    let mut mechanisms = 0;
    for node in 0..free {
        // The first node of a mechanism is its root.
        number[node] = match find(&mut root, node) {
            root if root < node => number[root],
            _ => {
                mechanisms += 1;
                mechanisms - 1
            }
        };
    }
    (number, mechanisms)
}

/// The largest mass in the mechanism of each free node, kg: what a light node counts as, but no more than 1e12 of its own mass. Where all that
/// hangs together has none, as directions of a rod that are held by the ground alone, the largest of the system stands in.
fn around(system: &System, own: &[f64], mechanism: &[usize]) -> Vec<f64> {
    let mut heaviest = vec![0.0_f64; own.len()];
    for (&mass, &mechanism) in own.iter().zip(mechanism) {
        heaviest[mechanism] = heaviest[mechanism].max(mass);
    }
    let any = self::heaviest(system, own);
    let around = |mechanism: usize| Some(heaviest[mechanism]).filter(|mass| *mass > 0.0).unwrap_or(any);
    let most = |own: f64| if own > 0.0 { own / LEAST_SHARE } else { f64::INFINITY };
    own.iter().zip(mechanism).map(|(&own, &mechanism)| around(mechanism).min(most(own))).collect()
}

/// The heaviest of these masses, kg. Where there are none it is that of what never moves, as the middle of a shaft without inertia about its axis: what is
/// left to move of it, or of a slender rod that joints hold, are directions without mass, and rows alone say where they are. Where nothing has a mass any
/// does as well.
fn heaviest(system: &System, own: &[f64]) -> f64 {
    let heaviest = own.iter().copied().fold(0.0, f64::max);
    [heaviest, system.fixed_mass].into_iter().find(|mass| *mass > 0.0).unwrap_or(1.0)
}

/// The mass of a free node where all others that it has mass in common with yield, kg: of a body that is small beside its distance from its
/// nodes none can stay where it is and let one of them move but by turning about its centre.
fn yielding(system: &System, node: usize) -> f64 {
    let mut nodes: Vec<usize> =
        system.mass.row(node).map(|(other, _)| other).filter(|&other| other < system.free && other != node).collect();
    if nodes.is_empty() || nodes.len() > MOST_AROUND {
        return system.mass.diagonal(node);
    }
    nodes.push(node);
    let last = nodes.len() - 1;
    let entry =
        |a: usize, b: usize| system.mass.row(a).find(|&(other, _)| other == b).map_or(Complex::ZERO, |(_, m)| Complex::new(m.m, m.s));
    let mut mass = DMatrix::from_fn(last + 1, last + 1, |i, j| entry(nodes[i], nodes[j]));
    for k in 0..last {
        let pivot = mass[(k, k)].re;
        // What rounding leaves of nothing yields all the same.
        if pivot <= ROUNDED * system.mass.diagonal(nodes[k]) {
            continue;
        }
        for i in k + 1..=last {
            let factor = mass[(i, k)] / pivot;
            for j in k + 1..=last {
                mass[(i, j)] = mass[(i, j)] - factor * mass[(k, j)];
            }
        }
    }
    mass[(last, last)].re.max(0.0)
}

fn find(root: &mut [usize], mut node: usize) -> usize {
    while root[node] != node {
        root[node] = root[root[node]];
        node = root[node];
    }
    node
}
