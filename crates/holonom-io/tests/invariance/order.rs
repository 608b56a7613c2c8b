//! The order of a file, what it leaves to parameters and repetitions, and whether it asks for forces.

use holonom::model::{Table, Value};

use super::cases::Case;
use super::change::Change;
use super::columns::Column;
use super::sections::{entries, with_entries};

/// Entries in the order that their keys have, which are numbered as they stand; sections follow their first entries.
fn ordered(description: &Table, key: impl Fn(usize) -> u64) -> Table {
    let mut keyed: Vec<_> = entries(description).into_iter().enumerate().map(|(k, entry)| (key(k), entry)).collect();
    keyed.sort_by_key(|(key, _)| *key);
    with_entries(description, keyed.into_iter().map(|(_, entry)| entry))
}

/// Random numbers that are the same in every run (splitmix64).
fn random(seed: u64) -> u64 {
    let mut z = seed.wrapping_mul(0x9E37_79B9_7F4A_7C15);
    z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    z ^ (z >> 31)
}

fn check(name: &str, keeps_rows: bool, make: &dyn Fn(&Case) -> Table) {
    Column { name, bound: &|case| case.bound, keeps_rows }.check(&|case| Some((make(case), Change::default())));
}

#[test]
fn entries_in_the_reverse_order() {
    check("entries reversed", true, &|case| ordered(&case.description, |k| u64::MAX - k as u64));
}

#[test]
fn entries_in_a_random_order() {
    for seed in 1..=3 {
        let name = format!("entries shuffled, {seed}");
        check(&name, true, &|case| ordered(&case.description, |k| random(1000 * seed + k as u64)));
    }
}

/// With nothing shared there are other nodes and other rows; the freedom is the same.
#[test]
fn forces_asked_for() {
    check("reactions = true", false, &|case| {
        let mut description = case.description.clone();
        description.set("output", Value::Table([("reactions", Value::Bool(true))].into_iter().collect()));
        description
    });
}

/// What this test makes of a file is the same model.
#[test]
fn parameters_and_repetitions_written_out() {
    check("not written out", true, &|case| case.original.clone());
}
