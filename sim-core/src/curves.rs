//! From nodes to yarn curves (stage 7 of the flow).
//!
//! # Theory
//! All yarns of a node share its position. To be drawn they are moved apart along the normal of the fabric there until they
//! lie on each other, the middle of the stack at the node: by (n − 1 − 2·rank) R front to back where all have the radius R
//! (Cirio et al. §3.2). That is not enough inside of a stitch contact, where the old loop goes from front to back and the new
//! one from back to front along the same straight axis, and so right through it: each gets one more control point in the
//! middle, to the side on which its handedness lets it pass by the radius of the other.
//!
//! The normal of a node is Σ a_ij (eᵢ × eⱼ) over the pairs of its neighbours, eᵢ the vectors to them now and
//! a_ij = n_laid·(Eᵢ × Eⱼ) the area that the same pair spanned in the fabric as laid. Each pair so votes for the front by the
//! side it showed when laid, with the weight of its area then and now.
//!
//! # Differences from the paper
//! The paper fits a plane by SVD, which leaves the sign open, and needs the history of each normal to settle it. The votes
//! have a sign, need no history and stay continuous through curls; where all neighbours stay in a plane both give the same.

use crate::materials::Materials;
use glam::{DVec3, Vec3};
use smallvec::SmallVec;
use std::collections::HashMap;
use stitch_mesh::ids::{NodeId, VisitId};
use stitch_mesh::yarn_curves::{YarnCurve, YarnCurves};
use stitch_mesh::yarn_net::{StitchContact, YarnNet, YarnState};

/// The yarns of `net` in `state`, drawn with the radii of their materials.
pub fn curves(net: &YarnNet, state: &YarnState, materials: &Materials) -> YarnCurves {
    let normals = normals(net, state);
    let radii = radii(net, materials);
    let offsets = offsets(net, &normals, &radii);
    let at = |visit: VisitId| state.position[net.visits[visit.index()].node.index()] + offsets[visit.index()];
    let middles: HashMap<(VisitId, VisitId), DVec3> =
        net.contacts.iter().flat_map(|c| middles(net, state, &normals, c, &radii)).collect();

    let middle = |a, b| middles.get(&(a, b)).or_else(|| middles.get(&(b, a))).map(|m| m.as_vec3());
    string_together(net, materials, &|visit| Some(at(visit).as_vec3()), &middle)
}

/// The curves through the points of visits and those in the middle of stitch contacts.
pub(crate) fn string_together(
    net: &YarnNet,
    materials: &Materials,
    at: &dyn Fn(VisitId) -> Option<Vec3>,
    middle: &dyn Fn(VisitId, VisitId) -> Option<Vec3>,
) -> YarnCurves {
    let radii = radii(net, materials);
    let curve = |yarn: &stitch_mesh::yarn_net::Yarn| {
        let mut points = Vec::with_capacity(2 * yarn.visits.len());
        let mut dyes = Vec::with_capacity(2 * yarn.visits.len());
        let mut drawn = Vec::with_capacity(2 * yarn.visits.len());
        let mut visits = Vec::with_capacity(2 * yarn.visits.len());
        for visit in yarn.visits.clone().map(VisitId) {
            points.extend(at(visit));
            let next = net.next(visit);
            points.extend(next.and_then(|next| middle(visit, next)));
            visits.resize(points.len(), visit);
            if next.is_none() {
                continue;
            }
            dyes.resize(points.len(), net.visits[visit.index()].dye);
            drawn.resize(points.len(), radii[visit.index()] as f32);
        }
        dyes.resize(points.len(), dyes.last().copied().unwrap_or_default());
        drawn.resize(points.len(), drawn.last().copied().unwrap_or(materials.base.drawn_radius as f32));
        YarnCurve { points, closed: yarn.period.is_some(), radii: drawn, dyes, visits }
    };
    YarnCurves { curves: net.yarns.iter().map(curve).collect() }
}

/// Unit normal of the fabric at each node, towards the front.
pub(crate) fn normals(net: &YarnNet, state: &YarnState) -> Vec<DVec3> {
    (0..net.nodes.len()).map(|node| normal(net, state, node)).collect()
}

/// Unit normal of the fabric at one node, towards the front.
pub(crate) fn normal(net: &YarnNet, state: &YarnState, index: usize) -> DVec3 {
    let node = &net.nodes[index];
    let visits = node.visits.iter().flat_map(|v| [net.prev(*v), net.next(*v)]);
    let mut around: SmallVec<[NodeId; 8]> = visits.flatten().map(|v| net.visits[v.index()].node).collect();
    around.sort_unstable();
    around.dedup();
    let mut vote = DVec3::ZERO;
    for (k, a) in around.iter().enumerate() {
        for b in &around[k + 1..] {
            let laid = |n: &NodeId| net.nodes[n.index()].position - node.position;
            let now = |n: &NodeId| state.position[n.index()] - state.position[index];
            vote += node.normal.dot(laid(a).cross(laid(b))) * now(a).cross(now(b));
        }
    }
    vote.try_normalize().unwrap_or(node.normal)
}

/// Radius of the yarn at each visit, [visit_count] [m].
fn radii(net: &YarnNet, materials: &Materials) -> Vec<f64> {
    if materials.by_dye.is_empty() {
        return vec![materials.base.drawn_radius; net.visits.len()];
    }
    net.visits.iter().map(|v| materials.of(v.dye).drawn_radius).collect()
}

/// Offset of each visit from its node: front to back along the normal, [visit_count] [m].
fn offsets(net: &YarnNet, normals: &[DVec3], radii: &[f64]) -> Vec<DVec3> {
    let mut offsets = vec![DVec3::ZERO; net.visits.len()];
    for (node, normal) in net.nodes.iter().zip(normals) {
        for (visit, height) in stack(node.visits.iter().copied(), radii) {
            offsets[visit.index()] = height * *normal;
        }
    }
    offsets
}

/// Yarns that lie on each other, front to back, each with the height of its axis above the middle of the stack [m].
fn stack<'a>(
    visits: impl Iterator<Item = VisitId> + Clone + 'a,
    radii: &'a [f64],
) -> impl Iterator<Item = (VisitId, f64)> + 'a {
    let radius = |v: VisitId| radii[v.index()];
    let mut top: f64 = visits.clone().map(radius).sum();
    visits.map(move |visit| {
        let height = top - radius(visit);
        top -= 2.0 * radius(visit);
        (visit, height)
    })
}

/// The control points in the middle of a stitch contact, one a yarn.
fn middles(
    net: &YarnNet,
    state: &YarnState,
    normals: &[DVec3],
    contact: &StitchContact,
    radii: &[f64],
) -> Vec<((VisitId, VisitId), DVec3)> {
    let [p, q] = contact.new.map(|v| net.visits[v.index()].node.index());
    let (x0, x1) = (state.position[p], state.position[q]);
    let Some(axis) = (x1 - x0).try_normalize() else { return Vec::new() };
    let rank = |visit: VisitId| net.nodes[p].visits.iter().position(|v| *v == visit);
    let old_in_front = contact.old.first().and_then(|o| rank(o[0])) < rank(contact.new[0]);
    let to_old = if old_in_front { normals[p] } else { -normals[p] };
    let side = contact.handedness * to_old.cross(axis).normalize_or_zero();
    let normal = (normals[p] + normals[q]).normalize_or_zero();
    let middle = 0.5 * (x0 + x1);
    let by_new = radii[contact.new[0].index()];
    let firsts = contact.old.iter().map(|ends| ends[0]);
    let thickest = firsts.clone().map(|v| radii[v.index()]).fold(0.0, f64::max);
    let heights = stack(firsts, radii).map(|(_, height)| height);
    let old = contact.old.iter().zip(heights);
    let old = old.map(|(ends, height)| ((ends[0], ends[1]), middle + by_new * side + height * normal));
    std::iter::once(((contact.new[0], contact.new[1]), middle - thickest * side)).chain(old).collect()
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::clearance::least_distance;
    use crate::material::Material;
    use crate::testing::swatch_model;

    fn drawn_at(drawn_radius: f64) -> Materials {
        Material { drawn_radius, ..Material::for_loop_width(3e-3) }.into()
    }

    #[test]
    fn yarns_of_unlike_thickness_lie_on_each_other() {
        let heights: Vec<f64> = stack((0..3).map(VisitId), &[1.0, 3.0, 2.0]).map(|(_, h)| h).collect();
        assert_eq!(heights, [5.0, 1.0, -4.0]);
        let net = swatch_model(6, 6).net;
        let mut visits = (*net.visits).clone();
        let thick: stitch_mesh::dye::Dye = "#c04030".parse().unwrap();
        let half = visits.len() / 2;
        visits[half..].iter_mut().for_each(|v| v.dye = thick);
        let net = YarnNet { visits: std::sync::Arc::new(visits), ..(*net).clone() };
        let mut materials = drawn_at(0.2e-3);
        materials.by_dye.insert(thick, drawn_at(0.4e-3).base);
        let drawn = curves(&net, &net.laid_state(), &materials);
        let [curve] = &drawn.curves[..] else { panic!("one yarn") };
        let change = curve.dyes.iter().position(|d| *d == thick).unwrap();
        assert!(curve.radii[..change].iter().all(|r| *r == 0.2e-3));
        assert!(curve.radii[change..].iter().all(|r| *r == 0.4e-3));
    }

    #[test]
    fn normals_turn_with_the_fabric_and_keep_their_side() {
        let net = swatch_model(5, 5).net;
        let mut state = net.laid_state();
        for half_turns in [0.0, 0.5, 1.0, 1.7] {
            let turn =
                glam::DQuat::from_axis_angle(DVec3::new(0.6, 0.8, 0.0), half_turns * std::f64::consts::PI);
            for (x, node) in state.position.iter_mut().zip(&net.nodes) {
                *x = turn * node.position;
            }
            for (normal, node) in
                normals(&net, &state).iter().zip(&net.nodes).filter(|(_, n)| n.face.is_some())
            {
                assert!(normal.dot(turn * node.normal) > 0.99, "{normal} for {}", turn * node.normal);
            }
        }
    }

    #[test]
    fn normals_keep_their_side_when_rolled_up() {
        let net = swatch_model(12, 5).net;
        let mut state = net.laid_state();
        let radius = 6e-3;
        let mut expected = Vec::new();
        for (x, node) in state.position.iter_mut().zip(&net.nodes) {
            let (sin, cos) = (node.position.x / radius).sin_cos();
            *x = DVec3::new(radius * sin, node.position.y, radius * cos);
            expected.push(DVec3::new(sin, 0.0, cos));
        }
        let inside = |(_, n): &(_, &stitch_mesh::yarn_net::Node)| n.face.is_some();
        for ((normal, expected), _) in
            normals(&net, &state).iter().zip(&expected).zip(&net.nodes).filter(inside)
        {
            assert!(normal.dot(*expected) > 0.8, "{normal} for {expected}");
        }
    }

    #[test]
    fn middles_keep_yarns_from_passing_through_each_other() {
        let net = swatch_model(6, 6).net;
        let drawn = curves(&net, &net.laid_state(), &drawn_at(0.3e-3));
        let bare = YarnNet { contacts: Vec::new(), ..(*net).clone() };
        let through = curves(&bare, &bare.laid_state(), &drawn_at(0.3e-3));
        assert!(least_distance(&drawn) > 2.0 * least_distance(&through));
        assert!(least_distance(&through) < 0.1 * 0.6e-3);
    }

    #[test]
    fn collapsed_fabric_has_finite_curves() {
        let net = swatch_model(3, 3).net;
        let mut state = net.laid_state();
        state.position.fill(DVec3::ZERO);
        let drawn = curves(&net, &state, &drawn_at(0.3e-3));
        assert!(drawn.curves.iter().flat_map(|c| &c.points).all(|p| p.is_finite()));
    }
}
