//! Tiling: a written pattern repeated over a region of a stitch mesh (Yuksel et al. §5.3).
//!
//! # Theory
//! The region is looked through from its lowest row up. Plain stitches (one loop to one) that stand side by side, and above
//! each of them as many plain ones as the pattern has rows, make a **band**. Into it goes the widest swatch of the pattern that
//! fits, [`StitchMesh::reknit`] puts it there, and what is left over on both sides stays as it was: so shaping is never
//! touched, and every loop finds its place. Over a whole round a pattern without edge stitches closes seamlessly.
//!
//! From band to band columns are followed upwards, so that repeats stand above each other where the fabric widens or narrows
//! beside them.
//!
//! # Practice
//! A pattern of `w` stitches a repeat and `e` at its edges fits bands of `k w + e` stitches. At the upper end of the region
//! as many rows of it are knitted as fit and leave as many loops as there were. [`Tiled::left_out`] says what did not fit, and
//! which numbers would.

mod bands;
mod swatches;
#[cfg(test)]
mod tests;

use crate::knitspeak::{KnitSpeakError, Pattern};
use bands::{Bands, levels};
use std::collections::{BTreeMap, HashSet};
use stitch_mesh::edit::{Block, EditError, Survivors};
use stitch_mesh::ids::FaceId;
use stitch_mesh::label::Row;
use stitch_mesh::stitch_mesh::StitchMesh;
use swatches::Swatches;

/// How repeats lie beside each other.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Layout {
    /// All alike.
    #[default]
    Straight,
    /// All alike, as seen in a mirror.
    Mirrored,
    /// Every second one as seen in a mirror.
    Alternating,
    /// Every second one half a repeat higher.
    HalfDrop,
}

/// A tiled fabric.
#[derive(Clone, Debug)]
pub struct Tiled {
    /// The fabric.
    pub stitches: StitchMesh,
    /// What came through.
    pub survivors: Survivors,
    /// Repeats side by side, all bands together.
    pub repeats: usize,
    /// Stitches of the region that were knitted anew.
    pub covered: usize,
    /// What of the region stays as it was, a line each.
    pub left_out: Vec<String>,
}

/// Why nothing was tiled.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum TileError {
    /// The pattern cannot be worked.
    #[error(transparent)]
    Pattern(#[from] KnitSpeakError),
    /// The pattern's rows do not close.
    #[error("the pattern begins with {begins} stitches and ends with {ends}, so it cannot be repeated")]
    Open {
        /// Stitches below.
        begins: usize,
        /// Stitches above.
        ends: usize,
    },
    /// A layout that takes repeats apart.
    #[error(
        "a pattern with edge stitches ({0} beside its repeats) cannot be laid so: only all alike, or all mirrored"
    )]
    Edges(usize),
    /// The region is too small everywhere.
    #[error(
        "the pattern needs {wide} stitches side by side and {high} rows above each other; the widest place of the region has \
         {widest} plain stitches"
    )]
    NoRoom {
        /// Stitches that it needs.
        wide: usize,
        /// Rows that it needs.
        high: usize,
        /// Most plain stitches side by side in the region that are as high.
        widest: usize,
    },
    /// The fabric refuses.
    #[error(transparent)]
    Edit(#[from] EditError),
}

/// Repeats a pattern over those faces of some rows that are in `region`; the rows stand in the order of [`StitchMesh::rows`].
///
/// # Errors
/// [`TileError`].
pub fn tile(
    stitches: &StitchMesh,
    rows: &[Row],
    region: &HashSet<FaceId>,
    pattern: &Pattern,
    layout: Layout,
) -> Result<Tiled, TileError> {
    let mut swatches = Swatches::new(pattern, layout)?;
    let mut bands = Bands::new(stitches, region.clone());
    let mut blocks = Vec::new();
    let (mut repeats, mut covered, mut widest) = (0, 0, 0);
    let mut left_out: BTreeMap<(usize, usize), usize> = BTreeMap::new();
    let levels = levels(stitches, rows, region);
    for (row, level) in rows.iter().zip(levels) {
        // Bands begin at one height all over the region, whatever is left out below them.
        if level % swatches.rows().max(1) != 0 {
            continue;
        }
        for band in bands.above(row, &swatches.heights) {
            let room = band.faces[0].len();
            widest = widest.max(room);
            let round = if band.closed { swatches.round(room)? } else { None };
            let Some(wide) = round.as_ref().map(|_| room).or(swatches.widest(room)) else {
                *left_out.entry((room, 0)).or_default() += 1;
                continue;
            };
            let (wide, start) = bands.place(&band, wide, swatches.repeat, swatches.narrowest);
            if wide < room {
                *left_out.entry((room, wide)).or_default() += 1;
            }
            let high = band.faces.len();
            let faces = band.faces.iter().map(|row| (0..wide).map(|i| row[(start + i) % room]).collect());
            let faces: Vec<Vec<FaceId>> = faces.collect();
            bands.take(&faces, swatches.repeat);
            repeats += wide / swatches.repeat;
            covered += wide * high;
            let rows = match round {
                Some(rows) => rows,
                None => swatches.swatch(wide)?,
            };
            let rows = rows.into_iter().take(high).collect();
            blocks.push(Block { faces, rows });
        }
    }
    if blocks.is_empty() {
        return Err(TileError::NoRoom { wide: swatches.narrowest, high: swatches.rows(), widest });
    }
    let (tiled, survivors) = stitches.reknit(&blocks)?;
    let (narrowest, repeat) = (swatches.narrowest, swatches.repeat);
    let line = |((room, wide), bands): ((usize, usize), usize)| {
        let nearest = match wide {
            0 => format!("the pattern needs {narrowest}"),
            wide => format!("{wide} of them are tiled; {} or {} would divide", wide, wide + repeat),
        };
        let times = if bands == 1 { String::new() } else { format!(" ({bands} times)") };
        format!("{room} plain stitches side by side{times}: {nearest}")
    };
    let mut left_out: Vec<String> = left_out.into_iter().map(line).collect();
    if covered < region.len() {
        let rest = region.len() - covered;
        left_out.push(format!("{rest} of {} stitches of the region stay as they were", region.len()));
    }
    Ok(Tiled { stitches: tiled, survivors, repeats, covered, left_out })
}
