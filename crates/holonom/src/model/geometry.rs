//! Vectors of three numbers, of which a planar model uses two.

/// Three numbers.
pub type Vec3 = [f64; 3];

/// u + w
pub fn add(u: Vec3, w: Vec3) -> Vec3 {
    std::array::from_fn(|c| u[c] + w[c])
}

/// u − w
pub fn subtract(u: Vec3, w: Vec3) -> Vec3 {
    std::array::from_fn(|c| u[c] - w[c])
}

/// f u
pub fn scale(u: Vec3, f: f64) -> Vec3 {
    u.map(|c| f * c)
}

/// u · w
pub fn dot(u: Vec3, w: Vec3) -> f64 {
    u[0] * w[0] + u[1] * w[1] + u[2] * w[2]
}

/// Squares whose sum is beyond these have lost digits, or are infinite.
const SQUARES: std::ops::Range<f64> = 1e-280..f64::MAX;

/// Length of a vector, also where squares of its components are no numbers.
pub fn norm(u: Vec3) -> f64 {
    let square = dot(u, u);
    let largest = u.iter().fold(0.0, |largest: f64, c| largest.max(c.abs()));
    if SQUARES.contains(&square) || largest == 0.0 || !largest.is_finite() {
        return square.sqrt();
    }
    // By a power of two nothing is rounded.
    let size = 2.0_f64.powi(largest.log2() as i32);
    let part = u.map(|c| c / size);
    size * dot(part, part).sqrt()
}

/// u × w
pub fn cross(u: Vec3, w: Vec3) -> Vec3 {
    [u[1] * w[2] - u[2] * w[1], u[2] * w[0] - u[0] * w[2], u[0] * w[1] - u[1] * w[0]]
}

/// The k-th unit vector.
pub fn unit(k: usize) -> Vec3 {
    std::array::from_fn(|c| f64::from(u8::from(c == k)))
}

/// What components of a unit vector may differ by that were turned.
const ROUNDED: f64 = 1e-9;

/// Unit vectors at right angles to a unit vector and to each other: two in space, one in the plane. With u they are
/// right-handed.
pub fn across(u: Vec3, dim: usize) -> Vec<Vec3> {
    if dim == 2 {
        return vec![[-u[1], u[0], 0.0]];
    }
    let smallest = u.iter().fold(f64::INFINITY, |m, u| m.min(u.abs()));
    // The first of those that are alike but for rounding.
    let least = (0..3).find(|&k| u[k].abs() <= smallest + ROUNDED).unwrap_or(0);
    let first = cross(u, unit(least));
    let first = scale(first, 1.0 / norm(first));
    vec![first, cross(u, first)]
}

/// What is left of a vector without its parts along others.
pub fn rest(along: &[Vec3], u: Vec3) -> Vec3 {
    let mut orthogonal: Vec<Vec3> = Vec::new();
    let without = |orthogonal: &[Vec3], mut u: Vec3| {
        // Twice, as once leaves what rounding has brought in.
        for _ in 0..2 {
            for &e in orthogonal {
                u = subtract(u, scale(e, dot(e, u)));
            }
        }
        u
    };
    for &w in along {
        let left = without(&orthogonal, w);
        let size = norm(left);
        if size > 1e-12 * norm(w) {
            orthogonal.push(scale(left, 1.0 / size));
        }
    }
    without(&orthogonal, u)
}

/// w turned by the smallest rotation that takes the unit vector `from` to the unit vector `to`.
pub fn carried(w: Vec3, from: Vec3, to: Vec3) -> Vec3 {
    let (axis, cos) = (cross(from, to), dot(from, to));
    if cos <= -1.0 + 1e-12 {
        // Half a turn about anything at right angles.
        let e = across(from, 3)[0];
        return subtract(scale(e, 2.0 * dot(e, w)), w);
    }
    let turned = add(scale(w, cos), cross(axis, w));
    add(turned, scale(axis, dot(axis, w) / (1.0 + cos)))
}
