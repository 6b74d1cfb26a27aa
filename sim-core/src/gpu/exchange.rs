//! States to the device and back.
//!
//! Positions go about the origin and sliding as displacement from where the yarn was laid, so that single precision does.

use super::GpuError;
use super::drawn::{DeviceYarn, Drawn};
use super::simulator::GpuSimulator;
use super::system::System;
use crate::curves::string_together;
use crate::friction::Anchors;
use crate::model::FROZEN;
use glam::DVec3;
use std::collections::HashMap;
use stitch_mesh::yarn_curves::YarnCurves;
use stitch_mesh::yarn_net::YarnState;

impl GpuSimulator {
    /// Writes the whole state to the device: positions about the origin, sliding from what is laid, anchors where yarns are.
    pub(super) fn upload_state(&self, anchors: &Anchors) {
        let Self { state, system, .. } = self;
        let pattern = &system.tables.pattern;
        let four = |v: DVec3| v.as_vec3().extend(0.0).to_array();
        let position: Vec<[f32; 4]> =
            pattern.old.iter().map(|n| four(state.position[*n as usize] - self.origin)).collect();
        let velocity: Vec<[f32; 4]> = pattern.old.iter().map(|n| four(state.velocity[*n as usize])).collect();
        let slide = |v: usize| (state.sliding[v] - self.unslid(v)) as f32;
        let mut visits: Vec<[f32; 4]> = (0..state.sliding.len())
            .map(|v| {
                let frozen = self.model.sliding[v] == FROZEN;
                let rate = if frozen { 0.0 } else { state.sliding_velocity[v] as f32 };
                [slide(v), rate, (anchors.own[v] - self.unslid(v)) as f32, 0.0]
            })
            .collect();
        for node in &self.model.net.nodes {
            for pair in node.visits.windows(2) {
                let [a, b] = [pair[0].index(), pair[1].index()];
                visits[a][3] = (anchors.between[a] - self.unslid(a) + self.unslid(b)) as f32;
            }
        }
        system.write("position", &position);
        system.write("velocity", &velocity);
        system.write("visits", &visits);
    }

    /// Sliding coordinate of a visit that has not slid [m].
    fn unslid(&self, visit: usize) -> f64 {
        let id = stitch_mesh::ids::VisitId::new(visit);
        self.model.net.visits[visit].u - self.taken_in * self.take_in.total(id)
    }

    /// The state now, read back from the device if it has changed since it last was.
    ///
    /// # Errors
    /// The GPU fails; [`Self::last_state`] is that of the last good read.
    pub fn state(&mut self) -> Result<&YarnState, GpuError> {
        if !self.is_read {
            let [position, velocity, visits] = self.system.read(["position", "velocity", "visits"])?;
            let of = |numbers: &[f32], i: usize| {
                DVec3::new(
                    f64::from(numbers[4 * i]),
                    f64::from(numbers[4 * i + 1]),
                    f64::from(numbers[4 * i + 2]),
                )
            };
            for (i, old) in self.system.tables.pattern.old.iter().enumerate() {
                self.state.position[*old as usize] = self.origin + of(&position, i);
                self.state.velocity[*old as usize] = of(&velocity, i);
            }
            for v in 0..self.state.sliding.len() {
                self.state.sliding[v] = self.unslid(v) + f64::from(visits[4 * v]);
                self.state.sliding_velocity[v] = f64::from(visits[4 * v + 1]);
            }
            self.state.taken_in = self.taken_in;
            self.is_read = true;
            self.read_at = self.progress.clone();
        }
        Ok(&self.state)
    }

    /// Where yarns stick now.
    pub(super) fn anchors(&self) -> Result<Anchors, GpuError> {
        let [visits] = self.system.read(["visits"])?;
        let own = |v: usize| self.unslid(v) + f64::from(visits[4 * v + 2]);
        let mut anchors = Anchors {
            own: (0..self.state.sliding.len()).map(own).collect(),
            between: vec![0.0; self.state.sliding.len()],
        };
        for pair in self.model.net.nodes.iter().flat_map(|n| n.visits.windows(2)) {
            let [a, b] = [pair[0].index(), pair[1].index()];
            anchors.between[a] = self.unslid(a) - self.unslid(b) + f64::from(visits[4 * a + 3]);
        }
        Ok(anchors)
    }

    /// The yarns as they are drawn: `curves` on the device.
    ///
    /// # Errors
    /// The GPU fails.
    pub fn curves(&mut self) -> Result<YarnCurves, GpuError> {
        self.system.lay_points(self.params(self.step), &[]);
        let [points] = self.system.read(["points"])?;
        let net = &self.model.net;
        let at = |i: usize| {
            let p = &points[4 * i..4 * i + 4];
            let x = DVec3::new(f64::from(p[0]), f64::from(p[1]), f64::from(p[2]));
            (p[3] > 0.0).then(|| (self.origin + x).as_vec3())
        };
        let mut middles = HashMap::new();
        for (joint, contact) in self.system.tables.joints.iter().zip(&net.contacts) {
            let yarns = std::iter::once(contact.new).chain(contact.old.iter().copied());
            yarns.enumerate().for_each(|(i, ends)| {
                middles.insert(ends, at(joint.point as usize + i));
            });
        }
        Ok(string_together(net, &self.materials, &|visit| at(visit.index()), &|a, b| {
            middles.get(&[a, b]).or_else(|| middles.get(&[b, a])).copied().flatten()
        }))
    }

    /// The same without leaving the device, for a renderer that draws there; none where it draws elsewhere, or it is too much.
    ///
    /// # Errors
    /// The GPU fails.
    pub fn device_yarn(&mut self) -> Result<Option<DeviceYarn>, GpuError> {
        if !self.system.gpu.draws {
            return Ok(None);
        }
        if self.drawn.is_none() {
            let System { kernels, .. } = &self.system;
            self.drawn = Some(Drawn::new(&self.system, kernels, &self.model, &self.materials)?);
        }
        let params = self.params(self.step);
        let Some(Some(drawn)) = &mut self.drawn else { return Ok(None) };
        self.system.lay_points(params, drawn.tasks());
        drawn.yarn(&self.system).map(Some)
    }
}
