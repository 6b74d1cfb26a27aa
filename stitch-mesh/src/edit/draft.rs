//! A stitch mesh taken apart, to be changed and put together again.

use super::reshape::mend;
use super::{EditError, Edited, MOST_BOTTOMS, Survivors};
use crate::dye::Dye;
use crate::ids::{EdgeId, FaceId, HalfEdgeId, VertexId};
use crate::marks::Marks;
use crate::mesh::PolygonMesh;
use crate::reface::{Merged, Outline, Refacing};
use crate::seam::sorted;
use crate::stitch::Stitch;
use crate::stitch_mesh::{Place, StitchMesh};
use crate::wrapping::Wrapping;
use glam::DVec3;
use std::sync::Arc;

/// The parts of a stitch mesh.
pub struct Draft<'a> {
    before: &'a PolygonMesh,
    pub positions: Vec<DVec3>,
    pub refacing: Refacing,
    pub stitches: Vec<Stitch>,
    pub dyes: Arc<Vec<Dye>>,
    pub wrappings: Arc<Vec<Wrapping>>,
    pub places: Arc<Vec<Option<Place>>>,
    pub marks: Marks,
    /// Faces whose stitches have gained or lost loops, by their numbers now.
    changed: Vec<FaceId>,
    survivors: Survivors,
}

impl<'a> Draft<'a> {
    pub fn of(stitches: &'a StitchMesh) -> Self {
        let mesh = stitches.mesh();
        let survivors = || Survivors {
            vertices: (0..mesh.vertex_count()).map(|v| Some(VertexId::new(v))).collect(),
            faces: mesh.faces().map(Some).collect(),
        };
        // Of a garment these are some megabytes.
        let (of_stitches, (positions, survivors)) =
            rayon::join(|| stitches.stitches().to_vec(), || (mesh.positions().to_vec(), survivors()));
        Self {
            before: mesh,
            positions,
            refacing: Refacing::default(),
            stitches: of_stitches,
            dyes: stitches.dyes.clone(),
            wrappings: stitches.wrappings.clone(),
            places: stitches.places.clone(),
            marks: stitches.marks().clone(),
            changed: Vec::new(),
            survivors,
        }
    }

    /// The stitch of a face, to be changed.
    pub fn stitch(&mut self, face: FaceId) -> &mut Stitch {
        self.changed.push(face);
        &mut self.stitches[face.index()]
    }

    /// The vertices of a face, to be changed.
    pub fn outline(&mut self, face: FaceId) -> &mut Outline {
        let before = self.before;
        let outlines = &mut self.refacing.outlines;
        outlines.entry(face).or_insert_with(|| before.face_vertices(face).map(|v| v.0).collect())
    }

    /// Merges vertex `b` into `a`, which goes to `position`. The later number goes; faces lose the edge between them.
    pub fn merge_vertices(&mut self, a: VertexId, b: VertexId, position: DVec3) {
        let merged = Merged { stays: a.min(b), goes: a.max(b) };
        self.positions[merged.stays.index()] = position;
        self.positions.remove(merged.goes.index());
        for face in [a, b].into_iter().flat_map(|v| self.before.outgoing(v)).map(|h| self.before.face(h)) {
            self.outline(face);
        }
        for outline in self.refacing.outlines.values_mut() {
            outline.iter_mut().for_each(|v| *v = merged.now(VertexId(*v)).0);
            // The edge never closes the list of a face: that is the left wale edge.
            outline.dedup();
        }
        self.refacing.merged = Some(merged);
        let now = |v: VertexId| merged.now(v);
        self.survivors.vertices.iter_mut().for_each(|v| *v = v.map(now));
        for cable in &mut self.marks.cables {
            cable.path.iter_mut().for_each(|v| *v = now(*v));
        }
        for seam in &mut self.marks.seams {
            seam.a.iter_mut().chain(&mut seam.b).for_each(|v| *v = now(*v));
        }
        let live = self.marks.live.iter().map(|e| sorted(e.map(now)));
        self.marks.live = live.filter(|[a, b]| a != b).collect();
    }

    /// Takes a face out that has been merged into another.
    pub fn drop_face(&mut self, goes: FaceId, into: FaceId) {
        let now = |f: FaceId| {
            let f = if f == goes { into } else { f };
            if f > goes { FaceId(f.0 - 1) } else { f }
        };
        let i = goes.index();
        self.refacing.gone = Some(goes);
        self.refacing.outlines.remove(&goes);
        let outlines = std::mem::take(&mut self.refacing.outlines);
        self.refacing.outlines = outlines.into_iter().map(|(f, outline)| (now(f), outline)).collect();
        self.stitches.remove(i);
        Arc::make_mut(&mut self.dyes).remove(i);
        Arc::make_mut(&mut self.wrappings).remove(i);
        Arc::make_mut(&mut self.places).remove(i);
        self.changed.iter_mut().for_each(|f| *f = now(*f));
        self.survivors.faces.iter_mut().for_each(|f| *f = f.map(now));
    }

    /// Puts everything together again.
    pub fn finish(self) -> Result<Edited, EditError> {
        let Self { before, positions, refacing, mut stitches, .. } = self;
        let Self { dyes, wrappings, places, marks, changed, survivors, .. } = self;
        let mesh = before.refaced(positions, &refacing)?;
        for face in changed {
            let stitch = &mut stitches[face.index()];
            if stitch.bottoms() > MOST_BOTTOMS {
                return Err(EditError::TooManyBottoms(face));
            }
            let below = mesh.face_half_edges(face).take(stitch.bottoms());
            let borne = below.into_iter().any(|h| mesh.twin(h).is_some());
            mend(stitch, borne);
        }
        let others = refacing.outlines.into_keys();
        let stitches = StitchMesh::refaced(mesh, stitches, others)?.with(dyes, wrappings, places, marks)?;
        Ok((stitches, survivors))
    }
}

/// The edge between two vertices.
pub fn find(stitches: &StitchMesh, [a, b]: [VertexId; 2]) -> Result<EdgeId, EditError> {
    stitches.mesh().edge_between(a, b).ok_or(EditError::NoEdge(a, b))
}

/// The sides of a course edge that no cable and no seam holds.
pub fn free_course(stitches: &StitchMesh, edge: [VertexId; 2]) -> Result<Vec<HalfEdgeId>, EditError> {
    let (first, twin) = stitches.mesh().edge_sides(find(stitches, edge)?);
    let [a, b] = edge;
    if stitches.is_wale(first) {
        return Err(EditError::NotCourse(a, b));
    }
    if stitches.cables().iter().any(|c| c.covers(a, b)) {
        return Err(EditError::InCable(a, b));
    }
    if stitches.seams().iter().any(|s| s.covers(a, b)) {
        return Err(EditError::InSeam(a, b));
    }
    Ok([Some(first), twin].into_iter().flatten().collect())
}

/// The half-edge of a wale edge that is the right side of the stitch on its left, and its twin.
pub fn inner_wale(stitches: &StitchMesh, edge: [VertexId; 2]) -> Result<(HalfEdgeId, HalfEdgeId), EditError> {
    let (first, twin) = stitches.mesh().edge_sides(find(stitches, edge)?);
    let [a, b] = edge;
    if !stitches.is_wale(first) {
        return Err(EditError::NotWale(a, b));
    }
    let twin = twin.ok_or(EditError::RowEnd(a, b))?;
    let is_right = first == stitches.right(stitches.mesh().face(first));
    Ok(if is_right { (first, twin) } else { (twin, first) })
}

/// The turn of a course half-edge among the bottoms or tops of its face, from the left.
pub fn turn(stitches: &StitchMesh, h: HalfEdgeId) -> usize {
    let face = stitches.mesh().face(h);
    if stitches.is_bottom(h) {
        h.index() - stitches.mesh().first_half_edge(face).index()
    } else {
        stitches.left(face).index() - 1 - h.index()
    }
}
