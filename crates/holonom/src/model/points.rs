//! `[point.NAME]`: particles, places and driven supports, shared by all that name them.

use std::collections::HashSet;
use std::sync::Arc;

use super::assembly::{Assembly, PlacedPoint};
use super::ends::{fixed, node};
use super::entry::{Entry, Spot};
use super::expression::{Program, TimeProgram};
use super::fault::{Fault, Read};
use super::fields::{Keys, List, Number, Place};
use super::key::Shape;
use super::tables::require_inside;
use crate::system::{Constant, Signal};

/// A particle, a place or a driven support.
#[derive(Clone, Debug, PartialEq, Keys)]
#[table("a point")]
pub struct Point {
    /// mass of the point itself; a free point without any must be the end of a bar with mass
    #[key(unit = "kg", default = "0")]
    pub mass: Option<Number>,
    /// where it is at the start; or the name of another point, or of a body or a place of one, where that is
    #[key(unit = "m", default = "none: needed unless there is a motion")]
    pub position: Option<Place>,
    /// how fast it is at the start
    #[key(unit = "m/s", default = "0", shape = Shape::Vector)]
    pub velocity: Option<List<Number>>,
    /// true ties it to the ground
    #[key(default = "false")]
    pub fixed: Option<bool>,
    /// makes it a driven support: its coordinates as formulas of the time t
    #[key(unit = "m", default = "none", shape = Shape::Formulas(&["t"]))]
    pub motion: Option<List<Number>>,
}

/// A point as it was read.
pub struct Spec {
    pub name: String,
    path: String,
    mass: f64,
    /// Where it is at the start.
    pub start: [f64; 3],
    motion: Motion,
}

enum Motion {
    Free { velocity: [f64; 3] },
    Fixed,
    Driven(Vec<Program>),
}

impl Point {
    /// The point with its numbers, at the origin where its place has a name.
    pub(super) fn spec(&self, entry: &Entry<'_>, dim: usize) -> Read<Spec> {
        let mass = entry.optional("mass", &self.mass, Number::not_negative);
        let position = entry.optional("position", &self.position, |position, entry, key| match position {
            Place::Fixed(numbers) => numbers.vector(entry, key, dim),
            Place::Named(_) => Ok([0.0; 3]),
        });
        let velocity = entry.optional("velocity", &self.velocity, |velocity, entry, key| velocity.vector(entry, key, dim));
        let motion = entry.optional("motion", &self.motion, |motion, entry, key| motion.motions(entry, key, dim));
        let (mass, position, velocity, motion) = (mass?, position?, velocity?, motion?);
        let fixed = self.fixed.unwrap_or(false);
        let (start, motion) = match motion {
            Some(motion) => {
                for (given, key) in [(position.is_some(), "position"), (velocity.is_some(), "velocity"), (fixed, "fixed")] {
                    if given {
                        return Err(entry.refuse_key(key, format!("a point with a `motion` takes no `{key}`"), "keep one of the two"));
                    }
                }
                (driven_start(entry, &motion)?, Motion::Driven(motion))
            }
            None => {
                let start = *entry.needed("position", &position)?;
                if fixed && velocity.is_some_and(|velocity| velocity != [0.0; 3]) {
                    return Err(entry.refuse("velocity", "a fixed point does not move", "remove the velocity, or fixed = true"));
                }
                let motion = if fixed { Motion::Fixed } else { Motion::Free { velocity: velocity.unwrap_or_default() } };
                (start, motion)
            }
        };
        Ok(Spec { name: entry.name.to_string(), path: entry.path.to_string(), mass: mass.unwrap_or(0.0), start, motion })
    }
}

/// Where a driven point is at t = 0, which must be somewhere, and with finite derivatives.
fn driven_start(entry: &Entry<'_>, motion: &[Program]) -> Read<[f64; 3]> {
    let mut start = [0.0; 3];
    for (k, program) in motion.iter().enumerate() {
        let values = TimeProgram(program.clone()).at(0.0);
        if values.iter().any(|value| !value.is_finite()) {
            require_inside(entry, Spot { key: "motion", item: Some(k) }, program, &[0.0])?;
            let message = format!("position, velocity and acceleration are {values:?} at t = 0");
            return Err(entry.refuse(Spot { key: "motion", item: Some(k) }, message, "all must be finite"));
        }
        start[k] = values[0];
    }
    Ok(start)
}

/// Adds the points to a system, all but the driven ones, which stay places until the free nodes are complete.
pub fn add(assembly: &mut Assembly<'_>, specs: &[Spec]) {
    for (k, spec) in specs.iter().enumerate() {
        let end = match spec.motion {
            Motion::Free { velocity } => node(assembly.builder.free_node(spec.start, velocity), spec.start, true, k, &spec.name),
            _ => super::ends::End { point: Some(k), ..fixed(spec.start, spec.name.clone()) },
        };
        assembly.by_name.insert(spec.name.clone(), k);
        let velocity = if let Motion::Free { velocity } = spec.motion { Some(velocity) } else { None };
        let (name, path) = (spec.name.clone(), spec.path.clone());
        assembly.points.push(PlacedPoint { name, path, end, mass: spec.mass, velocity, carries_bar: false });
    }
}

/// Adds the motion of the driven points and the mass of all.
pub fn complete(assembly: &mut Assembly<'_>, specs: Vec<Spec>) {
    for (k, spec) in specs.into_iter().enumerate() {
        if let Motion::Driven(programs) = spec.motion {
            let id = assembly.builder.known_node(signals(programs));
            assembly.points[k].end = node(id, spec.start, false, k, &spec.name);
        }
        let place = assembly.points[k].end.place().expect("a point is a node");
        if spec.mass > 0.0 {
            assembly.builder.mass(place, place, spec.mass);
        }
    }
}

/// Whether a point is driven.
pub fn is_driven(spec: &Spec) -> bool {
    matches!(spec.motion, Motion::Driven(_))
}

fn signals(programs: Vec<Program>) -> [Arc<dyn Signal>; 3] {
    let mut programs = programs.into_iter();
    std::array::from_fn(|_| match programs.next() {
        Some(program) => Arc::new(TimeProgram(program)) as Arc<dyn Signal>,
        None => Arc::new(Constant(0.0)),
    })
}

/// Refuses free points without mass, one of each entry.
pub fn check_mass(assembly: &Assembly<'_>) {
    let mut told: HashSet<&str> = HashSet::new();
    for point in &assembly.points {
        // What is wrong with a faulty entry may be its mass.
        let name = point.name.split('[').next().unwrap_or(&point.name);
        let massless = !assembly.faulty.contains(name)
            && point.mass == 0.0
            && !point.carries_bar
            && point.end.free
            && !assembly.builder.has_inertia(&point.end.terms);
        if massless && told.insert(&point.path) {
            let message = format!("the free point `{}` has no mass", point.name);
            let cure = "give it a mass, attach a bar with mass, or tie it with fixed = true";
            assembly.sink.report(|| Fault::new(&*point.path, &*point.name, message, cure));
        }
    }
    if assembly.faulty.is_empty() && assembly.bodies.is_empty() && !assembly.points.iter().any(|point| point.end.free) {
        let cure = "add a [body.NAME], or a [point.NAME] with mass and position";
        assembly.sink.report(|| Fault::new("", "", "nothing in this model can move: it has no body and no free point", cure));
    }
}
