//! What a start moves that no joint ties to the ground.

use super::assembly::Assembly;
use super::bodies::nodes::Member;
use super::bodies::short;
use super::geometry::{norm, subtract};
use crate::system::{Term, place_of};

/// Most bodies that are named.
const NAMED: usize = 3;

/// What bodies move by less than, over the size of the mechanism, and turn by, rad, without a word.
const ADRIFT: f64 = 1e-6;

/// Says how bodies that no joint ties to the ground were moved to a start where coordinates are given: they only move as little as they can.
pub(super) fn moved(assembly: &Assembly<'_>) -> Option<String> {
    let bodies = &assembly.bodies;
    let mut tied = vec![false; bodies.len()];
    let pairs: Vec<[Member; 2]> = assembly.joints.iter().map(|joint| joint.geometry.members).collect();
    let mut grows = true;
    while std::mem::take(&mut grows) {
        for &[a, b] in pairs.iter().chain(pairs.iter().rev()) {
            let is_tied = [a, b].map(|member| !matches!(member, Member::Body(k) if !tied[k]));
            if is_tied[0] != is_tied[1]
                && let Member::Body(k) = if is_tied[0] { b } else { a }
            {
                (tied[k], grows) = (true, true);
            }
        }
    }
    let (dim, position) = (assembly.dimension(), assembly.builder.position());
    let moved = bodies.iter().zip(&assembly.frames).zip(&tied).filter(|(_, tied)| !**tied).filter_map(|((body, frame), _)| {
        let at = |terms: Vec<Term>| place_of(&terms, position, dim);
        let way = norm(subtract(at(frame.point(body.position)), body.position));
        let turned = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(|unit| at(frame.vector(unit)));
        let trace = if dim == 2 { 2.0 * turned[0][0] + 1.0 } else { turned[0][0] + turned[1][1] + turned[2][2] };
        // A thin rod has no directions across it.
        let is_whole = turned[..dim].iter().all(|unit| norm(*unit) > 0.5);
        let turn = if is_whole { ((trace - 1.0) / 2.0).clamp(-1.0, 1.0).acos() } else { 0.0 };
        (way > ADRIFT * assembly.builder.size() || turn > ADRIFT)
            .then(|| format!("`{}` by {} m and {} rad", body.name, short(way), short(turn)))
    });
    let mut moved: Vec<String> = moved.collect();
    let more = moved.len().saturating_sub(NAMED);
    moved.truncate(NAMED);
    if more > 0 {
        moved.push(format!("{more} more"));
    }
    (!moved.is_empty()).then(|| {
        format!(
            "bodies that no joint ties to the ground were moved, as little as they can be in the metric of the mass: {} (they stay where they are \
             in a file that is written in the pose in which the run begins)",
            moved.join(", ")
        )
    })
}
