//! Distances that are driven, where a mechanism begins elsewhere than it is written.

use std::sync::Arc;

use super::assembly::{CONTRADICTION, Effort};
use super::bodies::short;
use super::start::Target;
use super::way::Way;
use crate::system::{Constant, HalfSquare, Shifted, Signal, SystemBuilder};

/// A distance that is driven, of half the square of which a row is one.
pub struct DrivenLength {
    /// Of the drive.
    pub row: usize,
    /// Number of its effort, which has its name, and the distance over time.
    pub effort: usize,
    /// By how much the distance differs from that at the start; `None` where the distance itself is given.
    pub stroke: Option<Arc<dyn Signal>>,
}

/// The rows of driven distances that would hold the coordinates where they are: without one of these fewer rows are redundant beside those that
/// lead. They get as long as it takes.
pub(super) fn released(builder: &SystemBuilder, targets: &[Target], lengths: &[DrivenLength], efforts: &[Effort]) -> Vec<usize> {
    let mut held = builder.clone();
    for (length, there) in lengths.iter().zip(distances(builder, lengths, efforts)) {
        held.retarget(length.row, Arc::new(HalfSquare(Arc::new(Constant(there)))));
    }
    // Their drives wait for them where they are put.
    targets.iter().filter_map(|target| target.row).for_each(|row| held.retarget(row, Arc::new(Constant(0.0))));
    // How many more rows are redundant where coordinates are led.
    let more = |without: Option<usize>| {
        let without = without.as_slice();
        let count = |targets: &[Target]| Way::new(&held, targets, without, true)?.redundant_rows();
        Some(count(targets)?.saturating_sub(count(&[])?))
    };
    let most = if lengths.is_empty() { None } else { more(None) };
    let holds = |row: &usize| matches!((more(Some(*row)), most), (Some(fewer), Some(most)) if fewer < most);
    lengths.iter().map(|length| length.row).filter(holds).collect()
}

/// Refuses distances that are given and not released, where their ends are others.
pub(super) fn require_held(
    builder: &SystemBuilder,
    lengths: &[DrivenLength],
    efforts: &[Effort],
    released: &[usize],
) -> Result<(), (String, &'static str)> {
    let distances = distances(builder, lengths, efforts);
    let mut held = lengths.iter().zip(distances).filter(|(length, _)| !released.contains(&length.row));
    held.try_for_each(|(length, there)| length.require(&efforts[length.effort], there))
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
pub(super) fn extend(builder: &mut SystemBuilder, lengths: &[DrivenLength], efforts: &mut [Effort]) -> Result<(), (String, &'static str)> {
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
