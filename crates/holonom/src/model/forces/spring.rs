use std::sync::Arc;

use super::along_laws::Along;
use super::coordinate_laws::{self, Resisting, Viscous};
use super::laws::{Damper, ENERGY_VARIABLES, Energy, FORCE_VARIABLES, Force, LinearSpring, SHORTEST};
use crate::model::assembly::Assembly;
use crate::model::bodies::nodes::Member;
use crate::model::element::Element;
use crate::model::ends::{difference, from_to};
use crate::model::entry::Entry;
use crate::model::expression::Program;
use crate::model::fault::Read;
use crate::model::fields::{Keys, List, Number, Place, Site};
use crate::model::geometry::{Vec3, dot, norm, scale};
use crate::model::key::Shape;
use crate::model::references::split_place;
use crate::model::value::Value;
use crate::record::{Lengths, LineKind, SceneAxis, Shows};
use crate::system::{Law, Term};

/// a spring, a damper, or both, between two points or along an axis; linear or as a formula
#[derive(Clone, Debug, PartialEq, Keys)]
#[kind(
    name = "spring",
    equations = "V = ½ k (r − L₀)², tension c ṙ, V(r), tension F(r, ṙ, t), whichever are given, with r = max(|x_b − x_a|, 1e-9 m), or along an axis r = (x_b − x_a)·e",
    example = r#"
[point.bob]
mass = 1
position = [1, 0, 0]

[force.spring]
type = "spring"
between = ["ground", "bob"]
stiffness = 100
damping = 0.5
rest_length = 0.9
energy = "10*(length - 1)^4"
force = "0.1*rate^3"
"#
)]
pub struct Spring {
    /// the two points
    #[key(shape = Shape::Ends(2, 2))]
    pub between: List<Place>,
    /// e, a direction in the axes of the model at the start, which stays, or "BODY.AXIS", which turns with the body: the length is that
    /// along it and may be negative
    #[key(unit = "any", default = "none: from point to point", shape = Shape::Direction)]
    pub along: Option<Site>,
    /// k
    #[key(unit = "N/m", default = "none")]
    pub stiffness: Option<Number>,
    /// L₀, the length without tension of the stiffness, and `rest` in formulas
    #[key(unit = "m", default = "the length at the start")]
    pub rest_length: Option<Number>,
    /// c; what it takes is booked as work
    #[key(unit = "N·s/m", default = "none")]
    pub damping: Option<Number>,
    /// energy as a formula of the length, of `rest` and of `extension`, the length less `rest`
    #[key(unit = "J", default = "none", shape = Shape::Formula(ENERGY_VARIABLES))]
    pub energy: Option<Number>,
    /// tension as a formula of length, rate and t, of `rest` and of `extension`, booked as work
    #[key(unit = "N", default = "none", shape = Shape::Formula(FORCE_VARIABLES))]
    pub force: Option<Number>,
}

impl Element for Spring {
    fn turns(&self) -> Vec<(&'static str, &str)> {
        let axis = self.along.as_ref().and_then(|along| if let Value::Text(name) = &along.0 { split_place(name) } else { None });
        axis.map(|(body, _)| ("along", body)).into_iter().collect()
    }

    fn build(&self, assembly: &mut Assembly<'_>, entry: &Entry<'_>) -> Read<()> {
        let ends = assembly.moving_pair(entry, "between", &self.between);
        let axis = entry.optional("along", &self.along, |along, entry, key| axis(assembly, entry, key, along));
        let stiffness = entry.optional("stiffness", &self.stiffness, Number::not_negative);
        let rest_length = entry.optional("rest_length", &self.rest_length, |length, entry, key| match self.along {
            Some(_) => length.number(entry, key),
            None => length.not_negative(entry, key),
        });
        let damping = entry.optional("damping", &self.damping, Number::not_negative);
        let formula = |key, formula: &Option<Number>, variables: &[&'static str]| {
            entry.optional(key, formula, |formula, entry, key| formula.formula(entry, key, &not_taken(entry, variables)))
        };
        let (energy, force) = (formula("energy", &self.energy, ENERGY_VARIABLES), formula("force", &self.force, FORCE_VARIABLES));
        if let Self { stiffness: None, rest_length: None, damping: None, energy: None, force: None, .. } = self {
            entry.refuse_all(format!("the spring `{}` does nothing", entry.name), "add stiffness, damping, energy or force");
        }
        if let Self { rest_length: Some(_), stiffness: None, energy: None, force: None, .. } = self {
            entry.refuse("rest_length", "a rest length without a stiffness or a formula has no meaning", "add stiffness, energy or force");
        }
        let ([a, b], axis, stiffness, rest_length) = (ends?, axis?, stiffness?, rest_length?);
        let (damping, energy, force) = (damping?, energy?, force?);
        let drawn = if stiffness.is_none() && energy.is_none() { LineKind::Cylinder } else { LineKind::Spring };
        let (d, from_a_to_b) = (difference(&a, &b), from_to(&a, &b));
        let start = axis.as_ref().map_or(norm(d), |axis| dot(d, axis.start));
        let rest = rest_length.unwrap_or(start);
        let shortest = if axis.is_some() { start } else { start.max(SHORTEST) };
        if let Some(formula) = &energy {
            finite(entry, "energy", formula, &[shortest, rest, shortest - rest])?;
        }
        if let Some(formula) = &force {
            finite(entry, "force", formula, &[shortest, 0.0, 0.0, rest, shortest - rest])?;
        }
        let energy = energy.map(|formula| Energy { formula, rest });
        let force = force.map(|formula| Force { formula, rest });
        let (length, laws) = match &axis {
            None => {
                let linear = stiffness.map(|stiffness| law(LinearSpring { stiffness, rest_length: rest }));
                let laws = [linear, damping.map(|damping| law(Damper { damping })), energy.map(law), force.map(law)];
                (assembly.builder.square(&from_a_to_b), laws)
            }
            Some(axis) => {
                let linear = stiffness.map(|stiffness| law(coordinate_laws::Spring { stiffness, rest }));
                let damper = damping.map(|damping| law(Resisting(Viscous(damping))));
                let laws = [linear, damper, energy.map(|energy| law(Along(energy))), force.map(|force| law(Along(force)))];
                (assembly.builder.dot(&from_a_to_b, &axis.terms), laws)
            }
        };
        laws.into_iter().flatten().for_each(|law| assembly.builder.law(entry.name, &[length], law));
        let lengths = if axis.is_some() { Lengths::Along } else { Lengths::Distances { factors: vec![1.0], fixed: 0.0 } };
        assembly.show(Shows::Tension(lengths));
        assembly.draw_along(entry, drawn, &a, &b, axis.map(|axis| axis.drawn));
        Ok(())
    }
}

fn law(law: impl Law + 'static) -> Arc<dyn Law> {
    Arc::new(law)
}

/// The direction that a spring acts along.
struct Axis {
    /// Of length 1, in the axes of the model at the start.
    start: Vec3,
    terms: Vec<Term>,
    drawn: SceneAxis,
}

fn axis(assembly: &Assembly<'_>, entry: &Entry<'_>, key: &str, along: &Site) -> Read<Axis> {
    let direction = assembly.direction_at_start(entry, key.into(), &along.0)?;
    let size = norm(direction);
    if size == 0.0 {
        return Err(entry.refuse(key, "an axis of zero length has no direction", "give the direction of the axis"));
    }
    let start = scale(direction, 1.0 / size);
    let member = match &along.0 {
        Value::Text(name) => assembly.member(entry, key.into(), split_place(name).expect("an axis of a body").0)?,
        _ => Member::Ground,
    };
    let (body, local) = match member {
        Member::Body(k) => (Some(assembly.bodies[k].name.clone()), assembly.bodies[k].local_direction(start)),
        _ => (None, start),
    };
    let drawn = SceneAxis { body, axis: assembly.axes.in_world(local) };
    Ok(Axis { start, terms: assembly.frame(member).vector(start), drawn })
}

/// The variables of a formula by name. A parameter or an index called `rest` or `extension` comes before the variable.
fn not_taken(entry: &Entry<'_>, variables: &[&'static str]) -> Vec<&'static str> {
    let is_taken = |name: &str| ["rest", "extension"].contains(&name) && entry.scope.value(name).is_some();
    variables.iter().map(|&name| if is_taken(name) { "" } else { name }).collect()
}

/// A formula must at least be a number where the simulation starts.
fn finite(entry: &Entry<'_>, key: &str, formula: &Program, at: &[f64]) -> Read<()> {
    let value = formula.evaluate(at);
    if value.is_finite() {
        return Ok(());
    }
    Err(entry.refuse(key, format!("this formula is {value} for the length {} m of the start", at[0]), "it must be finite"))
}
