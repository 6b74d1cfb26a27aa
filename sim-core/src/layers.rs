//! Layers of the fabric that lie on each other: a curled edge, a fold, a sleeve against its body.
//!
//! # Theory
//! Nodes of one stitch are held apart by the yarn itself. Two nodes i, j that meet otherwise keep a distance, being as thick
//! as the yarns stacked at them: d = (nᵢ + nⱼ) R with n visits and the drawn radius R. With r = xᵢ − xⱼ and n̂ = r/|r|:
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
//! Pairs change from step to step, and coupling blocks for them would change the pattern of the matrix (Cirio et al. put such
//! blocks in a tail of it). Here every contact is **one-sided**: each node is braked against the *mean* velocity v̄ of the two at
//! the start of the step, with 2k instead of k. Their relative motion is then that of the implicit step itself, since
//! v₁ − v̄ is half of it; their common motion is not braked, as it would be against the other's old velocity, and momentum is
//! lost only as far as v̄ changes within a step.
//!
//! As with bodies a contact is taken up in the step whose free flight would close the gap.

use crate::near_pairs::near_pairs;
use glam::DVec3;
use stitch_mesh::yarn_net::{YarnNet, YarnState};

/// Share of the distance at which two nodes were laid that they keep at least.
const NEAREST: f64 = 0.5;

/// Yarns that a node counts as at most when pairs are looked for: cast-ons that gather a whole row don't set the reach.
const MOST_YARNS: f64 = 4.0;

/// How far pairs are looked for at most, over the distance of touching: what comes from further away in one step is not seen.
const FARTHEST: f64 = 4.0;

/// A node braked by another one: force and damping on its position.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Brake {
    /// Index of the node.
    pub node: usize,
    /// Force at the start of the step [N].
    pub force: DVec3,
    /// n̂, unit.
    pub normal: DVec3,
    /// 2k, against the velocity below along n̂ [N/m].
    pub stiffness: f64,
    /// 2c, against the velocity below across n̂ [kg/s].
    pub drag: f64,
    /// v̄ [m/s].
    pub velocity: DVec3,
}

/// How contacts are reckoned in a step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LayerContact {
    /// R [m].
    pub radius: f64,
    /// μ.
    pub friction: f64,
    /// k over the mass of the lighter node [1/s²].
    pub stiffness_by_mass: f64,
    /// h [s].
    pub step: f64,
}

/// How thick the nodes of a net are and how near they were laid.
pub(crate) struct Layers {
    /// Yarns at each node, [node_count].
    yarns: Vec<f64>,
    /// Where each node was laid, [node_count] [m].
    laid: Vec<DVec3>,
}

impl Layers {
    pub fn new(net: &YarnNet) -> Self {
        Self {
            yarns: net.nodes.iter().map(|n| n.visits.len() as f64).collect(),
            laid: net.nodes.iter().map(|n| n.position).collect(),
        }
    }

    /// Distance that two nodes keep [m].
    fn distance(&self, a: usize, b: usize, radius: f64) -> f64 {
        let thick = (self.yarns[a] + self.yarns[b]) * radius;
        thick.min(NEAREST * self.laid[a].distance(self.laid[b]))
    }

    /// The contacts of a step from `state`, two brakes each; `masses` are those of the nodes.
    pub fn brakes(&self, state: &YarnState, masses: &[f64], contact: LayerContact) -> Vec<Brake> {
        let LayerContact { radius, friction, stiffness_by_mass, step } = contact;
        let most = self.yarns.iter().copied().fold(0.0, f64::max);
        let touching = 2.0 * most.min(MOST_YARNS) * radius;
        let reach = (touching + step * relative_speed(&state.velocity)).min(FARTHEST * touching);
        let mut brakes = Vec::new();
        near_pairs(&state.position, reach, |a, b| {
            let apart = state.position[a] - state.position[b];
            let (v_a, v_b) = (state.velocity[a], state.velocity[b]);
            let distance = self.distance(a, b, radius);
            if nearest(apart, v_a - v_b, step) >= distance {
                return;
            }
            let Some(normal) = apart.try_normalize() else { return };
            let gap = apart.length() - distance;
            let mass = masses[a].min(masses[b]);
            let stiffness = stiffness_by_mass * mass;
            let press = stiffness * (-gap).max(0.0);
            let slip = (v_a - v_b).reject_from_normalized(normal).length();
            let drag = (friction * press / slip.max(1e-12)).min(mass / step);
            let force = -stiffness * gap * normal;
            let brake = Brake {
                node: a,
                force,
                normal,
                stiffness: 2.0 * stiffness,
                drag: 2.0 * drag,
                velocity: 0.5 * (v_a + v_b),
            };
            brakes.extend([brake, Brake { node: b, force: -force, ..brake }]);
        });
        brakes
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

    const CONTACT: LayerContact =
        LayerContact { radius: 0.4e-3, friction: 0.3, stiffness_by_mass: 1e6, step: 1e-3 };

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

    fn brakes(apart: f64, closing: f64) -> Vec<Brake> {
        let (layers, state, [a, b]) = met(apart, closing);
        let all = layers.brakes(&state, &vec![1e-6; state.position.len()], CONTACT);
        all.into_iter().filter(|k| k.node == a || k.node == b).collect()
    }

    #[test]
    fn nodes_that_overlap_push_each_other_apart() {
        let pair = brakes(1.5e-3, 0.0);
        let expected = 1e6 * 1e-6 * 0.1e-3;
        assert!((pair[0].force - expected * pair[0].normal).length() < 1e-12);
        assert_eq!(pair[0].force, -pair[1].force);
        let held = 2.0 * 0.3 * expected / 0.1;
        assert!((pair[0].drag - held).abs() < 1e-9 * held, "slips at the friction cone");
    }

    #[test]
    fn nodes_that_pass_each_other_or_stay_apart_are_left_alone() {
        assert_eq!(brakes(1.7e-3, 0.0), []);
        assert_eq!(brakes(2.5e-3, 0.5), []);
        assert_eq!(brakes(2.5e-3, -5.0), []);
    }

    #[test]
    fn nodes_that_would_fly_through_each_other_are_stopped_at_touching() {
        let pair = brakes(2.5e-3, 5.0);
        let [a, b] = [&pair[0], &pair[1]];
        // A step of each node alone, as it is put into the system, of mass 1e-6 kg.
        let after = |brake: &Brake, v: DVec3| {
            let h = CONTACT.step;
            let along =
                brake.normal.dot(1e-6 * v + h * brake.force + h * h * brake.stiffness * brake.velocity);
            along / (1e-6 + h * h * brake.stiffness)
        };
        let closing = after(a, DVec3::new(0.1, 0.0, -5.0)) - after(b, DVec3::ZERO);
        let left = 0.9e-3 + CONTACT.step * closing;
        println!("closing {closing}, gap left {left}");
        // Light and soft as they are, two thirds of the way is stopped by 2k h²/m = 2.
        assert!(closing > -3.0 && left > -2.0e-3);
    }

    #[test]
    fn a_fabric_as_laid_does_not_touch_itself() {
        let net = swatch_model(8, 8).net;
        let masses = vec![1e-6; net.nodes.len()];
        assert_eq!(Layers::new(&net).brakes(&net.laid_state(), &masses, CONTACT), []);
    }
}
