//! What to draw, as plain data.

use glam::Vec3;
use smallvec::SmallVec;
use stitch_mesh::yarn_curves::YarnCurves;

use crate::{Bounds, Solids};

/// A polygon of a surface.
#[derive(Clone, Debug, PartialEq)]
pub struct Polygon {
    /// Its corners, indices into [`Faces::positions`], counter-clockwise seen from the front.
    pub vertices: SmallVec<[u32; 4]>,
    /// Colour, linear RGB.
    pub color: [f32; 3],
}

/// Coloured polygons with shared corners; they need not be flat.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Faces {
    /// Corners [m].
    pub positions: Vec<Vec3>,
    /// The polygons.
    pub polygons: Vec<Polygon>,
}

impl Faces {
    /// The corners of a polygon [m].
    pub fn corners(&self, polygon: usize) -> impl Iterator<Item = Vec3> + '_ {
        self.polygons[polygon].vertices.iter().map(|&v| self.positions[v as usize])
    }

    /// A polygon cut into triangles, each three of its corners; their number stands for the mean of them. A quadrilateral is
    /// cut along the shorter diagonal inside it; larger ones are a fan about the mean, which treats all corners of a warped
    /// polygon alike.
    pub(crate) fn cut(&self, polygon: usize) -> impl Iterator<Item = [usize; 3]> + use<> {
        let n = self.polygons[polygon].vertices.len();
        let other = n == 4 && self.is_cut_from_second(polygon);
        (0..triangles(n)).map(move |i| match n {
            3 | 4 => [0, i + 1, i + 2].map(|corner| (corner + usize::from(other)) % n),
            _ => [n, i, (i + 1) % n],
        })
    }

    /// Whether a quadrilateral is cut from its second to its last corner.
    fn is_cut_from_second(&self, polygon: usize) -> bool {
        let vertices = &self.polygons[polygon].vertices;
        let at = |i: usize| self.positions[vertices[i % 4] as usize];
        let half = |i: usize| (at(i + 1) - at(i)).cross(at(i + 2) - at(i));
        let whole = half(0) + half(2);
        let inside = |i: usize| half(i).dot(whole) >= 0.0 && half(i + 2).dot(whole) >= 0.0;
        match (inside(0), inside(1)) {
            (true, true) => at(1).distance_squared(at(3)) < at(0).distance_squared(at(2)),
            (first, _) => !first,
        }
    }

    /// The triangles of a polygon.
    pub(crate) fn triangles(&self, polygon: usize) -> impl Iterator<Item = [Vec3; 3]> + '_ {
        let vertices = &self.polygons[polygon].vertices;
        let at = move |i: usize| match vertices.get(i) {
            Some(vertex) => self.positions[*vertex as usize],
            None => self.mean(polygon),
        };
        self.cut(polygon).map(move |corners| corners.map(at))
    }

    /// The mean of the corners of a polygon [m].
    pub(crate) fn mean(&self, polygon: usize) -> Vec3 {
        self.corners(polygon).sum::<Vec3>() / self.polygons[polygon].vertices.len().max(1) as f32
    }
}

/// How many triangles a polygon of so many corners is cut into.
pub(crate) fn triangles(corners: usize) -> usize {
    match corners {
        0..3 => 0,
        3 | 4 => corners - 2,
        _ => corners,
    }
}

/// A line between two points, as the GPU reads it, too.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct Segment {
    /// Its ends [m].
    pub ends: [Vec3; 2],
    /// Colour, linear RGB.
    pub color: [f32; 3],
    /// Width on the screen [px]; a line without any is not drawn.
    pub width: f32,
}

/// Lines of constant width on the screen, drawn slightly in front of what they lie on.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Lines {
    /// The lines.
    pub segments: Vec<Segment>,
}

/// Everything in a picture.
#[derive(Clone, Debug, Default)]
pub struct Drawing {
    /// Polygons: input mesh, labels, stitch faces.
    pub faces: Faces,
    /// Edges and overlays.
    pub lines: Lines,
    /// Bodies beside the fabric.
    pub solids: Solids,
    /// The yarn.
    pub yarn: YarnCurves,
}

impl Drawing {
    /// The box around all of it except the ground, which has no end; `None` if it is empty.
    pub fn bounds(&self) -> Option<Bounds> {
        let faces = Bounds::of(self.faces.positions.iter().copied());
        let lines = Bounds::of(self.lines.segments.iter().flat_map(|segment| segment.ends));
        let yarn = self.yarn.curves.iter().filter_map(|curve| {
            let bounds = Bounds::of(curve.points.iter().copied())?;
            let radius = curve.greatest_radius();
            Some(Bounds { min: bounds.min - radius, max: bounds.max + radius })
        });
        [faces, lines, self.solids.bounds()].into_iter().flatten().chain(yarn).reduce(Bounds::union)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use smallvec::smallvec;

    #[test]
    fn a_fan_covers_a_concave_hexagon_once() {
        let outline = [(0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (1.0, 1.2), (0.0, 2.0), (-0.2, 1.0)];
        let faces = Faces {
            positions: outline.iter().map(|&(x, y)| Vec3::new(x, y, 0.0)).collect(),
            polygons: vec![Polygon { vertices: (0..6).collect(), color: [1.0; 3] }],
        };
        let double_area = |[a, b, c]: [Vec3; 3]| (b - a).cross(c - a).z;
        assert!(faces.triangles(0).all(|triangle| double_area(triangle) > 0.0));
        let shoelace: f32 = (0..6)
            .map(|i| {
                let ((x0, y0), (x1, y1)) = (outline[i], outline[(i + 1) % 6]);
                x0 * y1 - x1 * y0
            })
            .sum();
        assert!((faces.triangles(0).map(double_area).sum::<f32>() - shoelace).abs() < 1e-5);
    }

    #[test]
    fn a_quadrilateral_is_cut_inside() {
        let dart = [(0.0, 0.0), (2.0, 2.0), (0.0, 0.5), (-2.0, 2.0)];
        for turn in 0..4 {
            let positions = (0..4).map(|i| dart[(i + turn) % 4]).map(|(x, y)| Vec3::new(x, y, 0.0)).collect();
            let faces =
                Faces { positions, polygons: vec![Polygon { vertices: (0..4).collect(), color: [1.0; 3] }] };
            let areas: Vec<f32> = faces.triangles(0).map(|[a, b, c]| (b - a).cross(c - a).z).collect();
            assert!(areas.len() == 2 && areas.iter().all(|a| *a > 0.0), "{turn}: {areas:?}");
        }
    }

    #[test]
    fn polygons_of_two_corners_have_no_triangles() {
        let polygons = vec![Polygon { vertices: smallvec![0, 1], color: [1.0; 3] }];
        let faces = Faces { positions: vec![Vec3::ZERO, Vec3::X], polygons };
        assert_eq!(faces.triangles(0).count(), 0);
    }
}
