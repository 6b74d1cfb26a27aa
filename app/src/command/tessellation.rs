//! Commands that decide how many stitches there are, and cut the labelled mesh into them.

use super::find_edge;
use crate::fabric::Fabric;
use crate::project::Project;
use crate::relax::mean_width;
use anyhow::{Result, bail};
use stitch_mesh::edge_counts::{EdgeCounts, StitchSize};
use stitch_mesh::ids::EdgeId;
use stitch_mesh::tessellate::tessellate as cut;

/// Counts as edited so far, or those of the stitch size.
fn counts(project: &Project) -> Result<EdgeCounts> {
    match &project.counts {
        Some(counts) => Ok(counts.clone()),
        None => Ok(EdgeCounts::from_size(&project.labelled, project.size)?),
    }
}

pub(super) fn tessellate(project: &mut Project, width_mm: Option<f64>) -> Result<()> {
    let size = width_mm.map_or(project.size, |width| StitchSize::of_width(width * 1e-3));
    let counts = match width_mm {
        Some(_) => {
            let marked = project.counts.take().map(|c| c.marked).unwrap_or_default();
            EdgeCounts { marked, ..EdgeCounts::from_size(&project.labelled, size)? }
        }
        None => counts(project)?,
    };
    let mut stitches = cut(&project.labelled, &counts)?;
    if let Some(fabric) = &project.fabric {
        stitches.keep_from(&fabric.stitches);
    }
    if project.fabric.is_none() || project.size != size {
        // Yarn as thick as the stitches came out: on short edges they are narrower than was asked for.
        project.materials = project.materials.refitted(mean_width(&stitches));
    }
    project.size = size;
    project.counts = Some(counts);
    project.scene.let_go();
    let woven = project.fabric.as_ref().map(|f| f.woven.clone()).unwrap_or_default();
    project.fabric = Some(Fabric::laid(stitches, None, woven));
    Ok(())
}

fn ids(project: &Project, edges: &[[u32; 2]]) -> Result<Vec<EdgeId>> {
    edges.iter().map(|e| find_edge(project.labelled.mesh(), *e)).collect()
}

pub(super) fn set_counts(project: &mut Project, edges: &[[u32; 2]], count: u32) -> Result<()> {
    let mut counts = counts(project)?;
    counts.set(&project.labelled, &ids(project, edges)?, count)?;
    project.counts = Some(counts);
    Ok(())
}

pub(super) fn mark(project: &mut Project, edges: &[[u32; 2]], marked: bool) -> Result<()> {
    let mut counts = counts(project)?;
    for (edge, [a, b]) in ids(project, edges)?.into_iter().zip(edges) {
        if !project.labelled.is_wale(edge) {
            bail!("edge {a}–{b} is not a wale edge: increases and decreases lie along wale edges");
        }
        counts.mark(edge, marked);
    }
    project.counts = Some(counts);
    Ok(())
}
