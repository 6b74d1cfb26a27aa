//! What can be wrong with a polygon mesh, found before any structure is built on it.

use crate::corners::Corners;
use crate::ids::{FaceId, VertexId};
use glam::DVec3;
use rayon::prelude::*;
use smallvec::SmallVec;
use std::collections::BTreeMap;

/// One thing wrong with a mesh, by face, edge or vertex (numbered from 0).
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MeshProblem {
    /// There are no faces at all.
    #[error("the mesh has no faces")]
    Empty,
    /// Positions for another number of vertices.
    #[error("{given} positions for {vertices} vertices")]
    PositionCount {
        /// Positions given.
        given: usize,
        /// Vertices there are.
        vertices: usize,
    },
    /// A coordinate is not a finite number.
    #[error("vertex {0} has a coordinate that is not a finite number")]
    NotFinite(VertexId),
    /// A face names a vertex that does not exist.
    #[error("face {face} names vertex {vertex}, but there are only {count}")]
    MissingVertex {
        /// The face.
        face: FaceId,
        /// The vertex it names.
        vertex: u32,
        /// Number of vertices.
        count: usize,
    },
    /// A face with fewer than three corners, a corner twice, or no area.
    #[error("face {face} is degenerate: {why}")]
    DegenerateFace {
        /// The face.
        face: FaceId,
        /// What is degenerate about it.
        why: &'static str,
    },
    /// More than two faces share an edge.
    #[error("edge {a}–{b} is not manifold: {count} faces share it")]
    NonManifoldEdge {
        /// One end.
        a: VertexId,
        /// The other end.
        b: VertexId,
        /// Number of faces there.
        count: usize,
    },
    /// Two neighbours disagree about which side is the front.
    #[error("face {face} is flipped against its neighbour, face {neighbour}, at edge {a}–{b}")]
    FlippedFace {
        /// The later face.
        face: FaceId,
        /// The earlier face.
        neighbour: FaceId,
        /// One end of their edge.
        a: VertexId,
        /// The other end.
        b: VertexId,
    },
    /// A vertex at which several fans of faces meet in one point only.
    #[error("vertex {0} is not manifold: faces meet there in one point only")]
    NonManifoldVertex(VertexId),
    /// A vertex that no face uses.
    #[error("vertex {0} is isolated: no face uses it")]
    IsolatedVertex(VertexId),
}

/// A mesh that cannot be built, and why.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{}", describe(.0))]
pub struct MeshError(pub Vec<MeshProblem>);

fn describe(problems: &[MeshProblem]) -> String {
    let shown: Vec<String> = problems.iter().take(3).map(|p| p.to_string()).collect();
    match problems.len() - shown.len() {
        0 => shown.join("; "),
        more => format!("{}; and {more} more", shown.join("; ")),
    }
}

/// Everything wrong with a mesh given as positions [m] and faces. Empty when [`crate::mesh::PolygonMesh::new`] succeeds.
pub fn validate(positions: &[DVec3], faces: &[impl AsRef<[u32]> + Sync]) -> Vec<MeshProblem> {
    check(positions, faces, |_| ()).err().unwrap_or_default()
}

/// The corners of a mesh, and what `work` has made of them while the mesh was looked through, if nothing is wrong with it; or else
/// all that is. The work has to end whatever is wrong, short of vertices that do not exist.
pub(crate) fn check<T: Send>(
    positions: &[DVec3],
    faces: &[impl AsRef<[u32]> + Sync],
    work: impl FnOnce(&Corners) -> T + Send,
) -> Result<(Corners, T), Vec<MeshProblem>> {
    let mut problems = Vec::new();
    if faces.is_empty() {
        problems.push(MeshProblem::Empty);
    }
    problems.extend(not_finite(positions));
    for (f, vertices) in faces.iter().map(AsRef::as_ref).enumerate() {
        let face = FaceId::new(f);
        let missing = vertices.iter().find(|v| **v as usize >= positions.len());
        if let Some(&vertex) = missing {
            problems.push(MeshProblem::MissingVertex { face, vertex, count: positions.len() });
        }
    }
    if !problems.is_empty() {
        return Err(problems); // what follows looks vertices up and measures them
    }
    let (degenerate, corners) =
        rayon::join(|| degenerate_faces(positions, faces), || Corners::new(positions.len(), faces));
    problems.extend(degenerate);
    let (made, ()) = rayon::join(
        || work(&corners),
        || {
            if corners.has_doubles() {
                problems.extend(edge_problems(faces));
            }
            if problems.is_empty() {
                problems = vertex_problems(positions.len(), &corners);
            }
        },
    );
    if problems.is_empty() { Ok((corners, made)) } else { Err(problems) }
}

/// What can be wrong with a mesh after its vertices have moved.
pub(crate) fn position_problems(positions: &[DVec3], faces: &[impl AsRef<[u32]> + Sync]) -> Vec<MeshProblem> {
    let problems: Vec<MeshProblem> = not_finite(positions).collect();
    if problems.is_empty() { degenerate_faces(positions, faces) } else { problems }
}

fn not_finite(positions: &[DVec3]) -> impl Iterator<Item = MeshProblem> {
    let vertices = positions.iter().enumerate().filter(|(_, p)| !p.is_finite());
    vertices.map(|(v, _)| MeshProblem::NotFinite(VertexId::new(v)))
}

fn degenerate_faces(positions: &[DVec3], faces: &[impl AsRef<[u32]> + Sync]) -> Vec<MeshProblem> {
    let problem = |(f, vertices): (usize, &[u32])| {
        let why = degenerate(positions, vertices)?;
        Some(MeshProblem::DegenerateFace { face: FaceId::new(f), why })
    };
    faces.par_iter().map(AsRef::as_ref).enumerate().filter_map(problem).collect()
}

pub(crate) fn degenerate(positions: &[DVec3], vertices: &[u32]) -> Option<&'static str> {
    if vertices.len() < 3 {
        return Some("it has fewer than three corners");
    }
    let mut sorted: SmallVec<[u32; 8]> = vertices.into();
    sorted.sort_unstable();
    if sorted.windows(2).any(|w| w[0] == w[1]) {
        return Some("it has a corner twice");
    }
    let points: SmallVec<[DVec3; 8]> = vertices.iter().map(|v| positions[*v as usize]).collect();
    let perimeter: f64 = (0..points.len()).map(|i| points[i].distance(points[(i + 1) % points.len()])).sum();
    // A face thinner than a millionth of its outline cannot hold a stitch.
    (area_vector(points.iter().copied()).length() <= 1e-6 * perimeter * perimeter).then_some("it has no area")
}

/// Area vector of a polygon (Newell's formula, about its first point so that far-off meshes keep their digits) [m²].
pub fn area_vector(mut points: impl Iterator<Item = DVec3>) -> DVec3 {
    let (Some(origin), Some(second)) = (points.next(), points.next()) else { return DVec3::ZERO };
    let mut before = second - origin;
    let twice = points.map(|p| std::mem::replace(&mut before, p - origin).cross(p - origin)).sum::<DVec3>();
    twice * 0.5
}

fn edge_problems(faces: &[impl AsRef<[u32]>]) -> Vec<MeshProblem> {
    // Uses of every edge: the face, and whether it runs from the smaller vertex to the larger. Ordered, so that the same
    // mesh is always described in the same words.
    let mut uses: BTreeMap<(u32, u32), Vec<(usize, bool)>> = BTreeMap::new();
    for (f, vertices) in faces.iter().map(AsRef::as_ref).enumerate() {
        for (i, &a) in vertices.iter().enumerate() {
            let b = vertices[(i + 1) % vertices.len()];
            uses.entry((a.min(b), a.max(b))).or_default().push((f, a < b));
        }
    }
    let mut problems = Vec::new();
    for ((a, b), uses) in uses {
        let (a, b) = (VertexId(a), VertexId(b));
        match uses[..] {
            [(first, up), (second, also)] if up == also && first != second => {
                let (face, neighbour) = (FaceId::new(second), FaceId::new(first));
                problems.push(MeshProblem::FlippedFace { face, neighbour, a, b });
            }
            ref many if many.len() > 2 => {
                problems.push(MeshProblem::NonManifoldEdge { a, b, count: many.len() });
            }
            _ => {}
        }
    }
    problems
}

fn vertex_problems(count: usize, corners: &Corners) -> Vec<MeshProblem> {
    (0..count as u32).into_par_iter().filter_map(|vertex| vertex_problem(vertex, corners)).collect()
}

/// Whether a vertex is isolated or has several fans. Only to be asked where all edges are manifold: then the faces around a vertex form chains: as many
/// as there are corners less inner edges, or a single closed fan.
pub(crate) fn vertex_problem(vertex: u32, corners: &Corners) -> Option<MeshProblem> {
    let corners = corners.at(vertex);
    let vertex = VertexId(vertex);
    let Some(first) = corners.first() else { return Some(MeshProblem::IsolatedVertex(vertex)) };
    // Walk both ways from the first corner; a single fan reaches all of them. Around the vertex, every corner joins the edge it
    // comes in on with the edge it goes out on.
    let mut reached = 1;
    let mut at = first.before;
    while let Some(c) = corners.iter().find(|c| c.after == at).filter(|c| *c != first) {
        (at, reached) = (c.before, reached + 1);
    }
    if at != first.after || corners.len() == 1 {
        at = first.after;
        while let Some(c) = corners.iter().find(|c| c.before == at) {
            (at, reached) = (c.after, reached + 1);
        }
    }
    (reached != corners.len()).then_some(MeshProblem::NonManifoldVertex(vertex))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grid() -> (Vec<DVec3>, Vec<Vec<u32>>) {
        let at = |i: u32| DVec3::new((i % 3) as f64, (i / 3) as f64, 0.0);
        let quad = |i: u32| vec![i, i + 1, i + 4, i + 3];
        ((0..9).map(at).collect(), [0, 1, 3, 4].map(quad).to_vec())
    }

    #[test]
    fn a_good_mesh_has_no_problems() {
        let (positions, faces) = grid();
        assert_eq!(validate(&positions, &faces), []);
    }

    #[test]
    fn every_problem_is_named() {
        let (positions, faces) = grid();
        assert_eq!(validate(&positions, &[[0u32; 0]; 0]), [MeshProblem::Empty]);

        let mut bad = positions.clone();
        bad[4].y = f64::NAN;
        assert_eq!(validate(&bad, &faces), [MeshProblem::NotFinite(VertexId(4))]);

        let mut bad = faces.clone();
        bad[1][2] = 99;
        assert!(matches!(
            validate(&positions, &bad)[..],
            [MeshProblem::MissingVertex { face: FaceId(1), vertex: 99, count: 9 }]
        ));

        let mut bad = faces.clone();
        bad[2].reverse();
        assert!(matches!(
            validate(&positions, &bad)[..],
            [MeshProblem::FlippedFace { .. }, MeshProblem::FlippedFace { .. }]
        ));

        let mut bad = faces.clone();
        bad.push(vec![3, 4, 8]);
        assert!(validate(&positions, &bad).contains(&MeshProblem::NonManifoldEdge {
            a: VertexId(3),
            b: VertexId(4),
            count: 3
        }));

        assert!(matches!(
            validate(&positions, &[vec![0, 1], vec![0, 1, 1], vec![0, 1, 2]])[..],
            [
                MeshProblem::DegenerateFace { face: FaceId(0), .. },
                MeshProblem::DegenerateFace { face: FaceId(1), .. },
                MeshProblem::DegenerateFace { face: FaceId(2), .. },
                ..
            ]
        ));

        // Two corners of the grid alone touch in the middle vertex only, and six vertices lie idle.
        let bow_tie = validate(&positions, &[faces[0].clone(), faces[3].clone()]);
        assert!(bow_tie.contains(&MeshProblem::NonManifoldVertex(VertexId(4))));
        assert!(bow_tie.contains(&MeshProblem::IsolatedVertex(VertexId(2))));
    }
}
