//! Tubes as spirals (Yuksel et al. Fig. 7a): each closed row goes on into the row above it, as a knitter works them.
//!
//! Where a row closes, its end on the right is joined to the beginning of the row above instead of to its own. What is left
//! are one end at the lowest row and one at the highest: [`super::border`] joins them to cast-on and bind-off.

use super::{Draft, Port, wale_port};
use crate::ids::HalfEdgeId;
use crate::label::Row;
use crate::stitch_mesh::StitchMesh;
use std::collections::HashMap;

/// A run of closed rows, one above the other, wound into one.
pub struct Spiral {
    /// The left wale half-edge of the first stitch of the lowest row.
    pub first: HalfEdgeId,
    /// The left wale half-edge of the first stitch of the highest row.
    pub last_row: HalfEdgeId,
    /// Where the yarn comes into the lowest row, and goes out of the highest.
    pub ends: [Port; 2],
}

/// Winds the closed rows of `rows` (as [`StitchMesh::rows`] gives them) into spirals.
pub fn wind(stitches: &StitchMesh, rows: &[Row], draft: &mut Draft<'_>) -> Vec<Spiral> {
    let closed: Vec<&Row> = rows.iter().filter(|r| r.closed).collect();
    let begins: HashMap<_, usize> = closed.iter().enumerate().map(|(i, r)| (r.faces[0], i)).collect();
    let above = |i: usize| {
        let next = stitches.above(closed[i].faces[0]).next()?;
        begins.get(&next).copied().filter(|a| *a != i)
    };
    let mut is_above = vec![false; closed.len()];
    (0..closed.len()).filter_map(above).for_each(|a| is_above[a] = true);
    let left = |i: usize| stitches.left(closed[i].faces[0]);
    let right = |i: usize| stitches.right(closed[i].faces[closed[i].faces.len() - 1]);
    let mut spirals = Vec::new();
    // Rows in a circle up the wale have no lowest one; they stay rings.
    for lowest in (0..closed.len()).filter(|i| !is_above[*i]) {
        let mut at = lowest;
        while let Some(next) = above(at) {
            draft.join(wale_port(right(at)), wale_port(left(next)));
            at = next;
        }
        let ends = [wale_port(left(lowest)), wale_port(right(at))];
        if at == lowest {
            draft.part(ends[0]);
        }
        spirals.push(Spiral { first: left(lowest), last_row: left(at), ends });
    }
    spirals
}
