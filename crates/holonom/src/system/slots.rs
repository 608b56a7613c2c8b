//! Sums over slots: gradients along a direction, and forces along gradients.
//!
//! A slot is a node and D numbers of a gradient there; those of a row are next to each other.

use std::ops::Range;

use super::System;

/// Σ g_s·v over the slots, `v` over all nodes.
#[inline]
pub(crate) fn along(dim: usize, nodes: &[u32], gradient: &[f64], v: &[f64]) -> f64 {
    match dim {
        2 => along_in::<2>(nodes, gradient, v),
        _ => along_in::<3>(nodes, gradient, v),
    }
}

/// Adds `factor` g_s to the node of each slot, `out` over all nodes.
#[inline]
pub(crate) fn scatter(dim: usize, nodes: &[u32], factor: f64, gradient: &[f64], out: &mut [f64]) {
    match dim {
        2 => scatter_in::<2>(nodes, factor, gradient, out),
        _ => scatter_in::<3>(nodes, factor, gradient, out),
    }
}

/// A slot of a constraint row.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RowSlot {
    pub row: u32,
    pub slot: u32,
    pub node: u32,
}

/// The slots of a system: those of the invariants, of the functions, then row by row those of the custom rows.
#[derive(Clone, Debug, Default)]
pub(crate) struct Slots {
    /// The node of each.
    pub nodes: Vec<u32>,
    /// Those of each constraint row (r), and all of them row by row.
    pub rows: Vec<Range<usize>>,
    pub by_row: Vec<RowSlot>,
}

impl Slots {
    pub fn new(system: &System) -> Self {
        let sources = (0..system.invariants.slots()).chain(system.functions.sources());
        let mut nodes: Vec<u32> = sources.map(|s| system.invariants.node_of(s)).collect();
        let mut rows: Vec<_> = system.rows.iter().map(|row| system.slots_of(row.quantity)).collect();
        for entry in &system.custom {
            for _ in 0..entry.rows.rows() {
                rows.push(nodes.len()..nodes.len() + entry.nodes.len());
                nodes.extend(entry.nodes.iter().map(|node| node.index() as u32));
            }
        }
        let of_row = |(row, slots): (u32, &Range<usize>)| slots.clone().map(move |slot| (row, slot));
        let slot = |(row, slot): (u32, usize)| RowSlot { row, slot: slot as u32, node: nodes[slot] };
        Self { by_row: (0..).zip(&rows).flat_map(of_row).map(slot).collect(), nodes, rows }
    }
}

impl Slots {
    /// Adds Σ factor_k g_k of all rows to forces on all nodes.
    pub fn add_forces(&self, dim: usize, factors: &[f64], gradient: &[f64], force: &mut [f64]) {
        // Newton starts every step without multipliers.
        if factors.iter().any(|factor| *factor != 0.0) {
            scatter_rows(dim, &self.by_row, factors, gradient, force);
        }
    }

    /// Adds `factor` g_k·x of all rows (r), `x` over all nodes.
    pub fn add_along(&self, dim: usize, factor: f64, gradient: &[f64], x: &[f64], out: &mut [f64]) {
        add_along_rows(dim, &self.by_row, factor, gradient, x, out);
    }
}

/// Adds `factor` Σ g_s·v over the slots of each row to the rows, `v` over all nodes.
#[inline]
pub(crate) fn add_along_rows(dim: usize, slots: &[RowSlot], factor: f64, gradient: &[f64], v: &[f64], out: &mut [f64]) {
    match dim {
        2 => add_along_rows_in::<2>(slots, factor, gradient, v, out),
        _ => add_along_rows_in::<3>(slots, factor, gradient, v, out),
    }
}

/// Adds `factors` of the rows times their g_s to the nodes of their slots, `out` over all nodes.
#[inline]
pub(crate) fn scatter_rows(dim: usize, slots: &[RowSlot], factors: &[f64], gradient: &[f64], out: &mut [f64]) {
    match dim {
        2 => scatter_rows_in::<2>(slots, factors, gradient, out),
        _ => scatter_rows_in::<3>(slots, factors, gradient, out),
    }
}

#[inline]
fn add_along_rows_in<const D: usize>(slots: &[RowSlot], factor: f64, gradient: &[f64], v: &[f64], out: &mut [f64]) {
    let (gradient, v) = (gradient.as_chunks::<D>().0, v.as_chunks::<D>().0);
    for &RowSlot { row, slot, node } in slots {
        let (g, v) = (&gradient[slot as usize], &v[node as usize]);
        let along: f64 = (0..D).map(|c| g[c] * v[c]).sum();
        out[row as usize] += factor * along;
    }
}

#[inline]
fn scatter_rows_in<const D: usize>(slots: &[RowSlot], factors: &[f64], gradient: &[f64], out: &mut [f64]) {
    let (gradient, out) = (gradient.as_chunks::<D>().0, out.as_chunks_mut::<D>().0);
    for &RowSlot { row, slot, node } in slots {
        let (factor, g, out) = (factors[row as usize], &gradient[slot as usize], &mut out[node as usize]);
        (0..D).for_each(|c| out[c] += factor * g[c]);
    }
}

#[inline]
fn along_in<const D: usize>(nodes: &[u32], gradient: &[f64], v: &[f64]) -> f64 {
    let (v, mut sum) = (v.as_chunks::<D>().0, 0.0);
    for (&node, g) in nodes.iter().zip(gradient.as_chunks::<D>().0) {
        let v = &v[node as usize];
        for c in 0..D {
            sum += g[c] * v[c];
        }
    }
    sum
}

#[inline]
fn scatter_in<const D: usize>(nodes: &[u32], factor: f64, gradient: &[f64], out: &mut [f64]) {
    let out = out.as_chunks_mut::<D>().0;
    for (&node, g) in nodes.iter().zip(gradient.as_chunks::<D>().0) {
        let out = &mut out[node as usize];
        for c in 0..D {
            out[c] += factor * g[c];
        }
    }
}
