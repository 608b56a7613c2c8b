//! Inertia tensors: whether a body can have them, and their principal axes.

use std::cmp::Ordering;

/// Part of the largest entry by which a tensor may miss symmetry or the triangle inequality: what decimals in a file leave.
const TOLERANCE: f64 = 1e-9;

/// Most sweeps over the three entries beside the diagonal; some six are needed.
const SWEEPS: usize = 32;

/// Whether this inertia tensor, kg m², is symmetric and has no negative principal moment.
///
/// # Errors
/// In words, what is wrong with it.
pub fn check(inertia: [[f64; 3]; 3]) -> Result<(), String> {
    if inertia.as_flattened().iter().any(|entry| !entry.is_finite()) {
        return Err("an entry of the inertia is not a finite number".into());
    }
    let allowed = TOLERANCE * largest(inertia);
    for (i, j, names) in [(0, 1, ["Ixy", "Iyx"]), (0, 2, ["Ixz", "Izx"]), (1, 2, ["Iyz", "Izy"])] {
        if (inertia[i][j] - inertia[j][i]).abs() > allowed {
            let [first, second] = names;
            return Err(format!("the inertia is not symmetric: {first} = {}, but {second} = {}", inertia[i][j], inertia[j][i]));
        }
    }
    let (moments, which) = moments(inertia);
    match moments.iter().find(|&&moment| moment < -allowed) {
        Some(&moment) => Err(no_body(moments, which, &format!("{} is negative", short(moment)))),
        None => Ok(()),
    }
}

/// Whether no principal moment, kg m², exceeds the sum of the others, as none of a body does.
///
/// # Errors
/// In words, which one does.
pub fn check_sums(inertia: [[f64; 3]; 3]) -> Result<(), String> {
    let (moments, which) = moments(inertia);
    for (k, i, j) in [(0, 1, 2), (1, 0, 2), (2, 0, 1)] {
        // Differences, as a sum could overflow.
        let excess = moments[k] - moments[i] - moments[j];
        if excess > TOLERANCE * largest(inertia) {
            let [k, i, j] = [k, i, j].map(|k| short(moments[k]));
            return Err(no_body(moments, which, &format!("{k} exceeds {i} + {j} by {}", short(excess))));
        }
    }
    Ok(())
}

fn no_body(moments: [f64; 3], which: &str, why: &str) -> String {
    format!("the {which} {} cannot belong to a body: {why}", moments.map(short).join(", "))
}

/// Principal moments, in the order of the diagonal where that has them, and what they are called then.
fn moments(inertia: [[f64; 3]; 3]) -> ([f64; 3], &'static str) {
    match inertia[0][1] == 0.0 && inertia[0][2] == 0.0 && inertia[1][2] == 0.0 {
        true => ([inertia[0][0], inertia[1][1], inertia[2][2]], "moments"),
        false => (principal(inertia).0, "principal moments"),
    }
}

/// Principal moments, kg m², in ascending order, and the unit vectors of their axes (3 × 3: axis, component), right-handed.
///
/// Cyclic Jacobi rotations (Golub and Van Loan 2013, §8.5), which find small moments beside large
/// ones. The upper triangle is read. A diagonal tensor keeps its moments to the bit.
pub fn principal(inertia: [[f64; 3]; 3]) -> ([f64; 3], [[f64; 3]; 3]) {
    let scale = largest(inertia);
    if scale == 0.0 || !scale.is_finite() {
        return ([inertia[0][0], inertia[1][1], inertia[2][2]], IDENTITY);
    }
    // By a power of two, which leaves every digit as it is.
    let unit = 2.0_f64.powi((scale.log2().floor() as i32).clamp(-1000, 1000));
    let mut a = inertia.map(|row| row.map(|entry| entry / unit));
    let mut axes = IDENTITY;
    for _ in 0..SWEEPS {
        if a[0][1] == 0.0 && a[0][2] == 0.0 && a[1][2] == 0.0 {
            break;
        }
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            rotate(&mut a, &mut axes, p, q);
        }
    }
    sorted([a[0][0], a[1][1], a[2][2]].map(|moment| moment * unit), axes)
}

const IDENTITY: [[f64; 3]; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

/// Turns axes p < q so that their entry a_pq of the upper triangle vanishes.
fn rotate(a: &mut [[f64; 3]; 3], axes: &mut [[f64; 3]; 3], p: usize, q: usize) {
    // What rounding leaves of nothing between equal moments would be turned forever.
    if a[p][q].abs() <= f64::EPSILON * (a[p][p].abs() * a[q][q].abs()).sqrt() {
        a[p][q] = 0.0;
        return;
    }
    let cotangent = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
    // The smaller root of t² + 2 t cot 2φ − 1 = 0; a quotient that overflows gives t = 0.
    let tangent = 1.0_f64.copysign(cotangent) / (cotangent.abs() + cotangent.hypot(1.0));
    let cosine = 1.0 / tangent.hypot(1.0);
    let sine = tangent * cosine;
    a[p][p] -= tangent * a[p][q];
    a[q][q] += tangent * a[p][q];
    a[p][q] = 0.0;
    let r = 3 - p - q;
    let (rp, rq) = ((r.min(p), r.max(p)), (r.min(q), r.max(q)));
    let (along_p, along_q) = (a[rp.0][rp.1], a[rq.0][rq.1]);
    a[rp.0][rp.1] = cosine * along_p - sine * along_q;
    a[rq.0][rq.1] = sine * along_p + cosine * along_q;
    for i in 0..3 {
        let (along_p, along_q) = (axes[p][i], axes[q][i]);
        axes[p][i] = cosine * along_p - sine * along_q;
        axes[q][i] = sine * along_p + cosine * along_q;
    }
}

/// Moments in ascending order with their axes, each towards its largest component, the last so that they are right-handed.
fn sorted(moments: [f64; 3], axes: [[f64; 3]; 3]) -> ([f64; 3], [[f64; 3]; 3]) {
    let mut order = [0, 1, 2];
    order.sort_by(|&i, &j| moments[i].partial_cmp(&moments[j]).unwrap_or(Ordering::Equal));
    let [x, y, z] = order.map(|k| axes[k]);
    let (x, y) = (forwards(x), forwards(y));
    let cross = [x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2], x[0] * y[1] - x[1] * y[0]];
    let along = cross[0] * z[0] + cross[1] * z[1] + cross[2] * z[2];
    (order.map(|k| moments[k]), [x, y, if along < 0.0 { z.map(|c| -c) } else { z }])
}

fn forwards(axis: [f64; 3]) -> [f64; 3] {
    let main = axis.into_iter().fold(0.0_f64, |main, c| if c.abs() > main.abs() { c } else { main });
    if main < 0.0 { axis.map(|c| -c) } else { axis }
}

fn largest(inertia: [[f64; 3]; 3]) -> f64 {
    inertia.as_flattened().iter().fold(0.0, |largest, entry| entry.abs().max(largest))
}

/// A number for people, with six digits.
pub(in crate::model) fn short(number: f64) -> String {
    let rounded = format!("{number:.5e}").parse().unwrap_or(number);
    if rounded == 0.0 || (1e-4..1e7).contains(&f64::abs(rounded)) { format!("{}", rounded + 0.0) } else { format!("{rounded:e}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    const fn diagonal(moments: [f64; 3]) -> [[f64; 3]; 3] {
        [[moments[0], 0.0, 0.0], [0.0, moments[1], 0.0], [0.0, 0.0, moments[2]]]
    }

    /// R diag(m) Rᵀ with the rotation about an axis by an angle (Rodrigues).
    fn turned(moments: [f64; 3], axis: [f64; 3], angle: f64) -> ([[f64; 3]; 3], [[f64; 3]; 3]) {
        let length = axis.iter().map(|c| c * c).sum::<f64>().sqrt();
        let u = axis.map(|c| c / length);
        let (sine, cosine) = angle.sin_cos();
        let skew = [[0.0, -u[2], u[1]], [u[2], 0.0, -u[0]], [-u[1], u[0], 0.0]];
        let rotation: [[f64; 3]; 3] =
            std::array::from_fn(|i| std::array::from_fn(|j| cosine * IDENTITY[i][j] + sine * skew[i][j] + (1.0 - cosine) * u[i] * u[j]));
        let tensor =
            std::array::from_fn(|i| std::array::from_fn(|j| (0..3).map(|k| rotation[i][k] * moments[k] * rotation[j][k]).sum::<f64>()));
        (tensor, rotation)
    }

    fn determinant(m: [[f64; 3]; 3]) -> f64 {
        (0..3).map(|k| m[0][k] * (m[1][(k + 1) % 3] * m[2][(k + 2) % 3] - m[1][(k + 2) % 3] * m[2][(k + 1) % 3])).sum()
    }

    fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
        a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
    }

    #[test]
    fn principal_moments_and_axes_of_a_turned_tensor_come_back() {
        for moments in
            [[1.0, 2.0, 2.5], [1e-9, 1.0, 1.0], [3.0, 3.0, 3.0], [0.0, 7.0, 7.0], [1e300, 2e300, 2.5e300], [1e-300, 2e-300, 2.5e-300]]
        {
            for angle in [0.0, 1e-9, 0.3, 1.0, 2.0, 3.1] {
                let (tensor, rotation) = turned(moments, [1.0, -2.0, 0.5], angle);
                let (found, axes) = principal(tensor);
                for k in 0..3 {
                    assert!((found[k] - moments[k]).abs() <= 4e-15 * moments[2], "{found:?} for {moments:?}");
                    assert!((dot(axes[k], axes[k]) - 1.0).abs() < 4e-15);
                    for i in 0..3 {
                        let residual = dot(tensor[i], axes[k]) - found[k] * axes[k][i];
                        assert!(residual.abs() <= 4e-15 * moments[2], "axis {k} of {moments:?}");
                    }
                }
                assert!((determinant(axes) - 1.0).abs() < 8e-15, "right-handed");
                if moments == [1.0, 2.0, 2.5] {
                    let column = [rotation[0][0], rotation[1][0], rotation[2][0]];
                    assert!((dot(axes[0], column).abs() - 1.0).abs() < 1e-14);
                }
            }
        }
    }

    #[test]
    fn a_diagonal_tensor_keeps_its_moments_and_gets_axes_in_their_order() {
        let (moments, axes) = principal(diagonal([0.3, 0.1, 0.2]));
        assert_eq!(moments, [0.1, 0.2, 0.3]);
        assert_eq!(axes, [[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]]);
        assert_eq!(principal(diagonal([0.0; 3])), ([0.0; 3], IDENTITY));
    }

    #[test]
    fn a_known_tensor_has_its_known_eigenvalues() {
        // 2 − √2, 2, 2 + √2: the second difference on three points.
        let (moments, _) = principal([[2.0, -1.0, 0.0], [-1.0, 2.0, -1.0], [0.0, -1.0, 2.0]]);
        for (found, expected) in moments.into_iter().zip([2.0 - 2.0_f64.sqrt(), 2.0, 2.0 + 2.0_f64.sqrt()]) {
            assert!((found - expected).abs() < 1e-15, "{found}");
        }
    }

    #[test]
    fn sound_tensors_pass() {
        let check = |inertia| check(inertia).and_then(|()| check_sums(inertia));
        for moments in [[1.0, 2.0, 3.0], [0.0, 1.0, 1.0], [0.0; 3], [1.0, 1.0, 2.0 + 1e-10], [1e300, 1e300, 1e300]] {
            assert_eq!(check(diagonal(moments)), Ok(()));
            assert_eq!(check(turned(moments, [1.0, 2.0, 3.0], 0.7).0), Ok(()));
        }
    }

    #[test]
    fn what_no_body_has_is_told() {
        let told = |inertia| check(inertia).and_then(|()| check_sums(inertia)).unwrap_err();
        assert_eq!(told(diagonal([1.0, 3.5, 2.0])), "the moments 1, 3.5, 2 cannot belong to a body: 3.5 exceeds 1 + 2 by 0.5");
        assert_eq!(told(diagonal([1.0, -0.5, 2.0])), "the moments 1, -0.5, 2 cannot belong to a body: -0.5 is negative");
        assert_eq!(
            told(turned([1.0, 2.0, 3.1], [1.0, 1.0, 0.0], 0.4).0),
            "the principal moments 1, 2, 3.1 cannot belong to a body: 3.1 exceeds 1 + 2 by 0.1"
        );
        assert_eq!(told(diagonal([1.0, 1.0, 2.0 + 1e-8])), "the moments 1, 1, 2 cannot belong to a body: 2 exceeds 1 + 1 by 1e-8");
        let mut skew = diagonal([2.0, 2.0, 2.0]);
        skew[0][1] = 0.1;
        assert_eq!(told(skew), "the inertia is not symmetric: Ixy = 0.1, but Iyx = 0");
        assert_eq!(told(diagonal([1.0, f64::NAN, 1.0])), "an entry of the inertia is not a finite number");
    }

    #[test]
    fn numbers_are_shown_with_six_digits() {
        assert_eq!([0.1_f32 as f64, -0.0, 1e-9, 2.5e12, -3.0].map(short), ["0.1", "0", "1e-9", "2.5e12", "-3"]);
    }
}
