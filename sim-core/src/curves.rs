//! From nodes to yarn curves (stage 7 of the flow).
//!
//! # Theory
//! All yarns of a node share its position. To be drawn they are moved apart along the normal of the fabric there, by
//! (n − 1 − 2·rank) R front to back (Cirio et al. §3.2). That is not enough inside of a stitch contact, where the old loop
//! goes from front to back and the new one from back to front along the same straight axis, and so right through it: each
//! gets one more control point in the middle, R to the side on which its handedness lets it pass.
//!
//! The normal of a node is Σ a_ij (eᵢ × eⱼ) over the pairs of its neighbours, eᵢ the vectors to them now and
//! a_ij = n_laid·(Eᵢ × Eⱼ) the area that the same pair spanned in the fabric as laid. Each pair so votes for the front by the
//! side it showed when laid, with the weight of its area then and now.
//!
//! # Differences from the paper
//! The paper fits a plane by SVD, which leaves the sign open, and needs the history of each normal to settle it. The votes
//! have a sign, need no history and stay continuous through curls; where all neighbours stay in a plane both give the same.

use glam::{DVec3, Vec3};
use std::collections::HashMap;
use stitch_mesh::ids::{NodeId, VisitId};
use stitch_mesh::yarn_curves::{YarnCurve, YarnCurves};
use stitch_mesh::yarn_net::{StitchContact, YarnNet, YarnState};

/// The yarns of `net` in `state`, drawn with `radius` [m].
pub fn curves(net: &YarnNet, state: &YarnState, radius: f64) -> YarnCurves {
    let normals = normals(net, state);
    let offsets = offsets(net, &normals, radius);
    let at = |visit: VisitId| state.position[net.visits[visit.index()].node.index()] + offsets[visit.index()];
    let middles: HashMap<(VisitId, VisitId), DVec3> =
        net.contacts.iter().flat_map(|c| middles(net, state, &normals, c, radius)).collect();

    let curve = |yarn: &stitch_mesh::yarn_net::Yarn| {
        let mut points = Vec::with_capacity(2 * yarn.visits.len());
        for visit in yarn.visits.clone().map(VisitId) {
            points.push(at(visit).as_vec3());
            let Some(next) = net.next(visit) else { continue };
            let middle = middles.get(&(visit, next)).or_else(|| middles.get(&(next, visit)));
            points.extend(middle.map(|m| m.as_vec3()));
        }
        YarnCurve { points, closed: yarn.period.is_some(), radius: radius as f32, color: yarn.color }
    };
    YarnCurves { curves: net.yarns.iter().map(curve).collect() }
}

/// Unit normal of the fabric at each node, towards the front.
pub(crate) fn normals(net: &YarnNet, state: &YarnState) -> Vec<DVec3> {
    let mut around: Vec<NodeId> = Vec::new();
    let of = |(i, node): (usize, &stitch_mesh::yarn_net::Node)| {
        around.clear();
        let visits = node.visits.iter().flat_map(|v| [net.prev(*v), net.next(*v)]);
        around.extend(visits.flatten().map(|v| net.visits[v.index()].node));
        around.sort_unstable();
        around.dedup();
        let mut vote = DVec3::ZERO;
        for (k, a) in around.iter().enumerate() {
            for b in &around[k + 1..] {
                let laid = |n: &NodeId| net.nodes[n.index()].position - node.position;
                let now = |n: &NodeId| state.position[n.index()] - state.position[i];
                vote += node.normal.dot(laid(a).cross(laid(b))) * now(a).cross(now(b));
            }
        }
        vote.try_normalize().unwrap_or(node.normal)
    };
    net.nodes.iter().enumerate().map(of).collect()
}

/// Offset of each visit from its node: front to back along the normal, [visit_count] [m].
fn offsets(net: &YarnNet, normals: &[DVec3], radius: f64) -> Vec<DVec3> {
    let mut offsets = vec![DVec3::ZERO; net.visits.len()];
    for (node, normal) in net.nodes.iter().zip(normals) {
        for (rank, visit) in node.visits.iter().enumerate() {
            offsets[visit.index()] = layer(node.visits.len(), rank) * radius * *normal;
        }
    }
    offsets
}

/// Place of a yarn in a stack of `count`, in radii, front to back: 1, −1 for two, 2, 0, −2 for three.
fn layer(count: usize, rank: usize) -> f64 {
    count as f64 - 1.0 - 2.0 * rank as f64
}

/// The control points in the middle of a stitch contact, one a yarn.
fn middles(
    net: &YarnNet,
    state: &YarnState,
    normals: &[DVec3],
    contact: &StitchContact,
    radius: f64,
) -> Vec<((VisitId, VisitId), DVec3)> {
    let [p, q] = contact.new.map(|v| net.visits[v.index()].node.index());
    let (x0, x1) = (state.position[p], state.position[q]);
    let Some(axis) = (x1 - x0).try_normalize() else { return Vec::new() };
    let rank = |visit: VisitId| net.nodes[p].visits.iter().position(|v| *v == visit);
    let old_in_front = contact.old.first().and_then(|o| rank(o[0])) < rank(contact.new[0]);
    let to_old = if old_in_front { normals[p] } else { -normals[p] };
    let side = contact.handedness * radius * to_old.cross(axis).normalize_or_zero();
    let normal = (normals[p] + normals[q]).normalize_or_zero();
    let middle = 0.5 * (x0 + x1);
    let old =
        contact.old.iter().enumerate().map(|(i, ends)| {
            ((ends[0], ends[1]), middle + side + layer(contact.old.len(), i) * radius * normal)
        });
    std::iter::once(((contact.new[0], contact.new[1]), middle - side)).chain(old).collect()
}

/// Samples a span that the least distance of yarns is measured with, and pictures are good with.
pub(crate) const SAMPLES: usize = 4;

/// The curve as points with their arc length [m].
pub(crate) fn with_arc_length(curve: &YarnCurve) -> Vec<(Vec3, f32)> {
    let mut length = 0.0;
    let points = curve.sample(SAMPLES);
    let mut last = points.first().copied().unwrap_or_default();
    let walk = points.into_iter().map(|p| {
        length += p.distance(last);
        last = p;
        (p, length)
    });
    walk.collect()
}
