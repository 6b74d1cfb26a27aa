//! What the machine does at best, to hold the solver against: a roofline.

use sim_core::{Costs, STAGES};
use std::hint::black_box;
use std::time::Instant;

/// Bytes of the array that is copied: too many for any cache.
const COPIED: usize = 1 << 28;

/// Multiplications and additions to time.
const OPERATIONS: usize = 1 << 28;

/// Numbers that are multiplied and added beside each other: enough to keep every unit busy.
const BESIDE: usize = 64;

/// What one core of this machine does.
pub struct Machine {
    /// Reading and writing memory [GB/s].
    pub copy: f64,
    /// Multiplying and adding in single precision [Gflop/s].
    pub arithmetic: f64,
}

impl Machine {
    /// Measures, which takes less than a second.
    pub fn measure() -> Self {
        Self { copy: copy(), arithmetic: pulp::Arch::new().dispatch(Arithmetic) }
    }

    /// How near to it the stages of the solver on the CPU come; None where it did nothing.
    pub fn compare(&self, costs: &Costs) -> Option<String> {
        if costs.operations == 0 {
            return None;
        }
        let by_second = |count: u64, name: &str| {
            let stage = STAGES.iter().position(|s| *s == name).unwrap_or_default();
            1e-9 * count as f64 / costs.stages[stage].as_secs_f64().max(1e-12)
        };
        let moved = by_second(costs.bytes, "iterations");
        let done = by_second(costs.operations, "factorisation");
        Some(format!(
            "iterations read {moved:.1} GB/s (a plain copy moves {:.1}), the factorisation does {done:.1} Gflop/s (multiplying \
             and adding alone {:.1})",
            self.copy, self.arithmetic
        ))
    }
}

/// The best of three copies [GB/s], reads and writes counted.
fn copy() -> f64 {
    let (from, mut to) = (vec![1_u64; COPIED / 8], vec![0_u64; COPIED / 8]);
    let once = |_| {
        let start = Instant::now();
        to.copy_from_slice(black_box(&from));
        black_box(&to);
        2.0 * COPIED as f64 / start.elapsed().as_secs_f64() / 1e9
    };
    (0..3).map(once).fold(0.0, f64::max)
}

struct Arithmetic;

impl pulp::WithSimd for Arithmetic {
    type Output = f64;

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _: S) -> f64 {
        let (mut numbers, factor) = ([1.0_f32; BESIDE], black_box(0.999_f32));
        let start = Instant::now();
        for _ in 0..OPERATIONS / BESIDE {
            for x in &mut numbers {
                *x = *x * factor + 0.001;
            }
        }
        black_box(numbers);
        2.0 * OPERATIONS as f64 / start.elapsed().as_secs_f64() / 1e9
    }
}

/// Counts the most memory that this process has from now on, where the system does.
pub fn forget_peak() {
    // Where it doesn't, what came before counts, too.
    let _ = std::fs::write("/proc/self/clear_refs", "5");
}

/// The most memory that this process has had, where the system tells [MiB].
pub fn peak_mib() -> Option<f64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    let kib: f64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(kib / 1024.0)
}
