//! `[beam.NAME]`: straight elastic beams, a chain of frames with elements between them (methods §22).
//!
//! Each node of a beam is a rigid body with the cross section's inertia, so that joints, forces and bodies hold on to it as to any other. The
//! elements give the frames their stiffness, and spread the mass along the cubic through their places and tangents.

mod section;
mod strain;

use std::sync::Arc;

use nalgebra::{Matrix3, Vector3};

use section::Numbers;
pub use section::Section;
use strain::{Across, Rotation, Strain};

use super::assembly::Assembly;
use super::bodies::nodes::Member;
use super::bodies::{RigidBody, short};
use super::ends::{End, subtract};
use super::entry::Entry;
use super::fault::Read;
use super::fields::{Keys, List, Number, Turn};
use super::forces::{LinearSpring, Resisting, Viscous};
use super::geometry::{self, Vec3, dot, norm, scale, unit};
use super::key::Shape;
use super::repeat;
use super::spread::{Moving, spread};
use super::start::hold;
use crate::record::{Along, LineKind, Shows};
use crate::system::{Constant, FunctionId, InvariantId, Part, SystemBuilder, Term};

/// A straight elastic beam.
#[derive(Clone, Debug, PartialEq, Keys)]
#[table("a beam")]
pub struct Beam {
    /// its first end at the start
    #[key(unit = "m", shape = Shape::Vector)]
    pub from: List<Number>,
    /// its second end at the start
    #[key(unit = "m", shape = Shape::Vector)]
    pub to: List<Number>,
    /// number of elements; n of them have n + 1 bodies at their ends, `NAME[0]` to `NAME[n]`
    #[key(default = "8", shape = Shape::Whole)]
    pub elements: Option<Number>,
    /// its cross section
    pub section: Section,
    /// Young's modulus
    #[key(unit = "N/m²")]
    pub modulus: Number,
    /// Poisson's ratio, which the shear modulus follows from
    #[key(default = "0.3")]
    pub poisson: Option<Number>,
    /// of the material
    #[key(unit = "kg/m³")]
    pub density: Number,
    /// direction that z of the beam is as near to as it can be; x goes along it
    #[key(unit = "any", default = "z of the model, or x for beams along z", shape = Shape::Vector)]
    pub up: Option<List<Number>>,
    /// of the material: stress per rate of strain over the modulus
    #[key(unit = "s", default = "0")]
    pub damping: Option<Number>,
    /// of its first end, at the start; the beam moves as a rigid body then
    #[key(unit = "m/s", default = "0", shape = Shape::Vector)]
    pub velocity: Option<List<Number>>,
    /// in the axes of the model, at the start; one number in a planar model
    #[key(unit = "rad/s", default = "0")]
    pub angular_velocity: Option<Turn>,
}

/// A beam with its numbers.
pub(super) struct Evaluated {
    pub name: String,
    /// Position of its first body in the list.
    first: usize,
    elements: usize,
    /// Of an element, m.
    length: f64,
    /// kg/m
    line_density: f64,
    /// x, y and z of the beam at the start; in the plane x and y.
    axes: Vec<Vec3>,
    /// Along the axes, then about them, N/m and N·m/rad.
    stiffness: Vec<f64>,
    /// Shares of bending in how soft it is across, along y and z; in the plane along y.
    bending: Vec<f64>,
    /// s
    damping: f64,
    /// Whether it is too thin to be seen with its section.
    is_thin: bool,
}

impl Beam {
    /// Its numbers, and the bodies at the ends of its elements, which go behind `bodies`.
    pub(super) fn evaluate(&self, entry: &Entry<'_>, dim: usize, bodies: &mut Vec<RigidBody>) -> Read<Evaluated> {
        let vector = |list: &List<Number>, key: &str| list.vector(entry, key, dim);
        let (from, to) = (vector(&self.from, "from"), vector(&self.to, "to"));
        let elements = entry.optional("elements", &self.elements, |elements, entry, key| elements.whole(entry, key, 1));
        let poisson = entry.optional("poisson", &self.poisson, Number::number).and_then(|poisson| match poisson.unwrap_or(0.3) {
            ratio if ratio > -1.0 && ratio <= 0.5 => Ok(ratio),
            ratio => Err(entry.refuse("poisson", format!("a Poisson's ratio is between -1 and 0.5, and this is {ratio}"), "steel has 0.3")),
        });
        let of_section = poisson.unwrap_or(0.3);
        let section = entry.within("section", &self.section, |entry| self.section.evaluate(entry, dim, of_section));
        let (modulus, density) = (self.modulus.positive(entry, "modulus"), self.density.positive(entry, "density"));
        let up = entry.optional("up", &self.up, |up, entry, key| up.vector(entry, key, dim));
        let damping = entry.optional("damping", &self.damping, Number::not_negative);
        let velocity = entry.optional("velocity", &self.velocity, |velocity, entry, key| velocity.vector(entry, key, dim));
        let angular_velocity = entry.optional("angular_velocity", &self.angular_velocity, |turn, entry, key| turn.vector(entry, key, dim));
        let (from, to, elements, poisson, section) = (from?, to?, elements?.unwrap_or(8) as usize, poisson?, section?);
        let (modulus, density, up, damping) = (modulus?, density?, up?, damping?.unwrap_or(0.0));
        let (velocity, angular_velocity) = (velocity?.unwrap_or_default(), angular_velocity?.unwrap_or_default());
        let whole = geometry::subtract(to, from);
        if norm(whole) == 0.0 {
            return Err(entry.refuse("to", "the beam has no length: it ends where it begins", "move one of its ends"));
        }
        if bodies.len() + elements > repeat::MOST {
            return Err(entry.refuse(
                "elements",
                format!("the beams of this model make more than {} bodies", repeat::MOST),
                "take fewer elements",
            ));
        }
        let axes = axes(entry, dim, scale(whole, 1.0 / norm(whole)), up)?;
        let length = norm(whole) / elements as f64;
        let world_from_body = match dim {
            2 => Matrix3::from_columns(&[axes[0].into(), axes[1].into(), Vector3::z()]),
            _ => Matrix3::from_fn(|i, j| axes[j][i]),
        };
        let first = bodies.len();
        for k in 0..=elements {
            let share = if k == 0 || k == elements { 0.5 } else { 1.0 };
            let of_area = share * density * length;
            let [about_y, about_z] = section.second.map(|second| of_area * second);
            let local = Matrix3::from_diagonal(&Vector3::new(about_y + about_z, about_y, about_z));
            let position: Vec3 = std::array::from_fn(|c| from[c] + whole[c] * (k as f64 / elements as f64));
            let arm = Vector3::from(geometry::subtract(position, from));
            bodies.push(RigidBody {
                name: format!("{}[{k}]", entry.name),
                path: entry.path.to_string(),
                mass: of_area * section.area,
                inertia: world_from_body * local * world_from_body.transpose(),
                position,
                world_from_body,
                turned: if dim == 2 { axes[0][1].atan2(axes[0][0]) } else { 0.0 },
                velocity: (Vector3::from(velocity) + Vector3::from(angular_velocity).cross(&arm)).into(),
                angular_velocity,
                points: Vec::new(),
                axes: Vec::new(),
                shape: Some(
                    section.outline.prism(if k == 0 { 0.0 } else { -0.5 * length }, if k == elements { 0.0 } else { 0.5 * length }),
                ),
            });
        }
        let (stiffness, bending) = stiffness(&section, dim, length, modulus, 0.5 * modulus / (1.0 + poisson));
        let line_density = density * section.area;
        let (across, along) = (section.outline.size(), norm(whole));
        if across > along {
            entry.note("section", format!("the section is {} m across, and the beam {} m long: check units", short(across), short(along)));
        }
        let is_thin = across < THIN * along;
        Ok(Evaluated { name: entry.name.to_string(), first, elements, length, line_density, axes, stiffness, bending, damping, is_thin })
    }
}

/// x along the beam, y and z across it, which with `up` is as near to that as it can be.
fn axes(entry: &Entry<'_>, dim: usize, along: Vec3, up: Option<Vec3>) -> Read<Vec<Vec3>> {
    if dim == 2 {
        return match up {
            Some(_) => Err(entry.refuse_key("up", "a planar beam is bent in its plane, and `up` says nothing", "remove it")),
            None => Ok(vec![along, geometry::across(along, 2)[0]]),
        };
    }
    let is_upright = dot(along, unit(2)).abs() > UPRIGHT;
    let wanted = up.unwrap_or(if is_upright { unit(0) } else { unit(2) });
    if norm(wanted) == 0.0 {
        return Err(entry.refuse("up", "a direction of zero length is none", "give a direction across the beam"));
    }
    let across = geometry::rest(&[along], wanted);
    if norm(across) <= ALONG * norm(wanted) {
        return Err(entry.refuse(
            "up",
            "`up` goes along the beam, so that it does not say how the section is turned",
            "give another direction",
        ));
    }
    let z = scale(across, 1.0 / norm(across));
    Ok(vec![along, geometry::cross(z, along), z])
}

/// Share of its length below which a beam is drawn as a line.
const THIN: f64 = 0.01;

/// Cosine of the angle with z from which on a beam counts as one along z.
const UPRIGHT: f64 = 0.999;

/// Sine of the angle with the beam below which a direction goes along it.
const ALONG: f64 = 1e-6;

/// Along the axes, then about them. The shear stiffness has the deflection of the bending that one rotation of an element does not have, L³/12 E I,
/// so that forces and moments at its ends deform it as they deform a beam (MacNeal 1978); behind the stiffness stands what share of the deflection that is.
fn stiffness(section: &Numbers, dim: usize, length: f64, modulus: f64, shear_modulus: f64) -> (Vec<f64>, Vec<f64>) {
    let [about_y, about_z] = section.second.map(|second| modulus * second);
    let shear = |k: usize, bending: f64| {
        let of_bending = length.powi(3) / (12.0 * bending);
        let softness = length / (section.shear[k] * shear_modulus * section.area) + of_bending;
        (1.0 / softness, of_bending / softness)
    };
    let axial = modulus * section.area / length;
    let (along_y, of_y) = shear(0, about_z);
    if dim == 2 {
        return (vec![axial, along_y, about_z / length], vec![of_y]);
    }
    let (along_z, of_z) = shear(1, about_y);
    (vec![axial, along_y, along_z, shear_modulus * section.torsion / length, about_y / length, about_z / length], vec![of_y, of_z])
}

/// An element of a beam: the bodies at its ends, and its deformations.
pub struct Elastic {
    pub bodies: [usize; 2],
    coordinates: Vec<FunctionId>,
}

/// The same mechanism with elements that stay deformed as they are: beams go along so where joints lead a mechanism to its start, and set it off there.
pub(super) fn stiffened(builder: &SystemBuilder, elastic: &[Elastic]) -> SystemBuilder {
    let (mut stiff, first) = (builder.clone(), builder.rows());
    for &coordinate in elastic.iter().flat_map(|element| &element.coordinates) {
        stiff.row("beam", coordinate, Arc::new(Constant(0.0)));
    }
    hold(&mut stiff, first, |value| Arc::new(Constant(value)));
    stiff
}

impl Evaluated {
    /// Bodies at the ends of its elements.
    pub fn bodies(&self) -> std::ops::RangeInclusive<usize> {
        self.first..=self.first + self.elements
    }

    /// Spreads the mass over the elements: what their bodies have in their places goes along the cubic through places and tangents, whose mass
    /// matrix is that of bending (methods §22).
    pub fn spread_mass(&self, assembly: &mut Assembly<'_>) {
        let (mass, length) = (self.line_density * self.length, self.length);
        let (place, tangent) = (mass / 420.0, mass * length / 420.0);
        let entries = [
            // Half of the mass is in each place already.
            (0, 0, 156.0 * place - 0.5 * mass),
            (2, 2, 156.0 * place - 0.5 * mass),
            (0, 2, 54.0 * place),
            (0, 1, 22.0 * tangent),
            (2, 3, -22.0 * tangent),
            (0, 3, -13.0 * tangent),
            (1, 2, 13.0 * tangent),
            (1, 1, 4.0 * tangent * length),
            (3, 3, 4.0 * tangent * length),
            (1, 3, -3.0 * tangent * length),
        ];
        for k in 0..self.elements {
            let of = |body: usize| {
                let (frame, at) = (&assembly.frames[body], assembly.bodies[body].position);
                [frame.point(at), frame.vector(self.axes[0])].map(|terms| Moving::new(assembly, terms, Some(body)))
            };
            let [[a, u], [b, w]] = [self.first + k, self.first + k + 1].map(of);
            let moving = [a, u, b, w];
            for (tangent, sign) in [(1, 1.0), (3, -1.0)] {
                let moment = sign * mass * length / 12.0;
                moving[tangent].terms.iter().for_each(|&term| assembly.builder.weight(term, moment));
            }
            spread(&mut assembly.builder, &moving, &entries);
        }
    }

    /// Adds what its elements do to the bodies at their ends; those have the name of the second.
    pub fn build(&self, assembly: &mut Assembly<'_>) {
        for k in 1..=self.elements {
            let bodies = [self.first + k - 1, self.first + k];
            let name = format!("{}[{k}]", self.name);
            let ends = bodies.map(|body| end(assembly, body));
            let coordinates = self.coordinates(assembly, bodies, &ends);
            if self.is_thin {
                assembly.draw_line(&name, LineKind::Bar, &ends[0], &ends[1], None);
            }
            assembly.record(&name, |assembly| {
                for (&q, &stiffness) in coordinates.iter().zip(&self.stiffness) {
                    assembly.builder.law(&*name, &[q], Arc::new(LinearSpring { stiffness, rest: 0.0 }));
                    if self.damping > 0.0 {
                        assembly.builder.law(&*name, &[q], Arc::new(Resisting(Viscous(self.damping * stiffness))));
                    }
                }
                assembly.show(Shows::Section { coordinates: shown(&coordinates), length: self.length });
            });
            assembly.elastic.push(Elastic { bodies, coordinates });
        }
    }

    /// Displacements of the second end against the first along the mean axes of both, m, and the rotation vector, rad; zero at the start.
    fn coordinates(&self, assembly: &mut Assembly<'_>, bodies: [usize; 2], ends: &[End; 2]) -> Vec<FunctionId> {
        let dim = assembly.dimension();
        let [a, b]: [Vec<Vec<Term>>; 2] = bodies.map(|body| self.axes.iter().map(|&axis| assembly.frames[body].vector(axis)).collect());
        let mean: Vec<Vec<Term>> = a.iter().zip(&b).map(|(a, b)| subtract(&times(a, 0.5), &times(b, -0.5))).collect();
        let way = times(&subtract(&ends[1].terms, &ends[0].terms), 1.0 / self.length);
        let builder = &mut assembly.builder;
        let cosines: Vec<_> = a.iter().zip(&b).take(if dim == 2 { 1 } else { 3 }).map(|(a, b)| builder.dot(a, b)).collect();
        let strains: Vec<_> = mean.iter().map(|axis| builder.dot(&way, axis)).collect();
        let sine = |k: usize| match dim {
            2 => builder.cross([0.0; 3], &a[0], &b[0]),
            // ½ (a_j·b_i − a_i·b_j), as axes of a body have unit length.
            _ => builder.dot(&mean[(k + 2) % 3], &subtract(&b[(k + 1) % 3], &a[(k + 1) % 3])),
        };
        let sines: Vec<_> = if dim == 2 { 2..3 } else { 0..3 }.map(sine).collect();
        // What an element does across depends on the turns about the axes across.
        let of = [&strains[..], &cosines[..1], &sines[sines.len() + 1 - dim..]].concat();
        // ∫ w′²/2 of what bends to and fro, and what shear and that have in common (methods §22).
        let of_across = self.bending.iter().map(|share| share * (2.0 - 0.8 * share)).collect();
        let along = Part::Smooth { of: of.clone(), function: Arc::new(Strain { across: of_across }) };
        let across = (0..dim - 1).map(|axis| Part::Smooth { of: of[1..].to_vec(), function: Arc::new(Across { axis }) });
        let rotation = |&sine: &InvariantId| {
            let of = std::iter::once(sine).chain(cosines.iter().copied()).collect();
            (Part::Smooth { of, function: Arc::new(Rotation) }, 1.0)
        };
        let ways = std::iter::once(along).chain(across).map(|part| (part, self.length));
        ways.chain(sines.iter().map(rotation)).map(|part| builder.sum(&[part])).collect()
    }
}

/// The middle of a body as an end.
fn end(assembly: &Assembly<'_>, body: usize) -> End {
    let start = assembly.bodies[body].position;
    let terms = assembly.frame(Member::Body(body)).point(start);
    End { terms, start, free: true, point: None, body: Some(body), name: assembly.bodies[body].name.clone() }
}

fn times(terms: &[Term], factor: f64) -> Vec<Term> {
    terms.iter().map(|term| Term { factor: factor * term.factor, turn: factor * term.turn, ..*term }).collect()
}

/// The coordinates with the names of the columns of what the part behind an element exerts on the part before it.
fn shown(coordinates: &[FunctionId]) -> Vec<Along> {
    let names: &[[&str; 2]] = match coordinates.len() {
        3 => &[["normal", "normal force, above zero in tension"], ["shear", "shear force"], ["moment", "bending moment"]],
        _ => &[
            ["normal", "normal force, above zero in tension"],
            ["shear_y", "shear force along y of the beam"],
            ["shear_z", "shear force along z of the beam"],
            ["torque", "moment about the beam"],
            ["moment_y", "bending moment about y of the beam"],
            ["moment_z", "bending moment about z of the beam"],
        ],
    };
    let forces = coordinates.len().div_ceil(2);
    let along = names.iter().zip(coordinates).enumerate().map(|(k, ([suffix, words], &coordinate))| {
        let is_angle = k >= forces;
        let place = if is_angle { "as a mean over the element" } else { "in the middle of the element" };
        Along { coordinate, value: None, effort: [suffix.to_string(), format!("{words}, {place}, on the part before it")], is_angle }
    });
    along.collect()
}
