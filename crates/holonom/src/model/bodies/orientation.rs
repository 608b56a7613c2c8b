//! How a body is turned at the start.

use nalgebra::{Matrix3, Quaternion, Rotation3, Unit, UnitQuaternion, Vector3};

use crate::model::entry::{Entry, Spot, all};
use crate::model::fault::{Read, Refused};
use crate::model::key::{Key, Shape};
use crate::model::value::Value;

/// The keys of an orientation; one of its spellings is given.
pub const KEYS: &[Key] = &[
    Key::optional("quat_wxyz", Shape::Numbers(4, 4), "none", "", "unit quaternion, its real part first"),
    Key::optional("quat_xyzw", Shape::Numbers(4, 4), "none", "", "unit quaternion, its real part last"),
    Key::optional("axis", Shape::Vector, "none", "any", "axis of a rotation, with angle or angle_deg; not in a planar model"),
    Key::optional("angle", Shape::Number, "none", "rad", "angle about the axis; in a planar model from its first axis to its second"),
    Key::optional("angle_deg", Shape::Number, "none", "°", "the same in degrees"),
    Key::optional("rpy", Shape::Vector, "none", "rad", "roll, pitch and yaw: about x, then y, then z of the model"),
    Key::optional("rpy_deg", Shape::Vector, "none", "°", "the same in degrees"),
    Key::optional("matrix", Shape::Rows, "none", "", "rotation matrix from body axes to those of the model, by rows"),
];

/// Largest deviation of a quaternion from unit length, and of a matrix from orthogonal, that rounding explains.
const ROUNDED: f64 = 1e-6;

const SPELLINGS: [&str; 6] = ["quat_wxyz", "quat_xyzw", "axis", "rpy", "rpy_deg", "matrix"];

/// The rotation from body axes to those of the model.
pub fn read(body: &Entry<'_>, dim: usize) -> Read<Matrix3<f64>> {
    if let Value::List(_) = body.value("orientation")? {
        let cure = "write orientation = { quat_wxyz = [w, x, y, z] } or { quat_xyzw = [x, y, z, w] }";
        return Err(body.refuse("orientation", "four bare numbers do not say which comes first", cure));
    }
    let path = format!("{}.orientation", body.path);
    let entry = Entry { name: body.name, path: &path, table: body.table("orientation")?, ..*body };
    let before = entry.sink.count();
    entry.refuse_unknown_keys("an orientation", &KEYS.iter().collect::<Vec<_>>());
    let given: Vec<&str> = SPELLINGS.into_iter().filter(|key| entry.has(key)).collect();
    let angles = ["angle", "angle_deg"].into_iter().find(|key| entry.has(key));
    if given.is_empty() && angles.is_none() && entry.sink.count() > before {
        // What it says is under a name that is not known.
        return Err(Refused);
    }
    if let [_, second, ..] = given[..] {
        return Err(entry.refuse_key(second, format!("`{}` and `{second}` both give the orientation", given[0]), "keep one of the two"));
    }
    if let (Some(angle), Some(&key), 3) = (angles, given.first().filter(|key| **key != "axis"), dim) {
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
        return Ok(Rotation3::from_axis_angle(&Vector3::z_axis(), angle(&entry)?).into_inner());
    }
    match given.first().copied() {
        Some(key @ ("quat_wxyz" | "quat_xyzw")) => quaternion(&entry, key),
        Some("axis") => {
            let axis = Vector3::from(entry.vector("axis", 3)?);
            let angle = angle(&entry)?;
            let largest = axis.amax();
            if largest == 0.0 {
                return Err(entry.refuse("axis", "an axis of zero length has no direction", "give the axis of the rotation"));
            }
            // By its largest number first, as squares could overflow.
            Ok(Rotation3::from_axis_angle(&Unit::new_normalize(axis.map(|c| c / largest)), angle).into_inner())
        }
        Some(key @ ("rpy" | "rpy_deg")) => {
            let unit = if key == "rpy" { 1.0 } else { std::f64::consts::PI / 180.0 };
            let [roll, pitch, yaw] = entry.vector(key, 3)?.map(|angle| unit * angle);
            Ok(Rotation3::from_euler_angles(roll, pitch, yaw).into_inner())
        }
        Some(_) => matrix(&entry),
        None => match angles {
            Some(key) => Err(entry.refuse_key(key, "an angle in space needs an axis", format!("write {{ axis = [x, y, z], {key} = … }}"))),
            None => Err(entry.refuse_all("this orientation says nothing", format!("give one of {}", SPELLINGS.join(", ")))),
        },
    }
}

fn angle(entry: &Entry<'_>) -> Read<f64> {
    match (entry.has("angle"), entry.has("angle_deg")) {
        (true, true) => Err(entry.refuse_key("angle_deg", "`angle` and `angle_deg` exclude each other", "keep one of the two")),
        (false, true) => entry.number("angle_deg").map(f64::to_radians),
        (false, false) => Err(entry.refuse_all("this orientation has no angle", "add angle = … in radians, or angle_deg = … in degrees")),
        _ => entry.number("angle"),
    }
}

fn quaternion(entry: &Entry<'_>, key: &str) -> Read<Matrix3<f64>> {
    let items = entry.list(key)?;
    if items.len() != 4 {
        return Err(entry.refuse(key, format!("a quaternion has four numbers, and this has {}", items.len()), "write four numbers"));
    }
    let n = all(items.iter().enumerate().map(|(k, item)| entry.number_in(Spot { key, item: Some(k) }, item)))?;
    let quaternion = if key == "quat_wxyz" { Quaternion::new(n[0], n[1], n[2], n[3]) } else { Quaternion::new(n[3], n[0], n[1], n[2]) };
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

fn matrix(entry: &Entry<'_>) -> Read<Matrix3<f64>> {
    let cure = "write three rows of three numbers: the body's axes as columns";
    let rows = entry.list("matrix")?;
    let row = |(k, row): (usize, &Value)| match row {
        Value::List(items) if items.len() == 3 => {
            all(items.iter().map(|item| entry.number_in(Spot { key: "matrix", item: Some(k) }, item)))
        }
        _ => Err(entry.refuse(Spot { key: "matrix", item: Some(k) }, "a row of a rotation matrix has three numbers", cure)),
    };
    if rows.len() != 3 {
        return Err(entry.refuse("matrix", format!("a rotation matrix has three rows, and this has {}", rows.len()), cure));
    }
    let rows = all(rows.iter().enumerate().map(row))?;
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
