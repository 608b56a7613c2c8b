//! Files against the formulas of the solids they stand for, and what is told of broken ones.

use std::collections::HashMap;
use std::f64::consts::PI;
use std::sync::Arc;

use super::super::inertia;
use super::super::shape::Shape;
use super::*;

/// Faces of a box by the bits of its corners' numbers: x is bit 0.
const FACES: [[u32; 4]; 6] = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];

fn cuboid(size: [f64; 3], centre: [f64; 3]) -> Mesh {
    let corner = |k: u32| std::array::from_fn(|i| centre[i] + size[i] * if k >> i & 1 == 1 { 0.5 } else { -0.5 });
    let triangles = FACES.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    Mesh { vertices: (0..8).map(corner).collect(), triangles }
}

fn flipped(mut mesh: Mesh) -> Mesh {
    mesh.triangles.iter_mut().for_each(|triangle| triangle.swap(0, 1));
    mesh
}

fn joined(mut mesh: Mesh, other: Mesh) -> Mesh {
    let shift = mesh.vertices.len() as u32;
    mesh.vertices.extend(other.vertices);
    mesh.triangles.extend(other.triangles.into_iter().map(|triangle| triangle.map(|vertex| vertex + shift)));
    mesh
}

fn unit(v: [f64; 3]) -> [f64; 3] {
    let length = v.iter().map(|c| c * c).sum::<f64>().sqrt();
    v.map(|c| c / length)
}

/// An octahedron whose triangles are halved along every edge, with vertices on the unit sphere.
fn sphere(levels: u32) -> Mesh {
    let vertices = vec![[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [-1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, -1.0]];
    let triangles = vec![[0, 1, 2], [1, 3, 2], [3, 4, 2], [4, 0, 2], [1, 0, 5], [3, 1, 5], [4, 3, 5], [0, 4, 5]];
    let mut mesh = Mesh { vertices, triangles };
    for _ in 0..levels {
        let Mesh { mut vertices, triangles } = mesh;
        let mut middles = HashMap::new();
        let mut middle = |a: u32, b: u32| {
            *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
                let (a, b) = (vertices[a as usize], vertices[b as usize]);
                vertices.push(unit(std::array::from_fn(|i| a[i] + b[i])));
                vertices.len() as u32 - 1
            })
        };
        let finer = triangles.iter().flat_map(|&[a, b, c]| {
            let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
            [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
        });
        let triangles = finer.collect();
        mesh = Mesh { vertices, triangles };
    }
    mesh
}

fn near(found: &MassProperties, expected: &MassProperties, tolerance: f64) {
    assert_eq!(found.mass, expected.mass);
    let largest = expected.inertia.as_flattened().iter().fold(0.0_f64, |largest, entry| entry.abs().max(largest));
    for (found, expected) in found.inertia.as_flattened().iter().zip(expected.inertia.as_flattened()) {
        assert!((found - expected).abs() <= tolerance * largest, "{found} and {expected}");
    }
    for i in 0..3 {
        assert!((found.centre[i] - expected.centre[i]).abs() <= tolerance * (1.0 + expected.centre[i].abs()), "{:?}", found.centre);
        assert_eq!(found.inertia[i], [0, 1, 2].map(|j| found.inertia[j][i]), "symmetric to the bit");
    }
}

/// An L with its corner at the origin, arms along x and y: centre and moments from two boxes by Steiner's theorem.
fn angle() -> Mesh {
    let outline = [[0.0, 0.0], [3.0, 0.0], [3.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0]];
    let vertices = [0.0, 0.5].into_iter().flat_map(|z| outline.map(|[x, y]| [x, y, z])).collect();
    let mut triangles = Vec::new();
    // Fans around corner 3, which sees all others.
    for k in [4_u32, 5, 0, 1] {
        let next = (k + 1) % 6;
        triangles.extend([[3, next, k], [9, k + 6, next + 6]]);
    }
    for k in 0..6_u32 {
        let next = (k + 1) % 6;
        triangles.extend([[k, next, next + 6], [k, next + 6, k + 6]]);
    }
    Mesh { vertices, triangles }
}

#[test]
fn the_mesh_of_a_box_is_the_box() {
    let size = [0.1, 2.0, 0.3];
    let mesh = cuboid(size, [0.0; 3]);
    assert_eq!(mesh.flaw(), None);
    assert!((mesh.volume() - 0.06).abs() < 1e-16);
    near(&mesh.properties(12.0), &Shape::Box { size }.properties(12.0), 1e-15);
    let shape = Shape::Mesh(Arc::new(mesh.clone()));
    assert_eq!((shape.volume(), shape.properties(3.0)), (mesh.volume(), mesh.properties(3.0)));
}

#[test]
fn a_mesh_may_be_far_from_its_origin_tiny_or_huge() {
    let size = [1.0, 2.0, 3.0];
    let expected = Shape::Box { size }.properties(12.0);
    let far = [1e6, -2e6, 3e6];
    near(&cuboid(size, far).properties(12.0), &MassProperties { centre: far, ..expected }, 1e-14);
    for scale in [1e-40, 1e40] {
        let mesh = cuboid(size.map(|edge| edge * scale), [0.0; 3]);
        assert_eq!(mesh.flaw(), None);
        assert!((mesh.volume() / scale.powi(3) - 6.0).abs() < 1e-13);
        let found = mesh.properties(12.0);
        let inertia = found.inertia.map(|row| row.map(|entry| entry / scale / scale));
        near(&MassProperties { inertia, ..found }, &expected, 1e-14);
    }
}

#[test]
fn the_mesh_of_a_sphere_converges_at_second_order() {
    let ball = Shape::Sphere { radius: 1.0 };
    let errors: Vec<[f64; 2]> = (2..6)
        .map(|levels| {
            let mesh = sphere(levels);
            assert_eq!(mesh.flaw(), None);
            let found = mesh.properties(1.0);
            assert!(found.centre.iter().all(|c| c.abs() < 1e-15));
            [ball.volume() - mesh.volume(), ball.properties(1.0).inertia[2][2] - found.inertia[2][2]]
        })
        .collect();
    for pair in errors.windows(2) {
        for quantity in 0..2 {
            let order = (pair[0][quantity] / pair[1][quantity]).log2();
            assert!((order - 2.0).abs() < 0.1, "order {order}");
        }
    }
    assert!(errors[3][0] < 0.01 * 4.0 / 3.0 * PI);
}

#[test]
fn a_solid_that_is_not_convex_is_the_sum_of_its_parts() {
    let mesh = angle();
    assert_eq!(mesh.flaw(), None);
    assert!((mesh.volume() - 2.0).abs() < 1e-15);
    // Boxes 3 × 1 × ½ at (1.5, 0.5) and 1 × 1 × ½ at (0.5, 1.5), 3 kg and 1 kg: centre (1.25, 0.75).
    let xx = 3.0 * (1.0 + 0.25) / 12.0 + 3.0 * 0.0625 + 1.25 / 12.0 + 0.5625;
    let yy = 3.0 * (9.0 + 0.25) / 12.0 + 3.0 * 0.0625 + 1.25 / 12.0 + 0.5625;
    let zz = 3.0 * 10.0 / 12.0 + 3.0 * 0.125 + 2.0 / 12.0 + 1.125;
    let xy = -(3.0 * 0.25 * -0.25 - 0.75 * 0.75);
    let inertia = [[xx, xy, 0.0], [xy, yy, 0.0], [0.0, 0.0, zz]];
    near(&mesh.properties(4.0), &MassProperties { mass: 4.0, centre: [1.25, 0.75, 0.25], inertia }, 1e-14);
}

#[test]
fn a_turned_and_moved_mesh_has_turned_and_moved_properties() {
    // Columns of a rotation with rational entries.
    let rotation = [[2.0, -1.0, 2.0], [2.0, 2.0, -1.0], [-1.0, 2.0, 2.0]].map(|row: [f64; 3]| row.map(|entry| entry / 3.0));
    let turn = |v: [f64; 3]| -> [f64; 3] { rotation.map(|row| row[0] * v[0] + row[1] * v[1] + row[2] * v[2]) };
    let shift = [10.0, -20.0, 5.0];
    let moved = |v: [f64; 3]| -> [f64; 3] { std::array::from_fn(|i| turn(v)[i] + shift[i]) };
    let before = angle();
    let after = Mesh { vertices: before.vertices.iter().map(|&v| moved(v)).collect(), ..before.clone() };
    let (still, found) = (before.properties(4.0), after.properties(4.0));
    let half: [[f64; 3]; 3] = rotation.map(|row| std::array::from_fn(|j| (0..3).map(|k| row[k] * still.inertia[k][j]).sum()));
    let inertia = half.map(|row| rotation.map(|other| (0..3).map(|k| row[k] * other[k]).sum()));
    near(&found, &MassProperties { mass: 4.0, centre: moved(still.centre), inertia }, 1e-14);
    let (old, new) = (inertia::principal(still.inertia).0, inertia::principal(found.inertia).0);
    assert!((0..3).all(|k| (old[k] - new[k]).abs() < 1e-13), "{old:?} and {new:?}");
}

#[test]
fn inside_out_meshes_are_turned_and_cavities_are_left_out() {
    let size = [1.0, 2.0, 3.0];
    let inside_out = flipped(cuboid(size, [0.0; 3]));
    assert_eq!(inside_out.flaw(), None);
    near(&inside_out.properties(12.0), &Shape::Box { size }.properties(12.0), 1e-15);
    assert!((inside_out.volume() - 6.0).abs() < 1e-14);
    let turned = inside_out.outward();
    assert!(turned.integrals(&turned.frame()).volume > 0.0);
    assert_eq!(turned.clone().outward(), turned);

    let hollow = joined(cuboid([3.0; 3], [0.0; 3]), flipped(cuboid([1.0; 3], [0.5, 0.0, 0.0])));
    for mesh in [hollow.clone(), flipped(hollow)] {
        assert_eq!(mesh.flaw(), None);
        assert!((mesh.volume() - 26.0).abs() < 1e-13);
        assert!((mesh.properties(26.0).centre[0] + 0.5 / 26.0).abs() < 1e-15);
    }
}

#[test]
fn what_is_broken_is_told() {
    let told = |mesh: Mesh| mesh.flaw().unwrap();
    let sound = || cuboid([1.0, 2.0, 4.0], [0.0; 3]);
    let mut open = sound();
    open.triangles.pop();
    assert_eq!(told(open), "the mesh is not closed: 3 edges belong to one triangle only, the first from (0.5, -1, -2) to (0.5, -1, 2)");
    let mut one_wrong = sound();
    one_wrong.triangles[0].swap(0, 1);
    assert_eq!(
        told(one_wrong),
        "the mesh is not oriented: 3 edges belong to two triangles of which one is inside out, the first from (-0.5, -1, -2) to (-0.5, 1, -2)"
    );
    let mut fin = sound();
    fin.vertices.push([9.0, 9.0, 9.0]);
    fin.triangles.extend([[0, 1, 8], [1, 0, 8]]);
    assert_eq!(
        told(fin),
        "the mesh is not the surface of a solid: 1 edge belongs to more than two triangles, the first from (-0.5, -1, -2) to (0.5, -1, -2)"
    );
    assert_eq!(
        told(joined(cuboid([2.0; 3], [0.0; 3]), flipped(cuboid([1.0; 3], [5.0, 0.0, 0.0])))),
        "a part of the mesh, from (4.5, -0.5, -0.5) to (5.5, 0.5, 0.5), is inside out against the rest, and in none of it as a cavity"
    );
    assert_eq!(told(cuboid([1.0, 1.0, 0.0], [0.0, 3.0, 7.0])), "the mesh encloses no volume");
    assert_eq!(told(cuboid([0.0; 3], [1.0; 3])), "the mesh encloses no volume");
    assert_eq!(told(Mesh::default()), "the mesh has no triangles");
    let mut strange = sound();
    strange.vertices[3][1] = f64::NAN;
    assert_eq!(told(strange), "a coordinate of vertex 3 is not a finite number");
    let mut strange = sound();
    strange.triangles[4][2] = 8;
    assert_eq!(told(strange), "triangle 4 has vertex 8, and there are 8 vertices from 0");
    let mut strange = sound();
    strange.triangles[5] = [1, 2, 1];
    assert_eq!(told(strange), "triangle 5 has a vertex twice: 1, 2, 1");
    assert_eq!(told(cuboid([1e200; 3], [0.0; 3])), "the mesh is 1e200 m long, too small or too large for its volume to be a number");
}

#[test]
fn vertices_of_no_triangle_and_slivers_change_nothing() {
    let mut mesh = cuboid([1.0, 2.0, 3.0], [0.0; 3]);
    let expected = mesh.properties(1.0);
    mesh.vertices.push([1e9; 3]);
    assert_eq!(mesh.properties(1.0), expected);
    // A vertex on the edge from 0 to 1: one of its triangles has no area.
    mesh.vertices.push([0.0, -1.0, -1.5]);
    let wide = mesh.triangles.iter().position(|triangle| *triangle == [0, 1, 5]).unwrap();
    mesh.triangles[wide] = [0, 9, 5];
    mesh.triangles.extend([[9, 1, 5], [0, 1, 9]]);
    assert_eq!(mesh.flaw(), None);
    near(&mesh.properties(1.0), &expected, 1e-15);
}
