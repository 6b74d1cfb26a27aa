//! A net as the kernels want it: elements, who is around whom, and where everything is.
//!
//! WGSL has no portable float atomics, so nothing is scattered: every node has the list of elements around it and the rows of
//! its unknowns are summed by one invocation each, in the order of the list. Whatever grows with elements or with the matrix is kept
//! chunk by chunk; an element between two chunks is in both.

use super::GpuError;
use super::constants::{MOST_STACK, NONE, RIGID, SHEAR_OUT};
use super::layout::{Bend, Block, Counts, Joint, Material as Yarn, Node, Segment, Shear, Stacked, Wrap};
use super::pattern::{Pattern, Room};
use crate::air::VISCOSITY;
use crate::friction::Stack;
use crate::material::Material;
use crate::materials::Materials;
use crate::model::Model;
use crate::step::clearances;
use crate::take_in::TakeIn;
use glam::DVec3;
use stitch_mesh::ids::VisitId;

/// A run of groups with all the elements around their nodes.
#[derive(Default)]
pub(crate) struct Chunk {
    pub counts: Counts,
    pub segments: Vec<Segment>,
    pub bends: Vec<Bend>,
    pub wraps: Vec<Wrap>,
    pub shears: Vec<Shear>,
    /// Of each element around a node: what and which it is, then for each of its nodes the column and the place of its
    /// sliding coordinate; three words.
    pub entries: Vec<u32>,
    pub blocks: Vec<Block>,
    pub value_count: u32,
    pub factor_count: u64,
}

impl Chunk {
    /// Vectors that the results of its elements take.
    pub fn element_count(&self) -> u32 {
        self.counts.shears_at + self.counts.shears * SHEAR_OUT
    }
}

/// A net laid out for the kernels.
pub(crate) struct Tables {
    pub pattern: Pattern,
    pub nodes: Vec<Node>,
    pub stacked: Vec<Stacked>,
    pub pulls: Vec<u32>,
    pub around: Vec<u32>,
    pub incoming: Vec<u32>,
    pub joints: Vec<Joint>,
    pub old_dyes: Vec<u32>,
    pub chunks: Vec<Chunk>,
    pub visit_count: u32,
    /// Where the positions are measured from [m].
    pub origin: DVec3,
}

impl Tables {
    /// The tables for `model`, whose net is laid about `origin`. How the factor is laid out depends on the `room` there is.
    pub fn new(
        model: &Model,
        materials: &Materials,
        take_in: &TakeIn,
        origin: DVec3,
        room: Room,
    ) -> Result<Self, GpuError> {
        if let Some(node) = model.net.nodes.iter().position(|n| n.visits.len() > MOST_STACK) {
            let yarns = model.net.nodes[node].visits.len();
            return Err(GpuError::Unsupported(format!(
                "node {node} has {yarns} yarns, more than {MOST_STACK}"
            )));
        }
        let near = all_neighbours(model);
        let size = |n: u32| model.start[n as usize + 1] - model.start[n as usize];
        let widths: Vec<u32> = near.iter().map(|row| row.iter().map(|n| size(*n)).sum()).collect();
        if let Some(node) = widths.iter().position(|w| *w > 0xfff) {
            return Err(GpuError::Unsupported(format!("node {node} is joined to {} unknowns", widths[node])));
        }
        let pattern = Pattern::new(model, &widths, room);
        let mut tables = Self {
            nodes: vec![Node::default(); near.len()],
            stacked: Vec::new(),
            pulls: Vec::new(),
            around: Vec::new(),
            incoming: Vec::new(),
            joints: Vec::new(),
            old_dyes: Vec::new(),
            chunks: Vec::new(),
            visit_count: model.net.visits.len() as u32,
            origin,
            pattern,
        };
        let blocks = tables.lay_rows(&near);
        tables.lay_elements(model, take_in, &blocks);
        tables.lay_stacks(model);
        tables.lay_joints(model);
        tables.set_materials(model, materials);
        Ok(tables)
    }

    /// Number of unknowns.
    pub fn dof_count(&self) -> u32 {
        self.pattern.dof.last().copied().unwrap_or_default()
    }

    /// Rows and blocks of the matrix. Gives for each node the column at which each neighbour's block begins.
    fn lay_rows(&mut self, near: &[Vec<u32>]) -> Vec<Vec<(u32, u32)>> {
        let pattern = &self.pattern;
        let mut columns = Vec::with_capacity(near.len());
        let chunk_count = pattern.factor_counts.len();
        self.chunks = (0..chunk_count).map(|_| Chunk::default()).collect();
        for g in 0..pattern.nodes.len() {
            let chunk = &mut self.chunks[pattern.chunk_of[g] as usize];
            let fronts = pattern.fronts(g);
            for n in pattern.nodes[g].clone() {
                if chunk.counts.node_count == 0 {
                    chunk.counts.first_node = n;
                }
                chunk.counts.node_count += 1;
                let mut others: Vec<u32> =
                    near[pattern.old[n as usize] as usize].iter().map(|m| pattern.new[*m as usize]).collect();
                others.sort_unstable();
                let node = &mut self.nodes[n as usize];
                (node.dof, node.size) = (pattern.dof[n as usize], pattern.size(n));
                node.group = pattern.place[g];
                node.block = chunk.blocks.len() as u32;
                node.value = chunk.value_count;
                let mut own = Vec::with_capacity(others.len());
                for m in others {
                    if m == n {
                        node.own = node.width;
                    }
                    let front = fronts.get(&m).copied().unwrap_or(NONE);
                    chunk.blocks.push(Block { dof: pattern.dof[m as usize], size: pattern.size(m), front });
                    own.push((m, node.width));
                    node.width += pattern.size(m);
                }
                node.block_end = chunk.blocks.len() as u32;
                chunk.value_count += (node.width + RIGID) * node.size;
                columns.push(own);
            }
        }
        for (chunk, factor) in self.chunks.iter_mut().zip(&pattern.factor_counts) {
            chunk.factor_count = *factor;
        }
        for (n, from) in pattern.incoming().into_iter().enumerate() {
            self.nodes[n].incoming = self.incoming.len() as u32;
            self.incoming.extend(from);
            self.nodes[n].incoming_end = self.incoming.len() as u32;
        }
        columns
    }

    /// Who lies parallel in stacks, and neighbours along yarns.
    fn lay_stacks(&mut self, model: &Model) {
        for stack in Stack::all(&model.net) {
            let first = self.nodes[self.pattern.new[stack.node] as usize].visit as usize;
            for (k, parallel) in stack.parallel.iter().enumerate() {
                self.stacked[first + k].parallel = u32::from(*parallel);
            }
        }
        for (old, node) in model.net.nodes.iter().enumerate() {
            let visits = node.visits.iter().flat_map(|v| [model.net.prev(*v), model.net.next(*v)]);
            let mut around: Vec<u32> = visits.flatten().map(|v| model.net.visits[v.index()].node.0).collect();
            around.sort_unstable();
            around.dedup();
            let record = &mut self.nodes[self.pattern.new[old] as usize];
            record.around = self.around.len() as u32;
            self.around.extend(around.into_iter().map(|n| self.pattern.new[n as usize]));
            record.around_end = self.around.len() as u32;
            let laid = (node.position - self.origin).as_vec3();
            (record.laid_x, record.laid_y, record.laid_z) = laid.into();
            (record.normal_x, record.normal_y, record.normal_z) = node.normal.as_vec3().into();
        }
    }

    /// The middles of stitch contacts.
    fn lay_joints(&mut self, model: &Model) {
        let net = &model.net;
        let mut point = net.visits.len() as u32;
        for contact in &net.contacts {
            let [p, q] = contact.new.map(|v| net.visits[v.index()].node.index());
            let rank = |visit: VisitId| net.nodes[p].visits.iter().position(|v| *v == visit);
            let old_in_front = contact.old.first().and_then(|o| rank(o[0])) < rank(contact.new[0]);
            let old = self.old_dyes.len() as u32;
            self.old_dyes.extend(contact.old.iter().map(|ends| model.dye_of[ends[0].index()]));
            self.joints.push(Joint {
                node_0: self.pattern.new[p],
                node_1: self.pattern.new[q],
                dye: model.dye_of[contact.new[0].index()],
                old,
                old_end: self.old_dyes.len() as u32,
                point,
                side: (if old_in_front { 1.0 } else { -1.0 }) * contact.handedness as f32,
            });
            point += 1 + contact.old.len() as u32;
        }
    }

    /// Control points in all.
    pub fn point_count(&self) -> u32 {
        self.stacked.len() as u32 + self.joints.len() as u32 + self.old_dyes.len() as u32
    }

    /// What follows from materials: of nodes, and of crossings of woven cloth.
    pub fn set_materials(&mut self, model: &Model, materials: &Materials) {
        let yarns = model.resolve(materials);
        let (masses, clearances) = (model.node_masses(materials), clearances(model, materials));
        for (old, node) in model.net.nodes.iter().enumerate() {
            let record = &mut self.nodes[self.pattern.new[old] as usize];
            record.mass = masses[old] as f32;
            record.clearance = clearances[old] as f32;
            record.grip = materials.of(model.net.visits[node.visits[0].index()].dye).friction.sqrt() as f32;
        }
        for record in self.chunks.iter_mut().flat_map(|c| &mut c.shears) {
            let term = &model.shears[record.id as usize];
            let shear = term.shear(&yarns);
            let [a, b] = term.dyes.map(|d| &yarns[d as usize]);
            record.stiffness = shear.stiffness as f32;
            record.length = shear.length as f32;
            record.rest = shear.rest as f32;
            record.jam = shear.jam as f32;
            record.stiffness_damping = (0.5 * (a.stiffness_damping + b.stiffness_damping)) as f32;
            (record.stretch_0, record.stretch_1) =
                (a.stretch_stiffness() as f32, b.stretch_stiffness() as f32);
            [record.climb_0, record.climb_1] = term.climb.map(|c| c as f32);
            [record.share_0, record.share_1] = term.share.map(|s| s as f32);
            record.sense = term.sense as f32;
        }
    }
}

/// The yarns as the kernels know them.
pub(crate) fn yarns(materials: &[Material]) -> Vec<Yarn> {
    let yarn = |m: &Material| {
        let diameter = 2.0 * m.drawn_radius;
        Yarn {
            density: m.density as f32,
            stretch: m.stretch_stiffness() as f32,
            bend: m.bend_stiffness() as f32,
            wrap: m.wrap_stiffness as f32,
            wrap_sin: m.wrap_angle.sin() as f32,
            wrap_cos: m.wrap_angle.cos() as f32,
            wrap_fade: m.wrap_fade as f32,
            friction: m.friction as f32,
            cohesion: m.cohesion as f32,
            stick: m.friction_stiffness as f32,
            length: (m.length_factor * m.stretch_stiffness()) as f32,
            parallel: m.parallel_stiffness as f32,
            parallel_distance: m.parallel_distance as f32,
            mass_damping: m.mass_damping as f32,
            stiffness_damping: m.stiffness_damping as f32,
            diameter: diameter as f32,
            creep: (10.0 * (VISCOSITY / diameter).powf(2.0 / 3.0)) as f32,
        }
    };
    materials.iter().map(yarn).collect()
}

/// All nodes that share an element with each node, itself among them.
fn all_neighbours(model: &Model) -> Vec<Vec<u32>> {
    let mut near: Vec<Vec<u32>> = vec![Vec::new(); model.neighbours.len()];
    for (a, row) in model.neighbours.iter().enumerate() {
        for b in row {
            near[a].push(*b);
            if *b as usize != a {
                near[*b as usize].push(a as u32);
            }
        }
    }
    near
}
