//! Constraints in a stage: what the rows' multipliers are and how they are iterated.
//!
//! Every iteration solves the same matrix (methods §3)
//! ```text
//! [ A   Ḡᵀ ] [Δd ]      [ ϖ(M a + Ḡᵀλ − Q) ]
//! [ G   −δ ] [Δμ ]  = − [        Φ         ]
//! ```
//! Eliminating Δμ gives the classical tangent A + GᵀG/δ of penalty and augmented Lagrangian with ϖα = 1/δ, so that
//! the paper's loops and the exact Newton iteration differ only in δ and in what becomes of λ.

mod acceleration;
mod augmented;
mod collocation;
mod compare;
mod coupled;
mod custom_rates;
mod dampers;
mod failure;
mod followers;
mod hubs;
mod independence;
mod iteration;
mod kept;
mod kkt;
mod law_groups;
mod level;
mod linear;
mod newton;
mod passes;
mod pattern;
mod plan;
mod rank;
mod round_off;
mod scales;
mod stabilized;
mod stage;
mod standing;
mod sweep;
mod table;
mod terms;
mod twists;
mod velocity_rows;
mod workspace;

pub use collocation::{Collocation, Timing};
pub use dampers::{Fit, taken_of_turned};
pub(crate) use failure::SMOOTH;
pub use failure::{Failure, Unknown};
pub use followers::Followers;
pub(crate) use independence::extent;
pub use independence::{Independence, VANISHED, independence, independent, natural_sizes};
pub use iteration::{ITERATIONS, Iteration, Multipliers, SolveSettings, predict, solve};
pub use kkt::Kkt;
pub use law_groups::{LawFactors, LawTangents};
pub use level::Level;
pub use newton::Newton;
pub use pattern::{ALL, Block};
pub use rank::{RHO, Rank};
pub use scales::Scales;
pub use stabilized::Stabilized;
pub use stage::{RowsAt, Sampling, Stage};
pub use standing::Sure;
pub use table::{FORMULATIONS, Formulation};
pub use twists::Twists;
pub use workspace::{Moment, Prediction, Workspace};
