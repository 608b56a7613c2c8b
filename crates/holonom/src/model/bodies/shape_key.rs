//! The shape of a body as it is written: `shape = { box = [1, 2, 3] }` and so on.

use std::sync::Arc;

use super::shape::Shape as Solid;
use crate::model::entry::Entry;
use crate::model::fault::{Read, Refused};
use crate::model::key::{Key, Shape};
use crate::model::value::Value;
use crate::record::SceneShape;

/// The keys of a shape; one of them is given.
pub const KEYS: &[Key] = &[
    Key::optional("box", Shape::Numbers(3, 3), "none", "m", "its edges along x, y and z"),
    Key::optional("cylinder", Shape::Numbers(2, 2), "none", "m", "radius and length; its axis is z"),
    Key::optional("sphere", Shape::Number, "none", "m", "its radius"),
    Key::optional("rod", Shape::Number, "none", "m", "length of a slender rod along x"),
    Key::optional(
        "capsule",
        Shape::Numbers(2, 2),
        "none",
        "m",
        "radius, and length of the cylinder between its half spheres; its axis is z",
    ),
    Key::optional("mesh", Shape::Text, "none", "", "file with a closed triangle mesh in m, STL or OBJ, beside the model file"),
];

/// A shape and how it is drawn.
pub struct Shaped {
    pub shape: Solid,
    pub picture: SceneShape,
}

/// Reads the shape of a body.
pub fn read(body: &Entry<'_>, dim: usize) -> Read<Shaped> {
    if !matches!(body.value("shape")?, Value::Table(_)) {
        return Err(body.refuse("shape", "a shape is a table with one key", "write shape = { box = [1, 1, 1] }, { sphere = 1 } and so on"));
    }
    let path = format!("{}.shape", body.path);
    let entry = Entry { name: body.name, path: &path, table: body.table("shape")?, ..*body };
    let before = entry.sink.count();
    entry.refuse_unknown_keys("a shape", &KEYS.iter().collect::<Vec<_>>());
    let names: Vec<&str> = KEYS.iter().map(|key| key.name).collect();
    let given: Vec<&str> = names.iter().copied().filter(|name| entry.has(name)).collect();
    let [kind] = given[..] else {
        return match given.len() {
            // What it says is under a name that is not known.
            0 if entry.sink.count() > before => Err(Refused),
            0 => Err(entry.refuse_all("this shape says nothing", format!("give one of {}", names.join(", ")))),
            _ => Err(entry.refuse_key(given[1], format!("`{}` and `{}` are two shapes", given[0], given[1]), "keep one of the two")),
        };
    };
    if let (Value::List(items), Some(key)) = (entry.value(kind)?, KEYS.iter().find(|key| key.name == kind))
        && let Shape::Numbers(wanted, _) = key.shape
        && items.len() != wanted
    {
        let message = format!("`{kind}` wants {wanted} numbers, and this has {}", items.len());
        return Err(entry.refuse(kind, message, format!("give {}", key.doc)));
    }
    let (shape, picture) = match kind {
        "box" => {
            let size = entry.sizes(kind)?;
            (Solid::Box { size }, SceneShape::Box { size })
        }
        "cylinder" => {
            let [radius, length] = entry.sizes(kind)?;
            (Solid::Cylinder { radius, length }, SceneShape::Cylinder { radius, length })
        }
        "sphere" => {
            let radius = entry.positive(kind)?;
            (Solid::Sphere { radius }, SceneShape::Sphere { radius })
        }
        "rod" => {
            let length = entry.positive(kind)?;
            (Solid::Rod { length }, SceneShape::Rod { length })
        }
        "capsule" => {
            let [radius, length] = entry.sizes(kind)?;
            (Solid::Capsule { radius, length }, SceneShape::Capsule { radius, length })
        }
        _ => mesh(&entry, dim)?,
    };
    Ok(Shaped { shape, picture })
}

fn mesh(entry: &Entry<'_>, dim: usize) -> Read<(Solid, SceneShape)> {
    if dim == 2 {
        return Err(entry.refuse_key("mesh", "a planar model has no meshes", "give mass and inertia, or another shape"));
    }
    let name = entry.text("mesh")?;
    let mesh = entry.meshes.mesh(name).map_err(|why| entry.refuse("mesh", why, "name an STL or OBJ file with a closed mesh, in metres"))?;
    if let Some(flaw) = mesh.flaw() {
        return Err(entry.refuse("mesh", flaw, "repair the mesh: it must be closed, with all triangles turned alike"));
    }
    let centre = mesh.properties(1.0).centre;
    let vertices = mesh.vertices.iter().map(|v| std::array::from_fn(|c| v[c] - centre[c])).collect();
    let picture = SceneShape::Mesh { vertices, triangles: mesh.triangles.clone() };
    Ok((Solid::Mesh(Arc::clone(&mesh)), picture))
}
