//! Rates of custom rows between the two ends of a step, for rows at both levels (methods §9).

use smallvec::{SmallVec, smallvec};

use super::stabilized::Stabilized;
use super::stage::Stage;
use super::workspace::Workspace;
use crate::system::{CustomRows, Direction, Local, NO_CHANGE, NodeId, SIZE, System, gather};

/// Sum of a row's gradients over their sizes that is round-off.
const CANCELLED: f64 = 1e-12;

impl Stabilized {
    /// The rates Φ̇ = G v + ∂Φ/∂t of custom rows change over a step by
    /// ```text
    /// ΔΦ̇ = D_vΦ̇·Δv + D_qΦ̇·Δx + E        E = (G(q̄, t₁) − G(q̄, t₀)) v̄ + ∂Φ/∂t(q̄, t₁) − ∂Φ/∂t(q̄, t₀)
    /// ```
    /// with D_vΦ̇ the mean of both ends' G, and D_qΦ̇ = H v̄ + ∂G/∂t half way and what is missing along Δx, as in the discrete gradient of
    /// Gonzalez (1996). E is what time alone does: the work of γ along it is that of known motion. It is taken between the ends, as what a
    /// derivative half way would leave of it along Δx pulls where the row does not, and momenta would drift.
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
            entry.rows.mixed(&middle, t, &mut mixed);
            let by_time = change_by_time(&*entry.rows, &middle, &way, stage);
            for row in 0..rows {
                let slots = slot..slot + k;
                let (start, end) = (&from.gradient[slots.clone()], &to.gradient[slots.clone()]);
                let apart = without_translation(system, &entry.nodes, &change, [start, end]);
                // Beside the way, as the distance from the origin says nothing of how well the change is known.
                let moves = dot(&apart, &apart) > NO_CHANGE * NO_CHANGE * dot(&way, &way);
                let (turned, mixed) = (&mut self.turned_w[slots.clone()], &mixed[row * k..(row + 1) * k]);
                turned.iter_mut().zip(mixed).for_each(|(turned, mixed)| *turned += h * mixed);
                let by_time = by_time[row];
                let rise = dot(end, &way) - dot(start, &way) + h * (to.by_time[first + row] - from.by_time[first + row]);
                if moves {
                    let missing = (rise - h * by_time - dot(turned, &change)) / dot(&apart, &apart);
                    turned.iter_mut().zip(&apart).for_each(|(turned, apart)| *turned += missing * apart);
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

/// The change of the nodes of a row without its translation along the axes along which the row does not hold them, as neither end's gradient
/// does: a pull along these would change the momentum.
fn without_translation(system: &System, nodes: &[NodeId], change: &Local, gradients: [&[f64]; 2]) -> Local {
    let dim = system.dim;
    let points = || nodes.iter().enumerate().filter(|(_, node)| system.is_point[node.index()]).map(|(k, _)| k * dim);
    let (mut apart, count) = (change.clone(), points().count() as f64);
    for c in 0..dim {
        let holds = gradients.iter().any(|gradient| {
            let (sum, size) = points().fold((0.0, 0.0), |(sum, size), k| (sum + gradient[k + c], size + gradient[k + c].abs()));
            sum.abs() > CANCELLED * size
        });
        if !holds && count > 0.0 {
            let mean = points().map(|k| change[k + c]).sum::<f64>() / count;
            points().for_each(|k| apart[k + c] -= mean);
        }
    }
    apart
}

/// E of the rows of an entry with its nodes half way and on their `way` h v̄.
fn change_by_time(rows: &dyn CustomRows, middle: &[f64], way: &[f64], stage: &Stage) -> Local {
    let (k, count) = (middle.len(), rows.rows());
    let at = |t: f64| {
        let (mut gradient, mut rate): (SmallVec<[f64; SIZE * SIZE]>, Local) = (smallvec![0.0; count * k], smallvec![0.0; count]);
        rows.gradient(middle, t, &mut gradient, &mut rate);
        (gradient, rate)
    };
    let ((before, rate_before), (after, rate_after)) = (at(stage.start), at(stage.end()));
    let turned = |row: usize| {
        let slots = row * k..(row + 1) * k;
        (dot(&after[slots.clone()], way) - dot(&before[slots], way)) / stage.step
    };
    (0..count).map(|row| turned(row) + (rate_after[row] - rate_before[row])).collect()
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
