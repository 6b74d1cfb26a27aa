//! What a simulation is, whatever solves it: what one solver hands to another.

use crate::materials::Materials;
use crate::model::Model;
use crate::noise::unit_hash;
use crate::progress::Progress;
use crate::scene::Scene;
use crate::simulator::{SimError, check_state};
use crate::take_in::TakeIn;
use glam::DVec3;
use std::sync::Arc;
use stitch_mesh::yarn_net::{YarnNet, YarnState};

/// Noise on the positions at the start [m]. A flat fabric is an exact saddle: without noise it never curls, and which way
/// it curls would hang on rounding.
const NOISE: f64 = 1e-6;

/// Longest step that a simulation begins with [s]. Yarn that was just laid jumps into its first shape, and edited yarn does where it was
/// edited; longer steps come soon, one [`GROWTH`](crate::simulator::GROWTH) after the other.
const FIRST_STEP: f64 = 5e-3;

/// A simulation without a solver. Where yarns stick on each other is left out: they stick where they are.
#[derive(Clone)]
pub(crate) struct Handover {
    pub model: Model,
    pub take_in: TakeIn,
    pub materials: Materials,
    pub scene: Scene,
    pub state: YarnState,
    pub progress: Progress,
}

impl Handover {
    /// The beginning of a simulation of `net` from `state`, which may be its laid state.
    pub fn new(
        net: &Arc<YarnNet>,
        materials: impl Into<Materials>,
        scene: Scene,
        mut state: YarnState,
    ) -> Result<Self, SimError> {
        let materials = materials.into();
        materials.validate()?;
        scene.validate(net.nodes.len())?;
        let mut model = Model::new(Arc::clone(net))?;
        let take_in = TakeIn::new(net);
        take_in.shorten_turns(&mut model, state.taken_in);
        check_state(&model, &state)?;
        for (i, x) in state.position.iter_mut().enumerate() {
            let noise = |k: usize| NOISE * (unit_hash((3 * i + k) as u64) - 0.5);
            *x += DVec3::new(noise(0), noise(1), noise(2));
        }
        Ok(Self { model, take_in, materials, scene, state, progress: Progress::default() })
    }

    /// The step to begin with [s].
    pub fn first_step(&self) -> f64 {
        self.scene.time_step.min(FIRST_STEP)
    }
}
