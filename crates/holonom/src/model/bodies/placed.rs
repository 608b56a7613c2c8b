//! Bodies that are placed at points of others.

use std::collections::{HashMap, HashSet};

use super::rigid::RigidBody;
use crate::model::assembly::GROUND;
use crate::model::entry::Entry;
use crate::model::expression::indexed;
use crate::model::fault::{Read, Refused, suggest};
use crate::model::geometry::{Vec3, add};
use crate::model::references::split_place;

/// Bodies, and which of them are still to be moved to the place that they are written at.
pub(in crate::model) struct Placing<'a> {
    bodies: &'a mut [RigidBody],
    by_name: HashMap<String, usize>,
    /// Points of the model at the start.
    points: HashMap<&'a str, Vec3>,
    /// Entries in which something is wrong, which has been told.
    faulty: &'a HashSet<String>,
    /// The name of the place that each body waits for.
    waits: Vec<Option<String>>,
    /// Bodies for which no place was found, which has been told.
    lost: Vec<bool>,
}

/// Where a body is to be.
enum Target {
    Known(Vec3),
    /// At the centre of mass of a body, or at one of its points.
    On(usize, Option<usize>),
}

impl<'a> Placing<'a> {
    pub fn new(bodies: &'a mut [RigidBody], points: HashMap<&'a str, Vec3>, faulty: &'a HashSet<String>) -> Self {
        let by_name = bodies.iter().enumerate().map(|(k, body)| (body.name.clone(), k)).collect();
        let (waits, lost) = (vec![None; bodies.len()], vec![false; bodies.len()]);
        Self { bodies, by_name, points, faulty, waits, lost }
    }

    /// Has the body of an entry, which was read at the origin, wait for a place.
    pub fn wait(&mut self, entry: &Entry<'_>, place: &str) -> Read<()> {
        let full = indexed(place, &entry.scope).map_err(|mistake| entry.mistaken("position".into(), mistake))?;
        if let Some(&body) = self.by_name.get(entry.name) {
            self.waits[body] = Some(full);
        }
        Ok(())
    }

    /// Moves the body of an entry to its place, after those that it waits for.
    pub fn place(&mut self, entry: &Entry<'_>) -> Read<()> {
        let mut chain = Vec::new();
        let mut next = self.by_name.get(entry.name).copied();
        while let Some(body) = next
            && let Some(place) = self.waits[body].clone()
        {
            let target = match self.lost[body] {
                true => Err(Refused),
                false if chain.len() > self.bodies.len() => Err(self.circle(entry, body)),
                false => self.target(entry, body, &place),
            };
            let Ok(target) = target else {
                chain.iter().map(|&(waiting, _)| waiting).chain([body]).for_each(|waiting| self.lost[waiting] = true);
                return Err(Refused);
            };
            next = if let Target::On(other, _) = target { Some(other) } else { None };
            chain.push((body, target));
        }
        for (body, target) in chain.into_iter().rev() {
            let place = match target {
                Target::Known(place) => place,
                Target::On(other, None) => self.bodies[other].position,
                Target::On(other, Some(point)) => self.bodies[other].points[point].1,
            };
            self.bodies[body].shift(place);
            self.waits[body] = None;
        }
        Ok(())
    }

    /// What the place that a body waits for is.
    fn target(&self, entry: &Entry<'_>, body: usize, place: &str) -> Read<Target> {
        if place == GROUND {
            return Ok(Target::Known([0.0; 3]));
        }
        if let Some(&at) = self.points.get(place) {
            return Ok(Target::Known(at));
        }
        let (owner, point) = split_place(place).map_or((place, None), |(owner, point)| (owner, Some(point)));
        let Some(&other) = self.by_name.get(owner) else {
            if self.faulty.contains(owner.split('[').next().unwrap_or(owner)) {
                return Err(Refused);
            }
            let what = if point.is_some() { "body" } else { "body or point" };
            let cure = suggest(owner, self.bodies.iter().map(|body| body.name.as_str()));
            return Err(self.refuse(entry, body, format!("there is no {what} `{owner}`"), cure));
        };
        let Some(point) = point else { return Ok(Target::On(other, None)) };
        let names = || self.bodies[other].points.iter().map(|(name, _)| name.as_str());
        match names().position(|name| name == point) {
            Some(point) => Ok(Target::On(other, Some(point))),
            None => Err(self.refuse(entry, body, format!("the body `{owner}` has no point `{point}`"), suggest(point, names()))),
        }
    }

    fn circle(&self, entry: &Entry<'_>, body: usize) -> Refused {
        let message =
            format!("bodies are placed at each other in a circle, `{}` among them, so that they are nowhere", self.bodies[body].name);
        entry.refuse("position", message, "give one of them coordinates")
    }

    /// Refuses the place of a body; `entry` is one that waits for it.
    fn refuse(&self, entry: &Entry<'_>, body: usize, message: String, cure: String) -> Refused {
        let name = &self.bodies[body].name;
        let message = if name == entry.name { message } else { format!("this waits for the place of `{name}`: {message}") };
        entry.refuse("position", message, cure)
    }
}

impl RigidBody {
    /// Moves the body and what is on it.
    fn shift(&mut self, by: Vec3) {
        self.position = add(self.position, by);
        self.points.iter_mut().for_each(|(_, at)| *at = add(*at, by));
    }
}
