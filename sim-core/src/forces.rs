//! What holds and touches a fabric, and with what force.
//!
//! The forces are those that acted at the end of the last step, where an implicit step has them: of springs k (target − x) at
//! their places then, of bodies pressure and friction with the velocities that were solved for. A fabric at rest is held by
//! its weight.

use crate::scene::{Clamp, Scene};
use crate::simulator::Simulator;
use glam::DVec3;
use serde::{Deserialize, Serialize};

/// Forces on the fabric [N].
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Forces {
    /// Of each pin.
    pub pins: Vec<DVec3>,
    /// Of each clamp, all its springs together.
    pub clamps: Vec<DVec3>,
    /// Of each body, pressure and friction together.
    pub bodies: Vec<DVec3>,
}

/// The force of one thing in a scene on the fabric.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct HoldFact {
    /// What it is: the name of a clamp, "pins" for all of them, a body by kind and number.
    pub what: String,
    /// The force [N].
    pub force_n: DVec3,
}

impl HoldFact {
    /// Whether it is worth telling: a hundredth of a millinewton is what a millimetre of yarn weighs.
    pub fn is_felt(&self) -> bool {
        self.force_n.length() >= 5e-6
    }
}

impl Forces {
    /// Those of pins and clamps, `time_s` after the scene began [s], on nodes at `position` [node_count] [m].
    pub(crate) fn of_springs(scene: &Scene, position: &[DVec3], time_s: f64) -> Self {
        let of_clamp =
            |clamp: &Clamp| clamp.pins(time_s).map(|pin| pin.force(position[pin.node as usize])).sum();
        Self {
            pins: scene.pins.iter().map(|pin| pin.force(position[pin.node as usize])).collect(),
            clamps: scene.clamps.iter().map(of_clamp).collect(),
            bodies: Vec::new(),
        }
    }

    /// The same in words; all pins as one.
    pub(crate) fn in_words(self, scene: &Scene) -> Vec<HoldFact> {
        let pins = (!scene.pins.is_empty()).then(|| ("pins".to_owned(), self.pins.iter().sum::<DVec3>()));
        let clamps = scene.clamps.iter().zip(self.clamps).map(|(c, f)| (c.name.clone(), f));
        let bodies = scene.bodies.iter().zip(self.bodies).enumerate();
        let bodies = bodies.map(|(i, (b, f))| (format!("{} {i}", b.kind()), f));
        let all = pins.into_iter().chain(clamps).chain(bodies);
        all.map(|(what, force_n)| HoldFact { what, force_n }).collect()
    }
}

impl Simulator {
    /// The forces of pins, clamps and bodies on the fabric.
    pub fn forces(&self) -> Forces {
        let mut bodies = self.body_forces().to_vec();
        bodies.resize(self.scene().bodies.len(), DVec3::ZERO); // before the first step, and where bodies came since
        let springs = Forces::of_springs(self.scene(), &self.state().position, self.scene_time_s());
        Forces { bodies, ..springs }
    }

    /// The same in words; all pins as one.
    pub fn holds(&self) -> Vec<HoldFact> {
        self.forces().in_words(self.scene())
    }
}
