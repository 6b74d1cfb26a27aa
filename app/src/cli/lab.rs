//! Virtual textile experiments on the command line: figures, CSV, plots and pictures.

use super::Output;
use super::interrupt::{interrupted, work_bar};
use crate::files;
use crate::lab::{Direction, Experiment, Picture, Setup, plot};
use crate::page;
use anyhow::{Context, Result};
use image::RgbaImage;
use render::{Bounds, Camera, Drawing, Gpu, NamedView, render_image};
use serde_json::json;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

/// What an experiment is done with.
#[derive(clap::Args)]
pub struct Options {
    /// A written pattern instead of the usual fabric (stretch, shear)
    #[arg(long, value_name = "PATTERN.ks")]
    pattern: Option<PathBuf>,
    /// Which way the fabric is pulled (stretch)
    #[arg(long, value_enum, default_value = "course")]
    direction: Direction,
}

/// Size of a picture of one piece, and of one of several [pixels].
const ALONE: [u32; 2] = [960, 720];
const BESIDE: [u32; 2] = [560, 460];
/// How much nearer several pieces are seen: none of them fills the sphere around them all.
const CLOSER: f32 = 0.8;
/// Pieces side by side.
const ACROSS: usize = 3;

/// Does an experiment and leaves what it finds in `out`.
pub fn run(experiment: Experiment, options: &Options, out: &Path, print: Output) -> Result<()> {
    let name = experiment.name();
    let pattern = options.pattern.as_deref().map(|path| {
        String::from_utf8(files::read(path)?).with_context(|| format!("{} is not text", path.display()))
    });
    let setup = Setup { pattern: pattern.transpose()?, direction: options.direction };
    std::fs::create_dir_all(out).with_context(|| out.display().to_string())?;
    let bar = work_bar(name.clone())?;
    let report = experiment.run(&setup, &mut |done, _| {
        bar.set_position((1e3 * done) as u64);
        if interrupted() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    });
    bar.finish_and_clear();
    let report = report.with_context(|| name.clone())?;

    let mut written = Vec::new();
    let mut path = |what: &str, ending: &str| {
        // What is measured once has the name of the experiment alone.
        let file = if what == name { format!("{name}.{ending}") } else { format!("{name}-{what}.{ending}") };
        written.push(out.join(file));
        written[written.len() - 1].clone()
    };
    for table in &report.tables {
        files::write(&path(table.name, "csv"), table.csv().as_bytes())?;
    }
    let gpu = Gpu::headless()?;
    for shown in &report.plots {
        files::write_small_png(&path(&format!("{}-plot", shown.name), "png"), &plot::draw(&gpu, shown)?)?;
    }
    for picture in &report.pictures {
        files::write_png(&path(picture.name, "png"), &draw(&gpu, picture)?)?;
    }
    let figures: serde_json::Map<_, _> = report.figures.iter().map(|(n, x)| (n.clone(), json!(x))).collect();
    let lines = report.figures.iter().map(|(n, x)| format!("{n} {x:.4}"));
    let files = written.iter().map(|f| f.display().to_string());
    let text: Vec<String> = lines.chain(report.remarks.iter().cloned()).chain(files).collect();
    let json = json!({"experiment": name, "figures": figures, "remarks": report.remarks, "files": written});
    print.print(&json, &text.join("\n"));
    Ok(())
}

/// One piece fills the picture; several stand side by side with their names.
fn draw(gpu: &Gpu, picture: &Picture) -> Result<RgbaImage> {
    let one = |drawing: &Drawing, size: [u32; 2], view: NamedView| -> Result<RgbaImage> {
        let bounds = drawing.bounds().context("there is nothing to draw")?;
        // All pieces of a picture at one scale.
        let all = picture.shown.iter().filter_map(|(_, d)| d.bounds()).fold(bounds, Bounds::union);
        let mut camera = Camera::named(view, all, size[0] as f32 / size[1] as f32);
        if picture.shown.len() > 1 {
            camera.distance *= CLOSER;
        }
        Ok(render_image(gpu, size, &camera, drawing)?)
    };
    match &picture.shown[..] {
        [(_, drawing)] => one(drawing, ALONE, picture.view),
        several => {
            let drawn = several.iter().map(|(name, d)| Ok((name.as_str(), one(d, BESIDE, picture.view)?)));
            page::beside(gpu, &drawn.collect::<Result<Vec<_>>>()?, several.len().min(ACROSS))
        }
    }
}
