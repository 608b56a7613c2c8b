//! `[start] equilibrium`: a run begins where all forces balance.

use std::sync::Arc;

use super::adrift::{Turns, by_in_words, list, moved_by};
use super::assembly::Assembly;
use super::geometry::{norm, subtract};
use super::start::Target;
use crate::simulation::{Places, Restless};
use crate::system::{Constant, place_of};

/// What moves by less than this share of the mechanism has not moved.
const MOVED: f64 = 1e-6;

/// Moves the mechanism to where it comes to rest, while the coordinates at which joints are put, drives and all constraints stay as they are. Says
/// what has moved most.
///
/// # Errors
/// Why there is no such place, and the cure.
pub(super) fn settle(assembly: &mut Assembly<'_>, targets: &[Target]) -> Result<Option<String>, (String, &'static str)> {
    require_no_motion(assembly)?;
    let mut builder = assembly.builder.clone();
    for (target, value) in targets.iter().filter_map(|target| Some((target, target.value.filter(|_| target.row.is_none())?))) {
        let row = target.add_row(&mut builder);
        builder.retarget(row, Arc::new(Constant(value)));
    }
    let lost = |what: String| (what, "see that springs or joints hold all that forces pull at, or write the pose in which the run begins");
    let mut places = Places::new(builder.build()).map_err(|error| lost(format!("the mechanism cannot be put anywhere: {error}")))?;
    let outcome = places.settle();
    places.keep();
    let before = assembly.builder.position().to_vec();
    assembly.builder.move_to(&places.system().in_world(places.system().start_position()), places.angles());
    let moved = moved(assembly, &before);
    let went = moved.as_ref().map_or(String::new(), |moved| format!("; so far it has moved {moved}"));
    match outcome {
        Ok(()) => Ok(moved.map(|moved| format!("the run begins where all forces balance; that has moved {moved}"))),
        Err(Restless::Moves) => Err(lost(format!("the mechanism does not come to rest where forces balance: it goes on and on{went}"))),
        Err(Restless::Corner(of, what)) => {
            let name = places.system().cornered(of);
            Err(lost(format!("the mechanism does not come to rest where forces balance: at `{name}` {what}{went}")))
        }
        Err(Restless::Stuck) => Err(lost(format!("the way to where forces balance ends before the mechanism is there{went}"))),
    }
}

/// Velocities as they are written belong to the pose that is written, unless they are the same everywhere.
fn require_no_motion(assembly: &Assembly<'_>) -> Result<(), (String, &'static str)> {
    if !assembly.builder.is_moving() {
        return Ok(());
    }
    let of_bodies = assembly.bodies.iter().map(|body| (&body.name, body.velocity, norm(body.angular_velocity) > 0.0));
    let of_points = assembly.points.iter().filter_map(|point| Some((&point.name, point.velocity?, false)));
    let mut all = of_bodies.chain(of_points);
    let first = all.next().map(|(_, velocity, _)| velocity).unwrap_or_default();
    let turning = assembly.bodies.iter().find(|body| norm(body.angular_velocity) > 0.0).map(|body| &body.name);
    match turning.or_else(|| all.find(|(_, velocity, _)| *velocity != first).map(|(name, ..)| name)) {
        None => Ok(()),
        Some(name) => Err((
            format!("the velocity of `{name}` is written for the pose in the file, and the mechanism is moved to where its forces balance"),
            "give all bodies and points the same velocity and none an angular velocity, and rates of joints in [start], as `angle_rate`",
        )),
    }
}

/// The bodies and points that are farthest from where they were before.
fn moved(assembly: &Assembly<'_>, before: &[f64]) -> Option<String> {
    let (dim, least) = (assembly.dimension(), MOVED * assembly.builder.size());
    let turns = Turns::of(assembly);
    let bodies = assembly.bodies.iter().enumerate().filter_map(|(k, body)| {
        let (way, turn) = moved_by(assembly, k, &turns);
        Some((way, by_in_words(&body.name, way, turn, least)?))
    });
    let points = assembly.points.iter().filter_map(|point| {
        let terms = &point.end.terms;
        let way = norm(subtract(place_of(terms, assembly.builder.position(), dim), place_of(terms, before, dim)));
        Some((way, by_in_words(&point.name, way, 0.0, least)?))
    });
    let mut moved: Vec<_> = bodies.chain(points).collect();
    moved.sort_by(|a, b| b.0.total_cmp(&a.0));
    list(moved.into_iter().map(|(_, words)| words))
}
