//! The shadow map of the key light: depth from the light, as far as the picture reaches.

use glam::{Mat4, Vec3};

use crate::pipeline::{DEPTH_FORMAT, target};
use crate::{Bounds, Camera};

/// Width of the map [texels]; yarn is some ten texels wide where it is large enough to see.
const SIZE: u32 = 3072;

/// The depth texture, and how to compare with it.
#[derive(Debug)]
pub(crate) struct ShadowMap {
    pub view: wgpu::TextureView,
    pub sampler: wgpu::Sampler,
}

impl ShadowMap {
    /// Without shadows the map is a single texel that nobody looks at.
    pub fn new(device: &wgpu::Device, shadows: bool) -> Self {
        let size = if shadows { SIZE } else { 1 };
        let texture = target(device, "shadow map", [size; 2], DEPTH_FORMAT, 1);
        let sampler = device.create_sampler(&wgpu::SamplerDescriptor {
            label: Some("shadow comparison"),
            mag_filter: wgpu::FilterMode::Linear,
            min_filter: wgpu::FilterMode::Linear,
            compare: Some(wgpu::CompareFunction::LessEqual),
            ..Default::default()
        });
        Self { view: texture.create_view(&Default::default()), sampler }
    }
}

/// Where the map lies in the world.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ShadowFrustum {
    /// World to the map: x and y in −1…1, depth 0 nearest the light.
    pub projection: Mat4,
    center: Vec3,
    axes: [Vec3; 3],
    /// Half the width [m].
    radius: f32,
}

impl ShadowFrustum {
    /// Covers what of `bounds` the camera may see, seen from the direction `key`; casters outside the picture but inside
    /// `bounds` keep their depth.
    pub fn new(bounds: Bounds, camera: &Camera, aspect: f32, key: Vec3) -> Self {
        let seen = 1.4 * camera.distance * (camera.fov / 2.0).tan() * aspect.max(1.0);
        let whole = bounds.radius().max(1e-3);
        let (center, radius) = if seen < whole { (camera.target, seen) } else { (bounds.center(), whole) };
        let depth = whole + center.distance(bounds.center());
        let (x, y) = key.any_orthonormal_pair();
        let row =
            |axis: Vec3, scale: f32, offset: f32| (axis * scale).extend(offset - axis.dot(center) * scale);
        let rows = [
            row(x, 1.0 / radius, 0.0),
            row(y, 1.0 / radius, 0.0),
            row(key, -0.5 / depth, 0.5),
            glam::Vec4::W,
        ];
        let projection = Mat4::from_cols(rows[0], rows[1], rows[2], rows[3]).transpose();
        Self { projection, center, axes: [x, y, key], radius }
    }

    /// Width of a texel [m].
    pub fn texel(&self) -> f32 {
        2.0 * self.radius / SIZE as f32
    }

    /// Texels that a metre covers, or `None` if a sphere lies outside the map.
    pub fn scale(&self, center: Vec3, reach: f32) -> Option<f32> {
        let d = center - self.center;
        let outside = |axis: Vec3| d.dot(axis).abs() > self.radius + reach;
        (!outside(self.axes[0]) && !outside(self.axes[1])).then_some(1.0 / self.texel())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_scene_lies_inside_the_map_and_nearer_the_light_is_less() {
        let bounds = Bounds { min: Vec3::new(-1.0, 0.0, 2.0), max: Vec3::new(0.5, 3.0, 2.5) };
        let camera = Camera { target: bounds.center(), distance: 50.0, ..Default::default() };
        let key = Vec3::new(0.3, 0.8, 0.52).normalize();
        let map = ShadowFrustum::new(bounds, &camera, 1.5, key);
        for corner in [bounds.min, bounds.max, bounds.center()] {
            let p = map.projection.project_point3(corner);
            assert!(p.x.abs() <= 1.0 && p.y.abs() <= 1.0 && (0.0..=1.0).contains(&p.z), "{p}");
            let nearer = map.projection.project_point3(corner + key * 0.01);
            assert!(nearer.z < p.z && (nearer - p).truncate().length() < 1e-5);
        }
    }
}
