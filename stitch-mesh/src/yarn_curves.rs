//! Yarn curves: what is drawn and exported (stage 7 of the flow).
//!
//! A curve is a centripetal Catmull–Rom spline through its control points. Centripetal parametrisation keeps the spline
//! free of loops and cusps where control points lie close together, as they do at a stitch contact. The renderer evaluates
//! the same spline on the GPU.

use crate::dye::Dye;
use crate::ids::VisitId;
use glam::Vec3;

/// One drawn yarn.
#[derive(Clone, Debug, PartialEq)]
pub struct YarnCurve {
    /// Control points, which the curve passes through [m].
    pub points: Vec<Vec3>,
    /// Whether the last point is joined to the first.
    pub closed: bool,
    /// Radius of the yarn as drawn from each control point to the next, [point_count] [m].
    pub radii: Vec<f32>,
    /// Colour of the yarn from each control point to the next, [point_count].
    pub dyes: Vec<Dye>,
    /// The visit at which each control point is, or which it follows, in the net that the curve was made of; counted from 0
    /// where there was none, [point_count].
    pub visits: Vec<VisitId>,
}

/// All yarns of a fabric.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct YarnCurves {
    /// One curve a yarn, in the order of the net.
    pub curves: Vec<YarnCurve>,
}

impl YarnCurve {
    /// A yarn of one colour and thickness.
    pub fn new(points: Vec<Vec3>, closed: bool, radius: f32, dye: Dye) -> Self {
        let visits = (0..points.len()).map(VisitId::new).collect();
        Self { radii: vec![radius; points.len()], dyes: vec![dye; points.len()], visits, points, closed }
    }

    /// The radius at its thickest place [m].
    pub fn greatest_radius(&self) -> f32 {
        self.radii.iter().copied().fold(0.0, f32::max)
    }

    /// What is left of a curve where some of its control points are taken out with the yarn beside them: curves of those that
    /// follow each other.
    pub fn without(&self, gone: impl Fn(VisitId) -> bool) -> Vec<Self> {
        let n = self.points.len();
        let Some(first) = (0..n).find(|i| gone(self.visits[*i])) else { return vec![self.clone()] };
        // A ring is opened where something goes; an open curve begins where it began.
        let order: Vec<usize> =
            if self.closed { (first..n).chain(0..first).collect() } else { (0..n).collect() };
        let kept = order.split(|i| gone(self.visits[*i])).filter(|run| run.len() > 1);
        let curve = |run: &[usize]| Self {
            points: run.iter().map(|i| self.points[*i]).collect(),
            closed: false,
            radii: run.iter().map(|i| self.radii[*i]).collect(),
            dyes: run.iter().map(|i| self.dyes[*i]).collect(),
            visits: run.iter().map(|i| self.visits[*i]).collect(),
        };
        kept.map(curve).collect()
    }

    /// Number of spans: pieces of curve between neighbouring control points.
    pub fn span_count(&self) -> usize {
        if self.closed { self.points.len() } else { self.points.len().saturating_sub(1) }
    }

    /// The four control points of a span: before its start, start, end, after its end. At the ends of an open curve the
    /// missing one is the reflection of the other neighbour.
    pub fn span(&self, index: usize) -> [Vec3; 4] {
        let n = self.points.len();
        let at = |i: usize| self.points[i % n];
        let (p1, p2) = (at(index), at(index + 1));
        let p0 = if self.closed || index > 0 { at(index + n - 1) } else { 2.0 * p1 - p2 };
        let p3 = if self.closed || index + 2 < n { at(index + 2) } else { 2.0 * p2 - p1 };
        [p0, p1, p2, p3]
    }

    /// The curve as a polyline with `samples` pieces a span; a closed curve does not repeat its first point.
    pub fn sample(&self, samples: usize) -> Vec<Vec3> {
        let mut out = Vec::with_capacity(self.span_count() * samples + 1);
        for index in 0..self.span_count() {
            let span = self.span(index);
            out.extend((0..samples).map(|k| catmull_rom(span, k as f32 / samples as f32)));
        }
        if !self.closed {
            out.extend(self.points.last());
        }
        out
    }
}

/// Centripetal Catmull–Rom (Barry and Goldman's pyramid; knots tᵢ₊₁ = tᵢ + √|pᵢ₊₁ − pᵢ|) between the middle two of four
/// points, at `t` in 0…1.
pub fn catmull_rom([p0, p1, p2, p3]: [Vec3; 4], t: f32) -> Vec3 {
    // Coincident points would divide by zero; a knot interval of a micrometre's root is far under any yarn radius.
    let knot = |a: Vec3, b: Vec3| a.distance(b).sqrt().max(1e-3);
    let t1 = knot(p0, p1);
    let t2 = t1 + knot(p1, p2);
    let t3 = t2 + knot(p2, p3);
    let t = t1 + (t2 - t1) * t;
    let mix = |a: Vec3, b: Vec3, from: f32, to: f32| a + (b - a) * ((t - from) / (to - from));
    let a1 = mix(p0, p1, 0.0, t1);
    let a2 = mix(p1, p2, t1, t2);
    let a3 = mix(p2, p3, t2, t3);
    let b1 = mix(a1, a2, 0.0, t2);
    let b2 = mix(a2, a3, t1, t3);
    mix(b1, b2, t1, t2)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spline_interpolates_its_points_and_reproduces_a_line() {
        let points = vec![Vec3::ZERO, Vec3::X, Vec3::X * 3.0, Vec3::X * 3.5];
        let curve = YarnCurve::new(points, false, 0.1, Dye::UNDYED);
        let drawn = curve.sample(5);
        assert_eq!(drawn.len(), 16);
        assert!(drawn[5].distance(Vec3::X) < 1e-6 && drawn[10].distance(Vec3::X * 3.0) < 1e-6);
        assert!(drawn.windows(2).all(|w| w[1].x > w[0].x && w[0].y == 0.0));
    }

    #[test]
    fn closed_curve_passes_every_point_once() {
        let points = vec![Vec3::ZERO, Vec3::X, Vec3::ONE];
        let curve = YarnCurve::new(points.clone(), true, 0.1, Dye::UNDYED);
        let drawn = curve.sample(4);
        assert_eq!(drawn.len(), 12);
        for (i, p) in points.iter().enumerate() {
            assert!(drawn[4 * i].distance(*p) < 1e-6);
        }
    }

    #[test]
    fn a_ring_is_opened_where_yarn_is_taken_out() {
        let points: Vec<Vec3> = (0..6).map(|i| Vec3::X * i as f32).collect();
        let left = |closed, gone: &[u32]| -> Vec<Vec<f32>> {
            let curve = YarnCurve::new(points.clone(), closed, 0.1, Dye::UNDYED);
            let left = curve.without(|v| gone.contains(&v.0));
            assert!(gone.is_empty() || left.iter().all(|c| !c.closed && c.radii.len() == c.points.len()));
            left.iter().map(|c| c.points.iter().map(|p| p.x).collect()).collect()
        };
        assert_eq!(left(true, &[2]), [[3.0, 4.0, 5.0, 0.0, 1.0]]);
        assert_eq!(left(false, &[2]), [vec![0.0, 1.0], vec![3.0, 4.0, 5.0]]);
        assert_eq!(left(false, &[1, 4]), [[2.0, 3.0]], "single points are no yarn");
        assert_eq!(left(true, &[])[0].len(), 6);
    }

    #[test]
    fn coincident_points_stay_finite() {
        assert!(catmull_rom([Vec3::ONE; 4], 0.3).is_finite());
    }
}
