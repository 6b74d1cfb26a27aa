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
use sim_core::{Scene, SettleGoal, Settled, SharedGpu, Simulation};
use std::ops::ControlFlow;
use std::path::Path;

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
    let mut simulation = start(&project, &scene, Solver::Auto)?;
    let bar = progress_bar(limit, what)?;
    let goal = SettleGoal { speed: STILL, time_limit_s: limit };
    let settled = simulation.settle(goal, &mut |progress| {
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
    moved(&project, &mut simulation)
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
    let mut simulation = start(&project, &project.scene, solver)?;
    let camera =
        frames.map(|folder| std::fs::create_dir_all(folder).map(|()| Gpu::headless())).transpose()?;
    let gpu = camera.transpose()?;
    let bar = progress_bar(seconds, "simulating")?;
    let mut frame = 0;
    while simulation.progress().time_s < seconds - 1e-9 {
        if interrupted() {
            bail!("stopped at {:.3} s; nothing was written", simulation.progress().time_s);
        }
        if let (Some(folder), Some(gpu)) = (frames, &gpu)
            && simulation.progress().time_s >= f64::from(frame) * FRAME
        {
            let path = folder.join(format!("{frame:05}.png"));
            picture(
                gpu,
                &moved(&project, &mut simulation)?,
                Stage::Yarn,
                NamedView::ThreeQuarter,
                [960, 720],
                &path,
            )?;
            frame += 1;
        }
        simulation.step()?;
        bar.set_position((1e3 * simulation.progress().time_s) as u64);
    }
    bar.finish_and_clear();
    moved(&project, &mut simulation)
}

fn start(project: &Project, scene: &Scene, solver: Solver) -> Result<Simulation> {
    let fabric = project.fabric()?;
    let state = (*fabric.state()).clone();
    let (materials, scene) = (project.materials.clone(), scene.clone());
    let simulation =
        Simulation::new(&SharedGpu::default(), solver.into(), fabric.net(), materials, scene, state)?;
    match simulation.adapter() {
        Some(adapter) => tracing::info!(adapter, "simulating on the GPU"),
        None => tracing::info!("simulating on the CPU, {}", simulation.solver()),
    }
    Ok(simulation)
}

/// The project when the simulation that began with it has come so far.
fn moved(project: &Project, simulation: &mut Simulation) -> Result<Project> {
    let facts = simulation.facts()?;
    let mut after = project.clone();
    after.take_over(Moved::by(simulation, project.fabric()?.net())?, Some(facts));
    Ok(after)
}
