//! A camera that orbits a target.
//!
//! World axes: y up; the front of the fabric faces +z, so the front view looks along −z. The projection is perspective
//! with reversed infinite depth: depth = near ÷ distance, 1 at the near plane and 0 at infinity, which spreads the
//! precision of a float depth buffer evenly and gives the distance back by one division.

use std::f32::consts::{FRAC_PI_2, FRAC_PI_4};
use std::str::FromStr;

use glam::{Mat4, Vec2, Vec3, Vec4};

/// An axis-aligned box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Smallest corner [m].
    pub min: Vec3,
    /// Largest corner [m].
    pub max: Vec3,
}

impl Bounds {
    /// The smallest box around finite points; `None` if there are none.
    pub fn of(points: impl IntoIterator<Item = Vec3>) -> Option<Self> {
        points.into_iter().filter(|p| p.is_finite()).fold(None, |bounds: Option<Self>, p| {
            Some(bounds.map_or(Self { min: p, max: p }, |b| Self { min: b.min.min(p), max: b.max.max(p) }))
        })
    }

    /// The smallest box around two.
    pub fn union(self, other: Self) -> Self {
        Self { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    /// Its middle [m].
    pub fn center(&self) -> Vec3 {
        (self.min + self.max) / 2.0
    }

    /// Radius of the sphere around it [m].
    pub fn radius(&self) -> f32 {
        self.min.distance(self.max) / 2.0
    }

    fn corners(&self) -> impl Iterator<Item = Vec3> {
        let (min, size) = (self.min, self.max - self.min);
        (0..8).map(move |i| min + size * Vec3::new((i & 1) as f32, (i >> 1 & 1) as f32, (i >> 2 & 1) as f32))
    }
}

/// A half-line from the eye through a pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// Where it starts [m].
    pub origin: Vec3,
    /// Where it goes, length 1.
    pub direction: Vec3,
}

/// Directions to look from by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NamedView {
    /// From +z.
    Front,
    /// From −z.
    Back,
    /// From −x.
    Left,
    /// From +x.
    Right,
    /// From +y.
    Top,
    /// From −y.
    Bottom,
    /// From the front, some way to the right and above.
    ThreeQuarter,
}

impl NamedView {
    /// All of them with their names, as written on the command line.
    pub const ALL: [(&'static str, Self); 7] = [
        ("front", Self::Front),
        ("back", Self::Back),
        ("left", Self::Left),
        ("right", Self::Right),
        ("top", Self::Top),
        ("bottom", Self::Bottom),
        ("three-quarter", Self::ThreeQuarter),
    ];

    fn yaw_pitch(self) -> (f32, f32) {
        match self {
            Self::Front => (0.0, 0.0),
            Self::Back => (2.0 * FRAC_PI_2, 0.0),
            Self::Left => (-FRAC_PI_2, 0.0),
            Self::Right => (FRAC_PI_2, 0.0),
            Self::Top => (0.0, FRAC_PI_2),
            Self::Bottom => (0.0, -FRAC_PI_2),
            Self::ThreeQuarter => (0.8 * FRAC_PI_4, 0.45),
        }
    }
}

impl FromStr for NamedView {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        let names = || Self::ALL.map(|(name, _)| name).join(", ");
        let found = Self::ALL.iter().find(|(known, _)| *known == name);
        found
            .map(|(_, view)| *view)
            .ok_or_else(|| format!("unknown view \"{name}\": expected one of {}", names()))
    }
}

/// The camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// What it looks at and orbits [m].
    pub target: Vec3,
    /// How far from the target it is [m].
    pub distance: f32,
    /// Turn about the y axis [rad]; 0 looks along −z, positive moves the camera towards +x.
    pub yaw: f32,
    /// Height above the horizon [rad], −π/2…π/2; positive looks down.
    pub pitch: f32,
    /// Vertical field of view [rad].
    pub fov: f32,
}

impl Default for Camera {
    fn default() -> Self {
        Self { target: Vec3::ZERO, distance: 1.0, yaw: 0.0, pitch: 0.0, fov: 0.5 }
    }
}

impl Camera {
    /// A camera that sees all of `bounds` from a named direction in a picture of the given width ÷ height.
    pub fn named(view: NamedView, bounds: Bounds, aspect: f32) -> Self {
        let (yaw, pitch) = view.yaw_pitch();
        let mut camera = Self { yaw, pitch, ..Self::default() };
        camera.frame(bounds, aspect);
        camera
    }

    /// Unit vectors to the right, up, and backwards (from the target to the eye).
    pub fn axes(&self) -> [Vec3; 3] {
        let (sin_yaw, cos_yaw) = self.yaw.sin_cos();
        let (sin_pitch, cos_pitch) = self.pitch.sin_cos();
        let right = Vec3::new(cos_yaw, 0.0, -sin_yaw);
        let back = Vec3::new(sin_yaw * cos_pitch, sin_pitch, cos_yaw * cos_pitch);
        [right, back.cross(right), back]
    }

    /// Where the eye is [m].
    pub fn eye(&self) -> Vec3 {
        self.target + self.axes()[2] * self.distance
    }

    /// Distance of the near plane [m]: far enough under the distance to come close to the fabric.
    pub fn near(&self) -> f32 {
        self.distance * 0.02
    }

    /// World to view space: x right, y up, −z ahead.
    pub fn view(&self) -> Mat4 {
        let [right, up, back] = self.axes();
        let rotation =
            Mat4::from_cols(right.extend(0.0), up.extend(0.0), back.extend(0.0), Vec4::W).transpose();
        rotation * Mat4::from_translation(-self.eye())
    }

    /// View space to clip space, for a picture of the given width ÷ height.
    pub fn projection(&self, aspect: f32) -> Mat4 {
        let focal = 1.0 / (self.fov / 2.0).tan();
        Mat4::from_cols(
            Vec4::X * (focal / aspect),
            Vec4::Y * focal,
            Vec4::NEG_W, // w = −z: the distance ahead
            Vec4::Z * self.near(),
        )
    }

    /// World to clip space, for a picture of the given width ÷ height.
    pub fn view_projection(&self, aspect: f32) -> Mat4 {
        self.projection(aspect) * self.view()
    }

    /// Pixels that one metre across the line of sight covers, one metre from the eye, in a picture `height` pixels high.
    pub fn pixels_per_radian(&self, height: f32) -> f32 {
        height / (2.0 * (self.fov / 2.0).tan())
    }

    /// Pixels that a metre covers at the nearest point of a sphere, or `None` if the sphere is outside the picture.
    pub(crate) fn scale_at(&self, size: Vec2) -> impl Fn(Vec3, f32) -> Option<f32> {
        let (eye, [right, up, back]) = (self.eye(), self.axes());
        let (near, pixels) = (self.near(), self.pixels_per_radian(size.y));
        // Half the picture, and the cosine between its edge and the line of sight, across and up.
        let edge = |half: f32| (half, 1.0 / (1.0 + half * half).sqrt());
        let edges = [(right, edge(size.x / 2.0 / pixels)), (up, edge(size.y / 2.0 / pixels))];
        move |center, reach| {
            let p = center - eye;
            let ahead = -p.dot(back);
            let outside = |&(axis, (half, cosine)): &(Vec3, (f32, f32))| {
                (p.dot(axis).abs() - half * ahead) * cosine > reach
            };
            if ahead + reach < near || edges.iter().any(outside) {
                return None;
            }
            // A sphere around the eye would be infinitely large.
            Some(pixels / (ahead - reach).max(0.25 * ahead).max(near))
        }
    }

    /// The ray through a point of the picture; pixels count from the upper left corner, centres at halves.
    pub fn ray(&self, pixel: Vec2, size: Vec2) -> Ray {
        let [right, up, back] = self.axes();
        let half = (self.fov / 2.0).tan();
        let x = (2.0 * pixel.x / size.x - 1.0) * half * size.x / size.y;
        let y = (1.0 - 2.0 * pixel.y / size.y) * half;
        Ray { origin: self.eye(), direction: (right * x + up * y - back).normalize() }
    }

    /// Turns about the target by angles [rad]; the pitch stops at straight up and down.
    pub fn orbit(&mut self, yaw: f32, pitch: f32) {
        self.yaw = (self.yaw + yaw).rem_euclid(4.0 * FRAC_PI_2);
        self.pitch = (self.pitch + pitch).clamp(-FRAC_PI_2, FRAC_PI_2);
    }

    /// Moves sideways so that what lies at the target follows a pointer that moved by `pixels` (x right, y down).
    pub fn pan(&mut self, pixels: Vec2, height: f32) {
        let [right, up, _] = self.axes();
        let metres = self.distance / self.pixels_per_radian(height);
        self.target += (up * pixels.y - right * pixels.x) * metres;
    }

    /// Comes closer by a factor; 2 halves the distance.
    pub fn zoom(&mut self, factor: f32) {
        self.distance = (self.distance / factor).clamp(1e-4, 1e4);
    }

    /// Moves to see all of `bounds`, in the direction it looks already, with a small margin.
    pub fn frame(&mut self, bounds: Bounds, aspect: f32) {
        const MARGIN: f32 = 1.08;
        self.target = bounds.center();
        let [right, up, back] = self.axes();
        let half = (self.fov / 2.0).tan();
        // A corner at height y above the line of sight and z towards the eye is inside the picture if the eye is
        // y / tan(fov / 2) beyond it.
        let needed = |corner: Vec3| {
            let p = corner - self.target;
            let beyond = (p.dot(up).abs() / half).max(p.dot(right).abs() / (half * aspect));
            beyond * MARGIN + p.dot(back)
        };
        self.distance = bounds.corners().map(needed).fold(bounds.radius().max(1e-3) * 0.5, f32::max);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn project(camera: &Camera, aspect: f32, p: Vec3) -> Vec3 {
        camera.view_projection(aspect).project_point3(p)
    }

    #[test]
    fn named_views_look_from_where_they_say() {
        let bounds = Bounds { min: Vec3::splat(-1.0), max: Vec3::splat(1.0) };
        let directions = [Vec3::Z, Vec3::NEG_Z, Vec3::NEG_X, Vec3::X, Vec3::Y, Vec3::NEG_Y];
        for ((name, view), expected) in NamedView::ALL.into_iter().zip(directions) {
            let camera = Camera::named(view, bounds, 1.0);
            assert!(camera.eye().normalize().distance(expected) < 1e-5, "{name}");
            assert_eq!(name.parse::<NamedView>(), Ok(view));
        }
        assert!("sideways".parse::<NamedView>().unwrap_err().contains("three-quarter"));
    }

    #[test]
    fn frame_shows_all_of_the_box() {
        let bounds = Bounds { min: Vec3::new(-2.0, 0.0, 1.0), max: Vec3::new(3.0, 0.5, 9.0) };
        for (name, view) in NamedView::ALL {
            for aspect in [0.4, 1.0, 2.5] {
                let camera = Camera::named(view, bounds, aspect);
                let mut widest: f32 = 0.0;
                for corner in bounds.corners() {
                    let p = project(&camera, aspect, corner);
                    assert!((0.0..1.0).contains(&p.z), "{name}: {p}");
                    widest = widest.max(p.x.abs()).max(p.y.abs());
                }
                assert!((0.8..1.0).contains(&widest), "{name} at {aspect}: {widest}");
            }
        }
    }

    #[test]
    fn depth_is_near_over_distance() {
        let camera = Camera { yaw: 1.0, pitch: 0.3, distance: 4.0, ..Default::default() };
        let p = camera.eye() - camera.axes()[2] * 2.5;
        assert!((project(&camera, 1.5, p).z - camera.near() / 2.5).abs() < 1e-6);
    }

    #[test]
    fn ray_runs_through_the_point_that_projects_to_its_pixel() {
        let camera = Camera { yaw: -2.0, pitch: 0.6, target: Vec3::new(0.1, 0.2, 0.3), ..Default::default() };
        let size = Vec2::new(640.0, 360.0);
        let point = camera.target + Vec3::new(0.05, -0.08, 0.02);
        let p = project(&camera, size.x / size.y, point);
        let pixel = Vec2::new((p.x + 1.0) / 2.0, (1.0 - p.y) / 2.0) * size;
        let ray = camera.ray(pixel, size);
        let off = (point - ray.origin).cross(ray.direction).length();
        assert!(off < 1e-5, "{off}");
    }

    #[test]
    fn spheres_are_culled_only_outside_the_picture() {
        let camera = Camera { yaw: 0.7, pitch: 0.4, ..Default::default() };
        let (size, [right, up, back]) = (Vec2::new(300.0, 200.0), camera.axes());
        let scale = camera.scale_at(size);
        assert!((scale(camera.target, 0.0).unwrap() - camera.pixels_per_radian(200.0)).abs() < 0.1);
        let half = (camera.fov / 2.0).tan();
        for (axis, edge) in [(up, half), (right, 1.5 * half)] {
            for side in [-1.0, 1.0] {
                assert!(scale(camera.target + axis * side * edge * 1.2, 0.18 * edge).is_none());
                assert!(scale(camera.target + axis * side * edge * 1.2, 0.21 * edge).is_some());
            }
        }
        assert!(scale(camera.eye() + back * 0.2, 0.1).is_none());
    }

    #[test]
    fn pan_keeps_the_target_under_the_pointer() {
        let mut camera = Camera { yaw: 0.4, pitch: -0.2, ..Default::default() };
        let before = camera.target;
        camera.pan(Vec2::new(30.0, -12.0), 400.0);
        let p = project(&camera, 1.0, before);
        assert!((p.x * 200.0 - 30.0).abs() < 0.01 && (-p.y * 200.0 + 12.0).abs() < 0.01, "{p}");
    }
}
