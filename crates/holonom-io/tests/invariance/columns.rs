//! Columns of the table: what is done to every model, and how far its motion then is from that of the model as it was.

use holonom::model::Table;

use super::cases::{Case, METHODS, cases};
use super::change::Change;
use super::exceptions::exception;
use super::motion::{Moment, Track, differs, run};
use super::transform::changed;

/// Largest difference of iterations a step, on average over a run.
const ITERATIONS: f64 = 1.0;

/// A column of the table.
pub struct Column<'a> {
    pub name: &'a str,
    /// Largest difference of the motions over the scale of a model.
    pub bound: &'a dyn Fn(&Case) -> f64,
    /// Whether ranks and numbers of redundant rows stay, and not the freedom alone.
    pub keeps_rows: bool,
}

/// What was found of a model.
pub struct Finding {
    figure: f64,
    what: String,
    faults: Vec<String>,
}

impl Finding {
    /// A motion that differs so much, at most to `bound`.
    pub fn new(figure: f64, what: String, bound: f64) -> Self {
        let fault = format!("the motion differs by {figure:.1e} of its scale, above {bound:.1e}: {what}");
        Self { figure, what, faults: if figure > bound { vec![fault] } else { Vec::new() } }
    }

    /// A run that did not get to its end.
    pub fn stopped(reason: String) -> Self {
        Self { figure: f64::INFINITY, what: reason.clone(), faults: vec![reason] }
    }
}

impl Column<'_> {
    /// Does something to every model to which it can be done, runs it, and asserts that nothing has changed.
    pub fn check(&self, make: &dyn Fn(&Case) -> Option<(Table, Change)>) {
        self.conclude(&mut |case, method| {
            let (description, change) = make(case)?;
            let track = run(&description, METHODS[method], case.step * change.time, case.steps);
            Some(self.compare(case, &case.tracks[method], &track, &change, method == 0))
        });
    }

    /// Prints the line of the column and asserts that nothing was found against it.
    pub fn conclude(&self, find: &mut dyn FnMut(&Case, usize) -> Option<Finding>) {
        let (mut worst, mut faults, mut count) = ((-1.0, String::new()), Vec::new(), 0);
        for case in cases() {
            for (k, method) in METHODS.iter().enumerate() {
                let Some(finding) = find(case, k) else { continue };
                count += 1;
                let label = format!("{}, {method}", case.name);
                if finding.figure > worst.0 {
                    worst = (finding.figure, format!("{label}: {}", finding.what));
                }
                faults.extend(finding.faults.iter().map(|fault| format!("{label}: {fault}")));
            }
        }
        println!("| {:22} | {count:3} | {:3} | {:8.1e} | {} |", self.name, faults.len(), worst.0, worst.1);
        assert!(faults.is_empty(), "{}: {} of {count} runs differ\n{}\n", self.name, faults.len(), faults.join("\n"));
    }

    fn compare(&self, case: &Case, old: &Track, new: &Track, change: &Change, holds_velocities: bool) -> Finding {
        if old.status != new.status {
            return Finding::stopped(new.status.clone());
        }
        let (mut figure, mut what) = (0.0, String::new());
        for (old, new) in old.moments.iter().zip(&new.moments) {
            let mut moments = [old.clone(), new.back(change, &case.coordinates)];
            if change.turns() && !holds_velocities {
                moments = moments.map(Moment::without_rates);
            }
            let found = differs(&moments[0], &moments[1], &case.coordinates, &case.scale);
            if found.0 > figure {
                (figure, what) = found;
            }
        }
        let known = exception(&case.name, self.name);
        let mut finding = Finding::new(figure, what, known.map_or((self.bound)(case), |known| known.bound));
        let names = ["freedom", "number of redundant rows", "rank"];
        let keeps_rows = known.map_or(self.keeps_rows, |known| known.keeps_rows);
        let kept = if keeps_rows { &names[..] } else { &names[..1] };
        for (k, name) in kept.iter().enumerate().filter(|&(k, _)| old.size[k] != new.size[k]) {
            finding.faults.push(format!("the {name} is {} in place of {}", new.size[k], old.size[k]));
        }
        if (new.iterations - old.iterations).abs() > known.map_or(ITERATIONS, |known| known.iterations) {
            finding.faults.push(format!("{:.1} iterations a step in place of {:.1}", new.iterations, old.iterations));
        }
        finding
    }
}

/// A column of one change of units or frame for all models.
pub fn check_change(name: &str, change: impl Fn(&Case) -> Option<Change>) {
    check_change_to(name, &|case| case.bound, change);
}

/// The same with a bound of its own.
pub fn check_change_to(name: &str, bound: &dyn Fn(&Case) -> f64, change: impl Fn(&Case) -> Option<Change>) {
    let column = Column { name, bound, keeps_rows: true };
    column.check(&|case| {
        let change = change(case)?;
        Some((changed(&case.description, &change, &case.coordinates), change))
    });
}
