//! What became of many mechanisms: counts, the worst figures, and the seeds that failed.

use std::collections::BTreeMap;

use crate::case::{Case, Demand};
use crate::judge::{BROKEN, Ending, PROMISES};
use crate::rank::Agreement;

/// Time of a run over the median of its class from which on it is slow.
const SLOW: f64 = 100.0;

/// Shortest time of a run that can be slow, s: less may be the machine's.
const NOTICED: f64 = 0.05;

/// Seeds that are named of a sort of failure.
const NAMED: usize = 8;

/// How long a run took, s.
struct Time {
    seconds: f64,
    seed: u64,
    ending: &'static str,
}

/// Sums over cases.
#[derive(Default)]
pub struct Report {
    cases: usize,
    /// Counts of endings for each method, by word.
    endings: BTreeMap<(usize, &'static str), usize>,
    /// Of rank and start.
    agreements: BTreeMap<(&'static str, &'static str), usize>,
    /// Worst figure of each promise of each method among runs that kept all, and its seed.
    worst: BTreeMap<(usize, usize), (f64, u64)>,
    /// Seeds by sort of what happened.
    honest: BTreeMap<String, Vec<u64>>,
    failed: BTreeMap<String, Vec<u64>>,
    /// Times by method and class of size.
    times: BTreeMap<(usize, u32), Vec<Time>>,
}

impl Report {
    /// Adds a case.
    pub fn add(&mut self, case: &Case, demand: &Demand) {
        self.cases += 1;
        if let Some(ending) = &case.refused {
            self.sort("model", ending, case.seed);
        }
        for (what, found) in [("rank", &case.rank), ("start", &case.start)] {
            let word = match found {
                Some(Agreement::Agree) => "agrees",
                Some(Agreement::Unclear) => "unclear",
                Some(Agreement::Differ(sort, _)) => {
                    self.failed.entry(format!("{what}: difference {sort}")).or_default().push(case.seed);
                    "differs"
                }
                None => "no model",
            };
            *self.agreements.entry((what, word)).or_default() += 1;
        }
        for (method, (named, run)) in demand.methods.iter().zip(&case.runs).enumerate() {
            *self.endings.entry((method, run.ending.word())).or_default() += 1;
            self.sort(named.name, &run.ending, case.seed);
            let class = case.size.map_or(0, |[n, r]| (n + r).max(1).ilog2());
            self.times.entry((method, class)).or_default().push(Time { seconds: run.seconds, seed: case.seed, ending: run.ending.word() });
            if let (Ending::Kept, Some(figures)) = (&run.ending, run.figures) {
                self.compare(method, figures.over_their_units, case.seed);
            }
        }
    }

    fn compare(&mut self, method: usize, figures: [f64; 4], seed: u64) {
        for (promise, figure) in figures.into_iter().enumerate() {
            let worst = self.worst.entry((method, promise)).or_insert((0.0, seed));
            if figure > worst.0 {
                *worst = (figure, seed);
            }
        }
    }

    fn sort(&mut self, who: &str, ending: &Ending, seed: u64) {
        if *ending == Ending::Kept {
            return;
        }
        let sort = format!("{who}: {}: {}", ending.word(), sort_of(ending.reason()));
        let sorts = if ending.is_failure() { &mut self.failed } else { &mut self.honest };
        sorts.entry(sort).or_default().push(seed);
    }

    /// Seeds with runs that took far longer than others of their size.
    pub fn find_slow(&mut self, demand: &Demand) -> Vec<u64> {
        let mut slow = Vec::new();
        for (&(method, _), times) in &mut self.times {
            times.sort_by(|a, b| a.seconds.total_cmp(&b.seconds));
            let limit = (SLOW * times[times.len() / 2].seconds).max(NOTICED);
            for time in times.iter().filter(|time| time.seconds > limit) {
                let sort =
                    format!("{}: {SLOW} times slower than the median of its size, then {}", demand.methods[method].name, time.ending);
                self.failed.entry(sort).or_default().push(time.seed);
                slow.push(time.seed);
            }
        }
        slow
    }

    pub fn has_failures(&self) -> bool {
        !self.failed.is_empty()
    }

    /// Prints everything.
    pub fn print(&self, demand: &Demand) {
        println!("{} mechanisms", self.cases);
        for what in ["rank", "start"] {
            let of = self.agreements.iter().filter(|((of, _), _)| *of == what);
            let counts: Vec<String> = of.map(|((_, word), count)| format!("{word} {count}")).collect();
            println!("{what:24} {}", counts.join(", "));
        }
        for (method, named) in demand.methods.iter().enumerate() {
            let of = self.endings.iter().filter(|((of, _), _)| *of == method);
            let counts: Vec<String> = of.map(|((_, word), count)| format!("{word} {count}")).collect();
            println!("{:24} {}", named.name, counts.join(", "));
            self.print_worst(method);
        }
        print_sorts("Honest", &self.honest);
        print_sorts("Failed", &self.failed);
    }

    fn print_worst(&self, method: usize) {
        let of = self.worst.iter().filter(|((of, _), _)| *of == method);
        let worst: Vec<String> = of.map(|((_, promise), (figure, seed))| format!("{} {figure:.0e} ({seed})", PROMISES[*promise])).collect();
        println!("{:24} worst of those kept, {BROKEN:.0e} is the limit: {}", "", worst.join(", "));
        let classes = self.times.iter().filter(|((of, _), _)| *of == method);
        // They are in order since the slow ones were looked for.
        let median = |times: &[Time]| format!("{:.2} to {:.0}", 1e3 * times[times.len() / 2].seconds, 1e3 * times[times.len() - 1].seconds);
        let times: Vec<String> = classes.map(|((_, class), times)| format!("{}: {}", 1 << class, median(times))).collect();
        println!("{:24} median and longest, ms, by unknowns: {}", "", times.join(", "));
    }
}

fn print_sorts(title: &str, sorts: &BTreeMap<String, Vec<u64>>) {
    println!("\n{title}:");
    let mut sorts: Vec<_> = sorts.iter().collect();
    sorts.sort_by_key(|(_, seeds)| std::cmp::Reverse(seeds.len()));
    for (sort, seeds) in sorts {
        let named: Vec<String> = seeds.iter().take(NAMED).map(u64::to_string).collect();
        let more = if seeds.len() > NAMED { ", …" } else { "" };
        println!("{:6}  {sort}\n        seeds {}{more}", seeds.len(), named.join(", "));
    }
}

/// A reason without its numbers and names, so that alike ones are counted together.
fn sort_of(reason: &str) -> String {
    let first = reason.lines().next().unwrap_or("");
    let first = first.split("; the worst row").next().unwrap_or("").split(" at t =").next().unwrap_or("");
    let mut sort = String::new();
    let mut in_name = false;
    for c in first.chars() {
        match c {
            '`' => in_name = !in_name,
            _ if in_name => (),
            '0'..='9' | '.' | '-' if sort.ends_with(['#', 'e']) && (c != 'e') => sort = sort.trim_end_matches('#').to_string() + "#",
            '0'..='9' => sort.push('#'),
            c => sort.push(c),
        }
    }
    sort
}
