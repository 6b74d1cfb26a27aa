//! What surrounds the fabric, as the kernels know it: bodies, springs, distances of meshes.

use super::GpuError;
use super::device::LIMITS;
use super::layout::{Body as BodyRecord, Pin as PinRecord};
use super::simulator::GpuSimulator;
use crate::body::Body;
use crate::scene::Scene;
use crate::simulator::SimError;
use glam::{DQuat, DVec3};
use std::collections::BTreeMap;

impl GpuSimulator {
    /// Puts bodies and springs where they are at the end of the step.
    pub(crate) fn place_surroundings(&mut self) -> Result<(), GpuError> {
        let end = self.progress.scene_time_s + self.step;
        let mut springs: BTreeMap<u32, (f64, DVec3)> = BTreeMap::new();
        let clamped = self.scene.clamps.iter().flat_map(|c| c.pins(end));
        for pin in self.scene.pins.iter().copied().chain(clamped) {
            // Springs on one node are one spring.
            let (stiffness, pull) = springs.entry(pin.node).or_default();
            *stiffness += pin.stiffness;
            *pull += pin.stiffness * (pin.target - self.origin);
        }
        let pin = |(node, (stiffness, pull)): (&u32, &(f64, DVec3))| {
            let target = (*pull / stiffness.max(f64::MIN_POSITIVE)).as_vec3();
            let node = self.system.tables.pattern.new[*node as usize];
            PinRecord { node, stiffness: *stiffness as f32, x: target.x, y: target.y, z: target.z }
        };
        let pins: Vec<PinRecord> = springs.iter().map(pin).collect();
        let bodies: Vec<BodyRecord> = (0..self.scene.bodies.len()).map(|b| self.body(b)).collect();
        self.system.set_surroundings(&bodies, &pins)
    }

    /// A body of the scene during the step to come.
    fn body(&self, index: usize) -> BodyRecord {
        let body = &self.scene.bodies[index];
        let poses =
            [self.progress.scene_time_s, self.progress.scene_time_s + self.step].map(|t| body.pose(t));
        let shift = poses.map(|pose| (pose.apply(self.origin) - self.origin).as_vec3());
        let turn = poses.map(|pose| pose.rotation().as_quat());
        let mut record = BodyRecord {
            friction: body.friction() as f32,
            moves: u32::from(body.motion().is_some()),
            turn_w: 1.0,
            ..BodyRecord::default()
        };
        (record.from_x, record.from_y, record.from_z, record.from_w) = turn[0].into();
        (record.to_x, record.to_y, record.to_z, record.to_w) = turn[1].into();
        (record.from_shift_x, record.from_shift_y, record.from_shift_z) = shift[0].into();
        (record.to_shift_x, record.to_shift_y, record.to_shift_z) = shift[1].into();
        let mut place = |a: DVec3, b: DVec3, size: f64| {
            (record.a_x, record.a_y, record.a_z) = (a - self.origin).as_vec3().into();
            (record.b_x, record.b_y, record.b_z) = b.as_vec3().into();
            record.size = size as f32;
        };
        match resting(body) {
            Body::Ground { height, .. } => place(*height * DVec3::Y, DVec3::ZERO, 0.0),
            Body::Sphere { center, radius, .. } => {
                place(*center, DVec3::ZERO, *radius);
                record.kind = 1;
            }
            Body::Capsule { from, to, radius, .. } => {
                place(*from, *to - self.origin, *radius);
                record.kind = 2;
            }
            Body::Box { center, size, turn, .. } => {
                place(*center, *size, 0.0);
                record.kind = 3;
                let turn = DQuat::from_scaled_axis(*turn).as_quat();
                (record.turn_x, record.turn_y, record.turn_z, record.turn_w) = turn.into();
            }
            Body::Mesh { mesh, .. } => {
                let (low, cell, corners, _) = mesh.grid();
                place(low, DVec3::ZERO, cell);
                record.kind = 4;
                (record.corners_x, record.corners_y, record.corners_z) = corners.into();
                record.field = self.fields.iter().find(|(b, _)| *b == index).map_or(0, |(_, field)| *field);
            }
            // Refused by `fit`.
            Body::Sequence { .. } | Body::Moving { .. } => {}
        }
        record
    }

    /// Changes gravity, bodies, pins or time step; refused as a whole if anything in it makes no sense. What moves begins anew,
    /// unless all of it moves as before.
    ///
    /// # Errors
    /// A scene that makes no sense, or bodies that the GPU has no place for.
    pub fn set_scene(&mut self, scene: Scene) -> Result<(), SimError> {
        scene.validate(self.model.net.nodes.len())?;
        fit(&scene)?;
        let others = scene.bodies != self.scene.bodies;
        self.step = scene.time_step;
        if !scene.moves_like(&self.scene) {
            self.progress.scene_time_s = 0.0;
        }
        self.scene = scene;
        if others { self.upload_fields() } else { Ok(()) }
    }

    /// Puts the distances around the meshes of the scene on the device.
    pub(super) fn upload_fields(&mut self) -> Result<(), SimError> {
        let mut distances: Vec<f32> = Vec::new();
        self.fields.clear();
        for (index, body) in self.scene.bodies.iter().enumerate() {
            if let Body::Mesh { mesh, .. } = resting(body) {
                self.fields.push((index, distances.len() as u32));
                distances.extend(mesh.grid().3);
            }
        }
        Ok(self.system.set_fields(&distances)?)
    }
}

/// A body without its motion.
fn resting(body: &Body) -> &Body {
    match body {
        Body::Moving { body, .. } => body,
        resting => resting,
    }
}

/// Refuses bodies that there are no kernels or no room for.
pub(super) fn fit(scene: &Scene) -> Result<(), GpuError> {
    if let Some(index) = scene.bodies.iter().position(|b| matches!(resting(b), Body::Sequence { .. })) {
        return Err(GpuError::Unsupported(format!("body {index} changes its shape")));
    }
    let cells = |body: &Body| match resting(body) {
        Body::Mesh { mesh, .. } => mesh.grid().3.len(),
        _ => 0,
    };
    let bytes = 4 * scene.bodies.iter().map(cells).sum::<usize>() as u64;
    if bytes > LIMITS.max_storage_buffer_binding_size {
        return Err(GpuError::Unsupported("the meshes of the scene have too large a grid".to_owned()));
    }
    Ok(())
}
