//! The finished [`System`]: where its points are counted from, and the velocities that parts share at its nodes.

use std::sync::Arc;

use super::{Moving, NodeId, Place, SystemBuilder};
use crate::system::{Bending, Mass, Quantity, Row, Slots, System};

/// Gives each of the `free` nodes the velocity of the heaviest part there, beside which the momenta of light ones are not rounded
/// away, and finds what the momentum of all parts is more than that of the nodes then, N·s.
fn share_velocities(dim: usize, free: usize, moving: &[Moving], velocities: &mut [f64]) -> Vec<f64> {
    let mut heaviest = vec![0.0; free];
    for Moving { a, b, block, velocity } in moving {
        let node = *a as usize;
        if *b == Place::Node(NodeId(*a)) && node < free && block.m > heaviest[node] {
            heaviest[node] = block.m;
            velocities[node * dim..(node + 1) * dim].copy_from_slice(&velocity[..dim]);
        }
    }
    let mut impulse = vec![0.0; free * dim];
    for Moving { a, b, block, velocity } in moving.iter().filter(|part| (part.a as usize) < free) {
        let mut more = *velocity;
        if let Place::Node(b) = b {
            more.iter_mut().zip(&velocities[b.index() * dim..(b.index() + 1) * dim]).for_each(|(more, own)| *more -= own);
        }
        let push = [block.m * more[0] - block.s * more[1], block.m * more[1] + block.s * more[0], block.m * more[2]];
        impulse[*a as usize * dim..].iter_mut().zip(push).take(dim).for_each(|(sum, push)| *sum += push);
    }
    impulse
}

/// So many times farther away than large, a mechanism is counted from its own middle: a digit of its places would be lost.
const FAR: f64 = 10.0;

impl SystemBuilder {
    /// Where points are counted from: the world's origin, or the middle of the points where that is much farther away than they
    /// are from each other, and how far these are. Where rows are of coordinates in the world these are kept.
    fn origin(&self, is_point: &[bool]) -> ([f64; 3], f64) {
        let (mut middle, mut extent) = ([0.0; 3], self.size);
        for c in 0..self.dim {
            let points = self.position.chunks_exact(self.dim).zip(is_point).filter(|(_, is_point)| **is_point).map(|(x, _)| x[c]);
            let [low, high] = points.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(x), high.max(x)]);
            extent = extent.max(high - low);
            // Of few digits, so that differences from it have no round-off.
            middle[c] = f64::from((0.5 * (low + high)) as f32);
        }
        let [shortest, longest] = self.invariants.lengths(is_point, &self.position);
        // A single point shows no size; what holds it does.
        let extent = if extent > 0.0 { extent } else { shortest };
        // Rows of coordinates in the world have all their digits in these.
        let is_tied = longest > FAR * extent || !self.custom.is_empty();
        let is_far = middle.iter().any(|x| x.is_finite() && x.abs() > FAR * extent);
        (if is_far && !is_tied { middle } else { [0.0; 3] }, extent)
    }

    /// Whether each node is a point and not a direction.
    fn are_points(&self) -> Vec<bool> {
        let mut are_points = vec![true; self.free + self.motions.len()];
        self.directions.iter().for_each(|&node| are_points[node as usize] = false);
        are_points
    }

    /// How large the mechanism is, as far as it is built, m: the size that was set, or how far its points are apart where that is more.
    pub(crate) fn extent(&self) -> f64 {
        self.origin(&self.are_points()).1
    }

    /// The finished system.
    pub fn build(mut self) -> System {
        let is_point = self.are_points();
        let (origin, extent) = self.origin(&is_point);
        if origin != [0.0; 3] {
            // A single point is at its own middle, and what holds it is not seen from there.
            self.size = self.size.max(extent);
            for (x, _) in self.position.chunks_exact_mut(self.dim).zip(&is_point).filter(|(_, is_point)| **is_point) {
                x.iter_mut().zip(origin).for_each(|(x, origin)| *x -= origin);
            }
            self.invariants.move_origin(&is_point, origin);
            self.gauges.move_origin(&is_point, origin);
        }
        let mut row_names = self.row_names;
        for custom in &self.custom {
            match custom.rows.rows() {
                1 => row_names.push(custom.name.clone()),
                several => row_names.extend((0..several).map(|k| format!("{}[{k}]", custom.name))),
            }
        }
        let mut weighing = vec![[0.0; 2]; self.free + self.motions.len()];
        for (node, [m, s]) in self.weight {
            weighing[node as usize][0] += m;
            weighing[node as usize][1] += s;
        }
        let is_pfaffian = |row: &Row| matches!(row.quantity, Quantity::Function(id) if self.functions.is_pfaffian(id));
        let velocity_rows = (0..self.rows.len() as u32).filter(|&k| is_pfaffian(&self.rows[k as usize])).collect();
        let function_rows =
            (0..self.rows.len() as u32).filter(|&k| matches!(self.rows[k as usize].quantity, Quantity::Function(_))).collect();
        let start_impulse = share_velocities(self.dim, self.free, &self.moving, &mut self.velocity);
        let mut system = System {
            weighing,
            is_point,
            origin,
            dim: self.dim,
            free: self.free,
            mass: Mass::new(self.free + self.motions.len(), self.mass),
            gravity: self.gravity,
            invariants: self.invariants,
            velocity_rows,
            functions: self.functions,
            gauges: self.gauges,
            function_rows,
            driven_rows: Vec::new(),
            dissipative: self.laws.iter().filter(|law| !law.law.conservative()).count(),
            rows: self.rows,
            custom: self.custom,
            laws: self.laws,
            loads: self.loads,
            motions: self.motions,
            switches: self.switches,
            bending: Bending::default(),
            inputs: self.inputs,
            events: self.events,
            row_names,
            start_position: self.position,
            start_velocity: self.velocity,
            start_impulse,
            fixed_energy: -(0..self.dim).map(|c| self.gravity[c] * self.fixed_moment[c]).sum::<f64>(),
            fixed_mass: self.fixed_mass,
            size: self.size,
            slots: Arc::default(),
            plans: Arc::default(),
        };
        system.find_driven_rows();
        system.slots = Arc::new(Slots::new(&system));
        system.bending = system.find_bending();
        system
    }
}
