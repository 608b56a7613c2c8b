//! Rows that need not wait for a hub: a node that very many others share rows with.
//!
//! A row is eliminated after the last of its nodes, as its pivot is then what its gradient adds to the rows before it. Hubs come
//! last, so that the rows of everything that hangs on one would wait for it and fill in densely. What hangs on hubs alone and on
//! no other place moves as a whole: rows that its motions as a rigid body can satisfy one by one have a pivot before
//! the hub comes, whatever its masses and wherever it is (methods §13).

use super::pattern::Pattern;
use crate::system::{Evaluation, System};

/// Neighbours from which on a node is a hub: fewer make dense rows that cost little.
const HUB: usize = 100;

/// What a row must do to the rigid motions left by those before it, over what its gradient can do to any, to go early.
const SATISFIABLE: f64 = 0.05;

/// Change of a row under rigid motions, over what its gradient can do, that is round-off.
const UNCHANGED: f64 = 1e-9;

/// Rigid motions in space.
const MOTIONS: usize = 6;

/// Which nodes are hubs and which rows (r) need not wait for them; nothing where there is no hub. `edges` has each pair of nodes that
/// share a block or a row, some several times.
pub(super) fn early_rows(pattern: &Pattern, system: &System, edges: &mut Vec<(u32, u32)>) -> Option<(Vec<bool>, Vec<bool>)> {
    edges.sort_unstable();
    edges.dedup();
    let mut neighbours = vec![0; pattern.free];
    edges.iter().flat_map(|&(a, b)| [a, b]).for_each(|node| neighbours[node as usize] += 1);
    let is_hub: Vec<bool> = neighbours.iter().map(|&count| count >= HUB).collect();
    if !is_hub.contains(&true) {
        return None;
    }
    let part_of = parts(&is_hub, edges);
    let mut at = system.evaluation();
    system.evaluate_again(&system.start_position, 0.0, &mut at);
    let mut of_parts = vec![Vec::new(); pattern.free];
    for (row, slots) in pattern.slots.rows.iter().enumerate() {
        let mut nodes = slots.clone().filter(|&slot| pattern.is_free(slot)).map(|slot| pattern.slots.nodes[slot] as usize);
        if let Some(node) = nodes.find(|&node| !is_hub[node]) {
            of_parts[part_of[node]].push(row);
        }
    }
    let mut centre = vec![usize::MAX; pattern.free];
    for node in (0..pattern.free).rev().filter(|&node| system.is_point[node]) {
        centre[part_of[node]] = node;
    }
    let mut is_early = vec![false; pattern.slots.rows.len()];
    for (rows, &centre) in of_parts.iter().zip(&centre).filter(|(_, centre)| **centre != usize::MAX) {
        let part = Part { pattern, system, at: &at, is_hub: &is_hub, centre };
        part.satisfiable(rows).into_iter().for_each(|row| is_early[row] = true);
    }
    Some((is_hub, is_early))
}

/// What hangs together without the hubs: for each node the first node that it hangs together with.
fn parts(is_hub: &[bool], edges: &[(u32, u32)]) -> Vec<usize> {
    fn first(of: &mut [usize], mut node: usize) -> usize {
        while of[node] != node {
            of[node] = of[of[node]];
            node = of[node];
        }
        node
    }
    let mut of: Vec<usize> = (0..is_hub.len()).collect();
    for &(a, b) in edges.iter().filter(|(a, b)| !is_hub[*a as usize] && !is_hub[*b as usize]) {
        let (a, b) = (first(&mut of, a as usize), first(&mut of, b as usize));
        of[a.max(b)] = a.min(b);
    }
    (0..of.len()).map(|node| first(&mut of, node)).collect()
}

/// Nodes that hang together without the hubs.
struct Part<'a> {
    pattern: &'a Pattern,
    system: &'a System,
    at: &'a Evaluation,
    is_hub: &'a [bool],
    /// The node that its rotations are about.
    centre: usize,
}

impl Part<'_> {
    /// Of its rows those between it and the hubs that its rigid motions can satisfy one by one, with what its other rows leave of
    /// them; none where a place of it is held elsewhere.
    fn satisfiable(&self, rows: &[usize]) -> Vec<usize> {
        let (to_hubs, own): (Vec<usize>, Vec<usize>) = rows.iter().partition(|&&row| self.touches_hub(row));
        let mut taken = Vec::new();
        for row in own {
            let (change, most) = self.change(row);
            // Directions may be held, as those along a fixed axis are: they are so wherever it goes.
            if size(&change[..3]) > UNCHANGED * most {
                return Vec::new();
            }
            take(change, UNCHANGED * most, &mut taken);
        }
        let is_satisfiable = |&row: &usize| {
            let (change, most) = self.change(row);
            take(change, SATISFIABLE * most, &mut taken)
        };
        to_hubs.into_iter().filter(is_satisfiable).collect()
    }

    fn touches_hub(&self, row: usize) -> bool {
        let mut nodes = self.pattern.slots.rows[row].clone().filter(|&slot| self.pattern.is_free(slot));
        nodes.any(|slot| self.is_hub[self.pattern.slots.nodes[slot] as usize])
    }

    /// By how much the rigid motions of the part change a row, and by how much its gradient can where each of its nodes moves
    /// as far. Rotations move the farthest of the row's nodes by one.
    fn change(&self, row: usize) -> ([f64; MOTIONS], f64) {
        let (dim, system) = (self.pattern.dim, self.system);
        let component = |values: &[f64], node: usize, c: usize| if c < dim { values[node * dim + c] } else { 0.0 };
        let (mut change, mut most, mut farthest) = ([0.0; MOTIONS], 0.0_f64, 0.0_f64);
        for slot in self.pattern.slots.rows[row].clone().filter(|&slot| self.pattern.is_free(slot)) {
            let node = self.pattern.slots.nodes[slot] as usize;
            if self.is_hub[node] {
                continue;
            }
            let is_point = system.is_point[node];
            let g: [f64; 3] = std::array::from_fn(|c| component(&self.at.gradient, slot, c));
            let x = &system.start_position;
            let arm: [f64; 3] = std::array::from_fn(|c| component(x, node, c) - if is_point { component(x, self.centre, c) } else { 0.0 });
            if is_point {
                (0..3).for_each(|c| change[c] += g[c]);
            }
            (0..3).for_each(|c| change[3 + c] += arm[(c + 1) % 3] * g[(c + 2) % 3] - arm[(c + 2) % 3] * g[(c + 1) % 3]);
            most += g.iter().map(|g| g * g).sum::<f64>().sqrt();
            farthest = farthest.max(arm.iter().map(|a| a * a).sum::<f64>().sqrt());
        }
        if farthest > 0.0 {
            change[3..].iter_mut().for_each(|c| *c /= farthest);
        }
        (change, most)
    }
}

/// Takes the part of a change that those taken before do not have, made one long, where it is larger than `least`. Whether it was.
fn take(mut change: [f64; MOTIONS], least: f64, taken: &mut Vec<[f64; MOTIONS]>) -> bool {
    // Twice, as round-off of the first pass is large where little is left.
    for other in taken.iter().chain(&*taken) {
        let share: f64 = change.iter().zip(other).map(|(a, b)| a * b).sum();
        change.iter_mut().zip(other).for_each(|(a, b)| *a -= share * b);
    }
    let left = size(&change);
    if left > least {
        taken.push(change.map(|c| c / left));
    }
    left > least
}

fn size(change: &[f64]) -> f64 {
    change.iter().map(|c| c * c).sum::<f64>().sqrt()
}
