//! How much the slope of a formula of time changes at most, by ranges of its numbers and of their derivatives.

use super::functions::Function;
use super::{Op, Program};

/// Least and largest that a number may be.
type Range = [f64; 2];

/// Ranges of a number and of its first two derivatives.
type Ranges = [Range; 3];

impl Program {
    /// A number that the second derivative by the one variable exceeds nowhere from 0 to `end`; none where nothing is known of it.
    pub fn largest_bend(&self, end: f64) -> Option<f64> {
        let mut waiting: Vec<Ranges> = Vec::new();
        for op in &self.ops {
            let ranges = match op {
                Op::Constant(value) => constant(*value),
                Op::Variable(_) => [[0.0, end], [1.0; 2], [0.0; 2]],
                Op::Neg => product(constant(-1.0), waiting.pop()?),
                Op::Add | Op::Sub | Op::Mul => {
                    let (y, x) = (waiting.pop()?, waiting.pop()?);
                    match op {
                        Op::Add => sum(x, y),
                        Op::Sub => sum(x, product(constant(-1.0), y)),
                        _ => product(x, y),
                    }
                }
                Op::Div => {
                    let (y, x) = (waiting.pop()?, waiting.pop()?);
                    let divisor = y[0][0];
                    if y == constant(divisor) { product(x, constant(1.0 / divisor)) } else { return None }
                }
                Op::IntegerPower(power @ 2..) => {
                    let x = waiting.pop()?;
                    (1..*power).fold(x, |y, _| product(y, x))
                }
                Op::OfOne(Function::Sin | Function::Cos) => chained([[-1.0, 1.0]; 3], waiting.pop()?),
                Op::OfOne(Function::Sqrt) => {
                    let x = waiting.pop().filter(|[value, ..]| value[0] > 0.0)?;
                    let [a, b] = x[0].map(f64::sqrt);
                    chained([[a, b], [0.5 / b, 0.5 / a], [-0.25 / a.powi(3), -0.25 / b.powi(3)]], x)
                }
                _ => return None,
            };
            if !ranges.as_flattened().iter().all(|number| number.is_finite()) {
                return None;
            }
            waiting.push(ranges);
        }
        waiting.pop().map(|[.., [least, most]]| most.max(-least))
    }
}

fn constant(value: f64) -> Ranges {
    [[value; 2], [0.0; 2], [0.0; 2]]
}

fn sum(x: Ranges, y: Ranges) -> Ranges {
    std::array::from_fn(|k| plus(x[k], y[k]))
}

fn product(x: Ranges, y: Ranges) -> Ranges {
    let slopes = times(x[1], y[1]);
    let bends = plus(times(x[2], y[0]), times(x[0], y[2]));
    [times(x[0], y[0]), plus(times(x[1], y[0]), times(x[0], y[1])), plus(bends, plus(slopes, slopes))]
}

/// g(x), from the ranges of g and its derivatives by x.
fn chained(g: Ranges, x: Ranges) -> Ranges {
    [g[0], times(g[1], x[1]), plus(times(g[1], x[2]), times(g[2], times(x[1], x[1])))]
}

fn plus(x: Range, y: Range) -> Range {
    [x[0] + y[0], x[1] + y[1]]
}

fn times(x: Range, y: Range) -> Range {
    let ends = [x[0] * y[0], x[0] * y[1], x[1] * y[0], x[1] * y[1]];
    [ends.into_iter().fold(f64::INFINITY, f64::min), ends.into_iter().fold(f64::NEG_INFINITY, f64::max)]
}
