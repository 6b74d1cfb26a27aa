//! Yarn for a renderer on the same device: control points that never leave it.
//!
//! # Theory
//! The control points are those of `curves.rs`. Each gets a reference normal at a right angle to the yarn, from which its plies
//! and fibres are turned: the normal of the fabric there, less its part along the yarn. The renderer takes the normal along a span
//! by the smallest rotation; what is then missing to the normal at its end is a turn about the yarn that it spreads over the span.
//! So all points are done at once, where transport along the whole yarn, as `render` does on the CPU, is one after the other. How
//! far the wool has been drawn along is known from the sliding coordinates: it moves with the yarn.
//!
//! # Practice
//! There are two sets of buffers, written by turns, so that what was handed out last stays as it was for one step more. Back to
//! the CPU come 20 bytes for every [`RUN`] spans: where they are.

use super::GpuError;
use super::constants::{NARROW, NONE, WIDE};
use super::kernel::{Kernels, Task};
use super::layout::{Bound, Drawn as Point, Lay, Part};
use super::system::System;
use crate::materials::Materials;
use crate::model::Model;
use glam::Vec3;
use std::collections::HashMap;
use stitch_mesh::ids::VisitId;
use stitch_mesh::yarn_net::{Yarn, YarnNet};

/// Spans whose place is told together.
const RUN: u32 = 32;

/// Set in the last word of the control points at the ends of an open yarn.
const END: u32 = 1 << 31;

/// Yarn in the buffers of a device, as its renderer reads it.
#[derive(Clone, Debug)]
pub struct DeviceYarn {
    /// Control points: position [m], length of yarn up to there in diameters, unit reference normal, number of its stretch; the
    /// topmost bit of that is set at the ends of open yarns; 32 bytes.
    pub points: wgpu::Buffer,
    /// Radius [m] and roll up to the next point [rad] of each point; 8 bytes.
    pub stretches: wgpu::Buffer,
    /// Colour of each point, as sRGB in the bytes of a number.
    pub dyes: wgpu::Buffer,
    /// Where it is.
    pub runs: Vec<YarnRun>,
}

/// Some spans of yarn in a row.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct YarnRun {
    /// The control point that the first begins at.
    pub first: u32,
    /// How many there are.
    pub spans: u32,
    /// Mean of their control points, and the largest distance of one from it [m].
    pub center: Vec3,
    /// See `center`.
    pub far: f32,
    /// Mean length of a span [m].
    pub span: f32,
    /// Radius of the thickest yarn among them [m].
    pub radius: f32,
}

/// What lays yarn out on the device.
pub(crate) struct Drawn {
    runs: Vec<(Part, f32)>,
    bounds: wgpu::Buffer,
    dyes: wgpu::Buffer,
    sets: [Set; 2],
    turn: usize,
}

struct Set {
    points: wgpu::Buffer,
    stretches: wgpu::Buffer,
    tasks: Vec<Task>,
}

/// Entries of the buffers, while they are listed.
#[derive(Default)]
struct Entries {
    lays: Vec<Lay>,
    stretches: Vec<[f32; 2]>,
    dyes: Vec<u32>,
    runs: Vec<(Part, f32)>,
}

/// What entries are made of.
struct Source<'a> {
    model: &'a Model,
    materials: &'a Materials,
    /// The node of each visit on the device, and the control points in the middle of stitch contacts by their ends.
    new: &'a [u32],
    middles: HashMap<[VisitId; 2], u32>,
}

impl Drawn {
    /// For the net on a device; none where one of its buffers would be too large for a binding.
    pub fn new(
        system: &System,
        kernels: &Kernels,
        model: &Model,
        materials: &Materials,
    ) -> Result<Option<Self>, GpuError> {
        let (gpu, tables) = (&system.gpu, &system.tables);
        let mut middles = HashMap::new();
        for (joint, contact) in tables.joints.iter().zip(&model.net.contacts) {
            let yarns = std::iter::once(contact.new).chain(contact.old.iter().copied());
            for (i, [a, b]) in yarns.enumerate() {
                middles.extend([([a, b], joint.point + i as u32), ([b, a], joint.point + i as u32)]);
            }
        }
        let source = Source { model, materials, new: &tables.pattern.new, middles };
        let mut entries = Entries::default();
        for yarn in &model.net.yarns {
            entries.add(&source, yarn);
        }
        let count = entries.lays.len();
        let limit = gpu.device.limits().max_storage_buffer_binding_size;
        if count == 0 || (count * size_of::<Lay>().max(size_of::<Point>())) as u64 > limit {
            return Ok(None);
        }
        let parts: Vec<Part> = entries.runs.iter().map(|(part, _)| *part).collect();
        let [lays, runs] = [gpu.upload("lays", &entries.lays), gpu.upload("runs", &parts)];
        let bounds = gpu.buffer("bounds", (parts.len() * size_of::<Bound>()) as u64);
        let (points_in, run_groups) = ((count as u32).div_ceil(WIDE), (parts.len() as u32).div_ceil(NARROW));
        let set = || -> Result<Set, GpuError> {
            let points = gpu.buffer("drawn", (count * size_of::<Point>()) as u64);
            let stretches = gpu.upload("stretches", &entries.stretches);
            let find = |name: &str| match name {
                "lays" => Some(&lays),
                "runs" => Some(&runs),
                "bounds" => Some(&bounds),
                "drawn" => Some(&points),
                "stretches" => Some(&stretches),
                other => system.buffers.find(None, other),
            };
            let task = |stage: &str, workgroups| kernels.task(gpu, stage, workgroups, None, find);
            let tasks = vec![
                task("lay_out", points_in)?,
                task("frame", points_in)?,
                task("roll", points_in)?,
                task("bound", run_groups)?,
            ];
            Ok(Set { points, stretches, tasks })
        };
        let sets = [set()?, set()?];
        let dyes = gpu.upload("dyes", &entries.dyes);
        gpu.check()?;
        Ok(Some(Self { runs: entries.runs, bounds, dyes, sets, turn: 0 }))
    }

    /// The dispatches that lay the yarn out anew, after its control points.
    pub fn tasks(&mut self) -> &[Task] {
        self.turn = 1 - self.turn;
        &self.sets[self.turn].tasks
    }

    /// What they have laid out.
    pub fn yarn(&self, system: &System) -> Result<DeviceYarn, GpuError> {
        let size = (self.runs.len() * size_of::<Bound>()) as u64;
        let bytes = system.gpu.read(&[(&self.bounds, 0..size)])?.swap_remove(0);
        let bounds: Vec<Bound> = bytemuck::pod_collect_to_vec(&bytes);
        let run = |((part, radius), b): (&(Part, f32), &Bound)| YarnRun {
            first: part.first,
            spans: part.count,
            center: Vec3::new(b.x, b.y, b.z),
            far: b.far,
            span: b.span,
            radius: *radius,
        };
        let set = &self.sets[self.turn];
        Ok(DeviceYarn {
            points: set.points.clone(),
            stretches: set.stretches.clone(),
            dyes: self.dyes.clone(),
            runs: self.runs.iter().zip(&bounds).map(run).collect(),
        })
    }
}

impl Entries {
    /// A yarn: one point before its first, and two after its last, so that every span finds its four.
    fn add(&mut self, source: &Source<'_>, yarn: &Yarn) {
        let net: &YarnNet = &source.model.net;
        let mut arc = 0.0;
        let mut inner: Vec<(Lay, f32, u32)> = Vec::new();
        for visit in yarn.visits.clone().map(VisitId) {
            let material = source.materials.of(net.visits[visit.index()].dye);
            let radius = material.drawn_radius;
            let dye = net.visits[visit.index()].dye.0;
            let node = source.new[net.visits[visit.index()].node.index()];
            let of = |point: u32, after: u32, arc: f64| Lay {
                point,
                before: visit.0,
                after,
                mirror: NONE,
                visit: visit.0,
                node,
                arc: (arc / (2.0 * radius)) as f32,
                diameter: (2.0 * radius) as f32,
                inner: 1,
                mark: 0,
            };
            let color = u32::from_le_bytes([dye[0], dye[1], dye[2], 0]);
            let next = net.next(visit);
            inner.push((of(visit.0, next.unwrap_or(visit).0, arc), radius as f32, color));
            let Some(next) = next else { continue };
            let [u, after] = [visit, next].map(|v| net.visits[v.index()].u);
            let turn = if next > visit { 0.0 } else { yarn.period.unwrap_or_default() };
            let length = after + turn - u;
            if let Some(point) = source.middles.get(&[visit, next]) {
                inner.push((of(*point, next.0, arc + 0.5 * length), radius as f32, color));
            }
            arc += length;
        }
        let (count, closed) = (inner.len(), yarn.period.is_some());
        if count < 2 {
            return;
        }
        let first = self.lays.len() as u32 + 1;
        let around = |i: usize| inner[i % count];
        let outside = |(lay, radius, color): (Lay, f32, u32), mirror: u32| {
            (Lay { inner: 0, mirror, ..lay }, radius, color)
        };
        let mut all = Vec::with_capacity(count + 4);
        if closed {
            all.push(outside(around(count - 1), NONE));
            all.extend(&inner);
            let (start, radius, color) = inner[0];
            all.push((Lay { arc: (arc / f64::from(start.diameter)) as f32, ..start }, radius, color));
            all.extend([outside(around(1), NONE), outside(around(2), NONE)]);
        } else {
            all.push(outside(inner[1], first));
            all.extend(&inner);
            for end in [1, count] {
                all[end].0.mark = END;
            }
            let beyond = outside(inner[count - 2], first + count as u32 - 1);
            all.extend([beyond; 2]);
        }
        let spans = (all.len() - 4) as u32;
        for start in (0..spans).step_by(RUN as usize) {
            let part = Part { first: first + start, count: RUN.min(spans - start) };
            let within = &all[1 + start as usize..=(1 + start + part.count) as usize];
            self.runs.push((part, within.iter().map(|(_, radius, _)| *radius).fold(0.0, f32::max)));
        }
        for (lay, radius, color) in all {
            self.lays.push(lay);
            self.stretches.push([radius, 0.0]);
            self.dyes.push(color);
        }
    }
}
