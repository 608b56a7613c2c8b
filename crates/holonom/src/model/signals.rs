//! What the formulas of forces and events may read of a mechanism beside their own variables: inputs, measures, and positions and
//! velocities of points, bodies and joints, by the names of their columns.

use std::collections::{HashMap, HashSet};

use smallvec::SmallVec;

use super::assembly::{Assembly, GROUND};
use super::entry::Entry;
use super::expression::{self, Mistake, Names, Program, Scope, indexed, names_in};
use super::fields::Number;
use super::geometry::unit;
use super::measure::like;
use super::spin;
use super::sum::Sum;
use crate::record::RecordedInput;
use crate::system::{Form, Number as AnyNumber, Quantity, Reading, Sense};

/// Inputs, and the formulas of measures.
#[derive(Default)]
pub(super) struct Signals {
    /// In file order.
    pub inputs: Vec<RecordedInput>,
    pub measures: HashMap<String, Formula>,
    /// Names of entries that could not be read; what refers to them is no second fault.
    pub faulty: HashSet<String>,
}

/// The formula of a measure, with the indices of its repetition.
#[derive(Clone)]
pub(super) struct Formula {
    pub value: Number,
    pub indices: Vec<(String, f64)>,
}

/// What a formula reads, behind its own variables.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Leaf {
    /// A coordinate of the k-th place, or of its velocity.
    Place(usize, usize, bool),
    /// A component of the angular velocity of the k-th body.
    Turn(usize, usize),
    /// The k-th sense, or its rate.
    Sense(usize, bool),
}

/// What the formulas of a force or an event read of the state.
#[derive(Default)]
pub(super) struct Readings {
    dim: usize,
    leaves: Vec<Leaf>,
    places: Vec<Sum>,
    /// Axes of bodies: three, in the plane the first.
    turns: Vec<Vec<Sum>>,
    /// Names of leaves, places and bodies, in their order.
    names: [Vec<String>; 3],
    /// Nodes and quantities.
    pub reading: Reading,
    /// Names of the senses.
    senses: Vec<String>,
}

impl Readings {
    /// Nothing yet, of a load on these nodes and quantities.
    pub fn new(dim: usize, reading: Reading) -> Self {
        let senses = reading.senses.iter().map(|_| String::new()).collect();
        Self { dim, reading, senses, ..Self::default() }
    }

    /// Coordinates a node.
    pub fn dim(&self) -> usize {
        self.dim
    }

    /// How many numbers it reads.
    pub fn len(&self) -> usize {
        self.leaves.len()
    }

    /// The name of the first number that is no position of a place.
    pub fn first_but_positions(&self) -> Option<&str> {
        let other = self.leaves.iter().position(|leaf| !matches!(leaf, Leaf::Place(_, _, false)))?;
        Some(&self.names[0][other])
    }

    /// The name of the first number that is a velocity.
    pub fn first_rate(&self) -> Option<&str> {
        let rate = self.leaves.iter().position(|leaf| matches!(leaf, Leaf::Place(_, _, true) | Leaf::Turn(..) | Leaf::Sense(_, true)))?;
        Some(&self.names[0][rate])
    }

    /// Adds a quantity that the load acts on, behind all that is read; says where it is among the load's coordinates. Nothing is read after
    /// that.
    pub fn own(&mut self, quantity: Quantity) -> usize {
        self.reading.senses.push(Sense::Quantity(quantity));
        self.dim * self.reading.nodes.len() + self.reading.senses.len() - 1
    }

    /// Appends what it reads at coordinates `x` and velocities `v` of the nodes and then of the senses.
    pub fn append<N: AnyNumber>(&self, x: &[N], v: &[N], out: &mut SmallVec<[N; ROOM]>) {
        let own = self.dim * self.reading.nodes.len();
        for leaf in &self.leaves {
            out.push(match *leaf {
                Leaf::Place(k, axis, false) => self.places[k].at(x, self.dim, 1.0)[axis],
                Leaf::Place(k, axis, true) => self.places[k].at(v, self.dim, 0.0)[axis],
                Leaf::Sense(k, false) => x[own + k],
                Leaf::Sense(k, true) => v[own + k],
                Leaf::Turn(k, axis) => spin::angular_velocity(&self.turns[k], x, v, self.dim)[axis],
            });
        }
    }
}

impl Readings {
    /// Adds to `by_x` and `by_v` what a function changes by with the coordinates `x` and the velocities `v`, whose slopes by what it reads these are.
    pub fn spread<N: AnyNumber>(&self, slopes: &[N], [x, v]: [&[N]; 2], [by_x, by_v]: [&mut [N]; 2]) {
        let own = self.dim * self.reading.nodes.len();
        for (leaf, &slope) in self.leaves.iter().zip(slopes) {
            let along = |axis: usize| std::array::from_fn(|c| if c == axis { slope } else { N::from(0.0) });
            match *leaf {
                Leaf::Place(k, axis, false) => self.places[k].spread(along(axis), self.dim, by_x),
                Leaf::Place(k, axis, true) => self.places[k].spread(along(axis), self.dim, by_v),
                Leaf::Sense(k, false) => by_x[own + k] += slope,
                Leaf::Sense(k, true) => by_v[own + k] += slope,
                Leaf::Turn(k, axis) => spin::spread(&self.turns[k], along(axis), [x, v], self.dim, [&mut *by_x, &mut *by_v]),
            }
        }
    }

    /// Names of the places of which it reads coordinates.
    pub fn places(&self) -> &[String] {
        &self.names[1]
    }

    /// Adds what a function of positions changes by with each of these places, whose slopes by what it reads these are.
    pub fn spread_on_places(&self, slopes: &[f64], by_place: &mut [[f64; 3]]) {
        for (leaf, slope) in self.leaves.iter().zip(slopes) {
            if let Leaf::Place(k, axis, false) = *leaf {
                by_place[k][axis] += slope;
            }
        }
    }
}

/// Variables of a formula that are not put on the heap.
pub(super) const ROOM: usize = 16;

/// Resolves names while the formulas of an entry are parsed.
pub(super) struct Reader<'a, 'b> {
    pub assembly: &'a mut Assembly<'b>,
    pub entry: &'a Entry<'a>,
    pub readings: &'a mut Readings,
    /// The formulas of measures that have been read.
    read: HashMap<String, Program>,
}

impl<'a, 'b> Reader<'a, 'b> {
    pub fn new(assembly: &'a mut Assembly<'b>, entry: &'a Entry<'a>, readings: &'a mut Readings) -> Self {
        Self { assembly, entry, readings, read: HashMap::new() }
    }

    fn leaf(&mut self, name: &str, leaf: Leaf) -> usize {
        self.readings.leaves.push(leaf);
        self.readings.names[0].push(name.to_string());
        self.readings.leaves.len() - 1
    }

    /// The number of a quantity or input among the senses.
    fn sense(&mut self, name: &str, make: impl FnOnce(&mut Assembly<'b>) -> Sense) -> usize {
        let Readings { senses, reading, .. } = &mut *self.readings;
        if let Some(known) = senses.iter().position(|sense| sense == name) {
            return known;
        }
        senses.push(name.to_string());
        reading.senses.push(make(self.assembly));
        senses.len() - 1
    }

    /// A joint coordinate or the angle of a planar body.
    fn form(&self, name: &str) -> Option<Form> {
        let (owner, coordinate) = name.rsplit_once('.')?;
        if let Some(&joint) = self.assembly.joint_names.get(owner) {
            let coordinates = &self.assembly.joints[joint].coordinates;
            return coordinates.iter().find(|known| known.name == coordinate).map(|known| known.form.clone());
        }
        let body = self.assembly.body_by_name(owner).filter(|_| self.readings.dim == 2 && coordinate == "angle")?;
        Some(self.assembly.bodies[body].angle(&self.assembly.frames[body]))
    }

    /// A coordinate of a place or of its velocity.
    fn place(&mut self, name: &str) -> Option<Leaf> {
        let (owner, suffix) = name.rsplit_once('.')?;
        let (is_rate, letter) = suffix.strip_prefix('v').map_or((false, suffix), |letter| (true, letter));
        let mut letters = self.assembly.axes.name.chars();
        let axis = letters.position(|axis| letter.len() == 1 && letter.starts_with(axis))?;
        let known = self.readings.names[1].iter().position(|known| known == owner);
        let place = match known {
            Some(known) => known,
            None => {
                let terms = self.terms(owner)?;
                self.readings.places.push(Sum::new(&terms, &mut self.readings.reading.nodes));
                self.readings.names[1].push(owner.to_string());
                self.readings.places.len() - 1
            }
        };
        Some(Leaf::Place(place, axis, is_rate))
    }

    /// The nodes of a point, of the centre of mass of a body, or of a named place of one.
    fn terms(&self, owner: &str) -> Option<Vec<crate::system::Term>> {
        if let Some(&point) = self.assembly.by_name.get(owner) {
            return Some(self.assembly.points[point].end.terms.clone());
        }
        if let Some(body) = self.assembly.body_by_name(owner) {
            return Some(self.assembly.frames[body].point(self.assembly.bodies[body].position));
        }
        let (body, place) = super::references::split_place(owner)?;
        let body = self.assembly.body_by_name(body)?;
        let (_, at) = self.assembly.bodies[body].points.iter().find(|(known, _)| known == place)?;
        Some(self.assembly.frames[body].point(*at))
    }

    /// A component of the angular velocity of a body in space.
    fn turn(&mut self, name: &str) -> Result<Option<Leaf>, Mistake> {
        let Some((owner, suffix)) = name.rsplit_once('.') else { return Ok(None) };
        let axis = ["wx", "wy", "wz"].iter().position(|known| *known == suffix).filter(|_| self.readings.dim == 3);
        let (Some(axis), Some(body)) = (axis, self.assembly.body_by_name(owner)) else { return Ok(None) };
        if let Some(known) = self.readings.names[2].iter().position(|known| known == owner) {
            return Ok(Some(Leaf::Turn(known, axis)));
        }
        let (frame, own) = (&self.assembly.frames[body], &self.assembly.bodies[body]);
        let directions: Vec<_> = (0..3).map(|k| own.direction(unit(k))).collect();
        if !directions.iter().all(|&direction| frame.holds(direction)) {
            let message = format!("how `{owner}` turns about itself is not known: it is thin, and nothing holds it there");
            return Err(Mistake::new(0, message, "give it some inertia about that axis"));
        }
        let axes = directions.into_iter().map(|direction| frame.vector(direction)).collect::<Vec<_>>();
        let axes = axes.iter().map(|axis| Sum::new(axis, &mut self.readings.reading.nodes)).collect();
        self.readings.turns.push(axes);
        self.readings.names[2].push(owner.to_string());
        Ok(Some(Leaf::Turn(self.readings.turns.len() - 1, axis)))
    }

    /// A measure that a formula names and that has not been read.
    fn unread(&self, text: &str, scope: &Scope<'_>) -> Option<String> {
        let names = names_in(text).into_iter().filter_map(|name| indexed(&name, scope).ok());
        names.into_iter().find(|name| self.assembly.signals.measures.contains_key(name) && !self.read.contains_key(name))
    }

    /// Whether a name begins with one of an entry that could not be read.
    fn is_faulty(&self, name: &str) -> bool {
        let base = |name: &str| name.split(['[', '.']).next().unwrap_or(name).to_string();
        let name = base(name);
        self.assembly.signals.faulty.contains(&name) || self.assembly.faulty.contains(&name) || self.assembly.faulty_joints.contains(&name)
    }

    /// Names of what can be read, without rates.
    fn names(&self) -> Vec<String> {
        let assembly = &self.assembly;
        let axes = assembly.axes.name;
        let of_axes = |owner: &str, first: &str| axes.chars().map(|axis| format!("{owner}.{first}{axis}")).collect::<Vec<_>>();
        let coordinates = |owner: &str| [of_axes(owner, ""), of_axes(owner, "v")].concat();
        let turns = |owner: &str| match assembly.dimension() {
            2 => vec![format!("{owner}.angle"), format!("{owner}.angle_rate")],
            _ => of_axes(owner, "w"),
        };
        let points = assembly.points.iter().flat_map(|point| coordinates(&point.name));
        let bodies = assembly.bodies.iter().flat_map(|body| {
            let places = body.points.iter().flat_map(|(place, _)| coordinates(&format!("{}.{place}", body.name)));
            coordinates(&body.name).into_iter().chain(turns(&body.name)).chain(places).collect::<Vec<_>>()
        });
        let joints = assembly.joints.iter().flat_map(|joint| {
            let names = joint.coordinates.iter().map(|coordinate| format!("{}.{}", joint.name, coordinate.name));
            names.flat_map(|name| [name.clone(), format!("{name}_rate")]).collect::<Vec<_>>()
        });
        let inputs = assembly.signals.inputs.iter().map(|input| input.name.clone());
        let mut measures: Vec<String> = assembly.signals.measures.keys().cloned().collect();
        measures.sort_unstable();
        inputs.chain(measures).chain(joints).chain(points).chain(bodies).collect()
    }
}

/// Whether the column of a thing is a force, a moment, a power or an acceleration.
fn is_of_all_that_acts(column: &str) -> bool {
    let of_axis = |first: &str| column.strip_prefix(first).is_some_and(|axis| ["x", "y", "z"].contains(&axis));
    ["force", "effort", "power", "f", "t", "alpha"].contains(&column) || ["a", "alpha", "f", "t", "r"].into_iter().any(of_axis)
}

impl Names for Reader<'_, '_> {
    fn variable(&mut self, name: &str) -> Result<Option<usize>, Mistake> {
        if let Some(known) = self.readings.names[0].iter().position(|known| known == name) {
            return Ok(Some(known));
        }
        if name.split('.').next() == Some(GROUND) {
            return Ok(None);
        }
        if self.is_faulty(name) {
            return Err(Mistake::known());
        }
        if let Some(input) = self.assembly.signals.inputs.iter().position(|input| input.name == name) {
            let sense = self.sense(name, |_| Sense::Input(input));
            return Ok(Some(self.leaf(name, Leaf::Sense(sense, false))));
        }
        for (coordinate, is_rate) in [(Some(name), false), (name.strip_suffix("_rate"), true)] {
            if let Some(coordinate) = coordinate
                && let Some(form) = self.form(coordinate)
            {
                let sense = self.sense(coordinate, |assembly| {
                    let part = assembly.builder.part(&form);
                    Sense::Quantity(assembly.builder.sum(&[(part, 1.0)]).into())
                });
                return Ok(Some(self.leaf(name, Leaf::Sense(sense, is_rate))));
            }
        }
        let leaf = match self.place(name) {
            Some(leaf) => Some(leaf),
            None => self.turn(name)?,
        };
        if let Some(leaf) = leaf {
            return Ok(Some(self.leaf(name, leaf)));
        }
        if let Some(mistake) = self.entry.scope.of_bar(name).filter(|_| !name.ends_with(".force")) {
            return Err(mistake);
        }
        if let Some((_, column)) = name.rsplit_once('.')
            && is_of_all_that_acts(column)
        {
            let message = format!(
                "`{name}` cannot be read here: forces and accelerations follow from all that acts, and only measures may read them"
            );
            return Err(Mistake::new(
                0,
                message,
                "write it by positions and velocities: what a spring pulls with is STIFFNESS*(distance(A, B) - LENGTH)",
            ));
        }
        if let Some((_, column)) = name.rsplit_once('.') {
            let names = self.names();
            let cure = match column {
                "length" => "write distance(A, B) of its two ends".into(),
                "length_rate" => "write speed(A, B) of its two ends".into(),
                _ => like(name, &names),
            };
            // Constraints come before the coordinates of joints.
            let coordinates = if self.assembly.joints.is_empty() { "" } else { "coordinates of joints, " };
            let message = format!("`{name}` cannot be read here: positions, velocities, {coordinates}inputs and measures of these can");
            return Err(Mistake::new(0, message, cure));
        }
        Ok(None)
    }

    fn formula(&mut self, name: &str) -> Result<Option<Program>, Mistake> {
        let measures = &self.assembly.signals.measures;
        if !measures.contains_key(name) {
            return Ok(None);
        }
        // Its own formula means the number by this name, and would seem to read itself.
        if let Some(what) = expression::number_called(name) {
            return Err(Mistake::new(
                0,
                format!("`{name}` is a {what} of every expression, and a measure"),
                "give the measure another name",
            ));
        }
        // Each after all it reads, without recursion: a chain of measures may be long.
        let mut open = vec![name.to_string()];
        while let Some(name) = open.last().filter(|name| !self.read.contains_key(*name)).cloned() {
            let Formula { value, indices } = self.assembly.signals.measures[&name].clone();
            let scope = Scope { indices: &indices, ..self.entry.scope };
            let program = match value {
                Number::Given(number) => Program::constant(number),
                Number::Formula(text) => match self.unread(&text, &scope) {
                    Some(need) if open.contains(&need) => {
                        let round: Vec<&str> = open.iter().skip_while(|open| **open != need).map(String::as_str).collect();
                        let message = format!("measures go round in a circle: {} → {need}", round.join(" → "));
                        return Err(Mistake::new(0, message, "let one of them read no other"));
                    }
                    Some(need) => {
                        open.push(need);
                        continue;
                    }
                    None => Program::parse_with(&text, &["t"], self, &scope).map_err(|inner| match inner.known {
                        true => inner,
                        false => Mistake::new(0, format!("the measure `{name}` cannot be read here: {}", inner.message), inner.cure),
                    })?,
                },
            };
            self.read.insert(name, program);
            open.pop();
        }
        Ok(self.read.get(name).cloned())
    }

    fn axes(&self) -> Option<&'static str> {
        Some(self.assembly.axes.name)
    }

    fn has(&self, name: &str) -> bool {
        let signals = &self.assembly.signals;
        signals.measures.contains_key(name) || signals.inputs.iter().any(|input| input.name == name)
    }

    fn known(&self) -> Vec<String> {
        self.names()
    }
}
