//! Fill-reducing orders by approximate minimum degree.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::sparse::SymbolicSparseColMat;
use faer::sparse::linalg::amd;

/// An order of the vertices of a graph in which elimination fills in little. `edges` need each pair once.
pub fn fill_reducing_order(vertices: usize, edges: &[(u32, u32)]) -> Vec<u32> {
    let mut columns: Vec<Vec<usize>> = vec![Vec::new(); vertices];
    for &(i, j) in edges {
        if i != j {
            columns[i.max(j) as usize].push(i.min(j) as usize);
        }
    }
    let (mut start, mut index) = (vec![0], Vec::new());
    for column in &mut columns {
        column.sort_unstable();
        column.dedup();
        index.extend_from_slice(column);
        start.push(index.len());
    }
    let entries = index.len();
    let pattern = SymbolicSparseColMat::new_checked(vertices, vertices, start, None, index);
    let (mut order, mut place) = (vec![0usize; vertices], vec![0usize; vertices]);
    let mut memory = MemBuffer::new(amd::order_scratch::<usize>(vertices, entries));
    amd::order(&mut order, &mut place, pattern.as_ref(), amd::Control::default(), MemStack::new(&mut memory))
        .expect("a graph held in memory can be ordered");
    order.into_iter().map(|v| v as u32).collect()
}
