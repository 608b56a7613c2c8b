//! Rows that ask for what the others do not allow, such as a drive of what has no freedom left.

use super::Simulation;

/// Passes of the solve: what δ lets the rows miss is left to the next.
const PASSES: usize = 5;

/// Share of what rows ask for that is left where they contradict each other; less is left by curvature and by δ.
const CONTRADICTS: f64 = 1e-3;

/// Rows that ask for less than this share of the mechanism's size ask for nothing.
const NOTHING: f64 = 1e-10;

/// How many times the mass that a row moves is what it was at the start where it leads hardly anywhere, and most rows that are looked at.
const STUCK: f64 = 100.0;
const MOST: usize = 50;

impl Simulation {
    /// The row, by name, that asks for a motion in the step to come which all rows together do not allow, to first order, at the present
    /// state: no increment d has G d = −Φ(q, t + h). Nothing of the simulation changes.
    pub fn conflict(&mut self) -> Option<&str> {
        self.ask(Self::conflicting_row).map(|row| self.system.row_names[row].as_str())
    }

    /// Asks something with the matrix of the steps, which go on as if nobody had.
    fn ask<T>(&mut self, question: impl FnOnce(&mut Self) -> T) -> T {
        let counters = (self.newton.iterations, self.newton.factorizations);
        let answer = question(self);
        self.hints.restore(&mut self.newton, &mut *self.integrator);
        (self.newton.iterations, self.newton.factorizations) = counters;
        answer
    }

    /// The row that leads, by name, as that of a drive, which moves many times the mass that it did at the start: it comes to a dead centre, or to the
    /// end of its reach. Nothing of the simulation changes.
    pub(super) fn stuck(&mut self) -> Option<&str> {
        let system = self.system.clone();
        let leading: Vec<usize> = (0..system.rows.len()).filter(|&row| !system.rows[row].is_constant()).take(MOST).collect();
        let (x, t) = (self.state.x.clone(), self.state.t);
        let [now, first] = self.ask(|own| [(&x, t), (&system.start_position, 0.0)].map(|(x, t)| own.masses(&leading, x, t)));
        let growth = now?.into_iter().zip(first?).map(|(now, first)| now / first);
        let (row, growth) = leading.into_iter().zip(growth).max_by(|a, b| a.1.total_cmp(&b.1))?;
        (growth > STUCK).then(|| self.system.row_names[row].as_str())
    }

    /// The mass that each of some rows moves at a place and time, in units of its own: the diagonal of (G M⁻¹Gᵀ)⁻¹.
    fn masses(&mut self, rows: &[usize], x: &[f64], t: f64) -> Option<Vec<f64>> {
        let (system, newton, work) = (&*self.system, &mut self.newton, &mut self.work);
        work.end.x.copy_from_slice(x);
        system.place_known(t, &mut work.end.x, &mut work.end.v, &mut work.a);
        system.evaluate(&work.end.x, t, &work.start.at, &mut work.end.at);
        let is_known = rows.is_empty() || newton.factor_inertia(work);
        let of_row = |&row: &usize| {
            let multiplier = system.coordinates() + row;
            newton.unknowns.fill(0.0);
            newton.unknowns[multiplier] = 1.0;
            newton.kkt.solve(&mut newton.unknowns);
            newton.unknowns[multiplier].abs()
        };
        is_known.then(|| rows.iter().map(of_row).collect())
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
