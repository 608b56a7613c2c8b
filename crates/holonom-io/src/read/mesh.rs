//! Triangle meshes from the bytes of STL and OBJ files.
//!
//! Both formats are a list of numbers with words between, and are read here: the readers that were tried drop all solids of an
//! STL file but the first, refuse facets whose useless normal is no number, or panic on a face that names no texture.

mod obj;
mod stl;
#[cfg(test)]
mod tests;
mod weld;

use holonom::model::Mesh;
use thiserror::Error;

/// Largest mesh file that is read, bytes: 400 000 triangles of a binary STL file.
pub const LARGEST_MESH: usize = 20 * 1024 * 1024;

/// Most triangles that are read: polygons make many out of few bytes.
pub const MOST_TRIANGLES: usize = 1_000_000;

/// Largest coordinate, m: cubes and fifth powers of lengths must be numbers.
const FARTHEST: f64 = 1e50;

/// Why bytes are no mesh.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
pub enum MeshError {
    /// A name that does not say how to read the file.
    #[error("`{name}` ends in neither .stl nor .obj, and other meshes are not read")]
    Ending {
        /// The name of the file.
        name: String,
    },
    /// Nothing but blanks, or not even these.
    #[error("the file is empty")]
    Empty,
    /// More bytes than [`LARGEST_MESH`].
    #[error("the file has {bytes} bytes, and at most {} MB are read", LARGEST_MESH / (1024 * 1024))]
    TooLarge {
        /// How many it has.
        bytes: usize,
    },
    /// More triangles than [`MOST_TRIANGLES`].
    #[error("the mesh has more than {MOST_TRIANGLES} triangles")]
    TooMany,
    /// Something every mesh of its format has is missing.
    #[error("the file is no mesh: {missing}")]
    NotMesh {
        /// What it lacks, in words.
        missing: &'static str,
    },
    /// A binary STL file that is shorter than its header says.
    #[error("the file is truncated, or no STL file: as a binary one it announces {announced} triangles and has {found}")]
    Truncated {
        /// Triangles, by the number in its header.
        announced: u32,
        /// Whole triangles that its length has room for.
        found: usize,
    },
    /// An ASCII STL file that ends too early.
    #[error("the file is truncated: it ends within {within}")]
    Unfinished {
        /// What is not closed.
        within: &'static str,
    },
    /// A line that does not follow from those before.
    #[error("line {line}: `{found}` stands where {expected} is expected")]
    Unexpected {
        /// Counted from 1.
        line: usize,
        /// The start of what stands there, with control characters escaped.
        found: String,
        /// What would be right, in words.
        expected: &'static str,
    },
    /// A face of an OBJ file with a vertex that there is not.
    #[error("line {line}: the face names vertex {vertex}, and {vertices} vertices are above it")]
    NoVertex {
        /// Counted from 1.
        line: usize,
        /// As it is written: from 1 on, or negative from the last one back.
        vertex: i64,
        /// How many there are so far.
        vertices: usize,
    },
    /// A triangle of a binary STL file that is not finite, or far too large.
    #[error("triangle {triangle} has a coordinate that is no number below {FARTHEST:e} m")]
    NoNumber {
        /// Its place in the file, counted from 1.
        triangle: usize,
    },
}

/// What a file says before its vertices are welded.
#[derive(Default)]
struct Soup {
    /// Places (v × 3), m.
    vertices: Vec<[f64; 3]>,
    /// Vertices (t × 3) of each triangle.
    triangles: Vec<[u32; 3]>,
}

impl Soup {
    /// Adds a triangle of vertices that are there.
    fn add(&mut self, triangle: [u32; 3]) -> Result<(), MeshError> {
        if self.triangles.len() == MOST_TRIANGLES {
            return Err(MeshError::TooMany);
        }
        self.triangles.push(triangle);
        Ok(())
    }

    /// Adds a triangle with vertices of its own.
    fn add_corners(&mut self, corners: [[f64; 3]; 3]) -> Result<(), MeshError> {
        let first = self.vertices.len() as u32;
        self.add([first, first + 1, first + 2])?;
        self.vertices.extend(corners);
        Ok(())
    }
}

/// Reads a mesh from the bytes of a file, whose name says which format it has: `.stl` (binary or ASCII) or `.obj` (vertices and
/// faces; polygons become fans of triangles). Coordinates are taken as m. Vertices closer than 1e-9 of the mesh are one,
/// triangles that this leaves without three corners are dropped, and a mesh that is inside out is turned.
///
/// Whether the mesh encloses a solid is for [`Mesh::flaw`].
///
/// # Errors
/// When the bytes are no such mesh.
pub fn read_mesh(name: &str, bytes: &[u8]) -> Result<Mesh, MeshError> {
    let read = match name.rsplit_once('.').map(|(_, ending)| ending.to_ascii_lowercase()).as_deref() {
        Some("stl") => stl::read,
        Some("obj") => obj::read,
        _ => return Err(MeshError::Ending { name: name.into() }),
    };
    if bytes.len() > LARGEST_MESH {
        return Err(MeshError::TooLarge { bytes: bytes.len() });
    }
    if bytes.trim_ascii().is_empty() {
        return Err(MeshError::Empty);
    }
    Ok(weld::weld(&read(bytes)?).outward())
}

/// Three coordinates at the start of some words, m.
fn coordinates<'a>(words: &mut impl Iterator<Item = &'a str>, line: usize) -> Result<[f64; 3], MeshError> {
    let mut place = [0.0; 3];
    for coordinate in &mut place {
        let word = words.next().unwrap_or("");
        *coordinate = word.parse().ok().filter(|&number| sound(number)).ok_or_else(|| unexpected(line, word, "a coordinate"))?;
    }
    Ok(place)
}

fn sound(coordinate: f64) -> bool {
    coordinate.abs() < FARTHEST
}

/// The start of what stands on a line, without what would disturb a terminal.
fn unexpected(line: usize, found: &str, expected: &'static str) -> MeshError {
    let found = match found {
        "" => "nothing".into(),
        _ => found.chars().take(40).flat_map(char::escape_debug).collect(),
    };
    MeshError::Unexpected { line, found, expected }
}
