//! The way of a mechanism to the coordinates at which it starts. With constraints of velocities the places at its end follow from all of it, as
//! wheels roll along it.

use std::sync::Arc;

use super::beams::{Elastic, stiffened};
use super::bodies::short;
use super::start::{Rising, Target};
use crate::simulation::{Places, along, follow};
use crate::system::SystemBuilder;

/// First share of the way that is tried at once, and the longest where something is left free; and the least.
const FIRST_SHARE: f64 = 0.02;
const LEAST_SHARE: f64 = 1e-4;

/// Parts of the way that are tried.
const MOST_TRIES: usize = 1000;

/// Moves all nodes on a way along which every constraint is met, with as little as possible of all else, in the metric of the mass, and beams stay as they are.
/// Without these, it comes to rest after each part of the way: elements next to what leads would bear all of it, and turn inside out. Says whether the
/// coordinates leave anything free.
///
/// # Errors
/// Why that cannot be, and the cure.
pub(super) fn assemble(
    builder: &mut SystemBuilder,
    targets: &[Target],
    released: &[usize],
    elastic: Option<&[Elastic]>,
) -> Result<bool, (String, &'static str)> {
    if builder.is_moving() {
        let message = "a velocity is written for the pose in the file, and the mechanism is moved from there".to_string();
        return Err((
            message,
            "remove the velocities and give rates in [start], as `angle_rate`, or write the bodies where they are at the start",
        ));
    }
    let is_driven = builder.clone().build().is_driven();
    let mut led =
        Way::new(&stiffened(builder, elastic.unwrap_or_default()), targets, released, is_driven).ok_or_else(|| stuck(0.0, is_driven))?;
    let rolls = led.places.system().is_nonholonomic();
    let mut here = led.places.system().start_position().to_vec();
    // How far all nodes went, over the share, and how fast they go on: at a dead centre no velocity leads there.
    let mut way = vec![0.0; here.len()];
    let mut rate = None;
    // Where coordinates leave something free the place at the end follows from all of the way, and equal parts of it find the same one wherever the
    // model stands.
    let leaves_free = led.at(&here, 0.0).is_some() && leaves_free(&led.places);
    let is_free = !rolls && leaves_free;
    let longest = if is_free { FIRST_SHARE } else { 1.0 };
    let (mut share, mut step) = (0.0, FIRST_SHARE);
    for tries in 1.. {
        let next = f64::min(share + step, 1.0);
        let rate_here = &*rate.get_or_insert_with(|| led.rate(&here, share));
        let ahead = match rate_here {
            Some(rate) if rolls => led.follow(&here, rate, [share, next]),
            None if rolls => None,
            Some(rate) if is_free => led.step(&here, rate, [share, next]),
            _ => Some(along(&here, next - share, rate_here.as_ref().unwrap_or(&way))),
        };
        let there = ahead.and_then(|ahead| led.at(&ahead, next));
        match if elastic.is_some() { there } else { there.and_then(|_| led.settle()) } {
            Some(there) => {
                way = there.iter().zip(&here).map(|(there, here)| (there - here) / (next - share)).collect();
                here = there;
                (share, step, rate) = (next, f64::min(2.0 * step, longest), None);
                if share == 1.0 {
                    builder.move_to(&led.places.system().in_world(&here), led.places.angles());
                    break;
                }
            }
            None if step > LEAST_SHARE && tries < MOST_TRIES => step *= 0.5,
            None => return Err(stuck(share, is_driven)),
        }
    }
    Ok(leaves_free)
}

/// Whether nodes may move where the coordinates that lead stand still.
pub(super) fn leaves_free(places: &Places) -> bool {
    places.freedom() > 0
}

/// Says that the way ends at a share of it, and the cure.
fn stuck(share: f64, is_driven: bool) -> (String, &'static str) {
    let message = format!("the mechanism cannot be moved there: it gets {} % of the way", short(100.0 * share));
    let cure = match is_driven && share == 0.0 {
        true => {
            "take values that the joints can have together, and of coordinates that go together, as those of a screw or of wheels in mesh, the one that is driven"
        }
        false => "take values that the joints can have together; away from a dead centre a coordinate leads that moves there",
    };
    (message, cure)
}

/// A mechanism whose coordinates lead it, without the rows that are released.
pub(super) struct Way {
    places: Places,
    /// The rows that lead, and what they lead to.
    leads: Vec<(usize, f64)>,
    /// Whether something moves as time has it.
    is_driven: bool,
}

impl Way {
    /// From where a builder has its nodes. `None` where no matrix holds the rows.
    pub fn new(builder: &SystemBuilder, targets: &[Target], released: &[usize], is_driven: bool) -> Option<Self> {
        let mut builder = builder.clone();
        let placed = targets.iter().filter_map(|target| Some((target, target.value?)));
        let mut leads: Vec<(usize, f64)> =
            placed.map(|(target, value)| (target.row.unwrap_or_else(|| target.add_row(&mut builder)), value)).collect();
        leads.iter_mut().for_each(|(row, _)| *row -= released.iter().filter(|released| **released < *row).count());
        released.iter().rev().for_each(|&row| builder.remove_row(row));
        let mut way = Self { places: Places::new(builder.build()).ok()?, leads, is_driven };
        way.lead(0.0, 0.0);
        Some(way)
    }

    /// Has coordinates lead to a share of the way, where they go on by `going` of it in a second.
    fn lead(&mut self, share: f64, going: f64) {
        for &(row, value) in &self.leads {
            self.places.retarget(row, Arc::new(Rising([share * value, going * value])));
        }
    }

    /// How many rows follow from others where coordinates are at their values as written. `None` where these cannot be met.
    pub fn redundant_rows(&mut self) -> Option<usize> {
        let x = self.places.system().start_position().to_vec();
        self.at(&x, 0.0)?;
        Some(self.places.redundant_rows())
    }

    /// Puts the nodes near `x` and the coordinates at a share of the way, and hands back where they are then.
    fn at(&mut self, x: &[f64], share: f64) -> Option<Vec<f64>> {
        self.lead(share, 0.0);
        self.places.put(x).ok()?;
        // Drives must go on from there.
        if self.is_driven {
            self.places.velocities().ok()?;
        }
        Some(self.places.keep().to_vec())
    }

    /// Where the mechanism comes to rest near the place that it was put at last. `None` where that is nowhere.
    fn settle(&mut self) -> Option<Vec<f64>> {
        self.places.settle().ok()?;
        Some(self.places.keep().to_vec())
    }

    /// Where the nodes at `here`, with the velocities `first` there, are at the end of a part of the way between two shares of it: the motion with the
    /// least kinetic energy at each place. `None` where that leads nowhere, or the part is too long for it.
    fn follow(&mut self, here: &[f64], first: &[f64], shares: [f64; 2]) -> Option<Vec<f64>> {
        follow(here, first, shares, |x, share| self.rate(x, share))
    }

    /// The same by one step of the classical Runge-Kutta method, for ways whose places meet all constraints by themselves.
    fn step(&mut self, here: &[f64], first: &[f64], [from, to]: [f64; 2]) -> Option<Vec<f64>> {
        let (h, middle) = (to - from, 0.5 * (from + to));
        let second = self.rate(&along(here, 0.5 * h, first), middle)?;
        let third = self.rate(&along(here, 0.5 * h, &second), middle)?;
        let last = self.rate(&along(here, h, &third), to)?;
        let mean = |k: usize| (first[k] + 2.0 * (second[k] + third[k]) + last[k]) / 6.0;
        Some(here.iter().enumerate().map(|(k, x)| x + h * mean(k)).collect())
    }

    /// Velocities of all nodes over the share, with which constraints are met while the coordinates that lead go on and drives stand still.
    fn rate(&mut self, x: &[f64], share: f64) -> Option<Vec<f64>> {
        self.lead(share, 1.0);
        self.places.put(x).ok()?;
        let mut rate = self.places.velocities().ok()?.to_vec();
        if self.is_driven {
            self.lead(share, 0.0);
            rate.iter_mut().zip(self.places.velocities().ok()?).for_each(|(rate, of_drives)| *rate -= of_drives);
        }
        Some(rate)
    }
}
