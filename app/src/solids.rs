//! The bodies of a scene, to be drawn.

use glam::{DQuat, DVec3, Vec3};
use render::{Solid, Solids};
use sim_core::{Body, Pose, Scene};

/// The bodies of a scene at a time since it began [s].
pub fn solids(scene: &Scene, time_s: f64) -> Solids {
    Solids { solids: scene.bodies.iter().map(|body| solid(body, &body.pose(time_s), time_s)).collect() }
}

fn solid(body: &Body, pose: &Pose, time_s: f64) -> Solid {
    let at = |p: DVec3| -> Vec3 { pose.apply(p).as_vec3() };
    match body {
        Body::Ground { height, .. } => Solid::Ground { height: at(DVec3::Y * *height).y },
        Body::Sphere { center, radius, .. } => Solid::Sphere { center: at(*center), radius: *radius as f32 },
        Body::Capsule { from, to, radius, .. } => {
            Solid::Capsule { ends: [at(*from), at(*to)], radius: *radius as f32 }
        }
        Body::Box { center, size, turn, .. } => {
            let turn = DQuat::from_scaled_axis(*turn);
            let sign = |i: usize, bit: usize| if i >> bit & 1 == 1 { 0.5 } else { -0.5 };
            let corner =
                |i: usize| at(*center + turn * (*size * DVec3::new(sign(i, 0), sign(i, 1), sign(i, 2))));
            let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
            let triangles = quads.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).collect();
            Solid::Mesh { positions: (0..8).map(corner).collect(), triangles }
        }
        Body::Mesh { mesh, .. } => {
            let mesh = mesh.triangles();
            let positions = mesh.positions.iter().map(|p| at(*p)).collect();
            Solid::Mesh { positions, triangles: mesh.triangles.clone() }
        }
        Body::Sequence { frames, .. } => {
            let mesh = frames.at(time_s);
            let positions = mesh.positions.iter().map(|p| at(*p)).collect();
            Solid::Mesh { positions, triangles: mesh.triangles }
        }
        Body::Moving { body, .. } => solid(body, pose, time_s),
    }
}
