//! Bodies that may turn about axes about which they have no inertia and no joint holds them, alone or some of them together: no acceleration follows
//! there.

use std::collections::{BTreeMap, BTreeSet, HashMap};

use nalgebra::{DMatrix, Matrix3xX, SymmetricEigen};

use super::assembly::Assembly;
use super::bodies::RigidBody;
use super::bodies::frame::Frame;
use super::fault::Fault;
use super::geometry::{Vec3, across, cross, dot, norm, scale, subtract, unit};
use crate::system::{Place, Term, place_of};

/// Share of the largest moment of inertia of a body, or of what its mass has where its nodes are, that is nothing.
const NOTHING: f64 = 1e-13;

/// Share of a row that is round-off where what moves fastest might all be along it.
const ROUND_OFF: f64 = 1e-9;

/// Share of the distance of its nodes by which a frame moves that turns at all.
const TURNS: f64 = 1e-6;

/// Share of the fastest turn that is none.
const STANDS: f64 = 1e-6;

/// What something linear in rates of turns is of one of them, and below which size it is nothing.
#[derive(Clone, Copy, Default)]
struct Share {
    value: f64,
    nothing: f64,
}

/// The first of these bodies, or those that turn with it, as a fault.
pub(super) fn refuse(assembly: &Assembly<'_>) -> Option<Fault> {
    if assembly.dimension() == 2 {
        return None;
    }
    let turning = Spins::new(assembly).free()?;
    let bodies: Vec<&RigidBody> = turning.iter().map(|&body| &assembly.bodies[body]).collect();
    let first = bodies[0];
    let (message, cure) = match &bodies[..] {
        [body] => (
            format!(
                "the body `{}` has no moment of inertia about an axis about which no joint holds it: no acceleration follows there",
                body.name
            ),
            "give it one, as by `inertia` or by a cylinder in place of a rod, or joints that do not let it turn about that axis",
        ),
        bodies => (
            format!(
                "the bodies {} have no moments of inertia about axes about which joints let them turn together: no acceleration follows there",
                bodies.iter().map(|body| format!("`{}`", body.name)).collect::<Vec<_>>().join(", ")
            ),
            "give one of them one, as by `inertia` or by a cylinder in place of a rod, or joints that do not let them turn about these axes",
        ),
    };
    Some(Fault::new(&first.path, &first.name, message, cure))
}

/// Turns of bodies about their centres of mass without any inertia of these.
struct Spins<'a> {
    assembly: &'a Assembly<'a>,
    /// Of each the body, the axis, and the moment (kg m²) and the distance from the centre (m) beside which one is nothing.
    all: Vec<(usize, Vec3, [f64; 2])>,
    /// The turns that move a node, and where that is from the centre. What bodies share moves with the first of them, and rows see to the others.
    moved: HashMap<usize, (std::ops::Range<usize>, Vec3)>,
    /// Of fixed places that bodies have for nodes, in the same way.
    fixed: Vec<(std::ops::Range<usize>, Vec3)>,
}

impl<'a> Spins<'a> {
    fn new(assembly: &'a Assembly<'a>) -> Self {
        let (position, free) = (assembly.builder.position(), assembly.builder.free());
        let at = |terms: Vec<Term>| place_of(&terms, position, 3);
        let mut spins = Self { assembly, all: Vec::new(), moved: HashMap::new(), fixed: Vec::new() };
        for (number, (body, frame)) in assembly.bodies.iter().zip(&assembly.frames).enumerate() {
            let Frame::Body { basis, .. } = frame else { continue };
            let axes = axes_without_inertia(body, |axis| at(frame.vector(axis)));
            if axes.is_empty() {
                continue;
            }
            let centre = at(frame.point(body.position));
            let arm = |place: Vec3, is_point: bool| if is_point { subtract(place, centre) } else { place };
            let arms: Vec<_> = basis.iter().map(|node| (node.place, arm(at(vec![(node.place, 1.0).into()]), node.is_point))).collect();
            let farthest = arms.iter().map(|(_, arm)| norm(*arm)).fold(0.0, f64::max);
            let most = body.inertia.symmetric_eigenvalues().amax().max(body.mass * farthest * farthest);
            let own = arms.iter().filter(|(place, _)| !matches!(place, Place::Node(id) if spins.moved.contains_key(&id.index())));
            let own: Vec<_> = own.filter(|(_, arm)| norm(*arm) > 0.0).copied().collect();
            let axes = moving(&axes, &own);
            let turns = spins.all.len()..spins.all.len() + axes.len();
            let moves = |arm: Vec3| axes.iter().any(|axis| norm(cross(*axis, arm)) > TURNS * norm(arm));
            for (place, arm) in own.into_iter().filter(|(_, arm)| moves(*arm)) {
                match place {
                    Place::Node(id) if id.index() < free => _ = spins.moved.insert(id.index(), (turns.clone(), arm)),
                    _ => spins.fixed.push((turns.clone(), arm)),
                }
            }
            spins.all.extend(axes.into_iter().map(|axis| (number, axis, [most, farthest])));
        }
        spins
    }

    /// What the turns may not do: turn fixed places, give momentum to a node, move a row.
    fn conditions(&self) -> Vec<BTreeMap<usize, Share>> {
        let system = self.assembly.builder.clone().build();
        let mut at = system.evaluation();
        system.evaluate_again(system.start_position(), 0.0, &mut at);
        let (mut pushed, mut rows) = (BTreeSet::new(), BTreeSet::new());
        for &node in self.moved.keys() {
            pushed.extend(system.mass.row(node).map(|(other, _)| other));
        }
        for (row, slots) in system.slots.rows.iter().enumerate() {
            rows.extend(slots.clone().any(|slot| self.moved.contains_key(&(system.slots.nodes[slot] as usize))).then_some(row));
        }
        let mut all: Vec<BTreeMap<usize, Share>> = Vec::new();
        for (turns, arm) in &self.fixed {
            all.extend((0..3).map(|c| {
                let share = |turn: usize| Share { value: cross(self.all[turn].1, *arm)[c], nothing: ROUND_OFF * norm(*arm) };
                turns.clone().map(|turn| (turn, share(turn))).collect()
            }));
        }
        for node in pushed {
            let mut momentum: [BTreeMap<usize, Share>; 3] = Default::default();
            for (other, block) in system.mass.row(node) {
                for (turn, v, _) in self.velocities(other) {
                    let [most, farthest] = self.all[turn].2;
                    for (c, momentum) in momentum.iter_mut().enumerate() {
                        let share = momentum.entry(turn).or_default();
                        (share.value, share.nothing) = (share.value + block.m * v[c], NOTHING * most / farthest);
                    }
                }
            }
            all.extend(momentum);
        }
        for row in rows {
            let mut rate = BTreeMap::<usize, Share>::new();
            for slot in system.slots.rows[row].clone() {
                for (turn, v, arm) in self.velocities(system.slots.nodes[slot] as usize) {
                    let share = rate.entry(turn).or_default();
                    for (g, v) in at.gradient[3 * slot..3 * slot + 3].iter().zip(v) {
                        (share.value, share.nothing) = (share.value + g * v, share.nothing + ROUND_OFF * g.abs() * arm);
                    }
                }
            }
            all.push(rate);
        }
        all
    }

    /// The turns that move a node, its velocity at the rate 1, and its distance from the centre.
    fn velocities(&self, node: usize) -> impl Iterator<Item = (usize, Vec3, f64)> {
        let moved = self.moved.get(&node).into_iter();
        moved.flat_map(|(turns, arm)| turns.clone().map(|turn| (turn, cross(self.all[turn].1, *arm), norm(*arm))))
    }

    /// The bodies that turn together where no condition is against it, if any do: what is left when each condition gives one turn by the others.
    fn free(&self) -> Option<Vec<usize>> {
        if self.all.is_empty() {
            return None;
        }
        let mut given: Vec<(usize, BTreeMap<usize, Share>)> = Vec::new();
        let mut by = HashMap::<usize, usize>::new();
        for mut condition in self.conditions() {
            while let Some(first) = condition.keys().filter_map(|turn| by.get(turn)).min() {
                let (turn, other) = &given[*first];
                let factor = -condition.remove(turn).expect("it is among the keys").value / other[turn].value;
                for (other, share) in other.iter().filter(|(other, _)| *other != turn) {
                    let own = condition.entry(*other).or_default();
                    (own.value, own.nothing) = (own.value + factor * share.value, own.nothing + factor.abs() * share.nothing);
                }
            }
            condition.retain(|_, share| share.value.abs() > share.nothing);
            let most = condition.iter().max_by(|a, b| a.1.value.abs().total_cmp(&b.1.value.abs()));
            if let Some(turn) = most.map(|(turn, _)| *turn) {
                by.insert(turn, given.len());
                given.push((turn, condition));
            }
        }
        let free = (0..self.all.len()).find(|turn| !by.contains_key(turn))?;
        let mut rates = vec![0.0; self.all.len()];
        rates[free] = 1.0;
        for (turn, condition) in given.iter().rev() {
            let others = condition.iter().filter(|(other, _)| *other != turn).map(|(other, share)| share.value * rates[*other]);
            rates[*turn] = -others.sum::<f64>() / condition[turn].value;
        }
        let most = rates.iter().fold(0.0, |most: f64, rate| most.max(rate.abs()));
        let mut bodies: Vec<usize> =
            self.all.iter().zip(&rates).filter(|(_, rate)| rate.abs() > STANDS * most).map(|(turn, _)| turn.0).collect();
        bodies.dedup();
        Some(bodies)
    }
}

/// Axes about which a body has no moment of inertia, where its directions are now.
fn axes_without_inertia(body: &RigidBody, now: impl Fn(Vec3) -> Vec3) -> Vec<Vec3> {
    let SymmetricEigen { eigenvalues, eigenvectors } = SymmetricEigen::new(body.inertia);
    let largest = eigenvalues.amax();
    let axis = |k: usize| {
        let (axis, now) = (eigenvectors.column(k).into_owned().into(), now(eigenvectors.column(k).into_owned().into()));
        if norm(now) > 0.5 { scale(now, 1.0 / norm(now)) } else { axis }
    };
    let (without, with): (Vec<_>, Vec<_>) = (0..3).partition(|&k| eigenvalues[k] <= NOTHING * largest);
    match without[..] {
        [_, _, _] => vec![unit(0), unit(1), unit(2)],
        // What the frame has is the third.
        [_, _] => across(axis(with[0]), 3),
        _ => without.into_iter().map(axis).collect(),
    }
}

/// Axes among the sums of these about which a turn moves some nodes, by where they are from the centre.
fn moving(axes: &[Vec3], arms: &[(Place, Vec3)]) -> Vec<Vec3> {
    let moved = |i: usize, j: usize| arms.iter().map(|(_, arm)| dot(cross(axes[i], *arm), cross(axes[j], *arm)) / dot(*arm, *arm)).sum();
    let SymmetricEigen { eigenvalues, eigenvectors } = SymmetricEigen::new(DMatrix::from_fn(axes.len(), axes.len(), moved));
    let all = Matrix3xX::from_iterator(axes.len(), axes.iter().flatten().copied()) * eigenvectors;
    (0..axes.len()).filter(|&k| eigenvalues[k] > TURNS * TURNS).map(|k| [all[(0, k)], all[(1, k)], all[(2, k)]]).collect()
}
