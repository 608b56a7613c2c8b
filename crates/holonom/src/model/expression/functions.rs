//! The functions an expression may call.

use crate::system::Number;

/// A function of one or two numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Function {
    Sin,
    Cos,
    Tan,
    Asin,
    Acos,
    Atan,
    Sinh,
    Cosh,
    Tanh,
    Exp,
    Ln,
    Log10,
    Sqrt,
    Abs,
    Sign,
    Step,
    Floor,
    Atan2,
    Min,
    Max,
    Mod,
    Pow,
}

/// Names, number of arguments and functions.
pub(super) const FUNCTIONS: &[(&str, usize, Function)] = &[
    ("sin", 1, Function::Sin),
    ("cos", 1, Function::Cos),
    ("tan", 1, Function::Tan),
    ("asin", 1, Function::Asin),
    ("acos", 1, Function::Acos),
    ("atan", 1, Function::Atan),
    ("sinh", 1, Function::Sinh),
    ("cosh", 1, Function::Cosh),
    ("tanh", 1, Function::Tanh),
    ("exp", 1, Function::Exp),
    ("ln", 1, Function::Ln),
    ("log10", 1, Function::Log10),
    ("sqrt", 1, Function::Sqrt),
    ("abs", 1, Function::Abs),
    ("sign", 1, Function::Sign),
    ("step", 1, Function::Step),
    ("floor", 1, Function::Floor),
    ("atan2", 2, Function::Atan2),
    ("min", 2, Function::Min),
    ("max", 2, Function::Max),
    ("mod", 2, Function::Mod),
    ("pow", 2, Function::Pow),
];

/// Names and values of the constants. Nothing in a model may have one of these names.
pub(super) const CONSTANTS: &[(&str, f64)] = &[("pi", std::f64::consts::PI), ("tau", std::f64::consts::TAU), ("e", std::f64::consts::E)];

/// Names of units and what they are in SI units. Parameters, indices and variables may have these names and come first.
pub(super) const UNITS: &[(&str, f64)] =
    &[("deg", std::f64::consts::PI / 180.0), ("mm", 1e-3), ("cm", 1e-2), ("km", 1e3), ("rpm", std::f64::consts::PI / 30.0), ("bar", 1e5)];

/// Names of SI units that numbers have without saying so.
pub(super) const SI: [&str; 10] = ["kg", "m", "s", "N", "Nm", "J", "W", "Pa", "Hz", "rad"];

/// Names of units that a model may have as parameters, and what they are in SI units.
pub(super) const OTHERS: &[(&str, &str)] = &[
    ("ms", "1e-3"),
    ("kN", "1e3"),
    ("MN", "1e6"),
    ("Nmm", "1e-3"),
    ("kNm", "1e3"),
    ("kPa", "1e3"),
    ("MPa", "1e6"),
    ("GPa", "1e9"),
    ("kJ", "1e3"),
    ("kW", "1e3"),
    ("MW", "1e6"),
    ("kHz", "1e3"),
    ("inch", "25.4e-3"),
    ("kph", "1/3.6"),
    ("kmh", "1/3.6"),
];

impl Function {
    /// The value of a function of one number.
    pub(super) fn of_one<N: Number>(self, x: N) -> N {
        let real = x.re();
        match self {
            Self::Sin => x.sin(),
            Self::Cos => x.cos(),
            Self::Tan => x.tan(),
            Self::Asin => x.asin(),
            Self::Acos => x.acos(),
            Self::Atan => x.atan(),
            Self::Sinh => x.sinh(),
            Self::Cosh => x.cosh(),
            Self::Tanh if real < 0.0 => -tanh(-x),
            Self::Tanh => tanh(x),
            Self::Exp => x.exp(),
            Self::Ln => x.ln(),
            Self::Log10 => x.log10(),
            Self::Sqrt => real_power(x, 0.5),
            Self::Abs => {
                if is_less(&x, &N::from(0.0)) {
                    -x
                } else {
                    x
                }
            }
            // Written out: the signum of a number library is 1 at zero, and a NaN must stay one.
            Self::Sign => N::from(if real == 0.0 { 0.0 } else { real.signum() }),
            Self::Step => N::from(if real.is_nan() { real } else { f64::from(real >= 0.0) }),
            Self::Floor => N::from(real.floor()),
            Self::Atan2 | Self::Min | Self::Max | Self::Mod | Self::Pow => unreachable!("a function of two numbers"),
        }
    }

    /// The value of a function of two numbers.
    pub(super) fn of_two<N: Number>(self, x: N, y: N) -> N {
        match self {
            Self::Atan2 => atan2(x, y),
            Self::Min => {
                if is_less(&y, &x) {
                    y
                } else {
                    x
                }
            }
            Self::Max => {
                if is_less(&x, &y) {
                    y
                } else {
                    x
                }
            }
            Self::Mod => x - y * (x.re() / y.re()).floor(),
            Self::Pow => x.powd(y),
            _ => unreachable!("a function of one number"),
        }
    }
}

/// Whether a number is less than another one, or becomes so where both are equal: derivatives do not depend on which is written first.
fn is_less<N: Number>(x: &N, y: &N) -> bool {
    x.re() < y.re() || (x.re() == y.re() && x.is_less_ahead(y))
}

/// tanh x of x ≥ 0 by powers that vanish for large x, where those of sinh and cosh overflow in the derivatives.
fn tanh<N: Number>(x: N) -> N {
    let rest = -(x * -2.0).exp_m1();
    rest / (-rest + 2.0)
}

/// The angle of (x, y), with derivatives on both axes, too.
fn atan2<N: Number>(y: N, x: N) -> N {
    if x.re() == 0.0 && y.re() == 0.0 {
        return y.atan2(x);
    }
    let angle = if x.re().abs() >= y.re().abs() { (y / x).atan() } else { -(x / y).atan() };
    // Both differ from the angle by a constant.
    angle + (y.re().atan2(x.re()) - angle.re())
}

/// x/y. What is divided by a power that overflows is nothing, and so are its derivatives, as of 1/cosh(x) far out.
pub(super) fn quotient<N: Number>(x: N, y: N) -> N {
    if y.re().is_infinite() && x.re().is_finite() { N::from(0.0) } else { x / y }
}

/// x^n for a constant integer n.
pub(super) fn integer_power<N: Number>(x: N, n: i32) -> N {
    if n < 0 && x.re().is_infinite() { N::from(0.0) } else { x.powi(n) }
}

/// x^p for a constant p that is no integer.
pub(super) fn real_power<N: Number>(x: N, p: f64) -> N {
    if x.re() == 0.0 && (p > 1.0 || (p > 0.0 && x.is_constant())) {
        // The general rule makes 0·∞ of this. What grows without bound here is at most the second derivative, and nothing of a number that is
        // clipped to zero.
        return N::from(0.0);
    }
    if p == 0.5 {
        return x.sqrt();
    }
    if p < 0.0 && x.re() == f64::INFINITY {
        return N::from(0.0);
    }
    x.powf(p)
}
