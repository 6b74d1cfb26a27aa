//! The studio: a key light with shadows, a fill, a rim light and the ambient light of a bright room.
//!
//! The lights stand around the camera and move with it, so the fabric reads equally well from every side.

use glam::Vec3;

use crate::Camera;

/// The WGSL of shading, for the shaders of everything that is lit, with shadows or without. Comes after `frame.wgsl`.
pub(crate) fn wgsl(shadows: bool) -> String {
    format!("const SHADOWS = {shadows};\n{}", include_str!("light.wgsl"))
}

// Where the lights are, seen from the camera: x right, y up, z towards the eye.
const KEY: Vec3 = Vec3::new(-0.55, 0.62, 0.56);
const FILL: Vec3 = Vec3::new(0.85, -0.05, 0.52);
const RIM: Vec3 = Vec3::new(0.35, 0.60, -0.72);

/// Directions in the world towards the lights.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Lights {
    pub key: Vec3,
    pub fill: Vec3,
    pub rim: Vec3,
    pub up: Vec3,
}

impl Lights {
    pub fn around(camera: &Camera) -> Self {
        let [right, up, back] = camera.axes();
        let world = |v: Vec3| (right * v.x + up * v.y + back * v.z).normalize();
        Self { key: world(KEY), fill: world(FILL), rim: world(RIM), up }
    }
}
