use std::sync::Arc;

use super::laws::{Damper, Energy, FORCE_VARIABLES, Force, LinearSpring, SHORTEST};
use crate::model::assembly::Assembly;
use crate::model::element::Element;
use crate::model::ends::{difference, from_to};
use crate::model::entry::Entry;
use crate::model::expression::Program;
use crate::model::fault::Read;
use crate::model::fields::{Keys, List, Number, Place};
use crate::model::geometry::norm;
use crate::model::key::Shape;
use crate::record::{LineKind, Shows};
use crate::system::Law;

/// a spring, a damper, or both, between two points; linear or as a formula
#[derive(Clone, Debug, PartialEq, Keys)]
#[kind(
    name = "spring",
    equations = "V = ½ k (r − L₀)², tension c ṙ, V(r), tension F(r, ṙ, t), whichever are given, with r = max(|x_b − x_a|, 1e-9 m)",
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
    /// k
    #[key(unit = "N/m", default = "none")]
    pub stiffness: Option<Number>,
    /// L₀, the length without tension; only with a stiffness
    #[key(unit = "m", default = "the distance at the start")]
    pub rest_length: Option<Number>,
    /// c; what it takes is booked as work
    #[key(unit = "N·s/m", default = "none")]
    pub damping: Option<Number>,
    /// energy as a formula of the length
    #[key(unit = "J", default = "none", shape = Shape::Formula(&["length"]))]
    pub energy: Option<Number>,
    /// tension as a formula of length, rate and t, booked as work
    #[key(unit = "N", default = "none", shape = Shape::Formula(FORCE_VARIABLES))]
    pub force: Option<Number>,
}

impl Element for Spring {
    fn build(&self, assembly: &mut Assembly<'_>, entry: &Entry<'_>) -> Read<()> {
        let ends = assembly.moving_pair(entry, "between", &self.between);
        let stiffness = entry.optional("stiffness", &self.stiffness, Number::not_negative);
        let rest_length = entry.optional("rest_length", &self.rest_length, Number::not_negative);
        let damping = entry.optional("damping", &self.damping, Number::not_negative);
        let energy = entry.optional("energy", &self.energy, |energy, entry, key| energy.formula(entry, key, &["length"]));
        let force = entry.optional("force", &self.force, |force, entry, key| force.formula(entry, key, FORCE_VARIABLES));
        if let Self { stiffness: None, rest_length: None, damping: None, energy: None, force: None, .. } = self {
            entry.refuse_all(format!("the spring `{}` does nothing", entry.name), "add stiffness, damping, energy or force");
        }
        if self.rest_length.is_some() && self.stiffness.is_none() {
            entry.refuse("rest_length", "a rest length without a stiffness has no meaning", "add stiffness");
        }
        let ([a, b], stiffness, rest_length) = (ends?, stiffness?, rest_length?);
        let (damping, energy, force) = (damping?, energy?, force?);
        let start = norm(difference(&a, &b));
        let mut laws: Vec<Arc<dyn Law>> = Vec::new();
        if let Some(stiffness) = stiffness {
            laws.push(Arc::new(LinearSpring { stiffness, rest_length: rest_length.unwrap_or(start) }));
        }
        if let Some(damping) = damping {
            laws.push(Arc::new(Damper { damping }));
        }
        if let Some(energy) = energy {
            finite(entry, "energy", &energy, &[start.max(SHORTEST)])?;
            laws.push(Arc::new(Energy(energy)));
        }
        if let Some(force) = force {
            finite(entry, "force", &force, &[start.max(SHORTEST), 0.0, 0.0])?;
            laws.push(Arc::new(Force(force)));
        }
        let half_square = assembly.builder.square(&from_to(&a, &b));
        for law in laws {
            assembly.builder.law(entry.name, &[half_square], law);
        }
        assembly.show(Shows::Tension { factors: vec![1.0], fixed: 0.0 });
        assembly.draw(entry, LineKind::Spring, &a, &b);
        Ok(())
    }
}

/// A formula must at least be a number where the simulation starts.
fn finite(entry: &Entry<'_>, key: &str, formula: &Program, at: &[f64]) -> Read<()> {
    let value = formula.evaluate(at);
    if value.is_finite() {
        return Ok(());
    }
    Err(entry.refuse(key, format!("this formula is {value} for the length {} m of the start", at[0]), "it must be finite"))
}
