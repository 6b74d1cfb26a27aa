//! Facts about a project, for people and scripts.

use crate::fabric::Fabric;
use crate::problems::{Problem, problems};
use crate::project::Project;
use crate::relax::{MeshStrain, mesh_strain};
use glam::DVec3;
use serde::Serialize;
use sim_core::{Facts, HoldFact};
use std::collections::BTreeMap;
use stitch_mesh::ids::{FaceId, VisitId};
use stitch_mesh::weave::Woven;

/// How many pieces of yarn there are.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct YarnCount {
    /// With two ends.
    pub open: usize,
    /// Rings.
    pub closed: usize,
}

/// A woven piece.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct WovenFacts {
    /// Yarns of the warp.
    pub ends: usize,
    /// Yarns of the weft.
    pub picks: usize,
    /// Ends and picks of the repeat of the weave.
    pub repeat: [usize; 2],
    /// Distance from a yarn to the next [mm].
    pub spacing_mm: f64,
}

/// Facts about a project. Before there are stitches, those of the input mesh.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Inspection {
    /// Faces: stitches, or faces of the input mesh.
    pub faces: usize,
    /// Rows of them.
    pub rows: usize,
    /// Loops.
    pub loops: usize,
    /// Nodes at which yarns touch.
    pub contact_nodes: usize,
    /// Degrees of freedom of the simulation.
    pub dofs: usize,
    /// Pieces of yarn.
    pub yarns: YarnCount,
    /// How often each stitch occurs.
    pub stitches: BTreeMap<String, usize>,
    /// Edges marked as cables.
    pub cable_edges: usize,
    /// Edges with a face on one side only.
    pub boundary_edges: usize,
    /// Mean distance from a row to the next [mm].
    pub mean_course_spacing_mm: f64,
    /// Mean distance from a stitch to the next in its row [mm].
    pub mean_wale_spacing_mm: f64,
    /// Woven pieces.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub woven: Vec<WovenFacts>,
    /// Unstretched length of all yarn [m].
    pub yarn_length_m: f64,
    /// Extent in x, y, z [mm].
    pub size_mm: [f64; 3],
    /// How even the stitches are.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mesh_strain: Option<MeshStrain>,
    /// What keeps the mesh from being knitted.
    pub problems: Vec<Problem>,
    /// Figures of the last simulation.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sim: Option<Facts>,
}

/// Measures a project.
pub fn inspect(project: &Project) -> Inspection {
    let labelled = &project.labelled;
    let mesh = project.fabric.as_ref().map_or(labelled.mesh(), |f| f.stitches.mesh());
    let [low, high] = mesh.bounds();
    let facts = Inspection {
        faces: mesh.face_count(),
        rows: labelled.rows().len(),
        boundary_edges: mesh.edges().filter(|e| mesh.is_border(*e)).count(),
        size_mm: ((high - low) * 1e3).to_array(),
        problems: problems(project),
        ..Inspection::default()
    };
    match &project.fabric {
        Some(fabric) => {
            let mesh_strain = mesh_strain(&fabric.stitches, project.size.height / project.size.width);
            with_fabric(Inspection { mesh_strain, ..facts }, fabric)
        }
        None => facts,
    }
}

fn with_fabric(mut facts: Inspection, fabric: &Fabric) -> Inspection {
    let (Fabric { stitches, woven, .. }, net) = (fabric, fabric.net());
    let state = fabric.state();
    facts.rows = stitches.rows().len();
    facts.loops = stitches.loop_count();
    facts.contact_nodes = net.nodes.iter().filter(|n| n.visits.len() > 1).count();
    let sliding = (0..net.visits.len()).filter(|v| !net.is_frozen(VisitId::new(*v))).count();
    facts.dofs = 3 * net.nodes.len() + sliding;
    facts.yarns.closed = net.yarns.iter().filter(|y| y.period.is_some()).count();
    facts.yarns.open = net.yarns.len() - facts.yarns.closed;
    facts.cable_edges = stitches.cables().iter().map(|c| c.path.len() - 1).sum();
    for stitch in stitches.stitches() {
        *facts.stitches.entry(stitch.to_string()).or_default() += 1;
    }
    let u = |visit: u32| net.visits[visit as usize].u;
    facts.yarn_length_m =
        net.yarns.iter().map(|y| y.period.unwrap_or_else(|| u(y.visits.end - 1) - u(y.visits.start))).sum();

    let mut centers = vec![(DVec3::ZERO, 0.0); stitches.mesh().face_count()];
    for (node, position) in net.nodes.iter().zip(&state.position) {
        if let Some(face) = node.face {
            let (sum, count) = &mut centers[face.index()];
            (*sum, *count) = (*sum + *position, *count + 1.0);
        }
    }
    let center = |f: FaceId| centers[f.index()].0 / f64::max(centers[f.index()].1, 1.0);
    let mean = |pairs: Vec<(FaceId, FaceId)>| {
        let total: f64 = pairs.iter().map(|(a, b)| center(*a).distance(center(*b))).sum();
        1e3 * total / pairs.len().max(1) as f64
    };
    let faces = || stitches.mesh().faces();
    facts.mean_course_spacing_mm =
        mean(faces().flat_map(|f| stitches.above(f).map(move |a| (f, a))).collect());
    let beside = |f: FaceId| Some((f, stitches.mesh().face_across(stitches.right(f))?));
    facts.mean_wale_spacing_mm = mean(faces().filter_map(beside).collect());
    let (low, high) = state
        .position
        .iter()
        .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(lo, hi), p| (lo.min(*p), hi.max(*p)));
    facts.size_mm = ((high - low) * 1e3).to_array();
    facts.woven = woven.iter().map(WovenFacts::of).collect();
    facts.sim = fabric.facts.clone();
    facts
}

impl WovenFacts {
    fn of(piece: &Woven) -> Self {
        let Woven { ends, picks, spacing, ref draft, .. } = *piece;
        Self { ends, picks, repeat: draft.repeat(), spacing_mm: 1e3 * spacing }
    }
}

impl Inspection {
    /// The problems, and where each of them is.
    pub fn problem_groups(&self) -> Vec<(&str, Vec<&Problem>)> {
        let mut groups: Vec<(&str, Vec<&Problem>)> = Vec::new();
        for problem in &self.problems {
            match groups.iter_mut().find(|(what, _)| *what == problem.what) {
                Some((_, group)) => group.push(problem),
                None => groups.push((&problem.what, vec![problem])),
            }
        }
        groups
    }

    /// The problems as lines, one for all places with the same problem.
    pub fn grouped_problems(&self) -> Vec<String> {
        /// Places named before the rest is counted.
        const NAMED: usize = 8;
        let line = |(what, group): (&str, Vec<&Problem>)| {
            let named: Vec<&str> = group.iter().take(NAMED).map(|p| p.r#where.as_str()).collect();
            let named = named.join(", ");
            let more = group.len().saturating_sub(NAMED);
            if more > 0 { format!("{named} and {more} more: {what}") } else { format!("{named}: {what}") }
        };
        self.problem_groups().into_iter().map(line).collect()
    }
}

impl std::fmt::Display for Inspection {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        if self.faces > 0 {
            let Self { faces, rows, boundary_edges, .. } = self;
            writeln!(f, "{faces} faces in {rows} rows, {boundary_edges} boundary edges")?;
        }
        if self.loops > 0 {
            let stitches: Vec<String> = self.stitches.iter().map(|(s, n)| format!("{n} {s}")).collect();
            writeln!(f, "{} loops: {}", self.loops, stitches.join(", "))?;
        }
        for WovenFacts { ends, picks, repeat: [wide, high], spacing_mm } in &self.woven {
            writeln!(
                f,
                "woven: {ends} ends by {picks} picks, {spacing_mm:.2} mm apart, repeat {wide} by {high}"
            )?;
        }
        if self.dofs > 0 {
            writeln!(f, "{} contact nodes, {} degrees of freedom", self.contact_nodes, self.dofs)?;
            let YarnCount { open, closed } = self.yarns;
            writeln!(f, "{:.2} m of yarn: {open} with ends, {closed} closed", self.yarn_length_m)?;
        }
        if self.loops > 0 {
            let (course, wale) = (self.mean_course_spacing_mm, self.mean_wale_spacing_mm);
            writeln!(f, "rows {course:.2} mm apart, stitches {wale:.2} mm")?;
        }
        if let Some(MeshStrain { min, max, rms, .. }) = &self.mesh_strain {
            let percent = [min, max, rms].map(|s| 100.0 * s);
            writeln!(
                f,
                "stitches {:+.0} … {:+.0} % of even, {:.1} % rms",
                percent[0], percent[1], percent[2]
            )?;
        }
        let [x, y, z] = self.size_mm;
        write!(f, "{x:.0} × {y:.0} × {z:.0} mm")?;
        for problem in self.grouped_problems() {
            write!(f, "\n{problem}")?;
        }
        if self.loops == 0 && self.woven.is_empty() {
            write!(
                f,
                "\nno stitches yet: label what is open in the window or with commands (--script), then tessellate"
            )?;
        }
        if let Some(sim) = &self.sim {
            write!(
                f,
                "\nsimulated {:.2} s in {} steps ({} taken again): stretched at most {:.2} %, yarns at least {:.2} diameters \
                 apart, {:.2} mm into bodies",
                sim.time_s,
                sim.steps,
                sim.rejected_steps,
                100.0 * sim.max_stretch,
                sim.min_yarn_distance_over_diameter,
                sim.max_penetration_mm
            )?;
            for HoldFact { what, force_n } in sim.holds.iter().filter(|hold| hold.is_felt()) {
                let [x, y, z] = (1e3 * *force_n).to_array();
                write!(
                    f,
                    "\n{what}: {:.2} mN on the fabric ({x:.2}, {y:.2}, {z:.2})",
                    1e3 * force_n.length()
                )?;
            }
        }
        Ok(())
    }
}
