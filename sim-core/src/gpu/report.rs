//! What a simulation on the GPU tells of itself.

use super::GpuError;
use super::simulator::GpuSimulator;
use crate::costs::Costs;
use crate::facts::{self, Facts};
use crate::forces::{Forces, HoldFact};
use crate::materials::Materials;
use crate::progress::Progress;
use crate::scene::Scene;
use crate::step::clearances;
use crate::surroundings::{Bulk, body_forces};
use std::sync::Arc;
use stitch_mesh::yarn_net::YarnNet;

impl GpuSimulator {
    /// What there is to report of the simulation so far.
    ///
    /// # Errors
    /// The GPU fails.
    pub fn facts(&mut self) -> Result<Facts, GpuError> {
        self.state()?;
        let Self { model, materials, state, scene, progress, .. } = &*self;
        Ok(Facts {
            solver: "gpu".to_owned(),
            steps: progress.steps,
            time_s: progress.time_s,
            kinetic_j: model.kinetic_energy(materials, state),
            holds: self.holds(),
            rejected_steps: progress.rejected,
            ..facts::measure(model, materials, (scene, progress.scene_time_s), state)
        })
    }

    /// Largest strain of a segment now.
    ///
    /// # Errors
    /// The GPU fails.
    pub fn max_stretch(&mut self) -> Result<f64, GpuError> {
        self.state()?;
        Ok(facts::max_stretch(&self.model, &self.state))
    }

    /// Forces of pins, clamps and bodies on the fabric in the state that was last read back: of bodies those that act
    /// on the velocities that the fabric has there, as what the step had to do with is not kept on the device.
    pub fn holds(&self) -> Vec<HoldFact> {
        let Self { scene, state, model, materials, step, .. } = self;
        let time_s = self.read_at.scene_time_s;
        let (masses, clearances) = (model.node_masses(materials), clearances(model, materials));
        let bulk = Bulk { masses: &masses, clearances: &clearances };
        // In a step at the end of which the bodies are where they are now.
        let touching = bulk.touching(state, scene, (time_s - step).max(0.0), *step);
        let bodies = body_forces(scene, &touching, &state.velocity, *step);
        Forces { bodies, ..Forces::of_springs(scene, &state.position, time_s) }.in_words(scene)
    }

    /// Root-mean-square speed of the yarn [m/s].
    ///
    /// # Errors
    /// The GPU fails.
    pub fn speed(&mut self) -> Result<f64, GpuError> {
        self.state()?;
        Ok(self.model.speed(&self.materials, &self.state))
    }

    /// The net.
    pub fn net(&self) -> &Arc<YarnNet> {
        &self.model.net
    }

    /// The materials of its yarns.
    pub fn materials(&self) -> &Materials {
        &self.materials
    }

    /// The scene.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// How far the simulation has come.
    pub fn progress(&self) -> &Progress {
        &self.progress
    }

    /// Iterations that the last step took.
    pub fn iterations(&self) -> u32 {
        self.iterations
    }

    /// What its steps have cost since they began to be measured; nothing, if they aren't.
    pub fn costs(&self) -> Costs {
        self.costs.unwrap_or_default()
    }

    /// Measures from now on what its steps cost, which makes them a little slower: every stage is waited for.
    pub fn measure_costs(&mut self) {
        self.costs = Some(Costs::default());
    }

    /// The name of the adapter that it runs on.
    pub fn adapter(&self) -> &str {
        &self.system.gpu.adapter.name
    }

    /// What it takes on the device [bytes].
    pub fn bytes(&self) -> u64 {
        self.system.buffers.bytes()
    }
}
