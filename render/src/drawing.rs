//! What to draw, as plain data.

use glam::Vec3;
use stitch_mesh::yarn_curves::YarnCurves;

use crate::{Bounds, Solids};

/// A polygon of a surface.
#[derive(Clone, Debug, PartialEq)]
pub struct Polygon {
    /// Its corners, indices into [`Faces::positions`], counter-clockwise seen from the front.
    pub vertices: Vec<u32>,
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

    /// The triangles of a polygon: itself if it is one, otherwise a fan about the mean of its corners, which treats all
    /// corners of a warped polygon alike.
    pub(crate) fn triangles(&self, polygon: usize) -> impl Iterator<Item = [Vec3; 3]> + '_ {
        let vertices = &self.polygons[polygon].vertices;
        let n = vertices.len();
        let at = move |i: usize| self.positions[vertices[i % n] as usize];
        let mean = self.corners(polygon).sum::<Vec3>() / n.max(1) as f32;
        let count = match n {
            0..3 => 0,
            3 => 1,
            _ => n,
        };
        (0..count).map(move |i| if n == 3 { [at(0), at(1), at(2)] } else { [mean, at(i), at(i + 1)] })
    }
}

/// A line between two points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Segment {
    /// Its ends [m].
    pub ends: [Vec3; 2],
    /// Colour, linear RGB.
    pub color: [f32; 3],
    /// Width on the screen [px].
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
            Some(Bounds { min: bounds.min - curve.radius, max: bounds.max + curve.radius })
        });
        [faces, lines, self.solids.bounds()].into_iter().flatten().chain(yarn).reduce(Bounds::union)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
    fn polygons_of_two_corners_have_no_triangles() {
        let polygons = vec![Polygon { vertices: vec![0, 1], color: [1.0; 3] }];
        let faces = Faces { positions: vec![Vec3::ZERO, Vec3::X], polygons };
        assert_eq!(faces.triangles(0).count(), 0);
    }
}
