//! Forces and torques on bodies, as formulas of time and of the motion of the body.
//!
//! A force at a place goes to the nodes that the place is made of; a torque n is c × e_k on each of the three axes of the body, with c so that
//! their moment is n, and these go to their nodes: moments are exact, at means of two positions too (methods §6).

use std::sync::Arc;

use smallvec::SmallVec;

use crate::model::assembly::Assembly;
use crate::model::bodies::nodes::Member;
use crate::model::ends::End;
use crate::model::entry::{Entry, Spot};
use crate::model::expression::Program;
use crate::model::fault::Read;
use crate::model::fields::{List, Number, Turn};
use crate::model::geometry::unit;
use crate::model::signals::{ROOM, Reader, Readings};
use crate::model::spin::{angular_velocity, turning};
use crate::model::sum::{Sum, cross};
use crate::model::tables::require_inside;
use crate::model::value::Value;
use crate::record::{Exerts, Shows};
use crate::system::{Bend, Differentiated, ForceFunction, Number as AnyNumber, Reading};

/// Time, place, its velocity, and angular velocity of the body.
pub(super) const VARIABLES: &[&str] = &["t", "x", "y", "z", "vx", "vy", "vz", "wx", "wy", "wz"];

/// Those of a planar model whose plane has the axes of these letters; `w` is the angular velocity.
fn variables(axes: &str) -> Vec<String> {
    let own = |prefix: &'static str| axes.chars().map(move |axis| format!("{prefix}{axis}"));
    let turns = if axes.len() == 2 { vec!["w".to_string()] } else { own("w").collect() };
    std::iter::once("t".to_string()).chain(own("")).chain(own("v")).chain(turns).collect()
}

/// The body of a name.
pub(super) fn body(assembly: &Assembly<'_>, entry: &Entry<'_>, key: &str, name: &str) -> Read<usize> {
    match assembly.member(entry, key.into(), name)? {
        Member::Body(k) => Ok(k),
        Member::Point(_) => {
            let cure = "name a [body.NAME]; a point takes forces of type \"constant\" and \"expression\"";
            Err(entry.refuse(key, format!("`{name}` is a point, and a body is wanted here"), cure))
        }
        Member::Bar(_) => {
            let cure = "name a [body.NAME]; a bar takes forces at its ends, and torques of type \"effort\" along the angle of a joint between it and others";
            Err(entry.refuse(key, format!("`{name}` is a bar, and a body is wanted here"), cure))
        }
        Member::Ground => Err(entry.refuse(key, format!("`{name}` is no body"), "name a [body.NAME]")),
    }
}

/// A force at a place of a body, or a torque on it and its reaction on another one.
struct BodyLoad {
    dim: usize,
    readings: Readings,
    point: Sum,
    /// Body axes: three, in the plane the first.
    axes: Vec<Sum>,
    /// Those of the body that takes the reaction.
    other: Vec<Sum>,
    formulas: Vec<Program>,
    /// Whether the formulas are numbers.
    is_constant: bool,
    is_torque: bool,
    in_body_axes: bool,
}

impl BodyLoad {
    /// What the formulas are of.
    fn variables<N: AnyNumber>(&self, x: &[N], v: &[N], t: N) -> SmallVec<[N; ROOM]> {
        let dim = self.dim;
        let turn = angular_velocity(&self.axes, x, v, dim);
        let mut variables = SmallVec::from_slice(&[t]);
        variables.extend_from_slice(&self.point.at(x, dim, 1.0)[..dim]);
        variables.extend_from_slice(&self.point.at(v, dim, 0.0)[..dim]);
        variables.extend_from_slice(if dim == 2 { &turn[2..] } else { &turn[..] });
        self.readings.append(x, v, &mut variables);
        variables
    }

    /// The formulas at a state.
    fn given<N: AnyNumber>(&self, x: &[N], v: &[N], t: N) -> [N; 3] {
        let mut given = [N::from(0.0); 3];
        let variables = if self.is_constant { SmallVec::new() } else { self.variables(x, v, t) };
        given.iter_mut().zip(&self.formulas).for_each(|(given, formula)| *given = formula.evaluate(&variables));
        given
    }

    /// Σ g_k e_k.
    fn in_world<N: AnyNumber>(&self, given: [N; 3], axes: &[[N; 3]]) -> [N; 3] {
        if self.dim == 2 {
            let [x, y, _] = axes[0];
            return [x * given[0] - y * given[1], y * given[0] + x * given[1], N::from(0.0)];
        }
        std::array::from_fn(|c| axes[0][c] * given[0] + axes[1][c] * given[1] + axes[2][c] * given[2])
    }

    /// The force or torque in the axes of the model; a torque in the plane last.
    fn exerted<N: AnyNumber>(&self, x: &[N], v: &[N], t: N) -> [N; 3] {
        let (dim, zero, given) = (self.dim, N::from(0.0), self.given(x, v, t));
        match (dim, self.is_torque) {
            (2, true) => [zero, zero, given[0]],
            _ if self.in_body_axes => {
                let mut axes = [[zero; 3]; 3];
                axes.iter_mut().zip(&self.axes).for_each(|(axis, sum)| *axis = sum.at(x, dim, 1.0));
                self.in_world(given, &axes)
            }
            _ => given,
        }
    }
}

impl Exerts for BodyLoad {
    fn exerted(&self, x: &[f64], v: &[f64], t: f64) -> [f64; 3] {
        self.exerted(x, v, t)
    }
}

impl ForceFunction for BodyLoad {
    fn bends(&self, x: &[f64], v: &[f64], t: f64, note: &mut dyn FnMut(Bend)) {
        let variables = self.variables(x, v, t);
        self.formulas.iter().for_each(|formula| formula.bends(&variables, note));
    }

    fn evaluate<N: AnyNumber>(&self, x: &[N], v: &[N], t: N, force: &mut [N]) {
        let (dim, exerted) = (self.dim, self.exerted(x, v, t));
        force.fill(N::from(0.0));
        if !self.is_torque {
            self.point.spread(exerted, dim, force);
            return;
        }
        for (sums, sign) in [(&self.axes, 1.0), (&self.other, -1.0)].into_iter().filter(|(sums, _)| !sums.is_empty()) {
            let axes: SmallVec<[[N; 3]; 3]> = sums.iter().map(|sum| sum.at(x, dim, 1.0)).collect();
            let c = turning(exerted, &axes, dim);
            for (sum, axis) in sums.iter().zip(axes) {
                sum.spread(cross(c, axis).map(|c| c * sign), dim, force);
            }
        }
    }
}

/// Components of a force or of a torque.
pub(super) enum Formulas<'a> {
    Force(&'a List<Number>),
    Torque(&'a Turn),
}

/// A force or torque before it becomes a load.
pub(super) struct Given<'a> {
    pub body: usize,
    pub at: End,
    pub other: Option<usize>,
    pub formulas: Formulas<'a>,
    /// `"world"` or `"body"`.
    pub axes: Option<&'a str>,
}

/// Adds a force or torque.
pub(super) fn add(assembly: &mut Assembly<'_>, entry: &Entry<'_>, given: Given<'_>) -> Read<()> {
    let dim = assembly.dimension();
    let names = variables(assembly.axes.name);
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    let (key, is_torque) = match given.formulas {
        Formulas::Force(_) => ("force", false),
        Formulas::Torque(_) => ("torque", true),
    };
    let mut readings = Readings::new(dim, Reading::default());
    let mut reader = Reader::new(assembly, entry, &mut readings);
    let formulas = match (given.formulas, dim) {
        (Formulas::Force(force), _) | (Formulas::Torque(Turn::InSpace(force)), 3) => {
            force.formulas_reading(entry, key, dim, &names, &mut reader)
        }
        (Formulas::Torque(Turn::InPlane(torque)), 2) => {
            torque.formula_reading(entry, key, &names, &mut reader).map(|formula| vec![formula])
        }
        (Formulas::Torque(Turn::InPlane(_)), _) => {
            Err(entry.refuse(key, format!("`{key}` wants a list of {dim} numbers or formulas"), "give one for each axis of the model"))
        }
        (Formulas::Torque(Turn::InSpace(_)), _) => Err(entry.wanted(key.into(), "a number", &Value::List(Vec::new()))),
    };
    let in_body_axes = given.axes.map(|axes| entry.choice("axes", axes, &["world", "body"])).transpose();
    let (formulas, in_body_axes) = (formulas?, in_body_axes? == Some("body"));
    let nodes = &mut readings.reading.nodes;
    let point = Sum::new(&given.at.terms, nodes);
    let mut axes = |body: usize| -> Vec<Sum> {
        let own = |k: usize| assembly.frames[body].vector(assembly.bodies[body].direction(unit(k)));
        (0..if dim == 2 { 1 } else { 3 }).map(|k| Sum::new(&own(k), nodes)).collect()
    };
    let own = axes(given.body);
    let other = given.other.map_or(Vec::new(), axes);
    finite(entry, key, &given.at, &formulas, &readings)?;
    let reading = readings.reading.clone();
    let is_constant = formulas.iter().all(|formula| formula.as_constant().is_some());
    let load = Arc::new(BodyLoad { dim, readings, point, axes: own, other, formulas, is_constant, is_torque, in_body_axes });
    assembly.builder.load_reading(entry.name, reading, Arc::new(Differentiated(load.clone())));
    assembly.draw_load(entry, &given.at);
    assembly.show(Shows::Load { is_moment: is_torque, exerts: load });
    Ok(())
}

/// Formulas must at least be numbers where the body starts, unless they read more.
fn finite(entry: &Entry<'_>, key: &str, place: &End, formulas: &[Program], readings: &Readings) -> Read<()> {
    if readings.len() > 0 {
        return Ok(());
    }
    let (mut at, dim) = ([0.0; VARIABLES.len()], readings.dim());
    at[1..1 + dim].copy_from_slice(&place.start[..dim]);
    for (k, formula) in formulas.iter().enumerate() {
        let value = formula.evaluate(&at);
        if !value.is_finite() {
            let item = (formulas.len() > 1).then_some(k);
            require_inside(entry, Spot { key, item }, formula, &at)?;
            let message = format!("this formula is {value} where the body starts, at rest and at t = 0");
            return Err(entry.refuse(Spot { key, item }, message, "it must be finite"));
        }
    }
    Ok(())
}
