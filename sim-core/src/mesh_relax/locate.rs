//! Where the vertices of a stitch mesh are on the surface to begin with (Yuksel et al. §6.1).
//!
//! The tessellation lies on the flat polygons of the input. Each vertex is looked up on the flat triangles and carried with
//! its barycentric coordinates onto the smooth ones. A stitch mesh that has been relaxed before lies on the smooth surface
//! already and is looked up there: relaxing again goes on from where it was.

use super::surface::{Place, Surface};
use crate::bvh::{Bvh, nearest_on_segment, nearest_on_triangle};
use glam::DVec3;
use rayon::prelude::*;
use stitch_mesh::ids::VertexId;
use stitch_mesh::mesh::PolygonMesh;

/// A vertex this near to the surface lies on it, as a fraction of the size of the mesh.
const ON: f64 = 1e-6;

/// Places of the vertices of `mesh`, which are at `x`. Border vertices are placed on borders, corners on corners.
pub(super) fn locate(surface: &Surface, mesh: &PolygonMesh, x: &[DVec3]) -> Vec<Place> {
    let (low, high) =
        surface.flat.iter().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(l, h), p| (l.min(*p), h.max(*p)));
    let on = ON * low.distance(high);
    let (flat, far) = locate_on(surface, &surface.flat, mesh, x, on);
    if far <= on {
        return flat;
    }
    let (smooth, far) = locate_on(surface, &surface.points, mesh, x, on);
    if far <= on { smooth } else { flat }
}

/// Places by nearest point on triangles and borders with these points, and the largest distance.
fn locate_on(
    surface: &Surface,
    points: &[DVec3],
    mesh: &PolygonMesh,
    x: &[DVec3],
    on: f64,
) -> (Vec<Place>, f64) {
    let triangle = |t: usize| surface.triangles[t].map(|v| points[v as usize]);
    let triangles = Bvh::new(surface.triangles.len(), triangle);
    // Segments of all borders, without the steps from one border to the next.
    let borders = || surface.border_starts.windows(2).enumerate();
    let segments: Vec<(u32, u32)> =
        borders().flat_map(|(b, span)| (span[0]..span[1] - 1).map(move |s| (b as u32, s))).collect();
    let segment = |i: usize| [0, 1].map(|k| points[surface.border[segments[i].1 as usize + k] as usize]);
    let border_tree = Bvh::new(segments.len(), segment);

    let on_border = on_border(mesh);
    let place = |(v, p): (usize, &DVec3)| {
        if on_border[v] {
            let measure = |i: usize| {
                let at = nearest_on_segment(segment(i), *p);
                let [a, b] = segment(i);
                (a.lerp(b, at).distance_squared(*p), at)
            };
            if let Some((square, i, at)) = border_tree.nearest(*p, measure) {
                let (border, s) = segments[i];
                let end = if at < 0.5 { s } else { s + 1 };
                let point = surface.border[end as usize];
                let is_corner = surface.tangents[end as usize] == DVec3::ZERO
                    && mesh.valence(VertexId::new(v)) == 1
                    && points[point as usize].distance(*p) <= on.max(1e-9);
                let place = if is_corner {
                    Place::Corner { point }
                } else {
                    Place::Border { border, segment: s, at }
                };
                return (place, square.sqrt());
            }
        }
        let measure = |t: usize| {
            let at = nearest_on_triangle(triangle(t), *p);
            let [a, b, c] = triangle(t);
            ((at[0] * a + at[1] * b + at[2] * c).distance_squared(*p), at)
        };
        match triangles.nearest(*p, measure) {
            Some((square, t, at)) => (Place::Inside { triangle: t as u32, at }, square.sqrt()),
            None => (Place::Corner { point: 0 }, f64::INFINITY), // a surface without triangles; a mesh has faces
        }
    };
    let found: Vec<(Place, f64)> = x.par_iter().enumerate().map(place).collect();
    let far = found.iter().map(|(_, d)| *d).fold(0.0, f64::max);
    (found.into_iter().map(|(place, _)| place).collect(), far)
}

/// Which vertices lie on a border, [vertex_count].
fn on_border(mesh: &PolygonMesh) -> Vec<bool> {
    let mut on_border = vec![false; mesh.vertex_count()];
    for edge in mesh.edges().filter(|e| mesh.is_border(*e)) {
        mesh.edge_ends(edge).iter().for_each(|v| on_border[v.index()] = true);
    }
    on_border
}
