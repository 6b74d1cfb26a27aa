//! A body that changes its shape: closed meshes of one topology, one after another in time.
//!
//! # Theory
//! Between two frames every vertex goes linearly. Within a step the body is taken where it is when the step ends: its distance
//! is the exact one to the triangles (`closed_surface.rs`), and the velocity of its surface at a point is that of the point of the
//! nearest triangle, (Σ wᵢ xᵢ(t + h) − Σ wᵢ xᵢ(t))/h with w its barycentric coordinates.
//!
//! # Practice
//! A grid of distances, as for a mesh that keeps its shape, would have to be made anew every step; the tree of triangles costs
//! about half a microsecond a triangle and step, and only nodes in the box around the body ask it.

use crate::closed_surface::{ClosedMeshError, Surface, Triangles};
use glam::DVec3;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Meshes that cannot be a body together.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SequenceError {
    /// No frames.
    #[error("a sequence needs at least one mesh")]
    Empty,
    /// The first frame, or one of the others, is no body.
    #[error("frame {frame}: {error}")]
    Mesh {
        /// The frame, from 0.
        frame: usize,
        /// What is wrong with it.
        error: ClosedMeshError,
    },
    /// A frame with another number of vertices than the first, or one that is not finite.
    #[error("frame {frame} does not have the {vertices} vertices of the first, or one of them is not finite")]
    Vertices {
        /// The frame, from 0.
        frame: usize,
        /// Vertices of the first.
        vertices: usize,
    },
    /// No time between two frames.
    #[error("the time from frame to frame is {0} s, and must be positive")]
    Interval(f64),
}

/// Closed meshes of one topology, one after another.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(try_from = "Frames", into = "Frames")]
pub struct MeshSequence(Arc<Frames>);

/// The frames of a [`MeshSequence`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Frames {
    /// Three corners each, the same in all frames.
    pub triangles: Vec<[u32; 3]>,
    /// [frame_count][vertex_count] [m].
    pub positions: Vec<Vec<DVec3>>,
    /// Time from frame to frame [s].
    pub interval_s: f64,
    /// Whether the first frame follows the last one again.
    pub repeats: bool,
}

impl PartialEq for MeshSequence {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0) || self.0 == other.0
    }
}

impl TryFrom<Frames> for MeshSequence {
    type Error = SequenceError;

    fn try_from(frames: Frames) -> Result<Self, SequenceError> {
        Self::new(frames)
    }
}

impl From<MeshSequence> for Frames {
    fn from(sequence: MeshSequence) -> Self {
        (*sequence.0).clone()
    }
}

impl MeshSequence {
    /// The body of these frames, all facing outwards or all inwards.
    ///
    /// # Errors
    /// What is wrong with which frame.
    pub fn new(mut frames: Frames) -> Result<Self, SequenceError> {
        if !(frames.interval_s > 0.0 && frames.interval_s.is_finite()) {
            return Err(SequenceError::Interval(frames.interval_s));
        }
        let first = frames.positions.first().ok_or(SequenceError::Empty)?;
        let vertices = first.len();
        let fits = |p: &Vec<DVec3>| p.len() == vertices && p.iter().all(|x| x.is_finite());
        if let Some(frame) = frames.positions.iter().position(|p| !fits(p)) {
            return Err(SequenceError::Vertices { frame, vertices });
        }
        let mut mesh =
            Triangles { positions: first.clone(), triangles: std::mem::take(&mut frames.triangles) };
        let wrong = |error| SequenceError::Mesh { frame: 0, error };
        mesh.face_outwards().map_err(wrong)?;
        frames.triangles = Surface::new(mesh).map_err(wrong)?.mesh.triangles;
        Ok(Self(Arc::new(frames)))
    }

    /// Its triangles at a time [s].
    pub fn at(&self, time_s: f64) -> Triangles {
        Triangles { positions: self.positions(time_s), triangles: self.0.triangles.clone() }
    }

    fn positions(&self, time_s: f64) -> Vec<DVec3> {
        let count = self.0.positions.len();
        let place = time_s / self.0.interval_s;
        let place = if self.0.repeats {
            place.rem_euclid(count as f64)
        } else {
            place.clamp(0.0, (count - 1) as f64)
        };
        let (before, part) = (place as usize % count, place.fract());
        let after = if self.0.repeats { (before + 1) % count } else { (before + 1).min(count - 1) };
        let [a, b] = [before, after].map(|frame| &self.0.positions[frame]);
        a.iter().zip(b).map(|(a, b)| a.lerp(*b, part)).collect()
    }

    /// Its shape in the step of `step` from `time_s` on [s]. None where the triangles of no frame are closed, which
    /// [`Self::new`] has ruled out.
    pub(crate) fn during(&self, time_s: f64, step: f64) -> Option<Shape> {
        let end = self.at(time_s + step);
        let moved = self.positions(time_s).iter().zip(&end.positions).map(|(a, b)| *b - *a).collect();
        Some(Shape { surface: Surface::new(end).ok()?, moved })
    }
}

/// A body that changes its shape, during a step.
pub(crate) struct Shape {
    /// At the end of the step.
    surface: Surface,
    /// How far each vertex has moved in the step [m].
    moved: Vec<DVec3>,
}

impl Shape {
    /// Signed distance of `x` from the surface at the end of the step [m], and the unit normal there.
    pub fn distance(&self, x: DVec3) -> (f64, DVec3) {
        self.surface.nearest(x).map_or((f64::INFINITY, DVec3::Y), |n| (n.distance, n.normal))
    }

    /// How far the point of the surface that ends nearest to `x` has moved in the step [m].
    pub fn moved(&self, x: DVec3) -> DVec3 {
        self.surface.nearest(x).map_or(DVec3::ZERO, |n| {
            let corners = self.surface.mesh.triangles[n.triangle];
            corners.iter().zip(n.weights).map(|(v, w)| w * self.moved[*v as usize]).sum()
        })
    }

    /// The box around it from the beginning to the end of the step [m].
    pub fn bounds(&self) -> [DVec3; 2] {
        let both = self.surface.mesh.positions.iter().zip(&self.moved).flat_map(|(x, m)| [*x, *x - *m]);
        both.fold([DVec3::INFINITY, DVec3::NEG_INFINITY], |[low, high], x| [low.min(x), high.max(x)])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::closed_mesh::tests::{ball, cuboid};

    /// A ball that grows from 0.1 to 0.2 m in a second, by two frames.
    fn growing(repeats: bool) -> Frames {
        let Triangles { positions, triangles } = ball(0.1);
        let larger = positions.iter().map(|x| 2.0 * *x).collect();
        Frames { triangles, positions: vec![positions, larger], interval_s: 1.0, repeats }
    }

    #[test]
    fn a_ball_that_grows_has_the_distance_of_its_radius_then() {
        let sequence = MeshSequence::new(growing(false)).unwrap();
        let shape = sequence.during(0.49, 0.01).unwrap();
        for x in [DVec3::new(0.3, 0.1, -0.2), DVec3::new(0.05, -0.02, 0.06), DVec3::Y * 0.149] {
            let (distance, normal) = shape.distance(x);
            // The triangles lie a little inside of the sphere.
            assert!((distance - (x.length() - 0.15)).abs() < 5e-4, "{distance} at {x}");
            assert!(normal.dot(x.normalize()) > 0.99);
            // It grows by a tenth of a metre a second.
            assert!(shape.moved(x).distance(1e-3 * x.normalize()) < 3e-5, "{}", shape.moved(x));
        }
        let [low, high] = shape.bounds();
        assert!((high - 0.15).abs().max_element() < 1e-9 && (low + 0.15).abs().max_element() < 1e-9);
    }

    #[test]
    fn after_the_last_frame_it_stays_or_begins_again() {
        let largest = |repeats, time_s| {
            let sequence = MeshSequence::new(growing(repeats)).unwrap();
            sequence.at(time_s).positions.iter().map(|x| x.length()).fold(0.0, f64::max)
        };
        assert!((largest(false, 7.3) - 0.2).abs() < 1e-12 && (largest(false, -1.0) - 0.1).abs() < 1e-12);
        // Going back to the first frame takes as long as from any frame to the next.
        assert!((largest(true, 1.25) - 0.175).abs() < 1e-12 && (largest(true, 2.5) - 0.15).abs() < 1e-12);
    }

    #[test]
    fn frames_that_do_not_belong_together_are_refused() {
        let refused = |frames| MeshSequence::new(frames).unwrap_err().to_string();
        let mut short = growing(false);
        short.positions[1].pop();
        assert!(refused(short).contains("frame 1 does not have the"));
        let mut wild = growing(false);
        wild.positions[1][3].x = f64::NAN;
        assert!(refused(wild).contains("frame 1"));
        let Triangles { positions, mut triangles } = cuboid(DVec3::ONE);
        triangles.pop();
        let open = Frames { triangles, positions: vec![positions], interval_s: 1.0, repeats: false };
        assert!(refused(open).contains("frame 0: the mesh is not closed"));
        assert!(refused(Frames { interval_s: 0.0, ..growing(false) }).contains("must be positive"));
        assert!(refused(Frames { positions: vec![], ..growing(false) }).contains("at least one mesh"));
    }

    #[test]
    fn a_sequence_is_written_and_read() {
        let sequence = MeshSequence::new(growing(true)).unwrap();
        assert_eq!(MeshSequence::try_from(Frames::from(sequence.clone())).unwrap(), sequence);
    }
}
