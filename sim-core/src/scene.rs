//! What surrounds the fabric: gravity, air, bodies, pins, clamps and the time step. Y is up.

use crate::body::Body;
use crate::mesh_sequence::MeshSequence;
use crate::motion::Motion;
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

/// Nodes held by springs to a frame that may move: a row on a needle, an edge in a jaw.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Clamp {
    /// What it is called.
    #[serde(default)]
    pub name: String,
    /// The nodes, each with where its spring pulls it before the clamp moves [m].
    pub nodes: Vec<(u32, DVec3)>,
    /// Stiffness of each spring [N/m].
    pub stiffness: f64,
    /// How it moves.
    #[serde(default)]
    pub motion: Motion,
}

impl Clamp {
    /// Its springs at a time [s].
    pub fn pins(&self, time_s: f64) -> impl Iterator<Item = Pin> + '_ {
        let pose = self.motion.pose(time_s);
        let stiffness = self.stiffness;
        self.nodes.iter().map(move |(node, target)| Pin {
            node: *node,
            target: pose.apply(*target),
            stiffness,
        })
    }
}

/// Gravity, air, bodies, pins, clamps and the time step.
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
    /// Clamps.
    pub clamps: Vec<Clamp>,
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
            clamps: Vec::new(),
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
    #[error(
        "scene: body {0} has a number that is not finite, a negative one for a size or friction, or keys that are out of order"
    )]
    Body(usize),
    /// A pin with a number that makes no sense.
    #[error("scene: pin {0} has a number that is not finite or a negative stiffness")]
    Pin(usize),
    /// A clamp with a number that makes no sense, or a motion.
    #[error(
        "scene: clamp {0} has a number that is not finite, a negative stiffness, or keys that are out of order"
    )]
    Clamp(String),
    /// A clamp on a node that the net does not have.
    #[error("scene: clamp {clamp} holds node {node} of a net of {nodes} nodes")]
    ClampNode {
        /// The clamp.
        clamp: String,
        /// The node it names.
        node: u32,
        /// How many there are.
        nodes: usize,
    },
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

    /// Follows nodes to what they have become. Nodes that are gone are held no longer.
    pub fn follow(&mut self, nodes: &[Option<NodeId>]) {
        let follow = |node: &mut u32| match nodes.get(*node as usize).copied().flatten() {
            Some(now) => {
                *node = now.0;
                true
            }
            None => false,
        };
        self.pins.retain_mut(|pin| follow(&mut pin.node));
        self.clamps.iter_mut().for_each(|clamp| clamp.nodes.retain_mut(|(node, _)| follow(node)));
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
        for (i, c) in self.clamps.iter().enumerate() {
            let clamp = if c.name.is_empty() { i.to_string() } else { format!("'{}'", c.name) };
            let targets_are_finite = c.nodes.iter().all(|(_, target)| target.is_finite());
            if !(c.stiffness.is_finite() && c.stiffness >= 0.0 && targets_are_finite && c.motion.is_valid()) {
                return Err(SceneError::Clamp(clamp));
            }
            if let Some((node, _)) = c.nodes.iter().find(|(node, _)| *node as usize >= nodes) {
                return Err(SceneError::ClampNode { clamp, node: *node, nodes });
            }
        }
        Ok(())
    }

    /// Lets go of the fabric: no pins, no clamps.
    pub fn let_go(&mut self) {
        self.pins.clear();
        self.clamps.clear();
    }

    /// Whether everything in `other` moves as it does here, so that time may go on from one to the other.
    pub fn moves_like(&self, other: &Self) -> bool {
        fn motions(scene: &Scene) -> impl Iterator<Item = (Option<&Motion>, Option<&MeshSequence>)> {
            let clamps = scene.clamps.iter().map(|c| (Some(&c.motion), None));
            scene.bodies.iter().map(|b| (b.motion(), b.sequence())).chain(clamps)
        }
        motions(self).eq(motions(other))
    }
}
