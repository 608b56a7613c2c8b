//! The forces of joints whose bodies share nodes, by the same model without shared nodes.

use std::collections::{HashMap, HashSet};
use std::sync::Arc;

use super::assembly::Assembly;
use super::bodies::frame::Frame;
use super::bodies::nodes::{Member, PlaceCode, code_of};
use super::fault::Faults;
use super::value::Value;
use super::{Files, Kinds, Model};
use crate::simulation::Apart;
use crate::system::{Place, Term};

impl Assembly<'_> {
    /// Takes the forces of joints for unknown past which bodies share a node: a plate between two shafts along its normal has no node across it, and the
    /// second shaft has the axis of the first bearing, which then holds it past the plate. Rows that hold the plate to that axis twice are redundant.
    pub(super) fn doubt_forces(&mut self) {
        let codes: Vec<Vec<PlaceCode>> = self.frames.iter().map(codes_of).collect();
        let members: Vec<[Member; 2]> = self.joints.iter().map(|joint| joint.geometry.members).collect();
        let mut joints_of = vec![Vec::new(); codes.len()];
        let mut bodies_with = HashMap::<PlaceCode, usize>::new();
        codes.iter().flatten().for_each(|code| *bodies_with.entry(*code).or_default() += 1);
        for (number, sides) in members.iter().enumerate() {
            for (side, other) in [(sides[0], sides[1]), (sides[1], sides[0])] {
                if let Member::Body(body) = side {
                    joints_of[body].push((number, other));
                }
            }
        }
        let has = |member: Member, code: &PlaceCode| match member {
            Member::Ground => is_fixed(code),
            Member::Body(body) => codes[body].contains(code),
            _ => codes_of(&self.frame(member)).contains(code),
        };
        let (mut doubted, mut seen) = (HashSet::new(), HashSet::new());
        for (body, code) in codes.iter().enumerate().flat_map(|(body, own)| own.iter().map(move |code| (body, code))) {
            let is_common = is_fixed(code) || bodies_with[code] > 1;
            if !is_common || joints_of[body].iter().any(|&(_, other)| has(other, code)) {
                continue;
            }
            // From body to body as far as these do not have it.
            let mut open = vec![body];
            while let Some(from) = open.pop() {
                for &(joint, other) in &joints_of[from] {
                    let has_none = !has(other, code);
                    if let (Member::Body(next), true) = (other, has_none) {
                        doubted.insert(joint);
                        open.extend(seen.insert((next, *code)).then_some(next));
                    } else if !has_none && from != body {
                        doubted.insert(joint);
                    }
                }
            }
        }
        let joints = doubted.into_iter().filter(|&joint| !members[joint].iter().any(|side| matches!(side, Member::Bar(_))));
        joints.for_each(|joint| self.joints[joint].is_shared = true);
    }
}

fn codes_of(frame: &Frame) -> Vec<PlaceCode> {
    match frame {
        Frame::Ground => Vec::new(),
        Frame::Particle(place) => vec![code_of(*place)],
        Frame::Bar(ends) => ends.iter().flat_map(|(terms, _)| terms).map(|term| code_of(term.place)).collect(),
        Frame::Body { basis, .. } => basis.iter().map(|node| code_of(node.place)).collect(),
    }
}

/// Whether a code is that of a fixed place.
fn is_fixed(code: &PlaceCode) -> bool {
    code[0] != u64::MAX
}

impl Model {
    /// Whether bodies share nodes at a joint, so that its force is not among those of the rows.
    pub fn shares_nodes(&self) -> bool {
        self.joints.iter().any(|joint| joint.is_shared && !joint.geometry.is_of_bar())
    }

    /// Takes the forces of all joints and drives from the same model, which is in `value` with `reactions = true` in `[output]`, so that no bodies share
    /// nodes in it. It begins as this one. Says whether that could be done: another model has other nodes, and so has one in which rounding decides which
    /// places are the same.
    ///
    /// # Errors
    /// Everything that is wrong with it, with paths into the table.
    pub fn tell_forces(&mut self, value: &Value, kinds: &Kinds, files: &dyn Files) -> Result<bool, Faults> {
        let apart = Self::compile(value, kinds, files, Some(self))?;
        let nodes = self.nodes_of(apart.points.iter().map(|point| point.place), &apart.frames, apart.system.free);
        if let Some(nodes) = nodes {
            let nodes_of = |frame: &Frame| frame.nodes().into_iter().map(|(node, _)| node).collect();
            let bodies = apart.frames.iter().filter(|frame| matches!(frame, Frame::Body { .. })).map(nodes_of).collect();
            Arc::make_mut(&mut self.channels).apart = Some((Apart::new(apart.system, nodes, bodies), apart.channels).into());
            return Ok(true);
        }
        Ok(false)
    }

    /// The free nodes of the same model in which no bodies share nodes, with its points and frames, as sums of the nodes of this one. `None` where
    /// some of them are nowhere here.
    pub(super) fn nodes_of(&self, points: impl Iterator<Item = Place>, frames: &[Frame], free: usize) -> Option<Vec<Vec<Term>>> {
        let mut nodes = vec![Vec::new(); free];
        let mut put = |place: &Place, terms: Vec<Term>| {
            if let Place::Node(node) = place
                && let Some(own) = nodes.get_mut(node.index())
            {
                *own = terms;
            }
        };
        for (own, other) in self.points.iter().zip(points) {
            put(&other, vec![(own.place, 1.0).into()]);
        }
        for (own, other) in self.frames.iter().zip(frames) {
            let Frame::Body { basis, .. } = other else { continue };
            basis.iter().for_each(|node| put(&node.place, if node.is_point { own.point(node.at) } else { own.vector(node.at) }));
        }
        Some(nodes).filter(|nodes| nodes.iter().all(|terms| !terms.is_empty()))
    }
}
