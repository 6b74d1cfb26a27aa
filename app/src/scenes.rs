//! Scenes: what surrounds a fabric, by name or from a file.

use crate::fabric::Fabric;
use crate::files;
use anyhow::{Context, Result, bail};
use glam::DVec3;
use sim_core::{Body, Material, Pin, Scene};
use std::path::Path;
use stitch_mesh::ids::HalfEdgeId;
use stitch_mesh::stitch_mesh::StitchMesh;
use stitch_mesh::yarn_net::{YarnNet, YarnState};

/// Friction of wool on a body.
const FRICTION: f64 = 0.4;

/// Scenes by name, and what they are.
pub const NAMED: [(&str, &str); 5] = [
    ("free", "no gravity, nothing around"),
    ("board", "pinned out by its borders, as a knitter blocks it"),
    ("ground", "falling on the ground"),
    ("sphere", "falling on a sphere over the ground"),
    ("form", "worn by a dress form (made for the bundled pullover)"),
];

/// Pins at the stitches on the borders of a fabric, or on those that `on` says, and at its cast-on and bind-off.
pub fn pinned_out(
    stitches: &StitchMesh,
    (net, state): (&YarnNet, &YarnState),
    material: &Material,
    on: impl Fn(HalfEdgeId) -> bool,
) -> Scene {
    let spacing = stitches.mesh().edges().next().map_or(1e-3, |e| stitches.mesh().edge_length(e));
    let stiffness = material.stretch_stiffness() / spacing;
    let held = net.nodes.iter().zip(&state.position).enumerate().filter(|(_, (node, _))| match node.face {
        Some(face) => {
            stitches.mesh().face_half_edges(face).any(|h| stitches.mesh().twin(h).is_none() && on(h))
        }
        None => node.visits.len() > 2,
    });
    let pins = held.map(|(i, (_, target))| Pin { node: i as u32, target: *target, stiffness }).collect();
    Scene { pins, ..Scene::empty() }
}

/// A scene by name or file, placed to suit a fabric.
///
/// # Errors
/// Neither a name nor a readable file; a file that is no scene.
pub fn scene(name_or_file: &str, fabric: &Fabric, material: &Material) -> Result<Scene> {
    let state = fabric.state();
    let (low, high) = state
        .position
        .iter()
        .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(lo, hi), p| (lo.min(*p), hi.max(*p)));
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
        "board" => pinned_out(&fabric.stitches, (&fabric.net, &state), material, |_| true),
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
        file if Path::new(file).exists() => {
            let bytes = files::read(Path::new(file))?;
            serde_json::from_slice(&bytes).with_context(|| format!("{file} is not a scene"))?
        }
        unknown => {
            let names: Vec<&str> = NAMED.iter().map(|(name, _)| *name).collect();
            bail!("no scene '{unknown}': neither a file nor one of {}", names.join(", "))
        }
    })
}
