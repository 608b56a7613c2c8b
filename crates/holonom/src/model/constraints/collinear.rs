use crate::model::assembly::Assembly;
use crate::model::element::Element;
use crate::model::ends::{End, difference, from_to};
use crate::model::entry::Entry;
use crate::model::fault::Read;
use crate::model::fields::{Keys, List, Place};
use crate::model::geometry::{cross, norm};
use crate::model::key::Shape;
use crate::model::straight;
use crate::record::{Acts, LineKind, RecordedHold, Straight};
use crate::system::Quantity;

/// keeps three or more points on a straight line by the cross products of the paper (§7), in space three with one redundant, or two where points slide
#[derive(Clone, Debug, PartialEq, Keys)]
#[kind(
    name = "collinear",
    equations = "(x_1 − x_0) × (x_2 − x_1) = 0, (x_2 − x_1) × (x_3 − x_2) = 0, …; these rows turn with the mechanism but are not invariant: \
                 together with other rows that do not keep it straight, angular momentum may drift with O(h²)",
    example = r#"
[point.a]
mass = 1
position = [1, 0, 0]

[point.b]
mass = 1
position = [2, 0, 0]

[constraint.straight]
type = "collinear"
points = ["ground", "a", "b"]
"#
)]
pub struct Collinear {
    /// the points, in their order along the line
    #[key(shape = Shape::Ends(3, usize::MAX))]
    pub points: List<Place>,
}

impl Element for Collinear {
    const NEEDS_OTHERS: bool = true;

    fn build(&self, assembly: &mut Assembly<'_>, entry: &Entry<'_>) -> Read<()> {
        let points = assembly.ends(entry, "points", &self.points, 3, usize::MAX)?;
        assembly.require_free(entry, "points", &points)?;
        let (mut parts, first) = (Vec::new(), assembly.builder.rows());
        let (owners, numbers) = owners(assembly, entry, &points);
        for (triple, numbers) in points.windows(3).zip(numbers.windows(3)) {
            check(assembly, entry, triple)?;
            let keep_lengths = triple.windows(2).all(|pair| assembly.keeps_apart(&pair[0], &pair[1]));
            let ways = [0, 1].map(|k| from_to(&triple[k], &triple[k + 1]));
            let quantities = straight::parallel(assembly, ways.each_ref().map(Vec::as_slice), keep_lengths);
            // The first way goes from the first to the second, the second from there to the third.
            let on = [(0, 0, -1.0), (1, 0, 1.0), (1, 1, -1.0), (2, 1, 1.0)];
            let on = on.into_iter().filter_map(|(end, way, sign)| Some((numbers[end]?, way, sign))).collect();
            parts.push(Straight { quantities, ways, on });
        }
        let quantities: Vec<Quantity> = parts.iter().flat_map(|part| part.quantities.iter().copied()).collect();
        straight::hold(assembly, entry, &quantities);
        assembly.holds.push(RecordedHold {
            owners,
            what: "force of the line on this place",
            rows: first..assembly.builder.rows(),
            acts: Acts::Straight(parts),
        });
        assembly.draw(entry, LineKind::Guide, &points[0], &points[points.len() - 1]);
        Ok(())
    }
}

/// What the forces on places are called, each once, and which of them each place has: none where it is of the world.
fn owners(assembly: &Assembly<'_>, entry: &Entry<'_>, points: &[End]) -> (Vec<String>, Vec<Option<usize>>) {
    let mut owners: Vec<String> = Vec::new();
    let numbers = points.iter().map(|end| {
        let owner = format!("{}.{}", entry.name, assembly.full_name(end)?);
        let number = owners.iter().position(|known| *known == owner).unwrap_or(owners.len());
        if number == owners.len() {
            owners.push(owner);
        }
        Some(number)
    });
    let numbers = numbers.collect();
    (owners, numbers)
}

fn check(assembly: &Assembly<'_>, entry: &Entry<'_>, triple: &[End]) -> Read<()> {
    let (u, w) = (difference(&triple[0], &triple[1]), difference(&triple[1], &triple[2]));
    let size = norm(u) * norm(w);
    let [a, b, c] = [0, 1, 2].map(|i| triple[i].name.as_str());
    if size == 0.0 {
        return Err(entry.refuse(
            "points",
            format!("two of `{a}`, `{b}`, `{c}` start at the same place"),
            "points on a line must be apart",
        ));
    }
    let off = norm(cross(u, w));
    assembly.check_start(entry, off, size, || {
        format!("`{a}`, `{b}`, `{c}` are not on a straight line at the start: it bends by {:.3e} rad at `{b}`", off / size)
    })
}
