//! The simulator as compute kernels, on any GPU that WebGPU runs on.
//!
//! # Theory
//! The same model, the same linearly implicit step and the same stages in the same order as on the CPU (`step.rs`); every kernel in
//! `kernels/` names the CPU function whose twin it is. What differs, and why:
//!
//! - **Single precision.** A sliding coordinate is kept as displacement s from where it was laid, so Δu = Δu_laid + s₁ − s₀ loses
//!   nothing on a hundred metres of yarn; positions are measured from the middle of the fabric at the start. Conjugate gradients
//!   begin with the old velocities, and what these leave is summed element by element from differences of velocities, as
//!   b − A v₀ from the assembled matrix would lose the motion of the fabric as a whole (the stiffness of a segment is 4e5 times its mass).
//!   For the same reason products with the matrix take differences between nodes first (`product.wgsl`): a pullover of 3 000 loops is 4 µm away
//!   from the CPU's after four steps of up to 1/30 s, and was 26 µm.
//! - **Gather, not scatter.** WGSL has no portable float atomics. Elements leave the factors of their rank-one matrices, and one
//!   invocation a row sums what is around its node. Sums of scalar products go in two stages. So results have the same bits every time.
//! - **Preconditioner.** The complete factorisation of `solver/factor.rs` in smaller groups, level by level (`pattern.rs`), each as workgroups
//!   can do it (`changes.rs`). Where there is no room for that, some 75 000 loops, the incomplete one; what makes it definite where
//!   dropping does not leave it so goes from step to step (`shift.rs`).
//!
//! # Other preconditioners
//! Iterations of conjugate gradients to the tolerance of the CPU, hanging at h = 5 ms / free at h = 10 ms, after 30 steps:
//!
//! | preconditioner, in groups of two courses of a wale | stockinette 20 × 20 | rib | cable | stockinette 40 × 40 |
//! |---|---|---|---|---|
//! | symmetric Gauss–Seidel in 4 colours | > 300 / > 300 | > 300 / > 300 | > 300 / > 300 | > 300 / > 300 |
//! | incomplete, diagonal only, in 4 colours | 135 / 180 | 43 / 83 | 140 / 192 | 159 / 285 |
//! | the same, groups twice as large | 98 / 112 | 32 / 69 | 101 / 114 | 130 / 275 |
//! | overlapping groups with a ring around, additive | 166 / 218 | 54 / 98 | 110 / 157 | 208 / > 300 |
//! | tiles of 144 stitches + 2 rings, IC(1) inside | 61 / 165 | 16 / 30 | 75 / 51 | > 300 / – |
//! | IC(0), row by row | 17 / 43 | 16 / 31 | 94 / 69 | 23 / – |
//! | **IC(1), row by row** | 12 / 23 | 10 / 16 | 52 / 42 | 14 / – |
//!
//! The order decides: only elimination row by row carries along what happens far away. Its price are some w + 1.5 h levels a sweep, each a
//! dispatch. A complete factor has a quarter of these levels or less, and leaves 1 … 3 iterations in ten small
//! fabrics, to a fiftieth of that tolerance (`tests/factor.rs`); its price is memory.
//!
//! # Practice
//! - A step is one submission with one small read-back, as long as conjugate gradients take no more iterations than the step before and
//!   a few. A kernel that finds them done returns at once; if they are not, another submission goes on with them.
//! - The device is asked for no more than the limits that every WebGPU device has, and for the largest bindings it has itself: what grows with
//!   elements or the matrix is kept in chunks of that size, 128 MiB at least. A loop takes 34 KB in all in a small piece and 50 in a sweater of 57 000 (24
//!   with an incomplete factor).
//! - Topology edits and yarn that slips out make a new net, on the CPU, and new tables.
//! - The window simulates on the device that it draws on, where that is a graphics card, and what is simulated is drawn from where it is
//!   (`drawn.rs`). Back to the CPU come 20 bytes for every 32 spans of yarn a step, and every 0.05 s the state.
//! - Run on lavapipe only, where it is slower than the CPU solver; speed on hardware has not been measured. There the sweater of 3 076
//!   loops takes 6 s a step (13 with the incomplete factor and its iterations), that of 57 118 took 280, at 2 Gflop/s.

mod buffers;
mod changes;
mod constants;
mod device;
mod drawn;
mod elements;
mod exchange;
mod kernel;
mod layout;
mod pattern;
mod report;
mod shift;
mod simulator;
mod stages;
mod surroundings;
mod system;
mod tables;
#[cfg(test)]
mod tests;

pub use device::{GpuDevice, GpuError};
pub use drawn::{DeviceYarn, YarnRun};
pub use simulator::GpuSimulator;
