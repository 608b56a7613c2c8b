//! Values between the rows of a trajectory.

/// The value at a time of the polynomial through some rows of time (s) and value: with four rows a cubic.
pub fn through(rows: &[(f64, f64)], t: f64) -> f64 {
    if let Some((_, value)) = rows.iter().find(|(at, _)| *at == t) {
        return *value;
    }
    let share = |k: usize| {
        let others = rows.iter().enumerate().filter(|(other, _)| *other != k);
        others.map(|(_, (at, _))| (t - at) / (rows[k].0 - at)).product::<f64>()
    };
    rows.iter().enumerate().map(|(k, (_, value))| value * share(k)).sum()
}

/// Rows that a value between rows follows from: half of them before it, half of them after it, where there are so many.
pub const ROWS: usize = 4;

/// The value at a time between the first and the last of some rows, in the order of their times, from those around it.
pub fn between(rows: &[(f64, f64)], t: f64) -> f64 {
    let after = rows.partition_point(|(at, _)| *at < t);
    let first = after.saturating_sub(ROWS / 2).min(rows.len().saturating_sub(ROWS));
    through(&rows[first..rows.len().min(first + ROWS)], t)
}

/// The value of a column at one time, from rows that come one after the other.
#[derive(Clone, Debug, PartialEq)]
pub struct Reading {
    /// s
    t: f64,
    /// The last rows up to those from which the value follows.
    rows: Vec<(f64, f64)>,
}

impl Reading {
    /// Will tell the value at a time.
    pub fn new(t: f64) -> Self {
        Self { t, rows: Vec::with_capacity(ROWS) }
    }

    /// Sees the next row.
    pub fn see(&mut self, t: f64, value: f64) {
        let after = self.rows.iter().filter(|(at, _)| *at >= self.t).count();
        if self.rows.len() == ROWS {
            if after >= ROWS / 2 {
                return;
            }
            self.rows.remove(0);
        }
        self.rows.push((t, value));
    }

    /// The value; nothing where the rows ended before its time.
    pub fn value(&self) -> Option<f64> {
        self.rows.last().filter(|(at, _)| *at >= self.t).map(|_| through(&self.rows, self.t))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(times: &[f64], t: f64) -> Option<f64> {
        let mut reading = Reading::new(t);
        times.iter().for_each(|&at| reading.see(at, at * at * at - 2.0 * at));
        reading.value()
    }

    #[test]
    fn cubics_are_met_between_rows_of_any_distance_also_at_both_ends() {
        let times = [0.0, 0.1, 0.25, 0.3, 0.7, 0.75, 1.0];
        for t in [0.0, 0.04, 0.1, 0.2, 0.29, 0.5, 0.72, 0.9, 1.0] {
            let (found, exact) = (read(&times, t).unwrap(), t * t * t - 2.0 * t);
            assert!((found - exact).abs() < 1e-14, "{t}: {found} {exact}");
            assert_eq!(between(&times.map(|at| (at, at * at * at - 2.0 * at)), t), found, "the same rows");
        }
        assert_eq!(read(&times, 0.25), Some(0.25_f64.powi(3) - 0.5), "a row is met to the bit");
    }

    #[test]
    fn the_rows_are_those_around_the_time() {
        let mut reading = Reading::new(2.5);
        [1e9, 1e9, 0.0, 1.0, 2.0, 3.0, 1e9].iter().enumerate().for_each(|(k, &value)| reading.see(k as f64 - 1.0, value));
        assert_eq!(reading.value(), Some(1.5));
    }

    #[test]
    fn few_rows_are_enough_and_none_is_nothing() {
        assert_eq!(read(&[0.0], 0.0), Some(0.0));
        assert_eq!(read(&[0.0, 1.0], 0.5), Some(-0.5));
        assert_eq!(read(&[0.0, 1.0], 1.5), None);
        assert_eq!(read(&[], 0.0), None);
    }
}
