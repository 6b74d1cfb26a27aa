//! What other counts would come to, shown before they are applied.

use crate::project::Project;
use anyhow::{Result, bail};
use stitch_mesh::edge_counts::EdgeCounts;
use stitch_mesh::edge_totals::Totals;

/// Figures before and after tessellating with other counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Consequences {
    /// Of the stitches there are now; all zero without any.
    pub before: Totals,
    /// Of those that there would be.
    pub after: Totals,
}

/// What tessellating a project with `counts` would come to. Cuts nothing, so that a window can ask while a number is dragged.
///
/// # Errors
/// Labels or counts that cannot be tessellated.
pub fn preview(project: &Project, counts: &EdgeCounts) -> Result<Consequences> {
    project.labelled.check_complete()?;
    counts.check(&project.labelled)?;
    if let Some((face, left, right)) = counts.unequal_wales(&project.labelled).first() {
        bail!(
            "the wale edges of face {face} have {left} and {right} rows; a row of faces needs the same everywhere"
        );
    }
    let before = project.fabric.as_ref().map(|f| Totals::of(&f.stitches)).unwrap_or_default();
    Ok(Consequences { before, after: counts.totals(&project.labelled) })
}
