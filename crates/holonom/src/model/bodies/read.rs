//! `[body.NAME]`: rigid bodies as they are written.

use nalgebra::{Matrix3, Vector3};

use super::inertia_key::Inertia;
use super::orientation::Orientation;
use super::rigid::RigidBody;
use super::shape_key::{Shaped, Solid};
use crate::model::entry::{Entry, all};
use crate::model::fault::Read;
use crate::model::fields::{Keys, List, Map, Number, Place, Turn};
use crate::model::geometry::{Vec3, subtract};
use crate::model::key::Shape;

/// A rigid body as it is written.
#[derive(Clone, Debug, PartialEq, Keys)]
#[table("a body")]
pub struct Body {
    /// mass
    #[key(unit = "kg", default = "that of the shape by its density")]
    pub mass: Option<Number>,
    /// about the centre of mass in body axes: [Ixx, Iyy, Izz], with the products behind them as entries of the tensor,
    /// [.., Ixy, Ixz, Iyz] with Ixy = −∫ x y dm, or the tensor (3 × 3); one number in a planar model
    #[key(unit = "kg·m²", default = "that of the shape")]
    pub inertia: Option<Inertia>,
    /// false lets a principal moment exceed the sum of the others, which is noted
    #[key(default = "true")]
    pub check_inertia: Option<bool>,
    /// a shape of uniform density, for mass, inertia and picture
    #[key(unit = "m", default = "none: mass and inertia are needed")]
    pub shape: Option<Solid>,
    /// of the shape, instead of a mass; of a rod in kg/m
    #[key(unit = "kg/m³", default = "none")]
    pub density: Option<Number>,
    /// centre of mass in body axes; position, velocity and points are then those of the origin of these axes, and counted from there
    #[key(unit = "m", default = "the origin of the body axes", shape = Shape::Vector)]
    pub com: Option<List<Number>>,
    /// of the centre of mass, or with `com` of the origin of the body axes, at the start; or the name of a point, or of a body or a place
    /// of one, where that is
    #[key(unit = "m")]
    pub position: Place,
    /// of the body's axes, at the start
    #[key(default = "that of the model's axes")]
    pub orientation: Option<Orientation>,
    /// of the same place, at the start
    #[key(unit = "m/s", default = "0", shape = Shape::Vector)]
    pub velocity: Option<List<Number>>,
    /// in the axes of the model, at the start; one number in a planar model
    #[key(unit = "rad/s", default = "0")]
    pub angular_velocity: Option<Turn>,
    /// named places in body axes from the centre of mass, or with `com` from the origin of these axes, used as "NAME.POINT"
    #[key(unit = "m", default = "none")]
    pub points: Option<Map<List<Number>>>,
    /// named directions in body axes, used as "NAME.AXIS"
    #[key(unit = "any", default = "none")]
    pub axes: Option<Map<List<Number>>>,
}

impl Body {
    /// The body at the start, at the origin where its place has a name; of a mesh that is not at its centre of mass, `position` is that of the
    /// centre all the same.
    pub(in crate::model) fn evaluate(&self, entry: &Entry<'_>, dim: usize) -> Read<RigidBody> {
        let vector = |list: &List<Number>, entry: &Entry<'_>, key: &str| list.vector(entry, key, dim);
        let mass = entry.optional("mass", &self.mass, Number::positive);
        let density = entry.optional("density", &self.density, Number::positive);
        let inertia = entry
            .optional("inertia", &self.inertia, |inertia, entry, key| inertia.tensor(entry, key, dim, self.check_inertia != Some(false)));
        let shape = entry.optional("shape", &self.shape, |solid, entry, key| entry.within(key, solid, |entry| solid.evaluate(entry, dim)));
        let com = entry.optional("com", &self.com, vector);
        let position = match &self.position {
            Place::Fixed(numbers) => numbers.vector(entry, "position", dim),
            Place::Named(_) => Ok([0.0; 3]),
        };
        let orientation = entry.optional("orientation", &self.orientation, |orientation, entry, key| {
            entry.within(key, orientation, |entry| {
                let rotation = orientation.rotation(entry, dim)?;
                Ok((rotation, if dim == 2 { orientation.radians(entry)? } else { 0.0 }))
            })
        });
        let velocity = entry.optional("velocity", &self.velocity, vector);
        let angular_velocity = entry.optional("angular_velocity", &self.angular_velocity, |turn, entry, key| turn.vector(entry, key, dim));
        let points = entry.optional("points", &self.points, |points, entry, key| vectors(entry, key, points, dim));
        let axes = entry.optional("axes", &self.axes, |axes, entry, key| vectors(entry, key, axes, dim));
        let (mass, density, inertia, shape, com) = (mass?, density?, inertia?, shape?, com?);
        let (mass, inertia) = substance(entry, dim, mass, density, inertia, shape.as_ref())?;
        let (world_from_body, turned) = orientation?.unwrap_or_else(|| (Matrix3::identity(), 0.0));
        let mut body = RigidBody {
            name: entry.name.to_string(),
            path: entry.path.to_string(),
            mass,
            inertia: world_from_body * inertia * world_from_body.transpose(),
            position: position?,
            world_from_body,
            turned,
            velocity: velocity?.unwrap_or_default(),
            angular_velocity: angular_velocity?.unwrap_or_default(),
            points: Vec::new(),
            axes: Vec::new(),
            shape: shape.map(|shaped| shaped.picture),
        };
        if let Some(com) = com {
            let centre = body.place(com);
            (body.velocity, body.position) = (body.velocity_at(centre), centre);
        }
        let from_centre = |local: Vec3| subtract(local, com.unwrap_or_default());
        body.points = points?.into_iter().flatten().map(|(name, local)| (name, body.place(from_centre(local)))).collect();
        body.axes = axes?.into_iter().flatten().map(|(name, local)| (name, body.direction(local))).collect();
        Ok(body)
    }
}

/// A table of named places or axes.
fn vectors(entry: &Entry<'_>, key: &str, named: &Map<List<Number>>, dim: usize) -> Read<Vec<(String, Vec3)>> {
    let each = |inner: &Entry<'_>, name: &str, numbers: &List<Number>| {
        if !name.chars().all(|c| c.is_alphanumeric() || c == '_' || c == '-') {
            return Err(inner.refuse_key(name, format!("\"{name}\" cannot be a name"), "use letters, digits, _ and -"));
        }
        let vector = numbers.vector(inner, name, dim)?;
        if key == "axes" && vector == [0.0; 3] {
            return Err(inner.refuse(name, "an axis of zero length has no direction", "give a direction"));
        }
        Ok((name.to_string(), vector))
    };
    entry.within(key, named, |inner| all(named.iter().map(|(name, numbers)| each(inner, name, numbers))))
}

/// Mass and inertia from what is given of mass, density, inertia and shape.
fn substance(
    entry: &Entry<'_>,
    dim: usize,
    mass: Option<f64>,
    density: Option<f64>,
    inertia: Option<Matrix3<f64>>,
    shape: Option<&Shaped>,
) -> Read<(f64, Matrix3<f64>)> {
    let mass = match (mass, density, shape) {
        (Some(_), Some(_), _) => return Err(entry.refuse_key("density", "`mass` and `density` exclude each other", "keep one of the two")),
        (Some(mass), None, _) => mass,
        (None, Some(density), Some(shaped)) => density * shaped.shape.volume(),
        (None, Some(_), None) => {
            return Err(entry.refuse_key("density", "a density needs a `shape`", "add shape = { box = [1, 1, 1] }, or give mass"));
        }
        (None, None, _) => {
            return Err(entry.refuse_all(format!("`{}` has no `mass`", entry.name), "add mass = …, or a shape with a density"));
        }
    };
    let inertia = match (inertia, shape) {
        (Some(inertia), _) => inertia,
        (None, Some(shaped)) => {
            let inertia = shaped.shape.properties(mass).inertia;
            let tensor = Matrix3::from_fn(|i, j| inertia[i][j]);
            if dim == 2 { Matrix3::from_diagonal(&Vector3::new(0.0, 0.0, tensor[(2, 2)])) } else { tensor }
        }
        (None, None) => {
            let cure = if dim == 2 { "add inertia = …, or a shape" } else { "add inertia = [Ixx, Iyy, Izz], or a shape" };
            return Err(entry.refuse_all(format!("`{}` has no `inertia`", entry.name), cure));
        }
    };
    if !(mass > 0.0 && mass.is_finite() && inertia.iter().all(|entry| entry.is_finite())) {
        let message = format!("`{}` has a mass of {mass} kg and moments of up to {} kg·m²", entry.name, inertia.amax());
        return Err(entry.refuse_all(message, "check the units: lengths are in m, densities in kg/m³"));
    }
    let gyration = (inertia.trace() / mass).sqrt();
    if gyration > 0.0 && !SIZES.contains(&gyration) {
        let message = format!("mass and inertia of `{}` are those of something of the size {gyration:.1e} m", entry.name);
        return Err(entry.refuse_all(message, "check the units: masses are in kg, moments of inertia in kg·m²"));
    }
    Ok((mass, inertia))
}

/// Radii of gyration of bodies that can be computed with, m: powers of them must be numbers.
const SIZES: std::ops::Range<f64> = 1e-30..1e30;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::{Field, Model, NoFiles, Table, Value};

    fn model(body: &Body, plane: Option<&str>) -> Model {
        let mut table: Table = [("body", Value::Table([("top", Field::write(body))].into_iter().collect()))].into_iter().collect();
        if let Some(plane) = plane {
            table.push("plane", Value::text(plane));
        }
        Model::from_value(&Value::Table(table), &NoFiles).unwrap_or_else(|faults| panic!("{faults}"))
    }

    #[test]
    fn a_body_made_of_structs_is_that_of_a_file() {
        let body = Body::new([0.0, 0.0, 1.0])
            .shape(Solid::cuboid([1.0, 2.0, 3.0]))
            .density("2*6")
            .orientation(Orientation::axis_angle_deg([0, 0, 2], 90))
            .velocity([1, 0, 0])
            .angular_velocity([0.0, 0.0, 4.0])
            .points([("tip", [0.5, 0.0, 0.0])]);
        let model = model(&body, None);
        let top = &model.bodies[0];
        assert!((top.mass - 72.0).abs() < 1e-12, "{}", top.mass);
        // A quarter turn exchanges the moments m (l² + l²)/12 about x and y.
        let moments = [60.0, 78.0, 30.0];
        assert!((0..3).all(|k| (top.inertia[(k, k)] - moments[k]).abs() < 1e-12), "{}", top.inertia);
        assert_eq!((top.velocity, top.angular_velocity), ([1.0, 0.0, 0.0], [0.0, 0.0, 4.0]));
    }

    #[test]
    fn inertia_and_orientation_may_be_written_in_each_way() {
        let tensor = [[2.0, 0.1, 0.2], [0.1, 3.0, 0.3], [0.2, 0.3, 4.0]];
        for inertia in [Inertia::from([2.0, 3.0, 4.0, 0.1, 0.2, 0.3]), Inertia::from(tensor)] {
            let top = &model(&Body::new([0, 0, 0]).mass(1).inertia(inertia), None).bodies[0];
            assert_eq!(top.inertia, Matrix3::from_fn(|i, j| tensor[i][j]));
        }
        let half = 0.5_f64.sqrt();
        for orientation in [
            Orientation::wxyz([half, half, 0.0, 0.0]),
            Orientation::xyzw([half, 0.0, 0.0, half]),
            Orientation::axis_angle([3, 0, 0], "pi/2"),
            Orientation::roll_pitch_yaw(["pi/2", "0", "0"]),
            Orientation::roll_pitch_yaw_deg([90, 0, 0]),
            Orientation::rows([[1, 0, 0], [0, 0, -1], [0, 1, 0]]),
        ] {
            let body = Body::new([0, 0, 0]).mass(1).inertia([2.0, 3.0, 4.0]).orientation(orientation.clone());
            let top = &model(&body, None).bodies[0];
            let moments = [2.0, 4.0, 3.0];
            assert!((0..3).all(|k| (top.inertia[(k, k)] - moments[k]).abs() < 1e-12), "{orientation:?}");
        }
        let planar = Body::new([0, 0]).mass(1).inertia(0.5).orientation(Orientation::in_plane_deg(30)).angular_velocity(2.0);
        let top = &model(&planar, Some("xz")).bodies[0];
        assert_eq!((top.inertia[(2, 2)], top.angular_velocity), (0.5, [0.0, 0.0, 2.0]));
    }

    #[test]
    fn what_stands_for_a_table_does_not_hide_what_else_is_wrong() {
        let body: Table =
            [("shape", Value::text("box")), ("orientation", Value::List(Vec::new())), ("mass", Value::Bool(true))].into_iter().collect();
        let body = Value::Table([("top", Value::Table(body))].into_iter().collect());
        let faults = Model::from_value(&Value::Table([("body", body)].into_iter().collect()), &NoFiles).err().expect("wrong").0;
        let paths: Vec<&str> = faults.iter().map(|fault| fault.path.as_str()).collect();
        assert_eq!(paths, ["body.top.mass", "body.top.shape", "body.top", "body.top.orientation"], "the third has no position");
    }
}
