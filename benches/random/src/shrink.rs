//! Smaller mechanisms that fail in the same way.

use std::collections::BTreeSet;

use crate::case::{self, Demand};
use crate::mechanism::Mechanism;

/// Leaves out entries one after the other as long as some failure of the whole is still there that begins with `which`.
pub fn shrink(seed: u64, mut mechanism: Mechanism, which: &str, demand: &Demand) -> Mechanism {
    let mut wanted = sorts(seed, &mechanism, demand);
    wanted.retain(|sort| sort.starts_with(which));
    let fails = |smaller: &Mechanism| !sorts(seed, smaller, demand).is_disjoint(&wanted);
    'again: while !wanted.is_empty() {
        // Forces and loops are behind bodies, and easier to leave out.
        for entry in (0..mechanism.entries.len()).rev() {
            let smaller = mechanism.without(entry);
            if fails(&smaller) {
                mechanism = smaller;
                continue 'again;
            }
        }
        break;
    }
    mechanism
}

/// The failures of a mechanism without their figures.
fn sorts(seed: u64, mechanism: &Mechanism, demand: &Demand) -> BTreeSet<String> {
    let sort = |failure: &String| failure.split([':', ' ']).filter(|word| !word.is_empty()).take(3).collect::<Vec<_>>().join(" ");
    case::judge(seed, mechanism, demand).failures(demand).iter().map(sort).collect()
}
