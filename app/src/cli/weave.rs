//! The verb `weave`.

use super::Output;
use crate::cloth::cloth;
use crate::files;
use crate::inspect::inspect;
use anyhow::{Context, Result, bail};
use glam::DVec3;
use std::path::Path;
use stitch_mesh::weave::{Stripes, WeaveDraft, Woven};

/// What is woven.
#[derive(clap::Args)]
pub struct Piece {
    /// Yarns of the warp, which run up
    #[arg(long, value_name = "N", default_value_t = 40)]
    ends: usize,
    /// Yarns of the weft, which run across
    #[arg(long, value_name = "M", default_value_t = 40)]
    picks: usize,
    /// Distance from a yarn to the next in millimetres
    #[arg(long, value_name = "MM", default_value_t = 1.0)]
    spacing: f64,
    /// Colours of the warp from the left, as #rrggbb, or as #rrggbb*4,#rrggbb*2 with the number of yarns of each
    #[arg(long, value_name = "COLOURS", default_value_t)]
    warp: Stripes,
    /// Colours of the weft from below
    #[arg(long, value_name = "COLOURS", default_value_t)]
    weft: Stripes,
    /// Lies, its front upwards, instead of standing
    #[arg(long)]
    flat: bool,
}

/// A draft from a file, or by name.
fn draft(name: &Path) -> Result<WeaveDraft> {
    let shown = name.display().to_string();
    if !name.exists() && WeaveDraft::NAMED.iter().any(|(known, _)| shown == *known) {
        return Ok(shown.parse()?);
    }
    if !name.exists() {
        let names = WeaveDraft::NAMED.map(|(name, _)| name).join(", ");
        bail!("no draft '{shown}': neither a file nor one of {names}");
    }
    let text = String::from_utf8(files::read(name)?).with_context(|| format!("{shown} is not text"))?;
    text.parse::<WeaveDraft>().context(shown)
}

/// Weaves a piece of cloth as a project of its own.
pub fn weave(name: &Path, piece: &Piece, output: &Path, print: Output) -> Result<()> {
    let Piece { ends, picks, spacing, flat, .. } = *piece;
    let (warp, weft) = (piece.warp.clone(), piece.weft.clone());
    let middle = DVec3::ZERO;
    let draft = draft(name)?;
    let project = cloth(Woven { draft, ends, picks, spacing: spacing * 1e-3, warp, weft, middle, flat })?;
    project.save(output)?;
    let facts = inspect(&project);
    print.print(&serde_json::to_value(&facts)?, &facts);
    Ok(())
}
