//! Constant mass matrix M = M₄ ⊗ 1: one number for each pair of nodes (methods §6), and in the plane a second one for
//! the quarter turn J, as a body between two points with its centre of mass beside them needs it.

/// Symmetric sparse matrix over nodes, rows compressed.
#[derive(Clone, Debug, Default)]
pub struct Mass {
    start: Vec<u32>,
    column: Vec<u32>,
    value: Vec<f64>,
    turn: Vec<f64>,
    /// Whether there is a quarter turn in it.
    turns: bool,
}

/// The block m 1 + s J of a pair of nodes, kg.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MassBlock {
    /// Factor of the unit matrix.
    pub m: f64,
    /// Factor of the quarter turn J of the plane; 0 in space.
    pub s: f64,
}

impl MassBlock {
    /// x · (m 1 + s J) y of vectors with as many components as a node.
    #[inline]
    pub fn product(self, x: &[f64], y: &[f64]) -> f64 {
        let along: f64 = x.iter().zip(y).map(|(x, y)| x * y).sum();
        match self.s == 0.0 {
            true => self.m * along,
            false => self.m * along + self.s * (x[1] * y[0] - x[0] * y[1]),
        }
    }
}

impl Mass {
    /// Adds up the blocks `(a, b, m, s)` of a matrix over `nodes` nodes; both triangles must be among them.
    pub(crate) fn new(nodes: usize, mut entries: Vec<(u32, u32, MassBlock)>) -> Self {
        entries.sort_by_key(|&(a, b, _)| (a, b));
        let mut mass = Self { start: vec![0; nodes + 1], ..Self::default() };
        let mut last = None;
        for (a, b, block) in entries {
            if last == Some((a, b)) {
                *mass.value.last_mut().expect("an entry came before") += block.m;
                *mass.turn.last_mut().expect("an entry came before") += block.s;
            } else {
                mass.column.push(b);
                mass.value.push(block.m);
                mass.turn.push(block.s);
                mass.start[a as usize + 1] += 1;
                last = Some((a, b));
            }
        }
        for a in 0..nodes {
            mass.start[a + 1] += mass.start[a];
        }
        mass.turns = mass.turn.iter().any(|&s| s != 0.0);
        mass
    }

    /// Number of nodes.
    pub fn nodes(&self) -> usize {
        self.start.len() - 1
    }

    /// The blocks of node `a`: the other node and the block.
    pub fn row(&self, a: usize) -> impl Iterator<Item = (usize, MassBlock)> + '_ {
        let range = self.start[a] as usize..self.start[a + 1] as usize;
        range.map(|k| (self.column[k] as usize, MassBlock { m: self.value[k], s: self.turn[k] }))
    }

    /// The entry of the diagonal, kg.
    pub fn diagonal(&self, a: usize) -> f64 {
        self.row(a).find(|&(b, _)| b == a).map_or(0.0, |(_, block)| block.m)
    }

    /// y = M x over the first `nodes` nodes of `y`, `x` over all nodes, `dim` numbers a node.
    pub fn times(&self, dim: usize, x: &[f64], y: &mut [f64]) {
        match dim {
            2 => self.times_in::<2>(x, y),
            _ => self.times_in::<3>(x, y),
        }
    }

    fn times_in<const D: usize>(&self, x: &[f64], y: &mut [f64]) {
        let (x, y) = (x.as_chunks::<D>().0, y.as_chunks_mut::<D>().0);
        for (y, range) in y.iter_mut().zip(self.start.windows(2)) {
            *y = self.row_times(range, x);
        }
    }

    /// ½ xᵀ M y over all nodes.
    pub fn half_product(&self, dim: usize, x: &[f64], y: &[f64]) -> f64 {
        match dim {
            2 => self.half_product_in::<2>(x, y),
            _ => self.half_product_in::<3>(x, y),
        }
    }

    fn half_product_in<const D: usize>(&self, x: &[f64], y: &[f64]) -> f64 {
        let (x, y) = (x.as_chunks::<D>().0, y.as_chunks::<D>().0);
        let mut sum = 0.0;
        for (x, range) in x.iter().zip(self.start.windows(2)) {
            let product = self.row_times(range, y);
            (0..D).for_each(|c| sum += x[c] * product[c]);
        }
        0.5 * sum
    }

    /// The blocks from one place to another times those of `x` that belong to them.
    #[inline(always)]
    fn row_times<const D: usize>(&self, range: &[u32], x: &[[f64; D]]) -> [f64; D] {
        let range = range[0] as usize..range[1] as usize;
        let mut sum = [0.0; D];
        for (&b, m) in self.column[range.clone()].iter().zip(&self.value[range.clone()]) {
            let x = &x[b as usize];
            (0..D).for_each(|c| sum[c] += m * x[c]);
        }
        if self.turns {
            for (&b, s) in self.column[range.clone()].iter().zip(&self.turn[range]) {
                let x = &x[b as usize];
                (sum[0], sum[1]) = (sum[0] - s * x[1], sum[1] + s * x[0]);
            }
        }
        sum
    }

    /// The same with the sizes of all numbers: what y is a sum of.
    pub fn times_sizes(&self, dim: usize, x: &[f64], y: &mut [f64]) {
        for (a, y) in y.chunks_exact_mut(dim).enumerate() {
            y.fill(0.0);
            for (b, block) in self.row(a) {
                let x = x[b * dim..(b + 1) * dim].iter().fold(0.0, |m: f64, x| m.max(x.abs()));
                y.iter_mut().for_each(|y| *y += (block.m.abs() + block.s.abs()) * x);
            }
        }
    }
}
