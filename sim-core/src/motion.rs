//! Rigid motions by keyframes: how bodies and clamps move.
//!
//! # Theory
//! A pose is x ↦ R (x − c) + c + t: a turn R about the pivot c, then a shift t. Between two keys t and the rotation vector of R
//! (axis times angle) go linearly with time, so a key may turn by any number of rounds. Before the first key and after the
//! last nothing moves, or the motion begins anew where it has come to: a walk goes on walking.
//!
//! The velocity of a point that moves along is what the step sees: where it gets to in the step, by its length.

use glam::{DQuat, DVec3};
use serde::{Deserialize, Serialize};

/// Where something is at a time.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Key {
    /// The time since the scene began [s].
    pub time_s: f64,
    /// t, shift from where it began [m].
    #[serde(default)]
    pub shift: DVec3,
    /// Turn from how it began: a vector along its axis, as long as the angle [rad].
    #[serde(default)]
    pub turn: DVec3,
}

/// A rigid motion.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Motion {
    /// c, the point that it turns about [m].
    #[serde(default)]
    pub pivot: DVec3,
    /// Where it is when, in order of time; none for rest.
    pub keys: Vec<Key>,
    /// Whether it begins anew after the last key.
    #[serde(default)]
    pub repeats: bool,
}

/// A place in space: x ↦ R x + t.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    rotation: DQuat,
    shift: DVec3,
}

impl Pose {
    /// Nothing moved.
    pub const IDENTITY: Self = Self { rotation: DQuat::IDENTITY, shift: DVec3::ZERO };

    /// R.
    pub(crate) fn rotation(&self) -> DQuat {
        self.rotation
    }

    /// Where a point of the resting thing is.
    pub fn apply(&self, x: DVec3) -> DVec3 {
        self.rotation * x + self.shift
    }

    /// The point of the resting thing that is at `x`.
    pub fn undo(&self, x: DVec3) -> DVec3 {
        self.rotation.inverse() * (x - self.shift)
    }

    /// A direction of the resting thing.
    pub fn turn(&self, direction: DVec3) -> DVec3 {
        self.rotation * direction
    }
}

impl Motion {
    /// The pose at a time [s].
    pub fn pose(&self, time_s: f64) -> Pose {
        let (Some(first), Some(last)) = (self.keys.first(), self.keys.last()) else { return Pose::IDENTITY };
        let (mut time, mut from) = (time_s, DVec3::ZERO);
        if self.repeats && time > last.time_s {
            let round = last.time_s - first.time_s;
            let rounds = ((time - first.time_s) / round).floor();
            time -= rounds * round;
            from = rounds * (last.shift - first.shift);
        }
        let next = self.keys.partition_point(|k| k.time_s <= time);
        let (a, b) = (&self.keys[next.saturating_sub(1)], &self.keys[next.min(self.keys.len() - 1)]);
        let part = if b.time_s > a.time_s { (time - a.time_s) / (b.time_s - a.time_s) } else { 0.0 };
        let rotation = DQuat::from_scaled_axis(a.turn.lerp(b.turn, part));
        let shift = from + a.shift.lerp(b.shift, part);
        Pose { rotation, shift: shift + self.pivot - rotation * self.pivot }
    }

    /// Whether every number is finite, and the keys are in order of time.
    pub fn is_valid(&self) -> bool {
        let finite = |k: &Key| k.time_s.is_finite() && k.shift.is_finite() && k.turn.is_finite();
        let in_order = self.keys.windows(2).all(|k| k[0].time_s < k[1].time_s);
        self.pivot.is_finite()
            && self.keys.iter().all(finite)
            && in_order
            && !(self.repeats && self.keys.len() < 2)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    fn key(time_s: f64, shift: DVec3, turn: DVec3) -> Key {
        Key { time_s, shift, turn }
    }

    #[test]
    fn keys_are_reached_and_held() {
        let motion = Motion {
            pivot: DVec3::X,
            keys: vec![key(1.0, DVec3::ZERO, DVec3::ZERO), key(3.0, DVec3::Y, DVec3::Z * PI)],
            repeats: false,
        };
        let at = |t: f64| motion.pose(t).apply(DVec3::new(2.0, 0.0, 0.0));
        assert_eq!(at(0.0), DVec3::new(2.0, 0.0, 0.0));
        assert!(at(2.0).distance(DVec3::new(1.0, 1.5, 0.0)) < 1e-12, "a quarter turn about the pivot");
        assert!(at(3.0).distance(DVec3::new(0.0, 1.0, 0.0)) < 1e-12 && at(9.0) == at(3.0));
        let pose = motion.pose(1.7);
        assert!(pose.undo(pose.apply(DVec3::ONE)).distance(DVec3::ONE) < 1e-12);
        assert_eq!(Motion::default().pose(5.0), Pose::IDENTITY);
    }

    #[test]
    fn a_walk_goes_on() {
        let keys = vec![key(0.0, DVec3::ZERO, DVec3::ZERO), key(2.0, DVec3::X, DVec3::ZERO)];
        let motion = Motion { pivot: DVec3::ZERO, keys, repeats: true };
        for t in [0.5, 1.9, 2.1, 7.3] {
            assert!((motion.pose(t).apply(DVec3::ZERO).x - 0.5 * t).abs() < 1e-12);
        }
    }

    #[test]
    fn motions_out_of_order_are_refused() {
        let motion = |times: &[f64], repeats| Motion {
            keys: times.iter().map(|t| key(*t, DVec3::ZERO, DVec3::ZERO)).collect(),
            repeats,
            ..Motion::default()
        };
        assert!(motion(&[], false).is_valid() && motion(&[0.0, 1.0], true).is_valid());
        assert!(!motion(&[1.0, 1.0], false).is_valid() && !motion(&[0.0], true).is_valid());
        assert!(!motion(&[f64::NAN], false).is_valid());
    }
}
