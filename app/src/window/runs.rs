//! Selected edges as lines from vertex to vertex: what a cable lies on and what a seam joins.

use std::collections::{BTreeMap, BTreeSet};
use stitch_mesh::ids::{EdgeId, VertexId};
use stitch_mesh::mesh::PolygonMesh;

/// The edges as lines, each from one of its ends to the other. A line that closes or that branches has no ends there.
pub fn runs(mesh: &PolygonMesh, edges: &[EdgeId]) -> Vec<Vec<VertexId>> {
    let mut beside: BTreeMap<VertexId, Vec<VertexId>> = BTreeMap::new();
    for [a, b] in edges.iter().map(|e| mesh.edge_ends(*e)) {
        beside.entry(a).or_default().push(b);
        beside.entry(b).or_default().push(a);
    }
    let mut seen = BTreeSet::new();
    let mut found = Vec::new();
    for (start, _) in beside.iter().filter(|(_, around)| around.len() == 1) {
        if seen.contains(start) {
            continue;
        }
        let mut run = vec![*start];
        let mut at = *start;
        while let Some(next) = beside[&at].iter().find(|v| !seen.contains(*v) && !run.contains(v)) {
            run.push(*next);
            at = *next;
        }
        seen.extend(run.iter().copied());
        found.push(run);
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use stitch_mesh::edge_counts::StitchSize;
    use stitch_mesh::ids::{FaceId, HalfEdgeId};
    use stitch_mesh::pieces::rectangle;

    #[test]
    fn neighbouring_edges_join_and_others_stay_apart() {
        let piece = rectangle(5, 3, StitchSize::of_width(3e-3)).unwrap();
        let mesh = piece.mesh();
        let below = |face: u32| -> HalfEdgeId { mesh.first_half_edge(FaceId(face)) };
        let edges = [5, 7, 6, 14].map(|f| mesh.edge(below(f)));
        let found = runs(mesh, &edges);
        let lengths: Vec<usize> = found.iter().map(Vec::len).collect();
        assert_eq!(lengths, [4, 2]);
        let line: Vec<VertexId> =
            [5, 6, 7].map(|f| mesh.origin(below(f))).into_iter().chain([mesh.tip(below(7))]).collect();
        assert_eq!(found[0], line, "in order, though they were not given so");
    }
}
