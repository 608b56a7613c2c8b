//! From what laws do to their arguments to what they do to the invariants that these depend on.

use super::{Evaluation, LawEntry, MAX_ARGUMENTS, Quantity, Response, System};

impl System {
    /// Values of the arguments of a law.
    pub(crate) fn arguments(&self, law: &LawEntry, at: &Evaluation) -> [f64; MAX_ARGUMENTS] {
        let mut values = [0.0; MAX_ARGUMENTS];
        law.arguments.iter().zip(&mut values).for_each(|(&quantity, out)| *out = at.value[self.value_index(quantity)]);
        values
    }

    /// The same and their rates.
    pub(crate) fn arguments_and_rates(&self, law: &LawEntry, at: &Evaluation, v: &[f64]) -> [[f64; MAX_ARGUMENTS]; 2] {
        let mut rates = [0.0; MAX_ARGUMENTS];
        for (rate, &quantity) in rates.iter_mut().zip(&law.arguments) {
            *rate = self.along(&self.slots_of(quantity), &self.slots.nodes, at, v);
        }
        [self.arguments(law, at), rates]
    }

    /// Rates of the arguments of a law at a state with the velocities `v` and the time `t`. What it responds with by these goes to `out`, which
    /// arrives zeroed.
    pub(crate) fn respond(&self, law: &LawEntry, at: &Evaluation, v: &[f64], t: f64, out: &mut Response) -> [f64; MAX_ARGUMENTS] {
        let ([values, rates], m) = (self.arguments_and_rates(law, at, v), law.arguments.len());
        law.law.at(&values[..m], &rates[..m], t, out);
        rates
    }

    /// Turns what a law responds with by its arguments into what it is by its invariants, one after the other. `at` is where the
    /// forces' gradients are, `end` where the values are that the forces depend on, `v` the velocities there.
    ///
    /// With J = ∂(arguments)/∂(invariants): f_π = Jᵀf and its derivative by invariants Jᵀ f_x J + f·∂J/∂π, and where f
    /// depends on rates ẋ = Jπ̇ also Jᵀ f_ẋ ∂(Jπ̇)/∂π.
    pub(crate) fn by_invariants(&self, law: &LawEntry, out: &mut Response, at: &Evaluation, end: &Evaluation, v: &[f64]) {
        if law.arguments.len() == law.invariants.len() && law.arguments.iter().all(|argument| matches!(argument, Quantity::Invariant(_))) {
            return;
        }
        let (own, m) = (std::mem::take(out), law.arguments.len());
        // J at both places, and ∂(Jπ̇)/∂π.
        let [mut left, mut right, mut turned] = [[[0.0; MAX_ARGUMENTS]; MAX_ARGUMENTS]; 3];
        let mut first = 0;
        for (k, &argument) in law.arguments.iter().enumerate() {
            match argument {
                Quantity::Invariant(_) => {
                    (left[k][first], right[k][first]) = (1.0, 1.0);
                    first += 1;
                }
                Quantity::Function(id) => {
                    let (base, function) = (self.functions.base(id), id.0 as usize);
                    let (local, there) = (&at.functions.local[function], &end.functions.local[function]);
                    let rates = if law.law.conservative() { [0.0; MAX_ARGUMENTS] } else { self.rates(base, at, v) };
                    for i in 0..base.len() {
                        left[k][first + i] = local.gradient[i];
                        right[k][first + i] = there.gradient[i];
                        turned[k][first + i] = local.bend(i, &rates);
                        for j in 0..base.len() {
                            out.by_value[first + i][first + j] += own.force[k] * local.hessian[i][j];
                        }
                    }
                    first += base.len();
                }
            }
        }
        for k in 0..m {
            for i in 0..first {
                out.force[i] += left[k][i] * own.force[k];
                for l in 0..m {
                    for j in 0..first {
                        out.by_value[i][j] += left[k][i] * (own.by_value[k][l] * right[l][j] + own.by_rate[k][l] * turned[l][j]);
                        out.by_rate[i][j] += left[k][i] * own.by_rate[k][l] * right[l][j];
                    }
                }
            }
        }
    }
}
