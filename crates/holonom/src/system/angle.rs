//! Angles by their cosine and sine, counted over any number of turns.

use std::f64::consts::TAU;

use super::Derivatives;

/// θ with (c, s) = ρ (cos θ, sin θ), nearest to `near`, and its derivatives by c and s. Of `near` only the turns are in the
/// result, so that it is the same to the bit from wherever they are counted on.
pub(super) fn angle_at(c: f64, s: f64, near: f64) -> Derivatives {
    let (angle, square) = (s.atan2(c), c * c + s * s);
    let turns = ((near - angle) / TAU).round();
    let mut out = Derivatives { value: angle + turns * TAU, ..Derivatives::default() };
    out.gradient[..2].copy_from_slice(&[-s / square, c / square]);
    let (twist, bend) = (2.0 * c * s / (square * square), (s * s - c * c) / (square * square));
    out.hessian[0][..2].copy_from_slice(&[twist, bend]);
    out.hessian[1][..2].copy_from_slice(&[bend, -twist]);
    out
}

/// The discrete derivative κ (−s̄, c̄) of an angle, κ = Δθ/(c₀s₁ − s₀c₁) (methods §8), for turns below π.
pub(super) fn angle_between([[c0, s0], [c1, s1]]: [[f64; 2]; 2]) -> Derivatives {
    let (c, s) = (0.5 * (c0 + c1), 0.5 * (s0 + s1));
    let turn = (c0 * s1 - s0 * c1).atan2(c0 * c1 + s0 * s1);
    let end = c1 * c1 + s1 * s1;
    let radius = (end * (c0 * c0 + s0 * s0)).sqrt();
    // Δ/sin Δ and its derivative.
    let (ratio, slope) = match turn.abs() < 0.01 {
        true => {
            let t2 = turn * turn;
            (1.0 + t2 / 6.0 + 7.0 * t2 * t2 / 360.0, turn / 3.0 + 7.0 * turn * t2 / 90.0)
        }
        false => {
            let (sin, cos) = turn.sin_cos();
            (turn / sin, (sin - turn * cos) / (sin * sin))
        }
    };
    let kappa = ratio / radius;
    let by_c = (-slope * s1 - ratio * c1) / (radius * end);
    let by_s = (slope * c1 - ratio * s1) / (radius * end);
    let mut out = Derivatives::default();
    out.gradient[..2].copy_from_slice(&[-kappa * s, kappa * c]);
    out.hessian[0][..2].copy_from_slice(&[-s * by_c, -0.5 * kappa - s * by_s]);
    out.hessian[1][..2].copy_from_slice(&[0.5 * kappa + c * by_c, c * by_s]);
    out
}
