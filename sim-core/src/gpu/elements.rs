//! The elements of a net, chunk by chunk, and the lists of them around nodes and visits.

use super::constants::{BEND_OUT, OF_BEND, OF_SEGMENT, OF_SHEAR, OF_WRAP, SEGMENT_OUT, WRAP_OUT};
use super::layout::{Bend, Segment, Shear, Stacked, Wrap};
use super::tables::{Chunk, Tables};
use crate::model::{FROZEN, Model, Stencil};
use crate::take_in::TakeIn;
use stitch_mesh::ids::VisitId;
use stitch_mesh::wrapping::Wrapping;

/// What the lists around nodes are made of, while they are made.
struct Lists {
    entries: Vec<Vec<[u32; 3]>>,
    pulls: Vec<Vec<u32>>,
}

impl Tables {
    /// Elements of each chunk, and the lists of them around nodes and visits.
    pub(super) fn lay_elements(&mut self, model: &Model, take_in: &TakeIn, columns: &[Vec<(u32, u32)>]) {
        let mut lists = Lists {
            entries: vec![Vec::new(); self.nodes.len()],
            pulls: vec![Vec::new(); model.net.visits.len()],
        };
        let slid = |from: VisitId, to: VisitId, turn: f64| {
            let u = |v: VisitId| model.net.visits[v.index()].u;
            ((u(to) + turn - u(from)) as f32, take_in.taken(&model.net, from, to, turn > 0.0) as f32)
        };
        for (id, term) in model.segments.iter().enumerate() {
            let s = &term.stencil;
            let [visit_0, visit_1] = s.visits.map(|v| v.0);
            let [node_0, node_1] = self.nodes_of(s);
            let (laid, taken) = slid(s.visits[0], s.visits[1], s.turn[1]);
            let record = Segment {
                node_0,
                node_1,
                visit_0,
                visit_1,
                dye: term.dye,
                in_contact: u32::from(term.in_contact),
                id: id as u32,
                laid,
                taken,
                rest: term.rest as f32,
                climb: term.climb as f32,
                closeness: term.closeness as f32,
            };
            let place = s.visits.map(|v| model.sliding[v.index()]);
            self.enlist(model, columns, &mut lists, s, OF_SEGMENT, place, |c| {
                c.segments.push(record);
                c.segments.len()
            });
        }
        for term in &model.bends {
            let s = &term.stencil;
            let [node_0, node_1, node_2] = self.nodes_of(s);
            let (laid, taken) = slid(s.visits[0], s.visits[2], s.turn[2]);
            let [visit_0, _, visit_2] = s.visits.map(|v| v.0);
            let jam_angle = term.jam_angle as f32;
            let record =
                Bend { node_0, node_1, node_2, visit_0, visit_2, dye: term.dye, laid, taken, jam_angle };
            let [from, _, to] = s.visits.map(|v| model.sliding[v.index()]);
            self.enlist(model, columns, &mut lists, s, OF_BEND, [from, FROZEN, to], |c| {
                c.bends.push(record);
                c.bends.len()
            });
        }
        for term in &model.wraps {
            let [node_0, node_1, node_2, node_3] = self.nodes_of(&term.stencil);
            let Wrapping { modulus, angle } = term.wrapping;
            let (own_sin, own_cos) = angle.map_or((0.0, 0.0), f64::sin_cos);
            let record = Wrap {
                node_0,
                node_1,
                node_2,
                node_3,
                dye: term.dye,
                handedness: term.handedness as f32,
                own_sin: own_sin as f32,
                own_cos: own_cos as f32,
                rest: (modulus * term.rest) as f32,
            };
            self.enlist(model, columns, &mut lists, &term.stencil, OF_WRAP, [FROZEN; 4], |c| {
                c.wraps.push(record);
                c.wraps.len()
            });
        }
        for (id, term) in model.shears.iter().enumerate() {
            let s = &term.stencil;
            let [node_0, node_1, node_2, node_3] = self.nodes_of(s);
            let [visit_0, visit_1, visit_2, visit_3] = s.visits.map(|v| v.0);
            let u = |v: VisitId| model.net.visits[v.index()].u;
            let record = Shear {
                node_0,
                node_1,
                node_2,
                node_3,
                visit_0,
                visit_1,
                visit_2,
                visit_3,
                id: id as u32,
                laid_0: (u(s.visits[1]) - u(s.visits[0])) as f32,
                laid_1: (u(s.visits[3]) - u(s.visits[2])) as f32,
                ..Shear::default()
            };
            self.enlist(model, columns, &mut lists, s, OF_SHEAR, [FROZEN; 4], |c| {
                c.shears.push(record);
                c.shears.len()
            });
        }
        for chunk in &mut self.chunks {
            let first = chunk.counts.first_node as usize;
            for n in first..first + chunk.counts.node_count as usize {
                self.nodes[n].entry = chunk.entries.len() as u32;
                chunk.entries.extend(lists.entries[n].iter().flatten());
                self.nodes[n].entry_end = chunk.entries.len() as u32;
            }
            let c = &mut chunk.counts;
            (c.segments, c.bends) = (chunk.segments.len() as u32, chunk.bends.len() as u32);
            (c.wraps, c.shears) = (chunk.wraps.len() as u32, chunk.shears.len() as u32);
            c.bends_at = c.segments * SEGMENT_OUT;
            c.wraps_at = c.bends_at + c.bends * BEND_OUT;
            c.shears_at = c.wraps_at + c.wraps * WRAP_OUT;
        }
        for node in &model.net.nodes {
            for (k, visit) in node.visits.iter().enumerate() {
                let pull = self.pulls.len() as u32;
                self.pulls.extend(&lists.pulls[visit.index()]);
                let pull_end = self.pulls.len() as u32;
                let dye = model.dye_of[visit.index()];
                self.stacked.push(Stacked { visit: visit.0, dye, parallel: 0, pull, pull_end });
                if k == 0 {
                    let n = self.pattern.new[model.net.visits[visit.index()].node.index()];
                    self.nodes[n as usize].visit = self.stacked.len() as u32 - 1;
                }
            }
        }
    }

    fn nodes_of<const K: usize>(&self, stencil: &Stencil<K>) -> [u32; K] {
        stencil.nodes.map(|n| self.pattern.new[n.index()])
    }

    /// Puts an element into every chunk that has one of its nodes, and into the lists of all its nodes and visits there. `slides`
    /// are the unknowns of its sliding coordinates.
    #[allow(clippy::too_many_arguments, reason = "what all kinds of elements have in common")]
    fn enlist<const K: usize>(
        &mut self,
        model: &Model,
        columns: &[Vec<(u32, u32)>],
        lists: &mut Lists,
        stencil: &Stencil<K>,
        kind: u32,
        slides: [u32; K],
        push: impl Fn(&mut Chunk) -> usize,
    ) {
        let nodes = self.nodes_of(stencil);
        let chunk_of = |n: u32| self.pattern.chunk_of[self.pattern.group_of[n as usize] as usize];
        let chunks = nodes.map(chunk_of);
        for (k, chunk) in chunks.iter().enumerate() {
            if chunks[..k].contains(chunk) {
                continue;
            }
            let index = push(&mut self.chunks[*chunk as usize]) as u32 - 1;
            for role in (0..K).filter(|r| chunks[*r] == *chunk) {
                let word = kind | (role as u32) << 2 | index << 4;
                let mut to = [0; 2];
                for other in 0..K {
                    let row = &columns[nodes[role] as usize];
                    let at = row.partition_point(|(m, _)| *m < nodes[other]);
                    let place = match slides[other] {
                        FROZEN => 0,
                        dof => dof - model.start[stencil.nodes[other].index()],
                    };
                    to[other / 2] |= (row[at].1 | place << 12) << (16 * (other % 2));
                }
                lists.entries[nodes[role] as usize].push([word, to[0], to[1]]);
                if kind == OF_SEGMENT || kind == OF_BEND || kind == OF_SHEAR && (role == 1 || role == 2) {
                    lists.pulls[stencil.visits[role].index()].push(word);
                }
            }
        }
    }
}
