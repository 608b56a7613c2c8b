//! What is asked of a model rather than simulated: rank and redundancy, what a projection does to the energy, small
//! vibrations, the largest stable step.

mod exponents;
mod jacobian;
mod modes;
mod projection;
mod rank;
mod reactions;
mod slowest;
mod stability;

pub use jacobian::constraint_jacobian;
pub use modes::{MOST_FREEDOMS, Mode, Modes, NoModes, forks, is_at_rest, modes, way_ahead};
pub use projection::{ProjectionForm, projection_form};
pub use rank::{Rank, rank, rank_of};
pub use reactions::{MOST_ROWS, Undetermined, undetermined, undetermined_of};
pub use stability::{LargestStep, largest_step};
