use std::sync::Arc;

use num_dual::{Dual2_64, Dual64};
use smallvec::SmallVec;

use crate::model::assembly::Assembly;
use crate::model::element::Element;
use crate::model::entry::Entry;
use crate::model::expression::{Program, central, names_in};
use crate::model::fault::Read;
use crate::model::fields::{Keys, Number};
use crate::model::key::Shape;
use crate::model::signals::{ROOM, Reader, Readings};
use crate::record::{Acts, RecordedHold, Slopes};
use crate::system::{CustomRows, Number as AnyNumber, Reading, SIZE};

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
            return Err(entry.refuse(
                "value",
                "nothing that moves is in this formula",
                "name positions, such as NAME.x, of what can move: what joints hold where it is needs no constraint",
            ));
        }
        let rows = Arc::new(Held { readings, value });
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
        if let Some([given, found]) = rows.misleads(&start, &slope) {
            let message = format!(
                "a function that this formula calls has a wrong derivative: the formula's slope along a coordinate is {given} with it, and {found} by differences"
            );
            return Err(entry.refuse("value", message, "correct the derivative of the function, or leave it out"));
        }
        // How far the nodes are from where it is zero.
        let far = off[0] / norm(&slope);
        assembly.check_start(entry, far, norm(&start), || {
            format!("the formula of `{}` is {} at the start, and not zero", entry.name, off[0])
        })?;
        let owners = rows.readings.places().iter().map(|place| format!("{}.{place}", entry.name)).collect();
        let row = assembly.builder.custom_rows_so_far();
        assembly.holds.push(RecordedHold {
            owners,
            what: "force of the constraint on this place",
            rows: row..row + 1,
            acts: Acts::Formula(rows.clone()),
        });
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

/// Share of the largest slope by which one is misled, and by which differences over one length and over so many times less may differ and are known.
const MISLED: f64 = 1e-2;
const KNOWN: f64 = 1e-3;
const NARROWER: f64 = 8.0;

/// A formula that is kept at zero.
struct Held {
    readings: Readings,
    value: Program,
}

impl Held {
    /// What the formula is of.
    fn variables<N: AnyNumber>(&self, x: &[N], t: N) -> SmallVec<[N; ROOM]> {
        let mut variables = SmallVec::from_slice(&[t]);
        // Velocities are not read.
        self.readings.append(x, x, &mut variables);
        variables
    }

    /// By how much it changes with all coordinates, with whatever derivatives these carry, by one run of the formula back and forth: to vary each pair
    /// of coordinates costs the cube of their number in a sum over many points.
    fn slopes<N: AnyNumber>(&self, x: &[N], t: N, by_position: &mut [N]) {
        let variables = self.variables(x, t);
        let mut slopes: SmallVec<[N; ROOM]> = SmallVec::new();
        slopes.resize(variables.len(), N::from(0.0));
        self.value.slopes(&variables, &mut slopes);
        by_position.fill(N::from(0.0));
        self.readings.spread(&slopes[1..], [x, x], [by_position, &mut []]);
    }

    /// A slope as the derivative of a function has it, and as differences do, where these are far apart: forces act along the slopes, and would do
    /// work that nothing accounts for.
    fn misleads(&self, x: &[f64], slope: &[f64]) -> Option<[f64; 2]> {
        if !self.value.calls() {
            return None;
        }
        let largest = |numbers: &[f64]| numbers.iter().fold(0.0, |most: f64, number| most.max(number.abs()));
        let wide = f64::EPSILON.cbrt() * Some(largest(x)).filter(|size| *size > 0.0).unwrap_or(1.0);
        let over = |step: f64| {
            let mut slopes = vec![0.0; x.len()];
            let value = |place: &[f64], out: &mut [f64]| out[0] = self.value.evaluate(&self.variables(place, 0.0));
            central(x, |_| step, 1, value, |i, _, slope| slopes[i] = slope);
            slopes
        };
        let [wider, narrower] = [over(wide), over(wide / NARROWER)];
        let size = largest(slope).max(largest(&narrower));
        // A formula that bends within the differences has others over another length, and these tell nothing.
        let is_known = |(_, (wider, narrower)): &(&f64, (&f64, &f64))| (*wider - *narrower).abs() <= KNOWN * size;
        let known = slope.iter().zip(wider.iter().zip(&narrower)).filter(is_known);
        known.map(|(&given, (_, &found))| [given, found]).find(|[given, found]| (given - found).abs() > MISLED * size)
    }

    /// It with what it changes by along a line, up to the second derivative.
    fn along(&self, x: impl Iterator<Item = Dual2_64>, t: f64) -> Dual2_64 {
        let x: Moving<Dual2_64> = x.collect();
        self.value.evaluate(&self.variables(&x, Dual2_64::new(t, 1.0, 0.0)))
    }
}

impl Slopes for Held {
    fn by_place(&self, x: &[f64], t: f64, by_place: &mut [[f64; 3]]) {
        let (nodes, dim) = (&self.readings.reading.nodes, self.readings.dim());
        let own: Moving<f64> = nodes.iter().flat_map(|node| &x[node.index() * dim..(node.index() + 1) * dim]).copied().collect();
        let variables = self.variables(&own, t);
        let mut slopes: SmallVec<[f64; ROOM]> = SmallVec::from_elem(0.0, variables.len());
        self.value.slopes(&variables, &mut slopes);
        self.readings.spread_on_places(&slopes[1..], by_place);
    }
}

/// Coordinates of the nodes.
type Moving<N> = SmallVec<[N; SIZE]>;

impl CustomRows for Held {
    fn rows(&self) -> usize {
        1
    }

    fn value(&self, x: &[f64], t: f64, phi: &mut [f64]) {
        phi[0] = self.value.evaluate(&self.variables(x, t));
    }

    fn gradient(&self, x: &[f64], t: f64, by_position: &mut [f64], by_time: &mut [f64]) {
        self.slopes(x, t, by_position);
        // Numbers that follow time have the slope right after a corner.
        by_time[0] = self.along(x.iter().map(|&x| Dual2_64::from(x)), t).v1;
    }

    fn hessian(&self, x: &[f64], t: f64, lambda: &[f64], out: &mut [f64]) {
        let k = x.len();
        let mut point: Moving<Dual64> = x.iter().map(|&x| Dual64::from(x)).collect();
        let mut line: Moving<Dual64> = point.clone();
        for i in 0..k {
            point[i].eps = 1.0;
            self.slopes(&point, Dual64::from(t), &mut line);
            point[i].eps = 0.0;
            for (j, slope) in line[..=i].iter().enumerate() {
                let second = lambda[0] * slope.eps;
                out[i * k + j] = second;
                out[j * k + i] = second;
            }
        }
    }

    fn mixed(&self, x: &[f64], t: f64, out: &mut [f64]) {
        let point: Moving<Dual64> = x.iter().map(|&x| Dual64::from(x)).collect();
        let mut line = point.clone();
        self.slopes(&point, Dual64::new(t, 1.0), &mut line);
        out.iter_mut().zip(&line).for_each(|(out, slope)| *out = slope.eps);
    }

    fn curvature(&self, x: &[f64], v: &[f64], t: f64, out: &mut [f64]) {
        out[0] = self.along(x.iter().zip(v).map(|(&x, &v)| Dual2_64::new(x, v, 0.0)), t).v2;
    }
}
