//! Where a joint is at the start, from its keys `between`, `at`, `axis` and `axes`.

use super::{AnyJoint, Feature, OTHERS_IN_PLANE, Seat};
use crate::model::assembly::Assembly;
use crate::model::bodies::RigidBody;
use crate::model::bodies::nodes::{Member, Shared};
use crate::model::entry::{Entry, Spot};
use crate::model::fault::Read;
use crate::model::fields::{Field, Place, Site};
use crate::model::geometry::{Vec3, across, carried, cross, dot, norm, scale, subtract, unit};
use crate::model::value::Value;

/// A joint at the start, first and second side: reference coordinates in the axes of the model.
#[derive(Clone, Debug)]
pub struct Geometry {
    pub(in crate::model) members: [Member; 2],
    /// Where it sits, m.
    pub at: [Vec3; 2],
    /// Unit vectors u, v, w: the axis and two across it. In the plane u and its quarter turn.
    pub triad: [[Vec3; 3]; 2],
}

/// What can be shared and merged at the joints of a model, and what is needed of its bodies.
#[derive(Default)]
pub struct Survey {
    pub shared: Vec<Shared>,
    pub merged: Vec<[usize; 2]>,
    pub needed: Vec<(usize, Vec3)>,
    /// Where joints sit.
    pub sites: Vec<Vec3>,
    /// Bodies, and how far from their centres joints sit, m.
    pub arms: Vec<(usize, f64)>,
}

impl Survey {
    /// The size of the mechanism, m: the diagonal of the box around all bodies and joints, and of a single body its
    /// radius of gyration.
    pub fn length(&self, bodies: &[RigidBody]) -> f64 {
        let places = bodies.iter().map(|body| body.position).chain(self.sites.iter().copied());
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for place in places {
            (0..3).for_each(|c| (low[c], high[c]) = (low[c].min(place[c]), high[c].max(place[c])));
        }
        let gyration = bodies.iter().map(|body| (body.inertia.trace() / body.mass).sqrt()).fold(0.0, f64::max);
        let size = if bodies.is_empty() { 0.0 } else { norm(subtract(high, low)) };
        [size, gyration, 1.0].into_iter().find(|&size| size > 0.0).expect("one is above zero")
    }

    /// The usual size of a body, m: the geometric mean of all, each the radius of gyration or the longest way from the centre to
    /// a joint; the size of the mechanism where none has any.
    pub fn body_size(&self, bodies: &[RigidBody]) -> f64 {
        let mut sizes: Vec<f64> = bodies.iter().map(|body| (body.inertia.trace() / body.mass).sqrt()).collect();
        self.arms.iter().for_each(|&(body, arm)| sizes[body] = sizes[body].max(arm));
        let logarithms: Vec<f64> = sizes.iter().filter(|size| **size > 0.0).map(|size| size.ln()).collect();
        match logarithms.len() {
            0 => self.length(bodies),
            count => (logarithms.iter().sum::<f64>() / count as f64).exp(),
        }
    }
}

/// Adds what a joint asks of the nodes of its bodies.
pub fn survey(assembly: &Assembly<'_>, joint: &dyn AnyJoint, geometry: &Geometry, share: bool, survey: &mut Survey) {
    let layout = joint.layout();
    let directions = geometry.triad;
    survey.sites.extend(geometry.at);
    for (side, member) in geometry.members.iter().enumerate() {
        if let Member::Body(k) = *member {
            if layout.turns(side) {
                survey.needed.extend(directions[side].map(|u| (k, u)));
            }
            let arm = subtract(geometry.at[side], assembly.bodies[k].position);
            survey.needed.push((k, arm));
            survey.arms.push((k, norm(arm)));
        }
    }
    if !share || geometry.is_of_bar() {
        return;
    }
    let sides = |of: [Vec3; 2]| [(geometry.members[0], of[0]), (geometry.members[1], of[1])];
    // What is not in the same place at the start keeps its rows, which the start then meets or refuses.
    let apart = |[a, b]: [Vec3; 2]| norm(subtract(b, a)) > SAME * norm(a).max(norm(b));
    for feature in layout.shares[usize::from(assembly.dimension() == 2)] {
        match *feature {
            Feature::Point | Feature::All if apart(geometry.at) => (),
            Feature::Axis(k) if apart(directions.map(|triad| triad[k])) => (),
            Feature::Point => survey.shared.push(Shared { sides: sides(geometry.at), is_point: true }),
            Feature::Axis(k) => survey.shared.push(Shared { sides: sides(directions.map(|triad| triad[k])), is_point: false }),
            Feature::All => {
                if let [Member::Body(a), Member::Body(b)] = geometry.members {
                    survey.merged.push([a, b]);
                }
            }
        }
    }
}

/// Distance of two places over their coordinates, or of two directions, that is round-off.
const SAME: f64 = 1e-12;

impl Geometry {
    /// Whether a side is a bar, whose ends are nodes that others have, too.
    pub(in crate::model) fn is_of_bar(&self) -> bool {
        self.members.iter().any(|member| matches!(member, Member::Bar(_)))
    }

    pub(in crate::model) fn of(assembly: &Assembly<'_>, entry: &Entry<'_>, joint: &dyn AnyJoint) -> Read<Self> {
        let members = members(assembly, entry, joint);
        let layout = joint.layout();
        let dim = assembly.dimension();
        if layout.freedom[usize::from(dim == 2)].is_none() {
            return Err(entry.refuse_in_plane("joint", joint.name(), OTHERS_IN_PLANE));
        }
        let at = match (layout.at, joint.at()) {
            (Seat::Any, None) => {
                let members = members?;
                let centre = members.iter().rev().find_map(|member| match member {
                    Member::Body(k) => Some(assembly.bodies[*k].position),
                    _ => None,
                });
                Ok([centre.unwrap_or_default(); 2])
            }
            (_, None) => Err(entry.missing("at")),
            (seat, Some(at)) => places(assembly, entry, at, seat == Seat::Two),
        };
        let triad = triad(assembly, entry, layout.directions[usize::from(dim == 2)], joint.directions(), dim);
        let (members, at, triad) = (members?, at?, triad?);
        for side in 0..2 {
            let Member::Point(k) = members[side] else { continue };
            let point = &assembly.points[k];
            let off = norm(subtract(at[side], point.end.start));
            assembly.check_start(entry, off, norm(at[side]).max(norm(point.end.start)), || {
                format!("the joint sits {off:.3e} m beside the point `{}`", point.name)
            })?;
        }
        Ok(Self { members, at, triad })
    }
}

/// The two sides, of which at least one can move.
fn members(assembly: &Assembly<'_>, entry: &Entry<'_>, joint: &dyn AnyJoint) -> Read<[Member; 2]> {
    let (layout, names) = (joint.layout(), joint.between());
    let [first, second] = names else {
        let message = format!("a joint is between two bodies, and this names {}", names.len());
        return Err(entry.refuse("between", message, "write between = [\"A\", \"B\"], or [\"ground\", \"B\"]"));
    };
    let spot = |k| Spot { key: "between", item: Some(k) };
    let (a, b) = (assembly.member(entry, spot(0), first), assembly.member(entry, spot(1), second));
    let members = [a?, b?];
    if members[0] == members[1] {
        return Err(entry.refuse(spot(1), format!("`{}` joins `{first}` to itself", entry.name), "name two different bodies"));
    }
    for (k, member) in members.iter().enumerate() {
        if matches!(member, Member::Point(_)) && layout.turns(k) {
            let message = format!("`{}` is a point, and a {} joint needs a body there", names[k], joint.name());
            let cure = "name a [body.NAME], or hold the point by a spherical joint (in space) or a constraint of type \"fixed\"";
            return Err(entry.refuse(spot(k), message, cure));
        }
    }
    let moves = |member: &Member| match member {
        Member::Ground => false,
        Member::Point(k) => assembly.points[*k].end.free,
        Member::Body(_) | Member::Bar(_) => true,
    };
    if !members.iter().any(moves) {
        return Err(entry.refuse(
            "between",
            format!("neither `{first}` nor `{second}` can move"),
            "at least one must be a body, or a free point",
        ));
    }
    Ok(members)
}

/// The places of the key `at`: one for both sides, or one for each.
fn places(assembly: &Assembly<'_>, entry: &Entry<'_>, at: &Site, two: bool) -> Read<[Vec3; 2]> {
    match &at.0 {
        Value::List(items) if is_one_of_each(assembly, entry, items) => {
            let site = |k: usize| place(assembly, entry, Spot { key: "at", item: Some(k) }, &items[k]);
            let (a, b) = (site(0), site(1));
            Ok([a?, b?])
        }
        _ if two => Err(entry.refuse("at", "this joint wants two places, one of each body", "write at = [[x, y, z], [x, y, z]]")),
        value => place(assembly, entry, "at".into(), value).map(|place| [place; 2]),
    }
}

fn place(assembly: &Assembly<'_>, entry: &Entry<'_>, spot: Spot<'_>, value: &Value) -> Read<Vec3> {
    assembly.place_at_start(entry, spot, &Place::read(entry, spot, value)?)
}

/// Whether these are two places or directions and not the numbers of one, which may be texts with expressions.
fn is_one_of_each(assembly: &Assembly<'_>, entry: &Entry<'_>, items: &[Value]) -> bool {
    let is_place = |item: &Value| match item {
        Value::List(_) => true,
        Value::Text(text) => assembly.is_place_of_body(entry, text) || is_dotted(text),
        _ => false,
    };
    items.len() == 2 && items.iter().any(is_place)
}

/// Whether a text is two names with a dot between them, which no number is: that of a place, also where it is misspelt.
fn is_dotted(text: &str) -> bool {
    let is_name = |name: &str| name.starts_with(char::is_alphabetic) && name.chars().all(|c| c.is_alphanumeric() || "_-[]".contains(c));
    text.split_once('.').is_some_and(|(owner, place)| is_name(owner) && is_name(place))
}

/// The triads of both sides.
fn triad(assembly: &Assembly<'_>, entry: &Entry<'_>, count: usize, given: Option<&Site>, dim: usize) -> Read<[[Vec3; 3]; 2]> {
    if count == 0 && given.is_some() && dim == 2 {
        return Err(entry.refuse_key("axis", "in a planar model this joint has no axis", "remove it"));
    }
    let [a, b] = match (count, given) {
        (0, _) => [unit(if dim == 2 { 0 } else { 2 }); 2],
        (1, None) => return Err(entry.missing("axis")),
        (_, None) => return Err(entry.missing("axes")),
        (1, Some(axis)) => {
            let [a, b] = directions(assembly, entry, "axis", axis)?;
            if dot(a, b) < 0.5 {
                let degrees = dot(a, b).clamp(-1.0, 1.0).acos().to_degrees();
                let message = format!("the axis of the one body is at {degrees:.1}° to that of the other at the start");
                return Err(entry.refuse("axis", message, "turn one of them, or one of the bodies: they must be alike"));
            }
            [a, b]
        }
        (_, Some(axes)) => directions(assembly, entry, "axes", axes)?,
    };
    if dim == 2 {
        return Ok([a, b].map(|u| [u, [-u[1], u[0], 0.0], [0.0; 3]]));
    }
    let v = match count {
        2 => {
            let normal = cross(a, b);
            let size = norm(normal);
            [if size > 1e-9 { scale(normal, 1.0 / size) } else { across(a, 3)[0] }; 2]
        }
        _ => {
            let v = across(a, 3)[0];
            [v, carried(v, a, b)]
        }
    };
    Ok([[a, v[0], cross(a, v[0])], [b, v[1], cross(b, v[1])]])
}

/// The unit vectors at `axis`, one for both sides or one for each, or at `axes`.
pub(super) fn directions(assembly: &Assembly<'_>, entry: &Entry<'_>, key: &str, given: &Site) -> Read<[Vec3; 2]> {
    let read = |spot: Spot<'_>, value: &Value| -> Read<Vec3> {
        let u = assembly.direction_at_start(entry, spot, value)?;
        let size = norm(u);
        if size == 0.0 {
            return Err(entry.refuse(spot, "an axis of zero length has no direction", "give the direction of the axis"));
        }
        Ok(scale(u, 1.0 / size))
    };
    match &given.0 {
        Value::List(items) if is_one_of_each(assembly, entry, items) => {
            let axis = |k: usize| read(Spot { key, item: Some(k) }, &items[k]);
            let (a, b) = (axis(0), axis(1));
            Ok([a?, b?])
        }
        _ if key == "axes" => {
            Err(entry.refuse(key, "this joint wants two directions, one of each body", "write axes = [[1, 0, 0], [0, 1, 0]]"))
        }
        value => read(key.into(), value).map(|u| [u; 2]),
    }
}
