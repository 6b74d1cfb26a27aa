//! What a stitch mesh keeps when its input is cut into stitches again.
//!
//! A stitch is the same stitch if it lies in the same [`Place`] of the input and joins as many loops to as many. Edges are
//! found again by the stitch that they belong to and their turn in it.

use crate::cable::Cable;
use crate::ids::{HalfEdgeId, VertexId};
use crate::seam::Seam;
use crate::stitch_mesh::{Place, StitchMesh};
use std::collections::HashMap;
use std::sync::Arc;

impl StitchMesh {
    /// Takes over stitches, colours, wrappings and marks from an earlier stitch mesh of the same input. Cables, seams and live
    /// edges come along if all their edges are found again.
    pub fn keep_from(&mut self, old: &Self) {
        let mut at: HashMap<Place, _> = HashMap::new();
        for (face, place) in old.mesh().faces().zip(old.places()) {
            if let Some(place) = place {
                at.entry(*place).or_insert(face);
            }
        }
        let mut now = vec![None; old.mesh().face_count()];
        for face in self.mesh().faces() {
            let was = self.places()[face.index()].and_then(|p| at.get(&p)).copied();
            let Some(was) = was else { continue };
            // A stitch with other numbers of loops, or one that would hold nothing here, stays what it is now.
            if self.set_stitch(face, old.stitch(was).clone()).is_ok() {
                Arc::make_mut(&mut self.dyes)[face.index()] = old.dyes()[was.index()];
                Arc::make_mut(&mut self.wrappings)[face.index()] = old.wrappings()[was.index()];
                now[was.index()] = Some(face);
            }
        }
        let again = |h: HalfEdgeId| {
            let turn = h.index() - old.mesh().first_half_edge(old.mesh().face(h)).index();
            let face = now[old.mesh().face(h).index()]?;
            Some(HalfEdgeId::new(self.mesh().first_half_edge(face).index() + turn))
        };
        // The ends of an edge between two vertices, as it lies now.
        let ends = |a: VertexId, b: VertexId| {
            let forward = old.mesh().half_edge_between(a, b).and_then(again);
            let backward = || old.mesh().half_edge_between(b, a).and_then(again);
            let mesh = self.mesh();
            match forward {
                Some(h) => Some([mesh.origin(h), mesh.tip(h)]),
                None => backward().map(|h| [mesh.tip(h), mesh.origin(h)]),
            }
        };
        let path = |path: &[VertexId]| {
            let edges: Vec<[VertexId; 2]> =
                path.windows(2).map(|w| ends(w[0], w[1])).collect::<Option<_>>()?;
            let joined = edges.windows(2).all(|w| w[0][1] == w[1][0]);
            let first = edges.first().filter(|_| joined)?[0];
            Some(std::iter::once(first).chain(edges.iter().map(|e| e[1])).collect::<Vec<VertexId>>())
        };
        let marks = old.marks();
        let cable = |c: &Cable| Some(Cable { path: path(&c.path)?, ..c.clone() });
        let cables: Vec<Cable> = marks.cables.iter().filter_map(cable).collect();
        let seam = |s: &Seam| Some(Seam { a: path(&s.a)?, b: path(&s.b)? });
        let seams: Vec<Seam> = marks.seams.iter().filter_map(seam).collect();
        let live: Vec<[VertexId; 2]> = marks.live.iter().filter_map(|[a, b]| ends(*a, *b)).collect();
        // What does not fit any more, as a cable in front of an edge that is border now, is left out.
        cables.into_iter().for_each(|c| drop(self.set_cable(c)));
        seams.into_iter().for_each(|s| drop(self.sew(s)));
        live.into_iter().for_each(|e| drop(self.set_live(e, true)));
        self.set_spiral(marks.spiral);
    }
}
