//! Runs of models, results of earlier runs and what was measured, side by side.

mod difference;
mod plan;
mod subject;

pub use difference::{Difference, difference};
pub use plan::{Entry, Of, Plan};
pub use subject::MEASURED;
