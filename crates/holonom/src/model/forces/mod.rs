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

pub use spring::Spring;

use super::assembly::Assembly;
use super::bodies::nodes::Member;
use super::entry::Entry;
use super::geometry::{Vec3, unit};
use super::key::Kind;

/// All kinds of forces.
pub const KINDS: &[Kind] = &[
    Kind::of::<spring::Spring>(),
    torsion::KIND,
    bushing::KIND,
    force::KIND,
    torque::KIND,
    effort::KIND,
    friction::KIND,
    stop::KIND,
    constant::KIND,
    expression::KIND,
];

/// Adds the directions that a force needs of its bodies, which a plate or a rod may lack: all of them, where it turns
/// them or follows their axes.
pub(super) fn needed(assembly: &Assembly<'_>, entry: &Entry<'_>, out: &mut Vec<(usize, Vec3)>) {
    let turns = [bushing::KIND.name, force::KIND.name, torque::KIND.name];
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
