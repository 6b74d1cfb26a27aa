//! Scene files, as a person writes them: see `docs/scenes.md`. Lengths are in millimetres, angles in degrees.

use super::holds::{self, Hold};
use super::meshes::{MeshFile, SequenceFiles};
use super::skeleton::Skeleton;
use crate::fabric::Fabric;
use anyhow::{Context, Result, bail};
use glam::DVec3;
use serde::Deserialize;
use sim_core::{Body, Key, Motion, Scene};
use std::path::Path;

/// Friction of wool on a body.
pub(super) const FRICTION: f64 = 0.4;

/// How long something with a speed goes on [s].
const LONG: f64 = 3600.0;

/// Metres from millimetres.
pub(super) fn metres(mm: [f64; 3]) -> DVec3 {
    1e-3 * DVec3::from_array(mm)
}

/// Radians from degrees.
pub(super) fn radians(degrees: [f64; 3]) -> DVec3 {
    DVec3::from_array(degrees.map(f64::to_radians))
}

#[derive(Deserialize)]
#[serde(default, deny_unknown_fields)]
struct SceneFile {
    /// [m/s²]
    gravity: [f64; 3],
    /// [kg/m³]
    air: f64,
    time_step_ms: f64,
    origin: Origin,
    hold: Vec<Hold>,
    bodies: Vec<BodyEntry>,
}

impl Default for SceneFile {
    fn default() -> Self {
        Self {
            gravity: Scene::default().gravity.to_array(),
            air: 0.0,
            time_step_ms: 1e3 * Scene::default().time_step,
            origin: Origin::World,
            hold: Vec::new(),
            bodies: Vec::new(),
        }
    }
}

/// What coordinates are counted from.
#[derive(Clone, Copy, Deserialize)]
#[serde(rename_all = "snake_case")]
enum Origin {
    /// The origin of the input mesh.
    World,
    /// The middle of the box around the fabric.
    Fabric,
    /// The middle of the bottom of that box.
    Below,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct BodyEntry {
    ground: Option<Ground>,
    sphere: Option<Sphere>,
    capsule: Option<Capsule>,
    #[serde(rename = "box")]
    cuboid: Option<Cuboid>,
    mesh: Option<MeshFile>,
    mesh_sequence: Option<SequenceFiles>,
    skeleton: Option<Skeleton>,
    friction: Option<f64>,
    #[serde(rename = "move")]
    moves: Option<Move>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Ground {
    height: f64,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Sphere {
    center: [f64; 3],
    radius: f64,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Capsule {
    from: [f64; 3],
    to: [f64; 3],
    radius: f64,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Cuboid {
    center: [f64; 3],
    size: [f64; 3],
    #[serde(default)]
    turn: [f64; 3],
}

/// How something moves: at a speed, or by keys.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Move {
    /// [mm/s]
    speed: Option<[f64; 3]>,
    #[serde(default)]
    keys: Vec<MoveKey>,
    /// What it turns about.
    about: Option<[f64; 3]>,
    #[serde(default)]
    repeat: bool,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct MoveKey {
    /// [s]
    at: f64,
    #[serde(default)]
    by: [f64; 3],
    #[serde(default)]
    turn: [f64; 3],
}

impl Move {
    /// The motion of something whose middle is at `middle`, with coordinates counted from `origin`.
    pub(super) fn motion(&self, middle: DVec3, origin: DVec3) -> Result<Motion> {
        let pivot = self.about.map_or(middle, |about| origin + metres(about));
        let rest = Key { time_s: 0.0, shift: DVec3::ZERO, turn: DVec3::ZERO };
        let keys = match (self.speed, self.keys.is_empty()) {
            (Some(speed), true) => vec![rest, Key { time_s: LONG, shift: LONG * metres(speed), ..rest }],
            (None, false) => {
                let key = |k: &MoveKey| Key { time_s: k.at, shift: metres(k.by), turn: radians(k.turn) };
                self.keys.iter().map(key).collect()
            }
            _ => bail!("'move' takes either 'speed' or 'keys'"),
        };
        Ok(Motion { pivot, keys, repeats: self.repeat })
    }
}

impl BodyEntry {
    /// The bodies that it stands for: of a skeleton, all bones.
    fn bodies(&self, origin: DVec3, folder: &Path) -> Result<Vec<Body>> {
        let friction = self.friction.unwrap_or(FRICTION);
        let at = |mm: [f64; 3]| origin + metres(mm);
        let mut found: Vec<(Body, DVec3)> = Vec::new();
        if let Some(Ground { height }) = self.ground {
            found.push((Body::Ground { height: origin.y + 1e-3 * height, friction }, origin));
        }
        if let Some(Sphere { center, radius }) = self.sphere {
            found.push((Body::Sphere { center: at(center), radius: 1e-3 * radius, friction }, at(center)));
        }
        if let Some(Capsule { from, to, radius }) = self.capsule {
            let (from, to) = (at(from), at(to));
            found.push((Body::Capsule { from, to, radius: 1e-3 * radius, friction }, (from + to) / 2.0));
        }
        if let Some(Cuboid { center, size, turn }) = self.cuboid {
            let (center, size, turn) = (at(center), metres(size), radians(turn));
            found.push((Body::Box { center, size, turn, friction }, center));
        }
        if let Some(file) = &self.mesh {
            let mesh = file.read(origin, folder)?;
            let middle = middle(&mesh.triangles().positions);
            found.push((Body::Mesh { mesh, friction }, middle));
        }
        if let Some(files) = &self.mesh_sequence {
            let frames = files.read(origin, folder)?;
            let middle = middle(&frames.at(0.0).positions);
            found.push((Body::Sequence { frames, friction }, middle));
        }
        match (&self.skeleton, found.len()) {
            (Some(skeleton), 0) if self.moves.is_none() => skeleton.bodies(origin, friction),
            (Some(_), 0) => bail!("a skeleton moves by its own keys, not by 'move'"),
            (None, 1) => found
                .into_iter()
                .map(|(body, middle)| {
                    let Some(moves) = &self.moves else { return Ok(body) };
                    Ok(Body::Moving { motion: moves.motion(middle, origin)?, body: Box::new(body) })
                })
                .collect(),
            _ => bail!(
                "has to be one of 'ground', 'sphere', 'capsule', 'box', 'mesh', 'mesh_sequence', 'skeleton'"
            ),
        }
    }
}

fn middle(positions: &[DVec3]) -> DVec3 {
    positions.iter().sum::<DVec3>() / positions.len() as f64
}

/// The scene that a text describes, for a fabric; files that it names are in `folder`.
///
/// # Errors
/// Where it cannot be read, by line and column; what it asks for that is not there.
pub(super) fn read(text: &str, folder: &Path, fabric: &Fabric, stiffness: f64) -> Result<Scene> {
    // Comments are blanked, so that errors keep their lines.
    let lines = text.lines().map(|l| if l.trim_start().starts_with('#') { "" } else { l });
    let file: SceneFile = serde_json::from_str(&lines.collect::<Vec<_>>().join("\n"))?;
    let state = fabric.state();
    let (low, high) = super::bounds(&state);
    let origin = match file.origin {
        Origin::World => DVec3::ZERO,
        Origin::Fabric => (low + high) / 2.0,
        Origin::Below => DVec3::new((low.x + high.x) / 2.0, low.y, (low.z + high.z) / 2.0),
    };
    let mut bodies = Vec::new();
    for (i, entry) in file.bodies.iter().enumerate() {
        bodies.extend(entry.bodies(origin, folder).with_context(|| format!("body {i}"))?);
    }
    let clamp = |(i, hold): (usize, &Hold)| {
        let name = hold.name.clone().unwrap_or_else(|| format!("hold {i}"));
        holds::clamp(hold, &name, fabric, &state, origin, stiffness).with_context(|| name.clone())
    };
    let scene = Scene {
        gravity: DVec3::from_array(file.gravity),
        air: file.air,
        bodies,
        pins: Vec::new(),
        clamps: file.hold.iter().enumerate().map(clamp).collect::<Result<_>>()?,
        time_step: 1e-3 * file.time_step_ms,
    };
    scene.validate(fabric.net().nodes.len())?;
    Ok(scene)
}
