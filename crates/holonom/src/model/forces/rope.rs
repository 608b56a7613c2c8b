use std::sync::Arc;

use super::following::{Follows, RopeLoad, not_negative};
use super::joint::along;
use super::rope_laws::{Damping, Elastic, Strands, Taut};
use crate::model::assembly::Assembly;
use crate::model::element::Element;
use crate::model::ends::{End, difference, from_to};
use crate::model::entry::{Entry, Spot, all};
use crate::model::fault::Read;
use crate::model::fields::{Keys, List, Number, Place};
use crate::model::geometry::norm;
use crate::model::joints::{Coordinate, coordinate};
use crate::model::key::Shape;
use crate::model::signals::Readings;
use crate::record::{Lengths, LineKind, Shows};
use crate::system::{Differentiated, InvariantId, MAX_ARGUMENTS, Quantity, Reading, Term};

/// an elastic rope between two points, also over small sheaves and from a drum: it pulls when it is longer than its free length, and never pushes
#[derive(Clone, Debug, PartialEq, Keys)]
#[kind(
    name = "rope",
    equations = "tension k (ℓ − L) + c dℓ/dt where ℓ > L, never below 0, with ℓ = |x_1 − x_a| + |x_2 − x_1| + … + |x_b − x_n|; slack where ℓ ≤ L. From a drum L + R q in place of L, with the effort R times the tension along q",
    example = r#"
[point.bob]
mass = 1
position = [0.6, 0, -0.8]
velocity = [0, 0.5, -1]

[force.rope]
type = "rope"
between = [[-1, 0, 0], "bob"]
through = ["ground"]
length = 1.7
stiffness = 100
damping = 0.5
"#
)]
pub struct Rope {
    /// the two points it is tied to
    #[key(shape = Shape::Ends(2, 2))]
    pub between: List<Place>,
    /// the sheaves between them, without friction and so small that they are points, in their order along the rope
    #[key(default = "none", shape = Shape::Ends(0, usize::MAX))]
    pub through: Option<List<Place>>,
    /// L, the free length of the whole rope, with a drum where its coordinate is zero; as a formula of t, of inputs, measures of
    /// positions and what moves, by the names of columns, its work is booked
    #[key(unit = "m", default = "the length at the start", shape = Shape::Formula(&["t"]))]
    pub length: Option<Number>,
    /// the drum that it is wound on: a joint, or its coordinate as "JOINT.angle" or "JOINT.displacement"
    #[key(default = "none")]
    pub drum: Option<String>,
    /// R, the radius of the drum: what it lets out when it turns forward; below 0 it lets out when it turns back
    #[key(unit = "m, or m/m along a rail", default = "needed with `drum`")]
    pub radius: Option<Number>,
    /// k of the whole rope; it may be a formula, of velocities too
    #[key(unit = "N/m", shape = Shape::Formula(&["t"]))]
    pub stiffness: Number,
    /// c while it is taut, which may be a formula; what it takes is booked as work
    #[key(unit = "N·s/m", default = "none", shape = Shape::Formula(&["t"]))]
    pub damping: Option<Number>,
}

impl Element for Rope {
    fn build(&self, assembly: &mut Assembly<'_>, entry: &Entry<'_>) -> Read<()> {
        let ends = self.ends(assembly, entry);
        let mut readings = Readings::new(assembly.dimension(), Reading::default());
        let numbers = self.numbers(assembly, entry, &mut readings);
        let drum = self.winch(assembly, entry);
        let (ends, [length, stiffness, damping], drum) = (ends?, numbers?, drum?);
        let stiffness = stiffness.expect("a rope has a stiffness");
        if drum.is_none() {
            assembly.require_free(entry, "between", &ends)?;
        }
        let falls = falls(assembly, &ends, drum.is_some());
        if falls.moving.is_empty() {
            return Err(entry.refuse("between", "the length of this rope never changes", "tie it to what moves against its other end"));
        }
        let most = MAX_ARGUMENTS - drum.as_ref().map_or(0, |(coordinate, _)| coordinate.form.arguments());
        if falls.moving.len() > most {
            let message = format!("{} stretches of this rope change their lengths, and it can have at most {most}", falls.moving.len());
            return Err(entry.refuse("through", message, "let it run over fewer sheaves that move against each other"));
        }
        let start: f64 = ends.windows(2).map(|pair| norm(difference(&pair[0], &pair[1]))).sum();
        let (mut arguments, factors): (Vec<Quantity>, Vec<f64>) =
            falls.moving.into_iter().map(|(id, factor)| (Quantity::from(id), factor)).unzip();
        let radius = drum.as_ref().map(|(_, radius)| *radius);
        let drum = drum.map(|(coordinate, _)| along(assembly, &coordinate));
        arguments.extend(drum.iter().map(|drum| Quantity::from(drum.coordinate)));
        let (length, damping) = (length.unwrap_or(Follows::Known(start)), damping.unwrap_or(Follows::Known(0.0)));
        let shortest = assembly.shortest(start, length.known().unwrap_or(0.0));
        match (length.known(), stiffness.known(), damping.known()) {
            (Some(length), Some(stiffness), Some(damping)) => {
                let strands = Strands::new(&factors, radius.unwrap_or(0.0), length - falls.fixed, shortest);
                assembly.builder.law(entry.name, &arguments, Arc::new(Taut { strands, pull: Elastic { stiffness } }));
                if damping > 0.0 {
                    assembly.builder.law(entry.name, &arguments, Arc::new(Taut { strands, pull: Damping { damping, stiffness } }));
                }
            }
            _ => {
                let own = arguments.iter().map(|&quantity| readings.own(quantity)).min().expect("a length changes");
                let (factors, fixed, reading) = (factors.clone(), falls.fixed, readings.reading.clone());
                let load = RopeLoad { own, factors, radius, fixed, shortest, length, stiffness, damping, readings };
                assembly.builder.load_reading(entry.name, reading, Arc::new(Differentiated(load)));
            }
        }
        assembly.show(Shows::Tension {
            quantities: arguments,
            lengths: Lengths::Distances { factors, fixed: falls.fixed, drum },
            shortest,
        });
        ends.windows(2).for_each(|pair| assembly.draw(entry, LineKind::Rope, &pair[0], &pair[1]));
        Ok(())
    }
}

impl Rope {
    /// Length, stiffness and damping.
    fn numbers(&self, assembly: &mut Assembly<'_>, entry: &Entry<'_>, readings: &mut Readings) -> Read<[Option<Follows>; 3]> {
        let positive = |number: &Number, entry: &Entry<'_>, key: &str| number.positive(entry, key);
        let length = entry.optional("length", &self.length, |number, entry, key| {
            let length = Follows::read(assembly, readings, (entry, key), number, positive)?;
            // How fast it changes counts, and accelerations are not known.
            match readings.first_rate() {
                Some(name) => {
                    let message = format!("the length of a rope cannot follow a velocity, as `{name}` is");
                    Err(entry.refuse(key, message, "let it follow time, inputs and positions"))
                }
                None => Ok(length),
            }
        });
        let stiffness = Follows::read(assembly, readings, (entry, "stiffness"), &self.stiffness, positive);
        let damping = Follows::optional(assembly, readings, (entry, "damping"), &self.damping, not_negative);
        Ok([length?, Some(stiffness?), damping?])
    }

    /// The coordinate of the drum, and its radius.
    fn winch(&self, assembly: &Assembly<'_>, entry: &Entry<'_>) -> Read<Option<(Coordinate, f64)>> {
        let radius = entry.optional("radius", &self.radius, Number::number)?;
        match (&self.drum, radius) {
            (None, None) => Ok(None),
            (None, Some(_)) => Err(entry.refuse("radius", "a radius means nothing without a drum", "add drum = \"JOINT\", or remove it")),
            (Some(_), None | Some(0.0)) => {
                Err(entry.refuse_key("drum", "how much rope the drum lets out is not said", "add its radius, above 0 or below"))
            }
            (Some(drum), Some(radius)) => Ok(Some((coordinate(assembly, entry, "drum".into(), drum)?, radius))),
        }
    }

    /// All it runs through, from end to end.
    fn ends(&self, assembly: &Assembly<'_>, entry: &Entry<'_>) -> Read<Vec<End>> {
        let sheaves = self.through.as_ref().map_or(&[][..], |through| &through[..]);
        if sheaves.is_empty() || self.between.len() != 2 {
            return assembly.ends(entry, "between", &self.between, 2, 2);
        }
        // It may be tied to the same place with both ends, so that neighbours are looked at along the rope.
        let spot = |key, k| Spot { key, item: Some(k) };
        let tied = |k: usize| (spot("between", k), &self.between[k]);
        let through = sheaves.iter().enumerate().map(|(k, place)| (spot("through", k), place));
        let along: Vec<_> = [tied(0)].into_iter().chain(through).chain([tied(1)]).collect();
        let ends = all(along.iter().map(|&(spot, place)| assembly.end(entry, spot, place)))?;
        match (1..ends.len()).find(|&k| ends[k].terms == ends[k - 1].terms) {
            Some(k) => {
                let (spot, _) = along[k.min(sheaves.len())];
                Err(entry.refuse(spot, format!("the rope comes to `{}` twice in a row", ends[k].name), "name two different points"))
            }
            None => Ok(ends),
        }
    }
}

/// The stretches of a rope between neighbouring ends.
struct Falls {
    /// Half the squares of lengths that change, and how many stretches have that length.
    moving: Vec<(InvariantId, f64)>,
    /// The sum of those that do not, m.
    fixed: f64,
}

/// Where no stretch changes, as between the ground and what joints hold where it is, the first between two bodies counts as one that does, and with a drum the
/// first of all: the tension is seen there.
fn falls(assembly: &mut Assembly<'_>, ends: &[End], has_drum: bool) -> Falls {
    let mut falls = Falls { moving: Vec::new(), fixed: 0.0 };
    let mut seen: Vec<[&Vec<Term>; 2]> = Vec::new();
    let is_within_a_body = |[a, b]: [&End; 2]| a.body.is_some() && a.body == b.body;
    for pair in ends.windows(2) {
        let [a, b] = [&pair[0], &pair[1]];
        if is_within_a_body([a, b]) || (a.never_moves() && b.never_moves()) {
            falls.fixed += norm(difference(a, b));
        } else if let Some(k) = seen.iter().position(|&known| known == [&a.terms, &b.terms] || known == [&b.terms, &a.terms]) {
            falls.moving[k].1 += 1.0;
        } else {
            seen.push([&a.terms, &b.terms]);
            falls.moving.push((assembly.builder.square(&from_to(a, b)), 1.0));
        }
    }
    let counts = |pair: &&[End]| has_drum || !is_within_a_body([&pair[0], &pair[1]]);
    if falls.moving.is_empty()
        && let Some([a, b]) = ends.windows(2).find(counts)
    {
        falls.fixed -= norm(difference(a, b));
        falls.moving.push((assembly.builder.square(&from_to(a, b)), 1.0));
    }
    falls
}
