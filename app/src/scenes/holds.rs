//! What a scene file holds of a fabric: nodes by number, stitches, a row, or what lies in a box.

use super::file::{Move, metres};
use crate::fabric::Fabric;
use anyhow::{Result, bail};
use glam::DVec3;
use serde::Deserialize;
use sim_core::{Clamp, Motion};
use std::collections::HashSet;
use stitch_mesh::ids::FaceId;
use stitch_mesh::yarn_net::YarnState;

/// A part of the fabric that is held.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Hold {
    pub name: Option<String>,
    nodes: Option<Vec<u32>>,
    stitches: Option<Vec<u32>>,
    row: Option<Row>,
    region: Option<Region>,
    /// Of the spring at each node [N/m].
    stiffness: Option<f64>,
    #[serde(rename = "move")]
    moves: Option<Move>,
}

/// A row by its number or its place.
#[derive(Clone, Copy, Deserialize)]
#[serde(untagged)]
enum Row {
    Number(usize),
    Place(RowPlace),
}

#[derive(Clone, Copy, Deserialize)]
#[serde(rename_all = "snake_case")]
enum RowPlace {
    First,
    Last,
}

/// A box along the axes.
#[derive(Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
struct Region {
    from: [f64; 3],
    to: [f64; 3],
}

/// The clamp that holds it where it is now.
pub(super) fn clamp(
    hold: &Hold,
    name: &str,
    fabric: &Fabric,
    state: &YarnState,
    origin: DVec3,
    stiffness: f64,
) -> Result<Clamp> {
    let chosen = chosen(hold, fabric, state, origin)?;
    if chosen.is_empty() {
        bail!("there is no yarn there");
    }
    let nodes: Vec<(u32, DVec3)> = chosen.into_iter().map(|n| (n, state.position[n as usize])).collect();
    let middle = nodes.iter().map(|(_, x)| *x).sum::<DVec3>() / nodes.len() as f64;
    let motion = hold.moves.as_ref().map_or(Ok(Motion::default()), |m| m.motion(middle, origin))?;
    Ok(Clamp { name: name.to_owned(), nodes, stiffness: hold.stiffness.unwrap_or(stiffness), motion })
}

/// The nodes that it names.
fn chosen(hold: &Hold, fabric: &Fabric, state: &YarnState, origin: DVec3) -> Result<Vec<u32>> {
    let count = fabric.net().nodes.len();
    match (&hold.nodes, &hold.stitches, hold.row, hold.region) {
        (Some(nodes), None, None, None) => {
            if let Some(node) = nodes.iter().find(|n| **n as usize >= count) {
                bail!("there is no node {node}: the nodes are 0–{}", count - 1);
            }
            Ok(nodes.clone())
        }
        (None, Some(stitches), None, None) => {
            let faces = fabric.stitches.mesh().face_count();
            if let Some(face) = stitches.iter().find(|f| **f as usize >= faces) {
                bail!("there is no stitch {face}: the stitches are 0–{}", faces - 1);
            }
            Ok(of_stitches(fabric, &stitches.iter().map(|f| FaceId(*f)).collect()))
        }
        (None, None, Some(row), None) => {
            let (_, heights) = fabric.stitches.rows_and_heights();
            let Some(highest) = heights.last().copied() else {
                bail!("nothing is knitted: there are no rows")
            };
            let number = match row {
                Row::Number(number) => number,
                Row::Place(RowPlace::First) => 0,
                Row::Place(RowPlace::Last) => highest,
            };
            let Some(rows) = fabric.stitches.rows_between([number; 2]) else {
                bail!("there is no row {number}: the rows are 0–{highest}");
            };
            Ok(of_stitches(fabric, &rows.into_iter().flat_map(|row| row.faces).collect()))
        }
        (None, None, None, Some(Region { from, to })) => {
            let (a, b) = (origin + metres(from), origin + metres(to));
            let (low, high) = (a.min(b), a.max(b));
            let inside = |x: &DVec3| x.cmpge(low).all() && x.cmple(high).all();
            let nodes = state.position.iter().zip(0..).filter(|(x, _)| inside(x));
            Ok(nodes.map(|(_, n)| n).collect())
        }
        _ => bail!("has to be one of 'nodes', 'stitches', 'row', 'region'"),
    }
}

/// The nodes of some stitches.
pub(super) fn of_stitches(fabric: &Fabric, faces: &HashSet<FaceId>) -> Vec<u32> {
    let nodes = fabric.net().nodes.iter().zip(0..);
    nodes.filter(|(n, _)| n.face.is_some_and(|f| faces.contains(&f))).map(|(_, i)| i).collect()
}
