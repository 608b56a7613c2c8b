//! Where velocities lead that follow from places, to rounding: wheels roll along all of the way.

/// Ways of the modified midpoint rule that are extrapolated, of 2, 4, … steps.
const MOST_WAYS: usize = 10;

/// Share of the size of all coordinates to which the places are found.
const FOUND: f64 = 1e-13;

/// Where `here` is at the end of a part of a way between two shares of it, by extrapolation (Bulirsch and Stoer): it goes on by `rate` of the place and
/// the share, at the begin by `first`. `None` where that leads nowhere, or the part is too long for it.
pub(crate) fn follow(
    here: &[f64],
    first: &[f64],
    shares: [f64; 2],
    mut rate: impl FnMut(&[f64], f64) -> Option<Vec<f64>>,
) -> Option<Vec<f64>> {
    let size = here.iter().fold(0.0, |size: f64, x| size.max(x.abs()));
    let mut table: Vec<Vec<f64>> = Vec::new();
    for k in 0..MOST_WAYS {
        let mut next = midpoint(here, first, shares, 2 * (k + 1), &mut rate)?;
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

/// Places at the end of so many steps of the modified midpoint rule.
fn midpoint(
    here: &[f64],
    first: &[f64],
    [from, to]: [f64; 2],
    steps: usize,
    rate: &mut impl FnMut(&[f64], f64) -> Option<Vec<f64>>,
) -> Option<Vec<f64>> {
    let h = (to - from) / steps as f64;
    let [mut before, mut x] = [here.to_vec(), along(here, h, first)];
    for k in 1..steps {
        let next = along(&before, 2.0 * h, &rate(&x, from + k as f64 * h)?);
        (before, x) = (x, next);
    }
    let last = along(&before, h, &rate(&x, to)?);
    Some(x.iter().zip(&last).map(|(x, last)| 0.5 * (x + last)).collect())
}

/// Places `by` farther on at a rate.
pub(crate) fn along(x: &[f64], by: f64, rate: &[f64]) -> Vec<f64> {
    x.iter().zip(rate).map(|(x, rate)| x + by * rate).collect()
}
