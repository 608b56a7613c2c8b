//! What the runs left: columns of numbers, and what is asked of them.

use std::collections::HashMap;
use std::path::Path;

use super::runs::RUNS;

/// The results of all runs.
pub struct Results(Vec<Entry>);

struct Entry {
    /// Name of the runs, method and step.
    key: [&'static str; 3],
    series: Series,
}

/// One run: the columns of its table.
pub struct Series {
    columns: HashMap<String, Vec<f64>>,
}

impl Results {
    /// Runs everything and reads what it wrote into a folder below `root`.
    pub fn of(root: &Path, folder: &str) -> Result<Self, String> {
        let mut results = Vec::new();
        for runs in RUNS {
            runs.run(root, folder)?;
            for (method, step, file) in runs.files() {
                let series = Series::read(&root.join(folder).join(runs.name).join(file))?;
                results.push(Entry { key: [runs.name, method, step], series });
            }
        }
        Ok(Self(results))
    }

    /// A run by the names that [`RUNS`] has, where there is one step.
    pub fn of_run(&self, runs: &str, method: &str) -> &Series {
        let step = RUNS.iter().find(|entry| entry.name == runs).map_or("", |entry| entry.steps[0]);
        self.of_step(runs, method, step)
    }

    pub fn of_step(&self, runs: &str, method: &str, step: &str) -> &Series {
        let entry = self.0.iter().find(|entry| entry.key == [runs, method, step]);
        &entry.unwrap_or_else(|| panic!("the table of runs has no `{method}` with {step} s in `{runs}`")).series
    }

    /// The paper's pendulum over 20 s, step 0.025 s.
    pub fn pendulum(&self, method: &str) -> &Series {
        self.of_run("pendulum", method)
    }
}

impl Series {
    fn read(path: &Path) -> Result<Self, String> {
        let fault = |error: csv::Error| format!("{}: {error}", path.display());
        let mut reader = csv::Reader::from_path(path).map_err(fault)?;
        let names = reader.headers().map_err(fault)?.clone();
        let mut columns = vec![Vec::new(); names.len()];
        for record in reader.records() {
            for (column, cell) in columns.iter_mut().zip(record.map_err(fault)?.iter()) {
                column.push(cell.parse().unwrap_or(f64::NAN));
            }
        }
        match columns.first() {
            Some(rows) if !rows.is_empty() => Ok(Self { columns: names.iter().map(str::to_string).zip(columns).collect() }),
            _ => Err(format!("{}: no rows", path.display())),
        }
    }

    pub fn column(&self, name: &str) -> &[f64] {
        self.columns.get(name).unwrap_or_else(|| panic!("the trajectory has no column `{name}`"))
    }

    /// s.
    pub fn times(&self) -> &[f64] {
        self.column("t")
    }

    pub fn end(&self) -> f64 {
        last(self.times())
    }

    pub fn last(&self, column: &str) -> f64 {
        last(self.column(column))
    }

    pub fn largest(&self, column: &str) -> f64 {
        largest(self.column(column))
    }

    /// The value in the first row at or after a time.
    pub fn at(&self, time: f64, column: &str) -> f64 {
        let row = self.times().iter().position(|t| *t > time - 1e-9).unwrap_or(self.times().len() - 1);
        self.column(column)[row]
    }

    /// Rows from one time to another, both included.
    pub fn between(&self, from: f64, to: f64, values: &[f64]) -> Vec<f64> {
        let inside = |t: &f64| (from - 1e-9..=to + 1e-9).contains(t);
        self.times().iter().zip(values).filter(|(t, _)| inside(t)).map(|(_, value)| *value).collect()
    }

    /// Energy minus energy at the start, J.
    pub fn energy_change(&self) -> Vec<f64> {
        let energy = self.column("energy");
        energy.iter().map(|e| e - energy[0]).collect()
    }

    /// Energy at the end minus energy at the start, J.
    pub fn energy_gained(&self) -> f64 {
        last(&self.energy_change())
    }

    /// Largest distance of the energy from where it started, J.
    pub fn energy_drift(&self) -> f64 {
        largest(&self.energy_change().iter().map(|change| change.abs()).collect::<Vec<_>>())
    }

    /// Largest rise of the energy in a step, J; 0 where it never rises.
    pub fn energy_rise(&self) -> f64 {
        self.column("energy").windows(2).map(|pair| pair[1] - pair[0]).fold(0.0, f64::max)
    }

    /// First time at which the energy is 1 J away from where it started, s; infinite where it never is.
    pub fn leaves(&self) -> f64 {
        self.first(&self.energy_change(), |change| change.abs() > 1.0)
    }

    /// First time at which something holds of a value, s.
    pub fn first(&self, values: &[f64], holds: impl Fn(f64) -> bool) -> f64 {
        self.times().iter().zip(values).find(|(_, value)| holds(**value)).map_or(f64::INFINITY, |(t, _)| *t)
    }

    /// Distance of a point in the plane from the origin beyond 1 m, m.
    pub fn stretch(&self) -> Vec<f64> {
        self.column("bob.x").iter().zip(self.column("bob.y")).map(|(x, y)| x.hypot(*y) - 1.0).collect()
    }
}

pub fn last(values: &[f64]) -> f64 {
    values[values.len() - 1]
}

pub fn largest(values: &[f64]) -> f64 {
    values.iter().copied().fold(f64::NEG_INFINITY, f64::max)
}

pub fn smallest(values: &[f64]) -> f64 {
    values.iter().copied().fold(f64::INFINITY, f64::min)
}
