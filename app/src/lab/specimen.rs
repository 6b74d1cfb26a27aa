//! A piece of fabric, and places on it.
//!
//! Places are told as parts of the fabric: s from 0 at the left to 1 at the right, t from 0 at the first row to 1 at the last,
//! each the middle of a stitch.

use super::report::Picture;
use crate::solids::solids;
use crate::written::swatch;
use anyhow::{Context, Result};
use glam::DVec3;
use patterns::knitspeak::Width;
use render::{Drawing, NamedView};
use sim_core::{Material, Materials, Scene, Simulator, curves};
use std::sync::Arc;
use stitch_mesh::edge_counts::StitchSize;
use stitch_mesh::ids::{FaceId, NodeId};
use stitch_mesh::lay::lay;
use stitch_mesh::pieces::rectangle;
use stitch_mesh::stitch::Stitch;
use stitch_mesh::stitch_mesh::StitchMesh;
use stitch_mesh::yarn_net::{YarnNet, YarnState};

/// Width of the loops of specimens [m].
pub(super) const LOOP: f64 = 3e-3;

/// Rows that a written pattern is worked for, at least.
const LEAST_ROWS: usize = 12;

/// A piece of fabric.
pub(super) struct Specimen {
    pub stitches: Arc<StitchMesh>,
    pub net: Arc<YarnNet>,
    pub materials: Materials,
    /// Size of a stitch as laid.
    pub size: StitchSize,
    /// Stitches of every row from left to right, the lowest row first.
    pub rows: Vec<Vec<FaceId>>,
    /// s and t of every stitch, [face_count].
    places: Vec<[f64; 2]>,
}

impl Specimen {
    /// A piece of a stitch mesh.
    pub fn new(stitches: &StitchMesh, size: StitchSize, materials: Materials) -> Self {
        let rows: Vec<Vec<FaceId>> = stitches.rows().into_iter().map(|row| row.faces).collect();
        let mut places = vec![[0.0; 2]; stitches.mesh().face_count()];
        for (r, row) in rows.iter().enumerate() {
            for (i, face) in row.iter().enumerate() {
                let part = |i: usize, n: usize| (i as f64 + 0.5) / n as f64;
                places[face.index()] = [part(i, row.len()), part(r, rows.len())];
            }
        }
        let net = Arc::new(lay(stitches));
        Self { stitches: Arc::new(stitches.clone()), net, materials, size, rows, places }
    }

    /// A rectangle, its purls chosen by column and row.
    pub fn rectangle(wide: usize, high: usize, purl: impl Fn(usize, usize) -> bool) -> Result<Self> {
        let size = StitchSize::of_width(LOOP);
        let mut stitches = rectangle(wide, high, size)?;
        for i in (0..wide * high).filter(|i| purl(i % wide, i / wide)) {
            stitches.set_stitch(FaceId::new(i), Stitch::purl())?;
        }
        Ok(Self::new(&stitches, size, Material::for_loop_width(LOOP).into()))
    }

    /// A swatch of a written pattern, worked over its rows often enough to be tried.
    pub fn of_pattern(text: &str) -> Result<Self> {
        let (_, once) = swatch(text, Width::AsWritten, 1)?;
        let (project, _) = swatch(text, Width::AsWritten, LEAST_ROWS.div_ceil(once.rows.max(1)))?;
        Ok(Self::new(&project.fabric()?.stitches, project.size, project.materials.clone()))
    }

    /// A simulation of it as laid.
    pub fn simulate(&self, scene: Scene) -> Result<Simulator> {
        Ok(Simulator::new(&self.net, self.materials.clone(), scene, self.net.laid_state())?)
    }

    /// Mean position of the nodes at `chosen` places [m].
    pub fn mean(&self, state: &YarnState, chosen: impl Fn(f64, f64) -> bool) -> Result<DVec3> {
        let (sum, count) =
            self.nodes(chosen).fold((DVec3::ZERO, 0.0), |(s, c), n| (s + state.position[n.index()], c + 1.0));
        (count > 0.0).then(|| sum / count).context("the piece is too small for what is measured on it")
    }

    /// The nodes at `chosen` places.
    pub fn nodes(&self, chosen: impl Fn(f64, f64) -> bool) -> impl Iterator<Item = NodeId> {
        let is_chosen = move |face: FaceId| {
            let [s, t] = self.places[face.index()];
            chosen(s, t)
        };
        let nodes = self.net.nodes.iter().enumerate();
        nodes.filter(move |(_, n)| n.face.is_some_and(&is_chosen)).map(|(i, _)| NodeId::new(i))
    }

    /// Middle of every stitch, [face_count] [m].
    pub fn centers(&self, state: &YarnState) -> Vec<DVec3> {
        let mut sums = vec![(DVec3::ZERO, 0.0); self.places.len()];
        for (node, x) in self.net.nodes.iter().zip(&state.position) {
            if let Some(face) = node.face {
                let (sum, count) = &mut sums[face.index()];
                (*sum, *count) = (*sum + *x, *count + 1.0);
            }
        }
        sums.into_iter().map(|(sum, count)| sum / f64::max(count, 1.0)).collect()
    }

    /// Unit vectors along the course, along the wale and to the front, in the middle of the piece.
    pub fn frame(&self, state: &YarnState) -> Result<[DVec3; 3]> {
        let inner = |x: f64| (0.3..0.7).contains(&x);
        let part = |s: [f64; 2], t: [f64; 2]| {
            self.mean(state, |a, b| (s[0]..s[1]).contains(&a) && (t[0]..t[1]).contains(&b))
        };
        let across = part([0.6, 0.8], [0.3, 0.7])? - part([0.2, 0.4], [0.3, 0.7])?;
        let along = self.mean(state, |s, t| inner(s) && (0.6..0.8).contains(&t))?
            - self.mean(state, |s, t| inner(s) && (0.2..0.4).contains(&t))?;
        let front = across.cross(along).normalize();
        Ok([across.normalize(), along.normalize(), front])
    }

    /// What it looks like, its net as it is by now.
    pub fn drawing(&self, net: &YarnNet, state: &YarnState, scene: &Scene) -> Drawing {
        let yarn = curves(net, state, &self.materials);
        Drawing { yarn, solids: solids(scene, 0.0), ..Drawing::default() }
    }

    /// A picture of it alone.
    pub fn picture(&self, name: &'static str, view: NamedView, simulator: &Simulator) -> Picture {
        let drawing = self.drawing(simulator.net(), simulator.state(), simulator.scene());
        Picture { name, view, shown: vec![(String::new(), drawing)] }
    }
}
