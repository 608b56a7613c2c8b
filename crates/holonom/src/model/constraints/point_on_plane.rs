use crate::model::assembly::Assembly;
use crate::model::element::Element;
use crate::model::ends::{difference, fixed, from_to};
use crate::model::entry::Entry;
use crate::model::fault::Read;
use crate::model::fields::{Described, Keys, List, Number, Place};
use crate::model::geometry::{dot, norm};
use crate::model::key::Shape;
use crate::record::Acts;

/// keeps a point on a plane of fixed direction; not in planar models
#[derive(Clone, Debug, PartialEq, Keys)]
#[kind(
    name = "point-on-plane",
    equations = "n · (x − x_through) = 0, |n| = 1",
    example = r#"
[point.puck]
mass = 1
position = [1, 0, 0]

[constraint.table]
type = "point-on-plane"
point = "puck"
normal = [0, 0, 1]
"#
)]
pub struct PointOnPlane {
    /// the point that slides
    #[key(shape = Shape::Point)]
    pub point: String,
    /// direction at right angles to the plane
    #[key(unit = "any", shape = Shape::Vector)]
    pub normal: List<Number>,
    /// a point of the plane
    #[key(default = "where the point starts")]
    pub through: Option<Place>,
}

const USE_A_LINE: &str = "use point-on-line";

impl Element for PointOnPlane {
    const IN_PLANE: Option<&'static str> = Some(USE_A_LINE);

    fn build(&self, assembly: &mut Assembly<'_>, entry: &Entry<'_>) -> Read<()> {
        if assembly.dimension() == 2 {
            return Err(entry.refuse_in_plane("constraint", Self::NAME, USE_A_LINE));
        }
        let (point, normal) = (assembly.point(entry, "point", &self.point), self.normal.vector(entry, "normal", 3));
        let through = entry.optional("through", &self.through, |through, entry, key| assembly.end(entry, key, through));
        let (point, normal) = (point?, normal?);
        let through = through?.unwrap_or_else(|| fixed(point.start, "its start".into()));
        assembly.require_free(entry, "point", &[point.clone(), through.clone()])?;
        let length = norm(normal);
        if length == 0.0 {
            return Err(entry.refuse("normal", "the normal is zero", "give the direction at right angles to the plane"));
        }
        let normal = normal.map(|c| c / length);
        let d = difference(&through, &point);
        let off = dot(normal, d);
        let size = norm(d).max(norm(point.start));
        assembly.check_start(entry, off, size, || format!("`{}` starts {} m off the plane", point.name, off.abs()))?;
        let height = assembly.builder.linear(normal, &from_to(&through, &point));
        let first = assembly.builder.rows();
        assembly.builder.constant_row(entry.name, height, 0.0);
        assembly.hold(entry, "force of the plane on the point", first, Acts::Along(vec![normal]));
        Ok(())
    }
}
