//! A mannequin that moves: capsules on a skeleton.
//!
//! A bone hangs on another one and turns with it; besides, it turns about its own beginning by the angles of the keys, which
//! go linearly from key to key. Each bone becomes a capsule with a rigid motion of its own, sampled from that.

use super::file::{metres, radians};
use anyhow::{Context, Result, bail};
use glam::{DAffine3, DQuat, DVec3};
use serde::Deserialize;
use sim_core::{Body, Key, Motion};
use std::collections::HashMap;
use std::f64::consts::TAU;

/// Time between two samples [s].
const SAMPLE: f64 = 1.0 / 60.0;

/// Samples at most: ten minutes.
const MOST_SAMPLES: f64 = 36_000.0;

/// Bones and how they move.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Skeleton {
    bones: Vec<Bone>,
    #[serde(default)]
    keys: Vec<SkeletonKey>,
    #[serde(default)]
    repeat: bool,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Bone {
    name: String,
    /// The bone that it hangs on, one of those before.
    on: Option<String>,
    from: [f64; 3],
    to: [f64; 3],
    radius: f64,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct SkeletonKey {
    /// [s]
    at: f64,
    /// Shift of the whole.
    #[serde(default)]
    by: [f64; 3],
    /// Turns of bones, by their names.
    #[serde(default)]
    turns: HashMap<String, [f64; 3]>,
}

impl Skeleton {
    /// A capsule for each bone.
    pub(super) fn bodies(&self, origin: DVec3, friction: f64) -> Result<Vec<Body>> {
        let parents = self.parents()?;
        let ends: Vec<[DVec3; 2]> =
            self.bones.iter().map(|b| [b.from, b.to].map(|mm| origin + metres(mm))).collect();
        let bodies = self.bones.iter().zip(&ends).map(|(bone, [from, to])| Body::Capsule {
            from: *from,
            to: *to,
            radius: 1e-3 * bone.radius,
            friction,
        });
        let (Some(first), Some(last)) = (self.keys.first(), self.keys.last()) else {
            return Ok(bodies.collect());
        };
        let samples = ((last.at - first.at) / SAMPLE).ceil().max(1.0);
        if !(samples <= MOST_SAMPLES && self.keys.windows(2).all(|k| k[0].at < k[1].at)) {
            bail!("the keys of the skeleton are not in order of time, or go on for more than ten minutes");
        }
        let mut keys: Vec<Vec<Key>> = vec![Vec::new(); self.bones.len()];
        for sample in 0..=samples as usize {
            let time_s = first.at + (last.at - first.at) * sample as f64 / samples;
            for (bone, pose) in self.poses(&parents, &ends, time_s).into_iter().enumerate() {
                let (_, rotation, _) = pose.to_scale_rotation_translation();
                let before = keys[bone].last().map_or(DVec3::ZERO, |k: &Key| k.turn);
                let pivot = ends[bone][0];
                let shift = pose.transform_point3(pivot) - pivot;
                keys[bone].push(Key { time_s, shift, turn: nearest_turn(rotation, before) });
            }
        }
        let moving = |((body, keys), [pivot, _]): ((Body, Vec<Key>), &[DVec3; 2])| {
            let motion = Motion { pivot: *pivot, keys, repeats: self.repeat && self.keys.len() > 1 };
            Body::Moving { body: Box::new(body), motion }
        };
        Ok(bodies.zip(keys).zip(&ends).map(moving).collect())
    }

    /// The bone on which each hangs.
    fn parents(&self) -> Result<Vec<Option<usize>>> {
        let mut known: HashMap<&str, usize> = HashMap::new();
        let mut parents = Vec::new();
        for (i, bone) in self.bones.iter().enumerate() {
            let parent = |on: &String| {
                let found = known.get(on.as_str()).copied();
                found
                    .with_context(|| format!("bone '{}' hangs on '{on}', which is none before it", bone.name))
            };
            parents.push(bone.on.as_ref().map(parent).transpose()?);
            if known.insert(&bone.name, i).is_some() {
                bail!("two bones are called '{}'", bone.name);
            }
        }
        for key in &self.keys {
            if let Some(name) = key.turns.keys().find(|n| !known.contains_key(n.as_str())) {
                bail!("the key at {} s turns '{name}', which is no bone", key.at);
            }
        }
        Ok(parents)
    }

    /// Where the bones are at a time, seen from where they began.
    fn poses(&self, parents: &[Option<usize>], ends: &[[DVec3; 2]], time_s: f64) -> Vec<DAffine3> {
        let next = self.keys.partition_point(|k| k.at <= time_s);
        let (a, b) = (&self.keys[next.saturating_sub(1)], &self.keys[next.min(self.keys.len() - 1)]);
        let part = if b.at > a.at { (time_s - a.at) / (b.at - a.at) } else { 0.0 };
        let mut poses: Vec<DAffine3> = Vec::new();
        for (i, bone) in self.bones.iter().enumerate() {
            let turn = |k: &SkeletonKey| k.turns.get(&bone.name).map_or(DVec3::ZERO, |t| radians(*t));
            let rotation = DQuat::from_scaled_axis(turn(a).lerp(turn(b), part));
            let pivot = ends[i][0];
            let own = DAffine3::from_rotation_translation(rotation, pivot - rotation * pivot);
            let whole = DAffine3::from_translation(metres(a.by).lerp(metres(b.by), part));
            poses.push(parents[i].map_or(whole, |p| poses[p]) * own);
        }
        poses
    }
}

/// The rotation vector that is nearest to the one before: a turn of a whole round is a turn, too.
fn nearest_turn(rotation: DQuat, before: DVec3) -> DVec3 {
    let turn = rotation.to_scaled_axis();
    let axis = turn.normalize_or_zero();
    let around = [-2.0, -1.0, 0.0, 1.0, 2.0].map(|rounds| turn + rounds * TAU * axis);
    around.into_iter().min_by(|a, b| a.distance(before).total_cmp(&b.distance(before))).unwrap_or(turn)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn skeleton(text: &str) -> Skeleton {
        serde_json::from_str(text).unwrap()
    }

    #[test]
    fn a_shin_goes_with_its_thigh() {
        let leg = skeleton(
            r#"{"bones": [{"name": "thigh", "from": [0,0,0], "to": [0,-400,0], "radius": 60},
                          {"name": "shin", "on": "thigh", "from": [0,-400,0], "to": [0,-800,0], "radius": 40}],
                "keys": [{"at": 0}, {"at": 1, "by": [100,0,0], "turns": {"thigh": [90,0,0], "shin": [-90,0,0]}}]}"#,
        );
        let bodies = leg.bodies(DVec3::Z, 0.3).unwrap();
        let end = |i: usize, x: DVec3| bodies[i].pose(1.0).apply(x + DVec3::Z);
        // The thigh points to −z, the shin straight down from its end.
        assert!(end(0, DVec3::new(0.0, -0.4, 0.0)).distance(DVec3::new(0.1, 0.0, 0.6)) < 1e-9);
        assert!(end(1, DVec3::new(0.0, -0.8, 0.0)).distance(DVec3::new(0.1, -0.4, 0.6)) < 1e-9);
        let half = bodies[0].pose(0.5).apply(DVec3::new(0.0, -0.4, 1.0));
        let expected = DVec3::new(0.05, -0.4 * 0.5f64.sqrt(), 1.0 - 0.4 * 0.5f64.sqrt());
        assert!(half.distance(expected) < 1e-3, "{half}");
    }

    #[test]
    fn bones_that_do_not_exist_are_named() {
        let on =
            skeleton(r#"{"bones": [{"name": "a", "on": "b", "from": [0,0,0], "to": [0,1,0], "radius": 1}]}"#);
        assert!(on.bodies(DVec3::ZERO, 0.3).unwrap_err().to_string().contains("hangs on 'b'"));
        let turned = skeleton(r#"{"bones": [], "keys": [{"at": 0, "turns": {"arm": [0,0,0]}}]}"#);
        assert!(turned.bodies(DVec3::ZERO, 0.3).unwrap_err().to_string().contains("'arm', which is no bone"));
    }
}
