//! `[force.NAME]`: springs, dampers and loads. A kind is one file here and its line in the table.

mod body_load;
mod bushing;
mod constant;
mod coordinate_laws;
mod effort;
mod expression;
mod force;
mod friction;
mod joint;
mod laws;
mod point_load;
mod spring;
mod stop;
mod torque;
mod torsion;

pub use bushing::Bushing;
pub use constant::Constant;
pub use effort::Effort;
pub use expression::Expression;
pub use force::Force;
pub use friction::Friction;
pub use spring::Spring;
pub use stop::Stop;
pub use torque::Torque;
pub use torsion::Torsion;

use super::assembly::Assembly;
use super::bodies::nodes::Member;
use super::entry::Entry;
use super::fields::Described;
use super::geometry::{Vec3, unit};
use super::key::Kind;

/// All kinds of forces.
pub const KINDS: &[Kind] = &[
    Kind::of::<spring::Spring>(),
    Kind::of::<torsion::Torsion>(),
    Kind::of::<bushing::Bushing>(),
    Kind::of::<force::Force>(),
    Kind::of::<torque::Torque>(),
    Kind::of::<effort::Effort>(),
    Kind::of::<friction::Friction>(),
    Kind::of::<stop::Stop>(),
    Kind::of::<constant::Constant>(),
    Kind::of::<expression::Expression>(),
];

/// Adds the directions that a force needs of its bodies, which a plate or a rod may lack: all of them, where it turns
/// them or follows their axes.
pub(super) fn needed(assembly: &Assembly<'_>, entry: &Entry<'_>, out: &mut Vec<(usize, Vec3)>) {
    let turns = [Bushing::NAME, Force::NAME, Torque::NAME];
    if !entry.text("type").is_ok_and(|kind| turns.contains(&kind)) {
        return;
    }
    let named = ["body", "reaction"].into_iter().filter_map(|key| Some((key, entry.text(key).ok()?)));
    let between = entry.texts("between").into_iter().flatten().map(|name| ("between", name));
    for (key, name) in named.chain(between) {
        if let Ok(Member::Body(body)) = assembly.member(entry, key.into(), name) {
            out.extend((0..3).map(|k| (body, unit(k))));
        }
    }
}
