use std::sync::Arc;

use super::along_laws::Along;
use super::coordinate_laws::{self, Resisting, Viscous};
use super::following::{Follows, SpringLoad, any, not_negative};
use super::laws::{Damper, ENERGY_VARIABLES, Energy, FORCE_VARIABLES, Force, LinearSpring};
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
use crate::model::signals::{Reader, Readings};
use crate::model::tables::require_inside;
use crate::model::value::Value;
use crate::record::{Lengths, LineKind, SceneAxis, Shows};
use crate::system::{Differentiated, Law, Quantity, Reading, Term};

/// a spring, a damper, or both, between two points or along an axis; linear or as a formula
#[derive(Clone, Debug, PartialEq, Keys)]
#[kind(
    name = "spring",
    equations = "V = ½ k (r − L₀)², tension c ṙ, V(r), tension F(r, ṙ, t), whichever are given, with r = |x_b − x_a|, or along an axis r = (x_b − x_a)·e",
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
    /// k; as a formula of t, of inputs, measures and what moves, by the names of columns, its work is booked
    #[key(unit = "N/m", default = "none", shape = Shape::Formula(&["t"]))]
    pub stiffness: Option<Number>,
    /// L₀, the length without tension of the stiffness, and `rest` in formulas; as k it may be a formula
    #[key(unit = "m", default = "the length at the start", shape = Shape::Formula(&["t"]))]
    pub rest_length: Option<Number>,
    /// c, which may be a formula as k; what it takes is booked as work
    #[key(unit = "N·s/m", default = "none", shape = Shape::Formula(&["t"]))]
    pub damping: Option<Number>,
    /// energy as a formula of the length, of `rest` and of `extension`, the length less `rest`
    #[key(unit = "J", default = "none", shape = Shape::Formula(ENERGY_VARIABLES))]
    pub energy: Option<Number>,
    /// tension as a formula of length, rate and t, of `rest` and of `extension`, of inputs, measures and what moves, booked as work
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
        let mut readings = Readings::new(assembly.dimension(), Reading::default());
        let stiffness = Follows::optional(assembly, &mut readings, (entry, "stiffness"), &self.stiffness, not_negative);
        let length = if self.along.is_some() { any } else { not_negative };
        let rest = Follows::optional(assembly, &mut readings, (entry, "rest_length"), &self.rest_length, length);
        let damping = Follows::optional(assembly, &mut readings, (entry, "damping"), &self.damping, not_negative);
        let energy =
            entry.optional("energy", &self.energy, |formula, entry, key| formula.formula(entry, key, &not_taken(entry, ENERGY_VARIABLES)));
        let force = entry.optional("force", &self.force, |formula, entry, key| {
            let variables = not_taken(entry, FORCE_VARIABLES);
            formula.formula_reading(entry, key, &variables, &mut Reader::new(assembly, entry, &mut readings))
        });
        if let Self { stiffness: None, rest_length: None, damping: None, energy: None, force: None, .. } = self {
            entry.refuse_all(format!("the spring `{}` does nothing", entry.name), "add stiffness, damping, energy or force");
        }
        if let Self { rest_length: Some(_), stiffness: None, energy: None, force: None, .. } = self {
            entry.refuse("rest_length", "a rest length without a stiffness or a formula has no meaning", "add stiffness, energy or force");
        }
        let ([a, b], axis, stiffness, rest_length) = (ends?, axis?, stiffness?, rest?);
        let (damping, energy, force) = (damping?, energy?, force?);
        if rest_length.as_ref().is_some_and(Follows::is_formula) && energy.is_some() {
            let message = "an energy is one of the length alone, and here `rest_length` follows something else";
            return Err(entry.refuse("energy", message, "write the tension as `force`, or give a number as rest_length"));
        }
        let drawn = if stiffness.is_none() && energy.is_none() { LineKind::Cylinder } else { LineKind::Spring };
        let (d, from_a_to_b) = (difference(&a, &b), from_to(&a, &b));
        let start = axis.as_ref().map_or(norm(d), |axis| dot(d, axis.start));
        let rest = rest_length.unwrap_or(Follows::Known(start));
        let length: Quantity = match &axis {
            None => assembly.builder.square(&from_a_to_b).into(),
            Some(axis) => assembly.builder.dot(&from_a_to_b, &axis.terms).into(),
        };
        let shortest = assembly.shortest(start, rest.known().unwrap_or(0.0));
        let acting = Acting { quantity: length, is_along: axis.is_some(), start, shortest };
        acting.build(assembly, entry, Parts { stiffness, damping, energy, force }, rest, readings)?;
        let lengths = if axis.is_some() { Lengths::Along } else { Lengths::Distances { factors: vec![1.0], fixed: 0.0, drum: None } };
        assembly.show(Shows::Tension { quantities: vec![length], lengths, shortest });
        assembly.draw_along(entry, drawn, &a, &b, axis.map(|axis| axis.drawn));
        Ok(())
    }
}

/// What a spring acts on.
pub(super) struct Acting {
    /// Half the square of a distance, or a coordinate.
    pub quantity: Quantity,
    /// Whether it is a coordinate.
    pub is_along: bool,
    /// The length or the coordinate at the start, m or rad.
    pub start: f64,
    /// Distances below this count as this, m.
    pub shortest: f64,
}

impl Acting {
    /// Adds the laws of a spring, and the load that its numbers make which follow something else.
    pub fn build(self, assembly: &mut Assembly<'_>, entry: &Entry<'_>, parts: Parts, rest: Follows, mut readings: Readings) -> Read<()> {
        let (parts, followed) = parts.split(&rest);
        // Where the rest length follows something, no law has it.
        let known = rest.known().unwrap_or(self.start);
        parts.check(entry, if self.is_along { self.start } else { self.start.max(self.shortest) }, known)?;
        for law in parts.laws(known, self.is_along, self.shortest) {
            assembly.builder.law(entry.name, &[self.quantity], law);
        }
        if let Some(Parts { stiffness, damping, force, .. }) = followed {
            let own = readings.own(self.quantity);
            let reading = readings.reading.clone();
            let load = SpringLoad { own, is_square: !self.is_along, shortest: self.shortest, stiffness, rest, damping, force, readings };
            assembly.builder.load_reading(entry.name, reading, Arc::new(Differentiated(load)));
        }
        Ok(())
    }
}

/// What a spring consists of.
#[derive(Default)]
pub(super) struct Parts {
    pub stiffness: Option<Follows>,
    pub damping: Option<Follows>,
    pub energy: Option<Program>,
    pub force: Option<Program>,
}

impl Parts {
    /// What depends on the length, its rate and the time alone, and is laws of these; and what follows something else, where there is
    /// anything.
    fn split(mut self, rest: &Follows) -> (Self, Option<Self>) {
        let mut followed = Self::default();
        let moves = rest.is_formula();
        if moves || self.stiffness.as_ref().is_some_and(Follows::is_formula) {
            followed.stiffness = self.stiffness.take();
        }
        if self.damping.as_ref().is_some_and(Follows::is_formula) {
            followed.damping = self.damping.take();
        }
        if moves || self.force.as_ref().is_some_and(|force| force.reads_behind(FORCE_VARIABLES.len())) {
            followed.force = self.force.take();
        }
        let is_any = followed.stiffness.is_some() || followed.damping.is_some() || followed.force.is_some();
        (self, is_any.then_some(followed))
    }

    /// Formulas must at least be numbers where the simulation starts.
    fn check(&self, entry: &Entry<'_>, start: f64, rest: f64) -> Read<()> {
        if let Some(formula) = &self.energy {
            finite(entry, "energy", formula, &[start, rest, start - rest])?;
        }
        match &self.force {
            Some(formula) => finite(entry, "force", formula, &[start, 0.0, 0.0, rest, start - rest]),
            None => Ok(()),
        }
    }

    fn laws(self, rest: f64, is_along: bool, shortest: f64) -> Vec<Arc<dyn Law>> {
        let known = |number: Option<Follows>| number.and_then(|number| number.known());
        let (stiffness, damping) = (known(self.stiffness), known(self.damping));
        let energy = self.energy.map(|formula| Energy { formula, rest, shortest });
        let force = self.force.map(|formula| Force { formula, rest, shortest });
        let laws = if is_along {
            let linear = stiffness.map(|stiffness| law(coordinate_laws::Spring { stiffness, rest }));
            let damper = damping.map(|damping| law(Resisting(Viscous(damping))));
            [linear, damper, energy.map(|energy| law(Along(energy))), force.map(|force| law(Along(force)))]
        } else {
            let linear = stiffness.map(|stiffness| law(LinearSpring { stiffness, rest_length: rest, shortest }));
            [linear, damping.map(|damping| law(Damper { damping, shortest })), energy.map(law), force.map(law)]
        };
        laws.into_iter().flatten().collect()
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
    require_inside(entry, key, formula, at)?;
    Err(entry.refuse(key, format!("this formula is {value} for the length {} m of the start", at[0]), "it must be finite"))
}
