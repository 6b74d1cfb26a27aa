//! Whether there is room in memory for a complete factorisation.
//!
//! What does not fit would drive out everything else or be stopped by the system, and with it the work. Without room the
//! conjugate gradients are left alone, and a step that fails is taken again in two.

use super::dissection;
use sysinfo::{CGroupLimits, MemoryRefreshKind, System};

/// There is always room for this much; what is free is not asked [bytes].
const LITTLE: f64 = 256e6;

/// What is counted on where the system does not tell [bytes].
const UNTOLD: f64 = 4e9;

/// Memory that a factor takes in all, over its size: its pattern, and fronts while it is made.
const IN_ALL: f64 = 1.25;

/// Whether a complete factor of so many nodes fits into the memory that is free now.
pub(crate) fn is_there_for(nodes: usize) -> bool {
    let wanted = IN_ALL * dissection::bytes(nodes);
    if wanted < LITTLE {
        return true;
    }
    wanted < free_memory().unwrap_or(UNTOLD)
}

/// Memory that is free, in this container and in all, where the system tells [bytes].
fn free_memory() -> Option<f64> {
    let mut system = System::new().ok()?;
    system.refresh_memory_specifics(MemoryRefreshKind::nothing().with_ram());
    // What files take there is not counted: it makes room.
    let left = |limits: CGroupLimits| limits.total_memory.saturating_sub(limits.rss);
    let allowed = system.cgroup_limits().map_or(u64::MAX, left);
    Some(system.available_memory().min(allowed) as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_swatch_fits_and_the_fabric_of_a_city_does_not() {
        assert!(is_there_for(1_000));
        assert!(free_memory().is_none_or(|free| free > 1e6), "{:?}", free_memory());
        // Some 20 TB.
        assert!(!is_there_for(1_000_000_000));
    }
}
