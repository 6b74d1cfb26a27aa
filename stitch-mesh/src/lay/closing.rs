//! What lies near what once a seam has been pulled.
//!
//! A seam is laid open, and its borders may be laid far apart. Pulled, they lie against each other like courses of one fabric, and
//! must not be taken for layers that have met. Each node that the sewing yarn passes goes half of the way by which the yarn to the
//! other border becomes shorter; the fabric beside it goes with it, as far as [`BESIDE`] visits along its yarns.

use crate::yarn_net::{NodeKind, YarnNet};
use glam::DVec3;

/// How many visits beside the sewing yarn: a stitch or two.
const BESIDE: usize = 5;

/// Sets the closing of all nodes near seams.
pub(super) fn close(net: &mut YarnNet) {
    let node = |v: crate::ids::VisitId| net.visits[v.index()].node.index();
    // The ways that a node of sewing yarn goes, summed, and how many.
    let mut ways: Vec<(DVec3, f64)> = vec![(DVec3::ZERO, 0.0); net.nodes.len()];
    for taken in &net.taken_in {
        let Some(next) = net.next(taken.segment) else { continue };
        let [a, b] = [taken.segment, next].map(node);
        if [a, b].iter().any(|n| net.nodes[*n].kind != NodeKind::Seam) {
            continue;
        }
        let across = (net.nodes[b].position - net.nodes[a].position).normalize_or_zero();
        for (n, sign) in [(a, 0.5), (b, -0.5)] {
            ways[n].0 += sign * taken.length * across;
            ways[n].1 += 1.0;
        }
    }
    let mut closing: Vec<Option<DVec3>> =
        ways.iter().map(|(sum, count)| (*count > 0.0).then(|| *sum / *count)).collect();
    let mut last: Vec<usize> = (0..closing.len()).filter(|n| closing[*n].is_some()).collect();
    for _ in 0..BESIDE {
        let mut next = Vec::new();
        for from in last {
            let visits = net.nodes[from].visits.iter();
            let beside = visits.flat_map(|v| [net.prev(*v), net.next(*v)]).flatten().map(node);
            for to in beside {
                if closing[to].is_none() {
                    closing[to] = closing[from];
                    next.push(to);
                }
            }
        }
        last = next;
    }
    for (node, closing) in net.nodes.iter_mut().zip(closing) {
        node.closing = closing.unwrap_or_default();
    }
}
