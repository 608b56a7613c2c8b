//! `[start.JOINT]`: coordinates of joints at which a run begins, in place of the pose in which the mechanism is written.

use std::sync::Arc;

use super::assembly::{Assembly, CONTRADICTION, Effort};
use super::bodies::short;
use super::entry::Entry;
use super::fault::{Read, nearest};
use super::fields::{Keys, Number};
use super::joints::{Coordinate, coordinate};
use super::way::{Way, along};
use crate::simulation::{Choice, Method, Simulation};
use crate::system::{Constant, HalfSquare, Shifted, Signal, SystemBuilder};

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
    value: Option<f64>,
    rate: Option<f64>,
    /// The row of its drive.
    row: Option<usize>,
}

impl Target {
    fn is_of(&self, coordinate: &Coordinate) -> bool {
        self.coordinate.joint == coordinate.joint && self.coordinate.name == coordinate.name
    }

    /// Whether the coordinate is put somewhere.
    pub(super) fn is_placed(&self) -> bool {
        self.value.is_some()
    }
}

/// A distance that is driven, of half the square of which a row is one.
pub struct DrivenLength {
    /// Of the drive.
    pub row: usize,
    /// Number of its effort, which has its name, and the distance over time.
    pub effort: usize,
    /// By how much the distance differs from that at the start; `None` where the distance itself is given.
    pub stroke: Option<Arc<dyn Signal>>,
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

/// What a coordinate is at the start.
pub(super) fn value(assembly: &Assembly<'_>, coordinate: &Coordinate) -> f64 {
    assembly.starts.iter().find(|target| target.is_of(coordinate)).and_then(|target| target.value).unwrap_or(0.0)
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
                let are_degrees = value.abs() > std::f64::consts::TAU;
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

/// First share of the way that is tried at once, and the longest where something is left free; and the least.
const FIRST_SHARE: f64 = 0.02;
const LEAST_SHARE: f64 = 1e-4;

/// Parts of the way that are tried.
const MOST_TRIES: usize = 1000;

/// Puts the mechanism where its coordinates are given, and has it move at the rates that are.
///
/// # Errors
/// Why that cannot be, and the cure.
pub(super) fn begin(
    builder: &mut SystemBuilder,
    targets: &[Target],
    lengths: &[DrivenLength],
    efforts: &mut [Effort],
) -> Result<(), (String, &'static str)> {
    if targets.iter().any(Target::is_placed) {
        let released = released(builder, targets, lengths, efforts);
        let is_held = |length: &&DrivenLength| !released.contains(&length.row);
        let distances = distances(builder, lengths, efforts);
        let mut held = lengths.iter().zip(distances).filter(|(length, _)| is_held(length));
        held.try_for_each(|(length, there)| length.require(&efforts[length.effort], there))?;
        assemble(builder, targets, &released)?;
        extend(builder, lengths, efforts)?;
    }
    set_off(builder, targets)
}

/// Moves all nodes on a way along which every constraint is met, with as little as possible of all else, in the metric of the mass.
///
/// # Errors
/// Why that cannot be, and the cure.
fn assemble(builder: &mut SystemBuilder, targets: &[Target], released: &[usize]) -> Result<(), (String, &'static str)> {
    if builder.is_moving() {
        let message = "a velocity is written for the pose in the file, and the mechanism is moved from there".to_string();
        return Err((message, "remove the velocities, or write the bodies where they are at the start"));
    }
    let written = builder.clone().build();
    let (rolls, is_driven) = (written.is_nonholonomic(), written.is_driven());
    let mut here = builder.position().to_vec();
    // Angles there: joints may turn further than half a turn on the way.
    let mut turned = [Vec::new(), Vec::new()];
    // How far all nodes went, over the share, and how fast they go on: at a dead centre no velocity leads there.
    let mut way = vec![0.0; here.len()];
    let mut rate = None;
    // Where coordinates leave something free the place at the end follows from all of the way, and equal parts of it find the same one wherever the
    // model stands.
    let led = || Way { builder, targets, released, turned: [&[], &[]], is_driven }.at(&here, 0.0, 0.0);
    let leaves = |led: Simulation| led.system().coordinates() + led.redundant_rows() > led.system().constraints();
    let is_free = !rolls && led().is_some_and(leaves);
    let longest = if is_free { FIRST_SHARE } else { 1.0 };
    let (mut share, mut step) = (0.0, FIRST_SHARE);
    for tries in 1.. {
        let next = f64::min(share + step, 1.0);
        let angles = turned.each_ref().map(|angles| &angles[..]);
        let ways = Way { builder, targets, released, turned: angles, is_driven };
        let rate_here = &*rate.get_or_insert_with(|| ways.rate(&here, share));
        let ahead = match rate_here {
            Some(rate) if rolls => ways.follow(&here, rate, [share, next]),
            None if rolls => None,
            Some(rate) if is_free => ways.step(&here, rate, [share, next]),
            _ => Some(along(&here, next - share, rate_here.as_ref().unwrap_or(&way))),
        };
        match ahead.and_then(|ahead| ways.at(&ahead, next, 0.0)) {
            Some(simulation) => {
                let state = simulation.state().clone();
                let there = simulation.system().in_world(&state.x);
                way = there.iter().zip(&here).map(|(there, here)| (there - here) / (next - share)).collect();
                here = there.to_vec();
                turned = [state.angle, state.measured];
                (share, step, rate) = (next, f64::min(2.0 * step, longest), None);
                if share == 1.0 {
                    builder.move_to(&here, turned.each_ref().map(|angles| &angles[..]));
                    break;
                }
            }
            None if step > LEAST_SHARE && tries < MOST_TRIES => step *= 0.5,
            None => {
                let message = format!("the mechanism cannot be moved there: it gets {} % of the way", short(100.0 * share));
                let cure = match is_driven && share == 0.0 {
                    true => {
                        "take values that the joints can have together, and of coordinates that go together, as those of a screw or of wheels in mesh, the one that is driven"
                    }
                    false => "take values that the joints can have together; away from a dead centre a coordinate leads that moves there",
                };
                return Err((message, cure));
            }
        }
    }
    Ok(())
}

/// The rows of driven distances that would hold the coordinates where they are: without one of these fewer rows are redundant beside those that
/// lead. They get as long as it takes.
fn released(builder: &SystemBuilder, targets: &[Target], lengths: &[DrivenLength], efforts: &[Effort]) -> Vec<usize> {
    let mut held = builder.clone();
    for (length, there) in lengths.iter().zip(distances(builder, lengths, efforts)) {
        held.retarget(length.row, Arc::new(HalfSquare(Arc::new(Constant(there)))));
    }
    // Their drives wait for them where they are put.
    targets.iter().filter_map(|target| target.row).for_each(|row| held.retarget(row, Arc::new(Constant(0.0))));
    // How many more rows are redundant where coordinates are led.
    let more = |without: Option<usize>| {
        let count = |mut builder: SystemBuilder| {
            without.into_iter().for_each(|row| builder.remove_row(row));
            start(builder).map(|simulation| simulation.redundant_rows())
        };
        let mut led = held.clone();
        lead(&mut led, targets, 0.0, 0.0);
        Some(count(led)?.saturating_sub(count(held.clone())?))
    };
    let most = if lengths.is_empty() { None } else { more(None) };
    let holds = |row: &usize| matches!((more(Some(*row)), most), (Some(fewer), Some(most)) if fewer < most);
    lengths.iter().map(|length| length.row).filter(holds).collect()
}

/// How far the ends of driven distances are apart where the mechanism is, m.
fn distances(builder: &SystemBuilder, lengths: &[DrivenLength], efforts: &[Effort]) -> Vec<f64> {
    if lengths.is_empty() {
        return Vec::new();
    }
    let system = builder.clone().build();
    let (mut at, mut values) = (system.evaluation(), vec![0.0; system.constraints()]);
    system.evaluate_again(system.start_position(), 0.0, &mut at);
    system.constraint_values(&at, 0.0, &mut values);
    // The row is half the square less that of the distance that is given.
    let of_row = |length: &DrivenLength| (2.0 * values[length.row] + efforts[length.effort].at_start().powi(2)).max(0.0).sqrt();
    lengths.iter().map(of_row).collect()
}

impl DrivenLength {
    /// Refuses a distance that is given and is another than that of its ends, which are `there` m apart.
    fn require(&self, effort: &Effort, there: f64) -> Result<(), (String, &'static str)> {
        let given = effort.at_start();
        if self.stroke.is_some() || (there - given).abs() <= CONTRADICTION * given {
            return Ok(());
        }
        let (name, given, there) = (&effort.name, short(given), short(there));
        let message = format!("`{name}` is {given} m long at t = 0, but its ends are {there} m apart at the start");
        Err((message, "give that distance, or `stroke`, which counts from it"))
    }
}

/// Has strokes of driven distances count from where the ends are now, and refuses distances that are others than those.
fn extend(builder: &mut SystemBuilder, lengths: &[DrivenLength], efforts: &mut [Effort]) -> Result<(), (String, &'static str)> {
    for (length, there) in lengths.iter().zip(distances(builder, lengths, efforts)) {
        let effort = &mut efforts[length.effort];
        length.require(effort, there)?;
        if let Some(stroke) = &length.stroke
            && (there - effort.at_start()).abs() > f64::EPSILON * there
        {
            let counted: Arc<dyn Signal> = Arc::new(Shifted(stroke.clone(), there));
            builder.retarget(length.row, Arc::new(HalfSquare(counted.clone())));
            effort.length = Some(counted);
        }
    }
    Ok(())
}

/// Has coordinates lead to a share of the way, where they go on by `going` of it in a second.
pub(super) fn lead(builder: &mut SystemBuilder, targets: &[Target], share: f64, going: f64) {
    for Target { coordinate, value, row, .. } in targets {
        let Some(value) = value else { continue };
        let here = Arc::new(Rising([share * value, going * value]));
        if let Some(row) = row {
            builder.retarget(*row, here);
            continue;
        }
        let part = builder.part(&coordinate.form);
        let sum = builder.sum(&[(part, 1.0)]);
        builder.row(&coordinate.joint, sum, here);
    }
}

/// The mechanism at its start, where it has one.
pub(super) fn start(builder: SystemBuilder) -> Option<Simulation> {
    let method = Method::resolve(&Choice::default()).expect("the default method goes with everything");
    Simulation::new(Arc::new(builder.build()), method, 1e-3).ok()
}

/// A coordinate that has a rate: its value now, and that.
struct Rising([f64; 2]);

impl Signal for Rising {
    fn at(&self, t: f64) -> [f64; 3] {
        let [value, rate] = self.0;
        [value + rate * t, rate, 0.0]
    }
}

/// Gives the nodes the velocities at which coordinates have their rates and all constraints are met, with as little as possible of a change
/// of those that are written, in the metric of the mass.
fn set_off(builder: &mut SystemBuilder, targets: &[Target]) -> Result<(), (String, &'static str)> {
    let rated: Vec<(&Target, f64)> = targets.iter().filter_map(|target| Some((target, target.rate?))).collect();
    if rated.is_empty() {
        return Ok(());
    }
    if let Some((Target { coordinate, .. }, _)) = rated.iter().find(|(target, _)| target.row.is_some()) {
        let message = format!("`{}.{}` is driven: its drive says how fast it is", coordinate.joint, coordinate.name);
        return Err((message, "remove the rate, or the drive"));
    }
    let mut led = builder.clone();
    let first = led.rows();
    for (Target { coordinate, .. }, _) in &rated {
        let part = led.part(&coordinate.form);
        let sum = led.sum(&[(part, 1.0)]);
        led.row(&coordinate.joint, sum, Arc::new(Constant(0.0)));
    }
    // What the new rows are at zero targets are the coordinates as they are counted there.
    let here = led.clone().build();
    let (mut at, mut values) = (here.evaluation(), vec![0.0; here.constraints()]);
    here.evaluate_again(here.start_position(), 0.0, &mut at);
    here.constraint_values(&at, 0.0, &mut values);
    for (k, (_, rate)) in rated.iter().enumerate() {
        led.retarget(first + k, Arc::new(Rising([values[first + k], *rate])));
    }
    match start(led) {
        Some(simulation) => builder.set_velocity(&simulation.state().v),
        None => {
            let name = |(Target { coordinate, .. }, _): &(&Target, f64)| format!("`{}.{}`", coordinate.joint, coordinate.name);
            let names = rated.iter().map(name).collect::<Vec<_>>().join(", ");
            let message = format!("no velocities at the start meet all constraints and the rates that are given of {names}");
            return Err((message, "take rates that the joints can have together, and that no constraint forbids"));
        }
    }
    Ok(())
}
