//! A model as it is written, without places in a file: what can be made by hand, changed, compiled, and compiled again.

use super::bars::Bar;
use super::beams::Beam;
use super::bodies::{Body, Files, NoFiles};
use super::element::Boxed;
use super::entries::{Entries, Named};
use super::event::Event;
use super::expression::{BAR, BEAM, External, ExternalFunction, Functions};
use super::fault::{Faults, Refused, Sink};
use super::fields::{Field, Keys, List, Number};
use super::input::Input;
use super::key::{Kinds, Shape};
use super::measure::Measure;
use super::points::Point;
use super::sections::{Names, Unread, read};
use super::settings::{OutputKeys, SimulationKeys};
use super::start::{EQUILIBRIUM, Start};
use super::tables::Curve;
use super::value::{Table, Value};
use super::{Model, compile};

/// A model as it is written. Numbers are numbers or formulas over its parameters, so that one of these can be changed and the model compiled
/// again.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Description {
    /// Title, gravity and plane.
    pub model: ModelKeys,
    /// Named numbers and formulas for all others.
    pub parameters: Table,
    /// `[table.NAME]`: curves, which formulas call as functions.
    pub tables: Entries<Curve>,
    /// Functions that a program gives, which formulas call by their names; a file has none.
    pub functions: Functions,
    /// `[input.NAME]`: numbers from outside.
    pub inputs: Entries<Input>,
    /// `[point.NAME]`: particles, and places that stay or are driven.
    pub points: Entries<Point>,
    /// `[body.NAME]`: rigid bodies.
    pub bodies: Entries<Body>,
    /// `[bar.NAME]`: bars with mass between two points.
    pub bars: Entries<Bar>,
    /// `[beam.NAME]`: elastic beams.
    pub beams: Entries<Beam>,
    /// `[joint.NAME]`: joints between bodies, and couplers of their coordinates.
    pub joints: Entries<Boxed>,
    /// `[constraint.NAME]`: what holds points.
    pub constraints: Entries<Boxed>,
    /// `[drive.NAME]`: motions that are given over time.
    pub drives: Entries<Boxed>,
    /// `[force.NAME]`: springs, dampers, loads and other forces.
    pub forces: Entries<Boxed>,
    /// `[start.JOINT]`: where joints are at the start.
    pub starts: Entries<Start>,
    /// `equilibrium` of `[start]`: whether the mechanism begins where all forces balance.
    pub equilibrium: bool,
    /// `[measure.NAME]`: formulas of what the mechanism does, recorded and read by others.
    pub measures: Entries<Measure>,
    /// `[event.NAME]`: conditions whose times are found.
    pub events: Entries<Event>,
    /// `[simulation]`: how it is run; `None` leaves that to who runs it.
    pub simulation: Option<SimulationKeys>,
    /// `[output]`: what is recorded of it; `None` is motion at every step.
    pub output: Option<OutputKeys>,
}

/// Keys of the model itself.
#[derive(Clone, Debug, Default, PartialEq, Keys)]
pub struct ModelKeys {
    /// version of the model file
    #[key(default = "1", shape = Shape::Whole)]
    pub schema: Option<Number>,
    /// one line for people
    #[key(default = "none")]
    pub title: Option<String>,
    /// in the axes of the model, or all three of the world
    #[key(unit = "m/s²", default = "[0, 0, -9.81]", shape = Shape::Vector)]
    pub gravity: Option<List<Number>>,
    /// makes the model planar, with two coordinates a point
    #[key(default = "none: the model is in space", shape = Shape::Choice(&["xy", "xz", "yz"]))]
    pub plane: Option<String>,
}

impl Description {
    /// An empty model with a title.
    pub fn new(title: impl Into<String>) -> Self {
        Self { model: ModelKeys { title: Some(title.into()), ..ModelKeys::default() }, ..Self::default() }
    }

    /// Sets a parameter that every formula may use.
    pub fn parameter(&mut self, name: &str, value: impl Into<Number>) {
        self.parameters.set(name, value.into().write());
    }

    /// Adds a curve that formulas call as a function.
    pub fn table(&mut self, name: impl Into<String>, table: Curve) -> &mut Named<Curve> {
        self.tables.add(name, table)
    }

    /// Adds a function that formulas call by its name.
    pub fn function(&mut self, name: impl Into<String>, function: impl ExternalFunction + 'static) {
        self.functions.insert(name.into(), External::new(function));
    }

    /// Adds a number from outside.
    pub fn input(&mut self, name: impl Into<String>, input: Input) -> &mut Named<Input> {
        self.inputs.add(name, input)
    }

    /// Adds a point.
    pub fn point(&mut self, name: impl Into<String>, point: Point) -> &mut Named<Point> {
        self.points.add(name, point)
    }

    /// Adds a body.
    pub fn body(&mut self, name: impl Into<String>, body: Body) -> &mut Named<Body> {
        self.bodies.add(name, body)
    }

    /// Adds a bar.
    pub fn bar(&mut self, name: impl Into<String>, bar: Bar) -> &mut Named<Bar> {
        self.bars.add(name, bar)
    }

    /// Adds an elastic beam.
    pub fn beam(&mut self, name: impl Into<String>, beam: Beam) -> &mut Named<Beam> {
        self.beams.add(name, beam)
    }

    /// Adds a joint or a coupler.
    pub fn joint(&mut self, name: impl Into<String>, joint: impl Into<Boxed>) -> &mut Named<Boxed> {
        self.joints.add(name, joint)
    }

    /// Adds a constraint.
    pub fn constraint(&mut self, name: impl Into<String>, constraint: impl Into<Boxed>) -> &mut Named<Boxed> {
        self.constraints.add(name, constraint)
    }

    /// Adds a drive.
    pub fn drive(&mut self, name: impl Into<String>, drive: impl Into<Boxed>) -> &mut Named<Boxed> {
        self.drives.add(name, drive)
    }

    /// Adds a force.
    pub fn force(&mut self, name: impl Into<String>, force: impl Into<Boxed>) -> &mut Named<Boxed> {
        self.forces.add(name, force)
    }

    /// Adds a measure.
    pub fn measure(&mut self, name: impl Into<String>, measure: Measure) -> &mut Named<Measure> {
        self.measures.add(name, measure)
    }

    /// Adds an event.
    pub fn event(&mut self, name: impl Into<String>, event: Event) -> &mut Named<Event> {
        self.events.add(name, event)
    }

    /// Compiles the model.
    ///
    /// # Errors
    /// Everything that is wrong with it.
    pub fn compile(&self) -> Result<Model, Faults> {
        self.compile_with(&NoFiles)
    }

    /// The same with the files that bodies name.
    ///
    /// # Errors
    /// Everything that is wrong with it.
    pub fn compile_with(&self, files: &dyn Files) -> Result<Model, Faults> {
        let sink = Sink::default();
        let mut names = Names::new(&sink);
        self.names().for_each(|(section, name)| {
            let _ = names.check(section, name);
        });
        compile::model(self, &Unread::default(), files, None, sink)
    }

    /// Reads a table as it stands in a file.
    ///
    /// # Errors
    /// Everything that is missing or of another shape. What its words mean is looked at when it is compiled.
    pub fn from_value(value: &Value, kinds: &Kinds) -> Result<Self, Faults> {
        let sink = Sink::default();
        let read = read(value, kinds, &sink);
        match (sink.finish(), read) {
            (Ok(()), Ok(partial)) => Ok(partial.description),
            (Err(faults), _) => Err(faults),
            (Ok(()), Err(Refused)) => unreachable!("what is refused has a fault"),
        }
    }

    /// The table as it would stand in a file.
    pub fn to_value(&self) -> Value {
        let mut table = Keys::write(&self.model);
        let boxed = |boxed: &Boxed| boxed.0.write();
        let sections = [
            ("parameters", (!self.parameters.is_empty()).then(|| Value::Table(self.parameters.clone()))),
            ("table", self.tables.write(Keys::write)),
            ("input", self.inputs.write(Keys::write)),
            ("point", self.points.write(Keys::write)),
            ("body", self.bodies.write(Keys::write)),
            ("bar", self.bars.write(Keys::write)),
            ("beam", self.beams.write(Keys::write)),
            ("joint", self.joints.write(boxed)),
            ("constraint", self.constraints.write(boxed)),
            ("drive", self.drives.write(boxed)),
            ("force", self.forces.write(boxed)),
            ("start", self.write_starts()),
            ("measure", self.measures.write(Keys::write)),
            ("event", self.events.write(Keys::write)),
            ("simulation", self.simulation.as_ref().map(Field::write)),
            ("output", self.output.as_ref().map(Field::write)),
        ];
        sections.into_iter().for_each(|(name, section)| section.into_iter().for_each(|section| table.push(name, section)));
        Value::Table(table)
    }

    /// The table of starts, with its own key.
    fn write_starts(&self) -> Option<Value> {
        let mut table = Table::default();
        if self.equilibrium {
            table.push(EQUILIBRIUM.name, Value::Bool(true));
        }
        if let Some(Value::Table(of_joints)) = self.starts.write(Keys::write) {
            of_joints.iter().for_each(|(name, value)| table.push(name, value.clone()));
        }
        (!table.is_empty()).then_some(Value::Table(table))
    }

    /// Names of the entries that are neither points nor bodies, and what they are.
    pub(super) fn others(&self) -> impl Iterator<Item = (&str, &'static str)> {
        let what = |section| match section {
            "input" => Some("an input"),
            "measure" => Some("a measure"),
            "event" => Some("an event"),
            "table" => Some("a table"),
            "bar" => Some(BAR),
            "beam" => Some(BEAM),
            "joint" => Some("a joint"),
            "constraint" => Some("a constraint"),
            "drive" => Some("a drive"),
            "force" => Some("a force"),
            _ => None,
        };
        self.names().filter_map(move |(section, name)| Some((name, what(section)?)))
    }

    /// Names of all entries with their sections.
    fn names(&self) -> impl Iterator<Item = (&'static str, &str)> {
        fn of<'a, T>(section: &'static str, entries: &'a Entries<T>) -> impl Iterator<Item = (&'static str, &'a str)> {
            entries.iter().map(move |named| (section, named.name.as_str()))
        }
        let signals = of("table", &self.tables)
            .chain(of("input", &self.inputs))
            .chain(of("measure", &self.measures))
            .chain(of("event", &self.events));
        let rigid = of("point", &self.points).chain(of("body", &self.bodies)).chain(of("bar", &self.bars));
        let parts = rigid.chain(of("beam", &self.beams));
        let elements = of("constraint", &self.constraints).chain(of("joint", &self.joints));
        signals.chain(parts).chain(elements).chain(of("drive", &self.drives)).chain(of("force", &self.forces))
    }
}
