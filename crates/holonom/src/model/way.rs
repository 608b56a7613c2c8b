//! The way of a mechanism to the coordinates at which it starts. With constraints of velocities the places at its end follow from all of it, as
//! wheels roll along it.

use super::start::{Target, lead, start};
use crate::simulation::Simulation;
use crate::system::SystemBuilder;

/// Ways of the modified midpoint rule that are extrapolated, of 2, 4, … steps.
const MOST_WAYS: usize = 10;

/// Share of the size of all coordinates to which the places are found.
const FOUND: f64 = 1e-13;

/// A mechanism whose coordinates lead it, without the rows that are released.
pub(super) struct Way<'a> {
    pub builder: &'a SystemBuilder,
    pub targets: &'a [Target],
    pub released: &'a [usize],
    /// Angles of the equations and of what is measured at the start of the way, rad.
    pub turned: [&'a [f64]; 2],
    /// Whether something moves as time has it.
    pub is_driven: bool,
}

/// Places `by` farther on at a rate.
pub(super) fn along(x: &[f64], by: f64, rate: &[f64]) -> Vec<f64> {
    x.iter().zip(rate).map(|(x, rate)| x + by * rate).collect()
}

impl Way<'_> {
    /// The mechanism with its nodes near `x` and its coordinates at a share of the way, going on by so much of it in a second.
    pub fn at(&self, x: &[f64], share: f64, going: f64) -> Option<Simulation> {
        let mut builder = self.builder.clone();
        lead(&mut builder, self.targets, share, going);
        // Also those that lead are counted from where they were.
        builder.move_to(x, self.turned);
        self.released.iter().rev().for_each(|&row| builder.remove_row(row));
        start(builder)
    }

    /// Where the nodes at `here`, with the velocities `first` there, are at the end of a part of the way between two shares of it: the motion with the
    /// least kinetic energy at each place is followed by extrapolation (Bulirsch and Stoer). `None` where that leads nowhere, or the part is too long
    /// for it.
    pub fn follow(&self, here: &[f64], first: &[f64], shares: [f64; 2]) -> Option<Vec<f64>> {
        let size = here.iter().fold(0.0, |size: f64, x| size.max(x.abs()));
        let mut table: Vec<Vec<f64>> = Vec::new();
        for k in 0..MOST_WAYS {
            let mut next = self.midpoint(here, first, shares, 2 * (k + 1))?;
            let mut off = f64::INFINITY;
            for (j, before) in table.iter_mut().enumerate() {
                let ratio = ((k + 1) as f64 / (k - j) as f64).powi(2);
                off = next.iter().zip(&*before).fold(0.0, |most, (x, before)| f64::max(most, (x - before).abs() / (ratio - 1.0)));
                let better: Vec<f64> = next.iter().zip(&*before).map(|(x, before)| x + (x - before) / (ratio - 1.0)).collect();
                *before = std::mem::replace(&mut next, better);
            }
            if off <= FOUND * size {
                return Some(next);
            }
            table.push(next);
        }
        None
    }

    /// The same by one step of the classical Runge-Kutta method, for ways whose places meet all constraints by themselves.
    pub fn step(&self, here: &[f64], first: &[f64], [from, to]: [f64; 2]) -> Option<Vec<f64>> {
        let (h, middle) = (to - from, 0.5 * (from + to));
        let second = self.rate(&along(here, 0.5 * h, first), middle)?;
        let third = self.rate(&along(here, 0.5 * h, &second), middle)?;
        let last = self.rate(&along(here, h, &third), to)?;
        let mean = |k: usize| (first[k] + 2.0 * (second[k] + third[k]) + last[k]) / 6.0;
        Some(here.iter().enumerate().map(|(k, x)| x + h * mean(k)).collect())
    }

    /// Places at the end of so many steps of the modified midpoint rule.
    fn midpoint(&self, here: &[f64], first: &[f64], [from, to]: [f64; 2], steps: usize) -> Option<Vec<f64>> {
        let h = (to - from) / steps as f64;
        let [mut before, mut x] = [here.to_vec(), along(here, h, first)];
        for k in 1..steps {
            let rate = self.rate(&x, from + k as f64 * h)?;
            let next = along(&before, 2.0 * h, &rate);
            (before, x) = (x, next);
        }
        let last = along(&before, h, &self.rate(&x, to)?);
        Some(x.iter().zip(&last).map(|(x, last)| 0.5 * (x + last)).collect())
    }

    /// Velocities of all nodes over the share, with which constraints are met while the coordinates that lead go on and drives stand still.
    pub fn rate(&self, x: &[f64], share: f64) -> Option<Vec<f64>> {
        let velocity = |going: f64| Some(self.at(x, share, going)?.state().v.clone());
        let mut rate = velocity(1.0)?;
        if self.is_driven {
            rate.iter_mut().zip(velocity(0.0)?).for_each(|(rate, of_drives)| *rate -= of_drives);
        }
        Some(rate)
    }
}
