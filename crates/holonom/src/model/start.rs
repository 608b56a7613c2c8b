//! `[start.JOINT]`: coordinates of joints at which a run begins, in place of the pose in which the mechanism is written.

use std::sync::Arc;

use super::Model;
use super::adrift;
use super::assembly::{Assembly, Effort};
use super::beams::{Elastic, stiffened};
use super::entry::Entry;
use super::fault::{Read, nearest};
use super::fields::{Keys, Number};
use super::joints::{Coordinate, coordinate};
use super::key::{Key, Shape};
use super::lengths::{DrivenLength, extend, released, require_held};
use super::rest;
use super::way::{self, assemble};
use crate::simulation::Places;
use crate::system::{Constant, Shifted, Signal, SystemBuilder, place_of};

/// The key of `[start]` itself.
pub const EQUILIBRIUM: Key = Key::optional(
    "equilibrium",
    Shape::Flag,
    "false",
    "",
    "begins where all forces balance at t = 0, with the joints that are given a place held there",
);

/// `[start.JOINT]`
#[derive(Clone, Debug, Default, PartialEq, Keys)]
#[table("a start")]
pub struct Start {
    /// angle of the joint at the start, counted from the pose that is written; less than half a turn
    #[key(unit = "rad", default = "as it comes")]
    pub angle: Option<Number>,
    /// displacement of the joint at the start, counted from the pose that is written
    #[key(unit = "m", default = "as it comes")]
    pub displacement: Option<Number>,
    /// first angle of a universal joint at the start, in the same way
    #[key(unit = "rad", default = "as it comes")]
    pub angle1: Option<Number>,
    /// second angle of a universal joint at the start, in the same way
    #[key(unit = "rad", default = "as it comes")]
    pub angle2: Option<Number>,
    /// displacement along x at the start, of a joint that leaves that free, in the same way
    #[key(unit = "m", default = "as it comes")]
    pub x: Option<Number>,
    /// displacement along y at the start, of a joint that leaves that free, in the same way
    #[key(unit = "m", default = "as it comes")]
    pub y: Option<Number>,
    /// displacement along z at the start, of a joint that leaves that free, in the same way
    #[key(unit = "m", default = "as it comes")]
    pub z: Option<Number>,
    /// rate of the angle at the start
    #[key(unit = "rad/s", default = "as it comes")]
    pub angle_rate: Option<Number>,
    /// rate of the displacement at the start
    #[key(unit = "m/s", default = "as it comes")]
    pub displacement_rate: Option<Number>,
    /// rate of `angle1` at the start
    #[key(unit = "rad/s", default = "as it comes")]
    pub angle1_rate: Option<Number>,
    /// rate of `angle2` at the start
    #[key(unit = "rad/s", default = "as it comes")]
    pub angle2_rate: Option<Number>,
    /// rate of `x` at the start
    #[key(unit = "m/s", default = "as it comes")]
    pub x_rate: Option<Number>,
    /// rate of `y` at the start
    #[key(unit = "m/s", default = "as it comes")]
    pub y_rate: Option<Number>,
    /// rate of `z` at the start
    #[key(unit = "m/s", default = "as it comes")]
    pub z_rate: Option<Number>,
}

/// A coordinate, and what it and its rate are at the start, where they are given.
pub struct Target {
    coordinate: Coordinate,
    pub(super) value: Option<f64>,
    rate: Option<f64>,
    /// The row of its drive.
    pub(super) row: Option<usize>,
}

impl Target {
    fn is_of(&self, coordinate: &Coordinate) -> bool {
        self.coordinate.joint == coordinate.joint && self.coordinate.name == coordinate.name
    }

    /// Adds a row of the coordinate, whose target is yet to be given, and hands back its number.
    pub(super) fn add_row(&self, builder: &mut SystemBuilder) -> usize {
        let part = builder.part(&self.coordinate.form);
        let sum = builder.sum(&[(part, 1.0)]);
        builder.row(&self.coordinate.joint, sum, Arc::new(Constant(0.0)));
        builder.rows() - 1
    }

    /// What is measured of the joint under its name: `JOINT.COORDINATE`.
    pub(super) fn name(&self) -> String {
        format!("{}.{}", self.coordinate.joint, self.coordinate.name)
    }

    /// Whether the coordinate is put somewhere.
    pub(super) fn is_placed(&self) -> bool {
        self.value.is_some()
    }

    /// Whether its rate is given.
    pub(super) fn is_rated(&self) -> bool {
        self.rate.is_some()
    }
}

/// The profile of a drive of a coordinate, whose row is the next one: it counts from where the joint is at the start.
pub(super) fn profile(assembly: &mut Assembly<'_>, coordinate: &Coordinate, profile: Arc<dyn Signal>) -> Arc<dyn Signal> {
    let row = assembly.builder.rows();
    match assembly.starts.iter_mut().find(|target| target.is_of(coordinate)) {
        None => profile,
        Some(target) => {
            target.row = Some(row);
            Arc::new(Shifted(profile, target.value.unwrap_or(0.0)))
        }
    }
}

impl Start {
    /// Adds the coordinates of the joint that the entry is called after to those that are moved.
    pub(super) fn build(&self, assembly: &mut Assembly<'_>, entry: &Entry<'_>) -> Read<()> {
        let given = [
            ("angle", &self.angle, "angle_rate", &self.angle_rate),
            ("displacement", &self.displacement, "displacement_rate", &self.displacement_rate),
            ("angle1", &self.angle1, "angle1_rate", &self.angle1_rate),
            ("angle2", &self.angle2, "angle2_rate", &self.angle2_rate),
            ("x", &self.x, "x_rate", &self.x_rate),
            ("y", &self.y, "y_rate", &self.y_rate),
            ("z", &self.z, "z_rate", &self.z_rate),
        ];
        if given.iter().all(|(_, value, _, rate)| value.is_none() && rate.is_none()) {
            let cure = "give a coordinate of the joint, as `angle` or `displacement`, or its rate, as `angle_rate`";
            return Err(entry.refuse_all("nothing is said of the start", cure));
        }
        require_single(assembly, entry)?;
        for (key, value, rate_key, rate) in given {
            let (value, rate) = (entry.optional(key, value, Number::number)?, entry.optional(rate_key, rate, Number::number)?);
            if value.is_none() && rate.is_none() {
                continue;
            }
            let at = if value.is_some() { key } else { rate_key };
            let coordinate = coordinate(assembly, entry, at.into(), &format!("{}.{key}", entry.name))?;
            if let Some(value) = value.filter(|value| coordinate.is_angle && value.abs() >= std::f64::consts::PI) {
                let within = "take the same angle within half a turn";
                let are_degrees = value.abs() > std::f64::consts::TAU && !entry.is_in_degrees(key, 0);
                let cure = if are_degrees { format!("{within}; in degrees write \"{value}*deg\"") } else { within.into() };
                return Err(entry.refuse(key, format!("{value} rad is half a turn or more"), cure));
            }
            assembly.starts.push(Target { coordinate, value, rate, row: None });
        }
        Ok(())
    }
}

/// Refuses the bare name of a joint that is repeated, also where it is misspelt.
fn require_single(assembly: &Assembly<'_>, entry: &Entry<'_>) -> Read<()> {
    let name = entry.name;
    if name.contains('[') || assembly.joint_names.contains_key(name) || assembly.faulty_joints.contains(name) {
        return Ok(());
    }
    let names = || assembly.joints.iter().map(|joint| joint.name.as_str());
    let of_family = names().find(|known| known.strip_prefix(name).is_some_and(|rest| rest.starts_with('[')));
    match of_family.or_else(|| nearest(name, names())).and_then(|one| Some((one, one_of(one)?))) {
        Some((one, cure)) if of_family.is_some() => Err(entry.refuse_all(format!("`{name}` is repeated, as `{one}` and others"), cure)),
        Some((_, cure)) => Err(entry.refuse_all(format!("there is no joint `{name}`"), cure)),
        None => Ok(()),
    }
}

/// How a start is written for one of those that a joint is repeated to, such as `hinge[2]`.
pub(super) fn one_of(joint: &str) -> Option<String> {
    let (base, indices) = joint.split_once('[')?;
    let indices = indices.trim_end_matches(']').split("][").zip('i'..='z');
    let ranges: Vec<String> = indices.map(|(value, index)| format!("{index} = {value} to {value}")).collect();
    Some(format!("for `{joint}` alone write [start.{base}] with repeat = \"{}\", and a longer range for several", ranges.join(", ")))
}

/// Puts the mechanism where the run begins, at equilibrium or not, and sets it off. Notes what that moves.
///
/// # Errors
/// Why that cannot be, and the cure.
pub(super) fn begin(assembly: &mut Assembly<'_>, equilibrium: bool) -> Result<(), (String, &'static str)> {
    let targets = std::mem::take(&mut assembly.starts);
    let lengths = std::mem::take(&mut assembly.lengths);
    let before = (!targets.is_empty() && !equilibrium).then(|| adrift::measured(&assembly.builder).1);
    let elastic = std::mem::take(&mut assembly.elastic);
    let mut leaves_free = match place(&mut assembly.builder, &targets, &lengths, &mut assembly.efforts, Some(&elastic)) {
        // Beams that cannot go along as they are come to rest bent.
        Err(_) if equilibrium && !elastic.is_empty() => place(&mut assembly.builder, &targets, &lengths, &mut assembly.efforts, None)?,
        Err((message, _)) if !elastic.is_empty() => {
            return Err((
                format!("{message}, if beams stay as they are written"),
                "write equilibrium = true in [start], where beams may bend on the way",
            ));
        }
        placed => placed?,
    };
    let settled = if equilibrium { rest::settle(assembly, &targets)? } else { None };
    leaves_free |= match set_off(&mut assembly.builder, &targets, &elastic, &assembly.efforts) {
        // Beams that cannot go along without being deformed are struck.
        Err(_) if !elastic.is_empty() => set_off(&mut assembly.builder, &targets, &[], &assembly.efforts)?,
        set_off => set_off?,
    };
    let is_at_rest = !equilibrium && !elastic.is_empty() && !assembly.builder.is_moving();
    // Beams go along with drives, too, where they can without being deformed. Velocities that are written say what is struck.
    if is_at_rest
        && assembly.builder.clone().build().is_driven()
        && let Some((velocities, _)) = velocities(&stiffened(&assembly.builder, &elastic))
    {
        assembly.builder.set_velocity(&velocities);
    }
    assembly.elastic = elastic;
    // Where forces balance, what has moved there is all that is told.
    let followed = before.filter(|_| leaves_free).and_then(|before| adrift::followed(assembly, &targets, &before));
    let adrift = (!equilibrium && targets.iter().any(Target::is_placed)).then(|| adrift::moved(assembly)).flatten();
    for (path, message) in [("start.equilibrium", settled), ("start", followed), ("start", adrift)] {
        message.into_iter().for_each(|message| assembly.sink.note(path, || message));
    }
    Ok(())
}

/// Puts the mechanism where the same one begins in which bodies share nodes, so that what is asked of the start holds here as it does there.
///
/// # Errors
/// Driven distances that are others than those of their ends, and the cure.
pub(super) fn begin_as(assembly: &mut Assembly<'_>, shared: &Model) -> Result<(), (String, &'static str)> {
    let targets = std::mem::take(&mut assembly.starts);
    let lengths = std::mem::take(&mut assembly.lengths);
    let are_placed = targets.iter().any(Target::is_placed);
    if !are_placed && !shared.at_equilibrium {
        return Ok(());
    }
    let mut position = assembly.builder.position().to_vec();
    let places = assembly.points.iter().map(|point| point.end.place().expect("a point is a node"));
    let (x, dim) = (shared.system.in_world(shared.system.start_position()), assembly.dimension());
    for (own, terms) in
        position.chunks_exact_mut(dim).zip(shared.nodes_of(places, &assembly.frames, assembly.builder.free()).iter().flatten())
    {
        own.copy_from_slice(&place_of(terms, &x, dim)[..dim]);
    }
    // Turns of angles are counted where the mechanism moves.
    assembly.builder.move_to(&position, [&[]; 2]);
    if are_placed { extend(&mut assembly.builder, &lengths, &mut assembly.efforts) } else { Ok(()) }
}

/// Puts the mechanism where its coordinates are given, with beams as they are, or bent where forces balance. Says whether these leave anything free.
///
/// # Errors
/// Why that cannot be, and the cure.
fn place(
    builder: &mut SystemBuilder,
    targets: &[Target],
    lengths: &[DrivenLength],
    efforts: &mut [Effort],
    elastic: Option<&[Elastic]>,
) -> Result<bool, (String, &'static str)> {
    if !targets.iter().any(Target::is_placed) {
        return Ok(false);
    }
    let released = released(builder, targets, lengths, efforts);
    require_held(builder, lengths, efforts, &released)?;
    let leaves_free = assemble(builder, targets, &released, elastic)?;
    extend(builder, lengths, efforts)?;
    Ok(leaves_free)
}

/// A coordinate that has a rate: its value now, and that.
pub(super) struct Rising(pub [f64; 2]);

impl Signal for Rising {
    fn at(&self, t: f64) -> [f64; 3] {
        let [value, rate] = self.0;
        [value + rate * t, rate, 0.0]
    }
}

/// With rows by which coordinates go on from where they are at rates.
pub(super) fn leading(builder: &SystemBuilder, rates: &[(&Target, f64)]) -> SystemBuilder {
    let mut led = builder.clone();
    let first = led.rows();
    rates.iter().for_each(|(target, _)| _ = target.add_row(&mut led));
    let mut rates = rates.iter().map(|(_, rate)| *rate);
    hold(&mut led, first, |value| Arc::new(Rising([value, rates.next().unwrap_or_default()])));
    led
}

/// Has the rows from the `first` on, whose targets are zero, begin where what they hold is.
pub(super) fn hold(builder: &mut SystemBuilder, first: usize, mut target: impl FnMut(f64) -> Arc<dyn Signal>) {
    let here = builder.clone().build();
    let (mut at, mut values) = (here.evaluation(), vec![0.0; here.constraints()]);
    here.evaluate_again(here.start_position(), 0.0, &mut at);
    here.constraint_values(&at, 0.0, &mut values);
    (first..builder.rows()).for_each(|row| builder.retarget(row, target(values[row])));
}

/// Gives the nodes the velocities at which coordinates have their rates and all constraints are met, with as little as possible of a change
/// of those that are written, in the metric of the mass. Says whether the rates leave anything free.
fn set_off(
    builder: &mut SystemBuilder,
    targets: &[Target],
    elastic: &[Elastic],
    efforts: &[Effort],
) -> Result<bool, (String, &'static str)> {
    let rated: Vec<(&Target, f64)> = targets.iter().filter_map(|target| Some((target, target.rate?))).collect();
    if rated.is_empty() {
        return Ok(false);
    }
    if let Some((Target { coordinate, .. }, _)) = rated.iter().find(|(target, _)| target.row.is_some()) {
        let message = format!("`{}.{}` is driven: its drive says how fast it is", coordinate.joint, coordinate.name);
        return Err((message, "remove the rate, or the drive"));
    }
    let stiff = stiffened(builder, elastic);
    match velocities(&leading(&stiff, &rated)) {
        Some((velocities, leaves_free)) => {
            builder.set_velocity(&velocities);
            Ok(leaves_free)
        }
        None => {
            let name = |(Target { coordinate, .. }, _): &(&Target, f64)| format!("`{}.{}`", coordinate.joint, coordinate.name);
            let names = rated.iter().map(name).collect::<Vec<_>>().join(", ");
            let message = format!("no velocities at the start meet all constraints and the rates that are given of {names}");
            let drives = barring(&stiff, &rated, efforts);
            if !drives.is_empty() {
                let are = if drives.len() == 1 { "is driven at another speed" } else { "are driven at other speeds" };
                let drives = drives.iter().map(|drive| format!("`{drive}`")).collect::<Vec<_>>().join(", ");
                return Err((
                    format!("{message}: {drives} {are} there"),
                    "remove the rates, or the drives, or give the drives the speeds at t = 0 that go with the rates",
                ));
            }
            // Such as the axis of one of four parallel hinges that is a little off: the loop is stuck, and no other rate helps.
            let redundant = Places::new(builder.clone().build()).is_ok_and(|mut places| {
                let x = places.system().start_position().to_vec();
                places.put(&x).is_ok() && places.redundant_rows() > 0
            });
            Err((
                message,
                match redundant {
                    true => {
                        "take rates that the joints can have together, and that no constraint forbids; or, as some constraints follow from others, write \
                         places and axes with all digits: a loop of hinges that are a little off does not move"
                    }
                    false => "take rates that the joints can have together, and that no constraint forbids",
                },
            ))
        }
    }
}

/// The velocities at which all constraints are met where the nodes are, and whether these leave anything free. `None` where there are none.
fn velocities(builder: &SystemBuilder) -> Option<(Vec<f64>, bool)> {
    let mut places = Places::new(builder.clone().build()).ok()?;
    let x = places.system().start_position().to_vec();
    places.put(&x).ok()?;
    let leaves_free = way::leaves_free(&places);
    Some((places.velocities().ok()?.to_vec(), leaves_free))
}

/// Drives, by name, with any of which there are no velocities at the rates that are given, while there are without them.
fn barring<'e>(builder: &SystemBuilder, rated: &[(&Target, f64)], efforts: &'e [Effort]) -> Vec<&'e str> {
    let has_velocities = |without: &[&Effort]| {
        let mut free = builder.clone();
        without.iter().rev().for_each(|effort| free.remove_row(effort.row));
        velocities(&leading(&free, rated)).is_some()
    };
    let mut barring: Vec<&Effort> = efforts.iter().collect();
    if barring.is_empty() || !has_velocities(&barring) {
        return Vec::new();
    }
    for effort in efforts {
        let fewer: Vec<&Effort> = barring.iter().copied().filter(|other| other.row != effort.row).collect();
        if has_velocities(&fewer) {
            barring = fewer;
        }
    }
    barring.into_iter().map(|effort| effort.name.as_str()).collect()
}
