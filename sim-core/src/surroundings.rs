//! What a scene does to the nodes of a fabric in one step: bodies, pins and clamps.
//!
//! Everything is taken where it is at the end of the step. Nodes that were laid one after another lie near each other, so the boxes
//! around runs of them tell which may touch a body at all.

use crate::body::Placed;
use crate::body_contact::{BodyContact, Touching};
use crate::scene::Scene;
use crate::step::Stepper;
use glam::DVec3;
use stitch_mesh::yarn_net::YarnState;

/// Stiffness of a body against a node, in masses of the node per squared time step. At 1 fabric sinks in under its own
/// weight, at 1e4 a corner that touches down alone upsets the conditioning.
const BODY_STIFFNESS: f64 = 100.0;

/// Longest time step that makes bodies softer [s]. In steps of 1/30 s the shoulders of a mannequin would come through the sweater that
/// hangs from them, 5 mm.
const SOFTEST: f64 = 0.01;

/// Stiffness of bodies, and of layers of the fabric, against a node, over its mass [1/s²].
pub(crate) fn stiffness_by_mass(scene: &Scene) -> f64 {
    BODY_STIFFNESS / scene.time_step.min(SOFTEST).powi(2)
}

/// Acceleration that presses a node into a body by all of its clearance, at most [m/s²]: as if 200 of its like hung on it. Cloth that hangs
/// from a bar sinks in by 0.17 … 0.25 mm without, whatever its yarn, which fine yarn does not have.
pub(crate) const FIRM: f64 = 2_000.0;

/// Nodes in a run that is told from a body by the box around it.
const RUN: usize = 64;

/// Nodes of a run, the box around them, and how far from it they may reach in a step.
struct Run {
    nodes: std::ops::Range<usize>,
    bounds: [DVec3; 2],
    /// [m]
    reach: f64,
}

/// What bodies have to do with of each node.
#[derive(Clone, Copy)]
pub(crate) struct Bulk<'a> {
    /// [node_count] [kg]
    pub masses: &'a [f64],
    /// Distance that each keeps, [node_count] [m].
    pub clearances: &'a [f64],
}

impl Bulk<'_> {
    /// The nodes in runs, with what each keeps off and how far it flies in a step of `h` [s].
    fn runs(self, state: &YarnState, h: f64) -> Vec<Run> {
        let count = state.position.len();
        let run = |first: usize| {
            let nodes = first..(first + RUN).min(count);
            let mut bounds = [DVec3::INFINITY, DVec3::NEG_INFINITY];
            let mut reach: f64 = 0.0;
            for node in nodes.clone() {
                let x = state.position[node];
                bounds = [bounds[0].min(x), bounds[1].max(x)];
                reach = reach.max(self.clearances[node] + h * state.velocity[node].length());
            }
            Run { nodes, bounds, reach }
        };
        (0..count).step_by(RUN).map(run).collect()
    }

    /// Contacts in `state` with the bodies as they are at the end of the step of `h` from `time_s` on [s].
    pub fn touching(self, state: &YarnState, scene: &Scene, time_s: f64, h: f64) -> Vec<Touching> {
        let mut touching = Vec::new();
        let runs = if scene.bodies.is_empty() { Vec::new() } else { self.runs(state, h) };
        for (index, body) in scene.bodies.iter().enumerate() {
            let body = &Placed::new(body, time_s, h);
            let near = runs.iter().filter(|run| body.is_near(run.bounds, run.reach));
            for node in near.flat_map(|run| run.nodes.clone()) {
                let (x, v, mass) = (state.position[node], state.velocity[node], self.masses[node]);
                let clearance = self.clearances[node];
                let stiffness = stiffness_by_mass(scene).max(FIRM / clearance) * mass;
                let contact = BodyContact { body, clearance, stiffness };
                let (gap, normal) = contact.gap(x);
                let surface = body.velocity(x);
                if gap + h * v.dot(normal).min(surface.dot(normal)) >= 0.0 {
                    continue;
                }
                // It is pressed as deep as it is in the surface now, not as this leaves it or comes upon it in the step.
                let pressed = gap + h * surface.dot(normal);
                let drag = contact.drag((pressed, normal), v - surface, mass, h);
                touching.push(Touching { body: index, node, gap, normal, stiffness, drag, surface });
            }
        }
        touching
    }
}

impl Stepper {
    /// Adds the bodies as they are at the end of the step of `h` from `time_s` on [s].
    pub fn add_bodies(&mut self, state: &YarnState, scene: &Scene, time_s: f64, h: f64) -> Vec<Touching> {
        let bulk = Bulk { masses: &self.masses, clearances: &self.clearances };
        let touching = bulk.touching(state, scene, time_s, h);
        for of_body in touching.chunk_by(|a, b| a.body == b.body) {
            let body = &Placed::new(&scene.bodies[of_body[0].body], time_s, h);
            for &Touching { node, normal, stiffness, drag, surface, .. } in of_body {
                let contact = BodyContact { body, clearance: self.clearances[node], stiffness };
                self.add_point(node, &contact, state.position[node], h);
                let n = normal.to_array();
                self.add_block(node, |i, j| h * drag * (f64::from(u8::from(i == j)) - n[i] * n[j]));
                self.push(node, h * drag * (surface - surface.dot(normal) * normal));
            }
        }
        touching
    }

    /// Adds pins and clamps as they are at `time_s`, the end of the step of `h` [s]. Gives the number of springs.
    pub fn add_pins(&mut self, state: &YarnState, scene: &Scene, time_s: f64, h: f64) -> usize {
        let mut count = 0;
        for pin in scene.pins.iter().copied().chain(scene.clamps.iter().flat_map(|c| c.pins(time_s))) {
            self.add_point(pin.node as usize, &pin, state.position[pin.node as usize], h);
            count += 1;
        }
        count
    }
}

/// The force of each body on a fabric that ended the step of `h` [s] with `velocity` [N].
pub(crate) fn body_forces(scene: &Scene, touching: &[Touching], velocity: &[DVec3], h: f64) -> Vec<DVec3> {
    let mut forces = vec![DVec3::ZERO; scene.bodies.len()];
    for contact in touching {
        forces[contact.body] += contact.force(velocity[contact.node], h);
    }
    forces
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::Body;
    use crate::material::Material;
    use crate::simulator::Simulator;
    use std::sync::Arc;
    use stitch_mesh::edge_counts::StitchSize;
    use stitch_mesh::lay::lay;
    use stitch_mesh::pieces::rectangle;

    #[test]
    fn cloth_that_carries_fifty_of_its_like_stays_outside_however_fine() {
        for width in [4e-3, 2e-3, 1e-3] {
            let net = Arc::new(lay(&rectangle(4, 4, StitchSize::of_width(width)).unwrap()));
            let material = Material::for_loop_width(width);
            let mut state = net.laid_state();
            // Flat on the ground.
            for x in &mut state.position {
                *x = DVec3::new(x.x, 2.0 * material.drawn_radius + x.z, -x.y);
            }
            let bodies = vec![Body::Ground { height: 0.0, friction: 0.5 }];
            let gravity = DVec3::new(0.0, -490.0, 0.0);
            let scene = Scene { gravity, bodies, time_step: 1e-2, ..Scene::default() };
            let mut simulator = Simulator::new(&net, material.clone(), scene, state).unwrap();
            while simulator.time_s() < 0.1 {
                simulator.step().unwrap();
            }
            let lowest = simulator.state().position.iter().map(|x| x.y).fold(f64::INFINITY, f64::min);
            assert!(
                lowest > 0.25 * material.drawn_radius,
                "{lowest} m above the ground in loops of {width} m"
            );
        }
    }
}
