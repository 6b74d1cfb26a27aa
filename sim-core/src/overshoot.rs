//! What segments gain in length by turning, taken off again.
//!
//! # Theory
//! The system of a step is linear: for a segment r with ends that move by h v₀ and h v₁ it reckons with the length
//! ℓ = |r| + h (v₁ − v₀)·r/|r|, and balances forces for that. But the ends move along straight lines, and where the segment
//! turns by an angle φ its true length |r + h (v₁ − v₀)| is greater by some φ²/2. In a garment that falls on a body segments turn
//! by 0.4 in a sixtieth of a second. They come out 8 % too long, the next step draws them back with all the stiffness that yarn
//! has, and lengths swing from step to step.
//!
//! So both ends are drawn together until the length is ℓ: along the segment, in inverse proportion to their masses. These
//! are impulses between two points in the line through both, which keep momentum and angular momentum. Yarn that is really
//! stretched stays so; at rest, and in a step that turns nothing, nothing happens.
//!
//! # Practice
//! All segments at once, again and again, each by a part of what it has too much (Jacobi): the order of segments does not matter,
//! and the kernels on the GPU do the same. The sweater of 3 000 loops falling on its mannequin, h = 1/60 s: stretch 0.4 … 1.5 % where
//! it was 2 … 11 %, and fewer steps that are taken again. (Letting a segment keep half of its yarn in the same manner, where it would
//! lose more, does not help: the next step finds it overstretched and fails.)

use crate::model::Model;
use glam::DVec3;
use stitch_mesh::yarn_net::YarnState;

/// Excess of length that stays, relative to the length. Down to it the rest is drawn back, so that nothing jumps there.
pub(crate) const LEFT: f64 = 2e-3;

/// Sweeps over all segments at most.
pub(crate) const SWEEPS: usize = 12;

/// Part of the excess that a sweep takes off. Some four segments meet at a node, and together they may not take off more than twice
/// what there is.
pub(crate) const PART: f64 = 0.6;

/// A segment is not drawn back further than to this part of its length before the step.
pub(crate) const LEAST: f64 = 0.5;

/// Draws the ends of segments that have turned from `state` to `next` together, in a step of `h` [s]. `masses` of nodes
/// [node_count] [kg].
pub(crate) fn draw_back(model: &Model, masses: &[f64], state: &YarnState, next: &mut YarnState, h: f64) {
    let reckoned = |nodes: [usize; 2]| {
        let [a, b] = nodes;
        let r = state.position[b] - state.position[a];
        let moved = next.position[b] - next.position[a] - r;
        let length = r.length();
        (1.0 + LEFT) * (length + r.dot(moved) / length).max(LEAST * length)
    };
    let ends = |i: usize| model.segments[i].stencil.nodes.map(|n| n.index());
    let reckoned: Vec<f64> = (0..model.segments.len()).map(|i| reckoned(ends(i))).collect();
    let mut shift = vec![DVec3::ZERO; next.position.len()];
    for _ in 0..SWEEPS {
        let mut add = vec![DVec3::ZERO; shift.len()];
        let mut drawn = false;
        for (i, reckoned) in reckoned.iter().enumerate() {
            let [a, b] = ends(i);
            let r = next.position[b] + shift[b] - next.position[a] - shift[a];
            let length = r.length();
            if length > *reckoned {
                drawn = true;
                let by = PART * (length - reckoned) / length / (masses[a] + masses[b]) * r;
                add[a] += masses[b] * by;
                add[b] -= masses[a] * by;
            }
        }
        if !drawn {
            break;
        }
        shift.iter_mut().zip(&add).for_each(|(shift, add)| *shift += *add);
    }
    for ((x, v), shift) in next.position.iter_mut().zip(&mut next.velocity).zip(&shift) {
        *x += *shift;
        *v += *shift / h;
    }
}
