//! Vertices that lie at the same place become one.

use std::collections::HashMap;

use holonom::model::Mesh;

use super::Soup;

/// Part of the mesh's size below which two vertices are one: far below an f32's digits and above a rotation's round-off.
const TOGETHER: f64 = 1e-9;

/// Cells of the grid in which vertices are looked up, in distances that are welded: most vertices need one cell, and a cell
/// holds few.
const CELL: f64 = 4.0;

/// No vertex.
const NONE: u32 = u32::MAX;

type Cell = [i64; 3];

/// Vertices so far, and in which cell they lie.
struct Grid {
    vertices: Vec<[f64; 3]>,
    /// Least coordinates of the mesh, m.
    origin: [f64; 3],
    /// Largest difference of coordinates that is welded, m.
    together: f64,
    /// Last vertex of a cell.
    last: HashMap<Cell, u32>,
    /// The vertex before each in its cell, or [`NONE`].
    before: Vec<u32>,
}

impl Grid {
    /// For the vertices of a soup.
    fn over(soup: &Soup) -> Self {
        let (mut least, mut size) = ([0.0; 3], 0.0_f64);
        for i in 0..3 {
            let used = || soup.triangles.iter().flatten().map(|&vertex| soup.vertices[vertex as usize][i]);
            least[i] = used().fold(f64::INFINITY, f64::min);
            size = size.max(used().fold(f64::NEG_INFINITY, f64::max) - least[i]);
        }
        Self { vertices: Vec::new(), origin: least, together: TOGETHER * size, last: HashMap::new(), before: Vec::new() }
    }

    /// The cell of a place. In a mesh of no size all is one cell.
    fn cell(&self, place: [f64; 3]) -> Cell {
        std::array::from_fn(|i| ((place[i] - self.origin[i]) / (CELL * self.together)).floor() as i64)
    }

    fn find(&self, place: [f64; 3]) -> Option<u32> {
        let [low, high] = [-self.together, self.together].map(|shift| self.cell(place.map(|c| c + shift)));
        for x in low[0]..=high[0] {
            for y in low[1]..=high[1] {
                for z in low[2]..=high[2] {
                    let mut vertex = self.last.get(&[x, y, z]).copied().unwrap_or(NONE);
                    while vertex != NONE {
                        let other = self.vertices[vertex as usize];
                        if (0..3).all(|i| (other[i] - place[i]).abs() <= self.together) {
                            return Some(vertex);
                        }
                        vertex = self.before[vertex as usize];
                    }
                }
            }
        }
        None
    }

    /// The vertex at a place, a new one if none is near.
    fn vertex(&mut self, place: [f64; 3]) -> u32 {
        self.find(place).unwrap_or_else(|| {
            let vertex = self.vertices.len() as u32;
            self.vertices.push(place);
            self.before.push(self.last.insert(self.cell(place), vertex).unwrap_or(NONE));
            vertex
        })
    }
}

/// The mesh of a soup, without vertices that no triangle uses and without triangles of fewer than three corners.
pub(super) fn weld(soup: &Soup) -> Mesh {
    let mut grid = Grid::over(soup);
    let mut welded = vec![NONE; soup.vertices.len()];
    let mut triangles = Vec::with_capacity(soup.triangles.len());
    for triangle in &soup.triangles {
        let [a, b, c] = triangle.map(|vertex| {
            let vertex = vertex as usize;
            if welded[vertex] == NONE {
                welded[vertex] = grid.vertex(soup.vertices[vertex]);
            }
            welded[vertex]
        });
        if a != b && b != c && c != a {
            triangles.push([a, b, c]);
        }
    }
    Mesh { vertices: grid.vertices, triangles }
}
