//! The tangents of laws: those of laws in a row on the same nodes, as of an element of a beam, are summed before they go to the matrix.

use crate::system::{MAX_ARGUMENTS, Response};

/// Factors of the four parts of a law's tangent: by f itself, by values, by rates, and by the motion of rates.
#[derive(Clone, Copy, Debug)]
pub struct LawFactors {
    /// Of f, which second derivatives of the invariants are multiplied by.
    pub force: f64,
    /// Of ∂f/∂π.
    pub value: f64,
    /// Of ∂f/∂π̇, as velocities change with positions.
    pub rate: f64,
    /// Of ∂f/∂π̇, as gradients turn with the motion.
    pub motion: f64,
}

/// What the tangents of laws are made of.
#[derive(Clone, Copy)]
pub struct LawTangents<'a> {
    /// The responses of all laws.
    pub responses: &'a [Response],
    /// Gradients of the forces, in slots.
    pub left: &'a [f64],
    /// Gradients of the values that they depend on, in slots.
    pub right: &'a [f64],
    /// H v in slots, through which π̇ depends on positions.
    pub motion: &'a [f64],
}

/// Laws in a row whose nodes are among those of the first.
pub(super) struct LawGroup {
    /// The first law.
    pub first: usize,
    /// How many nodes that has, free ones only.
    pub nodes: usize,
    /// The pairs of these, row-major.
    pub pairs: Vec<u32>,
    /// The free slots of each law, by arguments.
    laws: Vec<Vec<LawSlot>>,
}

/// A slot of an argument of a law, with the number of its node in the group.
struct LawSlot {
    slot: u32,
    node: u16,
    argument: u8,
}

// Arguments fit the byte that numbers them.
const _: () = assert!(MAX_ARGUMENTS < 256);

/// Groups laws, each with the nodes, slots and arguments of its free slots. None goes on across the law `apart`.
pub(super) fn group_laws(laws: impl Iterator<Item = Vec<(u32, u32, u8)>>, apart: usize, pair: impl Fn(u32, u32) -> u32) -> Vec<LawGroup> {
    let (mut groups, mut nodes): (Vec<LawGroup>, Vec<u32>) = (Vec::new(), Vec::new());
    for (law, slots) in laws.enumerate() {
        if law == 0 || law == apart || !slots.iter().all(|(node, ..)| nodes.contains(node)) {
            nodes = slots.iter().map(|&(node, ..)| node).collect();
            nodes.sort_unstable();
            nodes.dedup();
            let pairs = nodes.iter().flat_map(|&a| nodes.iter().map(move |&b| (a, b))).map(|(a, b)| pair(a, b)).collect();
            groups.push(LawGroup { first: law, nodes: nodes.len(), pairs, laws: Vec::new() });
        }
        let place = |of: u32| nodes.iter().position(|&node| node == of).expect("a node of the group") as u16;
        let slots = slots.into_iter().map(|(node, slot, argument)| LawSlot { slot, node: place(node), argument }).collect();
        groups.last_mut().expect("the first law begins a group").laws.push(slots);
    }
    groups
}

/// The sum of the tangents of the laws of a group, over the components of its nodes.
pub(super) struct GroupSum {
    /// Row-major.
    pub matrix: Vec<f64>,
    /// What the force of one argument changes by.
    line: Vec<f64>,
}

impl GroupSum {
    /// With the room for each of these groups.
    pub fn new(groups: &[LawGroup], dim: usize) -> Self {
        let width = dim * groups.iter().map(|group| group.nodes).max().unwrap_or(0);
        Self { matrix: Vec::with_capacity(width * width), line: Vec::with_capacity(width) }
    }

    /// Adds up ∇π_i (∂f_i/∂π_j ∇π_j + ∂f_i/∂π̇_j ∇π̇_j)ᵀ of the laws that have factors; whether there is any.
    pub fn add_up<const D: usize>(
        &mut self,
        group: &LawGroup,
        tangents: &LawTangents,
        factors: impl Fn(usize) -> Option<LawFactors>,
    ) -> bool {
        let Self { matrix, line } = self;
        let [left, right, motion] = [tangents.left, tangents.right, tangents.motion].map(|slots| slots.as_chunks::<D>().0);
        let laws = (group.first..).zip(&group.laws).filter(|(_, slots)| !slots.is_empty());
        let mut laws = laws.filter_map(|(law, slots)| Some((&tangents.responses[law], slots, factors(law)?))).peekable();
        if laws.peek().is_none() {
            return false;
        }
        let width = group.nodes * D;
        matrix.clear();
        matrix.resize(width * width, 0.0);
        for (response, slots, factors) in laws {
            for of_argument in slots.chunk_by(|a, b| a.argument == b.argument) {
                let i = of_argument[0].argument as usize;
                line.clear();
                line.resize(width, 0.0);
                for &LawSlot { slot, node, argument } in slots {
                    let (j, t, first) = (argument as usize, slot as usize, node as usize * D);
                    let stiffness = factors.value * response.by_value[i][j] + factors.rate * response.by_rate[i][j];
                    let turning = factors.motion * response.by_rate[i][j];
                    let parts = right[t].iter().zip(motion[t]).map(|(right, motion)| stiffness * right + turning * motion);
                    line[first..first + D].iter_mut().zip(parts).for_each(|(sum, part)| *sum += part);
                }
                for &LawSlot { slot, node, .. } in of_argument {
                    let sums = matrix[node as usize * D * width..].chunks_exact_mut(width);
                    for (sums, left) in sums.zip(left[slot as usize]) {
                        sums.iter_mut().zip(&*line).for_each(|(sum, by)| *sum += left * by);
                    }
                }
            }
        }
        true
    }
}
