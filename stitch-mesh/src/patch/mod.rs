//! Patches: a selection of stitches copied, mirrored and put elsewhere (Yuksel et al. §5.3).
//!
//! A patch has an **anchor column**, that of its lowest stitch on the left: from row to row it goes on above the stitch in it.
//! The stitches of a row are counted from the anchor column, to the right. So a patch fits wherever rows and columns run as
//! where it was copied, whatever the fabric is like around it. It changes no faces: a stitch goes where one stands that
//! joins as many loops to as many.

mod line;
#[cfg(test)]
mod tests;

use crate::cable::{Cable, CableError};
use crate::dye::Dye;
use crate::ids::{FaceId, HalfEdgeId, VertexId};
use crate::label::Row;
use crate::stitch::Stitch;
use crate::stitch_mesh::{StitchMesh, StitchMeshError};
use crate::wrapping::Wrapping;
use line::Line;
use serde::{Deserialize, Serialize};
use std::collections::{HashMap, HashSet};

/// A stitch, the colour of its yarn, and how that is wrapped.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PatchStitch {
    /// What is knitted.
    pub stitch: Stitch,
    /// In which colour.
    #[serde(default)]
    pub color: Dye,
    /// How wrapped.
    #[serde(default, skip_serializing_if = "is_of_material")]
    pub wrapping: Wrapping,
}

fn is_of_material(wrapping: &Wrapping) -> bool {
    *wrapping == Wrapping::OF_MATERIAL
}

/// One row of a patch.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PatchRow {
    /// Column of the first stitch, counted from the anchor column.
    pub begins: i32,
    /// Stitches left to right; none where the selection had a hole.
    pub stitches: Vec<Option<PatchStitch>>,
}

/// A cable between two rows of a patch.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PatchCable {
    /// The row below it.
    pub row: usize,
    /// Column of the stitch below its first loop.
    pub column: i32,
    /// Turn of its first loop among the tops of that stitch.
    pub top: usize,
    /// As in [`Cable`].
    pub strands: Vec<u8>,
    /// As in [`Cable`].
    pub order: Vec<u8>,
    /// As in [`Cable`].
    pub front: Vec<u8>,
}

/// A patch. See the module.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Patch {
    /// Rows, the lowest first.
    pub rows: Vec<PatchRow>,
    /// Cables between them.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub cables: Vec<PatchCable>,
}

/// Why a patch cannot be copied or pasted.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PatchError {
    /// Nothing is selected, or the patch has no stitches.
    #[error("there are no stitches to copy")]
    Empty,
    /// No such face.
    #[error("there is no face {0}")]
    NoFace(FaceId),
    /// A stitch that does not lie in the rows above the lowest one.
    #[error(
        "face {face} does not lie in the rows above face {anchor}, the lowest on the left: a patch is copied from rows that \
         lie on each other"
    )]
    Apart {
        /// The face.
        face: FaceId,
        /// The anchor.
        anchor: FaceId,
    },
    /// The fabric ends before the patch does.
    #[error("the fabric ends {way} of face {face}, and the patch goes on")]
    Ends {
        /// The last face.
        face: FaceId,
        /// `above`, `to the left` or `to the right`.
        way: &'static str,
    },
    /// A closed row with fewer stitches than a row of the patch.
    #[error("the row of face {face} has {has} stitches, and a row of the patch {needs}")]
    Laps {
        /// A face of the row.
        face: FaceId,
        /// Its stitches.
        has: usize,
        /// Those of the patch.
        needs: usize,
    },
    /// A stitch that works other numbers of loops than the one that is there.
    #[error(
        "stitch {face} is {has}, and the patch has {stitch} there, which works other numbers of loops: a patch goes where increases and \
         decreases lie as they do in it"
    )]
    Shape {
        /// The face.
        face: FaceId,
        /// Its stitch.
        has: String,
        /// That of the patch.
        stitch: String,
    },
    /// A stitch that does not fit.
    #[error(transparent)]
    Stitch(#[from] StitchMeshError),
    /// A cable that does not fit.
    #[error("a cable of the patch does not fit: {0}")]
    Cable(#[from] CableError),
    /// A cable that is not on the patch.
    #[error("cable {0} of the patch does not lie on its stitches")]
    NoCable(usize),
}

impl Patch {
    /// Copies stitches, their colours and wrappings, and the cables that lie between them.
    ///
    /// # Errors
    /// [`PatchError`] where they do not lie in rows on each other.
    pub fn copy(stitches: &StitchMesh, selected: &[FaceId]) -> Result<Self, PatchError> {
        let count = stitches.mesh().face_count();
        if let Some(face) = selected.iter().find(|f| f.index() >= count) {
            return Err(PatchError::NoFace(*face));
        }
        let selected: HashSet<FaceId> = selected.iter().copied().collect();
        let rows = stitches.rows();
        let anchor = rows.iter().find_map(|r| leftmost(r, &selected)).ok_or(PatchError::Empty)?;
        let mut places: HashMap<FaceId, (usize, i32)> = HashMap::new();
        let mut patch = Self { rows: Vec::new(), cables: Vec::new() };
        let mut at = Some(anchor);
        while let Some(face) = at.filter(|_| places.len() < selected.len()) {
            let line = Line::through(stitches, face);
            let mut row: Vec<(i32, FaceId)> =
                line.columns().filter(|(_, f)| selected.contains(f) && !places.contains_key(f)).collect();
            row.sort_unstable();
            places.extend(row.iter().map(|(c, f)| (*f, (patch.rows.len(), *c))));
            let begins = row.first().map_or(0, |(c, _)| *c);
            let mut cells = vec![None; row.last().map_or(0, |(c, _)| (c - begins + 1) as usize)];
            for (c, f) in row {
                let stitch = stitches.stitch(f).clone();
                let (color, wrapping) = (stitches.dyes()[f.index()], stitches.wrappings()[f.index()]);
                cells[(c - begins) as usize] = Some(PatchStitch { stitch, color, wrapping });
            }
            patch.rows.push(PatchRow { begins, stitches: cells });
            at = stitches.above(face).next().filter(|f| *f != anchor && patch.rows.len() < rows.len());
        }
        if let Some(face) = selected.iter().filter(|f| !places.contains_key(f)).min() {
            return Err(PatchError::Apart { face: *face, anchor });
        }
        patch.cables =
            stitches.cables().iter().filter_map(|cable| copied(stitches, cable, &places)).collect();
        Ok(patch)
    }

    /// The patch as seen in a mirror: columns and stacks the other way round, twists the other way, left crosses to the
    /// right.
    pub fn mirrored(&self) -> Self {
        let ends = |r: &PatchRow| r.begins.wrapping_add(r.stitches.len() as i32 - 1);
        // What was the last column of the lowest row is the first one now.
        let last = self.rows.first().map_or(0, ends);
        let row = |r: &PatchRow| {
            let stitches = r.stitches.iter().rev().map(|s| {
                let mirror = |s: &PatchStitch| PatchStitch { stitch: s.stitch.mirrored(), ..s.clone() };
                s.as_ref().map(mirror)
            });
            PatchRow { begins: last.wrapping_sub(ends(r)), stitches: stitches.collect() }
        };
        let cable = |cable: &PatchCable| {
            let n = cable.strands.len() as u8;
            let other = |s: &u8| (n - 1).saturating_sub(*s);
            let (column, top) = self.loops_of(cable)?.last().copied()?;
            let tops = self.stitch_at(cable.row, column)?.stitch.tops();
            Some(PatchCable {
                row: cable.row,
                column: last.wrapping_sub(column),
                top: tops - 1 - top,
                strands: cable.strands.iter().rev().copied().collect(),
                order: cable.order.iter().rev().map(other).collect(),
                front: cable.front.iter().map(other).collect(),
            })
        };
        Self {
            rows: self.rows.iter().map(row).collect(),
            cables: self.cables.iter().filter_map(cable).collect(),
        }
    }

    /// Puts the patch on a fabric, its lowest stitch on the left on `at`. Cables between the stitches it covers are
    /// cleared, its own are set. All ids survive.
    ///
    /// # Errors
    /// [`PatchError`] with the face that does not fit; nothing is changed then.
    pub fn paste(&self, stitches: &mut StitchMesh, at: FaceId) -> Result<(), PatchError> {
        if at.index() >= stitches.mesh().face_count() {
            return Err(PatchError::NoFace(at));
        }
        if self.rows.iter().all(|r| r.stitches.is_empty()) {
            return Err(PatchError::Empty);
        }
        let mut after = stitches.clone();
        let mut faces: HashMap<(usize, i32), FaceId> = HashMap::new();
        let mut anchor = at;
        for (r, row) in self.rows.iter().enumerate() {
            if r > 0 {
                let ends = PatchError::Ends { face: anchor, way: "above" };
                anchor = stitches.above(anchor).next().ok_or(ends)?;
            }
            let line = Line::through(stitches, anchor);
            if line.row.closed && line.row.faces.len() < row.stitches.len() {
                let (has, needs) = (line.row.faces.len(), row.stitches.len());
                return Err(PatchError::Laps { face: anchor, has, needs });
            }
            for (i, stitch) in (0..).zip(&row.stitches) {
                let Some(PatchStitch { stitch, color, wrapping }) = stitch else { continue };
                let column = row.begins.wrapping_add(i);
                let face = line.at(column)?;
                let has = stitches.stitch(face);
                if (has.bottoms(), has.tops()) != (stitch.bottoms(), stitch.tops()) {
                    let [has, stitch] = [has, stitch].map(ToString::to_string);
                    return Err(PatchError::Shape { face, has, stitch });
                }
                after.set_stitch(face, stitch.clone())?;
                after.set_dye(face, *color)?;
                after.set_wrapping(face, *wrapping)?;
                faces.insert((r, column), face);
            }
        }
        let covered: HashSet<FaceId> = faces.values().copied().collect();
        let inside =
            |c: &Cable| edges(stitches, c).all(|h| between(stitches, h).is_some_and(|f| covers(&covered, f)));
        after.marks_mut().cables.retain(|c| !inside(c));
        for (i, cable) in self.cables.iter().enumerate() {
            let path = self.path(stitches, cable, &faces).ok_or(PatchError::NoCable(i))?;
            let PatchCable { strands, order, front, .. } = cable.clone();
            after.set_cable(Cable { path, strands, order, front })?;
        }
        *stitches = after;
        Ok(())
    }

    fn stitch_at(&self, row: usize, column: i32) -> Option<&PatchStitch> {
        let row = self.rows.get(row)?;
        let i = usize::try_from(column.checked_sub(row.begins)?).ok()?;
        row.stitches.get(i)?.as_ref()
    }

    /// Column of the stitch and turn among its tops, for each loop of a cable.
    fn loops_of(&self, cable: &PatchCable) -> Option<Vec<(i32, usize)>> {
        let mut loops = Vec::new();
        let (mut column, mut top) = (cable.column, cable.top);
        for _ in 0..cable.strands.iter().map(|n| usize::from(*n)).sum() {
            while top >= self.stitch_at(cable.row, column)?.stitch.tops() {
                (column, top) = (column + 1, 0);
            }
            loops.push((column, top));
            top += 1;
        }
        Some(loops)
    }

    /// Vertices along a cable, where the patch lies on `faces`.
    fn path(
        &self,
        stitches: &StitchMesh,
        cable: &PatchCable,
        faces: &HashMap<(usize, i32), FaceId>,
    ) -> Option<Vec<VertexId>> {
        let mesh = stitches.mesh();
        let mut path = Vec::new();
        for (column, top) in self.loops_of(cable)? {
            let h = stitches.tops(*faces.get(&(cable.row, column))?).nth(top)?;
            if path.last().is_some_and(|v| *v != mesh.tip(h)) {
                return None;
            }
            if path.is_empty() {
                path.push(mesh.tip(h));
            }
            path.push(mesh.origin(h));
        }
        Some(path)
    }
}

/// The selected face of a row that has none to its left.
fn leftmost(row: &Row, selected: &HashSet<FaceId>) -> Option<FaceId> {
    let n = row.faces.len();
    let is_in = |i: usize| selected.contains(&row.faces[i % n]);
    let first = (0..n).find(|i| is_in(*i))?;
    let begins = |i: &usize| is_in(*i) && !is_in(i + n - 1);
    let i = if row.closed { (0..n).find(begins).unwrap_or(first) } else { first };
    Some(row.faces[i])
}

/// Half-edges of the stitches below a cable, left to right.
fn edges<'a>(stitches: &'a StitchMesh, cable: &'a Cable) -> impl Iterator<Item = HalfEdgeId> + 'a {
    cable.path.windows(2).filter_map(|w| stitches.mesh().half_edge_between(w[1], w[0]))
}

/// The stitches below and above a top half-edge.
fn between(stitches: &StitchMesh, h: HalfEdgeId) -> Option<[FaceId; 2]> {
    let mesh = stitches.mesh();
    Some([mesh.face(h), mesh.face_across(h)?])
}

fn covers(faces: &HashSet<FaceId>, both: [FaceId; 2]) -> bool {
    both.iter().all(|f| faces.contains(f))
}

/// A cable as the patch keeps it, if it lies between copied stitches.
fn copied(
    stitches: &StitchMesh,
    cable: &Cable,
    places: &HashMap<FaceId, (usize, i32)>,
) -> Option<PatchCable> {
    let mesh = stitches.mesh();
    for h in edges(stitches, cable) {
        let [below, above] = between(stitches, h)?;
        if places.get(&above)?.0 != places.get(&below)?.0 + 1 {
            return None;
        }
    }
    let first = edges(stitches, cable).next()?;
    let face = mesh.face(first);
    let (row, column) = *places.get(&face)?;
    let top = stitches.tops(face).position(|h| h == first)?;
    let Cable { strands, order, front, .. } = cable.clone();
    Some(PatchCable { row, column, top, strands, order, front })
}
