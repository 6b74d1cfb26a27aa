//! Yarn laid out for the device: all of it that can be worked out without one, so in any thread.

use glam::Vec3;
use stitch_mesh::dye::Dye;
use stitch_mesh::yarn_curves::{YarnCurve, YarnCurves};

use super::level::Chunk;
use super::transport::{ControlPoint, lay_out};

/// Spans that are culled together: few enough to leave out most of what is not seen, enough to keep draw calls cheap.
const CHUNK: usize = 32;

/// A stretch of a curve that has one thickness, as `yarn.wgsl` reads it.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub(super) struct Stretch {
    radius: f32,
    /// Turn of the frame a span, beside its transport [rad].
    roll: f32,
}

/// Curves of yarn as they are uploaded.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct YarnLayout {
    pub(super) points: Vec<ControlPoint>,
    /// Colour from each control point to the next, as sRGB in the bytes of a number.
    pub(super) dyes: Vec<u32>,
    pub(super) stretches: Vec<Stretch>,
    pub(super) chunks: Vec<Chunk>,
    /// Radius of the thickest yarn [m].
    pub(super) radius: f32,
}

impl YarnLayout {
    /// Lays out curves: a tenth of a microsecond a control point.
    pub fn of(yarn: &YarnCurves) -> Self {
        let mut out = Self::default();
        let count = yarn.curves.iter().map(|curve| curve.points.len() + 4).sum();
        out.points.reserve(count);
        out.dyes.reserve(count);
        yarn.curves.iter().for_each(|curve| out.add(curve));
        out
    }

    fn add(&mut self, curve: &YarnCurve) {
        let Self { points, dyes, stretches, chunks, radius } = self;
        let first = points.len() + 1;
        let thickest = curve.greatest_radius();
        let roll = lay_out(curve, stretches.len() as u32, points);
        // One control point lies before the first of the curve, and some after its last.
        let packed = |dye: &Dye| u32::from_le_bytes([dye.0[0], dye.0[1], dye.0[2], 0]);
        dyes.resize(first.min(points.len()), 0);
        dyes.extend(curve.dyes.iter().cycle().take(points.len() - dyes.len()).map(packed));
        dyes.resize(points.len(), 0);
        if points.len() > first {
            chunks.extend(chunks_of(&points[first..points.len() - 2], first, thickest));
        }
        let radii = curve.radii.chunk_by(|a, b| a == b);
        stretches.extend(radii.map(|equal| Stretch { radius: equal[0], roll }));
        *radius = radius.max(thickest);
    }

    /// Whether there is no yarn.
    pub fn is_empty(&self) -> bool {
        self.points.is_empty()
    }
}

/// Cuts the points of a curve, which start at `first` in the buffer, into runs of spans.
fn chunks_of(points: &[ControlPoint], first: usize, radius: f32) -> impl Iterator<Item = Chunk> + '_ {
    let spans = points.len() - 1;
    (0..spans).step_by(CHUNK).map(move |start| {
        let run = &points[start..=(start + CHUNK).min(spans)];
        let center = run.iter().map(|p| p.position).sum::<Vec3>() / run.len() as f32;
        let length: f32 = run.windows(2).map(|w| w[0].position.distance(w[1].position)).sum();
        let count = run.len() - 1;
        let span = length / count as f32;
        let far = run.iter().map(|p| p.position.distance(center)).fold(0.0, f32::max);
        Chunk {
            first: (first + start) as u32,
            spans: count as u32,
            center,
            reach: reach(far, radius, span),
            radius,
            span,
        }
    })
}

/// How far yarn goes from a place that its control points are within `far` of: between them the spline bulges, by less than half
/// a span in any sane curve [m].
pub(super) fn reach(far: f32, radius: f32, span: f32) -> f32 {
    far + radius + 0.5 * span
}
