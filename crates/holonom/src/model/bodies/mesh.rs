//! Closed triangle files: whether they are that, and their exact mass properties.

use super::inertia::short;
use super::shape::MassProperties;

mod shells;
#[cfg(test)]
mod tests;

/// Volume, in cubes of half the mesh's length, below which a mesh is flat: what rounding leaves of nothing.
const FLAT: f64 = 1e-13;

/// A surface of triangles around a solid, and around its cavities; solids that overlap count twice.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// Places (v × 3) in the axes of the shape, m.
    pub vertices: Vec<[f64; 3]>,
    /// Vertices (t × 3) of each triangle, anticlockwise as seen from outside.
    pub triangles: Vec<[u32; 3]>,
}

/// Integrals over the inside, in lengths of the frame from its origin.
#[derive(Clone, Copy, Default)]
struct Integrals {
    /// ∫ dV, negative when the mesh is inside out.
    volume: f64,
    /// ∫ x dV (3)
    first: [f64; 3],
    /// ∫ x xᵀ dV (3 × 3)
    second: [[f64; 3]; 3],
}

/// Where integrals are taken, so that they neither cancel nor overflow.
struct Frame {
    /// Middle of the mesh, m.
    origin: [f64; 3],
    /// Half its largest extent, m.
    unit: f64,
}

impl Mesh {
    /// In words, why the mesh encloses no solid. All that is asked of a mesh beside this needs one without flaw.
    pub fn flaw(&self) -> Option<String> {
        self.flaw_of_lists().or_else(|| self.flaw_of_surface())
    }

    /// Volume, m³.
    pub fn volume(&self) -> f64 {
        let frame = self.frame();
        self.integrals(&frame).volume.abs() * frame.unit.powi(3)
    }

    /// The same surface with its outside outside, if all of it was inside out.
    pub fn outward(mut self) -> Self {
        if self.integrals(&self.frame()).volume < 0.0 {
            self.triangles.iter_mut().for_each(|triangle| triangle.swap(1, 2));
        }
        self
    }

    /// What a mass, kg, is when it is spread evenly over the inside. It does not matter whether the mesh is inside out.
    pub fn properties(&self, mass: f64) -> MassProperties {
        let frame = self.frame();
        let Integrals { volume, first, second } = self.integrals(&frame);
        let centre = first.map(|moment| moment / volume);
        let about_centre = |i: usize, j: usize| mass * frame.unit * frame.unit * (second[i][j] / volume - centre[i] * centre[j]);
        let mut inertia = [[0.0; 3]; 3];
        for i in 0..3 {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            inertia[i][i] = about_centre(j, j) + about_centre(k, k);
            inertia[i][j] = -about_centre(i.min(j), i.max(j));
            inertia[j][i] = inertia[i][j];
        }
        MassProperties { mass, centre: std::array::from_fn(|i| frame.origin[i] + frame.unit * centre[i]), inertia }
    }

    fn flaw_of_lists(&self) -> Option<String> {
        let count = self.vertices.len();
        if self.triangles.is_empty() {
            return Some("the mesh has no triangles".into());
        }
        if let Some(k) = self.vertices.iter().position(|vertex| vertex.iter().any(|c| !c.is_finite())) {
            return Some(format!("a coordinate of vertex {k} is not a finite number"));
        }
        for (k, triangle) in self.triangles.iter().enumerate() {
            if let Some(vertex) = triangle.iter().find(|&&vertex| vertex as usize >= count) {
                return Some(format!("triangle {k} has vertex {vertex}, and there are {count} vertices from 0"));
            }
            let [a, b, c] = *triangle;
            if a == b || b == c || c == a {
                return Some(format!("triangle {k} has a vertex twice: {a}, {b}, {c}"));
            }
        }
        None
    }

    fn flaw_of_surface(&self) -> Option<String> {
        let pairs = match self.pairs() {
            Ok(pairs) => pairs,
            Err(flaw) => return Some(flaw),
        };
        let frame = self.frame();
        if !frame.unit.powi(5).is_normal() {
            return Some(format!("the mesh is {} m long, too small or too large for its volume to be a number", short(2.0 * frame.unit)));
        }
        let volume = self.integrals(&frame).volume;
        if volume.abs() <= FLAT {
            return Some("the mesh encloses no volume".into());
        }
        self.flaw_of_shells(&pairs, &frame, volume)
    }

    /// Pairs of triangles with an edge in common, when every edge has two that run along it in opposite directions.
    fn pairs(&self) -> Result<Vec<[u32; 2]>, String> {
        let mut edges = Vec::with_capacity(3 * self.triangles.len());
        for (k, &[a, b, c]) in (0_u32..).zip(&self.triangles) {
            edges.extend([(a, b), (b, c), (c, a)].map(|(from, to)| ([from.min(to), from.max(to)], from < to, k)));
        }
        edges.sort_unstable();
        let (mut single, mut crowded, mut against) = (Vec::new(), Vec::new(), Vec::new());
        let mut pairs = Vec::with_capacity(edges.len() / 2);
        for same in edges.chunk_by(|one, other| one.0 == other.0) {
            match *same {
                [(ends, ..)] => single.push(ends),
                [(ends, one, _), (_, other, _)] if one == other => against.push(ends),
                [(_, _, one), (_, _, other)] => pairs.push([one, other]),
                _ => crowded.push(same[0].0),
            }
        }
        for (edges, what, why) in [
            (single, "not closed", "one triangle only"),
            (crowded, "not the surface of a solid", "more than two triangles"),
            (against, "not oriented", "two triangles of which one is inside out"),
        ] {
            if let Some(&first) = edges.first() {
                let count = if edges.len() == 1 { "1 edge belongs".into() } else { format!("{} edges belong", edges.len()) };
                return Err(format!("the mesh is {what}: {count} to {why}, the first {}", self.edge_in_words(first)));
            }
        }
        Ok(pairs)
    }

    fn edge_in_words(&self, ends: [u32; 2]) -> String {
        let [from, to] = ends.map(|vertex| self.vertices[vertex as usize].map(short).join(", "));
        format!("from ({from}) to ({to})")
    }

    /// Least and largest coordinates of some triangles.
    fn bounds<'a>(&self, triangles: impl IntoIterator<Item = &'a [u32; 3]>) -> [[f64; 3]; 2] {
        let mut bounds = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
        for vertex in triangles.into_iter().flatten() {
            let place = self.vertices[*vertex as usize];
            for i in 0..3 {
                bounds[0][i] = bounds[0][i].min(place[i]);
                bounds[1][i] = bounds[1][i].max(place[i]);
            }
        }
        bounds
    }

    fn frame(&self) -> Frame {
        let [least, most] = self.bounds(&self.triangles);
        let half: [f64; 3] = std::array::from_fn(|i| 0.5 * most[i] - 0.5 * least[i]);
        let unit = half.into_iter().fold(0.0, f64::max);
        Frame { origin: std::array::from_fn(|i| least[i] + half[i]), unit: if unit > 0.0 { unit } else { 1.0 } }
    }

    /// Corners of a triangle in lengths of the frame from its origin.
    fn corners(&self, triangle: &[u32; 3], frame: &Frame) -> [[f64; 3]; 3] {
        triangle.map(|vertex| {
            let place = self.vertices[vertex as usize];
            std::array::from_fn(|i| (place[i] - frame.origin[i]) / frame.unit)
        })
    }

    /// Sums over the tetrahedra between the origin of the frame and each triangle, which is the divergence theorem for
    /// polynomials: over one with corners 0, a, b, c and s = a + b + c, ∫x dV = V s/4 and
    /// ∫x xᵀ dV = V/20 (s sᵀ + a aᵀ + b bᵀ + c cᵀ) (Tonon, J. Math. Stat. 1, 2005, 8–11).
    fn integrals(&self, frame: &Frame) -> Integrals {
        let mut sum = Integrals::default();
        for triangle in &self.triangles {
            let [a, b, c] = self.corners(triangle, frame);
            let volume = tetrahedron([a, b, c]);
            let s: [f64; 3] = std::array::from_fn(|i| a[i] + b[i] + c[i]);
            sum.volume += volume;
            for i in 0..3 {
                sum.first[i] += volume / 4.0 * s[i];
                for j in i..3 {
                    sum.second[i][j] += volume / 20.0 * (s[i] * s[j] + a[i] * a[j] + b[i] * b[j] + c[i] * c[j]);
                }
            }
        }
        sum
    }
}

/// Volume of the tetrahedron between the origin and a triangle, positive when the origin is behind it.
fn tetrahedron([a, b, c]: [[f64; 3]; 3]) -> f64 {
    let cross = [b[1] * c[2] - b[2] * c[1], b[2] * c[0] - b[0] * c[2], b[0] * c[1] - b[1] * c[0]];
    (a[0] * cross[0] + a[1] * cross[1] + a[2] * cross[2]) / 6.0
}
