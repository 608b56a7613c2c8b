use super::coupler::{coordinate, couple};
use crate::model::assembly::Assembly;
use crate::model::element::Element;
use crate::model::entry::{Entry, Spot, all};
use crate::model::fault::Read;
use crate::model::fields::{Keys, List, Number};
use crate::system::MAX_ARGUMENTS;

/// a sum of joint coordinates that stays as it is: a differential, a tilting table, any linear coupling
#[derive(Clone, Debug, PartialEq, Keys)]
#[kind(
    name = "linear",
    equations = "Σ factor_k q_k = 0, angles counted over any number of turns",
    example = r#"
[body.wheel1]
mass = 1
shape = { cylinder = [0.1, 0.02] }
position = [0, 0, 0]
angular_velocity = [0, 0, 2]

[body.wheel2]
mass = 4
shape = { cylinder = [0.2, 0.02] }
position = [0.3, 0, 0]
angular_velocity = [0, 0, -1]

[joint.axle1]
type = "revolute"
between = ["ground", "wheel1"]
at = [0, 0, 0]
axis = [0, 0, 1]

[joint.axle2]
type = "revolute"
between = ["ground", "wheel2"]
at = [0.3, 0, 0]
axis = [0, 0, 1]

[joint.sum]
type = "linear"
terms = [{ joint = "axle1", factor = 1 }, { joint = "axle2", factor = 2 }]
"#
)]
pub struct Linear {
    /// the summands: { joint = "JOINT", factor = 1.0 }
    pub terms: List<Term>,
}

/// A summand of a linear coupling.
#[derive(Clone, Debug, PartialEq, Keys)]
#[table("a term")]
pub struct Term {
    /// joint, or coordinate of a joint as "JOINT.angle"
    pub joint: String,
    /// its factor
    pub factor: Number,
}

impl Element for Linear {
    const NEEDS_OTHERS: bool = true;

    fn build(&self, assembly: &mut Assembly<'_>, entry: &Entry<'_>) -> Read<()> {
        if self.terms.len() < 2 {
            return Err(entry.refuse("terms", "a coupling has at least two terms", "add { joint = \"JOINT\", factor = 1 }"));
        }
        let term = |inner: &Entry<'_>, term: &Term| {
            let joint = coordinate(assembly, inner, "joint".into(), &term.joint);
            let factor = term.factor.number(inner, "factor");
            Ok((joint?, factor?))
        };
        let terms = all(self
            .terms
            .iter()
            .enumerate()
            .map(|(k, of)| entry.within(Spot { key: "terms", item: Some(k) }, of, |inner| term(inner, of))))?;
        let arguments: usize = terms.iter().map(|(coordinate, _)| coordinate.form.arguments()).sum();
        if arguments > MAX_ARGUMENTS {
            return Err(entry.refuse(
                "terms",
                "a coupling holds three angles, or six displacements, or two ways along curves",
                "couple in two steps, through a joint between",
            ));
        }
        couple(assembly, entry, &terms)
    }
}
