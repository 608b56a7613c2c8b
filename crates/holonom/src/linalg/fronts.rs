//! The fronts of the elimination tree, and where everything goes in them.

use super::groups::{Groups, Lists, ONE_FRONT, fill_in};
use super::tile::{LANES, TILE};

/// An order of elimination grouped into fronts, with every place worked out.
pub(super) struct Fronts {
    /// Place of each row of the matrix in a vector over the blocks of all fronts, and the row at each place.
    pub place: Vec<u32>,
    pub row: Vec<u32>,
    /// Children before their parents.
    pub fronts: Vec<Front>,
    pub sources: Vec<Sources>,
    /// Places of the rows below the pivots, ascending, one front after the other.
    pub below: Vec<u32>,
    /// For each of them, where it is in a column of the parent's front.
    pub in_parent: Vec<u32>,
    /// The children of each front, one front after the other.
    pub children: Vec<u32>,
    /// Places of the entries of the pattern among the numbers of all tiles that have any, ascending: those in the pivots' columns
    /// of one front after the other, then those in the rows beside.
    pub entries: Vec<u32>,
    /// Front of each block.
    of_block: Vec<u32>,
    /// Tiles of all fronts together.
    pub tiles: Tiles,
}

/// Numbers of tiles: of the pivots' columns, of the pivots' rows beside these, and of what is left to the parents.
#[derive(Clone, Copy, Default)]
pub(super) struct Tiles {
    pub lower: usize,
    pub upper: usize,
    pub rest: usize,
}

/// A dense square of the elimination: its pivots, and the rows below that they fill, each filled up to whole blocks of
/// [`LANES`]. It is stored in tiles, by columns of tiles and in each by columns. Pivots that only fill up are 1, and
/// everything else that fills up is 0. Its parts are kept apart, each right after that of the front before, as solutions read
/// the first two only, one after the other.
#[derive(Clone, Copy)]
pub(super) struct Front {
    pub pivots: usize,
    /// Rows below the pivots.
    pub rows: usize,
    /// Blocks of pivots.
    pub head: usize,
    /// Blocks of a side.
    pub size: usize,
    /// First of its blocks among those of all fronts.
    pub block: usize,
    /// First of the rows below among those of all fronts.
    pub below: usize,
    /// First of its tiles in the pivots' columns, and in the pivots' rows beside these.
    pub lower: usize,
    pub upper: usize,
}

/// What a front is put together from. Solutions go through the fronts without it.
#[derive(Clone, Copy, Default)]
pub(super) struct Sources {
    /// Its entries among those of all fronts, in its columns and in its rows beside: the first, and the one after the last.
    pub lower: [usize; 2],
    pub upper: [usize; 2],
    /// Its children among those of all fronts, likewise.
    pub children: [usize; 2],
    /// First of the tiles that it leaves to the parent.
    pub rest: usize,
    /// The front that takes what the pivots add to the rows below; a root has none.
    pub parent: Option<usize>,
}

impl Fronts {
    /// Groups the unknowns of a structurally symmetric pattern that are eliminated in the order `order`, which is kept
    /// but for unknowns that do not know of each other.
    pub fn new(size: usize, entries: &[(u32, u32)], order: &[u32]) -> Self {
        let mut place = vec![0; size];
        order.iter().enumerate().for_each(|(k, &row)| place[row as usize] = k as u32);
        let columns = fill_in(size, entries, &place);
        let groups = Groups::new(&columns);
        let mut fronts = Self {
            place: vec![0; size],
            row: Vec::new(),
            fronts: Vec::new(),
            sources: Vec::new(),
            below: Vec::new(),
            in_parent: Vec::new(),
            children: Vec::new(),
            entries: Vec::new(),
            of_block: Vec::new(),
            tiles: Tiles::default(),
        };
        let tops = groups.children_first();
        for &top in &tops {
            let (block, members) = (fronts.of_block.len(), groups.members.of(top));
            for (k, &column) in members.iter().enumerate() {
                fronts.place[order[column as usize] as usize] = (block * LANES + k) as u32;
            }
            let (pivots, rows) = (members.len(), columns.of(top).len());
            let head = pivots.div_ceil(LANES);
            let size = head + rows.div_ceil(LANES);
            fronts.of_block.extend(std::iter::repeat_n(fronts.fronts.len() as u32, head));
            let Tiles { lower, upper, rest } = fronts.tiles;
            fronts.fronts.push(Front { pivots, rows, head, size, block, lower, upper, below: 0 });
            fronts.sources.push(Sources { rest, ..Sources::default() });
            let tail = size - head;
            fronts.tiles = Tiles { lower: lower + head * size, upper: upper + tail * head, rest: rest + tail * tail };
        }
        fronts.row = vec![0; fronts.of_block.len() * LANES];
        fronts.place.iter().enumerate().for_each(|(row, &place)| fronts.row[place as usize] = row as u32);
        for (k, &top) in tops.iter().enumerate() {
            let first = fronts.below.len();
            fronts.below.extend(columns.of(top).iter().map(|&column| fronts.place[order[column as usize] as usize]));
            fronts.below[first..].sort_unstable();
            fronts.fronts[k].below = first;
            let parent = fronts.below.get(first).map(|&place| fronts.of_block[place as usize / LANES] as usize);
            fronts.sources[k].parent = parent;
        }
        fronts.in_parent = (0..fronts.fronts.len()).flat_map(|k| fronts.rows_in_parent(k)).collect();
        fronts.place_children();
        fronts.place_entries(entries);
        fronts
    }

    fn place_children(&mut self) {
        let of_parents = (0..).zip(&self.sources).filter_map(|(k, sources)| Some((sources.parent? as u32, k)));
        let children = Lists::sorted_in(self.fronts.len(), of_parents);
        for (k, sources) in self.sources.iter_mut().enumerate() {
            let range = children.range(k);
            sources.children = [range.start, range.end];
        }
        self.children = children.numbers;
    }

    fn place_entries(&mut self, entries: &[(u32, u32)]) {
        let find = |&(row, column): &(u32, u32)| self.find(row as usize, column as usize).expect("the pattern is in the fronts");
        let mut is_entry = vec![false; (self.tiles.lower + self.tiles.upper) * TILE];
        entries.iter().for_each(|entry| is_entry[find(entry)] = true);
        let places: Vec<u32> = (0..).zip(is_entry).filter_map(|(place, is_entry)| is_entry.then_some(place)).collect();
        let before = |tile: usize| places.partition_point(|&place| (place as usize) < tile * TILE);
        for (front, sources) in self.fronts.iter().zip(&mut self.sources) {
            let upper = self.tiles.lower + front.upper;
            sources.lower = [front.lower, front.columns().end].map(before);
            sources.upper = [upper, upper + front.head * front.tail()].map(before);
        }
        self.entries = places;
    }

    /// Whether they are those of a pattern of so many rows, whose entries may come in any order.
    pub fn have_pattern(&self, size: usize, entries: &[(u32, u32)]) -> bool {
        let mut is_found = vec![false; self.entries.len()];
        let mut find = |&(row, column): &(u32, u32)| {
            let place = self.find(row as usize, column as usize).and_then(|place| self.entries.binary_search(&(place as u32)).ok());
            place.map(|place| is_found[place] = true).is_some()
        };
        self.place.len() == size && entries.iter().all(&mut find) && is_found.iter().all(|is_found| *is_found)
    }

    /// Blocks of all fronts together.
    pub fn blocks(&self) -> usize {
        self.of_block.len()
    }

    /// Its blocks, where all is one front of few.
    pub fn one_front(&self) -> Option<usize> {
        match self.fronts[..] {
            [front] if front.head <= ONE_FRONT => Some(front.head),
            _ => None,
        }
    }

    /// The front that eliminates a row of the matrix.
    pub fn front_of(&self, row: usize) -> usize {
        self.of_block[self.place[row] as usize / LANES] as usize
    }

    fn rows_in_parent(&self, front: usize) -> Vec<u32> {
        let Some(parent) = self.sources[front].parent else { return Vec::new() };
        let parent = &self.fronts[parent];
        let row = |&place| in_column(self.row_in(parent, place).expect("a parent has the rows of its children")) as u32;
        self.below[self.fronts[front].range()].iter().map(row).collect()
    }

    /// Which row of a front is at a place.
    fn row_in(&self, front: &Front, place: u32) -> Option<usize> {
        match (place as usize).checked_sub(front.block * LANES) {
            Some(row) if row < front.pivots => Some(row),
            _ => self.below[front.range()].binary_search(&place).ok().map(|row| front.head * LANES + row),
        }
    }

    /// Where an entry of the matrix is among the values; none outside the pattern.
    pub fn position(&self, row: usize, column: usize) -> Option<usize> {
        let place = self.find(row, column)?;
        if self.one_front().is_some() { Some(place) } else { self.entries.binary_search(&(place as u32)).ok() }
    }

    /// Where each number of all tiles is among the values; anything where it is none of the pattern.
    pub fn positions(&self) -> Vec<u32> {
        let numbers = (self.tiles.lower + self.tiles.upper) * TILE;
        if self.one_front().is_some() {
            return (0..numbers as u32).collect();
        }
        let mut positions = vec![0; numbers];
        (0..).zip(&self.entries).for_each(|(position, &place)| positions[place as usize] = position);
        positions
    }

    /// Where an entry of the matrix is among the numbers of all tiles; none outside the filled pattern.
    pub fn find(&self, row: usize, column: usize) -> Option<usize> {
        let (row, column) = (self.place[row], self.place[column]);
        let front = &self.fronts[self.of_block[row.min(column) as usize / LANES] as usize];
        let (row, column) = (self.row_in(front, row)?, self.row_in(front, column)?);
        let tile = match (column / LANES).checked_sub(front.head) {
            None => front.lower + column / LANES * front.size,
            Some(column) => self.tiles.lower + front.upper + column * front.head,
        };
        Some(tile * TILE + column % LANES * LANES + in_column(row))
    }
}

/// Where a row is in a column of tiles.
fn in_column(row: usize) -> usize {
    row / LANES * TILE + row % LANES
}

impl Front {
    /// The rows below the pivots, among those of all fronts.
    pub fn range(&self) -> std::ops::Range<usize> {
        self.below..self.below + self.rows
    }

    /// Blocks of the rows below the pivots.
    pub fn tail(&self) -> usize {
        self.size - self.head
    }

    /// Its blocks among those of all fronts.
    pub fn blocks(&self) -> std::ops::Range<usize> {
        self.block..self.block + self.head
    }

    /// The tiles of the pivots' columns among those of all fronts.
    pub fn columns(&self) -> std::ops::Range<usize> {
        self.lower..self.lower + self.head * self.size
    }
}
