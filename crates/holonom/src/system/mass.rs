//! Constant mass matrix M = M₄ ⊗ 1: one number for each pair of nodes (methods §4.1).

/// Symmetric sparse matrix over nodes, rows compressed. The full matrix is this one times the unit matrix of a node.
#[derive(Clone, Debug, Default)]
pub struct Mass {
    start: Vec<u32>,
    column: Vec<u32>,
    value: Vec<f64>,
}

impl Mass {
    /// Adds up the entries `(a, b, m)` of a matrix over `nodes` nodes; both triangles must be among them.
    pub(crate) fn new(nodes: usize, mut entries: Vec<(u32, u32, f64)>) -> Self {
        entries.sort_by_key(|&(a, b, _)| (a, b));
        let mut mass = Self { start: vec![0; nodes + 1], ..Self::default() };
        let mut last = None;
        for (a, b, m) in entries {
            if last == Some((a, b)) {
                *mass.value.last_mut().expect("an entry came before") += m;
            } else {
                mass.column.push(b);
                mass.value.push(m);
                mass.start[a as usize + 1] += 1;
                last = Some((a, b));
            }
        }
        for a in 0..nodes {
            mass.start[a + 1] += mass.start[a];
        }
        mass
    }

    /// Number of nodes.
    pub fn nodes(&self) -> usize {
        self.start.len() - 1
    }

    /// The entries of node `a`: pairs of node and kg.
    pub fn row(&self, a: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        let range = self.start[a] as usize..self.start[a + 1] as usize;
        self.column[range.clone()].iter().zip(&self.value[range]).map(|(&b, &m)| (b as usize, m))
    }

    /// The entry of the diagonal, kg.
    pub fn diagonal(&self, a: usize) -> f64 {
        self.row(a).find(|&(b, _)| b == a).map_or(0.0, |(_, m)| m)
    }

    /// y = M x over the first `nodes` nodes of `y`, `x` over all nodes, `dim` numbers a node.
    pub fn times(&self, dim: usize, x: &[f64], y: &mut [f64]) {
        match dim {
            2 => self.times_in::<2>(x, y),
            _ => self.times_in::<3>(x, y),
        }
    }

    fn times_in<const D: usize>(&self, x: &[f64], y: &mut [f64]) {
        for (a, y) in y.chunks_exact_mut(D).enumerate() {
            let mut sum = [0.0; D];
            for (b, m) in self.row(a) {
                for c in 0..D {
                    sum[c] += m * x[b * D + c];
                }
            }
            y.copy_from_slice(&sum);
        }
    }

    /// ½ xᵀ M y over all nodes.
    pub fn half_product(&self, dim: usize, x: &[f64], y: &[f64]) -> f64 {
        let mut sum = 0.0;
        for a in 0..self.nodes() {
            for (b, m) in self.row(a) {
                let dot: f64 = (0..dim).map(|c| x[a * dim + c] * y[b * dim + c]).sum();
                sum += m * dot;
            }
        }
        0.5 * sum
    }
}
