//! Which unknowns are eliminated together: columns of the elimination tree are joined to fronts where that costs less.

use super::tile::LANES;

/// A matrix of so many blocks at most is one front.
pub(super) const ONE_FRONT: usize = 4;

/// What a front costs beside its arithmetic, in products of two tiles (measured with `cargo bench`).
const FRONT_COST: f64 = 12.0;

/// What eliminating the pivots of a front and a few solutions cost, and handing what is left to its parent.
fn cost(pivots: usize, rows: usize) -> f64 {
    let (head, tail) = (pivots.div_ceil(LANES), rows.div_ceil(LANES));
    // For each block of pivots that has `left` after it (left + 2)² products, and 4 for what its diagonal and the solutions cost beside them.
    let squares = |last: usize| last * (last + 1) * (2 * last + 1) / 6;
    let blocks = squares(head + tail + 1) - squares(tail + 1) + 4 * head;
    FRONT_COST + blocks as f64 + (rows * rows) as f64 / 8.0
}

/// Most columns that a front is made of one by one.
const NEAR: usize = 24;

/// Lists of numbers, one after the other.
#[derive(Default)]
pub(super) struct Lists {
    pub numbers: Vec<u32>,
    /// Where each list ends.
    ends: Vec<u32>,
}

impl Lists {
    /// One list for each of `lists`, with the `numbers` that are given for it, in their order.
    pub fn sorted_in(lists: usize, numbers: impl Iterator<Item = (u32, u32)> + Clone) -> Self {
        let mut next = vec![0; lists + 1];
        numbers.clone().for_each(|(list, _)| next[list as usize + 1] += 1);
        (0..lists).for_each(|list| next[list + 1] += next[list]);
        let mut sorted = vec![0; next[lists] as usize];
        for (list, number) in numbers {
            sorted[next[list as usize] as usize] = number;
            next[list as usize] += 1;
        }
        next.truncate(lists);
        Self { numbers: sorted, ends: next }
    }

    pub fn range(&self, list: usize) -> std::ops::Range<usize> {
        list.checked_sub(1).map_or(0, |before| self.ends[before] as usize)..self.ends[list] as usize
    }

    pub fn of(&self, list: u32) -> &[u32] {
        &self.numbers[self.range(list as usize)]
    }

    fn of_mut(&mut self, list: usize) -> &mut [u32] {
        let range = self.range(list);
        &mut self.numbers[range]
    }

    pub fn len(&self) -> usize {
        self.ends.len()
    }

    fn push(&mut self, list: impl IntoIterator<Item = u32>) {
        self.numbers.extend(list);
        self.ends.push(self.numbers.len() as u32);
    }
}

/// For each column the best front that ends with it, with the best fronts below that one.
#[derive(Default)]
pub(super) struct Groups {
    /// Columns of each front.
    pub members: Lists,
    /// Columns whose parent is one of the members: the last ones of the fronts below.
    children: Lists,
    /// Cost of each front and of all below it.
    costs: Vec<f64>,
    /// Columns without a parent in the elimination tree.
    roots: Vec<u32>,
}

/// A front that is tried.
#[derive(Default)]
struct Trial {
    members: Vec<u32>,
    children: Vec<u32>,
    /// Cost of all below it. Costs are whole numbers of eighths, so that sums and differences of them are exact.
    below: f64,
}

impl Trial {
    /// One column with its children.
    fn begin(&mut self, column: u32, children: &[u32], below: f64) {
        self.members.clear();
        self.members.push(column);
        self.children.clear();
        self.children.extend(children);
        self.below = below;
    }

    fn copy(&mut self, other: &Self) {
        self.members.clone_from(&other.members);
        self.children.clone_from(&other.children);
    }
}

impl Groups {
    /// From the first column to the last. Columns join the ones before them singly, as long as those are few, or in whole fronts.
    pub fn new(columns: &Lists) -> Self {
        let all = 0..columns.len() as u32;
        let (parent, rows) = (|k: u32| columns.of(k).first().copied(), |k: u32| columns.of(k).len());
        let mut children = Lists::sorted_in(columns.len(), all.clone().filter_map(|k| Some((parent(k)?, k))));
        (0..columns.len()).for_each(|k| children.of_mut(k).sort_by_key(|&child| rows(child)));
        let mut groups = Self { roots: all.clone().filter(|&k| parent(k).is_none()).collect(), ..Self::default() };
        let in_one = columns.len() <= ONE_FRONT * LANES;
        let [mut singly, mut best, mut whole] = [(); 3].map(|()| Trial::default());
        for k in all {
            let (own, under) = (children.of(k), rows(k));
            let below = groups.cost_of(own);
            [&mut singly, &mut best, &mut whole].into_iter().for_each(|trial| trial.begin(k, own, below));
            let alone = cost(1, under) + below;
            let (mut least, mut least_whole) = (alone, alone);
            for _ in 0..NEAR {
                let Some(next) = (0..singly.children.len()).max_by_key(|&i| rows(singly.children[i])) else { break };
                let child = singly.children.swap_remove(next);
                let further = children.of(child);
                singly.members.push(child);
                singly.children.extend(further);
                singly.below += groups.cost_of(further) - groups.costs[child as usize];
                let joined = cost(singly.members.len(), under) + singly.below;
                if joined < least {
                    least = joined;
                    best.copy(&singly);
                }
            }
            for &child in own.iter().rev() {
                let (members, further) = (groups.members.of(child), groups.children.of(child));
                let below = whole.below + groups.cost_of(further) - groups.costs[child as usize];
                let joined = cost(whole.members.len() + members.len(), under) + below;
                if joined < least_whole || in_one {
                    (whole.below, least_whole) = (below, joined);
                    whole.members.extend(members);
                    whole.children.retain(|&other| other != child);
                    whole.children.extend(further);
                }
            }
            let (best, cost) = if least_whole < least || in_one { (&mut whole, least_whole) } else { (&mut best, least) };
            best.members.sort_unstable();
            groups.members.push(best.members.iter().copied());
            groups.children.push(best.children.iter().copied());
            groups.costs.push(cost);
        }
        groups
    }

    /// Cost of the best fronts that end with some columns, and of all below them.
    fn cost_of(&self, columns: &[u32]) -> f64 {
        columns.iter().map(|&column| self.costs[column as usize]).sum()
    }

    /// The last columns of all fronts, each after those of the fronts below.
    pub fn children_first(&self) -> Vec<u32> {
        let (mut found, mut open) = (Vec::new(), self.roots.clone());
        while let Some(group) = open.pop() {
            found.push(group);
            open.extend(self.children.of(group));
        }
        found.reverse();
        found
    }
}

/// Rows below the diagonal of each column of L (ascending places): each column hands its rows to its parent in the
/// elimination tree, the first of them.
pub(super) fn fill_in(size: usize, entries: &[(u32, u32)], place: &[u32]) -> Lists {
    let places = entries.iter().map(|&(i, j)| (place[i as usize], place[j as usize])).filter(|(i, j)| i < j);
    let entries = Lists::sorted_in(size, places);
    const NONE: u32 = u32::MAX;
    let mut columns = Lists::default();
    // The last child of each column, and of each child the one before it.
    let (mut last, mut before) = (vec![NONE; size], vec![NONE; size]);
    let mut found_for = vec![NONE; size];
    let mut column = Vec::new();
    for k in 0..size as u32 {
        let mut find = |row: u32| {
            if row != k && std::mem::replace(&mut found_for[row as usize], k) != k {
                column.push(row);
            }
        };
        entries.of(k).iter().copied().for_each(&mut find);
        let mut child = last[k as usize];
        while child != NONE {
            columns.of(child).iter().copied().for_each(&mut find);
            child = before[child as usize];
        }
        column.sort_unstable();
        if let Some(&parent) = column.first() {
            before[k as usize] = std::mem::replace(&mut last[parent as usize], k);
        }
        columns.push(column.drain(..));
    }
    columns
}
