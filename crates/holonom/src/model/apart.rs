//! The forces of joints whose bodies share nodes, by the same model without shared nodes.

use super::Model;
use super::bodies::frame::Frame;
use crate::simulation::Apart;
use crate::system::{Place, Term};

impl Model {
    /// Whether bodies share nodes at a joint, so that its force is not among those of the rows.
    pub fn shares_nodes(&self) -> bool {
        self.joints.iter().any(|joint| joint.is_shared)
    }

    /// Takes the forces of all joints and drives from the same model with `reactions = true` in `[output]`, in which no bodies share nodes.
    ///
    /// # Panics
    /// When that is another model.
    pub fn tell_forces(&mut self, apart: Self) {
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
        assert!(nodes.iter().all(|terms| !terms.is_empty()), "each node is one of a point or of a body");
        self.channels.apart = Some((Apart::new(apart.system, nodes), apart.channels).into());
    }
}
