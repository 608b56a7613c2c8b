//! Bodies that may turn about an axis about which they have no inertia and no joint holds them: no acceleration follows there.

use nalgebra::{DMatrix, Matrix3xX, SymmetricEigen};

use super::assembly::Assembly;
use super::bodies::RigidBody;
use super::bodies::frame::Frame;
use super::fault::Fault;
use super::geometry::{Vec3, across, add, cross, norm, scale, subtract};
use crate::system::{Evaluation, Place, System, Term, place_of};

/// Share of the largest moment of inertia of a body, or of what its mass has where its nodes are, that is nothing.
const NOTHING: f64 = 1e-13;

/// Share of a row that is round-off where what moves fastest might all be along it.
const ROUND_OFF: f64 = 1e-9;

/// The mechanism at its start, and which rows a node is in.
struct Held {
    system: System,
    at: Evaluation,
    rows: Vec<Vec<u32>>,
}

impl Held {
    fn new(assembly: &Assembly<'_>) -> Self {
        let system = assembly.builder.clone().build();
        let mut at = system.evaluation();
        system.evaluate_again(system.start_position(), 0.0, &mut at);
        let mut rows = vec![Vec::new(); system.nodes()];
        for (row, slots) in system.slots.rows.iter().enumerate() {
            slots.clone().for_each(|slot| rows[system.slots.nodes[slot] as usize].push(row as u32));
        }
        Self { system, at, rows }
    }

    /// What resists that a body turns about its centre of mass at the rate `axis`: the angular momentum of its nodes, speeds of those that the
    /// ground holds, and rates of rows, each over what is nothing. All of them are linear in the rate. `most` is the moment (kg·m²) beside which one is nothing.
    fn resistance(&self, axis: Vec3, arms: &[(Place, Vec3)], most: f64) -> Vec<f64> {
        let Self { system, at, rows } = self;
        let rate = |node: usize| {
            let arm = arms.iter().find_map(|&(place, arm)| matches!(place, Place::Node(id) if id.index() == node).then_some(arm));
            arm.map(|arm| (cross(axis, arm), norm(arm)))
        };
        let (mut momentum, mut all) = ([0.0; 3], Vec::new());
        for &(place, arm) in arms {
            let node = match place {
                Place::Fixed(_) if norm(arm) == 0.0 => continue,
                Place::Fixed(_) => {
                    all.extend(scale(cross(axis, arm), 1.0 / (ROUND_OFF * norm(arm))));
                    continue;
                }
                Place::Node(id) => id.index(),
            };
            let moved = system.mass.row(node).filter_map(|(other, block)| Some(scale(rate(other)?.0, block.m)));
            momentum = add(momentum, cross(arm, moved.fold([0.0; 3], add)));
            for &row in &rows[node] {
                let (mut sum, mut sizes) = (0.0, 0.0);
                for slot in system.slots.rows[row as usize].clone() {
                    let Some((v, arm)) = rate(system.slots.nodes[slot] as usize) else { continue };
                    for (g, v) in at.gradient[3 * slot..3 * slot + 3].iter().zip(v) {
                        (sum, sizes) = (sum + g * v, sizes + g.abs() * arm);
                    }
                }
                if sizes > 0.0 {
                    all.push(sum / (ROUND_OFF * sizes));
                }
            }
        }
        all.extend(scale(momentum, 1.0 / (NOTHING * most)));
        all
    }
}

/// The first of these bodies, as a fault.
pub(super) fn refuse(assembly: &Assembly<'_>) -> Option<Fault> {
    if assembly.dimension() == 2 {
        return None;
    }
    let (position, mut held) = (assembly.builder.position(), None);
    let at = |terms: Vec<Term>| place_of(&terms, position, 3);
    let mut all = assembly.bodies.iter().zip(&assembly.frames);
    all.find_map(|(body, frame)| {
        let Frame::Body { basis, .. } = frame else { return None };
        let axes = axes_without_inertia(body);
        if axes.is_empty() {
            return None;
        }
        let centre = at(frame.point(body.position));
        let arm = |place: Vec3, is_point: bool| if is_point { subtract(place, centre) } else { place };
        let arms: Vec<_> = basis.iter().map(|node| (node.place, arm(at(vec![(node.place, 1.0).into()]), node.is_point))).collect();
        let farthest = arms.iter().map(|(_, arm)| norm(*arm)).fold(0.0, f64::max);
        let most = body.inertia.symmetric_eigenvalues().amax().max(body.mass * farthest * farthest);
        let held = held.get_or_insert_with(|| Held::new(assembly));
        let resistance = |axis: Vec3| held.resistance(at(frame.vector(axis)), &arms, most);
        let freely = |axis: Vec3| {
            // A frame that has nothing beside the axis does not turn about it.
            let turns = norm(at(frame.vector(across(axis, 3)[0]))) > 0.5;
            turns && resistance(axis).iter().all(|resisting| resisting.abs() <= 1.0)
        };
        least_held(&axes, resistance).into_iter().any(freely).then(|| {
            let message = format!(
                "the body `{}` has no moment of inertia about an axis about which no joint holds it: no acceleration follows there",
                body.name
            );
            let cure = "give it one, as by `inertia` or by a cylinder in place of a rod, or joints that do not let it turn about that axis";
            Fault::new(&body.path, &body.name, message, cure)
        })
    })
}

/// Principal axes about which a body has no moment of inertia.
fn axes_without_inertia(body: &RigidBody) -> Vec<Vec3> {
    let SymmetricEigen { eigenvalues, eigenvectors } = SymmetricEigen::new(body.inertia);
    let largest = eigenvalues.amax();
    (0..3).filter(|&k| eigenvalues[k] <= NOTHING * largest).map(|k| eigenvectors.column(k).into_owned().into()).collect()
}

/// Unit vectors among all sums of these: what resists them is smallest for one, largest for another.
fn least_held(axes: &[Vec3], resistance: impl Fn(Vec3) -> Vec<f64>) -> Vec<Vec3> {
    let resistances: Vec<_> = axes.iter().map(|axis| resistance(*axis)).collect();
    let product = |i: usize, j: usize| resistances[i].iter().zip(&resistances[j]).map(|(a, b)| a * b).sum();
    let SymmetricEigen { eigenvectors, .. } = SymmetricEigen::new(DMatrix::from_fn(axes.len(), axes.len(), product));
    let all = Matrix3xX::from_iterator(axes.len(), axes.iter().flatten().copied());
    (all * eigenvectors).column_iter().map(|axis| [axis[0], axis[1], axis[2]]).collect()
}
