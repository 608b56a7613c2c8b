//! Rates of custom rows between the two ends of a step, for rows at both levels (methods §9).

use smallvec::{SmallVec, smallvec};

use super::stabilized::Stabilized;
use super::stage::Stage;
use super::workspace::Workspace;
use crate::system::{Direction, Local, NO_CHANGE, SIZE, System, gather};

impl Stabilized {
    /// The rates Φ̇ = G v + ∂Φ/∂t of custom rows change over a step by
    /// ```text
    /// ΔΦ̇ = D_vΦ̇·Δv + D_qΦ̇·Δx + E        E = h (∂G/∂t·v̄ + ∂²Φ/∂t²) half way
    /// ```
    /// with D_vΦ̇ the mean of both ends' G, and D_qΦ̇ = H v̄ + ∂G/∂t half way and what is missing along Δx, as in the discrete gradient of
    /// Gonzalez (1996). E is what time alone does: the work of γ along it is that of known motion.
    pub(super) fn turn_custom(&mut self, system: &System, stage: &Stage, work: &Workspace) {
        let (h, t) = (stage.step, stage.time());
        // H w; what time adds to it is below.
        system.turn_custom(&work.sampled.x, Direction { nodes: &self.w, time: 0.0 }, t, &mut self.turned_w);
        let (from, to) = (&work.start.at, &work.end.at);
        let (mut slot, mut first) = (system.custom_slots(), 0);
        for entry in &system.custom {
            let local = |x: &[f64]| gather(system.dim, &entry.nodes, x);
            let (middle, way, end) = (local(&work.sampled.x), local(&self.w), local(&work.end.x));
            let change: Local = end.iter().zip(&local(&work.start.x)).map(|(end, start)| end - start).collect();
            let (k, rows) = (middle.len(), entry.rows.rows());
            let mut mixed: SmallVec<[f64; SIZE * SIZE]> = smallvec![0.0; rows * k];
            let (mut by_time, still): (Local, Local) = (smallvec![0.0; rows], smallvec![0.0; k]);
            entry.rows.mixed(&middle, t, &mut mixed);
            entry.rows.curvature(&middle, &still, t, &mut by_time);
            // Beside the way, as the distance from the origin says nothing of how well the change is known.
            let moves = dot(&change, &change) > NO_CHANGE * NO_CHANGE * dot(&way, &way);
            for row in 0..rows {
                let slots = slot..slot + k;
                let (start, end) = (&from.gradient[slots.clone()], &to.gradient[slots.clone()]);
                let (turned, mixed) = (&mut self.turned_w[slots.clone()], &mixed[row * k..(row + 1) * k]);
                turned.iter_mut().zip(mixed).for_each(|(turned, mixed)| *turned += h * mixed);
                let by_time = dot(mixed, &way) + h * by_time[row];
                let rise = dot(end, &way) - dot(start, &way) + h * (to.by_time[first + row] - from.by_time[first + row]);
                if moves {
                    let missing = (rise - h * by_time - dot(turned, &change)) / dot(&change, &change);
                    turned.iter_mut().zip(&change).for_each(|(turned, change)| *turned += missing * change);
                }
                for (mean, (a, b)) in self.velocity_gradient[slots].iter_mut().zip(start.iter().zip(end)) {
                    *mean = 0.5 * (a + b);
                }
                self.rate_by_time[first + row] = by_time;
                slot += k;
            }
            first += rows;
        }
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
