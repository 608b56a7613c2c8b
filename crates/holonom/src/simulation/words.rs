//! From words to the parts of a method, and back to its name.

use super::method::{Choice, NAMED, Named, ProjectionChoice};
use crate::formulation::{FORMULATIONS, Formulation};
use crate::integrator::{Entry, Estimate, INTEGRATORS};

/// Why words do not make a method.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MethodError {
    /// A name that nothing has.
    #[error("there is no {kind} `{given}`; there are: {known}")]
    Unknown {
        /// What was to be named: `method`, `formulation`, …
        kind: &'static str,
        /// The name that there is not.
        given: String,
        /// All names that there are, with commas between them.
        known: String,
    },
    /// Two parts of a method that do not go together.
    #[error("the {kind} `{name}` does not go with the {with} `{given}`; it goes with: {partners}")]
    Pair {
        /// What the first of the two is: `integrator`, `projection`, …
        kind: &'static str,
        /// The first of the two.
        name: String,
        /// What the second is: `formulation`, `iteration`, …
        with: &'static str,
        /// The second of the two.
        given: String,
        /// All that the first goes with in place of it, with commas between them.
        partners: String,
    },
    /// A value that a key cannot have.
    #[error("`{key}` cannot be {given}; it can be: {allowed}")]
    Value {
        /// Key of `[simulation]`, such as `order` or `projection.levels`.
        key: &'static str,
        /// The value that it cannot have.
        given: String,
        /// What it may be, in words.
        allowed: String,
    },
    /// An accuracy, and an integrator that cannot choose steps by it.
    #[error("the integrator `{integrator}` has no error estimate to choose steps by accuracy; these have: {partners}")]
    NoEstimate {
        /// Its name, with the order where that is what is wrong.
        integrator: String,
        /// The integrators that have an estimate, with commas between them.
        partners: String,
    },
    /// An accuracy, and an integrator that is unstable without projection of velocities.
    #[error(
        "the integrator `{integrator}` is unstable on index 3 without projection, so that no step gives an accuracy; project velocities"
    )]
    Unstable {
        /// Its name.
        integrator: &'static str,
    },
}

/// The parts of a name that is none of [`NAMED`]: an integrator alone, or formulation, integrator and projection levels
/// joined by strokes, with the order behind the integrator, as in `bdf-3` and `lagrange-2/bdf-3/velocity+acceleration`; a comma does as well.
pub(super) fn spell(choice: &Choice) -> Option<Choice> {
    let name = choice.method.as_deref().filter(|name| NAMED.iter().all(|named| named.name != *name))?;
    let parts: Vec<&str> = name.split('/').collect();
    let (formulation, integrator, levels) = match parts[..] {
        [integrator] => (None, integrator, None),
        [formulation, integrator] => (Some(formulation), integrator, None),
        [formulation, integrator, levels] => (Some(formulation), integrator, Some(levels)),
        _ => return None,
    };
    let is_known = |name: &str| INTEGRATORS.iter().any(|entry| entry.name == name);
    let (integrator, order) = match integrator.rsplit_once('-').map(|(front, last)| (front, last.parse())) {
        Some((front, Ok(order))) if is_known(front) && !is_known(integrator) => (front, Some(order)),
        _ => (integrator, None),
    };
    if formulation.is_none() && !is_known(integrator) {
        return None;
    }
    let levels = levels.map_or(Vec::new(), |levels| levels.split(['+', ',']).map(str::to_string).collect());
    Some(Choice {
        method: None,
        formulation: formulation.map(str::to_string),
        index: None,
        integrator: Some(integrator.into()),
        order: order.or(choice.order),
        projection: Some(ProjectionChoice { levels: Some(levels), ..choice.projection.clone().unwrap_or_default() }),
        ..choice.clone()
    })
}

/// Formulation and integrator: as spelled out, as the named method has them, or the first that go together.
pub(super) fn partners(choice: &Choice, named: Option<&Named>) -> Result<(&'static Formulation, &'static Entry), MethodError> {
    let given = formulation(choice)?;
    let integrator = match (choice.integrator.as_deref(), named, given) {
        (Some(name), _, _) => name,
        (None, Some(named), _) => named.integrator,
        (None, None, Some(given)) => {
            let fitting = INTEGRATORS.iter().find(|entry| entry.goes_with(given));
            fitting.expect("every formulation has an integrator").name
        }
        (None, None, None) => NAMED[0].integrator,
    };
    let integrator = pick("integrator", integrator, INTEGRATORS, |entry| entry.name)?;
    let usual = match named {
        Some(named) if named.integrator == integrator.name => named.formulation,
        _ => integrator.usual,
    };
    let formulation = given.unwrap_or_else(|| FORMULATIONS.iter().find(|line| line.full_name() == usual).expect("the table names it"));
    if !integrator.goes_with(formulation) {
        return Err(MethodError::Pair {
            kind: "integrator",
            name: integrator.name.into(),
            with: "formulation",
            given: formulation.full_name(),
            partners: names(integrator.formulations().map(Formulation::full_name)),
        });
    }
    Ok((formulation, integrator))
}

/// The formulation that is spelled out, by name and index or by its full name.
fn formulation(choice: &Choice) -> Result<Option<&'static Formulation>, MethodError> {
    let Some(name) = choice.formulation.as_deref().or(choice.index.map(|_| FORMULATIONS[0].name)) else {
        return Ok(None);
    };
    if let Some(full) = FORMULATIONS.iter().find(|line| line.full_name() == name && line.name != name) {
        return Ok(Some(full));
    }
    let Some(first) = FORMULATIONS.iter().find(|line| line.name == name) else {
        let known = names(FORMULATIONS.iter().map(Formulation::full_name));
        return Err(MethodError::Unknown { kind: "formulation", given: name.into(), known });
    };
    let Some(index) = choice.index else { return Ok(Some(first)) };
    let of_name = || FORMULATIONS.iter().filter(|line| line.name == name);
    let allowed = || names(of_name().map(|line| line.index.to_string()));
    let found = of_name().find(|line| line.index == index);
    found.map(Some).ok_or_else(|| MethodError::Value { key: "index", given: index.to_string(), allowed: allowed() })
}

pub(super) fn order(choice: &Choice, integrator: &Entry) -> Result<u8, MethodError> {
    let usual = if choice.accuracy.is_some() { integrator.adaptive_order } else { integrator.orders[0] };
    let order = choice.order.unwrap_or(usual);
    match integrator.orders.contains(&order) {
        true => Ok(order),
        false => {
            Err(MethodError::Value { key: "order", given: order.to_string(), allowed: names(integrator.orders.iter().map(u8::to_string)) })
        }
    }
}

/// The least accuracy that makes sense: steps by thousands each round to 2e-16.
const FINEST: f64 = 1e-13;

/// The accuracy asked for, if the integrator can estimate its errors; `is_unstable` for want of projections.
pub(super) fn accuracy(choice: &Choice, integrator: &Entry, order: u8, is_unstable: bool) -> Result<Option<f64>, MethodError> {
    let Some(accuracy) = choice.accuracy else { return Ok(None) };
    let estimates = |entry: &Entry, order: u8| match entry.estimate {
        Estimate::History => order == 2,
        // A first order would need steps by the million.
        Estimate::Own | Estimate::OwnOfStates => order > 1,
        Estimate::None => false,
    };
    if is_unstable {
        return Err(MethodError::Unstable { integrator: integrator.name });
    }
    if !estimates(integrator, order) {
        let with = |entry: &&Entry| estimates(entry, entry.orders[0]);
        let name = integrator.name;
        // Of the same one another order.
        let partner = |entry: &Entry| match entry.name == name {
            true => format!("{name} of order {}", entry.orders[0]),
            false => entry.name.into(),
        };
        let partners = names(INTEGRATORS.iter().filter(with).map(partner));
        let name = if integrator.orders.len() > 1 { format!("{name} of order {order}") } else { name.into() };
        return Err(MethodError::NoEstimate { integrator: name, partners });
    }
    let allowed = "a positive number from 1e-13 on: numbers have sixteen digits, and round-off adds up";
    within("accuracy", Some(accuracy), 0.0, FINEST, f64::MAX, allowed).map(Some)
}

/// The fixed number of Newton iterations in a step, if one is asked for and can be kept.
pub(super) fn iterations(choice: &Choice, integrator: &Entry, iteration: &str) -> Result<Option<usize>, MethodError> {
    let Some(count) = choice.iterations else { return Ok(None) };
    let refuse = |with: &'static str, given: &str, partners: String| {
        Err(MethodError::Pair { kind: "number of iterations", name: count.to_string(), with, given: given.into(), partners })
    };
    if count == 0 {
        return Err(MethodError::Value { key: "iterations", given: "0".into(), allowed: "1, 2, 3 …".into() });
    }
    if let Some(accuracy) = choice.accuracy {
        return refuse("accuracy", &accuracy.to_string(), "equal steps".into());
    }
    if integrator.is_explicit() {
        let implicit = INTEGRATORS.iter().filter(|entry| !entry.is_explicit());
        return refuse("integrator", integrator.name, names(implicit.map(|entry| entry.name.into())));
    }
    if iteration != "newton" {
        return refuse("iteration", iteration, "newton".into());
    }
    Ok(Some(count))
}

/// The name of a method: one that people know, or its parts joined by strokes.
pub(super) fn name(formulation: &Formulation, integrator: &Entry, order: u8, levels: &[String]) -> String {
    let (full, is_usual) = (formulation.full_name(), order == integrator.orders[0]);
    let known =
        NAMED.iter().find(|known| is_usual && known.integrator == integrator.name && known.levels == levels && known.formulation == full);
    if let Some(known) = known {
        return known.name.into();
    }
    let order = if integrator.orders.len() == 1 { String::new() } else { format!("-{order}") };
    let levels = if levels.is_empty() { String::new() } else { format!("/{}", levels.join("+")) };
    format!("{full}/{}{order}{levels}", integrator.name)
}

pub(super) fn names(names: impl Iterator<Item = String>) -> String {
    names.collect::<Vec<_>>().join(", ")
}

/// The entry of a table that has a name.
pub(super) fn pick<'a, T>(
    kind: &'static str,
    given: &str,
    table: &'a [T],
    name: impl Fn(&'a T) -> &'static str,
) -> Result<&'a T, MethodError> {
    table.iter().find(|entry| name(entry) == given).ok_or_else(|| MethodError::Unknown {
        kind,
        given: given.into(),
        known: table.iter().map(&name).collect::<Vec<_>>().join(", "),
    })
}

pub(super) fn together(kind: &'static str, name: &str, with: &'static str, given: &str, partners: &[&str]) -> Result<(), MethodError> {
    match partners.contains(&given) {
        true => Ok(()),
        false => Err(MethodError::Pair { kind, name: name.into(), with, given: given.into(), partners: partners.join(", ") }),
    }
}

pub(super) fn positive(key: &'static str, given: Option<f64>, default: f64) -> Result<f64, MethodError> {
    match given {
        None => Ok(default),
        Some(value) if value > 0.0 && value.is_finite() => Ok(value),
        Some(value) => Err(MethodError::Value { key, given: value.to_string(), allowed: "a positive number".into() }),
    }
}

pub(super) fn within(key: &'static str, given: Option<f64>, default: f64, low: f64, high: f64, allowed: &str) -> Result<f64, MethodError> {
    match given.unwrap_or(default) {
        value if (low..=high).contains(&value) => Ok(value),
        value => Err(MethodError::Value { key, given: value.to_string(), allowed: allowed.into() }),
    }
}

#[cfg(test)]
mod tests {
    use crate::simulation::{Choice, Method, MethodError};

    #[test]
    fn a_misspelt_method_is_no_integrator_with_an_order() {
        for name in ["conserving-gll", "conserving-2x", "generalized-alpha-", "radau-"] {
            let resolved = Method::resolve(&Choice { method: Some(name.into()), ..Choice::default() });
            assert!(matches!(resolved, Err(MethodError::Unknown { kind: "method", .. })), "{name}");
        }
    }
}
