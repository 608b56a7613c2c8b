//! The connected surfaces of a mesh: one of them may be inside out only around a cavity.

use super::super::inertia::short;
use super::{FLAT, Frame, Mesh, tetrahedron};

/// A connected surface.
struct Shell {
    /// Volume inside in cubes of the frame's unit, negative when it is inside out.
    volume: f64,
    /// Least and largest coordinates, m.
    bounds: [[f64; 3]; 2],
}

impl Shell {
    /// Whether it could be around the other: as far as their boxes tell.
    fn could_hold(&self, other: &Shell) -> bool {
        (0..3).all(|i| self.bounds[0][i] <= other.bounds[0][i] && other.bounds[1][i] <= self.bounds[1][i])
    }
}

impl Mesh {
    /// In words, which shell is turned against the rest without being a cavity in it.
    pub(super) fn flaw_of_shells(&self, pairs: &[[u32; 2]], frame: &Frame, volume: f64) -> Option<String> {
        let (cavities, mut solids): (Vec<Shell>, Vec<Shell>) =
            self.shells(pairs, frame).into_iter().filter(|shell| shell.volume.abs() > FLAT).partition(|shell| shell.volume * volume < 0.0);
        // The largest is the likeliest to hold a cavity.
        solids.sort_by(|one, other| other.volume.abs().total_cmp(&one.volume.abs()));
        let stray = cavities.iter().find(|cavity| !solids.iter().any(|solid| solid.could_hold(cavity)))?;
        let [least, most] = stray.bounds.map(|place| place.map(short).join(", "));
        Some(format!("a part of the mesh, from ({least}) to ({most}), is inside out against the rest, and in none of it as a cavity"))
    }

    fn shells(&self, pairs: &[[u32; 2]], frame: &Frame) -> Vec<Shell> {
        let mut above: Vec<u32> = (0_u32..).take(self.triangles.len()).collect();
        for pair in pairs {
            let [one, other] = pair.map(|triangle| root(&mut above, triangle));
            above[one.max(other) as usize] = one.min(other);
        }
        let mut members: Vec<(u32, u32)> = (0_u32..).take(above.len()).map(|k| (root(&mut above, k), k)).collect();
        members.sort_unstable();
        let shell = |members: &[(u32, u32)]| {
            let triangles = || members.iter().map(|&(_, k)| &self.triangles[k as usize]);
            let volume = triangles().map(|triangle| tetrahedron(self.corners(triangle, frame))).sum();
            Shell { volume, bounds: self.bounds(triangles()) }
        };
        members.chunk_by(|one, other| one.0 == other.0).map(shell).collect()
    }
}

/// The first triangle of the shell of a triangle, halving the way there.
fn root(above: &mut [u32], mut triangle: u32) -> u32 {
    while above[triangle as usize] != triangle {
        above[triangle as usize] = above[above[triangle as usize] as usize];
        triangle = above[triangle as usize];
    }
    triangle
}
