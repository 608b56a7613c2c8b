//! The slowest small vibrations of a mechanism of many freedoms (methods §21).

use super::exponents::{Found, SLOWER, look, look_again, look_twice};
use super::modes::{Mode, Modes, NoModes};
use crate::simulation::{Motions, Places, Rest, Slow};
use crate::system::System;

/// Motions of a space that shows how slow the slowest is; of one that has the slowest ones at first, and at most; the share by which that grows as long as
/// it has fewer than so many exponents that the last growth has not changed.
const FEW: usize = 40;
const FIRST: usize = 120;
const MOST: usize = 300;
const GROWTH: f64 = 0.25;
const ENOUGH: usize = 80;

/// By what share the speed of a motion may change with that.
const SAME: f64 = 1e-7;

/// A step over the time of the slowest motion. Over one that shows nothing, or cannot be solved, the next, and how many are tried.
const LENGTH: f64 = 1.2;
const LONGER: f64 = 100.0;
const SHORTER: f64 = 0.1;
const TRIES: usize = 12;

/// The speed of a motion in a step of the length 1 that this shows to many digits; how many lengths show motions that are ever faster, and what share of the
/// speed of one is below that.
const FAR: f64 = 1e3;
const WINDOWS: usize = 4;
const BELOW: f64 = 0.999;

/// A mechanism at rest, with motions without order of which spaces of slow ones come, and how many freedoms it has.
struct Search<'a> {
    places: &'a mut Places,
    rest: &'a Rest,
    starts: &'a Motions,
    freedom: usize,
}

/// Finds the slowest modes of a mechanism at rest; `none` has none of them, and all freedoms as free. They come of the starts, motions without order.
pub(super) fn slowest(system: &System, places: &mut Places, rest: &Rest, starts: &Motions, none: Modes) -> Result<Modes, NoModes> {
    let freedom = none.free / 2;
    let mut search = Search { places, rest, starts, freedom };
    let Some(slowest) = search.slowest_speed()? else { return Err(NoModes::Large(freedom)) };
    let (mut h, mut least) = (LENGTH / slowest, SLOWER * slowest);
    let (mut modes, mut told) = (Modes { free: 0, ..none }, 0);
    for window in 0..WINDOWS {
        let (found, motions) = search.converged(h, least)?;
        let (slower, others) = found.split_at(found.partition_point(|found| found.speed() < least));
        if window == 0 {
            (modes.free, modes.within) = (slower.len(), slower.last().map_or(0.0, Found::speed));
        }
        let (here, faster) = others.split_at(others.partition_point(|found| found.speed() * h < FAR));
        let sure = here.iter().take_while(|found| found.is_sure).count();
        told += sure;
        modes.modes.extend(here[..sure].iter().filter_map(|found| Mode::of(system, &motions.basis, found)));
        // Where others are much faster, a step of their own shows them.
        match faster.first() {
            Some(next) if told < ENOUGH && sure == here.len() => (h, least) = (LENGTH / next.speed(), BELOW * next.speed()),
            _ => break,
        }
    }
    if modes.modes.is_empty() {
        return Err(NoModes::Large(freedom));
    }
    modes.faster = (2 * freedom).saturating_sub(modes.free + told);
    Ok(modes.numbered())
}

impl Search<'_> {
    /// Exponents from the slowest on that a larger space of motions does not change, but for those below `least`, with these motions.
    fn converged(&mut self, h: f64, least: f64) -> Result<(Vec<Found>, Motions), NoModes> {
        let is_same = |(a, b): &(&f64, &f64)| (**a < least && **b < least) || (*a - *b).abs() <= SAME * **b;
        let (mut slow, mut before) = (Slow::default(), Vec::new());
        let mut more = FIRST;
        let (same, exponents) = loop {
            let had = slow.motions.basis.len();
            self.add_motions(&mut slow, more, h)?;
            let has = slow.motions.basis.len();
            let exponents = look(self.places, &self.rest.spots[0], &slow.motions, h)?;
            let mut speeds: Vec<f64> = exponents.iter().map(|([re, im], _)| re.hypot(*im)).collect();
            speeds.sort_by(f64::total_cmp);
            let same = before.iter().zip(&speeds).take_while(is_same).count();
            let zero = speeds.partition_point(|speed| *speed < least);
            if has == had || has >= MOST || same >= zero + ENOUGH {
                break (same, exponents);
            }
            (before, more) = (speeds, (GROWTH * has as f64) as usize);
        };
        let mut found = look_again(self.places, self.rest, &slow.motions, h, exponents)?;
        found.sort_by(|a, b| a.speed().total_cmp(&b.speed()));
        found.truncate(same);
        Ok((found, slow.motions))
    }

    /// The speed of the slowest motion, 1/s; `None` where it cannot be told from the others.
    fn slowest_speed(&mut self) -> Result<Option<f64>, NoModes> {
        let (mut h, mut slowest) = (self.rest.long_step(), None);
        for _ in 0..TRIES {
            h = match (self.slowest_with(h), slowest) {
                // Forces of redundant rows may be too much for what a long step can be told from.
                (Err(NoModes::Singular), None) => SHORTER * h,
                (Ok(None), None) => LONGER * h,
                // A longer step may show what is slower.
                (Ok(Some(speed)), last) if speed < BELOW * last.unwrap_or(f64::INFINITY) => {
                    slowest = Some(speed);
                    LONGER / speed
                }
                (Ok(_) | Err(NoModes::Singular), _) => break,
                (Err(reason), _) => return Err(reason),
            };
        }
        Ok(slowest)
    }

    /// The speed of the slowest motion that few motions with a step of length h show, 1/s.
    fn slowest_with(&mut self, h: f64) -> Result<Option<f64>, NoModes> {
        let mut slow = Slow::default();
        self.add_motions(&mut slow, FEW, h)?;
        let found = look_twice(self.places, self.rest, &slow.motions, h)?;
        Ok(found.iter().filter(|found| found.is_sure).map(Found::speed).min_by(f64::total_cmp))
    }

    /// Adds up to so many motions to a space, until all are in it.
    fn add_motions(&mut self, slow: &mut Slow, more: usize, h: f64) -> Result<(), NoModes> {
        let most = self.freedom.min(slow.motions.basis.len() + more);
        Ok(self.places.slow_motions(slow, self.starts, most, &self.rest.spots[0], h)?)
    }
}
