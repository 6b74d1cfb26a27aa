//! Layers of the fabric that lie on each other: a curled edge, a fold, a sleeve against its body.
//!
//! # Theory
//! Nodes of one stitch are held apart by the yarn itself. Two nodes i, j that meet otherwise keep a distance, being as thick
//! as the two yarns that lie on each other at each: d = 4R with the drawn radius R. With r = xᵢ − xⱼ and n̂ = r/|r|:
//! - energy V = k/2 (d − |r|)₊² [J];
//! - gradient −k (d − |r|)₊ n̂ on xᵢ, the opposite on xⱼ; stiffness k n̂ n̂ᵀ (that across n̂, which is negative, is left out);
//! - Coulomb friction as a drag on the slip across n̂, c = min(m/h, μ N/|slip|), N the force above.
//!
//! Balls of this size around all nodes leave no hole that another layer fits through: a loop has four in W × H = 3 mm ×
//! 2.25 mm, and d is 1.7 mm.
//!
//! **Near in the fabric.** Neighbours in the fabric come closer than d in any knit; what they may not do is pass through each
//! other either. So d is at most half of the distance at which two nodes were laid, and no pair needs to be left out.
//!
//! # Practice
//! Pairs change from step to step; the blocks between the two nodes of a contact go into the tail of the matrix
//! (`solver/tail.rs`). Left out, so that each node is braked against the other's *old* velocity, they turn every contact into an
//! anchor that falling fabric hangs on.
//!
//! As with bodies a contact is taken up in the step whose free flight would close the gap.

use crate::near_pairs::near_pairs;
use glam::DVec3;
use stitch_mesh::yarn_net::{YarnNet, YarnState};

/// Share of the distance at which two nodes were laid that they keep at least.
pub(crate) const NEAREST: f64 = 0.5;

/// How far pairs are looked for at most, over the distance of touching: what comes from further away in one step is not seen.
pub(crate) const FARTHEST: f64 = 4.0;

/// Two nodes that press each other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Press {
    /// Indices of the nodes i and j.
    pub nodes: [usize; 2],
    /// Force on i, the opposite of that on j [N].
    pub force: DVec3,
    /// n̂, unit.
    pub normal: DVec3,
    /// k [N/m].
    pub stiffness: f64,
    /// c [kg/s].
    pub drag: f64,
}

/// How contacts are reckoned in a step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LayerContact<'a> {
    /// Half thickness of the fabric at each node, [node_count] [m].
    pub clearances: &'a [f64],
    /// Mass of the yarn around each node, [node_count] [kg].
    pub masses: &'a [f64],
    /// √μ of the yarn at each node, so that the product of two is the geometric mean of theirs, [node_count].
    pub grips: &'a [f64],
    /// k over the mass of the lighter node [1/s²].
    pub stiffness_by_mass: f64,
    /// h [s].
    pub step: f64,
}

/// How near the nodes of a net were laid.
pub(crate) struct Layers {
    /// Where each node was laid, [node_count] [m].
    laid: Vec<DVec3>,
}

impl Layers {
    pub fn new(net: &YarnNet) -> Self {
        Self { laid: net.nodes.iter().map(|n| n.position).collect() }
    }

    /// The contacts of a step from `state`.
    pub fn contacts(&self, state: &YarnState, contact: LayerContact) -> Vec<Press> {
        let LayerContact { clearances, masses, grips, stiffness_by_mass, step } = contact;
        let touching = 2.0 * clearances.iter().copied().fold(0.0, f64::max);
        let reach = (touching + step * relative_speed(&state.velocity)).min(FARTHEST * touching);
        let mut found = Vec::new();
        near_pairs(&state.position, reach, |a, b| {
            let apart = state.position[a] - state.position[b];
            let (v_a, v_b) = (state.velocity[a], state.velocity[b]);
            let laid = self.laid[a].distance(self.laid[b]);
            let distance = (clearances[a] + clearances[b]).min(NEAREST * laid);
            if nearest(apart, v_a - v_b, step) >= distance {
                return;
            }
            let Some(normal) = apart.try_normalize() else { return };
            let gap = apart.length() - distance;
            let mass = masses[a].min(masses[b]);
            let stiffness = stiffness_by_mass * mass;
            let press = stiffness * (-gap).max(0.0);
            let slip = (v_a - v_b).reject_from_normalized(normal).length();
            let drag = (grips[a] * grips[b] * press / slip.max(1e-12)).min(mass / step);
            let force = -stiffness * gap * normal;
            found.push(Press { nodes: [a, b], force, normal, stiffness, drag });
        });
        found
    }
}

/// Bound on the speed at which two nodes approach each other [m/s].
fn relative_speed(velocity: &[DVec3]) -> f64 {
    let mean = velocity.iter().sum::<DVec3>() / velocity.len().max(1) as f64;
    2.0 * velocity.iter().map(|v| v.distance(mean)).fold(0.0, f64::max)
}

/// How near a point at `apart` that flies with `velocity` for `time` comes to the origin.
fn nearest(apart: DVec3, velocity: DVec3, time: f64) -> f64 {
    let when = (-apart.dot(velocity) / velocity.length_squared().max(1e-30)).clamp(0.0, time);
    (apart + when * velocity).length()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::swatch_model;
    use stitch_mesh::ids::FaceId;

    const STEP: f64 = 1e-3;

    fn contacts(layers: &Layers, state: &YarnState) -> Vec<Press> {
        let count = state.position.len();
        let (clearances, masses) = (vec![0.8e-3; count], vec![1e-6; count]);
        let grips = vec![0.3_f64.sqrt(); count];
        let (clearances, masses, grips) = (&clearances[..], &masses[..], &grips[..]);
        let contact = LayerContact { clearances, masses, grips, stiffness_by_mass: 1e6, step: STEP };
        layers.contacts(state, contact)
    }

    /// Two nodes of a swatch that lie far from each other as laid, brought to a distance of `apart`.
    fn met(apart: f64, closing: f64) -> (Layers, YarnState, [usize; 2]) {
        let net = swatch_model(4, 4).net;
        let mut state = net.laid_state();
        let of = |face| net.nodes.iter().position(|n| n.face == Some(FaceId(face))).unwrap();
        let (a, b) = (of(5), of(15));
        assert!(net.nodes[a].position.distance(net.nodes[b].position) > 5e-3);
        assert!(net.nodes[a].visits.len() == 2 && net.nodes[b].visits.len() == 2);
        // Far from all others, so that only these two meet.
        state.position[a] = DVec3::splat(1.0);
        state.position[b] = DVec3::splat(1.0) - apart * DVec3::Z;
        state.velocity[a] = DVec3::new(0.1, 0.0, -closing);
        (Layers::new(&net), state, [a, b])
    }

    /// The contact of the two, if they have one; the first is the node that was set moving.
    fn contact(apart: f64, closing: f64) -> Option<Press> {
        let (layers, state, nodes) = met(apart, closing);
        contacts(&layers, &state).into_iter().find(|c| c.nodes == nodes)
    }

    #[test]
    fn nodes_that_overlap_push_each_other_apart() {
        let found = contact(1.5e-3, 0.0).unwrap();
        let expected = 1e6 * 1e-6 * 0.1e-3;
        assert!((found.force - DVec3::new(0.0, 0.0, expected)).length() < 1e-12);
        let held = 0.3 * expected / 0.1;
        assert!((found.drag - held).abs() < 1e-9 * held, "slips at the friction cone");
    }

    #[test]
    fn nodes_that_pass_each_other_or_stay_apart_are_left_alone() {
        assert_eq!(contact(1.7e-3, 0.0), None);
        assert_eq!(contact(2.5e-3, 0.5), None);
        assert_eq!(contact(2.5e-3, -5.0), None);
    }

    #[test]
    fn nodes_that_would_fly_through_each_other_are_drawn_to_touching() {
        let found = contact(2.5e-3, 5.0).unwrap();
        // An implicit step of the pair alone is (m + 2kh²) w = m w₀ + 2hF for the velocity w at which the gap grows.
        let (m, w) = (1e-6, -5.0);
        let grows = m * w + 2.0 * STEP * found.force.dot(found.normal);
        let after = grows / (m + 2.0 * STEP * STEP * found.stiffness);
        let gap = 0.9e-3 + STEP * after;
        assert!(gap > -1.5e-3 && after > -2.5, "{gap} {after}");
        assert!(0.9e-3 + STEP * w < -4e-3, "on its own it would be through");
    }

    #[test]
    fn a_fabric_as_laid_does_not_touch_itself() {
        let net = swatch_model(8, 8).net;
        assert_eq!(contacts(&Layers::new(&net), &net.laid_state()), []);
    }
}
