//! What a start moves that it does not name: joints that the named ones leave free, and what no joint ties to the ground.

use std::cell::LazyCell;
use std::collections::HashMap;
use std::f64::consts::{PI, TAU};

use super::assembly::Assembly;
use super::beams::stiffened;
use super::bodies::nodes::Member;
use super::bodies::short;
use super::geometry::{Vec3, norm, subtract, unit};
use super::start::{Target, leading};
use crate::simulation::{GOLDEN, Places};
use crate::system::{GaugeValues, System, SystemBuilder, place_of};

/// Most bodies or coordinates that are named.
const NAMED: usize = 3;

/// What bodies move by less than, over the size of the mechanism, and turn by, rad, without a word; of rates it is a share of the largest.
const ADRIFT: f64 = 1e-6;

/// Difference of two angles that is rounding where they are found by a cosine, rad.
const SAME_TURN: f64 = 1e-6;

/// Says how bodies that no joint ties to the ground were moved to a start where coordinates are given: they only move as little as they can.
pub(super) fn moved(assembly: &Assembly<'_>) -> Option<String> {
    let bodies = &assembly.bodies;
    let mut tied = vec![false; bodies.len()];
    let elastic = assembly.elastic.iter().map(|element| element.bodies.map(Member::Body));
    let pairs: Vec<[Member; 2]> = assembly.joints.iter().map(|joint| joint.geometry.members).chain(elastic).collect();
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
    let turns = Turns::of(assembly);
    let moved = (0..bodies.len()).filter(|k| !tied[*k]).filter_map(|k| {
        let (way, turn) = moved_by(assembly, k, &turns);
        by_in_words(&bodies[k].name, way, turn, ADRIFT * assembly.builder.size())
    });
    let moved = list(moved)?;
    Some(format!(
        "bodies that no joint ties to the ground were moved, as little as they can be in the metric of the mass: {moved} (they stay where they are \
         in a file that is written in the pose in which the run begins)"
    ))
}

/// That something has moved by more than `least` (m), or turned, in words.
pub(super) fn by_in_words(name: &str, way: f64, turn: f64, least: f64) -> Option<String> {
    let moved = (way > least).then(|| format!("{} m", short(way)));
    let turned = (turn > ADRIFT).then(|| format!("{} rad", short(turn)));
    let by: Vec<String> = moved.into_iter().chain(turned).collect();
    (!by.is_empty()).then(|| format!("`{name}` by {}", by.join(" and ")))
}

/// How far the centre of the k-th body is from where that is written, m, and by what it is turned, rad.
pub(super) fn moved_by(assembly: &Assembly<'_>, k: usize, turns: &Turns) -> (f64, f64) {
    let (dim, position, body) = (assembly.dimension(), assembly.builder.position(), &assembly.bodies[k]);
    let at = place_of(&assembly.frames[k].point(body.position), position, dim);
    (norm(subtract(at, body.position)), turns.of_body(assembly, k))
}

/// Angles of joints, and in the plane of bodies, counted over any number of turns since the pose that is written, rad.
pub(super) struct Turns(HashMap<String, f64>);

impl Turns {
    pub fn of(assembly: &Assembly<'_>) -> Self {
        let (system, measured) = measured(&assembly.builder);
        let angles = (0..measured.value.len()).filter(|&k| system.is_angle(k));
        Self(angles.map(|k| (system.gauges()[k].clone(), measured.value[k])).collect())
    }

    /// By how much the k-th body is turned, rad. How it stands does not tell whole turns: in space those of a joint count whose angle
    /// is the same but for these.
    fn of_body(&self, assembly: &Assembly<'_>, k: usize) -> f64 {
        let body = &assembly.bodies[k];
        if assembly.dimension() == 2 {
            return (self.0[&format!("{}.angle", body.name)] - body.turned).abs();
        }
        let at = |unit: Vec3| place_of(&assembly.frames[k].vector(unit), assembly.builder.position(), 3);
        let turned = [0, 1, 2].map(|c| at(unit(c)));
        // A thin rod has no directions across it.
        if turned.iter().any(|unit| norm(*unit) <= 0.5) {
            return 0.0;
        }
        let trace: f64 = (0..3).map(|c| turned[c][c]).sum();
        let stands = ((trace - 1.0) / 2.0).clamp(-1.0, 1.0).acos();
        let joints = assembly.joints.iter().filter(|joint| joint.geometry.members.contains(&Member::Body(k)));
        let angles = joints.flat_map(|joint| joint.coordinates.iter().map(move |of| format!("{}.{}", joint.name, of.name)));
        let mut turns = angles.filter_map(|name| Some(self.0.get(&name)?.abs()));
        // From half a turn back to half a turn on.
        let within = |turn: f64| (turn + PI).rem_euclid(TAU) - PI;
        turns.find(|turn| *turn > PI && (within(*turn).abs() - stands).abs() < SAME_TURN).unwrap_or(stands)
    }
}

/// Coordinates of the joints of a system, and in the plane angles of its bodies behind them, and their rates.
pub(super) fn measured(builder: &SystemBuilder) -> (System, GaugeValues) {
    let system = builder.clone().build();
    let mut values = system.gauge_values();
    system.measure(system.start_position(), system.start_velocity(), &mut values);
    (system, values)
}

/// Which coordinates of joints may still go on where those of some targets do not: a push of all nodes, as far as the rows let them, moves
/// these.
fn left_free<'t>(assembly: &Assembly<'_>, targets: impl Iterator<Item = &'t Target>) -> Option<Vec<bool>> {
    let builder = &assembly.builder;
    let held: Vec<(&Target, f64)> = targets.filter(|target| target.row.is_none()).map(|target| (target, 0.0)).collect();
    let led = leading(&stiffened(builder, &assembly.elastic), &held);
    let size = builder.size();
    let rates = |pushed: f64| {
        let mut led = led.clone();
        // Of all sizes and signs, as that of neighbours may be what moves a coordinate.
        let push: Vec<f64> = (0..led.position().len()).map(|k| pushed * ((k as f64 * GOLDEN).fract() - 0.5)).collect();
        led.set_velocity(&push);
        let mut places = Places::new(led.build()).ok()?;
        let x = places.system().start_position().to_vec();
        places.put(&x).ok()?;
        let v = places.velocities().ok()?.to_vec();
        let (system, mut measured) = (places.system(), places.system().gauge_values());
        system.measure(&x, &v, &mut measured);
        let scaled = measured.rate[..assembly.joint_coordinates()]
            .iter()
            .enumerate()
            .map(|(k, rate)| if system.is_angle(k) { size * rate } else { *rate });
        Some(scaled.collect::<Vec<f64>>())
    };
    let (at_rest, pushed) = (rates(0.0)?, rates(size)?);
    let share: Vec<f64> = at_rest.iter().zip(pushed).map(|(before, after)| (after - before).abs()).collect();
    // Where the joints are left nothing, as those of a loop that floats, all of these are round-off beside the push.
    let most = share.iter().fold(1e-3 * size, |most: f64, share| most.max(*share));
    Some(share.iter().map(|share| *share > ADRIFT * most).collect())
}

/// Says how joints were moved that the start does not name, though the named ones would let them stay: as little as they can be, which is seldom
/// nothing.
pub(super) fn followed(assembly: &Assembly<'_>, targets: &[Target], before: &GaugeValues) -> Option<String> {
    let (system, after) = measured(&assembly.builder);
    let size = |k: usize| if system.is_angle(k) { 1.0 } else { assembly.builder.size() };
    let quicker = |k: usize| (after.rate[k] - before.rate[k]).abs() / size(k);
    let coordinates = assembly.joint_coordinates();
    let quickest = (0..coordinates).map(quicker).fold(0.0, f64::max);
    let free = |is_given: fn(&Target) -> bool| LazyCell::new(move || left_free(assembly, targets.iter().filter(|target| is_given(target))));
    let (may_be_elsewhere, may_be_quick) = (free(Target::is_placed), free(Target::is_rated));
    let is_free = |free: &Option<Vec<bool>>, k: usize| free.as_ref().is_none_or(|free| free[k]);
    let moved = system.gauges()[..coordinates].iter().enumerate().filter_map(|(k, name)| {
        let target = targets.iter().find(|target| target.name() == *name);
        let unit = if system.is_angle(k) { "rad" } else { "m" };
        let (value, rate) = (after.value[k], after.rate[k]);
        let is_elsewhere =
            target.is_none_or(|target| !target.is_placed()) && value.abs() > ADRIFT * size(k) && is_free(&may_be_elsewhere, k);
        // Where something is driven, rates follow from that.
        let is_led = system.is_driven() || target.is_some_and(Target::is_rated);
        let is_quick = !is_led && quicker(k) > ADRIFT * quickest && is_free(&may_be_quick, k);
        match (is_elsewhere, is_quick) {
            (true, _) => Some(format!("`{name}` is {} {unit}", short(value))),
            (false, true) => Some(format!("`{name}_rate` is {} {unit}/s", short(rate))),
            _ => None,
        }
    });
    let moved = list(moved)?;
    Some(format!(
        "joints that [start] does not name were moved, too, as little as they can be in the metric of the mass: {moved} (name them there, too, \
         with 0 for those that are to stay)"
    ))
}

/// The first of some, and how many more there are.
pub(super) fn list(moved: impl Iterator<Item = String>) -> Option<String> {
    let mut moved: Vec<String> = moved.collect();
    let more = moved.len().saturating_sub(NAMED);
    moved.truncate(NAMED);
    if more > 0 {
        moved.push(format!("{more} more"));
    }
    (!moved.is_empty()).then(|| moved.join(", "))
}
