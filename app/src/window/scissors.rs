//! Scissors: the yarn under the pointer is cut where the pointer is.
//!
//! What is under it is looked for on the curves that are drawn, not on the nodes: at a contact the nodes of several yarns are one,
//! and only the curves tell which of them lies in front.

use super::editor::Editor;
use crate::command::Command;
use glam::Vec3;
use render::Ray;
use stitch_mesh::ids::VisitId;
use stitch_mesh::yarn_curves::YarnCurves;

/// Yarn counts as hit up to so many of its radii from its axis: curves bulge a little beyond their chords.
const REACH: f32 = 1.3;

impl Editor {
    /// Cuts the yarn that a ray meets first.
    pub(super) fn cut_at(&mut self, ray: Ray) {
        let Some(snapshot) = self.yarn() else { return };
        match met(&self.shown_yarn(snapshot), ray) {
            Some(visit) => self.act(Command::CutYarnAt { visit: visit.0 }),
            None => self.error = Some("there is no yarn under the scissors".into()),
        }
    }
}

/// The visit at which the segment begins that a ray meets first.
fn met(yarn: &YarnCurves, ray: Ray) -> Option<VisitId> {
    let spans = yarn.curves.iter().flat_map(|curve| {
        (0..curve.span_count()).filter_map(move |i| {
            let [_, from, to, _] = curve.span(i);
            let (distance, depth) = nearest(from, to, ray);
            (depth > 0.0 && distance < REACH * curve.radii[i]).then_some((depth, curve.visits[i]))
        })
    });
    spans.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, visit)| visit)
}

/// How near a ray comes to a line from point to point, and how far along the ray that is [m].
fn nearest(from: Vec3, to: Vec3, ray: Ray) -> (f32, f32) {
    let direction = ray.direction.normalize();
    let across = |v: Vec3| v - direction * v.dot(direction);
    // Seen along the ray it is a point, and the line a line in a plane.
    let (start, way) = (across(from - ray.origin), across(to - from));
    let t = (-start.dot(way) / way.length_squared().max(f32::MIN_POSITIVE)).clamp(0.0, 1.0);
    ((start + way * t).length(), (from.lerp(to, t) - ray.origin).dot(direction))
}

#[cfg(test)]
mod tests {
    use super::*;
    use stitch_mesh::dye::Dye;
    use stitch_mesh::yarn_curves::YarnCurve;

    #[test]
    fn the_yarn_in_front_is_met_and_none_beside() {
        let line = |z: f32, y: f32| {
            let points = (0..5).map(|i| Vec3::new(i as f32, y, z)).collect();
            YarnCurve::new(points, false, 0.1, Dye::UNDYED)
        };
        let mut yarn = YarnCurves { curves: vec![line(0.0, 0.0), line(1.0, 0.0), line(3.0, 1.0)] };
        yarn.curves[1].visits.iter_mut().for_each(|v| v.0 += 5);
        let down = |x: f32, y: f32| Ray { origin: Vec3::new(x, y, 10.0), direction: Vec3::NEG_Z };
        assert_eq!(met(&yarn, down(2.4, 0.05)), Some(VisitId(7)));
        assert_eq!(met(&yarn, down(2.4, 0.3)), None);
        let up = Ray { origin: Vec3::new(0.2, 0.0, -1.0), direction: Vec3::Z };
        assert_eq!(met(&yarn, up), Some(VisitId(0)));
    }
}
