//! What must not matter: units, the order of a file, where and how a model lies, its mirror image, the direction of
//! time, and whether forces are asked for. Motion, freedom, redundant rows and the number of iterations stay.
//!
//! Every test is a column of a table: `cargo test -p holonom-io --test invariance -- --nocapture` prints a line for each,
//! with the number of runs, what was found against them, the worst figure and the model that has it.

#[path = "invariance/cases.rs"]
mod cases;
#[path = "invariance/change.rs"]
mod change;
#[path = "invariance/columns.rs"]
mod columns;
#[path = "invariance/exceptions.rs"]
mod exceptions;
#[path = "invariance/expression.rs"]
mod expression;
#[path = "invariance/formulas.rs"]
mod formulas;
#[path = "invariance/frames.rs"]
mod frames;
#[path = "invariance/motion.rs"]
mod motion;
#[path = "invariance/order.rs"]
mod order;
#[path = "invariance/reverse.rs"]
mod reverse;
#[path = "invariance/sections.rs"]
mod sections;
#[path = "invariance/special.rs"]
mod special;
#[path = "invariance/transform.rs"]
mod transform;
#[path = "invariance/units.rs"]
mod units;
#[path = "invariance/written.rs"]
mod written;

use change::Change;
use columns::check_change;

#[test]
fn hard_models_have_the_freedom_that_counting_gives() {
    let found =
        |name: &str| cases::cases().iter().find(|case| case.name == name).map(|case| case.tracks.each_ref().map(|track| track.size[0]));
    let wrong = cases::FREEDOM.iter().filter(|(name, freedom)| found(name) != Some([*freedom; 2]));
    let wrong: Vec<String> = wrong.map(|(name, freedom)| format!("{name}: {:?} in place of {freedom}", found(name))).collect();
    println!("| {:22} | {:3} | {:3} |          | |", "freedom by counting", cases::FREEDOM.len(), wrong.len());
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// A test for each change of units: its name in the table, and the new numbers over the old ones of 1 m, 1 kg and 1 s.
macro_rules! units {
    ($($test:ident: $name:literal, $length:expr, $mass:expr, $time:expr;)*) => {
        $(#[test]
        fn $test() {
            check_change($name, |_| Some(Change::units($length, $mass, $time)));
        })*
    };
}

units! {
    // Every rounding is another one, and nothing else: what differs here is ill-conditioned, or the test is wrong.
    similar_units: "length × 1.3, mass × 0.7, time × 1.1", 1.3, 0.7, 1.1;
    // No rounding is another one: without constants that have a unit, every figure is zero.
    lengths_by_a_power_of_four: "length × 2^20", 1_048_576.0, 1.0, 1.0;
    lengths_by_a_smaller_power_of_four: "length × 2^10", 1024.0, 1.0, 1.0;
    lengths_by_a_power_of_a_quarter: "length × 2^-20", 1.0 / 1_048_576.0, 1.0, 1.0;
    lengths_by_a_large_power_of_four: "length × 2^60", 1_152_921_504_606_846_976.0, 1.0, 1.0;
    lengths_by_a_tiny_power_of_four: "length × 2^-60", 1.0 / 1_152_921_504_606_846_976.0, 1.0, 1.0;
    masses_by_a_power_of_four: "mass × 2^20", 1.0, 1_048_576.0, 1.0;
    masses_by_a_power_of_a_quarter: "mass × 2^-20", 1.0, 1.0 / 1_048_576.0, 1.0;
    times_by_a_power_of_four: "time × 2^10", 1.0, 1.0, 1024.0;
    times_by_a_power_of_a_quarter: "time × 2^-10", 1.0, 1.0, 1.0 / 1024.0;
    millimetres: "length × 1e3", 1e3, 1.0, 1.0;
    kilometres: "length × 1e-3", 1e-3, 1.0, 1.0;
    micrometres: "length × 1e6", 1e6, 1.0, 1.0;
    megametres: "length × 1e-6", 1e-6, 1.0, 1.0;
    grams: "mass × 1e3", 1.0, 1e3, 1.0;
    tonnes: "mass × 1e-3", 1.0, 1e-3, 1.0;
    milligrams: "mass × 1e6", 1.0, 1e6, 1.0;
    kilotonnes: "mass × 1e-6", 1.0, 1e-6, 1.0;
    milliseconds: "time × 1e3", 1.0, 1.0, 1e3;
    kiloseconds: "time × 1e-3", 1.0, 1.0, 1e-3;
    millimetres_tonnes_seconds: "mm, t, s", 1e3, 1e-3, 1.0;
}
