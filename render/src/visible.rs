//! What is seen where: which polygon shows at each pixel. A box or a brush takes what it covers on the screen, not what lies
//! behind it.
//!
//! The polygons are drawn on the processor, numbers instead of colours, with the depth of `frame.wgsl` (1 ÷ distance, which is
//! linear across the screen). A garment of 65 000 stitches takes a few milliseconds, and no picture has to come back from a GPU.

use glam::{Mat4, Vec2, Vec3, Vec4};

use crate::pick::SEAM;
use crate::{Camera, Faces};

/// Nothing shows here.
const NOTHING: u32 = u32::MAX;

/// The polygons as a camera sees them.
#[derive(Clone, Debug)]
pub struct Visible {
    size: [usize; 2],
    view_projection: Mat4,
    near: f32,
    /// Polygon at each pixel, by rows from the top.
    polygon: Vec<u32>,
    /// 1 ÷ distance of that polygon \[1/m\].
    depth: Vec<f32>,
}

impl Visible {
    /// What `camera` sees of `faces` in a picture of `size` pixels.
    pub fn new(faces: &Faces, camera: &Camera, size: [usize; 2]) -> Self {
        let pixels = size[0] * size[1];
        let mut visible = Self {
            size,
            view_projection: camera.view_projection(size[0] as f32 / size[1].max(1) as f32),
            near: camera.near(),
            polygon: vec![NOTHING; pixels],
            depth: vec![0.0; pixels],
        };
        for index in 0..faces.polygons.len() {
            for triangle in faces.triangles(index) {
                visible.draw(index as u32, triangle);
            }
        }
        visible
    }

    /// Where a point lies in the picture [px], and 1 ÷ its distance; none for what is behind the eye.
    fn project(&self, point: Vec3) -> Option<Vec3> {
        let p: Vec4 = self.view_projection * point.extend(1.0);
        (p.w > self.near).then(|| {
            let [width, height] = self.size.map(|s| s as f32);
            Vec3::new((0.5 + 0.5 * p.x / p.w) * width, (0.5 - 0.5 * p.y / p.w) * height, 1.0 / p.w)
        })
    }

    fn draw(&mut self, polygon: u32, corners: [Vec3; 3]) {
        let [Some(a), Some(b), Some(c)] = corners.map(|p| self.project(p)) else { return };
        let area = (b - a).truncate().perp_dot((c - a).truncate());
        if area == 0.0 {
            return;
        }
        // Pixels have their centres at halves.
        let range = |low: f32, high: f32, size: usize| {
            (low - 0.5).ceil().max(0.0) as usize..((high + 0.5).floor().max(0.0) as usize).min(size)
        };
        let low = a.min(b).min(c);
        let high = a.max(b).max(c);
        for y in range(low.y, high.y, self.size[1]) {
            for x in range(low.x, high.x, self.size[0]) {
                let p = Vec2::new(x as f32 + 0.5, y as f32 + 0.5) - a.truncate();
                let v = p.perp_dot((c - a).truncate()) / area;
                let w = (b - a).truncate().perp_dot(p) / area;
                if v.min(w).min(1.0 - v - w) < -SEAM {
                    continue;
                }
                let depth = a.z + v * (b.z - a.z) + w * (c.z - a.z);
                let pixel = y * self.size[0] + x;
                if depth > self.depth[pixel] {
                    self.depth[pixel] = depth;
                    self.polygon[pixel] = polygon;
                }
            }
        }
    }

    /// The polygon that shows at a point of the picture [px].
    pub fn at(&self, point: Vec2) -> Option<usize> {
        let inside = point.x >= 0.0 && point.y >= 0.0;
        let [x, y] = [point.x as usize, point.y as usize];
        let found = inside && x < self.size[0] && y < self.size[1];
        found.then(|| self.polygon[y * self.size[0] + x]).filter(|p| *p != NOTHING).map(|p| p as usize)
    }

    /// Where a point of a polygon shows [px]; none if something hides it, or it is outside of the picture.
    pub fn sees(&self, point: Vec3, polygon: usize) -> Option<Vec2> {
        let at = self.project(point)?.truncate();
        (self.at(at) == Some(polygon)).then_some(at)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Bounds, NamedView, Polygon, pick};

    /// Two squares, the second behind the first and half beside it.
    fn squares() -> Faces {
        let square = |x: f32, z: f32| {
            [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(|(dx, y)| Vec3::new(x + dx, y, z))
        };
        let polygon = |first: u32| Polygon { vertices: (first..first + 4).collect(), color: [1.0; 3] };
        Faces {
            positions: [square(0.0, 0.0), square(0.5, -0.4)].concat(),
            polygons: vec![polygon(0), polygon(4)],
        }
    }

    #[test]
    fn shows_at_every_pixel_what_a_ray_meets_first() {
        let faces = squares();
        let size = [90, 60];
        let bounds = Bounds::of(faces.positions.iter().copied()).unwrap();
        let camera = Camera::named(NamedView::ThreeQuarter, bounds, 1.5);
        let visible = Visible::new(&faces, &camera, size);
        let mut seen = [0; 3];
        for (y, x) in (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| (y, x))) {
            let pixel = Vec2::new(x as f32 + 0.5, y as f32 + 0.5);
            let ray = camera.ray(pixel, Vec2::new(90.0, 60.0));
            let met = pick(&faces, ray).map(|hit| hit.polygon);
            assert_eq!(visible.at(pixel), met, "{pixel}");
            seen[met.unwrap_or(2)] += 1;
        }
        assert!(seen.iter().all(|n| *n > 100), "{seen:?}: the picture shows both squares and what is beside");
    }

    #[test]
    fn hides_what_lies_behind() {
        let faces = squares();
        let bounds = Bounds::of(faces.positions.iter().copied()).unwrap();
        let camera = Camera::named(NamedView::Front, bounds, 1.0);
        let visible = Visible::new(&faces, &camera, [80, 80]);
        assert!(visible.sees(Vec3::new(0.7, 0.5, 0.0), 0).is_some());
        assert!(visible.sees(Vec3::new(0.7, 0.5, -0.4), 1).is_none(), "behind the first");
        assert!(visible.sees(Vec3::new(1.3, 0.5, -0.4), 1).is_some(), "beside the first");
        assert!(visible.sees(Vec3::new(0.5, 0.5, 50.0), 0).is_none(), "behind the eye");
    }
}
