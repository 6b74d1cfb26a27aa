//! What the tests that draw share: one device, and a piece of fabric to look at.

use std::f32::consts::TAU;
use std::sync::OnceLock;

use glam::Vec3;
use render::Gpu;
use stitch_mesh::dye::Dye;
use stitch_mesh::yarn_curves::{YarnCurve, YarnCurves};

/// The adapter of this machine. Without one these tests fail with a line that says what to install.
pub fn gpu() -> &'static Gpu {
    static GPU: OnceLock<Gpu> = OnceLock::new();
    GPU.get_or_init(|| Gpu::headless().unwrap_or_else(|error| panic!("{error}")))
}

/// Plain knitting of `wales` × `courses` loops with ten control points each, knit side to the front, centred; wales are
/// 5 mm apart. Each row is one yarn along the curve x = W t + a sin 4πt, y = −h cos 2πt, z = d cos 4πt.
pub fn stockinette(wales: usize, courses: usize) -> YarnCurves {
    const PER_LOOP: usize = 10;
    let (width, height) = (5.0e-3, 3.6e-3);
    let colors = [[221, 203, 173], [191, 101, 89], [101, 139, 158]].map(Dye);
    let row = |j: usize| {
        let point = |i: usize| {
            let t = i as f32 / PER_LOOP as f32;
            let x = width * (t - wales as f32 / 2.0) + 1.35e-3 * (2.0 * TAU * t).sin();
            let y = height * (j as f32 - courses as f32 / 2.0) - 3.25e-3 * (TAU * t).cos();
            Vec3::new(x, y, -0.95e-3 * (2.0 * TAU * t).cos())
        };
        let dye = colors[if j % 8 < 5 { 0 } else { 1 + j / 8 % 2 }];
        YarnCurve::new((0..=wales * PER_LOOP).map(point).collect(), false, 0.66e-3, dye)
    };
    YarnCurves { curves: (0..courses).map(row).collect() }
}
