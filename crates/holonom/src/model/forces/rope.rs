use std::sync::Arc;

use super::rope_laws::{Damping, Elastic, Strands, Taut};
use crate::model::assembly::Assembly;
use crate::model::element::Element;
use crate::model::ends::{End, difference, from_to};
use crate::model::entry::{Entry, Spot, all};
use crate::model::fault::Read;
use crate::model::fields::{Keys, List, Number, Place};
use crate::model::geometry::norm;
use crate::model::key::Shape;
use crate::record::{Lengths, LineKind, Shows};
use crate::system::{InvariantId, MAX_ARGUMENTS, Place as NodePlace, Term};

/// an elastic rope between two points, also over small sheaves: it pulls when it is longer than its free length, and never pushes
#[derive(Clone, Debug, PartialEq, Keys)]
#[kind(
    name = "rope",
    equations = "tension k (ℓ − L) + c dℓ/dt where ℓ > L, never below 0, with ℓ = |x_1 − x_a| + |x_2 − x_1| + … + |x_b − x_n|; slack where ℓ ≤ L",
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
    /// L, the free length of the whole rope
    #[key(unit = "m", default = "the length at the start")]
    pub length: Option<Number>,
    /// k of the whole rope
    #[key(unit = "N/m")]
    pub stiffness: Number,
    /// c while it is taut; what it takes is booked as work
    #[key(unit = "N·s/m", default = "none")]
    pub damping: Option<Number>,
}

impl Element for Rope {
    fn build(&self, assembly: &mut Assembly<'_>, entry: &Entry<'_>) -> Read<()> {
        let ends = self.ends(assembly, entry);
        let length = entry.optional("length", &self.length, Number::positive);
        let stiffness = self.stiffness.positive(entry, "stiffness");
        let damping = entry.optional("damping", &self.damping, Number::not_negative);
        let (ends, length, stiffness, damping) = (ends?, length?, stiffness?, damping?);
        assembly.require_free(entry, "between", &ends)?;
        let falls = falls(assembly, &ends);
        if falls.moving.is_empty() {
            return Err(entry.refuse("between", "the length of this rope never changes", "tie it to what moves against its other end"));
        }
        if falls.moving.len() > MAX_ARGUMENTS {
            let message =
                format!("{} stretches of this rope change their lengths, and a rope has at most {MAX_ARGUMENTS}", falls.moving.len());
            return Err(entry.refuse("through", message, "let it run over fewer sheaves that move against each other"));
        }
        let start: f64 = ends.windows(2).map(|pair| norm(difference(&pair[0], &pair[1]))).sum();
        let (lengths, factors): (Vec<InvariantId>, Vec<f64>) = falls.moving.into_iter().unzip();
        let strands = Strands::new(&factors, length.unwrap_or(start) - falls.fixed);
        assembly.builder.law(entry.name, &lengths, Arc::new(Taut { strands, pull: Elastic { stiffness } }));
        if let Some(damping) = damping.filter(|&damping| damping > 0.0) {
            assembly.builder.law(entry.name, &lengths, Arc::new(Taut { strands, pull: Damping { damping, stiffness } }));
        }
        assembly.show(Shows::Tension(Lengths::Distances { factors, fixed: falls.fixed }));
        ends.windows(2).for_each(|pair| assembly.draw(entry, LineKind::Rope, &pair[0], &pair[1]));
        Ok(())
    }
}

impl Rope {
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

fn falls(assembly: &mut Assembly<'_>, ends: &[End]) -> Falls {
    let mut falls = Falls { moving: Vec::new(), fixed: 0.0 };
    let mut seen: Vec<[&Vec<Term>; 2]> = Vec::new();
    for pair in ends.windows(2) {
        let [a, b] = [&pair[0], &pair[1]];
        let never_moves = |end: &End| end.terms.iter().all(|term| matches!(term.place, NodePlace::Fixed(_)));
        if (a.body.is_some() && a.body == b.body) || (never_moves(a) && never_moves(b)) {
            falls.fixed += norm(difference(a, b));
        } else if let Some(k) = seen.iter().position(|&known| known == [&a.terms, &b.terms] || known == [&b.terms, &a.terms]) {
            falls.moving[k].1 += 1.0;
        } else {
            seen.push([&a.terms, &b.terms]);
            falls.moving.push((assembly.builder.square(&from_to(a, b)), 1.0));
        }
    }
    falls
}
