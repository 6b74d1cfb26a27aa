//! Two halves of a fabric that can be factorised beside each other.
//!
//! # Theory
//! Nested dissection cut off after its first level: groups that separate the halves go into a last part, the joint. No
//! group of one half then touches the other, and elimination never fills between them, whatever its level of fill: all
//! that the halves share is what they add to the joint.
//!
//! An incomplete factorisation is good where elimination moves on like a front, and bad where it starts in the middle. So
//! both halves are eliminated from their far ends towards the joint: 20 iterations at 56 × 56 stitches, against 17 in one
//! piece, 24 to 30 with the second half in the same direction as the first, and 33 in four slices.
//!
//! # Practice
//! There are two halves even for one thread, so that the sums have the same bits on every machine. The cut goes across
//! the axis of the laid fabric that needs the smallest joint.

use crate::model::Model;
use glam::DVec3;
use std::ops::Range;

/// Number of the part that joins the halves 0 and 1.
const JOINT: usize = 2;

/// Puts `groups`, sorted as the fabric was laid, into the order of their elimination. Gives the ranges of both halves and
/// of the joint.
pub(crate) fn sort_into_parts(model: &Model, groups: &mut Vec<Vec<u32>>) -> Vec<Range<usize>> {
    let part_of = (0..3)
        .map(|axis| halves(model, groups, axis))
        .min_by_key(|parts| parts.iter().filter(|p| **p == JOINT).count())
        .unwrap_or_default();
    let mut ranges = Vec::new();
    let mut sorted = Vec::with_capacity(groups.len());
    for part in 0..=JOINT {
        let first = sorted.len();
        let of_part = groups.iter_mut().zip(&part_of).filter(|(_, p)| **p == part);
        sorted.extend(of_part.map(|(group, _)| std::mem::take(group)));
        if part == 1 {
            sorted[first..].reverse();
        }
        ranges.push(first..sorted.len());
    }
    *groups = sorted;
    ranges
}

/// The part of each group when the fabric is cut across `axis`.
fn halves(model: &Model, groups: &[Vec<u32>], axis: usize) -> Vec<usize> {
    let place = |group: &[u32]| {
        let sum: DVec3 = group.iter().map(|n| model.net.nodes[*n as usize].position).sum();
        sum[axis] / group.len() as f64
    };
    let places: Vec<f64> = groups.iter().map(|g| place(g)).collect();
    let mut order: Vec<usize> = (0..groups.len()).collect();
    order.sort_by(|a, b| places[*a].total_cmp(&places[*b]).then(a.cmp(b)));
    let mut part = vec![0; groups.len()];
    for (rank, group) in order.into_iter().enumerate() {
        part[group] = usize::from(2 * rank >= groups.len());
    }
    let mut part_of_node = vec![0; model.net.nodes.len()];
    let mut group_of_node = vec![0; model.net.nodes.len()];
    for (g, group) in groups.iter().enumerate() {
        for n in group {
            part_of_node[*n as usize] = part[g];
            group_of_node[*n as usize] = g;
        }
    }
    for (a, row) in model.neighbours.iter().enumerate() {
        for b in row.iter().map(|b| *b as usize) {
            // Of two groups that touch across a cut, the one in the lower half.
            if part_of_node[a] != part_of_node[b] {
                let lower = if part_of_node[a] < part_of_node[b] { a } else { b };
                part[group_of_node[lower]] = JOINT;
            }
        }
    }
    part
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solver::groups::groups;

    #[test]
    fn parts_touch_the_joint_alone() {
        let model = crate::testing::swatch_model(12, 16);
        let mut groups = groups(&model);
        let before: usize = groups.iter().map(Vec::len).sum();
        let parts = sort_into_parts(&model, &mut groups);
        assert_eq!(groups.iter().map(Vec::len).sum::<usize>(), before);
        assert!(parts.iter().all(|p| p.len() > 3), "{parts:?}");
        let mut part_of = vec![0; model.net.nodes.len()];
        for (p, range) in parts.iter().enumerate() {
            groups[range.clone()].iter().flatten().for_each(|n| part_of[*n as usize] = p);
        }
        for (a, row) in model.neighbours.iter().enumerate() {
            for b in row {
                let (p, q) = (part_of[a], part_of[*b as usize]);
                assert!(p == q || p == JOINT || q == JOINT);
            }
        }
    }
}
