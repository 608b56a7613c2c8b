//! The engine of holonom: dynamics of constrained mechanical systems in dependent Cartesian coordinates.

pub mod analysis;
pub mod energy;
pub mod formulation;
pub mod integrator;
pub mod linalg;
pub mod model;
pub mod projection;
pub mod record;
pub mod simulation;
pub mod system;
