//! Plans of eliminations that were made before: a matrix of the same pattern in the same order takes them as they are.

use std::sync::{Arc, Mutex, MutexGuard};

use super::fronts::Fronts;

/// Most plans that are kept: those that a few methods make for one system.
const MOST: usize = 8;

/// The plans of some matrices, for many threads. A plan follows from the pattern and the order alone: it is the same whether it
/// was found here or not.
#[derive(Default)]
pub struct Plans {
    /// The latest last.
    made: Mutex<Vec<Plan>>,
}

struct Plan {
    order: Vec<u32>,
    fronts: Arc<Fronts>,
}

impl Plans {
    pub(super) fn fronts(&self, size: usize, entries: &[(u32, u32)], order: &[u32]) -> Arc<Fronts> {
        let is_same = |plan: &&Plan| plan.order == order && plan.fronts.have_pattern(size, entries);
        if let Some(plan) = self.made().iter().find(is_same) {
            return plan.fronts.clone();
        }
        let fronts = Arc::new(Fronts::new(size, entries, order));
        let mut made = self.made();
        if made.len() == MOST {
            made.remove(0);
        }
        made.push(Plan { order: order.into(), fronts: fronts.clone() });
        fronts
    }

    fn made(&self) -> MutexGuard<'_, Vec<Plan>> {
        self.made.lock().expect("no planner panics")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_patterns_in_equal_order_are_planned_once() {
        let (plans, entries) = (Plans::default(), [(0, 0), (1, 1), (0, 1), (1, 0)]);
        let first = plans.fronts(2, &entries, &[0, 1]);
        assert!(Arc::ptr_eq(&first, &plans.fronts(2, &entries, &[0, 1])));
        let others = [plans.fronts(2, &entries, &[1, 0]), plans.fronts(2, &entries[..2], &[0, 1]), plans.fronts(3, &entries, &[0, 1, 2])];
        assert!(others.iter().all(|other| !Arc::ptr_eq(&first, other)));
    }

    #[test]
    fn the_latest_plans_are_kept() {
        let plans = Plans::default();
        let of_size = |size: u32| plans.fronts(size as usize, &[], &(0..size).collect::<Vec<_>>());
        let made: Vec<_> = (1..=MOST as u32 + 1).map(of_size).collect();
        assert!((2..).zip(&made[1..]).all(|(size, plan)| Arc::ptr_eq(plan, &of_size(size))));
        assert!(!Arc::ptr_eq(&made[0], &of_size(1)));
    }
}
