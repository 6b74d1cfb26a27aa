//! Simulation without a window: relaxing, scenes, frames.

use super::interrupt::{interrupted, progress_bar, step_counter};
use super::picture;
use super::values::Solver;
use crate::drawing::Stage;
use crate::fabric::Moved;
use crate::project::Project;
use crate::relax::relax_mesh;
use crate::scenes;
use anyhow::{Result, bail};
use render::{Gpu, NamedView};
use sim_core::mesh_relax::RelaxParams;
use sim_core::{GpuDevice, GpuSimulator, Scene, SettleGoal, Settled, SimError, Simulator};
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Arc;

/// Speed under which a fabric counts as at rest [m/s]: a loop's width in ten seconds or so.
const STILL: f64 = 1e-3;

/// Simulated time after which a relaxation ends even if something still creeps [s].
const RELAX_LIMIT: f64 = 3.0;

/// Time between two pictures [s].
const FRAME: f64 = 1.0 / 30.0;

/// Lets the stitches come to rest on the smooth surface of the input mesh, or in space.
pub fn relax_stitches(project: &Project, surface: bool) -> Result<Project> {
    let params = RelaxParams { aspect: project.size.height / project.size.width, ..RelaxParams::default() };
    let counter = step_counter("relaxing stitches")?;
    let relaxed = relax_mesh(project, params, surface, &mut |_, facts| {
        counter.set_position(facts.step as u64);
        counter.set_message(format!("{:.3} stitches in the last step", facts.moved));
        if interrupted() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    });
    counter.finish_and_clear();
    relaxed
}

/// Lets the yarn come to rest without gravity.
pub fn relax(project: Project) -> Result<Project> {
    let scene = Scene { time_step: project.scene.time_step, ..Scene::empty() };
    settle(project, scene, RELAX_LIMIT, "relaxing")
}

/// Simulates until the fabric is at rest, or for a time [s].
pub fn settle(mut project: Project, scene: Scene, limit: f64, what: &'static str) -> Result<Project> {
    let mut simulator = start(&project, &scene)?;
    let bar = progress_bar(limit, what)?;
    let goal = SettleGoal { speed: STILL, time_limit_s: limit };
    let settled = simulator.settle(goal, &mut |progress| {
        bar.set_position((1e3 * progress.time_s) as u64);
        if interrupted() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    })?;
    bar.finish_and_clear();
    match settled {
        Settled::Interrupted => bail!("stopped; nothing was written"),
        Settled::TimeLimit => tracing::warn!("still moving after {limit} s"),
        Settled::Still => {}
    }
    project.scene = scene;
    moved(&project, &simulator)
}

/// Simulates a scene for some seconds, with a picture every frame if a folder is given.
pub fn simulate(
    mut project: Project,
    scene: Option<&str>,
    seconds: f64,
    solver: Solver,
    frames: Option<&Path>,
) -> Result<Project> {
    if !(seconds > 0.0 && seconds <= 3600.0) {
        bail!("cannot simulate {seconds} s: --seconds goes up to 3600");
    }
    if let Some(name) = scene {
        project.scene = scenes::scene(name, project.fabric()?, &project.materials.base)?;
    }
    let mut running = Running::start(&project, solver)?;
    let camera =
        frames.map(|folder| std::fs::create_dir_all(folder).map(|()| Gpu::headless())).transpose()?;
    let gpu = camera.transpose()?;
    let bar = progress_bar(seconds, "simulating")?;
    let mut frame = 0;
    while running.time_s() < seconds - 1e-9 {
        if interrupted() {
            bail!("stopped at {:.3} s; nothing was written", running.time_s());
        }
        if let (Some(folder), Some(gpu)) = (frames, &gpu)
            && running.time_s() >= f64::from(frame) * FRAME
        {
            let path = folder.join(format!("{frame:05}.png"));
            picture(gpu, &running.moved(&project)?, Stage::Yarn, NamedView::ThreeQuarter, [960, 720], &path)?;
            frame += 1;
        }
        running.step(&project)?;
        bar.set_position((1e3 * running.time_s()) as u64);
    }
    bar.finish_and_clear();
    running.moved(&project)
}

fn start(project: &Project, scene: &Scene) -> Result<Simulator> {
    let fabric = project.fabric()?;
    let state = (*fabric.state()).clone();
    Ok(Simulator::new(fabric.net(), project.materials.clone(), scene.clone(), state)?)
}

/// The project when the simulation that began with it has come so far.
fn moved(project: &Project, simulator: &Simulator) -> Result<Project> {
    let mut after = project.clone();
    after.take_over(Moved::by(simulator, project.fabric()?.net()), Some(simulator.facts()));
    Ok(after)
}

/// A simulation where it was asked for, or on the CPU once the GPU has failed.
enum Running {
    Cpu {
        simulator: Box<Simulator>,
        /// Simulated time before it took over [s].
        before: f64,
    },
    Gpu(Box<GpuSimulator>),
}

impl Running {
    /// The project's fabric in its scene.
    fn start(project: &Project, solver: Solver) -> Result<Self> {
        let Solver::Gpu = solver else {
            return Ok(Self::Cpu { simulator: Box::new(start(project, &project.scene)?), before: 0.0 });
        };
        let fabric = project.fabric()?;
        let state = (*fabric.state()).clone();
        let gpu = GpuDevice::open()?;
        tracing::info!(adapter = gpu.adapter.name, "simulating on the GPU");
        let materials = project.materials.clone();
        Ok(Self::Gpu(Box::new(GpuSimulator::new(
            &gpu,
            fabric.net(),
            materials,
            project.scene.clone(),
            state,
        )?)))
    }

    fn time_s(&self) -> f64 {
        match self {
            Self::Cpu { simulator, before } => before + simulator.time_s(),
            Self::Gpu(simulator) => simulator.time_s(),
        }
    }

    /// Goes on by one step. Where the GPU fails, the CPU goes on from the last state that came back from it.
    fn step(&mut self, project: &Project) -> Result<()> {
        match self {
            Self::Cpu { simulator, .. } => {
                simulator.step()?;
            }
            Self::Gpu(gpu) => match gpu.step().and_then(|_| Ok(gpu.keep()?)) {
                Err(SimError::Gpu(error)) => {
                    tracing::warn!("{error}; going on on the CPU from {:.3} s", gpu.last_time_s());
                    let (materials, scene) = (project.materials.clone(), gpu.scene().clone());
                    let mut simulator =
                        Simulator::new(gpu.net(), materials, scene, gpu.last_state().clone())?;
                    simulator.resume_at(gpu.last_time_s());
                    *self = Self::Cpu { simulator: Box::new(simulator), before: gpu.last_time_s() };
                }
                other => other?,
            },
        }
        Ok(())
    }

    /// The project when the simulation that began with it has come so far.
    fn moved(&mut self, project: &Project) -> Result<Project> {
        let gpu = match self {
            Self::Cpu { simulator, .. } => return moved(project, simulator),
            Self::Gpu(gpu) => gpu,
        };
        let facts = gpu.facts()?;
        let moved = Moved {
            from: Arc::clone(project.fabric()?.net()),
            net: Arc::clone(gpu.net()),
            surgery: gpu.surgery().clone(),
            state: Arc::new(gpu.state()?.clone()),
        };
        let mut after = project.clone();
        after.take_over(moved, Some(facts));
        Ok(after)
    }
}
