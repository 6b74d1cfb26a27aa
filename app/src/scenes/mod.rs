//! Scenes: what surrounds a fabric, by name or from a file.

mod file;
mod holds;
mod meshes;
mod skeleton;

use crate::fabric::Fabric;
use crate::files;
use anyhow::{Context, Result, bail};
use file::FRICTION;
use glam::DVec3;
use sim_core::{Body, Clamp, Material, Motion, Pin, Scene};
use std::path::Path;
use stitch_mesh::ids::{FaceId, HalfEdgeId};
use stitch_mesh::stitch_mesh::StitchMesh;
use stitch_mesh::yarn_net::{YarnNet, YarnState};

/// Scenes by name, and what they are.
pub const NAMED: [(&str, &str); 10] = [
    ("free", "no gravity, nothing around"),
    ("board", "pinned out by its borders, as a knitter blocks it"),
    ("ground", "falling on the ground"),
    ("sphere", "falling on a sphere over the ground"),
    ("form", "worn by a dress form (made for the bundled pullover)"),
    ("bust", "worn by a bust with a neck (made for the bundled slipover)"),
    ("hang", "held by its last row"),
    ("pull", "its first and last rows drawn apart"),
    ("walk", "worn by a mannequin who walks (made for the bundled cowl)"),
    ("dance", "worn by a mannequin who dances (made for the bundled sweater and t-shirt)"),
];

/// Those of them that are files, as anybody could write them.
const FILES: [(&str, &str); 5] = [
    ("bust", include_str!("../../../assets/scenes/bust.json")),
    ("hang", include_str!("../../../assets/scenes/hang.json")),
    ("pull", include_str!("../../../assets/scenes/pull.json")),
    ("walk", include_str!("../../../assets/scenes/walk.json")),
    ("dance", include_str!("../../../assets/scenes/dance.json")),
];

/// The box around yarn [m].
fn bounds(state: &YarnState) -> (DVec3, DVec3) {
    let empty = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    state.position.iter().fold(empty, |(low, high), p| (low.min(*p), high.max(*p)))
}

/// Stiffness of a spring at one node that gives way about as much as the yarn does [N/m].
fn firm(stitches: &StitchMesh, material: &Material) -> f64 {
    let spacing = stitches.mesh().edges().next().map_or(1e-3, |e| stitches.mesh().edge_length(e));
    material.stretch_stiffness() / spacing
}

/// Pins at the stitches on the borders of a fabric, or on those that `on` says, and at its cast-on and bind-off.
pub fn pinned_out(
    stitches: &StitchMesh,
    (net, state): (&YarnNet, &YarnState),
    material: &Material,
    on: impl Fn(HalfEdgeId) -> bool,
) -> Scene {
    let stiffness = firm(stitches, material);
    let held = net.nodes.iter().zip(&state.position).enumerate().filter(|(_, (node, _))| match node.face {
        Some(face) => {
            stitches.mesh().face_half_edges(face).any(|h| stitches.mesh().twin(h).is_none() && on(h))
        }
        None => node.visits.len() > 2,
    });
    let pins = held.map(|(i, (_, target))| Pin { node: i as u32, target: *target, stiffness }).collect();
    Scene { pins, ..Scene::empty() }
}

/// A clamp that holds some stitches where they are.
pub(crate) fn held(fabric: &Fabric, material: &Material, faces: &[u32], name: String) -> Clamp {
    let state = fabric.state();
    let nodes = holds::of_stitches(fabric, &faces.iter().map(|f| FaceId(*f)).collect());
    Clamp {
        name,
        nodes: nodes.into_iter().map(|n| (n, state.position[n as usize])).collect(),
        stiffness: firm(&fabric.stitches, material),
        motion: Motion::default(),
    }
}

/// A scene by name or file, placed to suit a fabric.
///
/// # Errors
/// Neither a name nor a readable file; a file that is no scene.
pub fn scene(name_or_file: &str, fabric: &Fabric, material: &Material) -> Result<Scene> {
    let state = fabric.state();
    let (low, high) = bounds(&state);
    let (middle, size) = ((low + high) / 2.0, (high - low).max_element());
    let ground = |height| Body::Ground { height, friction: FRICTION };
    let capsule = |x: f64, y: f64, radius: f64| Body::Capsule {
        from: DVec3::new(-x, y, 0.0),
        to: DVec3::new(x, y, 0.0),
        radius,
        friction: FRICTION,
    };
    Ok(match name_or_file {
        "free" => Scene::empty(),
        "board" => pinned_out(&fabric.stitches, (fabric.net(), &state), material, |_| true),
        "ground" => Scene { bodies: vec![ground(low.y - 0.1 * size)], ..Scene::default() },
        "sphere" => {
            let radius = 0.3 * size;
            let center = DVec3::new(middle.x, low.y - 1.05 * radius, middle.z);
            let sphere = Body::Sphere { center, radius, friction: FRICTION };
            Scene { bodies: vec![sphere, ground(center.y - radius)], ..Scene::default() }
        }
        "form" => Scene {
            // Shoulders, chest, waist and hips of a child's dress form; it fills the pullover, so that nothing folds.
            bodies: vec![
                capsule(0.115, 0.285, 0.030),
                capsule(0.075, 0.20, 0.083),
                capsule(0.075, 0.10, 0.085),
                capsule(0.078, 0.00, 0.086),
            ],
            // A garment swings slowly: twice the usual step shows nothing else and takes half the time.
            time_step: 0.01,
            ..Scene::default()
        },
        other => {
            let stiffness = firm(&fabric.stitches, material);
            let bundled = FILES.iter().find(|(name, _)| *name == other);
            let (text, folder) = match bundled {
                Some((_, text)) => ((*text).to_owned(), Path::new("")),
                None if Path::new(other).is_file() => {
                    let text = String::from_utf8(files::read(Path::new(other))?);
                    (
                        text.with_context(|| format!("{other} is not text"))?,
                        Path::new(other).parent().unwrap_or(Path::new("")),
                    )
                }
                None => {
                    let names: Vec<&str> = NAMED.iter().map(|(name, _)| *name).collect();
                    bail!("no scene '{other}': neither a file nor one of {}", names.join(", "))
                }
            };
            file::read(&text, folder, fabric, stiffness).with_context(|| format!("scene {other}"))?
        }
    })
}
