//! Sums over slots: gradients along a direction, and forces along gradients.
//!
//! A slot is a node and D numbers of a gradient there; those of a row are next to each other.

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
