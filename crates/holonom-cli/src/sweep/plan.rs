//! Which runs there are: a full grid, random samples, or the rows of a table.

use std::collections::HashSet;

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

use super::vary::{Setting, Values, Vary};
use crate::failure::Failure;
use crate::options::SweepArguments;

/// Most runs of a sweep: what its table can hold in memory.
const MOST_RUNS: u64 = 1_000_000;

/// What is varied, and how many runs that makes. Runs have the numbers 1, 2, …
#[derive(Debug)]
pub struct Plan {
    /// Keys and their values.
    pub varied: Vec<Vary>,
    /// Number of runs.
    pub runs: u64,
    kind: Kind,
}

/// How values are put together.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    /// Every value of a key with every value of the others.
    Grid,
    /// Random samples, with their seed.
    Samples(u64),
    /// The first values of all keys, the second of all keys, …
    Rows,
}

impl Plan {
    /// Reads what is to be varied.
    pub fn new(arguments: &SweepArguments) -> Result<Self, Failure> {
        let varied = arguments.vary.iter().map(|given| Vary::parse(given)).collect::<Result<Vec<_>, _>>()?;
        let mut seen = HashSet::new();
        if let Some(twice) = varied.iter().find(|vary| !seen.insert(&vary.path)) {
            return Err(Failure::usage(format!("`{}` is varied twice", twice.path), "put all its values behind one --vary"));
        }
        match arguments.samples {
            Some(samples) => {
                varied.iter().try_for_each(refuse_count)?;
                Self::of(varied, Some(samples), Kind::Samples(arguments.seed))
            }
            None => Self::grid(varied),
        }
    }

    /// Every value of a key with every value of the others.
    pub fn grid(varied: Vec<Vary>) -> Result<Self, Failure> {
        let counts = varied.iter().map(count).collect::<Result<Vec<_>, _>>()?;
        Self::of(varied, counts.iter().try_fold(1, |runs: u64, n| runs.checked_mul(*n)), Kind::Grid)
    }

    /// The rows of a table, of which each key has a column; all are equally long.
    pub fn rows(varied: Vec<Vary>) -> Result<Self, Failure> {
        let runs = varied.first().map_or(Ok(0), count)?;
        Self::of(varied, Some(runs), Kind::Rows)
    }

    fn of(varied: Vec<Vary>, runs: Option<u64>, kind: Kind) -> Result<Self, Failure> {
        match runs {
            Some(0) => Err(Failure::usage("there is nothing to run", "vary a key over one value at least")),
            Some(runs) if runs <= MOST_RUNS => Ok(Self { varied, runs, kind }),
            _ => {
                let cure = "vary over fewer values, or take samples of them";
                Err(Failure::usage(format!("that is more than {MOST_RUNS} runs"), cure))
            }
        }
    }

    /// Whether every value of a key is run with every value of the others.
    pub fn is_grid(&self) -> bool {
        self.kind == Kind::Grid
    }

    /// The values of a run, one for each key that is varied: a function of its number alone.
    pub fn settings(&self, run: u64) -> Vec<Setting> {
        match self.kind {
            Kind::Grid => self.cell(run - 1),
            Kind::Samples(seed) => self.sample(seed, run),
            Kind::Rows => self.row(run - 1),
        }
    }

    /// The values of a cell of the grid; the last key varies fastest.
    fn cell(&self, mut cell: u64) -> Vec<Setting> {
        let mut settings: Vec<Setting> = Vec::with_capacity(self.varied.len());
        for vary in self.varied.iter().rev() {
            let count = count(vary).expect("the grid was counted");
            let k = cell % count;
            cell /= count;
            settings.push(match &vary.values {
                Values::Range(range) => range.at(k as f64 / (count - 1) as f64),
                Values::List(items) => items[k as usize].clone(),
            });
        }
        settings.reverse();
        settings
    }

    /// The values of a row of a table.
    fn row(&self, row: u64) -> Vec<Setting> {
        let value = |vary: &Vary| match &vary.values {
            Values::List(items) => items[row as usize].clone(),
            Values::Range(_) => unreachable!("a column has its values"),
        };
        self.varied.iter().map(value).collect()
    }

    /// Random values. Every run has a stream of its own, so that more samples only add to fewer.
    fn sample(&self, seed: u64, run: u64) -> Vec<Setting> {
        let mut key = [0; 32];
        key[..8].copy_from_slice(&seed.to_le_bytes());
        let mut random = ChaCha8Rng::from_seed(key);
        random.set_stream(run);
        let draw = |vary: &Vary| {
            // The 53 bits of a double in 0 … 1.
            let share = (random.next_u64() >> 11) as f64 / (1u64 << 53) as f64;
            match &vary.values {
                Values::Range(range) => range.at(share),
                Values::List(items) => items[(share * items.len() as f64) as usize].clone(),
            }
        };
        self.varied.iter().map(draw).collect()
    }
}

/// Refuses a number of values where samples are drawn.
fn refuse_count(vary: &Vary) -> Result<(), Failure> {
    match &vary.values {
        Values::Range(range) if range.count.is_some() => {
            let message = format!("the range of `{}` has a number of values, and --samples draws from all of it", vary.path);
            Err(Failure::usage(message, "write lo..hi or lo..hi:log, or leave out --samples"))
        }
        _ => Ok(()),
    }
}

/// Number of values of a key in a grid.
fn count(vary: &Vary) -> Result<u64, Failure> {
    match &vary.values {
        Values::List(items) => Ok(items.len() as u64),
        Values::Range(range) => range.count.ok_or_else(|| {
            let path = &vary.path;
            Failure::usage(
                format!("the range of `{path}` has no number of values"),
                format!("write --vary {path}=lo..hi:20, or give --samples"),
            )
        }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plan(vary: &[&str], seed: Option<u64>) -> Plan {
        let varied: Vec<Vary> = vary.iter().map(|given| Vary::parse(given).unwrap()).collect();
        match seed {
            Some(seed) => Plan::of(varied, Some(100), Kind::Samples(seed)).unwrap(),
            None => Plan::grid(varied).unwrap(),
        }
    }

    fn texts(plan: &Plan, run: u64) -> Vec<String> {
        plan.settings(run).into_iter().map(|setting| setting.text).collect()
    }

    #[test]
    fn the_last_key_of_a_grid_varies_fastest() {
        let plan = plan(&["a=1..3:3", "b=x,y"], None);
        let runs: Vec<String> = (1..=plan.runs).map(|run| texts(&plan, run).join(" ")).collect();
        assert_eq!(runs, ["1 x", "1 y", "2 x", "2 y", "3 x", "3 y"]);
    }

    #[test]
    fn the_runs_of_a_table_are_its_rows() {
        let columns = ["a=1,2,3", "b=x,y,z"].map(|given| Vary::parse(given).unwrap());
        let plan = Plan::rows(columns.into()).unwrap();
        let runs: Vec<String> = (1..=plan.runs).map(|run| texts(&plan, run).join(" ")).collect();
        assert_eq!(runs, ["1 x", "2 y", "3 z"]);
        assert!(!plan.is_grid() && Plan::rows(Vec::new()).unwrap_err().to_string().contains("nothing to run"));
    }

    /// The figures are of ChaCha with eight rounds as another program has it, key 1, nonces 1 and 100.
    #[test]
    fn samples_follow_from_the_seed_and_the_number_of_the_run() {
        let (one, other) = (plan(&["a=0..1", "b=x,y,z"], Some(1)), plan(&["a=0..1", "b=x,y,z"], Some(2)));
        let shares: Vec<f64> = (1..=100).map(|run| texts(&one, run)[0].parse().unwrap()).collect();
        let mean = shares.iter().sum::<f64>() / 100.0;
        assert!(shares.iter().all(|share| (0.0..1.0).contains(share)) && (mean - 0.5).abs() < 0.1, "{mean}");
        assert!(["x", "y", "z"].iter().all(|word| (1..=100).any(|run| texts(&one, run)[1] == *word)));
        assert_ne!(texts(&one, 1), texts(&other, 1));
        assert_ne!(texts(&one, 1), texts(&one, 2));
        assert_eq!([shares[0], shares[99]], [0.10353313864874247, 0.7647922365993575]);
    }
}
