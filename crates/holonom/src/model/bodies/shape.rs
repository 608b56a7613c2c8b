//! Shapes of uniform density: their volume, and what a mass spread over them weighs against turning.

use std::f64::consts::PI;
use std::sync::Arc;

use super::mesh::Mesh;

/// How a mass lies in space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MassProperties {
    /// Mass, kg.
    pub mass: f64,
    /// Centre of mass (3) in the axes of the shape, m.
    pub centre: [f64; 3],
    /// Inertia tensor (3 × 3) about the centre of mass in the axes of the shape, kg m².
    pub inertia: [[f64; 3]; 3],
}

/// A shape of uniform density. All but meshes lie with their centre at the origin; lengths are positive, in m.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// Edges along x, y, z.
    Box {
        /// Lengths of the edges.
        size: [f64; 3],
    },
    /// Axis along z.
    Cylinder {
        /// From the axis to the surface.
        radius: f64,
        /// From one flat end to the other.
        length: f64,
    },
    /// A full ball.
    Sphere {
        /// From the centre to the surface.
        radius: f64,
    },
    /// Slender, along x.
    Rod {
        /// From end to end.
        length: f64,
    },
    /// Axis along z; the length of the cylindrical part, without the two half spheres.
    Capsule {
        /// Of the cylinder and of both half spheres.
        radius: f64,
        /// Of the cylinder alone.
        length: f64,
    },
    /// Closed, without flaw.
    Mesh(Arc<Mesh>),
}

impl Shape {
    /// Volume, m³; of a rod its length, m, so that its density is in kg/m.
    pub fn volume(&self) -> f64 {
        match self {
            Self::Box { size } => size.iter().product(),
            Self::Cylinder { radius, length } => PI * radius * radius * length,
            Self::Sphere { radius } => 4.0 / 3.0 * PI * radius.powi(3),
            Self::Rod { length } => *length,
            Self::Capsule { radius, length } => PI * radius * radius * (length + 4.0 / 3.0 * radius),
            Self::Mesh(mesh) => mesh.volume(),
        }
    }

    /// What a mass, kg, is when it is spread evenly over the shape.
    pub fn properties(&self, mass: f64) -> MassProperties {
        let moments = match *self {
            Self::Box { size } => {
                let [x, y, z] = size.map(|edge| mass * edge * edge / 12.0);
                [y + z, x + z, x + y]
            }
            Self::Cylinder { radius, length } => cylinder(mass, radius, length),
            Self::Sphere { radius } => [0.4 * mass * radius * radius; 3],
            Self::Rod { length } => {
                let across = mass * length * length / 12.0;
                [0.0, across, across]
            }
            Self::Capsule { radius, length } => capsule(mass, radius, length),
            Self::Mesh(ref mesh) => return mesh.properties(mass),
        };
        let mut inertia = [[0.0; 3]; 3];
        for k in 0..3 {
            inertia[k][k] = moments[k];
        }
        MassProperties { mass, centre: [0.0; 3], inertia }
    }
}

fn cylinder(mass: f64, radius: f64, length: f64) -> [f64; 3] {
    let across = mass * (radius * radius / 4.0 + length * length / 12.0);
    [across, across, mass * radius * radius / 2.0]
}

/// A cylinder between two half spheres, whose centres of mass are ⅜ r from their flat sides.
fn capsule(mass: f64, radius: f64, length: f64) -> [f64; 3] {
    let in_cylinder = mass * length / (length + 4.0 / 3.0 * radius);
    let in_ends = mass - in_cylinder;
    let [across, _, along] = cylinder(in_cylinder, radius, length);
    let across = across + in_ends * (0.4 * radius * radius + length * (length / 4.0 + 3.0 / 8.0 * radius));
    [across, across, along + in_ends * 0.4 * radius * radius]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn moments(shape: &Shape, mass: f64) -> [f64; 3] {
        let MassProperties { mass: kept, centre, inertia } = shape.properties(mass);
        assert_eq!((kept, centre), (mass, [0.0; 3]));
        assert!((0..3).all(|i| (0..3).all(|j| i == j || inertia[i][j] == 0.0)), "the axes are principal");
        [inertia[0][0], inertia[1][1], inertia[2][2]]
    }

    fn near(found: [f64; 3], expected: [f64; 3]) {
        assert!(found.iter().zip(expected).all(|(found, expected)| (found - expected).abs() <= 1e-14 * expected), "{found:?}");
    }

    /// Volume and moments per density of a body of revolution about z with radius r(z), as a stack of thin discs.
    fn revolved(radius: impl Fn(f64) -> f64, half: f64) -> (f64, [f64; 3]) {
        let count = 200_000;
        let step = 2.0 * half / f64::from(count);
        let (mut volume, mut across, mut along) = (0.0, 0.0, 0.0);
        for k in 0..count {
            let z = (f64::from(k) + 0.5) * step - half;
            let r = radius(z);
            let slice = PI * r * r * step;
            volume += slice;
            across += slice * (r * r / 4.0 + z * z);
            along += slice * r * r / 2.0;
        }
        (volume, [across, across, along])
    }

    #[test]
    fn textbook_solids_have_textbook_moments() {
        // Meriam, Kraige: Dynamics, table D/4, worked out by hand for 12 kg.
        near(moments(&Shape::Box { size: [1.0, 2.0, 3.0] }, 12.0), [13.0, 10.0, 5.0]);
        near(moments(&Shape::Cylinder { radius: 0.5, length: 2.0 }, 12.0), [4.75, 4.75, 1.5]);
        near(moments(&Shape::Sphere { radius: 0.5 }, 12.0), [1.2; 3]);
        near(moments(&Shape::Rod { length: 2.0 }, 12.0), [0.0, 4.0, 4.0]);
    }

    #[test]
    fn volumes_are_those_of_the_solids() {
        assert_eq!(Shape::Box { size: [1.0, 2.0, 3.0] }.volume(), 6.0);
        assert_eq!(Shape::Rod { length: 2.0 }.volume(), 2.0);
        let near = |shape: Shape, expected: f64| assert!((shape.volume() - expected).abs() < 1e-14, "{shape:?}");
        near(Shape::Cylinder { radius: 0.5, length: 2.0 }, 0.5 * PI);
        near(Shape::Sphere { radius: 0.5 }, PI / 6.0);
        near(Shape::Capsule { radius: 0.5, length: 2.0 }, 0.5 * PI + PI / 6.0);
    }

    #[test]
    fn solids_of_revolution_agree_with_stacks_of_discs() {
        let (radius, length) = (0.3_f64, 0.8);
        let round = |z: f64| (radius * radius - z * z).max(0.0).sqrt();
        let capsule = move |z: f64| round((z.abs() - length / 2.0).max(0.0));
        for (shape, (volume, stacked)) in [
            (Shape::Capsule { radius, length }, revolved(capsule, length / 2.0 + radius)),
            (Shape::Sphere { radius }, revolved(round, radius)),
            (Shape::Cylinder { radius, length }, revolved(|_| radius, length / 2.0)),
        ] {
            assert!((shape.volume() - volume).abs() < 1e-9 * volume, "{shape:?}");
            for (found, expected) in moments(&shape, volume).into_iter().zip(stacked) {
                assert!((found - expected).abs() < 1e-9 * expected, "{shape:?}: {found} and {expected}");
            }
        }
    }

    #[test]
    fn a_capsule_is_a_sphere_or_a_rod_at_its_ends() {
        near(moments(&Shape::Capsule { radius: 0.5, length: 1e-300 }, 12.0), [1.2; 3]);
        let thin = moments(&Shape::Capsule { radius: 1e-9, length: 2.0 }, 12.0);
        assert!((thin[0] - 4.0).abs() < 1e-7 && thin[2] < 1e-16);
    }
}
