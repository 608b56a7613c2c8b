//! What the readers of points, bars, constraints and forces build on: the system so far, and the points by name.

use std::collections::{HashMap, HashSet};
use std::sync::Arc;

use super::bodies::Body;
use super::bodies::frame::Frame;
use super::bodies::nodes::Member;
use super::entry::{Entry, Spot, all};
use super::expression::{Mistake, Program, Scope};
use super::fault::{Read, Refused, Sink, nearest, suggest};
use super::geometry::{Vec3, add, norm};
use super::joints::Joint;
use super::value::Value;
use crate::record::{Anchor, Line, LineKind, SceneJoint};
use crate::system::{NodeId, Place, Signal, SystemBuilder, Term};

/// The name of the origin.
pub const GROUND: &str = "ground";

/// Largest relative contradiction between what a constraint says and where the points start.
pub const CONTRADICTION: f64 = 1e-6;

/// The world axes of a model.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Axes {
    /// `"xyz"`, `"xy"`, `"xz"` or `"yz"`.
    pub name: &'static str,
}

impl Axes {
    /// Three axes, or a plane of two.
    pub const ALL: [Self; 4] = [Self { name: "xyz" }, Self { name: "xy" }, Self { name: "xz" }, Self { name: "yz" }];

    /// Number of axes: coordinates of a point.
    pub fn dimension(self) -> usize {
        self.name.len()
    }

    /// The world coordinates (3) of coordinates in these axes.
    pub fn in_world(self, local: [f64; 3]) -> [f64; 3] {
        let mut world = [0.0; 3];
        for (k, axis) in self.name.bytes().enumerate() {
            world[usize::from(axis - b'x')] = local[k];
        }
        world
    }

    /// The part of a world vector in these axes, zeros behind it.
    pub fn of_world(self, world: [f64; 3]) -> [f64; 3] {
        let mut local = [0.0; 3];
        for (k, axis) in self.name.bytes().enumerate() {
            local[k] = world[usize::from(axis - b'x')];
        }
        local
    }
}

/// An end of something: a point of the model or a fixed place.
#[derive(Clone, Debug)]
pub struct End {
    /// The nodes it is made of.
    pub terms: Vec<Term>,
    /// Position at the start in the axes of the model, m.
    pub start: [f64; 3],
    /// Whether its motion is sought.
    pub free: bool,
    /// Position in the list of points, if it is one.
    pub point: Option<usize>,
    /// Position in the list of bodies, if it is a place of one.
    pub body: Option<usize>,
    /// As it was written, for messages.
    pub name: String,
}

/// A point of the model.
#[derive(Clone, Debug)]
pub struct Point {
    pub name: String,
    /// Where it is in the description.
    pub path: String,
    pub end: End,
    /// Its own mass, kg.
    pub mass: f64,
    /// Whether a bar with mass is attached.
    pub carries_bar: bool,
}

/// A system while it is put together.
pub struct Assembly<'a> {
    pub builder: SystemBuilder,
    pub axes: Axes,
    /// Gravity in the axes of the model, m/s².
    pub gravity: [f64; 3],
    pub sink: &'a Sink,
    /// All points, in file order.
    pub points: Vec<Point>,
    /// Position of each point in the list, by name.
    pub by_name: HashMap<String, usize>,
    /// Names of entries of points that could not be read; what refers to them is no second fault.
    pub faulty: HashSet<String>,
    pub lines: Vec<Line>,
    /// All bodies, in file order, and where their nodes are made, their frames.
    pub bodies: Vec<Body>,
    pub frames: Vec<Frame>,
    /// Position of each body in the list, by name.
    pub body_names: HashMap<String, usize>,
    /// Places of each body that something holds, in its axes, for the picture.
    pub body_places: Vec<Vec<Vec3>>,
    /// All joints that are no couplers, in file order.
    pub joints: Vec<Joint>,
    /// Position of each joint in the list, by name.
    pub joint_names: HashMap<String, usize>,
    /// Coordinates of joints that are driven, as `JOINT.COORDINATE`, with the drive.
    pub driven: HashMap<String, String>,
    /// Names of joints and couplers that could not be read.
    pub faulty_joints: HashSet<String>,
    pub scene_joints: Vec<SceneJoint>,
    /// Efforts of the drives.
    pub efforts: Vec<Effort>,
}

/// What a drive exerts: −λ of its row, times the length where the row is one of half a square.
#[derive(Clone)]
pub struct Effort {
    pub name: String,
    pub row: usize,
    pub length: Option<Arc<dyn Signal>>,
}

impl Assembly<'_> {
    /// Coordinates of a point.
    pub fn dimension(&self) -> usize {
        self.axes.dimension()
    }

    /// The point named at a key.
    pub fn point(&self, entry: &Entry<'_>, key: &str) -> Read<End> {
        match entry.text(key)? {
            GROUND => Err(entry.refuse(key, format!("`{GROUND}` is a place, and a point is wanted here"), "name a [point.NAME]")),
            name => self.named(entry, key.into(), name),
        }
    }

    /// The end at a key.
    pub fn end(&self, entry: &Entry<'_>, key: &str) -> Read<End> {
        self.end_in(entry, key.into(), entry.value(key)?)
    }

    /// At least `least` and at most `most` ends, no two neighbours alike.
    pub fn ends(&self, entry: &Entry<'_>, key: &str, least: usize, most: usize) -> Read<Vec<End>> {
        let items = entry.list(key)?;
        if !(least..=most).contains(&items.len()) {
            let wanted = if least == most { format!("{least}") } else { format!("at least {least}") };
            let names = ["\"A\"", "\"B\"", "\"C\""];
            let cure = format!("write {key} = [{}], with names of points, \"ground\" or fixed places", names[..least.min(3)].join(", "));
            return Err(entry.refuse(key, format!("`{key}` wants {wanted} points, and this has {}", items.len()), cure));
        }
        let ends = all(items.iter().enumerate().map(|(k, item)| self.end_in(entry, Spot { key, item: Some(k) }, item)))?;
        match (1..ends.len()).find(|&k| ends[k].terms == ends[k - 1].terms) {
            Some(k) => Err(entry.refuse(Spot { key, item: Some(k) }, "the same point comes twice", "name two different points")),
            None => Ok(ends),
        }
    }

    /// Two different ends.
    pub fn pair(&self, entry: &Entry<'_>, key: &str) -> Read<[End; 2]> {
        let ends = self.ends(entry, key, 2, 2)?;
        Ok(ends.try_into().expect("two ends"))
    }

    /// Two ends of which at least one can move.
    pub fn moving_pair(&self, entry: &Entry<'_>, key: &str) -> Read<[End; 2]> {
        let ends = self.pair(entry, key)?;
        self.require_free(entry, key, &ends)?;
        Ok(ends)
    }

    /// Refuses something that ties only places whose motion is known.
    pub fn require_free(&self, entry: &Entry<'_>, key: &str, ends: &[End]) -> Read<()> {
        if ends.iter().any(|end| end.free) {
            return Ok(());
        }
        Err(entry.refuse(key, "none of these can move freely", "at least one must be a point that is neither fixed nor driven"))
    }

    /// A side of a joint: a body, a point or the ground.
    pub fn member(&self, entry: &Entry<'_>, spot: Spot<'_>, name: &str) -> Read<Member> {
        if name == GROUND {
            return Ok(Member::Ground);
        }
        let full = indexed(name, &entry.scope).map_err(|mistake| entry.mistaken(spot, mistake))?;
        if let Some(k) = self.body_by_name(&full) {
            return Ok(Member::Body(k));
        }
        if let Some(&k) = self.by_name.get(&full) {
            return Ok(Member::Point(k));
        }
        let base = full.split('[').next().unwrap_or(&full);
        if self.faulty.contains(base) {
            return Err(Refused);
        }
        let names = self.bodies.iter().map(|body| body.name.as_str()).chain(self.points.iter().map(|point| point.name.as_str()));
        let cure = match nearest(&full, names.chain([GROUND])) {
            Some(near) => format!("did you mean `{near}`?"),
            None => format!("add [body.{base}], or name one that is there"),
        };
        Err(entry.refuse(spot, format!("there is no body `{full}`"), cure))
    }

    /// Position of a body in the list, by name.
    pub fn body_by_name(&self, name: &str) -> Option<usize> {
        self.body_names.get(name).copied()
    }

    /// Whether a text names a place or a direction of a body: `BODY.NAME`.
    pub fn is_place_of_body(&self, entry: &Entry<'_>, text: &str) -> bool {
        let body = split_place(text).and_then(|(body, _)| indexed(body, &entry.scope).ok());
        body.is_some_and(|body| self.body_by_name(&body).is_some())
    }

    /// The frame of a side of a joint.
    pub fn frame(&self, member: Member) -> Frame {
        match member {
            Member::Ground => Frame::Ground,
            Member::Point(k) => Frame::Particle(self.points[k].end.place().expect("a point is a node")),
            Member::Body(k) => self.frames[k].clone(),
        }
    }

    /// A joint by name.
    pub fn joint(&self, entry: &Entry<'_>, spot: Spot<'_>, name: &str) -> Read<&Joint> {
        let full = indexed(name, &entry.scope).map_err(|mistake| entry.mistaken(spot, mistake))?;
        if let Some(&k) = self.joint_names.get(&full) {
            return Ok(&self.joints[k]);
        }
        if self.body_by_name(&full).is_some() {
            return Err(entry.refuse(spot, format!("`{full}` is a body, and a joint is wanted here"), "name a [joint.NAME]"));
        }
        if self.faulty_joints.contains(full.split('[').next().unwrap_or(&full)) {
            return Err(Refused);
        }
        let cure = suggest(&full, self.joints.iter().map(|joint| joint.name.as_str()));
        Err(entry.refuse(spot, format!("there is no joint `{full}`"), cure))
    }

    /// Where a place is at the start: `"BODY.POINT"`, the name of a point or a body, or coordinates.
    pub fn place_at_start(&self, entry: &Entry<'_>, spot: Spot<'_>, value: &Value) -> Read<Vec3> {
        match value {
            Value::Text(name) if self.frames.is_empty() && split_place(name).is_some() => {
                self.named_place(entry, spot, name).map(|(_, at)| at)
            }
            _ => self.end_in(entry, spot, value).map(|end| end.start),
        }
    }

    /// A direction at the start: `"BODY.AXIS"`, or components.
    pub fn direction_at_start(&self, entry: &Entry<'_>, spot: Spot<'_>, value: &Value) -> Read<Vec3> {
        let cure = "write a direction as a list of numbers, or \"BODY.AXIS\"";
        match value {
            Value::List(items) if items.len() == self.dimension() => numbers(entry, spot, items),
            Value::Text(text) => {
                let (body, axis) = split_place(text).ok_or_else(|| entry.refuse(spot, format!("\"{text}\" is no direction"), cure))?;
                let Member::Body(k) = self.member(entry, spot, body)? else {
                    return Err(entry.refuse(spot, format!("`{body}` is no body and has no axes"), cure));
                };
                let axes = &self.bodies[k].axes;
                axes.iter().find(|(name, _)| name == axis).map(|&(_, direction)| direction).ok_or_else(|| {
                    let known = suggest(axis, axes.iter().map(|(name, _)| name.as_str()));
                    entry.refuse(spot, format!("the body `{body}` has no axis `{axis}`"), known)
                })
            }
            Value::List(items) => {
                let message = format!("a direction has {} numbers here, and this has {}", self.dimension(), items.len());
                Err(entry.refuse(spot, message, "give one for each axis of the model"))
            }
            other => Err(entry.refuse(spot, format!("a direction is wanted here, and this is {}", other.type_name()), cure)),
        }
    }

    /// A place of a body by its name, `BODY.POINT`, with its position at the start.
    fn named_place(&self, entry: &Entry<'_>, spot: Spot<'_>, name: &str) -> Read<(usize, Vec3)> {
        let (body, place) = split_place(name).expect("there is a dot");
        let Member::Body(k) = self.member(entry, spot, body)? else {
            return Err(entry.refuse(spot, format!("`{body}` is no body and has no named points"), "name a point of a [body.NAME]"));
        };
        let points = &self.bodies[k].points;
        points.iter().find(|(known, _)| known == place).map(|&(_, at)| (k, at)).ok_or_else(|| {
            let cure = match points.is_empty() {
                true => format!("add [body.{body}.points] with {place} = […] in body axes"),
                false => suggest(place, points.iter().map(|(name, _)| name.as_str())),
            };
            entry.refuse(spot, format!("the body `{body}` has no point `{place}`"), cure)
        })
    }

    /// A place of a body as an end.
    pub fn body_end(&self, body: usize, at: Vec3, name: &str) -> End {
        End { terms: self.frames[body].point(at), start: at, free: true, point: None, body: Some(body), name: name.to_string() }
    }

    fn end_in(&self, entry: &Entry<'_>, spot: Spot<'_>, value: &Value) -> Read<End> {
        match value {
            Value::Text(name) if name == GROUND => Ok(fixed([0.0; 3], GROUND.into())),
            Value::Text(name) => self.named(entry, spot, name),
            Value::List(items) if items.len() == self.dimension() => {
                let start = numbers(entry, spot, items)?;
                Ok(fixed(start, value.quoted()))
            }
            Value::List(items) => {
                let message = format!("a fixed place has {} numbers here, and this has {}", self.dimension(), items.len());
                Err(entry.refuse(spot, message, "give one for each axis of the model"))
            }
            other => {
                let message = format!("the name of a point is wanted here, and this is {}", other.type_name());
                Err(entry.refuse(spot, message, "write \"NAME\", \"ground\" or a list of coordinates"))
            }
        }
    }

    fn named(&self, entry: &Entry<'_>, spot: Spot<'_>, name: &str) -> Read<End> {
        if let Some(&k) = self.by_name.get(name) {
            return Ok(self.points[k].end.clone());
        }
        if !self.bodies.is_empty() {
            if split_place(name).is_some() {
                return self.named_place(entry, spot, name).map(|(body, at)| self.body_end(body, at, name));
            }
            if let Ok(Some(k)) = indexed(name, &entry.scope).map(|full| self.body_by_name(&full)) {
                return Ok(self.body_end(k, self.bodies[k].position, name));
            }
        }
        let full = match indexed(name, &entry.scope) {
            Ok(full) => full,
            Err(mistake) => return Err(entry.mistaken(spot, mistake)),
        };
        if let Some(&k) = self.by_name.get(&full) {
            return Ok(self.points[k].end.clone());
        }
        let base = full.split('[').next().unwrap_or(&full);
        if self.faulty.contains(base) {
            return Err(Refused);
        }
        if self.sink.is_full() {
            return Err(entry.refuse(spot, "", ""));
        }
        let begins = format!("{base}[");
        let mut many = self.points.iter().filter(|point| point.name.starts_with(&begins));
        if let (Some(first), last) = (many.next(), many.next_back()) {
            let cure = format!("`{base}` is repeated, from `{}` to `{}`", first.name, last.unwrap_or(first).name);
            return Err(entry.refuse(spot, format!("there is no point `{full}`"), cure));
        }
        let cure = match nearest(&full, self.points.iter().map(|point| point.name.as_str()).chain([GROUND])) {
            Some(near) => format!("did you mean `{near}`?"),
            None => format!("add [point.{base}], or name one that is there"),
        };
        Err(entry.refuse(spot, format!("there is no point `{full}`"), cure))
    }

    /// Draws a line between two ends.
    pub fn draw(&mut self, entry: &Entry<'_>, kind: LineKind, from: &End, to: &End) {
        let anchor = |end: &End| match (end.point, end.body) {
            (Some(k), _) => Anchor::Point(self.points[k].name.clone()),
            (None, Some(k)) => Anchor::Body { body: self.bodies[k].name.clone(), at: self.axes.in_world(self.bodies[k].local(end.start)) },
            (None, None) => Anchor::Fixed(self.axes.in_world(end.start)),
        };
        let line = Line { name: entry.name.to_string(), kind, from: anchor(from), to: anchor(to) };
        self.lines.push(line);
        for end in [from, to] {
            if let Some(k) = end.body {
                self.body_places[k].push(self.bodies[k].local(end.start));
            }
        }
    }

    /// Refuses a start that contradicts a constraint: `off` from where it should be, seen against `size`, both in m.
    pub fn check_start(&self, entry: &Entry<'_>, off: f64, size: f64, what: impl FnOnce() -> String) -> Read<()> {
        self.check_start_within(entry, off, size, CONTRADICTION, what)
    }

    /// The same with another share of the size.
    pub fn check_start_within(&self, entry: &Entry<'_>, off: f64, size: f64, share: f64, what: impl FnOnce() -> String) -> Read<()> {
        // Written so that a NaN is refused too.
        if off.abs() <= share * size.abs() {
            return Ok(());
        }
        Err(entry.refuse_all(what(), "correct the positions at the start, or what contradicts them here"))
    }

    /// The name of one of several rows of an entry.
    pub fn row_name(entry: &Entry<'_>, row: usize, rows: usize) -> String {
        if rows == 1 { entry.name.to_string() } else { format!("{}[{row}]", entry.name) }
    }
}

impl End {
    /// The node or place it is, where it is a single one.
    pub fn place(&self) -> Option<Place> {
        match self.terms[..] {
            [Term { place, factor: 1.0, turn: 0.0 }] => Some(place),
            _ => None,
        }
    }
}

/// A place that never moves.
pub fn fixed(start: [f64; 3], name: String) -> End {
    End { terms: vec![(Place::Fixed(start), 1.0).into()], start, free: false, point: None, body: None, name }
}

/// A node as an end.
pub fn node(id: NodeId, start: [f64; 3], free: bool, point: usize, name: &str) -> End {
    End { terms: vec![(Place::Node(id), 1.0).into()], start, free, point: Some(point), body: None, name: name.to_string() }
}

/// Numbers of a list that may itself be an item of a list, zeros behind them.
fn numbers(entry: &Entry<'_>, spot: Spot<'_>, items: &[Value]) -> Read<[f64; 3]> {
    let read = all(items.iter().map(|item| entry.number_in(spot, item)))?;
    Ok(std::array::from_fn(|k| read.get(k).copied().unwrap_or(0.0)))
}

/// `BODY.POINT` in its two parts; a dot in an index is none between them.
pub fn split_place(text: &str) -> Option<(&str, &str)> {
    let behind = text.rfind(']').map_or(0, |at| at + 1);
    text[behind..].find('.').map(|at| (&text[..behind + at], &text[behind + at + 1..]))
}

/// A reference with its indices worked out: `P[i-1]` becomes `P[2]`.
fn indexed(name: &str, scope: &Scope<'_>) -> Result<String, Mistake> {
    let Some((base, mut rest)) = name.split_once('[') else {
        return Ok(name.to_string());
    };
    let mut full = base.to_string();
    let mut at = base.chars().count() + 1;
    let wrong = |character: usize, message: String| Mistake { character, message, cure: "write \"NAME[i]\"".into(), known: false };
    loop {
        let Some((text, after)) = rest.split_once(']') else {
            return Err(wrong(at, "a closing ] is missing".into()));
        };
        let index = Program::parse(text, &[], scope).map_err(|inner| Mistake { character: at + inner.character, ..inner })?;
        let value = index.as_constant().expect("no variables");
        if value.is_nan() || (value - value.round()).abs() > 1e-9 {
            return Err(wrong(at, format!("the index `{text}` is {value}, which is no whole number")));
        }
        full.push_str(&format!("[{}]", value.round()));
        at += text.chars().count() + 2;
        match after.strip_prefix('[') {
            Some(next) => rest = next,
            None if after.is_empty() => return Ok(full),
            None => return Err(wrong(at - 1, "nothing may follow an index but another one".into())),
        }
    }
}

/// The terms of the way from one end to another, those of the same node together.
pub fn from_to(from: &End, to: &End) -> Vec<Term> {
    subtract(&to.terms, &from.terms)
}

/// The terms of a difference: those of the same node together, all fixed places together, and none that vanishes.
pub fn subtract(to: &[Term], from: &[Term]) -> Vec<Term> {
    let negative = from.iter().map(|term| Term { factor: -term.factor, turn: -term.turn, ..*term });
    let (mut difference, mut fixed, mut size) = (Vec::<Term>::new(), [0.0; 3], 0.0);
    for term in to.iter().copied().chain(negative) {
        if let Place::Fixed(x) = term.place {
            let part = [term.factor * x[0] - term.turn * x[1], term.factor * x[1] + term.turn * x[0], term.factor * x[2]];
            size += norm(part);
            fixed = add(fixed, part);
            continue;
        }
        match difference.iter_mut().find(|known| known.place == term.place) {
            Some(known) => {
                let sum = |a: f64, b: f64| if (a + b).abs() <= GONE * a.abs().max(b.abs()) { 0.0 } else { a + b };
                (known.factor, known.turn) = (sum(known.factor, term.factor), sum(known.turn, term.turn));
            }
            None => difference.push(term),
        }
    }
    difference.retain(|term| term.factor != 0.0 || term.turn != 0.0);
    if norm(fixed) > GONE * size {
        difference.push((Place::Fixed(fixed), 1.0).into());
    }
    difference
}

/// What a difference leaves of its terms, over their size, that is round-off.
const GONE: f64 = 1e-12;

/// Position of the second end minus that of the first, at the start.
pub fn difference(from: &End, to: &End) -> [f64; 3] {
    std::array::from_fn(|c| to.start[c] - from.start[c])
}
