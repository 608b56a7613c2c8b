//! What is recorded of a model, by name: points, bodies, coordinates of joints and their forces.

use std::collections::HashSet;
use std::sync::Arc;

use nalgebra::UnitQuaternion;

use super::body::RecordedBody;
use super::force::RecordedForce;
use super::heading::{Endings, Heading, Units};
use super::hold::{RecordedHold, Where};
use super::joint::{RecordedJoint, Wrench};
use super::measure::{RecordedInput, RecordedMeasure};
use super::recorder::{COLUMNS, Constraints, MEANINGS};
use super::transmission::{Push, RecordedTransmission};
use crate::simulation::{Apart, Found, Simulation};
use crate::system::{NodeId, Place, Signal, System, Term, place_of, rate_of};

/// A point whose motion is recorded.
#[derive(Clone, Debug, PartialEq)]
pub struct RecordedPoint {
    /// With its index where it is repeated; of a place of a body `BODY.PLACE`.
    pub name: String,
    /// The nodes it is made of.
    pub terms: Vec<Term>,
}

/// A drive whose effort is recorded: −λ of its row, times a length where the row is one of half a square.
#[derive(Clone)]
pub struct RecordedEffort {
    /// Of the drive.
    pub name: String,
    /// Its row among those of the system.
    pub row: usize,
    /// Length that −λ is multiplied by, m over time; `None` where −λ is the effort.
    pub length: Option<Arc<dyn Signal>>,
    /// Whether the effort is a moment and not a force.
    pub is_moment: bool,
}

/// A massless rod or a bar whose tension is recorded: λ of its row, which is one of half the square of its length, times that.
#[derive(Clone)]
pub struct RecordedRod {
    /// With its index where it is repeated.
    pub name: String,
    /// Its row among those of the system.
    pub row: usize,
    /// Its length, m over time.
    pub length: Arc<dyn Signal>,
}

/// What a coupler exerts along a coordinate that it couples, on the second body of its joint: −λ of its row times the factor of the coordinate there.
#[derive(Clone, Debug, PartialEq)]
pub struct RecordedCoupling {
    /// `COUPLER.JOINT.COORDINATE`
    pub name: String,
    /// The row among those of the system.
    pub row: usize,
    /// Of the coordinate in the row.
    pub factor: f64,
    /// Where the row has a function of the coordinate, which of its parts that is: the factor is times its slope.
    pub curve: Option<usize>,
    /// Whether the coordinate is an angle.
    pub is_moment: bool,
}

/// All that is recorded of a model, in the order of the columns.
#[derive(Clone, Default)]
pub struct Channels {
    /// World axes of the coordinates, `"xyz"` or two of them.
    pub axes: String,
    /// Position and velocity of points, then of named places of bodies.
    pub points: Vec<RecordedPoint>,
    /// Position and velocity of the centre of mass, in space also orientation and angular velocity.
    pub bodies: Vec<Arc<RecordedBody>>,
    /// Force and moment, where reactions are recorded.
    pub joints: Vec<RecordedJoint>,
    /// What forces do.
    pub forces: Vec<RecordedForce>,
    /// Force (N) or moment (N·m) of drives.
    pub efforts: Vec<RecordedEffort>,
    /// Force (N) or moment (N·m) of couplers.
    pub couplings: Vec<RecordedCoupling>,
    /// Forces of teeth and belts, which the bearings of their wheels feel.
    pub transmissions: Vec<RecordedTransmission>,
    /// Tension (N) of bars and of the constraints that keep a distance, that of a bar its mean over the length.
    pub rods: Vec<RecordedRod>,
    /// Forces (N) or moments (N·m) of all other constraints.
    pub holds: Vec<RecordedHold>,
    /// The coordinates of joints and bodies, as `hinge.angle`, that are angles (rad) and not displacements (m).
    pub angles: HashSet<String>,
    /// Formulas of the columns, each behind those that it reads.
    pub measures: Vec<RecordedMeasure>,
    /// Numbers from outside.
    pub inputs: Vec<RecordedInput>,
    /// The system that the forces of the constraints are found in and the same of it, where it is another one.
    pub apart: Option<Arc<(Apart, Arc<Self>)>>,
}

/// Suffixes of the columns of a body in space behind those of its centre: the unit quaternion of its orientation (from
/// body axes to the world's), and its angular velocity in world axes.
const TURNED: [(&str, &str, &str); 7] = [
    ("qw", "1", "unit quaternion from body to world axes, w"),
    ("qx", "1", "unit quaternion from body to world axes, x"),
    ("qy", "1", "unit quaternion from body to world axes, y"),
    ("qz", "1", "unit quaternion from body to world axes, z"),
    ("wx", "rad/s", "angular velocity about x of the world"),
    ("wy", "rad/s", "angular velocity about y of the world"),
    ("wz", "rad/s", "angular velocity about z of the world"),
];

impl Channels {
    /// The channels that forces of the constraints and accelerations are of.
    pub fn told(&self) -> &Self {
        self.apart.as_ref().map_or(self, |apart| &apart.1)
    }

    /// The same, where their forces are found, and not those of a system in which bodies share nodes.
    fn found_in(&self, found: &Found<'_>) -> Option<&Self> {
        Some(self.told()).filter(|_| self.apart.is_none() || found.is_apart)
    }

    /// All columns but those of measures: what every recording begins with, motion, accelerations, the coordinates of joints and their
    /// rates, what forces and drives do, inputs, then `constraints`.
    pub fn headings(&self, system: &System, constraints: Constraints) -> Vec<Heading> {
        self.sections(system, constraints, &self.sizes(constraints)).into_iter().flatten().collect()
    }

    /// The same, apart: what every recording begins with, motion, accelerations, coordinates, forces and drives, inputs, constraints, and the sizes
    /// of these components.
    pub(super) fn sections(&self, system: &System, constraints: Constraints, sizes: &[Vec<String>]) -> [Vec<Heading>; 8] {
        let common = COLUMNS.iter().zip(MEANINGS).map(|(&name, (unit, meaning))| Heading::new(name, unit, meaning));
        let [mut accelerations, mut held] = [Vec::new(), Vec::new()];
        if constraints != Constraints::Nothing {
            (accelerations, held) = (self.acceleration_headings(), self.joint_headings());
        }
        if constraints == Constraints::Rows {
            held.extend(self.multiplier_headings(system));
        }
        let inputs = self.inputs.iter().map(|input| Heading::new(&input.name, input.unit.clone(), &*input.meaning));
        let of_sizes = [("N", "size of the force"), ("N·m", "size of the moment")].map(|(unit, meaning)| (unit, Arc::from(meaning)));
        [
            common.collect(),
            self.motion_headings(),
            accelerations,
            self.coordinate_headings(system.gauges()).collect(),
            self.force_headings(),
            inputs.collect(),
            held,
            sizes.iter().map(|components| size_heading(components, &of_sizes)).collect(),
        ]
    }

    /// Columns that are components of one force or moment, the size of which has a column, too.
    pub(super) fn sizes(&self, constraints: Constraints) -> Vec<Vec<String>> {
        let axes = &self.axes;
        let of_forces = self.forces.iter().flat_map(|force| force.acts(axes));
        let told = Some(self.told()).filter(|_| constraints != Constraints::Nothing);
        let of_joints = told.iter().flat_map(|told| {
            let joints = told.joints.iter().flat_map(|joint| joint.acts(axes));
            let holds = told.holds.iter().flat_map(|hold| hold.acts(axes).map(|(_, columns)| columns).collect::<Vec<_>>());
            joints.chain(told.transmissions.iter().map(|transmission| transmission.acts(axes))).chain(holds)
        });
        of_forces.chain(of_joints).filter(|components| components.len() > 1).collect()
    }

    /// The columns of motion.
    fn motion_headings(&self) -> Vec<Heading> {
        let (of_points, mut of_bodies) = (self.moves("point"), self.moves("centre of mass"));
        if self.axes.len() == 3 {
            TURNED.into_iter().for_each(|(ending, unit, meaning)| of_bodies.add(ending, unit, meaning));
        }
        let points = self.points.iter().flat_map(|point| of_points.of(&point.name));
        points.chain(self.bodies.iter().flat_map(|body| of_bodies.of(&body.name))).collect()
    }

    /// Position and velocity of something.
    fn moves(&self, what: &str) -> Endings {
        let mut moves = Endings::default();
        self.axes.chars().for_each(|axis| moves.add(axis, "m", format!("position of the {what}, {axis}")));
        self.axes.chars().for_each(|axis| moves.add(format!("v{axis}"), "m/s", format!("velocity of the {what} along {axis}")));
        moves
    }

    /// The columns of accelerations.
    fn acceleration_headings(&self) -> Vec<Heading> {
        let [of_points, mut of_bodies] = ["point", "centre of mass"].map(|what| {
            let mut linear = Endings::default();
            self.axes.chars().for_each(|axis| linear.add(format!("a{axis}"), "m/s²", format!("acceleration of the {what} along {axis}")));
            linear
        });
        match self.axes.len() {
            2 => of_bodies.add("alpha", "rad/s²", "angular acceleration"),
            _ => self.axes.chars().for_each(|axis| {
                of_bodies.add(format!("alpha{axis}"), "rad/s²", format!("angular acceleration about {axis} of the world"));
            }),
        }
        let points = self.points.iter().flat_map(|point| of_points.of(&point.name));
        points.chain(self.bodies.iter().flat_map(|body| of_bodies.of(&body.name))).collect()
    }

    /// Appends the columns of accelerations, where forces are found.
    pub(super) fn accelerations(&self, found: &Found<'_>, row: &mut Vec<f64>) {
        let Some(reactions) = found.reactions else { return };
        let (told, dim) = (self.found_in(found).unwrap_or(self), self.axes.len());
        let (x, v, a) = (found.positions(), found.v, &reactions.a);
        told.points.iter().for_each(|point| row.extend_from_slice(&rate_of(&point.terms, a, dim)[..dim]));
        for body in &told.bodies {
            row.extend_from_slice(&rate_of(&body.centre, a, dim)[..dim]);
            let angular = body.angular_acceleration(&x, v, a, dim);
            row.extend_from_slice(&angular.as_slice()[if dim == 2 { 2..3 } else { 0..3 }]);
        }
    }

    /// The columns of the coordinates of joints, `names`, and their rates.
    fn coordinate_headings<'a>(&'a self, names: &'a [String]) -> impl Iterator<Item = Heading> + 'a {
        let bodies: HashSet<&str> = self.bodies.iter().filter(|_| self.axes.len() == 2).map(|body| body.name.as_str()).collect();
        let kinds = ["displacement", "angle"].map(|what| {
            let froms = ["pose that is written", "first axis of the model"].map(|from| format!("{what}, from the {from}").into());
            (froms, Arc::<str>::from(format!("rate of the {what}")))
        });
        names.iter().flat_map(move |name| {
            let is_angle = self.angles.contains(name);
            let (units, (froms, rate)) = (Units::of(is_angle), &kinds[usize::from(is_angle)]);
            let is_of_body = name.strip_suffix(".angle").is_some_and(|owner| bodies.contains(owner));
            let from: &Arc<str> = &froms[usize::from(is_of_body)];
            [Heading::new(name.clone(), units.value, Arc::clone(from)), Heading::new(format!("{name}_rate"), units.rate, Arc::clone(rate))]
        })
    }

    /// The columns of what forces and drives do.
    fn force_headings(&self) -> Vec<Heading> {
        let mut headings: Vec<Heading> = self.forces.iter().flat_map(|force| force.headings(&self.axes)).collect();
        headings.extend(self.told().efforts.iter().flat_map(|RecordedEffort { name, length, is_moment, .. }| {
            let (unit, what) = if *is_moment { ("N·m", "moment") } else { ("N", "force") };
            let lengths = [
                Heading::new(format!("{name}.length"), "m", "driven distance of its ends"),
                Heading::new(format!("{name}.length_rate"), "m/s", "rate of the distance"),
            ];
            let own = [
                Heading::new(format!("{name}.effort"), unit, format!("{what} that the drive exerts along its motion")),
                Heading::new(format!("{name}.power"), "W", "power that the drive gives to the mechanism"),
            ];
            lengths.into_iter().filter(|_| length.is_some()).chain(own)
        }));
        headings
    }

    /// Appends the columns of drives at the time `t` (s); no numbers of what they exert where forces are not found.
    pub(super) fn efforts(&self, found: Option<&Found<'_>>, t: f64, row: &mut Vec<f64>) {
        for effort in &self.told().efforts {
            let length = effort.length.as_ref().map_or(1.0, |length| {
                let [length, rate, _] = length.at(t);
                row.extend([length, rate]);
                length
            });
            let exerted = found.and_then(|found| {
                let lambda = found.reactions?.lambda[effort.row];
                // The target of the row moves with the length times the rate.
                Some([-lambda * length, lambda * found.system.explicit_rate(effort.row, found.at, t)])
            });
            row.extend(exerted.unwrap_or([f64::NAN; 2]));
        }
    }

    /// Force and moment of each joint on its second body, about its place there, what couplers exert, tensions, and forces of constraints.
    fn joint_headings(&self) -> Vec<Heading> {
        let couplings = self.told().couplings.iter().map(|RecordedCoupling { name, is_moment, .. }| {
            let (unit, what) = if *is_moment { ("N·m", "moment") } else { ("N", "force") };
            Heading::new(format!("{name}.effort"), unit, format!("{what} of the coupler along the coordinate"))
        });
        let tension =
            |rod: &RecordedRod| Heading::new(format!("{}.force", rod.name), "N", "tension: above zero it pulls its ends together");
        let pushes = self.told().transmissions.iter().flat_map(|transmission| {
            let name = &transmission.name;
            let force =
                move |axis| Heading::new(format!("{name}.f{axis}"), "N", format!("force on the first wheel, along {axis} of the world"));
            self.axes.chars().map(force)
        });
        let of_joints = RecordedJoint::endings(&self.axes);
        let joints = self.told().joints.iter().flat_map(|joint| of_joints.of(&joint.name));
        let holds = self.told().holds.iter().flat_map(|hold| hold.headings(&self.axes));
        joints.chain(couplings).chain(pushes).chain(self.told().rods.iter().map(tension)).chain(holds).collect()
    }

    /// The multiplier of each row of the system, and the force of the constraints on each point that is a free node.
    fn multiplier_headings(&self, system: &System) -> Vec<Heading> {
        let rows = self.apart.as_ref().map_or(system, |apart| apart.0.system()).row_names();
        let lambda = |row: &String| Heading::new(format!("{row}.lambda"), "1", "multiplier of the row");
        let mut headings: Vec<Heading> = rows.iter().map(lambda).collect();
        for point in self.told().points.iter().filter(|point| node(point).is_some()) {
            let force = |axis| Heading::new(format!("{}.r{axis}", point.name), "N", format!("force of the constraints along {axis}"));
            headings.extend(self.axes.chars().map(force));
        }
        headings
    }

    /// Goes on with the orientations of bodies in space from the last ones to the present state.
    pub(super) fn follow(&self, simulation: &Simulation, last: &mut [UnitQuaternion<f64>]) {
        if self.axes.len() == 3 {
            let x = simulation.system().in_world(&simulation.state().x);
            let turned = |body: &Arc<RecordedBody>| body.turned(&x, simulation.velocities()).0;
            self.bodies.iter().zip(last).for_each(|(body, last)| *last = near(turned(body), last));
        }
    }

    /// Appends the columns of motion.
    pub fn motion(&self, simulation: &Simulation, last: &mut [UnitQuaternion<f64>], row: &mut Vec<f64>) {
        let x = simulation.system().in_world(&simulation.state().x);
        let (x, v, dim) = (&x[..], simulation.velocities(), self.axes.len());
        for terms in self.points.iter().map(|point| &point.terms) {
            row.extend_from_slice(&place_of(terms, x, dim)[..dim]);
            row.extend_from_slice(&rate_of(terms, v, dim)[..dim]);
        }
        for (body, last) in self.bodies.iter().zip(last) {
            row.extend_from_slice(&place_of(&body.centre, x, dim)[..dim]);
            row.extend_from_slice(&rate_of(&body.centre, v, dim)[..dim]);
            if dim == 3 {
                let (orientation, omega) = body.turned(x, v);
                *last = near(orientation, last);
                row.extend([last.w, last.i, last.j, last.k, omega[0], omega[1], omega[2]]);
            }
        }
    }

    /// Appends the columns of the forces of joints, couplers, rods and other constraints at the time `t` (s); no numbers where bodies share nodes at
    /// the joint.
    pub(super) fn joint_forces(&self, found: &Found<'_>, t: f64, row: &mut Vec<f64>) {
        let (dim, x) = (self.axes.len(), found.positions());
        let (first, components) = (row.len(), RecordedJoint::components(dim));
        let Some(told) = self.found_in(found) else {
            let told = self.told();
            let held = told.holds.iter().map(|hold| hold.width(dim)).sum::<usize>();
            let others = told.couplings.len() + told.transmissions.len() * dim + told.rods.len() + held;
            row.extend(std::iter::repeat_n(f64::NAN, told.joints.len() * components.len() + others));
            return;
        };
        for joint in &told.joints {
            let wrench = joint.wrench(found, &x).unwrap_or(([f64::NAN; 3], [f64::NAN; 3]));
            row.extend(components.iter().map(|&k| component(wrench, k)));
        }
        let of = |row: usize| found.reactions.map_or(f64::NAN, |reactions| reactions.lambda[row]);
        let pushes: Vec<Push> = told.transmissions.iter().map(|transmission| told.push(transmission, of(transmission.row), &x)).collect();
        for (transmission, push) in told.transmissions.iter().zip(&pushes) {
            for (joint, wrench) in transmission.borne(push) {
                let own = &mut row[first + joint * components.len()..];
                own.iter_mut().zip(components).for_each(|(own, &k)| *own += component(wrench, k));
            }
        }
        let share = |coupling: &RecordedCoupling| {
            coupling.factor * coupling.curve.map_or(1.0, |part| found.system.slope_in_row(coupling.row, part, found.at))
        };
        row.extend(told.couplings.iter().map(|coupling| -share(coupling) * of(coupling.row)));
        pushes.iter().for_each(|push| row.extend_from_slice(&push.force.as_slice()[..dim]));
        row.extend(told.rods.iter().map(|rod| of(rod.row) * rod.length.at(t)[0]));
        let held_at = Where { at: found.at, x: &x, dim, t };
        for hold in &told.holds {
            match found.reactions {
                Some(reactions) => {
                    let exerted = hold.exerted(&reactions.lambda, held_at);
                    exerted.iter().for_each(|force| row.extend_from_slice(&force[hold.components(dim)]));
                }
                None => row.extend(std::iter::repeat_n(f64::NAN, hold.width(dim))),
            }
        }
    }

    /// What one of the transmissions of these channels does with this multiplier of its row, where `x` are the positions of all nodes.
    fn push(&self, transmission: &RecordedTransmission, lambda: f64, x: &[f64]) -> Push {
        let dim = self.axes.len();
        transmission.push(transmission.joints.map(|joint| self.joints[joint].place(x, dim)), lambda, x, dim)
    }

    /// What a joint bears of transmissions beside its own rows, with these multipliers of all rows and positions `x` of all nodes in the world.
    pub fn borne(&self, joint: usize, lambda: &[f64], x: &[f64]) -> Wrench {
        let mut sum = ([0.0; 3], [0.0; 3]);
        for transmission in self.transmissions.iter().filter(|transmission| transmission.joints.contains(&joint)) {
            let push = self.push(transmission, lambda[transmission.row], x);
            for (_, (force, moment)) in transmission.borne(&push).filter(|(on, _)| *on == joint) {
                (0..3).for_each(|c| (sum.0[c], sum.1[c]) = (sum.0[c] + force[c], sum.1[c] + moment[c]));
            }
        }
        sum
    }

    /// Force and moment of one of the joints whose forces are found, as [`RecordedJoint::wrench`] has it, with what it bears of transmissions.
    pub(crate) fn wrench(&self, joint: usize, simulation: &Simulation) -> Option<Wrench> {
        let found = simulation.found();
        let (told, x) = (self.found_in(&found)?, found.positions());
        let (force, moment) = told.joints[joint].wrench(&found, &x)?;
        let more = told.borne(joint, &found.reactions?.lambda, &x);
        Some((std::array::from_fn(|c| force[c] + more.0[c]), std::array::from_fn(|c| moment[c] + more.1[c])))
    }

    /// Appends the columns of the multipliers, and of what the constraints exert on points.
    pub(super) fn multipliers(&self, found: &Found<'_>, row: &mut Vec<f64>) {
        let (Some(reactions), Some(force)) = (found.reactions, found.constraint_forces()) else { return };
        let dim = self.axes.len();
        row.extend_from_slice(&reactions.lambda);
        for node in self.told().points.iter().filter_map(node) {
            row.extend_from_slice(&force[node.index() * dim..(node.index() + 1) * dim]);
        }
    }
}

/// The column of a size is called as those of its components, without what they differ in.
fn size_heading(components: &[String], [of_force, of_moment]: &[(&'static str, Arc<str>); 2]) -> Heading {
    let [first, second] = [&components[0], &components[1]];
    let same = first.bytes().zip(second.bytes()).take_while(|(a, b)| a == b).count();
    let name = first[..same].trim_end_matches('_');
    // Of a force, and of the shear of a beam.
    let is_force = name.ends_with(".f") || name.ends_with(".shear");
    let (unit, meaning) = if is_force { of_force } else { of_moment };
    Heading::new(name, *unit, Arc::clone(meaning))
}

/// A component of a force (0 to 2) and a moment (3 to 5).
fn component((force, moment): Wrench, k: usize) -> f64 {
    if k < 3 { force[k] } else { moment[k - 3] }
}

/// The node that a point is, where it is one.
pub(super) fn node(point: &RecordedPoint) -> Option<NodeId> {
    match point.terms[..] {
        [Term { place: Place::Node(node), factor: 1.0, turn: 0.0 }] => Some(node),
        _ => None,
    }
}

/// Of the two quaternions of an orientation the one near the last.
fn near(orientation: UnitQuaternion<f64>, last: &UnitQuaternion<f64>) -> UnitQuaternion<f64> {
    if orientation.coords.dot(&last.coords) < 0.0 { UnitQuaternion::new_unchecked(-orientation.into_inner()) } else { orientation }
}
