//! The springs of a stitch mesh: which vertices they join (Yuksel et al. §6.1 and Fig. 15).
//!
//! - Every edge is a stretch spring, and so are both diagonals of every sub-quad.
//! - Every corner of every sub-quad is a shear spring.
//! - Every pair of wale edges that follow each other from row to row is a strut. Where rows meet top to top or bottom to
//!   bottom they follow each other as well. Where several wale edges of one row end in a point (the tip of a triangle),
//!   none of them goes on straight, and there is no strut.
//!
//! A face with B bottoms and T tops has max(B, T) sub-quads, each with a bottom for its lower and a top for its upper side,
//! shared out evenly from the left; a face without bottoms or without tops has none.

use super::params::RestLengths;
use stitch_mesh::ids::{FaceId, HalfEdgeId};
use stitch_mesh::stitch_mesh::StitchMesh;

/// Two vertices and their rest length [stitches].
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Spring {
    pub ends: [u32; 2],
    pub rest: f64,
}

/// Springs, corners (i, j, k with the corner in the middle) and struts (likewise).
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Elements {
    pub springs: Vec<Spring>,
    pub corners: Vec<[u32; 3]>,
    pub struts: Vec<[u32; 3]>,
}

impl Elements {
    /// All springs of a stitch mesh, with lengths in units of `rest.unit()`.
    pub fn new(stitches: &StitchMesh, rest: &RestLengths) -> Self {
        let mesh = stitches.mesh();
        let (course, wale) = (rest.course / rest.unit(), rest.wale / rest.unit());
        let mut elements = Self::default();
        for edge in mesh.edges() {
            let rest = if stitches.is_wale(mesh.edge_sides(edge).0) { wale } else { course };
            elements.springs.push(Spring { ends: mesh.edge_ends(edge).map(|v| v.0), rest });
        }
        let diagonal = course.hypot(wale);
        for [a, b, c, d] in mesh.faces().flat_map(|f| sub_quads(stitches, f)) {
            elements.springs.extend([[a, c], [b, d]].map(|ends| Spring { ends, rest: diagonal }));
            elements.corners.extend([[d, a, b], [a, b, c], [b, c, d], [c, d, a]]);
        }
        elements.struts = struts(stitches);
        elements
    }
}

/// Sub-quads of a face: lower left, lower right, upper right, upper left.
pub(super) fn sub_quads(stitches: &StitchMesh, face: FaceId) -> Vec<[u32; 4]> {
    let mesh = stitches.mesh();
    let bottoms: Vec<HalfEdgeId> = stitches.bottoms(face).collect();
    let tops: Vec<HalfEdgeId> = stitches.tops(face).collect();
    if bottoms.is_empty() || tops.is_empty() {
        return Vec::new();
    }
    let count = bottoms.len().max(tops.len());
    let quad = |i: usize| {
        let (bottom, top) = (bottoms[i * bottoms.len() / count], tops[i * tops.len() / count]);
        [mesh.origin(bottom), mesh.tip(bottom), mesh.origin(top), mesh.tip(top)].map(|v| v.0)
    };
    (0..count).map(quad).collect()
}

fn struts(stitches: &StitchMesh) -> Vec<[u32; 3]> {
    let mesh = stitches.mesh();
    let row = rows(stitches);
    // For each vertex, its wale edges: the other end, and the row.
    let mut wales: Vec<Vec<(u32, u32)>> = vec![Vec::new(); mesh.vertex_count()];
    for edge in mesh.edges() {
        let side = mesh.edge_sides(edge).0;
        if stitches.is_wale(side) {
            let [a, b] = mesh.edge_ends(edge);
            let row = row[mesh.face(side).index()];
            wales[a.index()].push((b.0, row));
            wales[b.index()].push((a.0, row));
        }
    }
    let middle = |(j, wales): (usize, &Vec<(u32, u32)>)| match wales[..] {
        [(i, below), (k, above)] if below != above => Some([i, j as u32, k]),
        _ => None,
    };
    wales.iter().enumerate().filter_map(middle).collect()
}

/// A number for the row of every face, [face_count].
fn rows(stitches: &StitchMesh) -> Vec<u32> {
    const NONE: u32 = u32::MAX;
    let mesh = stitches.mesh();
    let mut row = vec![NONE; mesh.face_count()];
    for (number, start) in mesh.faces().enumerate() {
        if row[start.index()] != NONE {
            continue;
        }
        row[start.index()] = number as u32;
        for side in [StitchMesh::right, StitchMesh::left] {
            let mut at = mesh.face_across(side(stitches, start));
            while let Some(face) = at.filter(|f| row[f.index()] == NONE) {
                row[face.index()] = number as u32;
                at = mesh.face_across(side(stitches, face));
            }
        }
    }
    row
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;
    use stitch_mesh::edge_counts::StitchSize;
    use stitch_mesh::mesh::PolygonMesh;
    use stitch_mesh::pieces::{rectangle, tube};
    use stitch_mesh::stitch::Stitch;

    const REST: RestLengths = RestLengths { course: 4e-3, wale: 3e-3 };

    #[test]
    fn plain_fabric_has_its_springs() {
        let piece = rectangle(5, 4, StitchSize::of_width(4e-3)).unwrap();
        let elements = Elements::new(&piece, &REST);
        assert_eq!(elements.springs.len(), (5 * 5 + 6 * 4) + 2 * 20);
        assert_eq!(elements.corners.len(), 4 * 20);
        assert_eq!(elements.struts.len(), 6 * 3, "three inner boundaries of rows, six wales");
        let round = Elements::new(&tube(7, 4, StitchSize::of_width(4e-3)).unwrap(), &REST);
        assert_eq!(round.struts.len(), 7 * 3);
    }

    #[test]
    fn every_spring_of_a_piece_at_rest_is_at_rest() {
        let piece = rectangle(3, 3, StitchSize { width: REST.course, height: REST.wale }).unwrap();
        let at = |v: u32| piece.mesh().positions()[v as usize] / REST.unit();
        for Spring { ends: [a, b], rest } in Elements::new(&piece, &REST).springs {
            assert!((at(a).distance(at(b)) - rest).abs() < 1e-12);
        }
    }

    /// One face with `stitch` on a half circle of vertices, bottoms first.
    fn single(stitch: &str) -> StitchMesh {
        let stitch: Stitch = stitch.parse().unwrap();
        let count = stitch.bottoms() + stitch.tops() + 2;
        let at = |i: usize| DVec3::new((i as f64).cos(), (i as f64).sin(), 0.0);
        let mesh =
            PolygonMesh::new((0..count).map(at).collect(), &[(0..count as u32).collect::<Vec<_>>()]).unwrap();
        StitchMesh::new(mesh, vec![stitch]).unwrap()
    }

    #[test]
    fn sub_quads_join_loops_with_those_they_are_made_of() {
        // Figure 15: an increase to three has one bottom, 0–1, and three tops, from 2 on the right to 5 on the left.
        assert_eq!(sub_quads(&single("kyk"), FaceId(0)), [[0, 1, 4, 5], [0, 1, 3, 4], [0, 1, 2, 3]]);
        assert_eq!(sub_quads(&single("d12k"), FaceId(0)), [[0, 1, 3, 4], [1, 2, 3, 4]]);
        assert_eq!(sub_quads(&single("k"), FaceId(0)), [[0, 1, 2, 3]]);
        assert!(sub_quads(&single("d1"), FaceId(0)).is_empty(), "a triangle has none");
    }
}
