//! From a description to a model, in phases: evaluate points and bodies, survey what joints share, number the nodes, write rows and forces, put
//! together what is recorded.

use std::cell::Cell;
use std::collections::{HashMap, HashSet};
use std::sync::Arc;

use super::assembly::{Assembly, Axes};
use super::beams::{self, Beam};
use super::bodies::nodes::{self, Member};
use super::bodies::{Files, Placing, RigidBody, short};
use super::description::Description;
use super::element::Boxed;
use super::entries::Entries;
use super::entry::{Entry, Written};
use super::expression::{Functions, Mistake, Program, Scope, TimeProgram, Value as Known};
use super::fault::{Fault, Faults, Refused, Sink, nearest};
use super::fields as field;
use super::forces;
use super::geometry::{self, Vec3, unit};
use super::joints::{self, Geometry, Survey};
use super::jumps;
use super::knocks;
use super::repeat;
use super::sections::Unread;
use super::settings::{Output, Settings};
use super::signals::{Formula, Signals};
use super::tables::Tables;
use super::unseen::OverTime;
use super::value::{Table, Value, key_path};
use super::{GRAVITY, Model, SCHEMA, finish, measure, parameters, points, spinless, start, tables};
use crate::record::Constraints;
use crate::system::{self, SystemBuilder};

/// Compiles a description. What could not be read is known by name, so that nothing that refers to it is a second fault. Where the same model is given
/// in which bodies share nodes, it begins as that does.
pub(super) fn model(
    description: &Description,
    unread: &Unread,
    files: &dyn Files,
    shared: Option<&Model>,
    sink: Sink,
) -> Result<Model, Faults> {
    let (parameters, degrees) = parameters::read(&description.parameters, &sink);
    let room = || Cell::new(repeat::MOST);
    let functions = &description.functions;
    let nothing = Tables::new();
    let others: HashMap<String, &'static str> = description.others().map(|(name, what)| (name.to_string(), what)).collect();
    let (parameters, degrees) = (&parameters, &degrees);
    let first = Compiler { sink: &sink, files, parameters, degrees, tables: &nothing, functions, others: &others, room: room() };
    let tables = first.tables(description, unread);
    let compiler = Compiler { tables: &tables, room: room(), ..first };
    compiler.functions();
    let (axes, gravity) = compiler.head(description);
    let (mut specs, faulty_points) = compiler.points(&description.points, axes);
    let (mut bodies, faulty_bodies) = compiler.bodies(&description.bodies, axes);
    let (beams, faulty_beams) = compiler.beams(&description.beams, axes, &mut bodies);
    let told = [&faulty_points, &faulty_bodies, &faulty_beams, &unread.points, &unread.bodies, &unread.bars, &unread.beams];
    let mut faulty: HashSet<String> = told.into_iter().flatten().cloned().collect();
    let misplaced = compiler.place(description, &mut specs, &mut bodies, &faulty);
    faulty.extend(misplaced);
    let mut assembly = Assembly::new(SystemBuilder::new(axes.dimension(), gravity), axes, gravity, &sink, bodies);
    assembly.faulty = faulty;
    assembly.faulty_joints.clone_from(&unread.joints);
    assembly.signals = compiler.signals(description, unread, &mut assembly.builder);
    points::add(&mut assembly, &specs);
    compiler.bars(description, &mut assembly);
    let geometries = compiler.nodes(description, &mut assembly, &specs, &beams);
    beams.iter().for_each(|beam| beam.spread_mass(&mut assembly));
    points::complete(&mut assembly, specs);
    let mut bars = Vec::new();
    let faulty_bars = compiler.each("bar", &description.bars, |entry, bar| {
        bars.push(bar.build(&mut assembly, entry)?);
        Ok(())
    });
    compiler.build("constraint", &description.constraints, &mut assembly);
    compiler.joints(&description.joints, geometries, &mut assembly);
    compiler.each("start", &description.starts, |entry, start| start.build(&mut assembly, entry));
    compiler.build("drive", &description.drives, &mut assembly);
    let motions = sink.over_time.take();
    compiler.build("force", &description.forces, &mut assembly);
    beams.iter().for_each(|beam| beam.build(&mut assembly));
    let forces = sink.over_time.take().into_iter().map(|force| OverTime { is_motion: false, ..force });
    let over_time = motions.into_iter().chain(forces).collect();
    let (settings, output) = compiler.settings(description, &assembly);
    compiler.each("event", &description.events, |entry, event| event.build(&mut assembly, entry, settings.end));
    // Points of a bar with a fault may have their mass from it.
    if faulty_bars.is_empty() && unread.bars.is_empty() {
        points::check_mass(&assembly);
    }
    if sink.count() == 0 {
        for (path, motion) in sink.motions.take() {
            if let Some(message) = settings.end.and_then(|end| jumps::jump(motion, end)) {
                sink.note(&path, || message);
            }
        }
        if let (Some(end), Some(_)) = (settings.end, settings.choice.accuracy) {
            for time in sink.peaked.take().iter().flat_map(|program| knocks::times(program, end)) {
                assembly.builder.switch(Arc::new(TimeProgram(Program::since(time))));
            }
        }
        for program in sink.switches.take() {
            assembly.builder.switch(Arc::new(TimeProgram(program)));
        }
        assembly.measure_bodies();
        let begun = match shared {
            None => start::begin(&mut assembly, description.equilibrium),
            Some(shared) => start::begin_as(&mut assembly, shared),
        };
        if let Err((message, cure)) = begun {
            drop(assembly);
            let _: Refused = sink.report(|| Fault::new("start", "start", message, cure));
            return Err(sink.finish().expect_err("there is a fault"));
        }
        // At equilibrium a stop that pushes is no slip.
        if !description.equilibrium {
            forces::note_pushing(&assembly);
        }
        if let Some(fault) = if shared.is_none() { spinless::refuse(&assembly) } else { None } {
            drop(assembly);
            let _: Refused = sink.report(|| fault);
            return Err(sink.finish().expect_err("there is a fault"));
        }
        let title = description.model.title.clone().unwrap_or_default();
        let mut model = finish::finish(assembly, title, settings, output, bars, over_time);
        model.at_equilibrium = description.equilibrium;
        let measures = compiler.measures(description, &mut model);
        compiler.columns(description, &model, measures);
        if sink.count() == 0 {
            return Ok(model);
        }
    } else {
        drop(assembly);
    }
    Err(sink.finish().expect_err("there are faults"))
}

pub(super) struct Compiler<'a> {
    sink: &'a Sink,
    files: &'a dyn Files,
    parameters: &'a HashMap<String, Known>,
    /// Those of them whose formulas have the unit `deg`.
    degrees: &'a HashSet<String>,
    tables: &'a Tables,
    functions: &'a Functions,
    /// What the entries are that are neither points nor bodies.
    others: &'a HashMap<String, &'static str>,
    /// Entries that repetitions may still make.
    pub(super) room: Cell<usize>,
}

impl Compiler<'_> {
    pub(super) fn entry<'b>(&'b self, name: &'b str, path: &'b str, written: &'b dyn Written) -> Entry<'b> {
        let scope = Scope {
            parameters: Some(self.parameters),
            degrees: Some(self.degrees),
            indices: &[],
            tables: Some(self.tables),
            functions: Some(self.functions),
            others: Some(self.others),
        };
        Entry { name, path, written, scope, sink: self.sink, files: self.files }
    }

    /// Curves that formulas call as functions.
    fn tables(&self, description: &Description, unread: &Unread) -> Tables {
        let names = description.tables.iter().map(|named| named.name.as_str());
        tables::require_unlike_parameters("table", names, self.parameters, self.sink);
        let mut tables: Tables = unread.tables.iter().map(|name| (name.clone(), None)).collect();
        for named in description.tables.iter() {
            let path = key_path("table", &named.name);
            let curve = named.entry.curve(&self.entry(&named.name, &path, &named.entry));
            tables.insert(named.name.clone(), curve.ok().map(Arc::new));
        }
        tables
    }

    /// Refuses functions with names that formulas cannot call.
    fn functions(&self) {
        let nothing = Table::default();
        let mut names: Vec<&str> = self.functions.keys().map(String::as_str).collect();
        names.sort_unstable();
        tables::require_unlike_parameters("function", names.iter().copied(), self.parameters, self.sink);
        for name in names {
            let path = key_path("function", name);
            let entry = self.entry(name, &path, &nothing);
            let _ = parameters::require_own_name(&entry).and_then(|()| parameters::require_no_function(&entry));
            if self.tables.contains_key(name) {
                let _: Refused = entry.refuse_all(format!("`{name}` is also a table"), "give one of them another name");
            }
        }
    }

    /// Inputs, and the formulas of measures for forces that read them.
    fn signals(&self, description: &Description, unread: &Unread, builder: &mut SystemBuilder) -> Signals {
        for (section, names) in [
            ("input", description.inputs.iter().map(|named| named.name.as_str()).collect::<Vec<_>>()),
            ("measure", description.measures.iter().map(|named| named.name.as_str()).collect()),
        ] {
            tables::require_unlike_parameters(section, names.into_iter(), self.parameters, self.sink);
        }
        let mut signals = Signals { faulty: unread.signals.clone(), ..Signals::default() };
        let faulty = self.each("input", &description.inputs, |entry, input| {
            measure::require_free_name(entry)?;
            let (input, default) = input.recorded(entry)?;
            builder.input(&input.name, default);
            signals.inputs.push(input);
            Ok(())
        });
        signals.faulty.extend(faulty);
        let faulty = self.each("measure", &description.measures, |entry, measure| {
            measure::require_free_name(entry)?;
            let formula = Formula { value: measure.value.clone(), indices: entry.scope.indices.to_vec() };
            signals.measures.insert(entry.name.to_string(), formula);
            Ok(())
        });
        signals.faulty.extend(faulty);
        signals
    }

    /// Measures as formulas of the columns of a model. Hands back their names, and those of measures with a fault.
    fn measures(&self, description: &Description, model: &mut Model) -> Vec<String> {
        let mut names = Vec::new();
        if description.measures.is_empty() {
            return names;
        }
        let reactions = model.output.reactions;
        let of = |constraints| model.channels.headings(&model.system, constraints).into_iter().map(|heading| heading.name);
        let all: HashSet<String> = of(Constraints::Rows).collect();
        let _ = self.each("measure", &description.measures, |entry, _| {
            names.push(entry.name.to_string());
            Ok(())
        });
        let known: HashSet<String> = of(model.output.constraints()).chain(names.iter().cloned()).collect();
        let missing = |name: &str| {
            let is_there = all.contains(name);
            let mistake = |cure: &str| Mistake::new(0, format!("`{name}` is not recorded"), cure);
            match reactions {
                Some(false) if is_there => Some(mistake("remove reactions = false from [output]")),
                _ if is_there => Some(mistake("write reactions = true in [output]")),
                _ => None,
            }
        };
        let columns = measure::Columns { known: &known, missing: &missing, axes: model.axes };
        let mut measures = Vec::new();
        let _ = self.each("measure", &description.measures, |entry, measure| {
            measures.push(measure.recorded(entry, &columns)?);
            Ok(())
        });
        Arc::make_mut(&mut model.channels).measures = measure::sorted(measures, self.sink);
        names
    }

    /// Looks whether there are the columns that `[output]` names.
    fn columns(&self, description: &Description, model: &Model, measures: Vec<String>) {
        let Some(keys) = description.output.as_ref().filter(|keys| keys.columns.is_some()) else { return };
        let constraints = model.output.constraints();
        let headings = model.channels.headings(&model.system, constraints).into_iter().map(|heading| heading.name);
        let names: Vec<String> = headings.chain(measures).collect();
        keys.require_columns(&self.entry("", "output", keys), &names);
    }

    /// Axes and gravity of the model, which is in space where that is not known.
    fn head(&self, description: &Description) -> (Axes, Vec3) {
        let keys = &description.model;
        let root = self.entry("", "", keys);
        // What is wrong with one of these is recorded, and does not hide the others.
        let _ = root.optional("schema", &keys.schema, |schema, root, key| match schema.whole(root, key, 0)? {
            SCHEMA => Ok(()),
            other => Err(root.refuse(
                key,
                format!("this program reads schema {SCHEMA}, and this is {other}"),
                format!("write schema = {SCHEMA}"),
            )),
        });
        let planes: Vec<&'static str> = Axes::ALL[1..].iter().map(|axes| axes.name).collect();
        let meant = |plane: &str| nearest(plane, planes.iter().copied()).unwrap_or_default();
        let plane = keys.plane.as_deref().map(|plane| root.choice("plane", plane, &planes).unwrap_or_else(|Refused| meant(plane)));
        let axes = Axes::ALL.into_iter().find(|axes| plane.is_some_and(|plane| axes.name == plane)).unwrap_or(Axes::ALL[0]);
        let gravity = root.optional("gravity", &keys.gravity, |gravity, root, key| match gravity.len() {
            3 => {
                let world = gravity.vector(root, key, 3)?;
                let inside = axes.of_world(world);
                if let Some(k) = (0..3).find(|&k| axes.in_world(inside)[k] != world[k]) {
                    let (across, plane) = (["x", "y", "z"][k], axes.name);
                    root.note(
                        key,
                        format!("its {across} = {} m/s² is across the plane {plane} of the model and does not act: write two numbers, or take another plane", short(world[k])),
                    );
                }
                Ok(inside)
            }
            _ => gravity.vector(root, key, axes.dimension()),
        });
        (axes, gravity.map_or_else(|_| Vec3::default(), |gravity| gravity.unwrap_or(axes.of_world(GRAVITY))))
    }

    fn points(&self, entries: &Entries<points::Point>, axes: Axes) -> (Vec<points::Spec>, HashSet<String>) {
        let mut specs = Vec::new();
        let faulty = self.each("point", entries, |entry, point| {
            specs.push(point.spec(entry, axes.dimension())?);
            Ok(())
        });
        (specs, faulty)
    }

    fn bodies(&self, entries: &Entries<super::Body>, axes: Axes) -> (Vec<RigidBody>, HashSet<String>) {
        let mut bodies = Vec::new();
        let faulty = self.each("body", entries, |entry, body| {
            bodies.push(body.evaluate(entry, axes.dimension())?);
            Ok(())
        });
        (bodies, faulty)
    }

    /// The beams, whose bodies go behind the others.
    fn beams(&self, entries: &Entries<Beam>, axes: Axes, bodies: &mut Vec<RigidBody>) -> (Vec<beams::Evaluated>, HashSet<String>) {
        let mut beams = Vec::new();
        let faulty = self.each("beam", entries, |entry, beam| {
            beams.push(beam.evaluate(entry, axes.dimension(), bodies)?);
            Ok(())
        });
        (beams, faulty)
    }

    /// Moves the bodies and points that are placed at others there. Hands back the names of those for which that was not possible.
    fn place(
        &self,
        description: &Description,
        specs: &mut [points::Spec],
        bodies: &mut [RigidBody],
        faulty: &HashSet<String>,
    ) -> HashSet<String> {
        let mut placing = Placing::new(bodies, specs, faulty);
        // What is wrong with others has been told, and they may repeat without end.
        let bodies = || description.bodies.iter().filter(|named| !faulty.contains(&named.name));
        let points = || description.points.iter().filter(|named| !faulty.contains(&named.name));
        let again = Compiler { room: Cell::new(usize::MAX), ..*self };
        let mut wait = |entry: &Entry<'_>, place: Option<&field::Place>| match place {
            Some(field::Place::Named(name)) => placing.wait(entry, name),
            _ => Ok(()),
        };
        let mut lost = again.each_of("body", bodies(), |entry, body| wait(entry, Some(&body.position)));
        lost.extend(again.each_of("point", points(), |entry, point| wait(entry, point.position.as_ref())));
        lost.extend(again.each_of("body", bodies(), |entry, _| placing.place(entry)));
        lost.extend(again.each_of("point", points(), |entry, _| placing.place(entry)));
        lost
    }

    /// Looks at joints and forces for what bodies share and need, and makes the nodes. Hands back where the joints of each entry are, unless
    /// something is wrong with them.
    fn nodes(
        &self,
        description: &Description,
        assembly: &mut Assembly<'_>,
        specs: &[points::Spec],
        beams: &[beams::Evaluated],
    ) -> Vec<Option<Vec<Geometry>>> {
        let reacts = description.output.as_ref().and_then(|output| output.reactions) == Some(true);
        let mut survey = Survey::default();
        let mut geometries = Vec::new();
        // What is surveyed is built later, and counts then.
        let surveyor = Compiler { room: Cell::new(self.room.get()), ..*self };
        for named in description.joints.iter() {
            let mut of_entry = Vec::new();
            let surveyed = surveyor.instances("joint", named, &mut |entry, element: &Boxed| {
                let Some(joint) = element.0.as_joint() else { return Ok(()) };
                let geometry = Geometry::of(assembly, entry, joint)?;
                joints::survey(assembly, joint, &geometry, !reacts, &mut survey);
                of_entry.push(geometry);
                Ok(())
            });
            if surveyed.is_err() {
                assembly.faulty_joints.insert(named.name.clone());
            }
            geometries.push(surveyed.is_ok().then_some(of_entry));
        }
        // What is wrong with a force is told when it is built.
        let unheard = Sink::default();
        let surveyor = Compiler { sink: &unheard, ..surveyor };
        for named in description.forces.iter() {
            let _ = surveyor.instances("force", named, &mut |entry, element: &Boxed| {
                for (key, name) in element.0.turns() {
                    if let Ok(Member::Body(body)) = assembly.member(entry, key.into(), name) {
                        survey.needed.extend((0..3).map(|k| (body, unit(k))));
                    }
                }
                Ok(())
            });
        }
        // The section of a beam is a plate, and its elements need what is across that, too.
        survey.needed.extend(beams.iter().flat_map(beams::Evaluated::bodies).flat_map(|body| (0..3).map(move |k| (body, unit(k)))));
        // A named point beside a rod or a plate is held by nodes, too.
        for (k, body) in assembly.bodies.iter().enumerate() {
            survey.needed.extend(body.points.iter().map(|&(_, at)| (k, geometry::subtract(at, body.position))));
        }
        let places: Vec<Option<system::Place>> =
            assembly.points.iter().zip(specs).map(|(point, spec)| if points::is_driven(spec) { None } else { point.end.place() }).collect();
        let wanted = nodes::Wanted {
            bodies: &assembly.bodies,
            shared: &survey.shared,
            merged: &survey.merged,
            needed: &survey.needed,
            extent: survey.length(&assembly.bodies),
            length: survey.body_size(&assembly.bodies),
            points: &|k| places[k],
        };
        assembly.builder.set_size(if wanted.bodies.is_empty() { 0.0 } else { wanted.extent });
        assembly.frames = nodes::make(&mut assembly.builder, &wanted);
        geometries
    }

    /// The names of all bars, which joints may be at.
    fn bars(&self, description: &Description, assembly: &mut Assembly<'_>) {
        // What is named is built later: it counts then, and its faults are told then.
        let unheard = Sink::default();
        let namer = Compiler { sink: &unheard, room: Cell::new(self.room.get()), ..*self };
        namer.each("bar", &description.bars, |entry, _| {
            assembly.bar_names.insert(entry.name.to_string(), assembly.bar_names.len());
            Ok(())
        });
        assembly.bar_ends = vec![None; assembly.bar_names.len()];
    }

    /// Joints first, then what names their coordinates.
    fn joints(&self, entries: &Entries<Boxed>, mut geometries: Vec<Option<Vec<Geometry>>>, assembly: &mut Assembly<'_>) {
        for late in [false, true] {
            for (named, of_entry) in entries.iter().zip(&mut geometries).filter(|(named, _)| named.entry.0.needs_others() == late) {
                let Some(of_entry) = of_entry.take() else { continue };
                assembly.geometries = of_entry.into_iter();
                if self.instances("joint", named, &mut |entry, element: &Boxed| assembly.build(entry, &*element.0)).is_err() {
                    assembly.faulty_joints.insert(named.name.clone());
                }
            }
        }
    }

    fn build(&self, section: &str, entries: &Entries<Boxed>, assembly: &mut Assembly<'_>) {
        for late in [false, true] {
            for named in entries.iter().filter(|named| named.entry.0.needs_others() == late) {
                // A fault is recorded, and what is faulty is not there.
                let _ = self.instances(section, named, &mut |entry, element: &Boxed| assembly.build(entry, &*element.0));
            }
        }
    }

    fn settings(&self, description: &Description, assembly: &Assembly<'_>) -> (Settings, Output) {
        let settings = description.simulation.as_ref().map(|keys| keys.settings(&self.entry("", "simulation", keys), assembly));
        let output = description.output.as_ref().map(|keys| keys.output(&self.entry("", "output", keys), assembly));
        (settings.unwrap_or_default(), output.unwrap_or_default())
    }
}

impl Written for Boxed {
    fn value(&self, key: &str) -> Option<Value> {
        self.0.value(key)
    }
}
