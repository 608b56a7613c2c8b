//! Bodies that may turn about an axis about which they have no inertia and no joint holds them: no acceleration follows there.

use nalgebra::SymmetricEigen;

use super::assembly::Assembly;
use super::bodies::RigidBody;
use super::bodies::frame::Frame;
use super::fault::Fault;
use super::geometry::{Vec3, across, cross, dot, norm, subtract};
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

    /// Whether no mass moves, beside `most` (kg·m²) of it, and no row is missed where some nodes move alone.
    fn is_nothing(&self, moves: &[(usize, Vec3)], most: f64) -> bool {
        let Self { system, at, rows } = self;
        let rate = |node: usize| moves.iter().find(|(moved, _)| *moved == node).map(|(_, v)| *v);
        let along = |&(node, v): &(usize, Vec3)| -> f64 {
            let of_mass = system.mass.row(node).filter_map(|(other, block)| Some(block.m * dot(v, rate(other)?)));
            of_mass.sum()
        };
        if moves.iter().map(along).sum::<f64>() > NOTHING * most {
            return false;
        }
        let fastest = moves.iter().fold(0.0, |m: f64, (_, v)| m.max(norm(*v)));
        moves.iter().flat_map(|(node, _)| &rows[*node]).all(|&row| {
            let (mut sum, mut sizes) = (0.0, 0.0);
            for slot in system.slots.rows[row as usize].clone() {
                let Some(v) = rate(system.slots.nodes[slot] as usize) else { continue };
                for (g, v) in at.gradient[3 * slot..3 * slot + 3].iter().zip(v) {
                    (sum, sizes) = (sum + g * v, sizes + g.abs() * fastest);
                }
            }
            f64::abs(sum) <= ROUND_OFF * sizes
        })
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
        let freely = |axis: Vec3| {
            // A frame that has nothing beside the axis does not turn about it.
            if norm(at(frame.vector(across(axis, 3)[0]))) < 0.5 {
                return false;
            }
            let (axis, centre) = (at(frame.vector(axis)), at(frame.point(body.position)));
            let (mut moves, mut farthest) = (Vec::new(), 0.0_f64);
            for node in basis {
                let place = at(vec![(node.place, 1.0).into()]);
                let arm = if node.is_point { subtract(place, centre) } else { place };
                let v = cross(axis, arm);
                farthest = farthest.max(norm(arm));
                match node.place {
                    Place::Node(id) => moves.push((id.index(), v)),
                    // What the ground holds beside the axis does not let it turn.
                    Place::Fixed(_) if norm(v) > ROUND_OFF * norm(arm) => return false,
                    Place::Fixed(_) => (),
                }
            }
            let most = body.inertia.symmetric_eigenvalues().amax().max(body.mass * farthest * farthest);
            held.get_or_insert_with(|| Held::new(assembly)).is_nothing(&moves, most)
        };
        axes_without_inertia(body).into_iter().any(freely).then(|| {
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
