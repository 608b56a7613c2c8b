//! `[force.NAME]`: springs, dampers and loads. A kind is one file here and its line in the table.

mod along_laws;
mod body_load;
mod bushing;
mod constant;
mod coordinate_laws;
mod effort;
mod expression;
mod following;
mod force;
mod friction;
mod joint;
mod laws;
mod point_load;
mod rope;
mod rope_laws;
mod spring;
mod stop;
mod torque;
mod torsion;

pub use bushing::Bushing;
pub use constant::Constant;
pub(super) use coordinate_laws::{Resisting, Spring as LinearSpring, Viscous};
pub use effort::Effort;
pub use expression::Expression;
pub use force::Force;
pub use friction::Friction;
pub use rope::Rope;
pub use spring::Spring;
pub use stop::Stop;
pub(super) use stop::{Limit, note_pushing};
pub use torque::Torque;
pub use torsion::Torsion;

use super::key::Kind;

/// All kinds of forces.
pub const KINDS: &[Kind] = &[
    Kind::of::<Spring>(),
    Kind::of::<Rope>(),
    Kind::of::<Torsion>(),
    Kind::of::<Bushing>(),
    Kind::of::<Force>(),
    Kind::of::<Torque>(),
    Kind::of::<Effort>(),
    Kind::of::<Friction>(),
    Kind::of::<Stop>(),
    Kind::of::<Constant>(),
    Kind::of::<Expression>(),
];
