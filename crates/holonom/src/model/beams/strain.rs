//! How an element of a beam is deformed, as functions of dot products of the frames at its ends (methods §22).

use crate::system::{Derivatives, Smooth};

/// Cosine of the rotation from one end of an element to the other beyond which no step goes: rotations are known up to half a turn.
const LARGEST: f64 = -0.98;

/// What happens there.
const HALF_A_TURN: &str = "the ends of an element turn against each other by half a turn; take more elements";

/// Size of (1 − c)/2 below which φ/sin φ is summed up.
const NEAR: f64 = 0.05;

/// φ/sin φ with its first two derivatives by c = cos φ, which is above 1 where the axes of an iteration are longer than they should be.
fn over_sine(c: f64) -> [f64; 3] {
    if c < LARGEST {
        // Iterations may come here, and steps do not end here: a parabola goes on.
        let ([value, slope, bend], by) = (over_sine(LARGEST), c - LARGEST);
        return [value + by * (slope + 0.5 * by * bend), slope + by * bend, bend];
    }
    let y = 0.5 * (1.0 - c);
    if y.abs() >= NEAR {
        let square = 1.0 - c * c;
        let value = if y > 0.0 { c.acos() } else { c.acosh() } / square.abs().sqrt();
        let slope = (c * value - 1.0) / square;
        return [value, slope, (value + 3.0 * c * slope) / square];
    }
    // Σ a_n yⁿ with a_0 = 1 and a_{n+1}/a_n = (n + 1)/(n + 3/2).
    let (mut sums, mut factor) = ([0.0; 3], 1.0);
    let mut powers = [1.0, 0.0, 0.0];
    for n in 0..TERMS {
        let n = f64::from(n);
        sums[0] += factor * powers[0];
        sums[1] += factor * n * powers[1];
        sums[2] += factor * n * (n - 1.0) * powers[2];
        factor *= (n + 1.0) / (n + 1.5);
        powers = [powers[0] * y, powers[0], powers[1]];
    }
    [sums[0], -0.5 * sums[1], 0.25 * sums[2]]
}

/// Change of the arguments in all up to which Simpson's rule is exact to round-off up to [`LARGEST`]; elements are stiff, and their forces as exact as
/// the slopes.
const LEAST_CHANGE: f64 = 1e-4;

/// Terms of the sum, which leave round-off at [`NEAR`].
const TERMS: u32 = 16;

/// The rotation about an axis, rad, of (r, t₁, …): with r = sin φ n·e, n the axis of the whole rotation φ, and t_k the cosines between the axes of
/// the two ends, one of them in the plane and three in space. Together they are the rotation vector.
pub struct Rotation;

impl Smooth for Rotation {
    fn derivatives(&self, value: &[f64]) -> Derivatives {
        let (cosine, share) = cosine(&value[1..]);
        let [u, slope, bend] = over_sine(cosine);
        let r = value[0];
        let mut out = Derivatives { value: r * u, ..Derivatives::default() };
        out.gradient[0] = u;
        for i in 1..value.len() {
            out.gradient[i] = share * r * slope;
            (out.hessian[0][i], out.hessian[i][0]) = (share * slope, share * slope);
            (1..value.len()).for_each(|j| out.hessian[i][j] = share * share * r * bend);
        }
        out
    }

    fn least_change(&self) -> f64 {
        LEAST_CHANGE
    }

    fn corner(&self, _from: &[f64], to: &[f64]) -> Option<&'static str> {
        (cosine(&to[1..]).0 < LARGEST).then_some(HALF_A_TURN)
    }
}

/// cos φ of the cosines between the axes, and what each of these counts in it.
fn cosine(t: &[f64]) -> (f64, f64) {
    match t {
        [t] => (*t, 1.0),
        _ => (0.5 * (t.iter().sum::<f64>() - 1.0), 0.5),
    }
}

/// The strain along the beam, of (v₁, t, v₂, …): v_k is the way between the ends along the mean of their axes over the length, and t the cosine between
/// the axes along the beam. An arc of the length of the beam has none, nor has one that bends to and fro: that is longer than its way along the beam by
/// the square of its way across.
pub struct Strain {
    /// What the squares of the ways across count beside that of the way along the beam.
    pub across: Vec<f64>,
}

/// What happens where the way between the ends does not go along their axes any more.
const BACK: &str = "the ends of an element turn by a quarter of a turn against the way from one to the other; take more elements";

impl Smooth for Strain {
    fn derivatives(&self, value: &[f64]) -> Derivatives {
        let [v, t] = [value[0], value[1]];
        let [u, slope, bend] = over_sine(t);
        // Half the square of the length over that at the start: ½ (u v₁)² + ½ Σ c_k v_k².
        let mut half = Derivatives { value: 0.5 * (u * v).powi(2), ..Derivatives::default() };
        (half.gradient[0], half.gradient[1]) = (u * u * v, u * v * slope * v);
        (half.hessian[0][0], half.hessian[1][1]) = (u * u, v * v * (slope * slope + u * bend));
        (half.hessian[0][1], half.hessian[1][0]) = (2.0 * u * v * slope, 2.0 * u * v * slope);
        for (k, (way, c)) in value[2..].iter().zip(&self.across).enumerate() {
            half.value += 0.5 * c * way * way;
            (half.gradient[2 + k], half.hessian[2 + k][2 + k]) = (c * way, *c);
        }
        let length = (2.0 * half.value).sqrt();
        let mut out = Derivatives { value: length - 1.0, gradient: half.gradient.map(|g| g / length), ..Derivatives::default() };
        for (i, line) in out.hessian.iter_mut().enumerate() {
            line.iter_mut().enumerate().for_each(|(j, h)| *h = (half.hessian[i][j] - out.gradient[i] * out.gradient[j]) / length);
        }
        out
    }

    fn least_change(&self) -> f64 {
        LEAST_CHANGE
    }

    fn corner(&self, _from: &[f64], to: &[f64]) -> Option<&'static str> {
        let is_back = (to[0] <= 0.0).then_some(BACK);
        (to[1] < LARGEST).then_some(HALF_A_TURN).or(is_back)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_rotation_vector_is_exact_and_its_derivatives_are_those_of_differences() {
        for angle in [0.0, 1e-9, 1e-3, 0.3, 0.4509, 0.4511, 1.0, 2.0, 2.9] {
            let (sine, cosine) = f64::sin_cos(angle);
            let found = Rotation.derivatives(&[sine, cosine, cosine, 1.0]);
            assert!((found.value - angle).abs() < 4e-15 * (1.0 + angle), "{angle}: {}", found.value);
            assert!((Rotation.derivatives(&[sine, cosine]).value - angle).abs() < 4e-15 * (1.0 + angle));
            // An arc of unit length and this angle.
            let chord = if angle > 0.0 { (0.5 * angle).sin() / (0.5 * angle) } else { 1.0 };
            let strain = Strain { across: vec![1.2] }.derivatives(&[chord * (0.5 * angle).cos(), cosine, 0.0]).value;
            assert!(strain.abs() < 4e-15 * (1.0 + angle), "{angle}: {strain}");
        }
        let strain = &Strain { across: vec![1.2, 0.7] };
        let functions: [(&dyn Smooth, &[f64]); 7] = [
            (&Rotation, &[0.3, 0.9, 0.8, 0.95]),
            (&Rotation, &[0.8, 0.6]),
            (strain, &[0.9, 0.97, 0.2, -0.3]),
            // Where axes are longer or shorter than they should be.
            (&Rotation, &[0.8, 1.4, 1.2, 1.1]),
            (strain, &[0.9, 1.3, 0.1, 0.2]),
            (strain, &[0.9, 1.05, 0.0, 0.1]),
            (strain, &[0.9, -1.2, 0.3, 0.2]),
        ];
        for (function, at) in functions {
            let exact = function.derivatives(at);
            for i in 0..at.len() {
                let moved = |by: f64| {
                    let mut moved = at.to_vec();
                    moved[i] += by;
                    function.derivatives(&moved)
                };
                let h = 1e-6;
                let (up, down) = (moved(h), moved(-h));
                // Large values and slopes leave rounding of their differences.
                let size = 1.0 + exact.value.abs() + exact.gradient.iter().fold(0.0, |most: f64, g| most.max(g.abs()));
                assert!(((up.value - down.value) / (2.0 * h) - exact.gradient[i]).abs() < 1e-8 * size);
                for j in 0..at.len() {
                    let (slope, exact) = ((up.gradient[j] - down.gradient[j]) / (2.0 * h), exact.hessian[i][j]);
                    assert!((slope - exact).abs() < 1e-7 * (size + exact.abs()), "{i} {j}: {slope} {exact}");
                }
            }
        }
    }
}
