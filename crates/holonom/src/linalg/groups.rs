//! Which unknowns are eliminated together: columns of the elimination tree are joined to fronts where that costs less.

use super::tile::LANES;

/// A matrix of so many blocks at most is one front.
pub(super) const ONE_FRONT: usize = 4;

/// What a front costs beside its arithmetic, in products of two tiles (measured with `cargo bench`).
const FRONT_COST: f64 = 12.0;

/// What eliminating the pivots of a front and a few solutions cost, and handing what is left to its parent.
fn cost(pivots: usize, rows: usize) -> f64 {
    let (head, tail) = (pivots.div_ceil(LANES), rows.div_ceil(LANES));
    // For each block of pivots the products, and what its diagonal and the solutions cost beside them.
    let blocks = (tail..head + tail).map(|left| ((left + 2) * (left + 2) + 4) as f64);
    FRONT_COST + blocks.sum::<f64>() + (rows * rows) as f64 / 8.0
}

/// Most columns that a front is made of one by one.
const NEAR: usize = 24;

/// For each column the best front that ends with it, with the best fronts below that one.
pub(super) struct Groups {
    pub best: Vec<Group>,
    /// Columns without a parent in the elimination tree.
    roots: Vec<u32>,
}

#[derive(Clone)]
pub(super) struct Group {
    pub members: Vec<u32>,
    /// Columns whose parent is one of the members: the last ones of the fronts below.
    children: Vec<u32>,
    /// Cost of the front and of all below it.
    cost: f64,
}

impl Groups {
    /// From the first column to the last. Columns join the ones before them singly, as long as those are few, or in whole fronts.
    pub fn new(columns: &[Vec<u32>]) -> Self {
        let mut children = vec![Vec::new(); columns.len()];
        let mut groups = Self { best: Vec::with_capacity(columns.len()), roots: Vec::new() };
        for (k, column) in columns.iter().enumerate() {
            match column.first() {
                Some(&parent) => children[parent as usize].push(k as u32),
                None => groups.roots.push(k as u32),
            }
        }
        let (rows, in_one) = (|k: u32| columns[k as usize].len(), columns.len() <= ONE_FRONT * LANES);
        children.iter_mut().for_each(|children| children.sort_by_key(|&child| rows(child)));
        for k in 0..columns.len() {
            let alone = Group { members: vec![k as u32], children: children[k].clone(), cost: 0.0 };
            let mut best = groups.priced(alone, rows(k as u32));
            let (mut singly, mut whole) = (best.clone(), best.clone());
            for _ in 0..NEAR {
                let Some(next) = (0..singly.children.len()).max_by_key(|&i| rows(singly.children[i])) else { break };
                let child = singly.children.swap_remove(next);
                singly.members.push(child);
                singly.children.extend(&children[child as usize]);
                singly = groups.priced(singly, rows(k as u32));
                if singly.cost < best.cost {
                    best = singly.clone();
                }
            }
            for &child in children[k].iter().rev() {
                let joined = groups.priced(groups.joined(&whole, child), rows(k as u32));
                if joined.cost < whole.cost || in_one {
                    whole = joined;
                }
            }
            groups.best.push(if whole.cost < best.cost || in_one { whole } else { best });
        }
        groups.best.iter_mut().for_each(|group| group.members.sort_unstable());
        groups
    }

    /// A group with its cost, where its last column has `rows` below.
    fn priced(&self, group: Group, rows: usize) -> Group {
        let below: f64 = group.children.iter().map(|&child| self.best[child as usize].cost).sum();
        Group { cost: cost(group.members.len(), rows) + below, ..group }
    }

    /// A group with the best front of one of its children.
    fn joined(&self, group: &Group, child: u32) -> Group {
        let Group { members, children, .. } = &self.best[child as usize];
        let others = group.children.iter().filter(|&&other| other != child);
        Group {
            members: group.members.iter().chain(members).copied().collect(),
            children: others.chain(children).copied().collect(),
            cost: 0.0,
        }
    }

    /// The last columns of all fronts, each after those of the fronts below.
    pub fn children_first(&self) -> Vec<u32> {
        let (mut found, mut open) = (Vec::new(), self.roots.clone());
        while let Some(group) = open.pop() {
            found.push(group);
            open.extend(&self.best[group as usize].children);
        }
        found.reverse();
        found
    }
}

/// Rows below the diagonal of each column of L (ascending places): each column hands its rows to its parent in the
/// elimination tree, the first of them.
pub(super) fn fill_in(size: usize, entries: &[(u32, u32)], place: &[u32]) -> Vec<Vec<u32>> {
    let mut columns: Vec<Vec<u32>> = vec![Vec::new(); size];
    for &(i, j) in entries {
        let (i, j) = (place[i as usize], place[j as usize]);
        if i != j {
            columns[i.min(j) as usize].push(i.max(j));
        }
    }
    for k in 0..size {
        let mut column = std::mem::take(&mut columns[k]);
        column.sort_unstable();
        column.dedup();
        if let Some((&parent, rest)) = column.split_first() {
            columns[parent as usize].extend_from_slice(rest);
        }
        columns[k] = column;
    }
    columns
}
