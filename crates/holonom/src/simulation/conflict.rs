//! Rows that ask for what the others do not allow, such as a drive of what has no freedom left.

use super::Simulation;

/// Passes of the solve: what δ lets the rows miss is left to the next.
const PASSES: usize = 5;

/// Share of what rows ask for that is left where they contradict each other; less is left by curvature and by δ.
const CONTRADICTS: f64 = 1e-3;

/// Rows that ask for less than this share of the mechanism's size ask for nothing.
const NOTHING: f64 = 1e-10;

impl Simulation {
    /// The row, by name, that asks for a motion in the step to come which all rows together do not allow, to first order, at the present
    /// state: no increment d has G d = −Φ(q, t + h). Nothing of the simulation changes.
    pub fn conflict(&mut self) -> Option<&str> {
        let counters = (self.newton.iterations, self.newton.factorizations);
        let row = self.conflicting_row();
        self.hints.restore(&mut self.newton, &mut *self.integrator);
        (self.newton.iterations, self.newton.factorizations) = counters;
        row.map(|row| self.system.row_names[row].as_str())
    }

    fn conflicting_row(&mut self) -> Option<usize> {
        let t = self.state.t + self.nominal_step();
        let (system, newton, work, state) = (&*self.system, &mut self.newton, &mut self.work, &self.state);
        let n = system.coordinates();
        work.end.x.copy_from_slice(&state.x);
        work.end.v.copy_from_slice(&state.v);
        system.place_known(t, &mut work.end.x, &mut work.end.v, &mut work.a);
        system.evaluate(&work.end.x, t, &work.start.at, &mut work.end.at);
        system.constraint_values(&work.end.at, t, &mut work.phi);
        let asked = work.phi.clone();
        let most = work.scaled_violation();
        if most.is_nan() || most <= NOTHING || !newton.factor_inertia(work) {
            return None;
        }
        let mut left = work.phi.clone();
        for _ in 0..PASSES {
            newton.unknowns[..n].fill(0.0);
            newton.unknowns[n..].iter_mut().zip(&left).for_each(|(unknown, left)| *unknown = -left);
            newton.kkt.solve(&mut newton.unknowns);
            let mut along = vec![0.0; work.end.x.len()];
            along[..n].copy_from_slice(&newton.unknowns[..n]);
            system.slots.add_along(system.dim, 1.0, &work.end.at.gradient, &along, &mut left);
        }
        let share = |row: usize| left[row].abs() / (work.scales.gradient[row] * work.scales.length);
        let contradicting = || (0..left.len()).filter(|&row| share(row) > CONTRADICTS * most);
        let worst = |rows: &mut dyn Iterator<Item = usize>| rows.max_by(|&a, &b| share(a).total_cmp(&share(b)));
        // What moves is meant, not what holds.
        let moves = |row: &usize| asked[*row].abs() > NOTHING * work.scales.gradient[*row] * work.scales.length;
        worst(&mut contradicting().filter(moves)).or_else(|| worst(&mut contradicting()))
    }
}
