//! The command line. Exit status: 0 done; 1 the input or the work failed, with one line on standard error; 2 wrong usage.

mod bench;
mod chart;
mod demo;
mod interrupt;
mod lab;
mod new;
mod simulate;
mod values;
mod weave;
mod written;

use crate::drawing::{Stage, drawing};
use crate::inspect::inspect;
use crate::lab::Experiment;
use crate::open::open_any;
use crate::project::Project;
use crate::{export, files, library, sheet};
use anyhow::{Context, Result};
use clap::{Parser, Subcommand};
use render::{Camera, Gpu, NamedView, render_image};
use serde_json::json;
use sim_core::curves;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use values::{RelaxStage, Solver, UnitName, parse_rows, parse_size};

/// An editor for knitted fabric, with the yarn simulated live.
#[derive(Parser)]
#[command(name = "purlwise", version, args_conflicts_with_subcommands = true)]
struct Arguments {
    /// What to open in the window: a project (.purl), a mesh (.obj, in metres) or a written pattern (.ks)
    file: Option<PathBuf>,
    #[command(subcommand)]
    verb: Option<Verb>,
}

#[derive(Subcommand)]
enum Verb {
    /// Takes the bundled pullover through the whole flow, without a window: pictures and figures
    Demo {
        /// Folder for the results
        #[arg(long, default_value = "out/demo")]
        out: PathBuf,
        #[command(flatten)]
        output: Output,
    },
    /// Makes a project from a mesh
    New {
        /// A file (.obj), or a mesh that comes with the program: swatch, cowl, poncho, hat, pullover, slipover, sweater, t-shirt
        mesh: PathBuf,
        #[arg(short)]
        output: PathBuf,
        /// Width of a stitch in millimetres; 10, or as the mesh that comes with the program is made for
        #[arg(long, value_name = "MM", allow_negative_numbers = true)]
        stitch_size: Option<f64>,
        /// Unit of the mesh
        #[arg(long, value_enum, default_value = "m")]
        unit: UnitName,
        /// Labelling commands, one a line; without it the mesh labels itself
        #[arg(long)]
        script: Option<PathBuf>,
        #[command(flatten)]
        print: Output,
    },
    /// Runs a script of commands, one JSON object a line
    Edit {
        project: PathBuf,
        script: PathBuf,
        #[arg(short)]
        output: PathBuf,
        #[command(flatten)]
        print: Output,
    },
    /// Lets the yarn find its rest shape, without gravity, or the stitches before there is yarn
    Relax {
        project: PathBuf,
        #[arg(short)]
        output: PathBuf,
        /// What to relax
        #[arg(long, value_enum, default_value = "contact")]
        stage: RelaxStage,
        /// For the stage mesh: find a shape in space, not on the smooth surface of the input
        #[arg(long)]
        free: bool,
        #[command(flatten)]
        print: Output,
    },
    /// Simulates a scene
    Simulate {
        project: PathBuf,
        #[arg(short)]
        output: PathBuf,
        /// free, board, ground, sphere, form, bust, hang, pull, walk, dance, or a file (docs/scenes.md); the project's own scene if absent
        #[arg(long)]
        scene: Option<String>,
        /// Simulated time
        #[arg(long, default_value_t = 1.0, allow_negative_numbers = true)]
        seconds: f64,
        /// What to solve with
        #[arg(long, value_enum, default_value = "auto")]
        solver: Solver,
        /// Folder for one picture every 1/30 s
        #[arg(long)]
        frames: Option<PathBuf>,
        #[command(flatten)]
        print: Output,
    },
    /// Draws a picture
    Render {
        project: PathBuf,
        #[arg(short)]
        output: PathBuf,
        /// What to draw; the last stage reached if absent
        #[arg(long, value_enum)]
        stage: Option<Stage>,
        /// front, back, left, right, top, bottom or three-quarter
        #[arg(long, default_value = "three-quarter")]
        view: NamedView,
        /// Width and height in pixels, as in 1280x960
        #[arg(long, default_value = "1280x960", value_parser = parse_size)]
        size: [u32; 2],
        #[command(flatten)]
        print: Output,
    },
    /// Writes the yarn as curves (.bcc, .obj, .usda)
    Export {
        project: PathBuf,
        #[arg(short)]
        output: PathBuf,
        #[command(flatten)]
        print: Output,
    },
    /// Knits a flat piece, or a tube, from a written pattern; of a folder all its patterns
    Swatch {
        pattern: PathBuf,
        #[arg(short)]
        output: PathBuf,
        #[command(flatten)]
        extent: written::Extent,
        #[command(flatten)]
        print: Output,
    },
    /// Repeats a written pattern over a fabric
    Tile {
        project: PathBuf,
        pattern: PathBuf,
        #[arg(short)]
        output: PathBuf,
        #[command(flatten)]
        place: written::Where,
        #[command(flatten)]
        print: Output,
    },
    /// Writes knitting instructions
    Instructions {
        project: PathBuf,
        #[arg(short)]
        output: Option<PathBuf>,
        /// First and last row, from 0, as in 4..19; all rows if absent
        #[arg(long, value_name = "A..B", value_parser = parse_rows)]
        rows: Option<[usize; 2]>,
        /// Stitches, as in 3,7,20-39; all of the rows if absent
        #[arg(long, value_name = "F", value_parser = written::parse_faces)]
        faces: Option<written::Faces>,
        #[command(flatten)]
        print: Output,
    },
    /// Weaves a piece of cloth
    Weave {
        /// A weave draft (a file: a line of # and . for each pick, the last pick first), or plain, twill, satin
        draft: PathBuf,
        #[arg(short)]
        output: PathBuf,
        #[command(flatten)]
        piece: weave::Piece,
        #[command(flatten)]
        print: Output,
    },
    /// Draws the contact sheet of all stitches and cables, front and back
    Stitches {
        #[arg(short, default_value = "out/stitches.png")]
        output: PathBuf,
    },
    /// Draws a picture of every pattern of the library, ten in a row
    Library {
        #[arg(short, default_value = "out/patterns.png")]
        output: PathBuf,
    },
    /// Draws a knitting chart (.svg, .png)
    Chart {
        project: PathBuf,
        #[arg(short)]
        output: PathBuf,
        /// First and last row, from 0, as in 4..19; all rows if absent
        #[arg(long, value_name = "A..B", value_parser = parse_rows)]
        rows: Option<[usize; 2]>,
        #[command(flatten)]
        print: Output,
    },
    /// Does a virtual textile experiment: figures, CSV, plots and pictures
    Lab {
        #[arg(value_enum)]
        experiment: Experiment,
        /// Folder for the results
        #[arg(long, default_value = "out/lab")]
        out: PathBuf,
        #[command(flatten)]
        options: lab::Options,
        #[command(flatten)]
        print: Output,
    },
    /// Measures the simulator's speed, and what it achieved
    Bench {
        /// What to measure
        #[arg(value_enum, default_value = "pull")]
        suite: bench::Suite,
        /// For growth and scale: leave out what has more loops
        #[arg(long, default_value_t = 60_000)]
        most_loops: usize,
        /// What to solve with; if absent, growth takes the iterative one, and steps compares that with the direct one
        #[arg(long, value_enum)]
        solver: Option<Solver>,
        #[command(flatten)]
        print: Output,
    },
    /// Facts about a project
    Inspect {
        project: PathBuf,
        #[command(flatten)]
        print: Output,
    },
}

#[derive(clap::Args, Clone, Copy)]
struct Output {
    /// Prints one JSON object and nothing else
    #[arg(long)]
    json: bool,
}

impl Output {
    /// Prints the result of a verb.
    fn print(self, json: &serde_json::Value, text: &dyn std::fmt::Display) {
        self.tell(text);
        self.end(json);
    }

    /// Prints a part of the result for people.
    fn tell(self, text: &dyn std::fmt::Display) {
        // A reader that has gone away (`| head`) does not want the rest; the work is done all the same.
        if !self.json {
            let _ = writeln!(std::io::stdout(), "{text}");
        }
    }

    /// Prints the whole result for programs.
    fn end(self, json: &serde_json::Value) {
        if self.json {
            let _ = writeln!(std::io::stdout(), "{json}");
        }
    }
}

/// Runs the program.
pub fn main() -> ExitCode {
    listen_to_warnings();
    let arguments = Arguments::parse();
    match run(arguments) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            // One line: the causes after each other.
            let line = format!("{error:#}").replace('\n', "; ");
            let _ =
                std::io::Write::write_all(&mut std::io::stderr(), format!("purlwise: {line}\n").as_bytes());
            ExitCode::FAILURE
        }
    }
}

/// Our own warnings go to standard error; of the libraries only errors do: what the display server lacks is not the user's
/// business.
fn listen_to_warnings() {
    use tracing_subscriber::prelude::*;
    let levels = tracing_subscriber::filter::Targets::new()
        .with_default(tracing::Level::ERROR)
        .with_targets(["app", "sim_core"].map(|name| (name, tracing::Level::WARN)));
    let lines = tracing_subscriber::fmt::layer().with_writer(std::io::stderr).without_time();
    tracing_subscriber::registry().with(lines).with(levels).init();
}

fn run(arguments: Arguments) -> Result<()> {
    let Some(verb) = arguments.verb else {
        let project = arguments.file.as_deref().map(open_any).transpose()?;
        return crate::window::run(project, arguments.file);
    };
    match verb {
        Verb::Demo { out, output } => demo::run(&out, output),
        Verb::New { mesh, output, stitch_size, unit, script, print } => {
            files::check_ending(&output, "purl", "projects")?;
            let project = new::new(&mesh, unit.into(), stitch_size, script.as_deref())?;
            project.save(&output)?;
            report(&project, print)
        }
        Verb::Edit { project, script, output, print } => {
            files::check_ending(&output, "purl", "projects")?;
            let text = String::from_utf8(files::read(&script)?)
                .with_context(|| format!("{} is not text", script.display()))?;
            let project = new::perform(Project::open(&project)?, &text)
                .with_context(|| script.display().to_string())?;
            project.save(&output)?;
            report(&project, print)
        }
        Verb::Relax { project, output, stage, free, print } => {
            files::check_ending(&output, "purl", "projects")?;
            let opened = Project::open(&project)?;
            let relaxed = match stage {
                RelaxStage::Mesh => simulate::relax_stitches(&opened, !free),
                RelaxStage::Contact => simulate::relax(opened),
            };
            let project = relaxed.with_context(|| project.display().to_string())?;
            project.save(&output)?;
            report(&project, print)
        }
        Verb::Simulate { project, output, scene, seconds, solver, frames, print } => {
            // Before the work, not after it.
            files::check_ending(&output, "purl", "projects")?;
            let opened = Project::open(&project)?;
            let project = simulate::simulate(opened, scene.as_deref(), seconds, solver, frames.as_deref())
                .with_context(|| project.display().to_string())?;
            project.save(&output)?;
            report(&project, print)
        }
        Verb::Render { project, output, stage, view, size, print } => {
            let path = project.display().to_string();
            let project = Project::open(&project)?;
            let stage = stage.unwrap_or(match project.fabric {
                Some(_) => Stage::Yarn,
                None => Stage::Labels,
            });
            picture(&Gpu::headless()?, &project, stage, view, size, &output).context(path)?;
            print.print(&json!({"file": output, "size": size}), &output.display());
            Ok(())
        }
        Verb::Export { project, output, print } => {
            let path = project.display().to_string();
            let project = Project::open(&project)?;
            let fabric = project.fabric().context(path)?;
            let curves = curves(fabric.net(), &fabric.state(), &project.materials);
            files::write(&output, &export::encode(&curves, &output)?)?;
            let points: usize = curves.curves.iter().map(|c| c.points.len()).sum();
            let facts = json!({"file": output, "yarns": curves.curves.len(), "points": points});
            print.print(&facts, &format!("{} yarns, {points} points", curves.curves.len()));
            Ok(())
        }
        Verb::Swatch { pattern, output, extent, print } => {
            written::swatches(&pattern, &extent, &output, print)
        }
        Verb::Tile { project, pattern, output, place, print } => {
            written::tile(&project, &pattern, place, &output, print)
        }
        Verb::Instructions { project, output, rows, faces, print } => {
            written::instructions(&project, rows, faces, output.as_deref(), print)
        }
        Verb::Weave { draft, output, piece, print } => weave::weave(&draft, &piece, &output, print),
        Verb::Stitches { output } => {
            let bar = interrupt::step_counter("swatches")?;
            let sheet = sheet::draw(&Gpu::headless()?, &mut |done, _| bar.set_position(done as u64))?;
            bar.finish_and_clear();
            files::write_small_png(&output, &sheet)
        }
        Verb::Library { output } => {
            let bar = interrupt::step_counter("patterns")?;
            let pictures = library::draw(&Gpu::headless()?, &mut |done| bar.set_position(done as u64))?;
            bar.finish_and_clear();
            files::write_png(&output, &pictures)
        }
        Verb::Chart { project, output, rows, print } => chart::run(&project, &output, rows, print),
        Verb::Bench { suite, most_loops, solver, print } => bench::run(suite, most_loops, solver, print),
        Verb::Lab { experiment, out, options, print } => lab::run(experiment, &options, &out, print),
        Verb::Inspect { project, print } => report(&Project::open(&project)?, print),
    }
}

/// Prints the facts of a project.
fn report(project: &Project, print: Output) -> Result<()> {
    let facts = inspect(project);
    print.print(&serde_json::to_value(&facts)?, &facts);
    Ok(())
}

/// Draws one stage of a project into a PNG file.
fn picture(
    gpu: &Gpu,
    project: &Project,
    stage: Stage,
    view: NamedView,
    size: [u32; 2],
    path: &Path,
) -> Result<()> {
    let drawing = drawing(project, stage)?;
    let bounds = drawing.bounds().context("there is nothing to draw")?;
    let camera = Camera::named(view, bounds, size[0] as f32 / size[1] as f32);
    let image = render_image(gpu, size, &camera, &drawing)?;
    files::write_png(path, &image)
}
