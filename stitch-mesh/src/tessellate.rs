//! Tessellation: labelled mesh → stitch mesh (stage 2 of the flow; Yuksel et al. §5.2, Fig. 12).
//!
//! Every edge of the input gets a count: stitches along a course edge, rows along a wale edge. All wale edges of a row have
//! the same count. A face with B stitches below and T above is cut into its rows; row boundary i of w has B + (T − B) i/w
//! stitches, rounded; where two boundaries differ the row gets increases or decreases next to its wale edges, all along the
//! marked one if one of them is marked, else in turn on the left and on the right. Vertices lie evenly on the edges and at mean
//! value coordinates inside.
//!
//! Unlike the paper's, a side of a face may have no edges at all (a triangle whose tip is the top): its last row has one
//! stitch that gathers what is left, or conjures its loops out of yarn-overs where the tip is below.

use crate::edge_counts::{EdgeCounts, FaceCounts};
use crate::ids::{FaceId, VertexId};
use crate::label::{Incomplete, LabelledMesh, Wales};
use crate::mean_value::mean_value_weights;
use crate::mesh::{MeshError, PolygonMesh};
use crate::stitch::Stitch;
use crate::stitch_mesh::{Place, StitchMesh, StitchMeshError};
use glam::{DVec2, DVec3};
use std::sync::Arc;

/// Why a labelled mesh cannot be tessellated.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum TessellateError {
    /// Faces without a clear row.
    #[error(transparent)]
    Labels(#[from] Incomplete),
    /// Counts that do not fit the mesh.
    #[error("{given} edge counts for {edges} edges")]
    CountLength {
        /// Counts given.
        given: usize,
        /// Edges there are.
        edges: usize,
    },
    /// The two wale edges of a face have different counts.
    #[error(
        "the wale edges of face {face} have {left} and {right} rows; a row of faces needs the same everywhere"
    )]
    UnequalWales {
        /// The face.
        face: FaceId,
        /// Rows on the left.
        left: u32,
        /// Rows on the right.
        right: u32,
    },
    /// The tessellated faces do not make a mesh.
    #[error("the stitches do not make a mesh: {0}")]
    Mesh(#[from] MeshError),
    /// Nor a stitch mesh.
    #[error("the stitches do not make a stitch mesh: {0}")]
    StitchMesh(#[from] StitchMeshError),
}

/// Cuts every face into stitches. Faces come out row by row within each input face, in the order of the input faces.
///
/// # Errors
/// [`TessellateError`].
pub fn tessellate(labelled: &LabelledMesh, counts: &EdgeCounts) -> Result<StitchMesh, TessellateError> {
    labelled.check_complete()?;
    let mesh = labelled.mesh();
    if counts.counts.len() != mesh.edge_count() {
        return Err(TessellateError::CountLength { given: counts.counts.len(), edges: mesh.edge_count() });
    }
    let mut out = Builder {
        labelled,
        counts,
        positions: mesh.positions().to_vec(),
        on_edge: Vec::new(),
        faces: Vec::new(),
        stitches: Vec::new(),
        places: Vec::new(),
    };
    out.place_edge_vertices();
    for face in mesh.faces() {
        out.cut(face)?;
    }
    let mesh = PolygonMesh::new(out.positions, &out.faces)?;
    let mut stitches = StitchMesh::new(mesh, out.stitches)?;
    stitches.places = Arc::new(out.places.into_iter().map(Some).collect());
    Ok(stitches)
}

struct Builder<'a> {
    labelled: &'a LabelledMesh,
    counts: &'a EdgeCounts,
    positions: Vec<DVec3>,
    /// Vertices along every input edge in the direction of its first half-edge, both ends included.
    on_edge: Vec<Vec<u32>>,
    faces: Vec<Vec<u32>>,
    stitches: Vec<Stitch>,
    places: Vec<Place>,
}

impl Builder<'_> {
    fn place_edge_vertices(&mut self) {
        let mesh = self.labelled.mesh();
        for edge in mesh.edges() {
            let [a, b] = mesh.edge_ends(edge);
            let n = self.counts.counts[edge.index()].max(1);
            let mut vertices = vec![a.0];
            for i in 1..n {
                let t = f64::from(i) / f64::from(n);
                vertices.push(self.positions.len() as u32);
                self.positions.push(mesh.position(a).lerp(mesh.position(b), t));
            }
            vertices.push(b.0);
            self.on_edge.push(vertices);
        }
    }

    /// Vertices along a half-edge, from its origin to its tip.
    fn along(&self, h: crate::ids::HalfEdgeId) -> Vec<u32> {
        let mesh = self.labelled.mesh();
        let edge = mesh.edge(h);
        let mut vertices = self.on_edge[edge.index()].clone();
        if mesh.edge_sides(edge).0 != h {
            vertices.reverse();
        }
        vertices
    }

    /// Vertices along a chain of half-edges; without any, the one vertex where the wale edges meet.
    fn along_chain(&self, chain: &[crate::ids::HalfEdgeId], tip: VertexId) -> Vec<u32> {
        let mut vertices: Vec<u32> = vec![];
        for h in chain {
            vertices.pop();
            vertices.extend(self.along(*h));
        }
        if vertices.is_empty() { vec![tip.0] } else { vertices }
    }

    fn cut(&mut self, face: FaceId) -> Result<(), TessellateError> {
        let mesh = self.labelled.mesh();
        let Some(at_face) = FaceCounts::of(self.labelled, self.counts, face) else { return Ok(()) };
        let FaceCounts { wales, rows, .. } = at_face;
        let left_rows = self.counts.counts[mesh.edge(wales.left).index()];
        if left_rows != rows {
            return Err(TessellateError::UnequalWales { face, left: left_rows, right: rows });
        }
        let right = self.along(wales.right);
        let mut left = self.along(wales.left);
        left.reverse();
        let bottom = self.along_chain(&self.labelled.bottoms(wales), mesh.tip(wales.left));
        let mut top = self.along_chain(&self.labelled.tops(wales), mesh.tip(wales.right));
        top.reverse();

        let reference = self.reference(wales);
        let corners: Vec<DVec3> = self.corners(wales);
        // Of the flat outline: a side without edges is a point.
        let [narrow, wide] = [&bottom, &top].map(|side| if side.len() > 1 { 1.0 } else { 0.0 });
        let mut below = bottom;
        for i in 1..=rows {
            let above = if i == rows {
                top.clone()
            } else {
                let n = at_face.at(i);
                let up = f64::from(i) / f64::from(rows);
                let width = narrow + (wide - narrow) * up;
                let mut boundary = vec![left[i as usize]];
                for j in 1..n {
                    let point = DVec2::new(0.5 + width * (f64::from(j) / f64::from(n) - 0.5), up);
                    let weights = mean_value_weights(&reference, point);
                    boundary.push(self.positions.len() as u32);
                    self.positions.push(corners.iter().zip(&weights).map(|(c, w)| *c * *w).sum());
                }
                boundary.push(right[i as usize]);
                boundary
            };
            self.row(wales, i, &below, &above);
            below = above;
        }
        Ok(())
    }

    /// The flat outline of a face: bottoms and tops share their side by count.
    fn reference(&self, wales: Wales) -> Vec<DVec2> {
        let mesh = self.labelled.mesh();
        let side = |chain: &[crate::ids::HalfEdgeId], t: f64, forward: bool| {
            let count = |h| f64::from(self.counts.counts[mesh.edge(h).index()]);
            let total: f64 = chain.iter().map(|h| count(*h)).sum();
            let mut s = 0.0;
            let mut points = vec![DVec2::new(if chain.is_empty() { 0.5 } else { 0.0 }, t)];
            for h in chain {
                s += count(*h) / total;
                points.push(DVec2::new(s, t));
            }
            if !forward {
                points.iter_mut().for_each(|p| p.x = 1.0 - p.x);
            }
            points
        };
        let mut outline = side(&self.labelled.bottoms(wales), 0.0, true);
        outline.extend(side(&self.labelled.tops(wales), 1.0, false));
        outline
    }

    /// Corners of a face in the order of [`Self::reference`].
    fn corners(&self, wales: Wales) -> Vec<DVec3> {
        let mesh = self.labelled.mesh();
        let mut corners = Vec::new();
        for (from, chain) in
            [(wales.left, self.labelled.bottoms(wales)), (wales.right, self.labelled.tops(wales))]
        {
            corners.push(mesh.position(mesh.tip(from)));
            corners.extend(chain.iter().map(|h| mesh.position(mesh.tip(*h))));
        }
        corners
    }

    /// One row of stitches, counted from 1, between two boundaries (vertices left to right).
    fn row(&mut self, wales: Wales, row: u32, below: &[u32], above: &[u32]) {
        let (a, b) = (below.len() - 1, above.len() - 1);
        let stitches = a.min(b).max(1);
        let mesh = self.labelled.mesh();
        let marked = |h| self.counts.marked.contains(&mesh.edge(h));
        let side = match (marked(wales.left), marked(wales.right)) {
            (true, false) => Side::Left,
            (false, true) => Side::Right,
            _ => Side::Both { first_left: row % 2 == 1 },
        };
        let bottoms = shares(a, stitches, side);
        let tops = shares(b, stitches, side);
        let (mut p, mut q) = (0, 0);
        for i in 0..stitches {
            let (nb, nt) = (bottoms[i], tops[i]);
            let mut face = below[p..=p + nb].to_vec();
            face.extend(above[q..=q + nt].iter().rev());
            face.dedup(); // a side without edges is a single vertex, shared by both wale edges
            self.faces.push(face);
            let in_left_half = 2 * i < stitches;
            self.stitches.push(Stitch::default_for(nb, nt, in_left_half));
            self.places.push(Place { face: mesh.face(wales.left), row: row - 1, column: i as u32 });
            (p, q) = (p + nb, q + nt);
        }
    }
}

#[derive(Clone, Copy)]
enum Side {
    Left,
    Right,
    Both { first_left: bool },
}

/// Shares `edges` among `stitches` faces, one each and the rest from the wale edges inwards.
fn shares(edges: usize, stitches: usize, side: Side) -> Vec<usize> {
    if edges < stitches {
        return vec![edges; stitches]; // a side without edges: one stitch, no edge
    }
    let mut shares = vec![1; stitches];
    let place = |i: usize| match side {
        Side::Left => i,
        Side::Right => stitches - 1 - i,
        Side::Both { first_left } => {
            if i.is_multiple_of(2) == first_left {
                i / 2
            } else {
                stitches - 1 - i / 2
            }
        }
    };
    (0..edges - stitches).for_each(|i| shares[place(i % stitches)] += 1);
    shares
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::grid;
    use crate::ids::EdgeId;
    use proptest::prelude::*;

    fn counted(labelled: &LabelledMesh, bottom: u32, top: u32, rows: u32) -> EdgeCounts {
        let mesh = labelled.mesh();
        let mut counts = vec![rows; mesh.edge_count()];
        for row in labelled.rows() {
            for w in row.faces.iter().filter_map(|f| labelled.wales(*f)) {
                labelled.bottoms(w).iter().for_each(|h| counts[mesh.edge(*h).index()] = bottom);
                labelled.tops(w).iter().for_each(|h| counts[mesh.edge(*h).index()] = top);
            }
        }
        EdgeCounts { counts, marked: vec![] }
    }

    proptest! {
        #[test]
        fn any_counts_make_a_valid_stitch_mesh(bottom in 1u32..9, top in 1u32..9, rows in 1u32..7, wide in 1usize..4) {
            let labelled = grid(wide, 1);
            let stitches = tessellate(&labelled, &counted(&labelled, bottom, top, rows)).unwrap();
            let rows_out = stitches.rows();
            prop_assert_eq!(rows_out.len(), rows as usize);
            let tops = |r: usize| rows_out[r].faces.iter().map(|f| stitches.stitch(*f).tops()).sum::<usize>();
            let bottoms = |r: usize| rows_out[r].faces.iter().map(|f| stitches.stitch(*f).bottoms()).sum::<usize>();
            prop_assert_eq!(bottoms(0), wide * bottom as usize);
            prop_assert_eq!(tops(rows as usize - 1), wide * top as usize);
            for r in 1..rows as usize {
                prop_assert_eq!(tops(r - 1), bottoms(r));
            }
        }
    }

    #[test]
    fn increases_lie_along_the_marked_edge() {
        let labelled = grid(1, 1);
        let mut counts = counted(&labelled, 6, 10, 4);
        let wales = labelled.wales(FaceId(0)).unwrap();
        counts.marked = vec![labelled.mesh().edge(wales.right)];
        let stitches = tessellate(&labelled, &counts).unwrap();
        for row in stitches.rows() {
            let last = *row.faces.last().unwrap();
            assert_eq!(stitches.stitch(last).to_string(), "kp");
            assert!(row.faces[..row.faces.len() - 1].iter().all(|f| stitches.stitch(*f).to_string() == "k"));
        }
    }

    #[test]
    fn a_triangle_gathers_at_its_tip() {
        let positions = [DVec3::ZERO, DVec3::X, DVec3::new(0.2, 1.0, 0.0)].to_vec();
        let mut labelled = LabelledMesh::new(PolygonMesh::new(positions, &[vec![0, 1, 2]]).unwrap());
        let base = labelled.mesh().edge_between(VertexId(0), VertexId(1)).unwrap();
        labelled.fill_from_border(base).unwrap();
        let stitches = tessellate(&labelled, &counted(&labelled, 6, 1, 4)).unwrap();
        let last = stitches.rows().pop().unwrap();
        assert_eq!(last.faces.len(), 1);
        assert_eq!(stitches.stitch(last.faces[0]).tops(), 0);
        // Rows of even stitches that go from one of its sides to the other.
        for row in stitches.rows() {
            let widths = row.faces.iter().flat_map(|f| stitches.bottoms(*f));
            let widths: Vec<f64> =
                widths.map(|h| stitches.mesh().edge_length(stitches.mesh().edge(h))).collect();
            assert!(widths.iter().all(|w| (w - widths[0]).abs() < 1e-9), "{widths:?}");
        }
        let mut fronts = stitches.mesh().faces().map(|f| stitches.mesh().face_area_vector(f).z);
        assert!(fronts.all(|area| area > 0.0), "no stitch is folded");
    }

    #[test]
    fn refuses_what_it_cannot_cut() {
        let mut labelled = grid(1, 1);
        let counts = counted(&labelled, 2, 2, 2);
        let short = EdgeCounts { counts: vec![1], marked: vec![] };
        assert!(matches!(tessellate(&labelled, &short), Err(TessellateError::CountLength { .. })));
        labelled.set_label(EdgeId(0), None);
        assert!(matches!(tessellate(&labelled, &counts), Err(TessellateError::Labels { .. })));
    }
}
