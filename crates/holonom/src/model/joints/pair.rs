//! What the files of joints write their rows with: two bodies, a place and a triad on each.

use super::geometry::Geometry;
use super::{AnyJoint, Feature};
use crate::model::assembly::{Assembly, GROUND};
use crate::model::bodies::frame::Frame;
use crate::model::bodies::nodes::Member;
use crate::model::ends::{End, fixed, subtract_shared};
use crate::model::entry::Entry;
use crate::model::fault::{Read, Refused};
use crate::model::geometry::{Vec3, norm, subtract, unit};
use crate::record::SceneJoint;
use crate::system::{Form, InvariantId, Part, Place, Term};

/// A coordinate of a joint, counted from the start.
#[derive(Clone)]
pub struct Coordinate {
    /// Name of the joint.
    pub joint: String,
    /// `"angle"`, `"displacement"`, …
    pub name: &'static str,
    /// How it follows from the nodes of both sides.
    pub form: Form,
    /// Whether it is an angle (rad) and not a displacement (m).
    pub is_angle: bool,
    /// The direction of the joint's triad that it is about or along, where it is one.
    pub about: Option<usize>,
}

/// A joint of the model.
#[derive(Clone)]
pub struct JointInfo {
    /// As in the model, with its index where it is repeated.
    pub name: String,
    /// What `type` says.
    pub kind: &'static str,
    /// Where it is at the start.
    pub geometry: Geometry,
    /// What couplers, drives and forces can name of it, such as `hinge.angle`.
    pub coordinates: Vec<Coordinate>,
    /// Its rows among those of the system.
    pub rows: std::ops::Range<usize>,
    /// Whether nodes that its sides share stand for some of its rows, or nodes that bodies share past a joint take part of what its rows bear, so that
    /// their forces are not known.
    pub is_shared: bool,
}

/// Two bodies at a joint.
pub struct Pair<'a, 'b> {
    /// The system so far, which takes the rows.
    pub assembly: &'a mut Assembly<'b>,
    /// The entry of the joint, which records what is wrong with its keys.
    pub entry: &'a Entry<'a>,
    /// Where it is on both sides at the start.
    pub geometry: Geometry,
    /// Those that were added so far.
    pub coordinates: Vec<Coordinate>,
    frames: [Frame; 2],
    names: usize,
    is_shared: bool,
    radius: Option<f64>,
    curve: Vec<Vec3>,
}

/// The first and the second body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    A,
    B,
}

/// Builds a joint from its entry: its rows, coordinates and symbol.
pub(in crate::model) fn build(assembly: &mut Assembly<'_>, entry: &Entry<'_>, joint: &dyn AnyJoint) -> Read<()> {
    let layout = joint.layout();
    let geometry = assembly.geometries.next().expect("every joint was surveyed");
    if geometry.members.iter().any(|member| matches!(member, Member::Bar(k) if assembly.bar_ends[*k].is_none())) {
        return Err(Refused);
    }
    let frames = [0, 1].map(|side| assembly.frame(geometry.members[side]));
    let first = assembly.builder.rows();
    let mut pair =
        Pair { assembly, entry, geometry, coordinates: Vec::new(), frames, names: 0, is_shared: false, radius: None, curve: Vec::new() };
    joint.rows(&mut pair)?;
    let Pair { geometry, coordinates, is_shared, radius, curve, .. } = pair;
    let rows = first..assembly.builder.rows();
    let has_axis = layout.directions[usize::from(assembly.dimension() == 2)] > 0;
    draw(assembly, entry, joint.name(), &geometry, has_axis);
    if let Some(drawn) = assembly.scene_joints.last_mut() {
        (drawn.radius, drawn.curve) = (radius, curve);
    }
    if layout.shares[0] != [Feature::All] {
        for coordinate in &coordinates {
            assembly.builder.measure(format!("{}.{}", entry.name, coordinate.name), &coordinate.form);
        }
    }
    assembly.joint_names.insert(entry.name.to_string(), assembly.joints.len());
    assembly.joints.push(JointInfo { name: entry.name.to_string(), kind: joint.name(), geometry, coordinates, rows, is_shared });
    Ok(())
}

fn draw(assembly: &mut Assembly<'_>, entry: &Entry<'_>, kind: &str, geometry: &Geometry, has_axis: bool) {
    // Of a bar the end that is nearer.
    let carrier = |side: usize| match geometry.members[side] {
        Member::Bar(k) => {
            let way = |end: &&End| norm(subtract(end.start, geometry.at[side]));
            let end = assembly.bar_ends[k].iter().flatten().min_by(|a, b| way(a).total_cmp(&way(b)));
            let point = end.and_then(|end| end.point).map(Member::Point);
            point.or(end.and_then(|end| end.body).map(Member::Body)).unwrap_or(Member::Ground)
        }
        member => member,
    };
    let carriers = [0, 1].map(carrier);
    let name = |member: Member| match member {
        Member::Body(k) => Some(assembly.bodies[k].name.clone()),
        Member::Point(k) => Some(assembly.points[k].name.clone()),
        Member::Bar(_) | Member::Ground => None,
    };
    // Drawn with the first side, which carries the axes, unless that is a point.
    let side = usize::from(matches!(carriers[0], Member::Point(_)));
    let (mut at, mut axis) = (geometry.at[side], geometry.triad[side][0]);
    if let Member::Body(k) = carriers[side] {
        (at, axis) = (assembly.bodies[k].local(at), assembly.bodies[k].local_direction(axis));
    }
    (at, axis) = (assembly.axes.in_world(at), assembly.axes.in_world(axis));
    let [body, other] = [side, 1 - side].map(|side| name(carriers[side]));
    let axis = has_axis.then_some(axis);
    // Its force is recorded on the second side, whichever that is here.
    let (name, kind, acts_on_other) = (entry.name.to_string(), kind.to_string(), side == 0);
    assembly.scene_joints.push(SceneJoint {
        name,
        kind,
        body,
        other,
        at,
        axis,
        acts_on_other,
        drives: Vec::new(),
        radius: None,
        curve: Vec::new(),
    });
    for side in 0..2 {
        if let Member::Body(k) = carriers[side] {
            let local = assembly.bodies[k].local(geometry.at[side]);
            assembly.body_places[k].push(local);
        }
    }
}

impl Pair<'_, '_> {
    /// Whether the model is in a plane, in which all axes of rotation are its normal.
    pub fn is_planar(&self) -> bool {
        self.assembly.dimension() == 2
    }

    /// Draws the joint with a disc of this radius on its second body.
    pub fn draw_disc(&mut self, radius: f64) {
        self.radius = Some(radius);
    }

    /// Draws the joint with a curve of its first body through these places, m at the start.
    pub fn draw_curve(&mut self, places: impl Iterator<Item = Vec3>) {
        let assembly = &*self.assembly;
        let own = |place: Vec3| match self.geometry.members[0] {
            Member::Body(k) => assembly.bodies[k].local(place),
            _ => place,
        };
        let curve = places.map(|place| assembly.axes.in_world(own(place))).collect();
        self.curve = curve;
    }

    /// The place of the joint on a side.
    pub fn end(&self, side: Side) -> End {
        let at = self.geometry.at[side as usize];
        match self.geometry.members[side as usize] {
            Member::Ground => fixed(at, GROUND.into()),
            Member::Point(k) => self.assembly.points[k].end.clone(),
            Member::Body(k) => self.assembly.body_end(k, at, &self.assembly.bodies[k].name),
            Member::Bar(_) => End {
                terms: self.frames[side as usize].point(at),
                start: at,
                free: true,
                point: None,
                body: None,
                name: self.entry.name.to_string(),
            },
        }
    }

    /// d = r_B − r_A between the places of the joint.
    pub fn d(&self) -> Vec<Term> {
        let [a, b] = [0, 1].map(|side| self.frames[side].point(self.geometry.at[side]));
        let size = self.assembly.builder.size();
        // Points alone have no size, and share no nodes: each moves.
        self.apart([a, b], size, if size > 0.0 { size } else { 1.0 })
    }

    /// How two sums of nodes differ, which are of this size and whose points move by as much as `of_points`, m; nothing where the bodies share them.
    fn apart(&self, [a, b]: [Vec<Term>; 2], size: f64, of_points: f64) -> Vec<Term> {
        let builder = &self.assembly.builder;
        let reach = |node| if builder.is_direction(node) { norm(builder.position_of(node)) } else { of_points };
        subtract_shared(&b, &a, size, reach)
    }

    /// The direction k of the triad u, v, w on a side.
    pub fn e(&self, side: Side, k: usize) -> Vec<Term> {
        self.fixed_to(side, self.geometry.triad[side as usize][k])
    }

    /// A direction fixed to a side, by its reference coordinates.
    pub fn fixed_to(&self, side: Side, direction: Vec3) -> Vec<Term> {
        self.frames[side as usize].vector(direction)
    }

    /// d = 0: a row an axis, none where the two share the point.
    pub fn coincide(&mut self) {
        let d = self.d();
        for c in 0..self.assembly.dimension() {
            let invariant = self.assembly.builder.linear(unit(c), &d);
            self.row(invariant, 0.0, d.is_empty());
        }
    }

    /// d·e_k(A) = 0.
    pub fn stay(&mut self, k: usize) {
        let (d, e) = (self.d(), self.e(Side::A, k));
        let invariant = self.assembly.builder.dot(&d, &e);
        self.row(invariant, 0.0, d.is_empty());
    }

    /// e_k(B)·e_l(A) = 0. Where the two bodies share one of the two directions, each of them keeps this anyway.
    pub fn perpendicular(&mut self, k: usize, l: usize) {
        let is_shared = |m: usize| self.is_one_direction([Side::A, Side::B].map(|side| self.e(side, m)));
        let implied = is_shared(k) || is_shared(l);
        let invariant = self.assembly.builder.dot(&self.e(Side::B, k), &self.e(Side::A, l));
        self.row(invariant, 0.0, implied);
    }

    /// Whether two directions are sums of the same nodes.
    fn is_one_direction(&self, [a, b]: [Vec<Term>; 2]) -> bool {
        let builder = &self.assembly.builder;
        let points = a.iter().chain(&b).filter_map(|term| match term.place {
            Place::Node(node) if !builder.is_direction(node) => Some(builder.position_of(node)),
            _ => None,
        });
        let points: Vec<Vec3> = points.collect();
        let spread = points.iter().fold(0.0, |most: f64, place| most.max(norm(subtract(*place, points[0]))));
        self.apart([a, b], 1.0, spread).is_empty()
    }

    /// u_B ∥ u_A: no rotation but that about the axis; in the plane none at all.
    pub fn align(&mut self) {
        self.perpendicular(0, 1);
        if !self.is_planar() {
            self.perpendicular(0, 2);
        }
    }

    /// No rotation at all.
    pub fn lock_rotation(&mut self) {
        self.align();
        if !self.is_planar() {
            self.perpendicular(1, 2);
        }
    }

    /// Adds the row π = target, unless it is implied by what the bodies share.
    pub fn row(&mut self, invariant: InvariantId, target: f64, implied: bool) {
        let name = format!("{}[{}]", self.entry.name, self.names);
        self.names += 1;
        self.is_shared |= implied;
        if !implied {
            self.assembly.builder.constant_row(name, invariant, target);
        }
    }

    /// Adds the row that keeps the sum of some of the joint's coordinates, each with its factor.
    pub fn couple(&mut self, terms: &[(&str, f64)]) {
        let find = |name: &str| self.coordinates.iter().find(|known| known.name == name).expect("a coordinate of this joint");
        let forms: Vec<(Form, f64)> = terms.iter().map(|&(name, factor)| (find(name).form.clone(), factor)).collect();
        self.keep(&forms);
    }

    /// Adds the row first − second = 0.
    pub fn difference(&mut self, first: &Form, second: &Form) {
        self.keep(&[(first.clone(), 1.0), (second.clone(), -1.0)]);
    }

    /// Adds the row Σ factor · form = 0.
    pub fn keep(&mut self, forms: &[(Form, f64)]) {
        let parts: Vec<_> = forms.iter().map(|(form, factor)| (self.assembly.builder.part(form), *factor)).collect();
        self.hold_sum(&parts);
    }

    /// Adds the row that a part of a function is zero.
    pub fn hold(&mut self, part: Part) {
        self.hold_sum(&[(part, 1.0)]);
    }

    /// Adds the row that a sum of parts, each with its factor, is zero.
    pub fn hold_sum(&mut self, parts: &[(Part, f64)]) {
        let sum = self.assembly.builder.sum(parts);
        self.assembly.builder.constant_row(format!("{}[{}]", self.entry.name, self.names), sum, 0.0);
        self.names += 1;
    }

    /// The angle of B against A about the axis, as a coordinate.
    pub fn angle(&mut self) {
        let form = self.angle_between([1, 2]);
        self.coordinate_about("angle", form, true, Some(0));
    }

    /// The displacement d·e_k(A), as a coordinate.
    pub fn displacement(&mut self, name: &'static str, k: usize) {
        let form = Form::Product([self.d(), self.e(Side::A, k)]);
        self.coordinate_about(name, form, false, Some(k));
    }

    /// Adds the displacements across u, measured as `JOINT.x` and `JOINT.y`: x goes the way of that axis of the model which is nearest to being at
    /// right angles to u, the first of several, as far as that is across u; y is u × x.
    pub fn displacements_across(&mut self) {
        // w = u × v, and v = u × x.
        let x = self.e(Side::A, 2).into_iter().map(|term| Term { factor: -term.factor, turn: -term.turn, ..term });
        let form = Form::Product([self.d(), x.collect()]);
        self.coordinate("x", form, false);
        self.displacement("y", 1);
    }

    /// Adds a coordinate, measured as `JOINT.NAME`: an angle in rad, or a displacement in m.
    pub fn coordinate(&mut self, name: &'static str, form: Form, is_angle: bool) {
        self.coordinate_about(name, form, is_angle, None);
    }

    /// The same of one that is about or along a direction of the triad.
    pub fn coordinate_about(&mut self, name: &'static str, form: Form, is_angle: bool, about: Option<usize>) {
        self.coordinates.push(Coordinate { joint: self.entry.name.to_string(), name, form, is_angle, about });
    }

    /// The angle from e_k(A) to e_k(B), positive from k to l; in the plane from u to its quarter turn.
    pub fn angle_between(&self, [k, l]: [usize; 2]) -> Form {
        let [k, l] = if self.is_planar() { [0, 1] } else { [k, l] };
        let moving = self.e(Side::B, k);
        Form::Angle { cosine: [self.e(Side::A, k), moving.clone()], sine: [self.e(Side::A, l), moving], near: 0.0 }
    }
}
