//! What surrounds the fabric: gravity, air, bodies, pins and the time step. Y is up.

use crate::body::Body;
use glam::DVec3;
use serde::{Deserialize, Serialize};
use stitch_mesh::ids::NodeId;

/// A node held by a spring; dragging the fabric moves the target.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Pin {
    /// Index of the node in the net.
    pub node: u32,
    /// Where the spring pulls it [m].
    pub target: DVec3,
    /// Stiffness of the spring [N/m]. A loop weighs some 1e-5 kg: 10 N/m holds a node firmly, 0.1 N/m gently.
    pub stiffness: f64,
}

/// Gravity, air, bodies, pins and the time step.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Scene {
    /// Acceleration of gravity [m/s²].
    pub gravity: DVec3,
    /// Density of the air around, 1.2 in a room and 0 for none [kg/m³].
    pub air: f64,
    /// Bodies that the fabric lies on.
    pub bodies: Vec<Body>,
    /// Pinned nodes.
    pub pins: Vec<Pin>,
    /// h, the time step aimed at [s]; steps that go wrong are taken in smaller ones.
    pub time_step: f64,
}

impl Default for Scene {
    fn default() -> Self {
        Self {
            gravity: DVec3::new(0.0, -9.81, 0.0),
            air: 0.0,
            bodies: Vec::new(),
            pins: Vec::new(),
            time_step: 5e-3,
        }
    }
}

/// Something in a scene that can't be simulated.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SceneError {
    /// The time step is zero, negative, infinite or NaN.
    #[error("scene: time step is {0} s, and must be positive")]
    TimeStep(f64),
    /// Gravity is infinite or NaN.
    #[error("scene: gravity is {0}")]
    Gravity(DVec3),
    /// The density of the air is negative, infinite or NaN.
    #[error("scene: the density of the air is {0} kg/m³, and must be at least 0")]
    Air(f64),
    /// A body with a number that makes no sense.
    #[error("scene: body {0} has a number that is not finite or a negative one for a size or friction")]
    Body(usize),
    /// A pin with a number that makes no sense.
    #[error("scene: pin {0} has a number that is not finite or a negative stiffness")]
    Pin(usize),
    /// A pin on a node that the net does not have.
    #[error("scene: pin {pin} holds node {node} of a net of {nodes} nodes")]
    PinNode {
        /// The pin.
        pin: usize,
        /// The node it names.
        node: u32,
        /// How many there are.
        nodes: usize,
    },
}

impl Scene {
    /// No gravity, nothing around.
    pub fn empty() -> Self {
        Self { gravity: DVec3::ZERO, ..Self::default() }
    }

    /// Follows nodes to what they have become. Pins on nodes that are gone go too.
    pub fn follow(&mut self, nodes: &[Option<NodeId>]) {
        self.pins.retain_mut(|pin| {
            let now = nodes.get(pin.node as usize).copied().flatten();
            pin.node = now.map_or(pin.node, |n| n.0);
            now.is_some()
        });
    }

    /// Whether this scene can be simulated with a net of `nodes` nodes.
    pub fn validate(&self, nodes: usize) -> Result<(), SceneError> {
        if !(self.time_step > 0.0 && self.time_step.is_finite()) {
            return Err(SceneError::TimeStep(self.time_step));
        }
        if !self.gravity.is_finite() {
            return Err(SceneError::Gravity(self.gravity));
        }
        if !(self.air >= 0.0 && self.air.is_finite()) {
            return Err(SceneError::Air(self.air));
        }
        if let Some(i) = self.bodies.iter().position(|b| !b.is_valid()) {
            return Err(SceneError::Body(i));
        }
        for (pin, p) in self.pins.iter().enumerate() {
            if !(p.target.is_finite() && p.stiffness.is_finite() && p.stiffness >= 0.0) {
                return Err(SceneError::Pin(pin));
            }
            if p.node as usize >= nodes {
                return Err(SceneError::PinNode { pin, node: p.node, nodes });
            }
        }
        Ok(())
    }
}
