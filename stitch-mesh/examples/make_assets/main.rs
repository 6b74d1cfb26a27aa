//! Writes the bundled meshes into `assets/meshes`: run from the repository's root with
//! `cargo run --release -p stitch-mesh --example make_assets`.
//!
//! All are polygons with a row structure that can be knitted, in metres, y up, front towards +z.

mod garment;
mod mesh;

use garment::{SWEATER, T_SHIRT};
use glam::DVec3;
use mesh::Mesh;
use std::f64::consts::{PI, TAU};

/// Rings of quads about the y axis, from the lowest up; a last ring of radius zero closes the top with triangles.
fn rings(around: i32, rings: &[(f64, f64)]) -> Mesh {
    let mut mesh = Mesh::default();
    for (j, pair) in rings.windows(2).enumerate() {
        let mut at = |i: i32, k: usize| {
            let (radius, y) = rings[k];
            let i = if radius == 0.0 { 0 } else { i % around };
            let angle = TAU * f64::from(i) / f64::from(around);
            mesh.vertex([i, k as i32, 0], DVec3::new(radius * angle.sin(), y, radius * angle.cos()))
        };
        let mut faces = Vec::new();
        for i in 0..around {
            let mut face = vec![at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            if pair[1].0 == 0.0 {
                face.pop();
            }
            faces.push(face);
        }
        mesh.faces.extend(faces);
    }
    mesh
}

fn swatch() -> Mesh {
    let mut mesh = Mesh::default();
    for j in 0..5 {
        for i in 0..6 {
            let corners = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)];
            let face = corners.map(|(i, j)| {
                mesh.vertex([i, j, 0], DVec3::new(f64::from(i) * 0.024 - 0.072, f64::from(j) * 0.024, 0.0))
            });
            mesh.faces.push(face.to_vec());
        }
    }
    mesh
}

fn cowl() -> Mesh {
    rings(20, &[(0.115, 0.0), (0.108, 0.05), (0.104, 0.10), (0.106, 0.15), (0.112, 0.20)])
}

fn poncho() -> Mesh {
    let profile: Vec<(f64, f64)> = (0..=8)
        .map(|k| {
            let t = f64::from(k) / 8.0;
            (0.36 - 0.27 * t, 0.30 * (1.0 - (1.0 - t).powi(2)).max(0.0) + 0.02 * t)
        })
        .collect();
    rings(24, &profile)
}

fn hat() -> Mesh {
    let mut profile: Vec<(f64, f64)> = (0..=3).map(|k| (0.085, 0.03 * f64::from(k))).collect();
    for k in 1..=6 {
        let angle = PI / 2.0 * f64::from(k) / 6.0;
        let radius = if k == 6 { 0.0 } else { 0.085 * angle.cos() };
        profile.push((radius, 0.09 + 0.085 * angle.sin()));
    }
    rings(24, &profile)
}

/// A child's sleeveless pullover: a tube to the underarms, then a front and a back panel, each split by the neck into two
/// straps; the straps meet on the shoulders.
fn pullover() -> Mesh {
    const PANEL: i32 = 14; // faces across the front, and across the back
    const BODY: i32 = 9; // rows of faces from hem to underarm
    const YOKE: i32 = 6; // rows of faces from underarm to shoulder
    const ARM: i32 = 1; // faces of each panel that end at the underarm, on each side
    const NECK: i32 = 5; // first face of the neck, on each side
    let (half_width, depth, underarm, shoulder) = (0.165, 0.105, 0.21, 0.345);
    let across = |i: i32| f64::from(2 * i - PANEL) / f64::from(PANEL); // −1…1
    let mut mesh = Mesh::default();
    for (side, front) in [(0, true), (1, false)] {
        let mut at = |i: i32, j: i32| {
            let s = across(i);
            let t = (f64::from(j - BODY) / f64::from(YOKE)).max(0.0); // 0 at the underarm, 1 on the shoulder
            let (sin, cos) = (s * PI / 2.0).sin_cos();
            let body = f64::from(j.min(BODY)) / f64::from(BODY) * underarm;
            let slope = 0.035 * (s.abs() - 0.2).max(0.0);
            let y = body + t * (shoulder - underarm - slope);
            // The armhole curves inwards, the panel leans towards the shoulder line.
            let narrow = 1.0 - 0.16 * (t * PI / 2.0).sin().max(0.0);
            let hem = 1.0 + 0.06 * (1.0 - body / underarm);
            let x = half_width * hem * sin * if t > 0.0 { narrow } else { 1.0 };
            let z = depth * hem * cos.max(0.0).powf(0.6) * (1.0 - t * t).max(0.0).sqrt();
            let seam = (i == 0 || i == PANEL) && j <= BODY || j == BODY + YOKE;
            let name = if seam { [i, j, 2] } else { [i, j, side] };
            mesh.vertex(name, DVec3::new(x, y, if front { z } else { -z }))
        };
        let mut faces = Vec::new();
        for j in 0..BODY + YOKE {
            // The neck is deeper in front.
            let neck_from = BODY + if front { 3 } else { 5 };
            for i in 0..PANEL {
                let at_arm = j >= BODY && !(ARM..PANEL - ARM).contains(&i);
                let at_neck = j >= neck_from && (NECK..PANEL - NECK).contains(&i);
                if at_arm || at_neck {
                    continue;
                }
                let mut face = vec![at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
                if !front {
                    face.reverse();
                }
                faces.push(face);
            }
        }
        mesh.faces.extend(faces);
    }
    mesh
}

/// A sleeveless pullover knitted in the round: a tube to the underarms, two panels beside the armholes, and above them a yoke
/// that narrows over the shoulders to a collar.
fn slipover() -> Mesh {
    const HALF: i32 = 12; // faces across the front, and across the back
    const ARMHOLE: std::ops::Range<usize> = 5..7; // rows of faces
    /// Half the width, half the depth and the height of each ring [m].
    const RINGS: [[f64; 3]; 14] = [
        [0.172, 0.106, 0.00],
        [0.172, 0.106, 0.04],
        [0.172, 0.106, 0.08],
        [0.172, 0.106, 0.12],
        [0.172, 0.106, 0.16],
        [0.170, 0.104, 0.20],
        [0.165, 0.098, 0.24],
        [0.157, 0.085, 0.28],
        [0.143, 0.068, 0.31],
        [0.100, 0.060, 0.33],
        [0.068, 0.055, 0.35],
        [0.064, 0.053, 0.38],
        [0.064, 0.053, 0.41],
        [0.064, 0.053, 0.44],
    ];
    let mut mesh = Mesh::default();
    for j in 0..RINGS.len() - 1 {
        let mut at = |i: i32, j: usize| {
            let [width, depth, y] = RINGS[j];
            // Once round: over the front from right to left as it is worn, and back.
            let turn = PI * (f64::from(i) / f64::from(HALF) - 0.5);
            let z = depth * turn.cos().abs().powf(0.6) * turn.cos().signum();
            mesh.vertex([i % (2 * HALF), j as i32, 0], DVec3::new(width * turn.sin(), y, z))
        };
        let mut faces = Vec::new();
        for i in 0..2 * HALF {
            let at_side = [0, HALF - 1, HALF, 2 * HALF - 1].contains(&i);
            if !(at_side && ARMHOLE.contains(&j)) {
                faces.push(vec![at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]);
            }
        }
        mesh.faces.extend(faces);
    }
    mesh
}

fn main() -> std::io::Result<()> {
    std::fs::create_dir_all("assets/meshes")?;
    swatch().write("swatch", "a flat piece.")?;
    cowl().write("cowl", "a tube.")?;
    poncho().write("poncho", "a poncho, knitted from hem to neck.")?;
    hat().write("hat", "a hat with decreases to the crown.")?;
    pullover().write("pullover", "a child's sleeveless pullover.")?;
    slipover().write("slipover", "a sleeveless pullover with a collar, knitted in the round.")?;
    SWEATER.write("sweater", "a sweater in four pieces, to be sewn together.")?;
    T_SHIRT.write("t-shirt", "a sleeveless shirt in two pieces, to be sewn together.")
}
