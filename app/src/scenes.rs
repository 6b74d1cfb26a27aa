//! Scenes: what surrounds a fabric, by name or from a file.

use crate::files;
use anyhow::{Context, Result, bail};
use glam::DVec3;
use sim_core::{Body, Scene};
use std::path::Path;
use stitch_mesh::yarn_net::YarnState;

/// Friction of wool on a body.
const FRICTION: f64 = 0.4;

/// Scenes by name, and what they are.
pub const NAMED: [(&str, &str); 4] = [
    ("free", "no gravity, nothing around"),
    ("ground", "falling on the ground"),
    ("sphere", "falling on a sphere over the ground"),
    ("form", "worn by a dress form (made for the bundled pullover)"),
];

/// A scene by name or file, placed to suit a fabric.
///
/// # Errors
/// Neither a name nor a readable file; a file that is no scene.
pub fn scene(name_or_file: &str, state: &YarnState) -> Result<Scene> {
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
