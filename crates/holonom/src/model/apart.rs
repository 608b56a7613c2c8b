//! The forces of joints whose bodies share nodes, by the same model without shared nodes.

use super::Model;
use super::bodies::frame::Frame;
use crate::simulation::Apart;
use crate::system::{Place, Term};

impl Model {
    /// Whether bodies share nodes at a joint, so that its force is not among those of the rows.
    pub fn shares_nodes(&self) -> bool {
        self.joints.iter().any(|joint| joint.is_shared && !joint.geometry.is_of_bar())
    }

    /// Takes the forces of all joints and drives from the same model with `reactions = true` in `[output]`, in which no bodies share nodes. Says
    /// whether that could be done: another model has other nodes, and so has one in which rounding decides which places are the same.
    #[must_use]
    pub fn tell_forces(&mut self, apart: Self) -> bool {
        let mut nodes = vec![Vec::new(); apart.system.free];
        let mut put = |place: &Place, terms: Vec<Term>| {
            if let Place::Node(node) = place
                && let Some(own) = nodes.get_mut(node.index())
            {
                *own = terms;
            }
        };
        for (own, other) in self.points.iter().zip(&apart.points) {
            put(&other.place, vec![(own.place, 1.0).into()]);
        }
        for (own, other) in self.frames.iter().zip(&apart.frames) {
            let Frame::Body { basis, .. } = other else { continue };
            basis.iter().for_each(|node| put(&node.place, if node.is_point { own.point(node.at) } else { own.vector(node.at) }));
        }
        let is_whole = nodes.iter().all(|terms| !terms.is_empty());
        if is_whole {
            let nodes_of = |frame: &Frame| frame.nodes().into_iter().map(|(node, _)| node).collect();
            let bodies = apart.frames.iter().filter(|frame| matches!(frame, Frame::Body { .. })).map(nodes_of).collect();
            self.channels.apart = Some((Apart::new(apart.system, nodes, bodies), apart.channels).into());
        }
        is_whole
    }
}
