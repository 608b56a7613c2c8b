//! Independent runs of one model that differ in some of its keys.

mod answers;
mod check;
mod column;
mod journal;
mod plan;
mod reduction;
mod report;
mod run;
mod sheet;
mod store;
mod study;
mod vary;
mod vibration;
mod watch;

pub use answers::Answers;
pub use plan::Plan;
pub use run::Ending;
pub use store::{JOURNAL, Store};
pub use study::{Complaint, Line, Study};
pub use vary::Vary;
