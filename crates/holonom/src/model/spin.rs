//! How a body turns, by the directions that its axes are.
//!
//! Between two positions these are means of those there: shorter than one, and no longer across each other. What is found here is exact there, too:
//! the ω with ω × e_k = ė_k of all axes, so that a torque n on them has the power n·ω.

use smallvec::SmallVec;

use super::sum::{Sum, cross};
use crate::system::Number as AnyNumber;

/// Where the axes of a body are; in the plane the first.
type Axes<N> = SmallVec<[[N; 3]; 3]>;

fn dot<N: AnyNumber>(u: [N; 3], w: [N; 3]) -> N {
    u[0] * w[0] + u[1] * w[1] + u[2] * w[2]
}

/// The c whose c × e_k on the axes e_k have the torque n: Σ (|e_k|² 1 − e_k e_kᵀ) c = n. That is n/2 for axes of length 1 across each other.
pub(super) fn turning<N: AnyNumber>(torque: [N; 3], axes: &[[N; 3]], dim: usize) -> [N; 3] {
    let zero = N::from(0.0);
    let mut m = [[zero; 3]; 3];
    for e in axes {
        for i in 0..3 {
            m[i][i] += e[0] * e[0] + e[1] * e[1] + e[2] * e[2];
            (0..3).for_each(|j| m[i][j] -= e[i] * e[j]);
        }
    }
    if dim == 2 {
        return [zero, zero, torque[2] / m[2][2]];
    }
    let columns: [[N; 3]; 3] = std::array::from_fn(|k| cross(m[(k + 1) % 3], m[(k + 2) % 3]));
    let determinant = m[0][0] * columns[0][0] + m[0][1] * columns[0][1] + m[0][2] * columns[0][2];
    std::array::from_fn(|c| (columns[0][c] * torque[0] + columns[1][c] * torque[1] + columns[2][c] * torque[2]) / determinant)
}

/// The angular velocity of a body with these axes.
pub(super) fn angular_velocity<N: AnyNumber>(axes: &[Sum], x: &[N], v: &[N], dim: usize) -> [N; 3] {
    let at: Axes<N> = axes.iter().map(|sum| sum.at(x, dim, 1.0)).collect();
    let mut turned = [N::from(0.0); 3];
    for (sum, e) in axes.iter().zip(&at) {
        let own = cross(*e, sum.at(v, dim, 0.0));
        (0..3).for_each(|c| turned[c] += own[c]);
    }
    turning(turned, &at, dim)
}

/// Adds to `by_x` and `by_v` what a function changes by with the coordinates `x` and the velocities `v`, whose slopes by the angular velocity these are.
pub(super) fn spread<N: AnyNumber>(axes: &[Sum], slopes: [N; 3], [x, v]: [&[N]; 2], dim: usize, [by_x, by_v]: [&mut [N]; 2]) {
    let at: Axes<N> = axes.iter().map(|sum| sum.at(x, dim, 1.0)).collect();
    let (omega, y) = (angular_velocity(axes, x, v, dim), turning(slopes, &at, dim));
    for (sum, &e) in axes.iter().zip(&at) {
        let rise = cross(sum.at(v, dim, 0.0), y);
        let (along, of_axis, of_slope) = (dot(y, omega) * 2.0, dot(e, omega), dot(y, e));
        let own = std::array::from_fn(|c| rise[c] - along * e[c] + of_axis * y[c] + of_slope * omega[c]);
        sum.spread(own, dim, by_x);
        sum.spread(cross(y, e), dim, by_v);
    }
}
