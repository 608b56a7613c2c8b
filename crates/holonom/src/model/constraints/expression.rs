use std::sync::Arc;

use smallvec::SmallVec;

use crate::model::assembly::Assembly;
use crate::model::element::Element;
use crate::model::entry::Entry;
use crate::model::expression::{Program, names_in};
use crate::model::fault::Read;
use crate::model::fields::{Keys, Number};
use crate::model::key::Shape;
use crate::model::signals::{Reader, Readings};
use crate::system::{ConstraintFunction, CustomRows, Differentiated, Number as AnyNumber, Reading};

/// keeps a formula of positions and of time at zero
#[derive(Clone, Debug, PartialEq, Keys)]
#[kind(
    name = "expression",
    equations = "f(x, t) = 0",
    example = r#"
[point.bead]
mass = 1
position = [1, 0, 0.5]

[constraint.dome]
type = "expression"
value = "bead.z - 1 + 0.5*bead.x^2 + 0.5*bead.y^2"
"#
)]
pub struct Expression {
    /// a formula of positions of points and bodies and of t, kept at zero; its slope should not be zero there
    #[key(unit = "any", shape = Shape::Formula(&["t"]))]
    pub value: Number,
}

impl Element for Expression {
    fn build(&self, assembly: &mut Assembly<'_>, entry: &Entry<'_>) -> Read<()> {
        let dim = assembly.dimension();
        self.require_no_coordinate(entry)?;
        let mut readings = Readings::new(dim, Reading::default());
        let value = self.value.formula_reading(entry, "value", &["t"], &mut Reader::new(assembly, entry, &mut readings))?;
        if let Some(name) = readings.first_but_positions() {
            let message = format!("`{name}` is no position, and a constraint is of positions of points and bodies, and of t");
            return Err(entry.refuse("value", message, "use a joint or a coupler for coordinates of joints, and forces for velocities"));
        }
        let nodes = readings.reading.nodes.clone();
        if nodes.is_empty() {
            return Err(entry.refuse("value", "nothing that moves is in this formula", "name positions, such as NAME.x"));
        }
        let rows = Arc::new(Differentiated(Held { readings, value }));
        let position = assembly.builder.position();
        let start: Vec<f64> = nodes.iter().flat_map(|node| &position[node.index() * dim..(node.index() + 1) * dim]).copied().collect();
        let (mut off, mut slope, mut by_time) = ([0.0], vec![0.0; start.len()], [0.0]);
        rows.value(&start, 0.0, &mut off);
        rows.gradient(&start, 0.0, &mut slope, &mut by_time);
        let norm = |numbers: &[f64]| numbers.iter().map(|number| number * number).sum::<f64>().sqrt();
        if !off[0].is_finite() || !norm(&slope).is_finite() {
            let message = format!("this formula is {} at the start, and its slope {}", off[0], norm(&slope));
            return Err(entry.refuse("value", message, "both must be finite"));
        }
        if norm(&slope) == 0.0 {
            let message = "this formula has no slope at the start, so that nothing keeps it at zero";
            return Err(entry.refuse(
                "value",
                message,
                "write it so that it grows on one side and falls on the other: x - y, not (x - y)^2",
            ));
        }
        // How far the nodes are from where it is zero.
        let far = off[0] / norm(&slope);
        assembly.check_start(entry, far, norm(&start), || {
            format!("the formula of `{}` is {} at the start, and not zero", entry.name, off[0])
        })?;
        assembly.builder.custom_rows(entry.name, &nodes, rows);
        Ok(())
    }
}

impl Expression {
    /// Refuses coordinates of joints: constraints are made before these.
    fn require_no_coordinate(&self, entry: &Entry<'_>) -> Read<()> {
        let Number::Formula(text) = &self.value else { return Ok(()) };
        let is_coordinate = |name: &String| [".angle", ".displacement"].iter().any(|end| name.ends_with(end));
        match names_in(text).into_iter().find(is_coordinate) {
            None => Ok(()),
            Some(name) => {
                let message = format!("`{name}` is a coordinate, and a constraint is of positions of points and bodies, and of t");
                Err(entry.refuse(
                    "value",
                    message,
                    "tie coordinates of joints with a coupler: a [joint.NAME] of type = \"linear\" or \"cam\"",
                ))
            }
        }
    }
}

/// A formula that is kept at zero.
struct Held {
    readings: Readings,
    value: Program,
}

impl ConstraintFunction for Held {
    fn rows(&self) -> usize {
        1
    }

    fn evaluate<N: AnyNumber>(&self, x: &[N], t: N, phi: &mut [N]) {
        let mut variables = SmallVec::from_slice(&[t]);
        // Velocities are not read.
        self.readings.append(x, x, &mut variables);
        phi[0] = self.value.evaluate(&variables);
    }
}
