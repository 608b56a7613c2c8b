//! Distances between two points that count from the start.

use std::sync::Arc;

use super::assembly::CONTRADICTION;
use super::ends::{End, difference};
use super::entry::Entry;
use super::fault::Read;
use super::geometry::norm;
use crate::system::{Shifted, Signal};

/// How far two ends are apart at the start, m: not zero.
pub(super) fn apart_at_start(entry: &Entry<'_>, [a, b]: &[End; 2]) -> Read<f64> {
    let start = norm(difference(a, b));
    if start > 0.0 {
        return Ok(start);
    }
    let message = format!("`{}` and `{}` start at the same place, and a distance of zero has no direction", a.name, b.name);
    Err(entry.refuse(
        "between",
        message,
        "let them start apart; what keeps two points together is a constraint of type = \"fixed\" with between",
    ))
}

/// The distance over time whose difference from that of the start is `stroke`. That begins at zero but for rounding, seen against the length
/// of the start; `itself` is the key that gives the distance instead.
pub(super) fn from_start(entry: &Entry<'_>, ends: &[End; 2], stroke: Arc<dyn Signal>, itself: &str) -> Read<Arc<dyn Signal>> {
    let (start, begins) = (apart_at_start(entry, ends)?, stroke.at(0.0)[0]);
    if begins.abs() <= CONTRADICTION * start {
        return Ok(Arc::new(Shifted(stroke, start)));
    }
    let cure = format!("a stroke counts from the start: subtract its value at t = 0, or give the distance itself as `{itself}`");
    Err(entry.refuse("stroke", format!("the stroke is {begins} m at t = 0"), cure))
}
