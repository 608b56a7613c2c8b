//! A random mechanism from a seed: a tree of bodies, loops, couplers and forces.

use nalgebra::Vector3;

use crate::bodies::{Motion, orientation, substance};
use crate::extras;
use crate::further;
use crate::joints::{Joint, kind};
use crate::layout::{Layout, Pattern};
use crate::mechanism::{Entry, Mechanism, number, text, vector};
use crate::random::Random;

/// Most bodies of a mechanism, and most loops.
const MOST_BODIES: f64 = 12.0;
const MOST_LOOPS: usize = 3;

/// A body or particle that has its place.
pub struct Placed {
    pub name: String,
    pub centre: Vector3<f64>,
    /// m
    pub size: f64,
    /// kg
    pub mass: f64,
    pub is_point: bool,
}

/// A mechanism while it is made.
pub struct Making {
    pub random: Random,
    pub layout: Layout,
    /// m
    pub size: f64,
    /// 1/s
    pub rate: f64,
    origin: Vector3<f64>,
    pub bodies: Vec<Placed>,
    pub joints: Vec<Joint>,
    pub entries: Vec<Entry>,
}

/// The mechanism of a seed.
pub fn mechanism(seed: u64) -> Mechanism {
    let mut random = Random::new(seed);
    let dim = if random.chance(0.3) { 2 } else { 3 };
    let size = random.log_between(1e-3, 1e3);
    let gravity = gravity(&mut random, dim);
    let fall = (gravity.norm() / size).sqrt();
    let spin = if fall > 0.0 { fall * random.log_between(0.1, 10.0) } else { random.log_between(0.1, 10.0) };
    let layout = Layout::new(&mut random, dim, size);
    let origin = if random.chance(0.1) { random.direction(dim) * (100.0 * size) } else { Vector3::zeros() };
    let rate = spin.max(fall);
    let mut making = Making { random, layout, size, rate, origin, bodies: Vec::new(), joints: Vec::new(), entries: Vec::new() };
    making.grow(spin);
    for _ in 0..making.random.below(MOST_LOOPS + 1) {
        making.close();
    }
    extras::add(&mut making);
    if seed >= further::FROM {
        further::add(&mut making);
    }
    let reactions = making.random.chance(0.5);
    let weight = making.bodies.iter().map(|body| body.mass * gravity.norm() * (body.centre.norm() + size)).sum();
    Mechanism { header: header(&mut making, seed, &gravity), entries: making.entries, reactions, size, rate, weight }
}

fn gravity(random: &mut Random, dim: usize) -> Vector3<f64> {
    let size = match random.below(5) {
        0 => 0.0,
        1 => 9.81 * random.log_between(1e-2, 1e2),
        _ => 9.81,
    };
    match random.chance(0.5) {
        true => Vector3::ith(dim - 1, -size),
        false => random.direction(dim) * size,
    }
}

fn header(making: &mut Making, seed: u64, gravity: &Vector3<f64>) -> Vec<crate::mechanism::Key> {
    let mut keys = vec![("title", text(&format!("Random mechanism {seed}")))];
    if making.layout.dim == 2 {
        keys.push(("plane", text(making.random.pick(&["xy", "xz", "yz"]))));
    }
    keys.push(("gravity", vector(making.layout.dim, gravity)));
    keys
}

impl Making {
    /// The tree of bodies.
    fn grow(&mut self, spin: f64) {
        let share = self.random.between(0.0, 1.0);
        let count = 1 + (MOST_BODIES * share * share) as usize;
        let masses = self.random.below(4);
        let (dim, about) = (self.layout.dim, self.origin);
        let motion = Motion::new(&mut self.random, dim, about, self.size, spin);
        for k in 0..count {
            let mass = match masses {
                0 => 1.0,
                1 => self.random.log_between(0.3, 3.0),
                _ => self.random.log_between(1e-6, 1e6),
            };
            let parent = self.parent();
            self.add(k, mass, parent, &motion);
        }
    }

    /// What the next body hangs on, among the bodies that are no particles: nothing, the ground or one of them.
    fn parent(&mut self) -> Option<Option<usize>> {
        let solid: Vec<usize> = (0..self.bodies.len()).filter(|&k| !self.bodies[k].is_point).collect();
        match (solid.last(), self.random.between(0.0, 1.0)) {
            (None, share) => (share < 0.75).then_some(None),
            (_, share) if share < 0.05 => None,
            (_, share) if share < 0.15 => Some(None),
            (Some(&last), share) if share < 0.6 => Some(Some(last)),
            _ => Some(Some(self.random.pick(&solid))),
        }
    }

    fn add(&mut self, k: usize, mass: f64, parent: Option<Option<usize>>, motion: &Motion) {
        let size = self.size * self.random.log_between(0.3, 3.0);
        let is_point = self.random.chance(0.08);
        let (from, reach) = match parent {
            Some(Some(p)) => (self.bodies[p].centre, self.bodies[p].size),
            _ => (self.origin, self.size),
        };
        let at = from + self.layout.way(&mut self.random, reach);
        let away = self.layout.way(&mut self.random, size);
        let placed = Placed { name: format!("b{k}"), centre: at + away, size, mass, is_point };
        self.write_body(&placed, motion);
        self.bodies.push(placed);
        if let Some(parent) = parent {
            let place = kind(&mut self.random, self.layout.dim, is_point);
            self.tie(parent, k, at, place);
        }
    }

    fn write_body(&mut self, body: &Placed, motion: &Motion) {
        let (dim, random) = (self.layout.dim, &mut self.random);
        let mut keys = vec![("mass", number(body.mass)), ("position", vector(dim, &body.centre))];
        let moving = motion.of(random, dim, &body.centre);
        if let Some([velocity, _]) = &moving {
            keys.push(("velocity", vector(dim, velocity)));
        }
        if !body.is_point {
            keys.extend(moving.map(|[_, spin]| ("angular_velocity", if dim == 2 { number(spin[2]) } else { vector(3, &spin) })));
            keys.extend(orientation(random, dim));
            keys.extend(substance(random, dim, body.size, body.mass));
        }
        let section = if body.is_point { "point" } else { "body" };
        self.entries.push(Entry { section, name: body.name.clone(), uses: Vec::new(), keys });
    }

    /// Joins a body, or the ground, and a body or particle at a place.
    fn tie(&mut self, first: Option<usize>, second: usize, at: Vector3<f64>, kind: &'static str) {
        let body = &self.bodies[second];
        let second_is_point = body.is_point;
        // A particle is where its joint is, but for rods without mass.
        let at = if second_is_point && kind != "distance" { body.centre } else { at };
        let far = if second_is_point { body.centre } else { at + (body.centre - at) * 0.7 };
        let far = if (far - at).norm() > 0.01 * self.size || second_is_point { far } else { at + Vector3::x() * self.size };
        let between = [first.map_or("ground".to_string(), |k| self.bodies[k].name.clone()), body.name.clone()];
        let axis = self.layout.axis(&mut self.random);
        let joint = Joint { name: String::new(), between, second_is_point, at, axis, kind, coordinates: Vec::new(), keys: Vec::new() };
        self.finish(joint, &far);
    }

    fn finish(&mut self, joint: Joint, far: &Vector3<f64>) {
        let mut joint = joint.complete(&mut self.random, &mut self.layout, far, self.size);
        joint.name = format!("j{}", self.joints.len());
        let uses = joint.between.iter().filter(|name| *name != "ground").cloned().collect();
        self.entries.push(Entry { section: "joint", name: joint.name.clone(), uses, keys: joint.keys.clone() });
        self.joints.push(joint);
    }

    /// Closes a loop, or doubles a joint.
    fn close(&mut self) {
        let doubled = self.random.chance(0.3);
        if let (true, false) = (doubled, self.joints.is_empty()) {
            let at = self.random.below(self.joints.len());
            return self.double(self.joints[at].clone());
        }
        let second = self.random.below(self.bodies.len());
        let others: Vec<usize> = (0..self.bodies.len()).filter(|&k| k != second && !self.bodies[k].is_point).collect();
        let first = if others.is_empty() || self.random.chance(0.4) { None } else { Some(self.random.pick(&others)) };
        let kind = match self.layout.pattern == Pattern::Parallel && self.random.chance(0.6) && !self.bodies[second].is_point {
            true => "revolute",
            false => kind(&mut self.random, self.layout.dim, self.bodies[second].is_point),
        };
        let at = self.bodies[second].centre + self.layout.way(&mut self.random, self.bodies[second].size);
        self.tie(first, second, at, kind);
    }

    /// A joint once more, the same or of another kind at the same place along the same axis: its rows are redundant.
    fn double(&mut self, mut joint: Joint) {
        let far = joint.at + self.layout.way(&mut self.random, self.size);
        if joint.second_is_point || joint.kind == "distance" || self.random.chance(0.5) {
            joint.name = format!("j{}", self.joints.len());
            let uses = joint.between.iter().filter(|name| *name != "ground").cloned().collect();
            self.entries.push(Entry { section: "joint", name: joint.name.clone(), uses, keys: joint.keys.clone() });
            self.joints.push(joint);
            return;
        }
        joint.kind = kind(&mut self.random, self.layout.dim, false);
        self.finish(joint, &far);
    }
}
