//! Rows that are too many on one node: each of them waits for the node, so that all of them fill in with each other.

use super::StartError;
use crate::system::System;

/// Neighbours below which a node is no hub, rows of which need not wait for it, and rows that may go early all the same.
const FEW: usize = 100;
const EARLY: usize = 6 * FEW;

/// Refuses a system whose matrix would have more entries than can be numbered, as so many rows are on one node.
pub(super) fn require_few_rows(system: &System) -> Result<(), StartError> {
    if system.constraints() < 2 * EARLY {
        return Ok(());
    }
    let mut rows = vec![Vec::new(); system.free];
    for (row, slots) in system.slots.rows.iter().enumerate() {
        let nodes = system.slots.nodes[slots.clone()].iter().map(|&node| node as usize).filter(|&node| node < system.free);
        nodes.for_each(|node| rows[node].push(row));
    }
    for of_node in &mut rows {
        of_node.dedup();
        let count = of_node.len().saturating_sub(EARLY) as u64;
        if count * count / 2 <= u64::from(u32::MAX) {
            continue;
        }
        let mut others: Vec<u32> =
            of_node.iter().flat_map(|&row| system.slots.nodes[system.slots.rows[row].clone()].iter().copied()).collect();
        others.sort_unstable();
        others.dedup();
        if others.len() < FEW {
            return Err(StartError::Crowded { row: system.row_names[of_node[0]].clone(), rows: of_node.len() });
        }
    }
    Ok(())
}
