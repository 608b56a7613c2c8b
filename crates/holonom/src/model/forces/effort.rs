use std::sync::Arc;

use smallvec::SmallVec;

use super::coordinate_laws;
use super::joint::{acted_on, quantity};
use crate::model::assembly::Assembly;
use crate::model::element::Element;
use crate::model::entry::Entry;
use crate::model::expression::Program;
use crate::model::fault::Read;
use crate::model::fields::{Keys, Map, Number};
use crate::model::joints::coordinate;
use crate::model::key::Shape;
use crate::model::parameters::require_name;
use crate::model::signals::{ROOM, Reader, Readings};
use crate::model::tables::require_inside;
use crate::system::{Bend, Load, MAX_ARGUMENTS, Reading, Sense};

/// a motor or any other effort along the coordinate of a joint, as a formula of time, of that coordinate and its rate, and of
/// whatever else moves: control laws, nonlinear springs, engines
#[derive(Clone, Debug, PartialEq, Keys)]
#[kind(
    name = "effort",
    equations = "effort E(t, q, q̇, …), booked as work",
    example = r#"
[body.flap]
mass = 1
shape = { box = [0.4, 0.2, 0.01] }
position = [0.2, 0, 0]
angular_velocity = [0, 1, 0]
velocity = [0, 0, -0.2]

[joint.hinge]
type = "revolute"
between = ["ground", "flap"]
at = [0, 0, 0]
axis = [0, 1, 0]

[body.weight]
mass = 0.5
shape = { sphere = 0.1 }
position = [0, 1, 0]

[joint.rail]
type = "prismatic"
between = ["ground", "weight"]
axis = [0, 0, 1]

[force.controller]
type = "effort"
joint = "hinge"
coordinates = { s = "rail" }
effort = "2*sin(t) - 5*q - 0.3*q_rate + s - 0.1*s_rate"
"#
)]
pub struct Effort {
    /// the joint, or its coordinate as "JOINT.angle" or "JOINT.displacement"
    pub joint: String,
    /// E as a formula of t, q and q_rate, of the names below, and of inputs, measures and what moves, by the names of its columns
    #[key(unit = "N·m or N", shape = Shape::Formula(&["t", "q", "q_rate"]))]
    pub effort: Number,
    /// names for coordinates of other joints: { a = "JOINT" } makes a and a_rate variables of the formula
    #[key(default = "none")]
    pub coordinates: Option<Map<String>>,
}

impl Element for Effort {
    fn build(&self, assembly: &mut Assembly<'_>, entry: &Entry<'_>) -> Read<()> {
        let own = coordinate(assembly, entry, "joint".into(), &self.joint);
        let mut names = vec!["t".to_string(), "q".into(), "q_rate".into()];
        let mut coordinates = vec![own?];
        if let Some(others) = &self.coordinates {
            entry.within("coordinates", others, |inner| {
                for (name, other) in others.iter() {
                    require_name(inner, name)?;
                    let rate = format!("{name}_rate");
                    if let Some(known) = names.iter().find(|known| *known == name || **known == rate) {
                        return Err(inner.refuse_key(name, format!("`{known}` is the name of another variable"), "give it another name"));
                    }
                    coordinates.push(coordinate(assembly, inner, name.as_str().into(), other)?);
                    names.extend([name.clone(), rate]);
                }
                Ok(())
            })?;
        }
        assembly.draw_drive(entry, &coordinates[0].joint);
        let variables: Vec<&str> = names.iter().map(String::as_str).collect();
        let mut readings = Readings::new(assembly.dimension(), Reading::default());
        let effort = self.effort.formula_reading(entry, "effort", &variables, &mut Reader::new(assembly, entry, &mut readings))?;
        let arguments: usize = coordinates.iter().map(|coordinate| coordinate.form.arguments()).sum();
        let mut quantities = vec![acted_on(assembly, &coordinates[0])];
        quantities.extend(coordinates[1..].iter().map(|coordinate| quantity(assembly, coordinate)));
        if readings.len() == 0 {
            let zero = vec![0.0; variables.len()];
            let at_start: f64 = effort.evaluate(&zero);
            if !at_start.is_finite() {
                require_inside(entry, "effort", &effort, &zero)?;
                let message = format!("this formula is {at_start} at the start, where all coordinates are 0");
                return Err(entry.refuse("effort", message, "it must be finite"));
            }
            // What depends on few coordinates alone is a law of these, whose damping is fitted to the step.
            if arguments <= MAX_ARGUMENTS {
                assembly.builder.law(entry.name, &quantities, Arc::new(coordinate_laws::Effort(effort)));
                return Ok(());
            }
        }
        let first = readings.reading.senses.len();
        readings.reading.senses.extend(quantities.iter().map(|&quantity| Sense::Quantity(quantity.into())));
        let reading = readings.reading.clone();
        let load = EffortLoad { own: assembly.dimension() * reading.nodes.len() + first, coordinates: quantities.len(), readings, effort };
        assembly.builder.load_reading(entry.name, reading, Arc::new(load));
        Ok(())
    }
}

/// An effort along the first of its coordinates, which depends on more than laws can.
struct EffortLoad {
    /// Where the first of its coordinates is among what it reads, and how many there are.
    own: usize,
    coordinates: usize,
    readings: Readings,
    effort: Program,
}

impl EffortLoad {
    /// What the formula is of.
    fn variables(&self, x: &[f64], v: &[f64], t: f64) -> SmallVec<[f64; ROOM]> {
        let mut variables = SmallVec::from_slice(&[t]);
        for k in self.own..self.own + self.coordinates {
            variables.extend([x[k], v[k]]);
        }
        self.readings.append(x, v, &mut variables);
        variables
    }
}

impl Load for EffortLoad {
    fn bends(&self, x: &[f64], v: &[f64], t: f64, note: &mut dyn FnMut(Bend)) {
        self.effort.bends(&self.variables(x, v, t), note);
    }

    fn force(&self, x: &[f64], v: &[f64], t: f64, force: &mut [f64]) {
        force[self.own] = self.effort.evaluate(&self.variables(x, v, t));
    }

    fn tangent(&self, x: &[f64], v: &[f64], t: f64, by_position: &mut [f64], by_velocity: &mut [f64]) {
        let own = self.own * x.len()..(self.own + 1) * x.len();
        let (by_x, by_v) = (&mut by_position[own.clone()], &mut by_velocity[own]);
        let variables = self.variables(x, v, t);
        let mut slopes: SmallVec<[f64; ROOM]> = SmallVec::from_elem(0.0, variables.len());
        self.effort.slopes(&variables, &mut slopes);
        let (of_coordinates, of_readings) = slopes[1..].split_at(2 * self.coordinates);
        for (k, pair) in of_coordinates.chunks_exact(2).enumerate() {
            (by_x[self.own + k], by_v[self.own + k]) = (pair[0], pair[1]);
        }
        self.readings.spread(of_readings, [x, v], [by_x, by_v]);
    }
}
