//! How a body is turned at the start.

use nalgebra::{Matrix3, Quaternion, Rotation3, Unit, UnitQuaternion, Vector3};

use crate::model::entry::{Entry, Spot, Written};
use crate::model::fault::{Read, Refused};
use crate::model::fields::{Keys, List, Number, Rows};
use crate::model::key::Shape;
use crate::model::value::Value;

/// How the axes of a body are turned from those of the model; one of its spellings is given.
#[derive(Clone, Debug, PartialEq, Keys)]
#[table("an orientation", refuse_bare)]
pub struct Orientation {
    /// unit quaternion, its real part first
    #[key(default = "none", shape = Shape::Numbers(4, 4))]
    pub quat_wxyz: Option<List<Number>>,
    /// unit quaternion, its real part last
    #[key(default = "none", shape = Shape::Numbers(4, 4))]
    pub quat_xyzw: Option<List<Number>>,
    /// axis of a rotation, with angle or angle_deg; not in a planar model
    #[key(unit = "any", default = "none", shape = Shape::Vector)]
    pub axis: Option<List<Number>>,
    /// angle about the axis; in a planar model from its first axis to its second
    #[key(unit = "rad", default = "none")]
    pub angle: Option<Number>,
    /// the same in degrees
    #[key(unit = "°", default = "none")]
    pub angle_deg: Option<Number>,
    /// roll, pitch and yaw: about x, then y, then z of the model
    #[key(unit = "rad", default = "none", shape = Shape::Vector)]
    pub rpy: Option<List<Number>>,
    /// the same in degrees
    #[key(unit = "°", default = "none", shape = Shape::Vector)]
    pub rpy_deg: Option<List<Number>>,
    /// rotation matrix from body axes to those of the model, by rows
    #[key(default = "none")]
    pub matrix: Option<Rows>,
}

/// Largest deviation of a quaternion from unit length, and of a matrix from orthogonal, that rounding explains.
const ROUNDED: f64 = 1e-6;

const SPELLINGS: [&str; 6] = ["quat_wxyz", "quat_xyzw", "axis", "rpy", "rpy_deg", "matrix"];

impl Orientation {
    /// Turned by an angle, rad, about an axis of any length.
    pub fn axis_angle(axis: [impl Into<Number>; 3], angle: impl Into<Number>) -> Self {
        Self::new().axis(axis).angle(angle)
    }

    /// Turned by an angle in degrees about an axis of any length.
    pub fn axis_angle_deg(axis: [impl Into<Number>; 3], angle: impl Into<Number>) -> Self {
        Self::new().axis(axis).angle_deg(angle)
    }

    /// In a planar model turned by an angle, rad, from its first axis to its second.
    pub fn in_plane(angle: impl Into<Number>) -> Self {
        Self::new().angle(angle)
    }

    /// In a planar model turned by an angle in degrees from its first axis to its second.
    pub fn in_plane_deg(angle: impl Into<Number>) -> Self {
        Self::new().angle_deg(angle)
    }

    /// By roll, pitch and yaw, rad: about x, then y, then z of the model.
    pub fn roll_pitch_yaw(angles: [impl Into<Number>; 3]) -> Self {
        Self::new().rpy(angles)
    }

    /// By roll, pitch and yaw in degrees.
    pub fn roll_pitch_yaw_deg(angles: [impl Into<Number>; 3]) -> Self {
        Self::new().rpy_deg(angles)
    }

    /// By a unit quaternion, its real part first.
    pub fn wxyz(quaternion: [impl Into<Number>; 4]) -> Self {
        Self::new().quat_wxyz(quaternion)
    }

    /// By a unit quaternion, its real part last.
    pub fn xyzw(quaternion: [impl Into<Number>; 4]) -> Self {
        Self::new().quat_xyzw(quaternion)
    }

    /// By the rows of the rotation matrix from body axes to those of the model.
    pub fn rows<T: Into<Number>>(matrix: [[T; 3]; 3]) -> Self {
        Self::new().matrix(matrix)
    }

    /// The rotation from body axes to those of the model; `entry` is the table of the orientation.
    pub(super) fn rotation(&self, entry: &Entry<'_>, dim: usize) -> Read<Matrix3<f64>> {
        let given: Vec<&str> = SPELLINGS.into_iter().filter(|key| self.value(key).is_some()).collect();
        let angle = ["angle", "angle_deg"].into_iter().find(|key| self.value(key).is_some());
        if given.is_empty() && angle.is_none() && entry.has_fault() {
            // What it says is under a name that is not known, which has been told.
            return Err(Refused);
        }
        if let [first, second, ..] = given[..] {
            return Err(entry.refuse_key(second, format!("`{first}` and `{second}` both give the orientation"), "keep one of the two"));
        }
        if let (Some(angle), Some(&key), 3) = (angle, given.first().filter(|key| **key != "axis"), dim) {
            return Err(entry.refuse_key(
                angle,
                format!("`{angle}` goes with an `axis`, and this orientation has `{key}`"),
                "keep one of the two",
            ));
        }
        if dim == 2 {
            if let Some(key) = given.first() {
                return Err(entry.refuse_key(key, format!("a planar model has no `{key}`"), "write { angle = … } or { angle_deg = … }"));
            }
            return Ok(Rotation3::from_axis_angle(&Vector3::z_axis(), self.radians(entry)?).into_inner());
        }
        match self {
            Self { quat_wxyz: Some(numbers), .. } => quaternion(entry, "quat_wxyz", numbers, |[w, x, y, z]| Quaternion::new(w, x, y, z)),
            Self { quat_xyzw: Some(numbers), .. } => quaternion(entry, "quat_xyzw", numbers, |[x, y, z, w]| Quaternion::new(w, x, y, z)),
            Self { axis: Some(axis), .. } => {
                let axis = Vector3::from(axis.vector(entry, "axis", 3)?);
                let angle = self.radians(entry)?;
                let largest = axis.amax();
                if largest == 0.0 {
                    return Err(entry.refuse("axis", "an axis of zero length has no direction", "give the axis of the rotation"));
                }
                // By its largest number first, as squares could overflow.
                Ok(Rotation3::from_axis_angle(&Unit::new_normalize(axis.map(|c| c / largest)), angle).into_inner())
            }
            Self { rpy: Some(angles), .. } => {
                let angles = angles.vector(entry, "rpy", 3)?;
                note_degrees(entry, "rpy", &angles);
                Ok(rotation_of(angles))
            }
            Self { rpy_deg: Some(angles), .. } => {
                Ok(rotation_of(angles.vector(entry, "rpy_deg", 3)?.map(|angle| std::f64::consts::PI / 180.0 * angle)))
            }
            Self { matrix: Some(rows), .. } => rotation_near(entry, rows),
            _ => match angle {
                Some(key) => {
                    Err(entry.refuse_key(key, "an angle in space needs an axis", format!("write {{ axis = [x, y, z], {key} = … }}")))
                }
                None => Err(entry.refuse_all("this orientation says nothing", format!("give one of {}", SPELLINGS.join(", ")))),
            },
        }
    }

    /// The angle about its axis, or in a planar model; rad.
    pub(super) fn radians(&self, entry: &Entry<'_>) -> Read<f64> {
        match (&self.angle, &self.angle_deg) {
            (Some(_), Some(_)) => Err(entry.refuse_key("angle_deg", "`angle` and `angle_deg` exclude each other", "keep one of the two")),
            (Some(angle), None) => angle.number(entry, "angle").inspect(|angle| note_degrees(entry, "angle", &[*angle])),
            (None, Some(angle)) => angle.number(entry, "angle_deg").map(f64::to_radians),
            (None, None) => Err(entry.refuse_all("this orientation has no angle", "add angle = … in radians, or angle_deg = … in degrees")),
        }
    }
}

/// Notes angles of more than a turn, which may be degrees; not those whose formula says that they are.
fn note_degrees(entry: &Entry<'_>, key: &str, radians: &[f64]) {
    let is_long = |(k, angle): (usize, &f64)| angle.abs() > std::f64::consts::TAU && !entry.is_in_degrees(key, k);
    if let Some((_, angle)) = radians.iter().enumerate().find(|one| is_long(*one)) {
        entry.note(key, format!("{angle} rad is more than a full turn; degrees are written as `{key}_deg`"));
    }
}

fn refuse_bare(entry: &Entry<'_>, spot: Spot<'_>, value: &Value) -> Refused {
    match value {
        Value::List(items) if items.len() == 3 => entry.refuse(
            spot,
            "three bare numbers do not say whether they are angles, and in which order",
            "write orientation = { rpy_deg = [roll, pitch, yaw] }, { rpy = [..] } in radians, or { axis = [x, y, z], angle_deg = … }",
        ),
        Value::List(_) => {
            let cure = "write orientation = { quat_wxyz = [w, x, y, z] } or { quat_xyzw = [x, y, z, w] }";
            entry.refuse(spot, "four bare numbers do not say which comes first", cure)
        }
        Value::Number(angle) => entry.refuse(
            spot,
            "a bare number does not say whether it is in radians or degrees",
            format!("write orientation = {{ angle_deg = {angle} }} or {{ angle = {angle} }}, in space with an axis = [x, y, z] beside it"),
        ),
        _ => entry.refuse_no_table(spot, value),
    }
}

/// About x, then y, then z of the model.
fn rotation_of([roll, pitch, yaw]: [f64; 3]) -> Matrix3<f64> {
    Rotation3::from_euler_angles(roll, pitch, yaw).into_inner()
}

fn quaternion(entry: &Entry<'_>, key: &str, numbers: &List<Number>, ordered: fn([f64; 4]) -> Quaternion<f64>) -> Read<Matrix3<f64>> {
    if numbers.len() != 4 {
        return Err(entry.refuse(key, format!("a quaternion has four numbers, and this has {}", numbers.len()), "write four numbers"));
    }
    let n = numbers.numbers(entry, key)?;
    let quaternion = ordered([n[0], n[1], n[2], n[3]]);
    let size = quaternion.norm();
    if (size - 1.0).abs() > ROUNDED {
        let cure = match size > 0.0 && size.is_finite() {
            true => format!(
                "a rotation has one of length 1: write [{}]",
                n.iter().map(|n| (n / size).to_string()).collect::<Vec<_>>().join(", ")
            ),
            false => "a rotation has one of length 1".into(),
        };
        return Err(entry.refuse(key, format!("the length of this quaternion is {size}"), cure));
    }
    Ok(UnitQuaternion::from_quaternion(quaternion).to_rotation_matrix().into_inner())
}

/// The rotation nearest to a matrix that must be one but for rounding.
fn rotation_near(entry: &Entry<'_>, rows: &Rows) -> Read<Matrix3<f64>> {
    let cure = "write three rows of three numbers: the body's axes as columns";
    let rows = rows.numbers(entry, "matrix", "a rotation matrix", cure)?;
    let matrix = Matrix3::from_fn(|i, j| rows[i][j]);
    let products = matrix.transpose() * matrix;
    // Written so that what is no number is refused too.
    let is_off = |deviation: f64| deviation.is_nan() || deviation.abs() > ROUNDED;
    if let Some(k) = (0..3).find(|&k| is_off(products[(k, k)].sqrt() - 1.0)) {
        let message = format!("column {} of this matrix has the length {}", k + 1, products[(k, k)].sqrt());
        return Err(entry.refuse("matrix", message, "in a rotation matrix it is 1: give seven digits or more"));
    }
    if let Some((i, j)) = [(0, 1), (0, 2), (1, 2)].into_iter().find(|&at| is_off(products[at])) {
        let degrees = products[(i, j)].clamp(-1.0, 1.0).acos().to_degrees();
        let message = format!("columns {} and {} of this matrix are at {degrees:.4}°", i + 1, j + 1);
        return Err(entry.refuse("matrix", message, "in a rotation matrix they are at right angles: give seven digits or more"));
    }
    if matrix.determinant() < 0.0 {
        return Err(entry.refuse("matrix", "this matrix is a reflection: its axes are left-handed", "turn one of the axes around"));
    }
    // As near as it is, exactly orthogonal.
    Ok(UnitQuaternion::from_matrix(&matrix).to_rotation_matrix().into_inner())
}
