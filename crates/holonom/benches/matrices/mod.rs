//! The matrix [M Gᵀ; G −δ] of a mechanism of bars, at the positions of its start.

use faer::sparse::Triplet;
use holonom::linalg::fill_reducing_order;
use holonom::model::{BarInfo, Model};
use holonom::system::{Place, System};

/// Share of the rows' own size in −δ, as a stage has it.
const SOFT: f64 = 1e-10;

pub struct Matrix {
    pub size: usize,
    /// Row, column and value; entries of the same place add up.
    pub entries: Vec<(usize, usize, f64)>,
    /// Nodes by least fill-in, each row right after the last of its nodes, as the engine orders them.
    pub order: Vec<u32>,
}

impl Matrix {
    /// Number of rows and columns.
    pub fn size_of(model: &Model) -> usize {
        model.system.coordinates() + model.bars.len()
    }

    pub fn of(model: &Model) -> Self {
        let system = &model.system;
        let (dim, free) = (system.dimension(), system.free_nodes());
        let mut entries = Vec::new();
        for a in 0..free {
            for (b, block) in system.mass().row(a).filter(|&(b, _)| b < free) {
                entries.extend((0..dim).map(|c| (dim * a + c, dim * b + c, block.m)));
            }
        }
        for (k, bar) in model.bars.iter().enumerate() {
            let row = dim * free + k;
            entries.push((row, row, -SOFT));
            let ends = ends(bar);
            let [from, to] = ends.map(|end| position(system, end));
            for (end, sign) in ends.iter().zip([-1.0, 1.0]) {
                let Some(node) = free_node(system, *end) else { continue };
                for c in 0..dim {
                    let slope = sign * (to[c] - from[c]);
                    entries.extend([(row, dim * node + c, slope), (dim * node + c, row, slope)]);
                }
            }
        }
        Self { size: Self::size_of(model), entries, order: order(model) }
    }

    pub fn right_side(&self) -> Vec<f64> {
        vec![1.0; self.size]
    }

    #[allow(dead_code)] // each bench uses its share
    pub fn triplets(&self) -> Vec<Triplet<usize, usize, f64>> {
        self.entries.iter().map(|&(i, j, value)| Triplet::new(i, j, value)).collect()
    }
}

fn free_node(system: &System, place: Place) -> Option<usize> {
    match place {
        Place::Node(id) if id.index() < system.free_nodes() => Some(id.index()),
        _ => None,
    }
}

fn position(system: &System, place: Place) -> [f64; 3] {
    let dim = system.dimension();
    match place {
        Place::Node(id) => {
            let x = &system.start_position()[dim * id.index()..dim * (id.index() + 1)];
            std::array::from_fn(|c| x.get(c).copied().unwrap_or(0.0))
        }
        Place::Fixed(x) => x,
    }
}

fn order(model: &Model) -> Vec<u32> {
    let system = &model.system;
    let (dim, free) = (system.dimension() as u32, system.free_nodes());
    let nodes_of = |ends: [Place; 2]| ends.into_iter().filter_map(|end| free_node(system, end));
    let edges: Vec<(u32, u32)> = model
        .bars
        .iter()
        .filter_map(|bar| match nodes_of(ends(bar)).collect::<Vec<_>>()[..] {
            [a, b] => Some((a as u32, b as u32)),
            _ => None,
        })
        .collect();
    let nodes = fill_reducing_order(free, &edges);
    let mut place = vec![0; free];
    nodes.iter().enumerate().for_each(|(k, &node)| place[node as usize] = k);
    let mut rows_after = vec![Vec::new(); free];
    for (k, bar) in model.bars.iter().enumerate() {
        let last = nodes_of(ends(bar)).map(|node| place[node]).max().expect("a bar has a free end");
        rows_after[last].push(dim * free as u32 + k as u32);
    }
    let with_rows = nodes.iter().zip(&rows_after);
    with_rows.flat_map(|(&node, rows)| (0..dim).map(move |c| dim * node + c).chain(rows.iter().copied())).collect()
}

fn ends(bar: &BarInfo) -> [Place; 2] {
    bar.ends.expect("these models have no bodies")
}
