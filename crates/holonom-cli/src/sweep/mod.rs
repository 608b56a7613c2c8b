//! Independent runs of one model that differ in some of its keys.

mod check;
mod column;
mod journal;
mod plan;
mod reduction;
mod report;
mod run;
mod sheet;
mod vary;
mod watch;

pub use check::check;
pub use journal::Journal;
pub use plan::Plan;
pub use report::write_report;
pub use run::{Ending, Runner};
pub use sheet::Sheet;
