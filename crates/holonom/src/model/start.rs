//! `[start.JOINT]`: coordinates of joints at which a run begins, in place of the pose in which the mechanism is written.

use std::sync::Arc;

use super::assembly::Assembly;
use super::bodies::short;
use super::entry::Entry;
use super::fault::Read;
use super::fields::{Keys, Number};
use super::joints::{Coordinate, coordinate};
use crate::simulation::{Choice, Method, Simulation};
use crate::system::{Constant, Signal, System, SystemBuilder};

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
}

/// A coordinate, and what it is at the start.
pub struct Target {
    coordinate: Coordinate,
    value: f64,
    /// The row of its drive.
    row: Option<usize>,
}

/// A motion that begins elsewhere.
struct Shifted(Arc<dyn Signal>, f64);

impl Signal for Shifted {
    fn at(&self, t: f64) -> [f64; 3] {
        let [value, rate, second] = self.0.at(t);
        [value + self.1, rate, second]
    }

    fn is_constant(&self) -> bool {
        self.0.is_constant()
    }
}

/// The profile of a drive of a coordinate, whose row is the next one: it counts from where the joint is at the start.
pub(super) fn profile(assembly: &mut Assembly<'_>, coordinate: &Coordinate, profile: Arc<dyn Signal>) -> Arc<dyn Signal> {
    let row = assembly.builder.rows();
    let of = |target: &&mut Target| target.coordinate.joint == coordinate.joint && target.coordinate.name == coordinate.name;
    match assembly.starts.iter_mut().find(of) {
        None => profile,
        Some(target) => {
            target.row = Some(row);
            Arc::new(Shifted(profile, target.value))
        }
    }
}

impl Start {
    /// Adds the coordinates of the joint that the entry is called after to those that are moved.
    pub(super) fn build(&self, assembly: &mut Assembly<'_>, entry: &Entry<'_>) -> Read<()> {
        let given = [("angle", &self.angle), ("displacement", &self.displacement)];
        if given.iter().all(|(_, value)| value.is_none()) {
            return Err(entry.refuse_all("nothing is said of the start", "give `angle` or `displacement`"));
        }
        for (key, value) in given {
            let Some(value) = entry.optional(key, value, Number::number)? else { continue };
            let name = format!("{}.{key}", entry.name);
            let coordinate = coordinate(assembly, entry, key.into(), &name)?;
            if coordinate.is_angle && value.abs() >= std::f64::consts::PI {
                return Err(entry.refuse(key, format!("{value} rad is half a turn or more"), "take the same angle within half a turn"));
            }
            assembly.starts.push(Target { coordinate, value, row: None });
        }
        Ok(())
    }
}

/// First share of the way that is tried at once, and the least.
const FIRST_SHARE: f64 = 0.02;
const LEAST_SHARE: f64 = 1e-4;

/// Parts of the way that are tried.
const MOST_TRIES: usize = 1000;

/// Moves all nodes on a way along which every constraint is met, with as little as possible of all else, in the metric of the mass.
///
/// # Errors
/// Why that cannot be, and the cure.
pub(super) fn assemble(builder: &mut SystemBuilder, targets: &[Target]) -> Result<(), (String, &'static str)> {
    if targets.is_empty() {
        return Ok(());
    }
    if builder.is_moving() {
        let message = "a velocity is written for the pose in the file, and the mechanism is moved from there".to_string();
        return Err((message, "remove the velocities, or write the bodies where they are at the start"));
    }
    let (mut share, mut step) = (0.0, FIRST_SHARE);
    let mut here = builder.position().to_vec();
    // How far all nodes went, over the share.
    let mut way = vec![0.0; here.len()];
    for tries in 1.. {
        let next = f64::min(share + step, 1.0);
        let ahead: Vec<f64> = here.iter().zip(&way).map(|(x, way)| x + (next - share) * way).collect();
        builder.move_to(&ahead);
        match at(builder.clone(), targets, next) {
            Some((system, x)) => {
                let there = system.in_world(&x);
                way = there.iter().zip(&here).map(|(there, here)| (there - here) / (next - share)).collect();
                here = there.to_vec();
                (share, step) = (next, 2.0 * step);
                if share == 1.0 {
                    builder.move_to(&here);
                    break;
                }
            }
            None if step > LEAST_SHARE && tries < MOST_TRIES => step *= 0.5,
            None => {
                let message = format!("the mechanism cannot be moved there: it gets {} % of the way", short(100.0 * share));
                let cure = "take values that the joints can have together; away from a dead centre a coordinate leads that moves there";
                return Err((message, cure));
            }
        }
    }
    Ok(())
}

/// The mechanism with its coordinates at a share of the way.
fn at(mut builder: SystemBuilder, targets: &[Target], share: f64) -> Option<(Arc<System>, Vec<f64>)> {
    for Target { coordinate, value, row } in targets {
        let here = Arc::new(Constant(share * value));
        if let Some(row) = row {
            builder.retarget(*row, here);
            continue;
        }
        let part = builder.part(&coordinate.form);
        let sum = builder.sum(&[(part, 1.0)]);
        builder.row(&coordinate.joint, sum, here);
    }
    let system = Arc::new(builder.build());
    let method = Method::resolve(&Choice::default()).expect("the default method goes with everything");
    let simulation = Simulation::new(system.clone(), method, 1e-3).ok()?;
    let x = simulation.state().x.clone();
    Some((system, x))
}
