//! Stockinette that hangs by its last row, in as many stitches as one likes.

use super::machine::{Machine, forget_peak};
use super::measured::Measured;
use anyhow::Result;
use serde_json::{Map, Value, json};
use sim_core::{Material, Pin, Scene, SharedGpu, Simulation, SolverChoice};
use std::sync::Arc;
use stitch_mesh::edge_counts::StitchSize;
use stitch_mesh::lay::lay;
use stitch_mesh::pieces::rectangle;
use stitch_mesh::yarn_net::YarnNet;

/// Width of a loop [m].
const LOOP: f64 = 3e-3;
/// Stiffness of what holds each node of the last row [N/m].
const STIFFNESS: f64 = 10.0;

/// The fabric, and what holds it.
pub struct Hanging {
    side: usize,
    net: Arc<YarnNet>,
    pins: Vec<Pin>,
}

impl Hanging {
    /// Of so many stitches on each side.
    pub fn new(side: usize) -> Result<Self> {
        let net = Arc::new(lay(&rectangle(side, side, StitchSize::of_width(LOOP))?));
        let last = side * (side - 1);
        let held = net.nodes.iter().enumerate().filter(|(_, n)| n.face.is_some_and(|f| f.index() >= last));
        let pins =
            held.map(|(i, n)| Pin { node: i as u32, target: n.position, stiffness: STIFFNESS }).collect();
        Ok(Self { side, net, pins })
    }

    /// Lets it hang for so many steps of a length [s] and then measures some more.
    pub fn steps(
        &self,
        machine: &Machine,
        gpu: &SharedGpu,
        solver: SolverChoice,
        time_step: f64,
        [before, steps]: [u64; 2],
    ) -> Result<Measured> {
        forget_peak();
        let scene = Scene { pins: self.pins.clone(), time_step, ..Scene::default() };
        let (material, state) = (Material::for_loop_width(LOOP), self.net.laid_state());
        let mut simulation = Simulation::new(gpu, solver, &self.net, material, scene, state)?;
        while simulation.progress().steps < before {
            simulation.step()?;
        }
        let few = |s: &Simulation| s.progress().steps < before + steps;
        Measured::steps(machine, self.side * self.side, &mut simulation, few)
    }
}

/// All columns of steps, and how long they are [s].
pub fn columns(measured: &Measured, time_step: f64) -> Map<String, Value> {
    let mut run = measured.json();
    run.insert("time_step_ms".to_owned(), json!(1e3 * time_step));
    run
}
