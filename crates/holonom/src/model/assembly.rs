//! What the readers of points, bars, constraints and forces build on: the system so far, and the points by name.

use std::collections::{HashMap, HashSet};

use super::entry::{Entry, Spot, all};
use super::expression::{Mistake, Program, Scope};
use super::fault::{Read, Refused, Sink, nearest};
use super::value::Value;
use crate::record::{Anchor, Line, LineKind};
use crate::system::{NodeId, Place, SystemBuilder};

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
    pub place: Place,
    /// Position at the start in the axes of the model, m.
    pub start: [f64; 3],
    /// Whether its motion is sought.
    pub free: bool,
    /// Position in the list of points, if it is one.
    pub point: Option<usize>,
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
        match (1..ends.len()).find(|&k| ends[k].place == ends[k - 1].place) {
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
        let anchor = |end: &End| match end.point {
            Some(k) => Anchor::Point(self.points[k].name.clone()),
            None => Anchor::Fixed(self.axes.in_world(end.start)),
        };
        let line = Line { name: entry.name.to_string(), kind, from: anchor(from), to: anchor(to) };
        self.lines.push(line);
    }

    /// Refuses a start that contradicts a constraint: `off` from where it should be, seen against `size`, both in m.
    pub fn check_start(&self, entry: &Entry<'_>, off: f64, size: f64, what: impl FnOnce() -> String) -> Read<()> {
        // Written so that a NaN is refused too.
        if off.abs() <= CONTRADICTION * size.abs() {
            return Ok(());
        }
        Err(entry.refuse_all(what(), "correct the positions at the start, or what contradicts them here"))
    }

    /// The name of one of several rows of an entry.
    pub fn row_name(entry: &Entry<'_>, row: usize, rows: usize) -> String {
        if rows == 1 { entry.name.to_string() } else { format!("{}[{row}]", entry.name) }
    }
}

/// A place that never moves.
pub fn fixed(start: [f64; 3], name: String) -> End {
    End { place: Place::Fixed(start), start, free: false, point: None, name }
}

/// A node as an end.
pub fn node(id: NodeId, start: [f64; 3], free: bool, point: usize, name: &str) -> End {
    End { place: Place::Node(id), start, free, point: Some(point), name: name.to_string() }
}

/// Numbers of a list that may itself be an item of a list, zeros behind them.
fn numbers(entry: &Entry<'_>, spot: Spot<'_>, items: &[Value]) -> Read<[f64; 3]> {
    let read = all(items.iter().map(|item| entry.number_in(spot, item)))?;
    Ok(std::array::from_fn(|k| read.get(k).copied().unwrap_or(0.0)))
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

/// w − u
pub fn difference(from: &End, to: &End) -> [f64; 3] {
    std::array::from_fn(|c| to.start[c] - from.start[c])
}

/// u · w
pub fn dot(u: [f64; 3], w: [f64; 3]) -> f64 {
    u[0] * w[0] + u[1] * w[1] + u[2] * w[2]
}

/// Length of a vector.
pub fn norm(u: [f64; 3]) -> f64 {
    dot(u, u).sqrt()
}

/// u × w
pub fn cross(u: [f64; 3], w: [f64; 3]) -> [f64; 3] {
    [u[1] * w[2] - u[2] * w[1], u[2] * w[0] - u[0] * w[2], u[0] * w[1] - u[1] * w[0]]
}

/// The k-th unit vector.
pub fn unit(k: usize) -> [f64; 3] {
    std::array::from_fn(|c| f64::from(u8::from(c == k)))
}
