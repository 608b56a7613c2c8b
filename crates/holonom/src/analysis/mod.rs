//! What is asked of a model rather than simulated: rank and redundancy, what a projection does to the energy, the
//! largest stable step.

mod projection;
mod rank;
mod stability;

pub use projection::{ProjectionForm, projection_form};
pub use rank::{Rank, rank};
pub use stability::{LargestStep, largest_step};
