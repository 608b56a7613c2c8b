//! `[body.NAME]`: rigid bodies as they are written.

use nalgebra::{Matrix3, Vector3};

use super::inertia;
use super::orientation;
use super::shape_key::{self, Shaped};
use crate::model::entry::{Entry, Spot, all};
use crate::model::fault::{Read, Refused};
use crate::model::geometry::{Vec3, add};
use crate::model::key::{Key, REPEAT, Shape};
use crate::model::value::Value;
use crate::record::SceneShape;

/// The keys of a body.
pub const KEYS: &[Key] = &[
    Key::optional("mass", Shape::Number, "that of the shape by its density", "kg", "mass"),
    Key::optional(
        "inertia",
        Shape::Inertia,
        "that of the shape",
        "kg·m²",
        "about the centre of mass in body axes: [Ixx, Iyy, Izz], with the products behind them as entries of the tensor, \
         [.., Ixy, Ixz, Iyz] with Ixy = −∫ x y dm, or the tensor (3 × 3); one number in a planar model",
    ),
    Key::optional(
        "shape",
        Shape::Table(shape_key::KEYS),
        "none: mass and inertia are needed",
        "m",
        "a shape of uniform density, for mass, inertia and picture",
    ),
    Key::optional("density", Shape::Number, "none", "kg/m³", "of the shape, instead of a mass; of a rod in kg/m"),
    Key::required("position", Shape::Vector, "m", "of the centre of mass, at the start"),
    Key::optional("orientation", Shape::Table(orientation::KEYS), "that of the model's axes", "", "of the body's axes, at the start"),
    Key::optional("velocity", Shape::Vector, "0", "m/s", "of the centre of mass, at the start"),
    Key::optional("angular_velocity", Shape::Spin, "0", "rad/s", "in the axes of the model, at the start; one number in a planar model"),
    Key::optional("points", Shape::Places, "none", "m", "named places in body axes from the centre of mass, used as \"NAME.POINT\""),
    Key::optional("axes", Shape::Places, "none", "any", "named directions in body axes, used as \"NAME.AXIS\""),
    REPEAT,
];

/// A rigid body at the start.
#[derive(Clone, Debug)]
pub struct Body {
    pub name: String,
    /// Where it is in the description.
    pub path: String,
    /// kg
    pub mass: f64,
    /// Inertia tensor about the centre of mass in the axes of the model, kg·m².
    pub inertia: Matrix3<f64>,
    /// Of the centre of mass, m.
    pub position: Vec3,
    /// From body axes to those of the model.
    pub world_from_body: Matrix3<f64>,
    /// m/s
    pub velocity: Vec3,
    /// In the axes of the model, rad/s; in the plane its last number.
    pub angular_velocity: Vec3,
    /// Named places: where they are at the start.
    pub points: Vec<(String, Vec3)>,
    /// Named directions at the start.
    pub axes: Vec<(String, Vec3)>,
    pub shape: Option<SceneShape>,
}

impl Body {
    /// Where a place in body axes is at the start.
    pub fn place(&self, local: Vec3) -> Vec3 {
        add(self.position, self.direction(local))
    }

    /// A direction in body axes at the start.
    pub fn direction(&self, local: Vec3) -> Vec3 {
        (self.world_from_body * Vector3::from(local)).into()
    }

    /// A place at the start in body axes.
    pub fn local(&self, place: Vec3) -> Vec3 {
        (self.world_from_body.transpose() * (Vector3::from(place) - Vector3::from(self.position))).into()
    }

    /// A direction at the start in body axes.
    pub fn local_direction(&self, direction: Vec3) -> Vec3 {
        (self.world_from_body.transpose() * Vector3::from(direction)).into()
    }

    /// Velocity at the start of the place that is at `place`, m/s.
    pub fn velocity_at(&self, place: Vec3) -> Vec3 {
        let arm = Vector3::from(place) - Vector3::from(self.position);
        (Vector3::from(self.velocity) + Vector3::from(self.angular_velocity).cross(&arm)).into()
    }

    /// Rate of a direction of the body at the start.
    pub fn rate_of(&self, direction: Vec3) -> Vec3 {
        Vector3::from(self.angular_velocity).cross(&Vector3::from(direction)).into()
    }
}

/// Reads a body; of a mesh that is not at its centre of mass, `position` is that of the centre all the same.
pub fn body(entry: &Entry<'_>, dim: usize) -> Read<Body> {
    let mass = entry.optional("mass", Entry::positive);
    let density = entry.optional("density", Entry::positive);
    let inertia = entry.optional("inertia", |entry, key| tensor(entry, key, dim));
    let shape = entry.optional("shape", |entry, _| shape_key::read(entry, dim));
    let position = entry.vector("position", dim);
    let orientation = entry.optional("orientation", |entry, _| orientation::read(entry, dim));
    let velocity = entry.optional("velocity", |entry, key| entry.vector(key, dim));
    let angular_velocity = entry.optional("angular_velocity", |entry, key| entry.spin(key, dim));
    let points = places(entry, "points", dim);
    let axes = places(entry, "axes", dim);
    let (mass, density, inertia, shape) = (mass?, density?, inertia?, shape?);
    let (mass, inertia) = substance(entry, dim, mass, density, inertia, shape.as_ref())?;
    let world_from_body = orientation?.unwrap_or_else(Matrix3::identity);
    let mut body = Body {
        name: entry.name.to_string(),
        path: entry.path.to_string(),
        mass,
        inertia: world_from_body * inertia * world_from_body.transpose(),
        position: position?,
        world_from_body,
        velocity: velocity?.unwrap_or_default(),
        angular_velocity: angular_velocity?.unwrap_or_default(),
        points: Vec::new(),
        axes: Vec::new(),
        shape: shape.map(|shaped| shaped.picture),
    };
    body.points = points?.into_iter().map(|(name, local)| (name, body.place(local))).collect();
    body.axes = axes?.into_iter().map(|(name, local)| (name, body.direction(local))).collect();
    Ok(body)
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

/// The inertia tensor at a key, which must be one that a body can have.
fn tensor(entry: &Entry<'_>, key: &str, dim: usize) -> Read<Matrix3<f64>> {
    if dim == 2 {
        if let Value::List(_) = entry.value(key)? {
            return Err(entry.refuse(
                key,
                "a planar model has one moment of inertia",
                format!("write {key} = …, about the normal of the plane"),
            ));
        }
        let polar = entry.positive(key)?;
        return Ok(Matrix3::from_diagonal(&Vector3::new(0.0, 0.0, polar)));
    }
    if let Value::Number(_) | Value::Text(_) = entry.value(key)? {
        let cure = format!("write {key} = [Ixx, Iyy, Izz], or with the products behind them [.., Ixy, Ixz, Iyz]");
        return Err(entry.refuse(key, "a body in space has three moments of inertia, and this is one", cure));
    }
    let items = entry.list(key)?;
    let number = |(k, item): (usize, &Value)| entry.number_in(Spot { key, item: Some(k) }, item);
    let tensor = match items.len() {
        3 if items.iter().all(|item| matches!(item, Value::List(_))) => {
            let row = |(k, item): (usize, &Value)| match item {
                Value::List(numbers) if numbers.len() == 3 => {
                    all(numbers.iter().map(|number| entry.number_in(Spot { key, item: Some(k) }, number)))
                }
                _ => Err(entry.refuse(
                    Spot { key, item: Some(k) },
                    "a row of the inertia tensor has three numbers",
                    "write three rows of three numbers",
                )),
            };
            let rows = all(items.iter().enumerate().map(row))?;
            [0, 1, 2].map(|i| [0, 1, 2].map(|j| rows[i][j]))
        }
        3 | 6 => {
            let n = all(items.iter().enumerate().map(number))?;
            let product = |k: usize| n.get(k).copied().unwrap_or(0.0);
            [[n[0], product(3), product(4)], [product(3), n[1], product(5)], [product(4), product(5), n[2]]]
        }
        other => {
            let message = format!("`{key}` has 3 or 6 numbers or is 3 × 3, and this has {other}");
            return Err(entry.refuse(key, message, "write [Ixx, Iyy, Izz], or with the products behind them [.., Ixy, Ixz, Iyz]"));
        }
    };
    match inertia::check(tensor) {
        Ok(()) => Ok(Matrix3::from_fn(|i, j| tensor[i][j])),
        Err(why) => {
            let symmetric = (0..3).all(|i| tensor[i][(i + 1) % 3] == tensor[(i + 1) % 3][i]);
            Err(entry.refuse(
                key,
                why,
                if symmetric { CURE } else { "a tensor of inertia is symmetric: write the same number at both places" },
            ))
        }
    }
}

const CURE: &str = "check the units and that it is about the centre of mass; each principal moment is at most the sum of the other two";

/// A table of named vectors.
fn places(entry: &Entry<'_>, key: &str, dim: usize) -> Read<Vec<(String, Vec3)>> {
    let Some(table) = entry.optional(key, Entry::table)? else { return Ok(Vec::new()) };
    let path = format!("{}.{key}", entry.path);
    let inner = Entry { name: entry.name, path: &path, table, ..*entry };
    let place = |name: &str| -> Read<(String, Vec3)> {
        if !name.chars().all(|c| c.is_alphanumeric() || c == '_' || c == '-') {
            return Err::<_, Refused>(inner.refuse_key(name, format!("\"{name}\" cannot be a name"), "use letters, digits, _ and -"));
        }
        let vector = inner.vector(name, dim)?;
        if key == "axes" && vector == [0.0; 3] {
            return Err(inner.refuse(name, "an axis of zero length has no direction", "give a direction"));
        }
        Ok((name.to_string(), vector))
    };
    all(table.keys().map(place))
}
