//! Bodies and points that are placed at others.

use std::collections::{HashMap, HashSet};

use super::rigid::RigidBody;
use crate::model::assembly::GROUND;
use crate::model::entry::Entry;
use crate::model::expression::indexed;
use crate::model::fault::{Read, Refused, suggest};
use crate::model::geometry::{Vec3, add};
use crate::model::points::Spec;
use crate::model::references::split_place;

/// Bodies and points, and which of them are still to be moved to the place that they are written at. Points are counted after the bodies.
pub(in crate::model) struct Placing<'a> {
    bodies: &'a mut [RigidBody],
    points: &'a mut [Spec],
    by_name: HashMap<String, usize>,
    /// Entries in which something is wrong, which has been told.
    faulty: &'a HashSet<String>,
    /// The name of the place that each waits for.
    waits: Vec<Option<String>>,
    /// Those for which no place was found, which has been told.
    lost: Vec<bool>,
}

/// Where a body or a point is to be.
enum Target {
    Ground,
    /// At the centre of mass of a body, at a point of the model, or at one of the points of a body.
    On(usize, Option<usize>),
}

impl<'a> Placing<'a> {
    pub fn new(bodies: &'a mut [RigidBody], points: &'a mut [Spec], faulty: &'a HashSet<String>) -> Self {
        let names = bodies.iter().map(|body| &body.name).chain(points.iter().map(|point| &point.name));
        let by_name: HashMap<String, usize> = names.cloned().zip(0..).collect();
        let count = bodies.len() + points.len();
        Self { bodies, points, by_name, faulty, waits: vec![None; count], lost: vec![false; count] }
    }

    /// Has the body or the point of an entry, which was read at the origin, wait for a place.
    pub fn wait(&mut self, entry: &Entry<'_>, place: &str) -> Read<()> {
        let full = indexed(place, &entry.scope).map_err(|mistake| entry.mistaken("position".into(), mistake))?;
        if let Some(&k) = self.by_name.get(entry.name) {
            self.waits[k] = Some(full);
        }
        Ok(())
    }

    /// Moves the body or the point of an entry to its place, after those that it waits for.
    pub fn place(&mut self, entry: &Entry<'_>) -> Read<()> {
        let mut chain = Vec::new();
        let mut next = self.by_name.get(entry.name).copied();
        while let Some(k) = next
            && let Some(place) = self.waits[k].clone()
        {
            let target = match self.lost[k] {
                true => Err(Refused),
                false if chain.len() > self.waits.len() => Err(self.circle(entry, k)),
                false => self.target(entry, k, &place),
            };
            let Ok(target) = target else {
                chain.iter().map(|&(waiting, _)| waiting).chain([k]).for_each(|waiting| self.lost[waiting] = true);
                return Err(Refused);
            };
            next = if let Target::On(other, _) = target { Some(other) } else { None };
            chain.push((k, target));
        }
        let bodies = self.bodies.len();
        for (k, target) in chain.into_iter().rev() {
            let place = match target {
                Target::Ground => [0.0; 3],
                Target::On(other, Some(point)) => self.bodies[other].points[point].1,
                Target::On(other, None) if other < bodies => self.bodies[other].position,
                Target::On(other, None) => self.points[other - bodies].start,
            };
            match k < bodies {
                true => self.bodies[k].shift(place),
                false => self.points[k - bodies].start = place,
            }
            self.waits[k] = None;
        }
        Ok(())
    }

    /// What the place that a body or a point waits for is.
    fn target(&self, entry: &Entry<'_>, waiting: usize, place: &str) -> Read<Target> {
        if place == GROUND {
            return Ok(Target::Ground);
        }
        let (owner, point) = split_place(place).map_or((place, None), |(owner, point)| (owner, Some(point)));
        let has_points = |k: &usize| *k < self.bodies.len();
        let Some(other) = self.by_name.get(owner).copied().filter(|k| point.is_none() || has_points(k)) else {
            if self.faulty.contains(owner.split('[').next().unwrap_or(owner)) {
                return Err(Refused);
            }
            let what = if point.is_some() { "body" } else { "body or point" };
            let points = self.points.iter().filter(|_| point.is_none()).map(|point| point.name.as_str());
            let cure = suggest(owner, self.bodies.iter().map(|body| body.name.as_str()).chain(points));
            return Err(self.refuse(entry, waiting, format!("there is no {what} `{owner}`"), cure));
        };
        let Some(point) = point else { return Ok(Target::On(other, None)) };
        let names = || self.bodies[other].points.iter().map(|(name, _)| name.as_str());
        match names().position(|name| name == point) {
            Some(point) => Ok(Target::On(other, Some(point))),
            None => Err(self.refuse(entry, waiting, format!("the body `{owner}` has no point `{point}`"), suggest(point, names()))),
        }
    }

    fn name(&self, k: usize) -> &str {
        self.bodies.get(k).map_or_else(|| &self.points[k - self.bodies.len()].name, |body| &body.name)
    }

    fn circle(&self, entry: &Entry<'_>, k: usize) -> Refused {
        let what = if self.waits[self.bodies.len()..].iter().any(Option::is_some) { "bodies and points" } else { "bodies" };
        let message = format!("{what} are placed at each other in a circle, `{}` among them, so that they are nowhere", self.name(k));
        entry.refuse("position", message, "give one of them coordinates")
    }

    /// Refuses the place of a body or a point; `entry` is one that waits for it.
    fn refuse(&self, entry: &Entry<'_>, waiting: usize, message: String, cure: String) -> Refused {
        let name = self.name(waiting);
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
