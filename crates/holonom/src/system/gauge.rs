//! What is measured beside the equations: coordinates of joints, with their rates.

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use super::Followed;
use super::part::Part;
use super::{FunctionValues, Functions, InvariantId, Invariants, System, SystemBuilder, Term};

/// A joint coordinate, before it is a quantity of a system.
#[derive(Clone)]
pub enum Form {
    /// U·W
    Product([Vec<Term>; 2]),
    /// The angle with these products as cosine and sine.
    Angle {
        /// U and W of ρ cos θ, with any ρ > 0.
        cosine: [Vec<Term>; 2],
        /// U and W of ρ sin θ, with the same ρ.
        sine: [Vec<Term>; 2],
        /// Of the angles that are alike but for turns the one nearest to this is that of the start, rad.
        near: f64,
    },
    /// A function of some products with a number that is followed.
    Followed {
        /// U and W of each argument, in order.
        of: Vec<[Vec<Term>; 2]>,
        /// Finds the number, and value and derivatives where it is known.
        function: Arc<dyn Followed>,
    },
}

impl Form {
    /// How many invariants it is made of.
    pub fn arguments(&self) -> usize {
        match self {
            Self::Product(_) => 1,
            Self::Angle { .. } => 2,
            Self::Followed { of, .. } => of.len(),
        }
    }

    pub(crate) fn part(&self, invariants: &mut Invariants) -> Part {
        let mut product = |[u, w]: &[Vec<Term>; 2]| invariants.dot(u, w);
        match self {
            Self::Product(factors) => Part::Invariant(product(factors)),
            Self::Followed { of, function } => {
                let of = of.iter().map(&mut product).collect();
                Part::Followed { of, function: Arc::clone(function) }
            }
            Self::Angle { cosine, sine, near } => Part::Angle { cosine: product(cosine), sine: product(sine), near: *near },
        }
    }
}

/// Functions of the positions that no equation needs, by name.
#[derive(Clone)]
pub(crate) struct Gauges {
    invariants: Invariants,
    functions: Functions,
    names: Vec<String>,
    is_angle: Vec<bool>,
}

/// Values and rates of what a system measures.
#[derive(Clone, Debug, Default)]
pub struct GaugeValues {
    invariants: Vec<f64>,
    gradient: Vec<f64>,
    functions: FunctionValues,
    /// Values, rad or m.
    pub value: Vec<f64>,
    /// Rates, rad/s or m/s.
    pub rate: Vec<f64>,
}

/// What is kept of measured values, beside the turns that they were counted to.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Measured {
    value: Vec<f64>,
    rate: Vec<f64>,
}

impl Measured {
    pub fn keep(&mut self, values: &GaugeValues) {
        self.value.clone_from(&values.value);
        self.rate.clone_from(&values.rate);
    }
}

impl GaugeValues {
    /// Takes over what was measured before of the same system.
    pub(crate) fn restore(&mut self, measured: &Measured) {
        self.value.copy_from_slice(&measured.value);
        self.rate.copy_from_slice(&measured.rate);
    }

    /// Angles with the turns that they have been counted to, rad.
    pub(crate) fn counted(&self) -> &[f64] {
        &self.functions.angle
    }

    /// Has angles counted on from these.
    pub(crate) fn count_on(&mut self, counted: &[f64]) {
        self.functions.angle.copy_from_slice(counted);
    }

    /// The same, of what was measured elsewhere.
    pub(crate) fn copy_from(&mut self, other: &Self) {
        self.value.copy_from_slice(&other.value);
        self.rate.copy_from_slice(&other.rate);
        self.functions.angle.copy_from_slice(&other.functions.angle);
    }
}

impl Gauges {
    pub fn new(dim: usize) -> Self {
        Self { invariants: Invariants::new(dim), functions: Functions::default(), names: Vec::new(), is_angle: Vec::new() }
    }

    pub fn move_origin(&mut self, is_point: &[bool], origin: [f64; 3]) {
        self.invariants.move_origin(is_point, origin);
    }

    /// Has angles counted from these at the start.
    pub fn begin_at(&mut self, angles: &[f64]) {
        self.functions.begin_at(angles);
    }

    pub fn add(&mut self, name: String, form: &Form) {
        let part = form.part(&mut self.invariants);
        self.functions.add(&self.invariants, &[(part, 1.0)]);
        self.names.push(name);
        self.is_angle.push(matches!(form, Form::Angle { .. }));
    }
}

impl SystemBuilder {
    /// Measures a joint coordinate under a name.
    pub fn measure(&mut self, name: impl Into<String>, form: &Form) {
        self.gauges.add(name.into(), form);
    }

    /// How much is measured.
    pub fn measured(&self) -> usize {
        self.gauges.names.len()
    }
}

impl System {
    /// Names of what is measured.
    pub fn gauges(&self) -> &[String] {
        &self.gauges.names
    }

    /// Whether what is measured is an angle (rad), and no displacement (m).
    pub(crate) fn is_angle(&self, gauge: usize) -> bool {
        self.gauges.is_angle[gauge]
    }

    /// Room for what is measured; angles start within half a turn of those of the start.
    pub fn gauge_values(&self) -> GaugeValues {
        let Gauges { invariants, functions, names, .. } = &self.gauges;
        GaugeValues {
            invariants: vec![0.0; invariants.len()],
            gradient: vec![0.0; invariants.slots() * self.dim],
            functions: functions.values(),
            value: vec![0.0; names.len()],
            rate: vec![0.0; names.len()],
        }
    }

    /// Measures at positions `x` and velocities `v` of all nodes. Angles are counted on from those measured last, less
    /// than half a turn away.
    pub fn measure(&self, x: &[f64], v: &[f64], out: &mut GaugeValues) {
        let Gauges { invariants, functions, names, .. } = &self.gauges;
        if names.is_empty() {
            return;
        }
        invariants.evaluate(x, &mut out.invariants, &mut out.gradient);
        functions.evaluate(&out.invariants, &mut out.functions);
        match self.dim {
            2 => self.rate_gauges::<2>(v, out),
            _ => self.rate_gauges::<3>(v, out),
        }
    }

    /// Takes values and rates over from the evaluated functions.
    fn rate_gauges<const D: usize>(&self, v: &[f64], out: &mut GaugeValues) {
        let Gauges { invariants, functions, .. } = &self.gauges;
        let (v, gradient) = (v.as_chunks::<D>().0, out.gradient.as_chunks::<D>().0);
        let slope = |id: InvariantId| {
            let of_slot = |s: usize| (0..D).map(|c| gradient[s][c] * v[invariants.node_of(s) as usize][c]).sum::<f64>();
            invariants.slots_of(id).fold(0.0, |sum, s| sum + of_slot(s))
        };
        let values = out.value.iter_mut().zip(&mut out.rate).zip(&out.functions.local);
        for (k, ((value, rate), local)) in values.enumerate() {
            *value = local.value;
            *rate = functions.base_of(k).iter().zip(&local.gradient).map(|(&id, g)| g * slope(id)).sum();
        }
    }

    /// The angle that turns most between two measurements `h` (s) apart, by its rates or by what was counted: its name, and by
    /// how much, rad.
    pub(crate) fn largest_turn(&self, h: f64, from: &GaugeValues, to: &GaugeValues) -> Option<(usize, f64)> {
        let turn = |k: usize| {
            let rates = from.rate[k].abs().max(to.rate[k].abs());
            (k, (rates * h.abs()).max((to.value[k] - from.value[k]).abs()))
        };
        let angles = (0..self.gauges.names.len()).filter(|&k| self.gauges.is_angle[k]);
        angles.map(turn).max_by(|a, b| a.1.total_cmp(&b.1))
    }
}
