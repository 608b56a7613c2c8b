//! Values and gradients of all invariants and constraint rows, *at* one position and *between* two.

use smallvec::{SmallVec, smallvec};

use super::{CustomEntry, FunctionValues, InvariantId, MAX_ARGUMENTS, NodeId, Quantity, RowSlot, SIZE, System, add_along_rows, along};

/// Values and gradients at one position, or between two.
///
/// Gradients are kept in slots of D numbers, one for each pair of an invariant (or custom row) and a node it names.
#[derive(Clone, Debug, Default)]
pub struct Evaluation {
    /// Values of the invariants, then of the functions, then Φ of the custom rows.
    pub(crate) value: Vec<f64>,
    /// Gradients, D a slot.
    pub(crate) gradient: Vec<f64>,
    /// Derivatives of the functions by their invariants.
    pub(crate) functions: FunctionValues,
    /// ∂Φ/∂t of the custom rows.
    pub(crate) by_time: Vec<f64>,
    /// Where between the two positions each custom row has its gradient: the paper's β (15).
    pub(crate) beta: Vec<f64>,
}

impl Evaluation {
    /// Has angles counted on from these, as a state has them.
    pub fn count_on(&mut self, angles: &[f64]) {
        self.functions.angle.copy_from_slice(angles);
    }

    /// Takes over the numbers of another evaluation of the same system, without allocating.
    pub fn copy_from(&mut self, other: &Self) {
        self.value.copy_from_slice(&other.value);
        self.gradient.copy_from_slice(&other.gradient);
        self.functions.local.copy_from_slice(&other.functions.local);
        self.functions.angle.copy_from_slice(&other.functions.angle);
        self.by_time.copy_from_slice(&other.by_time);
        self.beta.copy_from_slice(&other.beta);
    }
}

/// Two positions of all nodes and the times they belong to.
#[derive(Clone, Copy)]
pub struct Between<'a> {
    /// All positions at the start (D × nodes), m.
    pub from: &'a [f64],
    /// All positions at the end (D × nodes), m.
    pub to: &'a [f64],
    /// Time of the first, s.
    pub start: f64,
    /// Time between them, s.
    pub step: f64,
}

/// Most Newton steps on the scalar equation for β; halving the bracket alone would need 53.
const BETA_ITERATIONS: usize = 60;

impl System {
    /// Room for one evaluation of this system.
    pub fn evaluation(&self) -> Evaluation {
        let customs = self.constraints() - self.rows.len();
        Evaluation {
            value: vec![0.0; self.invariants.len() + self.functions.len() + customs],
            gradient: vec![0.0; self.slots.nodes.len() * self.dim],
            functions: self.functions.values(),
            by_time: vec![0.0; customs],
            beta: vec![0.5; customs],
        }
    }

    /// Position of a quantity among the values of an evaluation.
    #[inline]
    pub(crate) fn value_index(&self, quantity: Quantity) -> usize {
        match quantity {
            Quantity::Invariant(id) => id.0 as usize,
            Quantity::Function(id) => self.invariants.len() + id.0 as usize,
        }
    }

    /// The slope of a part of a row that is a function of one coordinate, by that.
    ///
    /// # Panics
    /// When it is none.
    pub(crate) fn slope_in_row(&self, row: usize, part: usize, at: &Evaluation) -> f64 {
        let Quantity::Function(id) = self.rows[row].quantity else { panic!("a row of a function") };
        self.functions.slope(id, part, &at.value, &at.functions)
    }

    /// The slots of a quantity.
    pub(crate) fn slots_of(&self, quantity: Quantity) -> std::ops::Range<usize> {
        match quantity {
            Quantity::Invariant(id) => self.invariants.slots_of(id),
            Quantity::Function(id) => {
                let (slots, first) = (self.functions.slots_of(id), self.invariants.slots());
                first + slots.start..first + slots.end
            }
        }
    }

    /// Evaluates everything at the positions `x` of all nodes and time `t`. Angles are counted from those of `near`, less
    /// than half a turn away.
    pub fn evaluate(&self, x: &[f64], t: f64, near: &Evaluation, out: &mut Evaluation) {
        out.functions.angle.copy_from_slice(&near.functions.angle);
        self.evaluate_again(x, t, out);
    }

    /// The same with angles counted from those that `out` holds.
    pub fn evaluate_again(&self, x: &[f64], t: f64, out: &mut Evaluation) {
        self.invariants.evaluate(x, &mut out.value, &mut out.gradient);
        if !self.functions.is_empty() {
            self.functions.evaluate(&out.value, &mut out.functions);
            self.take_functions(out);
        }
        self.each_custom(out, |entry, out| {
            let local = gather(self.dim, &entry.nodes, x);
            [&mut *out.value, &mut *out.gradient, &mut *out.by_time].into_iter().for_each(|numbers| numbers.fill(0.0));
            entry.rows.value(&local, t, out.value);
            entry.rows.gradient(&local, t, out.gradient, out.by_time);
        });
    }

    /// Values and gradients of the functions from their derivatives and the gradients of the invariants.
    fn take_functions(&self, out: &mut Evaluation) {
        let first = self.invariants.len();
        out.value[first..].iter_mut().zip(&out.functions.local).for_each(|(value, local)| *value = local.value);
        let (invariants, functions) = out.gradient.split_at_mut(self.invariants.slots() * self.dim);
        let (local, all) = (&out.functions.local, 0..self.functions.len());
        self.functions.compose(self.dim, all, |k, _| local[k].gradient.map(|factor| [factor, 0.0]), invariants, invariants, functions);
    }

    /// The gradients between two positions whose evaluations are `from` and `to`, such that gradient · Δx (+ ∂Φ/∂t Δt)
    /// is the difference of the values: half way for quadratic forms, by discrete derivatives for functions of them, at
    /// the paper's β (15) for custom rows.
    pub fn evaluate_between(&self, span: Between<'_>, from: &Evaluation, to: &Evaluation, out: &mut Evaluation) {
        for ((out, a), b) in out.gradient.iter_mut().zip(&from.gradient).zip(&to.gradient) {
            *out = 0.5 * (a + b);
        }
        for ((out, a), b) in out.value.iter_mut().zip(&from.value).zip(&to.value) {
            *out = 0.5 * (a + b);
        }
        if !self.functions.is_empty() {
            self.functions.evaluate_between([&from.value, &to.value], &from.functions, &to.functions, &mut out.functions);
            self.take_functions(out);
        }
        let mut first = self.invariants.len() + self.functions.len();
        self.each_custom(out, |entry, mut out| {
            let rows = entry.rows.rows();
            for row in 0..rows {
                let rise = to.value[first + row] - from.value[first + row];
                out.beta[row] = directional_point(self.dim, entry, span, row, rise, &mut out);
            }
            first += rows;
        });
    }

    /// Φ (r) from an evaluation and the time it belongs to.
    pub fn constraint_values(&self, at: &Evaluation, t: f64, phi: &mut [f64]) {
        for (phi, row) in phi.iter_mut().zip(&self.rows) {
            *phi = at.value[self.value_index(row.quantity)] - row.target(t)[0];
        }
        phi[self.rows.len()..].copy_from_slice(&at.value[self.invariants.len() + self.functions.len()..]);
    }

    /// Φ̇ = G v + Φ_t (r), `v` over all nodes.
    pub(crate) fn constraint_rates(&self, slots: &[RowSlot], at: &Evaluation, v: &[f64], t: f64, out: &mut [f64]) {
        out.iter_mut().enumerate().for_each(|(row, out)| *out = self.explicit_rate(row, at, t));
        add_along_rows(self.dim, slots, 1.0, &at.gradient, v, out);
    }

    /// ∂Φ_k/∂t with all nodes held.
    pub(crate) fn explicit_rate(&self, row: usize, at: &Evaluation, t: f64) -> f64 {
        match self.rows.get(row) {
            Some(row) => -row.target(t)[1],
            None => at.by_time[row - self.rows.len()],
        }
    }

    /// Gradient of a row along a direction over all nodes.
    #[inline]
    pub(crate) fn along(&self, slots: &std::ops::Range<usize>, nodes: &[u32], at: &Evaluation, v: &[f64]) -> f64 {
        along(self.dim, &nodes[slots.clone()], &at.gradient[slots.start * self.dim..slots.end * self.dim], v)
    }

    /// Rates ∇π_i·v of some invariants at an evaluation.
    pub(crate) fn rates(&self, of: &[InvariantId], at: &Evaluation, v: &[f64]) -> [f64; MAX_ARGUMENTS] {
        let mut rates = [0.0; MAX_ARGUMENTS];
        for (rate, &id) in rates.iter_mut().zip(of) {
            *rate = self.along(&self.invariants.slots_of(id), &self.slots.nodes, at, v);
        }
        rates
    }

    /// Everything in Φ̈ but G a (r): (G v)_q v + 2 Φ_qt v + Φ_tt, at the evaluation `at` of `x`. `half` has room for one
    /// number an invariant.
    pub fn constraint_curvatures(&self, at: &Evaluation, x: &[f64], v: &[f64], t: f64, half: &mut [f64], out: &mut [f64]) {
        self.invariants.half_curvature(v, half);
        for (out, row) in out.iter_mut().zip(&self.rows) {
            let curvature = match row.quantity {
                Quantity::Invariant(id) => 2.0 * half[id.0 as usize],
                Quantity::Function(id) => {
                    let (base, local) = (self.functions.base(id), &at.functions.local[id.0 as usize]);
                    let rates = self.rates(base, at, v);
                    let inner = base.iter().zip(&local.gradient).map(|(id, gradient)| 2.0 * gradient * half[id.0 as usize]);
                    inner.sum::<f64>() + (0..base.len()).map(|i| rates[i] * local.bend(i, &rates)).sum::<f64>()
                }
            };
            *out = curvature - row.target(t)[2];
        }
        if self.custom.is_empty() {
            return;
        }
        let mut first = self.rows.len();
        for entry in &self.custom {
            let (position, velocity) = (gather(self.dim, &entry.nodes, x), gather(self.dim, &entry.nodes, v));
            let rows = entry.rows.rows();
            out[first..first + rows].fill(0.0);
            entry.rows.curvature(&position, &velocity, t, &mut out[first..first + rows]);
            first += rows;
        }
    }

    /// H v of all rows' and laws' slots (D a slot), their second derivatives times a direction, at the evaluation `at`
    /// of `x`. `half` has room for one number an invariant.
    pub(crate) fn turn(&self, at: &Evaluation, x: &[f64], along: Direction<'_>, t: f64, half: &mut [f64], turned: &mut [f64]) {
        self.turn_of(0..self.functions.len(), at, x, along, t, half, turned);
    }

    /// The same without the slots of functions that are no rows, which keep what they hold.
    pub(crate) fn turn_rows(&self, at: &Evaluation, x: &[f64], along: Direction<'_>, t: f64, half: &mut [f64], turned: &mut [f64]) {
        self.turn_of(self.functions_of_rows(), at, x, along, t, half, turned);
    }

    #[expect(clippy::too_many_arguments)] // those of `turn`, and of what
    fn turn_of(
        &self,
        of: impl Iterator<Item = usize>,
        at: &Evaluation,
        x: &[f64],
        along: Direction<'_>,
        t: f64,
        half: &mut [f64],
        turned: &mut [f64],
    ) {
        self.invariants.curvature(along.nodes, half, turned);
        self.turn_functions(of, at, turned, |k, base| {
            let rates = self.rates(base, at, along.nodes);
            let local = &at.functions.local[k];
            std::array::from_fn(|i| [local.gradient[i], local.bend(i, &rates)])
        });
        self.turn_custom(x, along, t, turned);
    }

    /// Where the gradients of the custom rows begin in an evaluation.
    pub(crate) fn custom_slots(&self) -> usize {
        (self.invariants.slots() + self.functions.slots()) * self.dim
    }

    /// The slots of the custom rows in what [`System::turn`] fills.
    pub(crate) fn turn_custom(&self, x: &[f64], along: Direction<'_>, t: f64, turned: &mut [f64]) {
        if self.custom.is_empty() {
            return;
        }
        let mut slot = self.custom_slots();
        for entry in &self.custom {
            let (position, direction) = (gather(self.dim, &entry.nodes, x), gather(self.dim, &entry.nodes, along.nodes));
            let (width, rows) = (position.len(), entry.rows.rows());
            let mut hessian: SmallVec<[f64; SIZE * SIZE]> = smallvec![0.0; width * width];
            let mut mixed: SmallVec<[f64; SIZE * SIZE]> = smallvec![0.0; rows * width];
            if along.time != 0.0 {
                entry.rows.mixed(&position, t, &mut mixed);
            }
            let mut unit: Local = smallvec![0.0; rows];
            for row in 0..rows {
                unit.fill(0.0);
                unit[row] = 1.0;
                hessian.fill(0.0);
                entry.rows.hessian(&position, t, &unit, &mut hessian);
                for i in 0..width {
                    let line = &hessian[i * width..(i + 1) * width];
                    let by_nodes: f64 = line.iter().zip(&direction).map(|(h, v)| h * v).sum();
                    turned[slot + i] = by_nodes + mixed[row * width + i] * along.time;
                }
                slot += width;
            }
        }
    }

    /// The functions that are rows.
    pub(crate) fn functions_of_rows(&self) -> impl Iterator<Item = usize> + '_ {
        self.function_rows.iter().filter_map(|&row| match self.rows[row as usize].quantity {
            Quantity::Function(id) => Some(id.0 as usize),
            Quantity::Invariant(_) => None,
        })
    }

    /// Fills the slots of some functions with `factor` times what the slots of their invariants hold, plus `bend` times
    /// the gradients there; `parts` gives both for each argument of a function.
    pub(crate) fn turn_functions(
        &self,
        of: impl Iterator<Item = usize>,
        at: &Evaluation,
        turned: &mut [f64],
        parts: impl Fn(usize, &[InvariantId]) -> [[f64; 2]; MAX_ARGUMENTS],
    ) {
        if !self.functions.is_empty() {
            let (inner, own) = turned.split_at_mut(self.invariants.slots() * self.dim);
            self.functions.compose(self.dim, of, parts, inner, &at.gradient, own);
        }
    }

    /// Calls `f` for every custom entry with its part of an evaluation.
    fn each_custom(&self, out: &mut Evaluation, mut f: impl FnMut(&CustomEntry, CustomPart<'_>)) {
        if self.custom.is_empty() {
            return;
        }
        let (mut row, mut slot) = (0, self.custom_slots());
        let values = self.invariants.len() + self.functions.len();
        for entry in &self.custom {
            let (rows, width) = (entry.rows.rows(), entry.nodes.len() * self.dim);
            let first = values + row;
            let part = CustomPart {
                value: &mut out.value[first..first + rows],
                gradient: &mut out.gradient[slot..slot + rows * width],
                by_time: &mut out.by_time[row..row + rows],
                beta: &mut out.beta[row..row + rows],
            };
            f(entry, part);
            row += rows;
            slot += rows * width;
        }
    }
}

struct CustomPart<'a> {
    value: &'a mut [f64],
    gradient: &'a mut [f64],
    by_time: &'a mut [f64],
    beta: &'a mut [f64],
}

/// A direction in which positions and time change together.
#[derive(Clone, Copy)]
pub(crate) struct Direction<'a> {
    /// Over all nodes.
    pub nodes: &'a [f64],
    /// How much time goes by: one along a velocity, none along an acceleration.
    pub time: f64,
}

impl<'a> Direction<'a> {
    /// The way of the nodes in a unit of time.
    pub fn velocity(nodes: &'a [f64]) -> Self {
        Self { nodes, time: 1.0 }
    }
}

/// Coordinates of the nodes of a load or custom row.
pub(crate) type Local = SmallVec<[f64; SIZE]>;

/// The coordinates of some nodes.
pub(crate) fn gather(dim: usize, nodes: &[NodeId], x: &[f64]) -> Local {
    nodes.iter().flat_map(|node| &x[node.index() * dim..(node.index() + 1) * dim]).copied().collect()
}

/// The paper's β (15): where on the way from one position to the other a row's gradient times the way is its rise.
/// Writes the gradient there. Half way is taken when it serves, as it does for every quadratic row.
fn directional_point(dim: usize, entry: &CustomEntry, span: Between<'_>, row: usize, rise: f64, out: &mut CustomPart<'_>) -> f64 {
    let (from, mut rate) = (gather(dim, &entry.nodes, span.from), gather(dim, &entry.nodes, span.to));
    let (k, mut local) = (from.len(), from.clone());
    for i in 0..k {
        rate[i] = (rate[i] - from[i]) / span.step;
    }
    let rows = entry.rows.rows();
    let mut gradient: SmallVec<[f64; SIZE * SIZE]> = smallvec![0.0; rows * k];
    let (mut by_time, mut curvature): (Local, Local) = (smallvec![0.0; rows], smallvec![0.0; rows]);
    let (mut beta, mut low, mut high, mut low_sign) = (0.5, 0.0, 1.0, 0.0);
    for _ in 0..BETA_ITERATIONS {
        for i in 0..k {
            local[i] = from[i] + beta * span.step * rate[i];
        }
        let t = span.start + beta * span.step;
        gradient.fill(0.0);
        by_time.fill(0.0);
        entry.rows.gradient(&local, t, &mut gradient, &mut by_time);
        let parts = (0..k).map(|i| gradient[row * k + i] * rate[i]).chain([by_time[row]]);
        // What keeps up with a row that moves is a sum of large parts, and rounded as they are.
        let (along, size) = parts.fold((0.0, 0.0), |(sum, size): (f64, f64), part| (sum + part, size + part.abs()));
        let excess = span.step * along - rise;
        if excess.abs() <= 4.0 * f64::EPSILON * (rise.abs() + span.step * size) {
            break;
        }
        curvature.fill(0.0);
        entry.rows.curvature(&local, &rate, t, &mut curvature);
        let slope = span.step * span.step * curvature[row];
        if low_sign == 0.0 {
            // The mean of the gradient along the way is the rise, so its excess changes sign between the ends.
            low_sign = if slope > 0.0 { -1.0 } else { 1.0 };
        }
        if excess * low_sign > 0.0 {
            low = beta;
        } else {
            high = beta;
        }
        let newton = beta - excess / slope;
        let next = if newton > low && newton < high { newton } else { 0.5 * (low + high) };
        if next == beta {
            break;
        }
        beta = next;
    }
    out.gradient[row * k..row * k + k].copy_from_slice(&gradient[row * k..row * k + k]);
    out.by_time[row] = by_time[row];
    beta
}
