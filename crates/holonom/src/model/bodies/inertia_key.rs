//! The inertia of a body as it is written.

use nalgebra::{Matrix3, Vector3};

use super::inertia;
use crate::model::entry::{Entry, Spot};
use crate::model::fault::Read;
use crate::model::fields::{Field, List, Number, Rows};
use crate::model::key::Shape;
use crate::model::value::Value;

/// Inertia about the centre of mass in body axes, kg·m².
#[derive(Clone, Debug, PartialEq)]
pub enum Inertia {
    /// Of a planar body, about the normal of the plane.
    Polar(Number),
    /// Ixx, Iyy, Izz, which the products Ixy, Ixz, Iyz may follow.
    Moments(List<Number>),
    /// The tensor by its rows.
    Tensor(Rows),
}

impl Field for Inertia {
    const SHAPE: Shape = Shape::Inertia;

    fn read(entry: &Entry<'_>, spot: Spot<'_>, value: &Value) -> Read<Self> {
        match value {
            Value::Number(_) | Value::Text(_) => Number::read(entry, spot, value).map(Self::Polar),
            Value::List(items) if !items.is_empty() && items.iter().all(|item| matches!(item, Value::List(_))) => {
                Rows::read(entry, spot, value).map(Self::Tensor)
            }
            Value::List(_) => List::read(entry, spot, value).map(Self::Moments),
            other => {
                let message = format!("`{}` wants numbers, and this is {}", spot.key, other.type_name());
                Err(entry.refuse(spot, message, format!("write {} = [Ixx, Iyy, Izz], in a planar model one number", spot.key)))
            }
        }
    }

    fn write(&self) -> Value {
        match self {
            Self::Polar(moment) => moment.write(),
            Self::Moments(moments) => moments.write(),
            Self::Tensor(rows) => rows.write(),
        }
    }
}

impl From<f64> for Inertia {
    fn from(moment: f64) -> Self {
        Self::Polar(moment.into())
    }
}

impl From<&str> for Inertia {
    fn from(formula: &str) -> Self {
        Self::Polar(formula.into())
    }
}

impl<T: Into<Number>> From<[T; 3]> for Inertia {
    fn from(moments: [T; 3]) -> Self {
        Self::Moments(moments.into())
    }
}

impl<T: Into<Number>> From<[T; 6]> for Inertia {
    fn from(moments_and_products: [T; 6]) -> Self {
        Self::Moments(moments_and_products.into())
    }
}

impl<T: Into<Number>> From<[[T; 3]; 3]> for Inertia {
    fn from(rows: [[T; 3]; 3]) -> Self {
        Self::Tensor(rows.into())
    }
}

impl Inertia {
    /// The inertia tensor, which must be one that a body can have: with `is_checked` false a moment may exceed the sum of the others, which
    /// is noted.
    pub(super) fn tensor(&self, entry: &Entry<'_>, key: &str, dim: usize, is_checked: bool) -> Read<Matrix3<f64>> {
        if dim == 2 {
            let Self::Polar(moment) = self else {
                let cure = format!("write {key} = …, about the normal of the plane");
                return Err(entry.refuse(key, "a planar model has one moment of inertia", cure));
            };
            return Ok(Matrix3::from_diagonal(&Vector3::new(0.0, 0.0, moment.positive(entry, key)?)));
        }
        let tensor = match self {
            Self::Polar(_) => {
                let cure = format!("write {key} = {SPELLINGS}");
                return Err(entry.refuse(key, "a body in space has three moments of inertia, and this is one", cure));
            }
            Self::Moments(moments) => {
                let count = moments.len();
                if count != 3 && count != 6 {
                    let message = format!("`{key}` has 3 or 6 numbers or is 3 × 3, and this has {count}");
                    return Err(entry.refuse(key, message, format!("write {SPELLINGS}")));
                }
                let n = moments.numbers(entry, key)?;
                let product = |k: usize| n.get(k).copied().unwrap_or(0.0);
                [[n[0], product(3), product(4)], [product(3), n[1], product(5)], [product(4), product(5), n[2]]]
            }
            Self::Tensor(rows) => rows.numbers(entry, key, "the inertia tensor", "write three rows of three numbers")?,
        };
        inertia::check(tensor).map_err(|why| {
            let symmetric = (0..3).all(|i| tensor[i][(i + 1) % 3] == tensor[(i + 1) % 3][i]);
            entry.refuse(key, why, if symmetric { CURE } else { "a tensor of inertia is symmetric: write the same number at both places" })
        })?;
        match inertia::check_sums(tensor) {
            Err(why) if is_checked => return Err(entry.refuse(key, why, SUMS)),
            Err(why) => entry.note(key, why),
            Ok(()) => (),
        }
        Ok(Matrix3::from_fn(|i, j| tensor[i][j]))
    }
}

const SPELLINGS: &str = "[Ixx, Iyy, Izz], or with the products behind them [.., Ixy, Ixz, Iyz]";

const CURE: &str = "check the units and that it is about the centre of mass; each principal moment is at most the sum of the other two";

const SUMS: &str = "check the units and that it is about the centre of mass; check_inertia = false takes it as it is";
