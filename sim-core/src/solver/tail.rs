//! The tail of a matrix: blocks between nodes that only happen to meet.
//!
//! Contacts between layers of a fabric come and go from step to step. In the pattern of the matrix they would cost a new symbolic
//! factorisation each time, so they are kept beside it (as Cirio et al. §5 do). A contact B between two nodes adds
//! [[B, −B], [−B, B]]; the diagonal blocks go into the matrix itself and so into its factors, the others are here and only
//! take part in products. What is factorised then exceeds the whole matrix where both nodes move alike, by Σ B, and
//! conjugate gradients take some more iterations.

use glam::{DMat3, DVec3};

/// A block −B between the positions of two nodes and the same below the diagonal.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Link {
    /// First unknown of each node.
    pub start: [u32; 2],
    /// B, symmetric.
    pub block: DMat3,
}

impl Link {
    /// Adds its part of a product with `x` to `y`.
    pub fn add(&self, x: &[f64], y: &mut [f64]) {
        let [a, b] = self.start.map(|s| s as usize);
        for (to, from) in [(a, b), (b, a)] {
            let part = self.block * DVec3::from_slice(&x[from..]);
            (0..3).for_each(|k| y[to + k] -= part[k]);
        }
    }
}
