//! How an element of a beam is deformed, as functions of dot products of the frames at its ends (methods §22).

use crate::system::{Derivatives, Smooth};

/// Cosine of the rotation from one end of an element to the other beyond which no step goes: rotations are known up to half a turn.
const LARGEST: f64 = -0.98;

/// What happens there.
const HALF_A_TURN: &str = "the ends of an element turn against each other by half a turn; take more elements";

/// Size of (1 − c)/2 below which φ/sin φ is summed up.
const NEAR: f64 = 0.05;

/// A function of the cosine of a turn with its first two derivatives, and a parabola in its place beyond [`LARGEST`]: iterations may come there, and steps do
/// not end there.
fn continued(c: f64, function: impl Fn(f64) -> [f64; 3]) -> [f64; 3] {
    let by = (c - LARGEST).min(0.0);
    let [value, slope, bend] = function(c - by);
    [value + by * (slope + 0.5 * by * bend), slope + by * bend, bend]
}

/// φ/sin φ with its first two derivatives by c = cos φ, which is above 1 where the axes of an iteration are longer than they should be.
fn over_sine(c: f64) -> [f64; 3] {
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
        let [u, slope, bend] = continued(cosine, over_sine);
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

/// How much what an element that is turned does across its mean axes is more than its way along them, in the plane of the turn: (p + 1/(1 + z))/4z³ of
/// p = 1/(a + b z) and z = cos ½β, and its derivatives by cos β, so that it makes (1 + p sin² ½β)/z of it.
fn more(cosine: f64, [a, b]: [f64; 2]) -> [f64; 3] {
    let z = (0.5 * (1.0 + cosine)).sqrt();
    let (p, q) = ((a + b * z).recip(), (1.0 + z).recip());
    let [sum, slope, bend] = [p + q, -b * p * p - q * q, 2.0 * (b * b * p.powi(3) + q.powi(3))];
    // By z, whose derivatives are 1/4z and −1/16z³.
    let cube = 0.25 * z.powi(-3);
    let [value, slope, bend] = [cube * sum, cube * (slope - 3.0 * sum / z), cube * (bend - 6.0 * slope / z + 12.0 * sum / (z * z))];
    [value, 0.25 * slope / z, (bend - slope / z) / (16.0 * z * z)]
}

/// The way across an element along one of its axes over its length, of (v₂, t, r₃) in the plane and of (v₂, v₃, t, r₂, r₃) in space: that along the mean axis of its
/// ends, which is the shorter in the plane of their turn the more they turn, and how much more an element does that is bent so far.
pub struct Across {
    /// Which of the axes across it is.
    pub axis: usize,
}

/// What makes [`more`] of a deflection, and what makes a length of it: of an element whose turn goes as a parabola along it.
const DEFLECTED: [f64; 2] = [3.0, 7.0];
const LENGTHENED: [f64; 2] = [2.0, 4.8];

impl Smooth for Across {
    fn derivatives(&self, value: &[f64]) -> Derivatives {
        across(value, self.axis, DEFLECTED)
    }

    fn least_change(&self) -> f64 {
        LEAST_CHANGE
    }

    // Where it has one the strain has it as well.
    fn corner(&self, _from: &[f64], _to: &[f64]) -> Option<&'static str> {
        None
    }
}

/// v + K r (r v − r′ v′), where v is the way along the axis and r the sine of the turn that bends towards it, v′ and r′ those of the other axis, and K what
/// turns make [`more`] of it.
fn across(value: &[f64], axis: usize, more_of: [f64; 2]) -> Derivatives {
    let axes = value.len() / 2;
    let [v, t, r] = [axis, axes, 2 * axes - axis];
    // In the plane there is no other.
    let other = (axes == 2).then_some([1 - axis, 3 + axis]);
    let [v2, r2] = other.map_or([0.0; 2], |other| other.map(|i| value[i]));
    let [factor, slope, bend] = continued(value[t], |cosine| more(cosine, more_of));
    let turned = value[r] * value[v] - r2 * v2;
    let mut out = Derivatives { value: value[v] + factor * value[r] * turned, ..Derivatives::default() };
    let mut add = |i: usize, by: f64, bends: &[(usize, f64)]| {
        out.gradient[i] += factor * by;
        (out.hessian[t][i], out.hessian[i][t]) = (slope * by, slope * by);
        for &(j, bend) in bends {
            (out.hessian[i][j], out.hessian[j][i]) = (factor * bend, factor * bend);
        }
    };
    add(v, value[r] * value[r], &[(r, 2.0 * value[r])]);
    add(r, value[r] * value[v] + turned, &[(r, 2.0 * value[v])]);
    if let Some([other_v, other_r]) = other {
        add(other_v, -value[r] * r2, &[(r, -r2), (other_r, -value[r])]);
        add(other_r, -value[r] * v2, &[(r, -v2)]);
    }
    out.gradient[v] += 1.0;
    out.gradient[t] = slope * value[r] * turned;
    out.hessian[t][t] = bend * value[r] * turned;
    out
}

/// The strain along the beam, of (v₁, v₂, …, t, r₃) or (…, t, r₂, r₃): v_k is the way between the ends along the mean of their axes over the length, t the cosine
/// between the axes along the beam, and r those about which they turn. An arc of the length of the beam has none, nor has one that bends to and fro: that is longer
/// than its way along the beam by the square of its way across.
pub struct Strain {
    /// What the squares of the ways across count beside that of the way along the beam.
    pub across: Vec<f64>,
}

/// What happens where the way between the ends does not go along their axes any more.
const BACK: &str = "the ends of an element turn by a quarter of a turn against the way from one to the other; take more elements";

impl Smooth for Strain {
    fn derivatives(&self, value: &[f64]) -> Derivatives {
        let (m, turn) = (value.len(), value.len() / 2);
        let (v, [u, slope, bend]) = (value[0], continued(value[turn], over_sine));
        // Half the square of the length over that at the start: ½ (u v₁)² + ½ Σ c_k y_k².
        let mut half = Derivatives { value: 0.5 * (u * v).powi(2), ..Derivatives::default() };
        (half.gradient[0], half.gradient[turn]) = (u * u * v, u * v * slope * v);
        (half.hessian[0][0], half.hessian[turn][turn]) = (u * u, v * v * (slope * slope + u * bend));
        (half.hessian[0][turn], half.hessian[turn][0]) = (2.0 * u * v * slope, 2.0 * u * v * slope);
        for (axis, c) in self.across.iter().enumerate() {
            let way = across(&value[1..], axis, LENGTHENED);
            half.value += 0.5 * c * way.value * way.value;
            for i in 1..m {
                half.gradient[i] += c * way.value * way.gradient[i - 1];
                for j in 1..m {
                    half.hessian[i][j] += c * (way.gradient[i - 1] * way.gradient[j - 1] + way.value * way.hessian[i - 1][j - 1]);
                }
            }
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
        (to[to.len() / 2] < LARGEST).then_some(HALF_A_TURN).or(is_back)
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
            let strain = Strain { across: vec![1.2] }.derivatives(&[chord * (0.5 * angle).cos(), 0.0, cosine, sine]).value;
            assert!(strain.abs() < 4e-15 * (1.0 + angle), "{angle}: {strain}");
        }
        let [strain, planar] = &[vec![1.2, 0.7], vec![1.2]].map(|across| Strain { across });
        let [first, second] = &[0, 1].map(|axis| Across { axis });
        let functions: [(&dyn Smooth, &[f64]); 11] = [
            (&Rotation, &[0.3, 0.9, 0.8, 0.95]),
            (&Rotation, &[0.8, 0.6]),
            (strain, &[0.9, 0.2, -0.3, 0.97, 0.1, -0.2]),
            (planar, &[0.9, 0.3, 0.6, 0.8]),
            (first, &[0.3, 0.6, 0.8]),
            (first, &[0.3, -0.2, 0.6, 0.5, -0.6]),
            (second, &[0.3, -0.2, 0.6, 0.5, -0.6]),
            // Where axes are longer or shorter than they should be.
            (&Rotation, &[0.8, 1.4, 1.2, 1.1]),
            (strain, &[0.9, 0.1, 0.2, 1.3, 0.1, 0.3]),
            (planar, &[0.9, 0.1, 1.05, 0.1]),
            (strain, &[0.9, 0.3, 0.2, -1.2, 0.1, 0.2]),
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
