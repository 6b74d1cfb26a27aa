//! What comes with the program to begin with: meshes by name, each with what makes a fabric of it.
//!
//! The same garment comes in any number of loops, by the size of its stitches: [`Bundled::of_loops`].

use crate::command::{Command, read_script};
use crate::project::{DEFAULT_STITCH_WIDTH, Project};
use crate::scenes;
use anyhow::{Context, Result};
use stitch_mesh::edge_counts::{EdgeCounts, StitchSize};
use stitch_mesh::obj::{Unit, read_obj};

/// A mesh that comes with the program.
#[derive(Debug)]
pub struct Bundled {
    /// What it is called.
    pub name: &'static str,
    /// What it is.
    pub about: &'static str,
    /// Width of its stitches, unless somebody wants others [m].
    pub width: f64,
    /// OBJ, in metres.
    obj: &'static [u8],
    /// Commands that label, tessellate, knit and sew it.
    script: &'static str,
    /// The scene that it is made for.
    scene: Option<&'static str>,
}

/// The script of a mesh that labels itself and is stockinette all over.
const PLAIN: &str = "{\"do\":\"autolabel\"}\n{\"do\":\"tessellate\"}\n";

/// An inch [m], over which knitters count stitches.
const INCH: f64 = 0.0254;

/// All of them.
pub const ALL: [Bundled; 8] = [
    Bundled {
        name: "swatch",
        about: "A flat piece",
        width: DEFAULT_STITCH_WIDTH,
        obj: include_bytes!("../../assets/meshes/swatch.obj"),
        script: PLAIN,
        scene: None,
    },
    Bundled {
        name: "cowl",
        about: "A tube",
        width: DEFAULT_STITCH_WIDTH,
        obj: include_bytes!("../../assets/meshes/cowl.obj"),
        script: PLAIN,
        scene: None,
    },
    Bundled {
        name: "poncho",
        about: "A poncho, knitted from hem to neck",
        width: DEFAULT_STITCH_WIDTH,
        obj: include_bytes!("../../assets/meshes/poncho.obj"),
        script: PLAIN,
        scene: None,
    },
    Bundled {
        name: "hat",
        about: "A hat with decreases to the crown",
        width: DEFAULT_STITCH_WIDTH,
        obj: include_bytes!("../../assets/meshes/hat.obj"),
        script: PLAIN,
        scene: None,
    },
    Bundled {
        name: "pullover",
        about: "A child's sleeveless pullover in stockinette, with a ribbed hem, on a dress form",
        width: DEFAULT_STITCH_WIDTH,
        obj: include_bytes!("../../assets/meshes/pullover.obj"),
        script: include_str!("../../assets/meshes/pullover.jsonl"),
        scene: Some("form"),
    },
    Bundled {
        name: "slipover",
        about: "A child's sleeveless pullover in stockinette, knitted in the round, whose hem and collar roll up, on a bust",
        width: 6e-3,
        obj: include_bytes!("../../assets/meshes/slipover.obj"),
        script: include_str!("../../assets/meshes/slipover.jsonl"),
        scene: Some("bust"),
    },
    Bundled {
        name: "sweater",
        about: "A sweater of front, back and sleeves in garter stitch, sewn together, on a mannequin who dances: \
                57 000 loops at 6.5 stitches an inch",
        width: INCH / 6.5,
        obj: include_bytes!("../../assets/meshes/sweater.obj"),
        script: include_str!("../../assets/meshes/sweater.jsonl"),
        scene: Some("dance"),
    },
    Bundled {
        name: "t-shirt",
        about: "A sleeveless shirt in fine garter stitch, sewn together, on a mannequin who dances: 325 000 loops at 20 \
                stitches an inch",
        width: INCH / 20.0,
        obj: include_bytes!("../../assets/meshes/t-shirt.obj"),
        script: include_str!("../../assets/meshes/t-shirt.jsonl"),
        scene: Some("dance"),
    },
];

/// The mesh of this name.
pub fn find(name: &str) -> Option<&'static Bundled> {
    ALL.iter().find(|b| b.name == name)
}

/// The sleeveless pullover, knitted and on its dress form: what the window opens with.
///
/// # Errors
/// The bundled mesh is broken.
pub fn pullover() -> Result<Project> {
    let pullover = find("pullover").context("there is no pullover")?;
    pullover.knitted(pullover.width)
}

impl Bundled {
    /// The mesh as it was read, for stitches of this width [m].
    ///
    /// # Errors
    /// The mesh is broken.
    pub fn mesh(&self, width: f64) -> Result<Project> {
        Ok(Project::new(read_obj(self.obj, Unit::M)?, StitchSize::of_width(width)))
    }

    /// Labelled, knitted in stitches of this width [m], sewn, and in its scene.
    ///
    /// # Errors
    /// Stitches of a width that no mesh can be cut into.
    pub fn knitted(&self, width: f64) -> Result<Project> {
        let mut project = self.mesh(width)?;
        for (line, command) in read_script(self.script)? {
            project = command.apply(&project).with_context(|| format!("{}, line {line}", self.name))?;
        }
        if let Some(scene) = self.scene {
            project.scene = scenes::scene(scene, project.fabric()?, &project.materials.base)?;
        }
        Ok(project)
    }

    /// As [`Self::knitted`], in stitches of the width with which it has most nearly so many loops. Every edge of the mesh
    /// keeps at least one stitch: below some 500 loops there is no coming.
    ///
    /// # Errors
    /// More loops than a garment may have.
    pub fn of_loops(&self, loops: usize) -> Result<Project> {
        let labels = |command: &Command| !matches!(command, Command::Tessellate { .. });
        let mut project = self.mesh(self.width)?;
        for (_, command) in read_script(self.script)?.into_iter().take_while(|(_, c)| labels(c)) {
            project = command.apply(&project)?;
        }
        let count = |width: f64| -> Result<f64> {
            let counts = EdgeCounts::from_size(&project.labelled, StitchSize::of_width(width))?;
            Ok(counts.totals(&project.labelled).stitches as f64)
        };
        let wanted = loops.max(1) as f64;
        let about = self.width * (count(self.width)? / wanted).sqrt();
        // Counts are whole numbers, so the number of loops goes in steps: the best of the widths around.
        let mut best = (f64::INFINITY, about);
        for step in -20..=20 {
            let width = about * 1.01_f64.powi(step);
            let off = (count(width)? - wanted).abs();
            if off < best.0 {
                best = (off, width);
            }
        }
        self.knitted(best.1)
    }
}
