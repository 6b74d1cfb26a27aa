//! Bodies that the fabric collides with, and how they move. What happens in a collision is in `body_contact.rs`.

use crate::closed_mesh::ClosedMesh;
use crate::mesh_sequence::{MeshSequence, Shape};
use crate::motion::{Motion, Pose};
use glam::{DQuat, DVec3};
use serde::{Deserialize, Serialize};

/// A body.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Body {
    /// Everything under a height.
    Ground {
        /// Height of the floor [m].
        height: f64,
        /// Coefficient of friction.
        friction: f64,
    },
    /// A ball.
    Sphere {
        /// Centre [m].
        center: DVec3,
        /// Radius [m].
        radius: f64,
        /// Coefficient of friction.
        friction: f64,
    },
    /// A rod with round ends.
    Capsule {
        /// One end of the axis [m].
        from: DVec3,
        /// The other [m].
        to: DVec3,
        /// Radius [m].
        radius: f64,
        /// Coefficient of friction.
        friction: f64,
    },
    /// A box.
    Box {
        /// Centre [m].
        center: DVec3,
        /// Lengths of its sides [m].
        size: DVec3,
        /// How it is turned about its centre: a vector along the axis, as long as the angle [rad].
        turn: DVec3,
        /// Coefficient of friction.
        friction: f64,
    },
    /// A closed mesh.
    Mesh {
        /// The mesh.
        mesh: ClosedMesh,
        /// Coefficient of friction.
        friction: f64,
    },
    /// A closed mesh that changes its shape.
    Sequence {
        /// Its shapes.
        frames: MeshSequence,
        /// Coefficient of friction.
        friction: f64,
    },
    /// A body that moves.
    Moving {
        /// The body as it is before it moves.
        body: Box<Body>,
        /// How it moves.
        motion: Motion,
    },
}

impl Body {
    /// Signed distance of `x` from the surface before it moves or changes, negative inside [m], and the unit normal there.
    pub fn distance(&self, x: DVec3) -> (f64, DVec3) {
        let around = |axis: DVec3, radius: f64| {
            let r = x - axis;
            (r.length() - radius, r.try_normalize().unwrap_or(DVec3::Y))
        };
        match self {
            Self::Ground { height, .. } => (x.y - height, DVec3::Y),
            Self::Sphere { center, radius, .. } => around(*center, *radius),
            Self::Capsule { from, to, radius, .. } => {
                let axis = to - from;
                let t = ((x - from).dot(axis) / axis.length_squared().max(1e-30)).clamp(0.0, 1.0);
                around(from + t * axis, *radius)
            }
            Self::Box { center, size, turn, .. } => {
                let turn = DQuat::from_scaled_axis(*turn);
                let (distance, normal) = of_box(turn.inverse() * (x - center), 0.5 * *size);
                (distance, turn * normal)
            }
            Self::Mesh { mesh, .. } => mesh.distance(x),
            Self::Sequence { frames, .. } => {
                frames.during(0.0, 0.0).map_or((f64::INFINITY, DVec3::Y), |shape| shape.distance(x))
            }
            Self::Moving { body, .. } => body.distance(x),
        }
    }

    /// The box around it before it moves [m]; of ground there is none, and a body that changes its shape has one in each step.
    fn bounds(&self) -> Option<[DVec3; 2]> {
        Some(match self {
            Self::Ground { .. } | Self::Sequence { .. } => return None,
            Self::Sphere { center, radius, .. } => [*center - *radius, *center + *radius],
            Self::Capsule { from, to, radius, .. } => [from.min(*to) - *radius, from.max(*to) + *radius],
            Self::Box { center, size, .. } => {
                let reach = 0.5 * size.length();
                [*center - reach, *center + reach]
            }
            Self::Mesh { mesh, .. } => mesh.bounds(),
            Self::Moving { body, .. } => return body.bounds(),
        })
    }

    /// Coefficient of friction.
    pub fn friction(&self) -> f64 {
        match self {
            Self::Ground { friction, .. }
            | Self::Sphere { friction, .. }
            | Self::Capsule { friction, .. }
            | Self::Box { friction, .. }
            | Self::Mesh { friction, .. }
            | Self::Sequence { friction, .. } => *friction,
            Self::Moving { body, .. } => body.friction(),
        }
    }

    /// What it is called.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Ground { .. } => "ground",
            Self::Sphere { .. } => "sphere",
            Self::Capsule { .. } => "capsule",
            Self::Box { .. } => "box",
            Self::Mesh { .. } => "mesh",
            Self::Sequence { .. } => "mesh sequence",
            Self::Moving { body, .. } => body.kind(),
        }
    }

    /// Where it is at a time, seen from where it was before it moved.
    pub fn pose(&self, time_s: f64) -> Pose {
        match self {
            Self::Moving { motion, .. } => motion.pose(time_s),
            _ => Pose::IDENTITY,
        }
    }

    /// How it moves, if it does.
    pub fn motion(&self) -> Option<&Motion> {
        match self {
            Self::Moving { motion, .. } => Some(motion),
            _ => None,
        }
    }

    /// How it changes its shape, if it does.
    pub fn sequence(&self) -> Option<&MeshSequence> {
        match self {
            Self::Sequence { frames, .. } => Some(frames),
            Self::Moving { body, .. } => body.sequence(),
            _ => None,
        }
    }

    /// Whether every number is finite, and sizes and friction are not negative.
    pub fn is_valid(&self) -> bool {
        let (places, size) = match self {
            Self::Ground { height, .. } => ([DVec3::splat(*height); 3], 0.0),
            Self::Sphere { center, radius, .. } => ([*center; 3], *radius),
            Self::Capsule { from, to, radius, .. } => ([*from, *to, *to], *radius),
            Self::Box { center, size, turn, .. } => ([*center, *turn, *size], size.min_element()),
            Self::Mesh { .. } | Self::Sequence { .. } => ([DVec3::ZERO; 3], 0.0),
            // One motion a body: its keys can say all that two could.
            Self::Moving { body, motion } => {
                return body.is_valid() && motion.is_valid() && body.motion().is_none();
            }
        };
        let natural = |x: f64| x.is_finite() && x >= 0.0;
        places.iter().all(|p| p.is_finite()) && natural(size) && natural(self.friction())
    }
}

/// Distance and normal of a box about the origin with these half sides.
fn of_box(x: DVec3, half: DVec3) -> (f64, DVec3) {
    let beyond = x.abs() - half;
    let outside = beyond.max(DVec3::ZERO);
    if outside != DVec3::ZERO {
        let distance = outside.length();
        return (distance, outside / distance * x.signum());
    }
    // Inside, the nearest face.
    let depth = beyond.max_element();
    let axis = (0..3).find(|i| beyond[*i] == depth).unwrap_or_default();
    (depth, DVec3::AXES[axis] * x[axis].signum())
}

/// A body during a step.
pub(crate) struct Placed<'a> {
    body: &'a Body,
    /// Where it was when the step began, and is when it ends.
    poses: [Pose; 2],
    /// What it is like in the step if it changes its shape, before it moves.
    shape: Option<Shape>,
    /// The box around it during the step, if it has one [m].
    bounds: Option<[DVec3; 2]>,
    /// Length of the step [s].
    step: f64,
}

impl<'a> Placed<'a> {
    /// The body in the step of `step` from `time_s` on [s].
    pub fn new(body: &'a Body, time_s: f64, step: f64) -> Self {
        let poses = [body.pose(time_s), body.pose(time_s + step)];
        let shape = body.sequence().and_then(|frames| frames.during(time_s, step));
        let resting = shape.as_ref().map(Shape::bounds).or_else(|| body.bounds());
        let bounds = resting.map(|[low, high]| {
            let corner = |i: usize| DVec3::from_array([0, 1, 2].map(|k| [low, high][i >> k & 1][k]));
            let all = poses.iter().flat_map(|pose| (0..8).map(move |i| pose.apply(corner(i))));
            all.fold([DVec3::INFINITY, DVec3::NEG_INFINITY], |[l, h], x| [l.min(x), h.max(x)])
        });
        Self { body, poses, shape, bounds, step }
    }

    /// Whether something in a box may come nearer to it in the step than `margin` [m].
    pub fn is_near(&self, [low, high]: [DVec3; 2], margin: f64) -> bool {
        self.bounds.is_none_or(|[l, h]| low.cmple(h + margin).all() && high.cmpge(l - margin).all())
    }

    /// Signed distance of `x` from the surface at the end of the step [m], and the unit normal there.
    pub fn distance(&self, x: DVec3) -> (f64, DVec3) {
        let x = self.poses[1].undo(x);
        let (distance, normal) = match &self.shape {
            Some(shape) => shape.distance(x),
            None => self.body.distance(x),
        };
        (distance, self.poses[1].turn(normal))
    }

    /// Velocity of the point of the body that is at `x` when the step ends [m/s].
    pub fn velocity(&self, x: DVec3) -> DVec3 {
        if self.body.motion().is_none() && self.shape.is_none() {
            return DVec3::ZERO;
        }
        let resting = self.poses[1].undo(x);
        let moved = self.shape.as_ref().map_or(DVec3::ZERO, |shape| shape.moved(resting));
        (x - self.poses[0].apply(resting - moved)) / self.step
    }

    /// Coefficient of friction.
    pub fn friction(&self) -> f64 {
        self.body.friction()
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::closed_mesh::tests::cuboid;
    use crate::mesh_sequence::Frames;
    use crate::motion::Key;
    use crate::testing::finite_difference::samples;

    const FRICTION: f64 = 0.3;

    pub fn bodies() -> [Body; 5] {
        let turn = DVec3::new(0.3, -0.2, 0.5);
        let size = DVec3::new(0.6, 0.4, 0.5);
        [
            Body::Ground { height: 0.1, friction: FRICTION },
            Body::Sphere { center: DVec3::new(0.1, 0.2, 0.3), radius: 0.4, friction: FRICTION },
            Body::Capsule {
                from: DVec3::ZERO,
                to: DVec3::new(0.3, 0.5, 0.1),
                radius: 0.05,
                friction: FRICTION,
            },
            Body::Box { center: DVec3::ONE * 0.1, size, turn, friction: FRICTION },
            Body::Mesh { mesh: ClosedMesh::new(cuboid(size)).unwrap(), friction: FRICTION },
        ]
    }

    #[test]
    fn distance_is_signed() {
        let [ground, sphere, capsule, ..] = bodies();
        assert!((ground.distance(DVec3::new(3.0, 0.5, 0.0)).0 - 0.4).abs() < 1e-15);
        assert!((sphere.distance(DVec3::new(0.1, 0.2, 0.3)).0 + 0.4).abs() < 1e-15);
        assert!((capsule.distance(DVec3::new(0.0, -1.0, 0.0)).0 - 0.95).abs() < 1e-15);
        let size = DVec3::new(2.0, 4.0, 6.0);
        let cube = Body::Box { center: DVec3::X, size, turn: DVec3::ZERO, friction: 0.0 };
        assert_eq!(cube.distance(DVec3::new(1.0, 1.5, 1.0)), (-0.5, DVec3::Y));
        assert_eq!(cube.distance(DVec3::new(-3.0, 0.0, 0.0)), (3.0, DVec3::NEG_X));
        let (corner, normal) = cube.distance(DVec3::new(3.0, 3.0, 4.0));
        assert!((corner - 3f64.sqrt()).abs() < 1e-15 && normal.distance(DVec3::ONE / 3f64.sqrt()) < 1e-15);
    }

    #[test]
    fn centre_of_a_body_is_finite() {
        let centres = [DVec3::ZERO, DVec3::new(0.1, 0.2, 0.3), DVec3::ZERO, DVec3::ONE * 0.1, DVec3::ZERO];
        for (body, x) in bodies().into_iter().zip(centres) {
            assert!(body.distance(x).1.is_normalized());
        }
        let point = Body::Capsule { from: DVec3::X, to: DVec3::X, radius: 0.0, friction: 0.0 };
        assert!(point.distance(DVec3::X).1.is_normalized());
    }

    #[test]
    fn moving_bodies_take_their_surface_along() {
        let keys = [(0.0, DVec3::ZERO, DVec3::ZERO), (1.0, DVec3::new(0.5, -0.2, 0.1), DVec3::Z * 2.0)];
        let keys = keys.map(|(time_s, shift, turn)| Key { time_s, shift, turn }).to_vec();
        let motion = Motion { pivot: DVec3::new(0.2, 0.0, 0.0), keys, repeats: false };
        for body in bodies() {
            let moving = Body::Moving { body: Box::new(body.clone()), motion: motion.clone() };
            let placed = Placed::new(&moving, 0.4, 1e-3);
            for x in samples::<3>(20).map(DVec3::from_array) {
                let resting = motion.pose(0.401).undo(x);
                assert!((placed.distance(x).0 - body.distance(resting).0).abs() < 1e-12);
                let before = motion.pose(0.4).apply(resting);
                assert!(((x - before) / 1e-3 - placed.velocity(x)).length() < 1e-9);
                // A turn of 2 rad/s about the pivot, which itself moves.
                let pivot = motion.pose(0.401).apply(motion.pivot);
                let expected = DVec3::new(0.5, -0.2, 0.1) + DVec3::Z.cross(x - pivot) * 2.0;
                assert!(placed.velocity(x).distance(expected) < 5e-3, "{}", placed.velocity(x));
            }
        }
    }

    #[test]
    fn what_is_not_in_the_box_around_a_body_does_not_touch_it() {
        let keys = [(0.0, DVec3::ZERO, DVec3::ZERO), (1.0, DVec3::new(0.5, -0.2, 0.1), DVec3::Z * 2.0)];
        let keys = keys.map(|(time_s, shift, turn)| Key { time_s, shift, turn }).to_vec();
        let motion = Motion { pivot: DVec3::X, keys, repeats: false };
        for body in bodies() {
            let moving = Body::Moving { body: Box::new(body), motion: motion.clone() };
            let placed = Placed::new(&moving, 0.4, 1e-2);
            let mut far = 0;
            for x in samples::<3>(200).map(|x| 2.0 * DVec3::from_array(x)) {
                let near = placed.is_near([x, x], 0.05);
                assert!(near || placed.distance(x).0 > 0.05 - 1e-9);
                far += u32::from(!near);
            }
            assert!(far > 20 || placed.bounds.is_none(), "{}: {far}", moving.kind());
        }
    }

    #[test]
    fn frames_of_a_motion_are_the_motion() {
        let keys = [(0.0, DVec3::ZERO, DVec3::ZERO), (1.0, DVec3::new(0.5, -0.2, 0.1), DVec3::Z * 0.5)];
        let keys = keys.map(|(time_s, shift, turn)| Key { time_s, shift, turn }).to_vec();
        let motion = Motion { pivot: DVec3::ZERO, keys, repeats: false };
        let mesh = cuboid(DVec3::new(0.3, 0.2, 0.25));
        let frame =
            |i: usize| mesh.positions.iter().map(|x| motion.pose(i as f64 * 0.02).apply(*x)).collect();
        let frames = Frames {
            triangles: mesh.triangles.clone(),
            positions: (0..=50).map(frame).collect(),
            interval_s: 0.02,
            repeats: false,
        };
        let sequence = Body::Sequence { frames: MeshSequence::new(frames).unwrap(), friction: FRICTION };
        let size = 2.0 * DVec3::new(0.3, 0.2, 0.25);
        let cuboid = Body::Box { center: DVec3::ZERO, size, turn: DVec3::ZERO, friction: FRICTION };
        let moving = Body::Moving { body: Box::new(cuboid), motion: motion.clone() };
        let [a, b] = [&sequence, &moving].map(|body| Placed::new(body, 0.4, 0.01));
        for x in samples::<3>(100).map(DVec3::from_array) {
            let ((distance, normal), (expected, along)) = (a.distance(x), b.distance(x));
            assert!((distance - expected).abs() < 1e-4, "{distance} for {expected} at {x}");
            // On the surface; elsewhere a shape without an inside has no velocity of its own.
            let on = x - distance * normal;
            assert!(a.velocity(on).distance(b.velocity(on)) < 5e-3, "{} {}", a.velocity(on), b.velocity(on));
            assert!(normal.dot(along) > 0.99 || expected < 0.0, "{normal} {along}");
        }
    }

    #[test]
    fn bodies_without_sense_are_refused() {
        assert!(bodies().iter().all(Body::is_valid));
        let flat = |size: DVec3| Body::Box { center: DVec3::ZERO, size, turn: DVec3::ZERO, friction: 0.3 };
        assert!(
            !flat(DVec3::new(1.0, -1.0, 1.0)).is_valid() && !flat(DVec3::splat(f64::INFINITY)).is_valid()
        );
        assert!(!Body::Sphere { center: DVec3::ZERO, radius: -1.0, friction: 0.3 }.is_valid());
    }
}
