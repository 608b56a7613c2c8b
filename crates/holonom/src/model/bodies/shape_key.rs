//! The shape of a body as it is written: `shape = { box = [1, 2, 3] }` and so on.

use std::sync::Arc;

use super::shape::Shape as Evaluated;
use crate::model::entry::{Entry, Spot, Written};
use crate::model::fault::{Read, Refused};
use crate::model::fields::{Keys, List, Number};
use crate::model::key::{Key, Shape};
use crate::model::value::Value;
use crate::record::SceneShape;

/// The shape of a body, of uniform density; one of its keys is given.
#[derive(Clone, Debug, PartialEq, Keys)]
#[table("a shape", refuse_bare)]
pub struct Solid {
    /// its edges along x, y and z
    #[key(name = "box", unit = "m", default = "none", shape = Shape::Numbers(3, 3))]
    pub box_edges: Option<List<Number>>,
    /// radius and length; its axis is z
    #[key(name = "cylinder", unit = "m", default = "none", shape = Shape::Numbers(2, 2))]
    pub cylinder_size: Option<List<Number>>,
    /// its radius
    #[key(name = "sphere", unit = "m", default = "none")]
    pub sphere_radius: Option<Number>,
    /// length of a slender rod along x
    #[key(name = "rod", unit = "m", default = "none")]
    pub rod_length: Option<Number>,
    /// radius, and length of the cylinder between its half spheres; its axis is z
    #[key(name = "capsule", unit = "m", default = "none", shape = Shape::Numbers(2, 2))]
    pub capsule_size: Option<List<Number>>,
    /// file with a closed triangle mesh in m, STL or OBJ, beside the model file
    #[key(name = "mesh", default = "none")]
    pub mesh_file: Option<String>,
}

/// A shape and how it is drawn.
pub struct Shaped {
    pub shape: Evaluated,
    pub picture: SceneShape,
}

impl Solid {
    /// A box of these edges along x, y and z, m.
    pub fn cuboid(edges: [impl Into<Number>; 3]) -> Self {
        Self::new().box_edges(edges)
    }

    /// A cylinder about z, m.
    pub fn cylinder(radius: impl Into<Number>, length: impl Into<Number>) -> Self {
        Self::new().cylinder_size([radius.into(), length.into()])
    }

    /// A sphere, m.
    pub fn sphere(radius: impl Into<Number>) -> Self {
        Self::new().sphere_radius(radius)
    }

    /// A slender rod along x, m.
    pub fn rod(length: impl Into<Number>) -> Self {
        Self::new().rod_length(length)
    }

    /// A cylinder about z between two half spheres, which its length, m, does not count.
    pub fn capsule(radius: impl Into<Number>, length: impl Into<Number>) -> Self {
        Self::new().capsule_size([radius.into(), length.into()])
    }

    /// What a closed triangle mesh encloses; `file` is an STL or OBJ file beside the model file, in m.
    pub fn mesh(file: impl Into<String>) -> Self {
        Self::new().mesh_file(file)
    }

    /// The shape with its lengths; `entry` is its table.
    pub(super) fn evaluate(&self, entry: &Entry<'_>, dim: usize) -> Read<Shaped> {
        let given: Vec<&str> = names().filter(|name| self.value(name).is_some()).collect();
        if let [first, second, ..] = given[..] {
            return Err(entry.refuse_key(second, format!("`{first}` and `{second}` are two shapes"), "keep one of the two"));
        }
        let (shape, picture) = match self {
            Self { box_edges: Some(edges), .. } => {
                let size = sizes(entry, "box", edges)?;
                (Evaluated::Box { size }, SceneShape::Box { size })
            }
            Self { cylinder_size: Some(size), .. } => {
                let [radius, length] = sizes(entry, "cylinder", size)?;
                (Evaluated::Cylinder { radius, length }, SceneShape::Cylinder { radius, length })
            }
            Self { sphere_radius: Some(radius), .. } => {
                let radius = radius.positive(entry, "sphere")?;
                (Evaluated::Sphere { radius }, SceneShape::Sphere { radius })
            }
            Self { rod_length: Some(length), .. } => {
                let length = length.positive(entry, "rod")?;
                (Evaluated::Rod { length }, SceneShape::Rod { length })
            }
            Self { capsule_size: Some(size), .. } => {
                let [radius, length] = sizes(entry, "capsule", size)?;
                (Evaluated::Capsule { radius, length }, SceneShape::Capsule { radius, length })
            }
            Self { mesh_file: Some(file), .. } => mesh(entry, file, dim)?,
            // What it says is under a name that is not known, which has been told.
            _ if entry.has_fault() => return Err(Refused),
            _ => {
                let cure = format!("give one of {}", names().collect::<Vec<_>>().join(", "));
                return Err(entry.refuse_all("this shape says nothing", cure));
            }
        };
        Ok(Shaped { shape, picture })
    }
}

fn refuse_bare(entry: &Entry<'_>, spot: Spot<'_>, _value: &Value) -> Refused {
    entry.refuse(spot, "a shape is a table with one key", "write shape = { box = [1, 1, 1] }, { sphere = 1 } and so on")
}

fn names() -> impl Iterator<Item = &'static str> {
    Solid::KEYS.iter().map(|key| key.name)
}

/// The lengths at a key, whose documentation says which they are.
fn sizes<const N: usize>(entry: &Entry<'_>, name: &str, lengths: &List<Number>) -> Read<[f64; N]> {
    if let Some(Key { doc, .. }) = Solid::KEYS.iter().find(|key| key.name == name && lengths.len() != N) {
        return Err(entry.refuse(name, format!("`{name}` wants {N} numbers, and this has {}", lengths.len()), format!("give {doc}")));
    }
    lengths.sizes(entry, name)
}

fn mesh(entry: &Entry<'_>, file: &str, dim: usize) -> Read<(Evaluated, SceneShape)> {
    if dim == 2 {
        return Err(entry.refuse_key("mesh", "a planar model has no meshes", "give mass and inertia, or another shape"));
    }
    let mesh = entry.files.mesh(file).map_err(|why| entry.refuse("mesh", why, "name an STL or OBJ file with a closed mesh, in metres"))?;
    if let Some(flaw) = mesh.flaw() {
        return Err(entry.refuse("mesh", flaw, "repair the mesh: it must be closed, with all triangles turned alike"));
    }
    let centre = mesh.properties(1.0).centre;
    let vertices = mesh.vertices.iter().map(|v| std::array::from_fn(|c| v[c] - centre[c])).collect();
    let picture = SceneShape::Mesh { vertices, triangles: mesh.triangles.clone() };
    Ok((Evaluated::Mesh(Arc::clone(&mesh)), picture))
}
