//! From pieces to yarns: joined pieces are followed, loose ends get tails, arc lengths are measured.

use super::draft::{Draft, Piece, PieceAt};
use super::{Port, course_port};
use crate::dye::Dye;
use crate::ids::{NodeId, VisitId, YarnId};
use crate::stitch_mesh::StitchMesh;
use crate::yarn_net::{Loop, NodeKind, TakenIn, Visit, Yarn, YarnNet};
use smallvec::SmallVec;
use std::sync::Arc;

/// Length of a tail, in steps of [`Draft::outward`].
const TAIL: f64 = 1.2;

/// The least yarn of a segment [m]: edits can fold faces so that nodes of two of them lie in one place.
const SHORTEST: f64 = 1e-5;

/// Not visited by any yarn.
const NONE: u32 = u32::MAX;

/// Makes the net of a draft.
pub fn trace(stitches: &StitchMesh, draft: Draft) -> YarnNet {
    let piece_at = PieceAt::of(&draft);
    let mut used = vec![false; draft.pieces.len()];
    let mut tracer = Tracer {
        crossed: vec![None; 2 * stitches.mesh().half_edge_count()],
        number: vec![NONE; draft.visits.len()],
        visits: Vec::with_capacity(draft.visits.len() + 2),
        yarns: Vec::new(),
        dye: None,
        draft,
    };
    // Open yarns first, from their loose ends, then what is left: rings.
    for open in [true, false] {
        for start in 0..used.len() {
            let Piece { from, to, .. } = tracer.draft.pieces[start];
            let from = match open {
                _ if used[start] => continue,
                true if piece_at.is_loose(&tracer.draft, from) => from,
                true if piece_at.is_loose(&tracer.draft, to) => to,
                false => from,
                true => continue,
            };
            tracer.follow(&piece_at, from, open, &mut used);
        }
    }
    tracer.finish(stitches)
}

/// How yarn crosses an edge.
#[derive(Clone, Copy)]
struct Crossed {
    /// How many visits there had been before.
    visits: u32,
    /// Whether it left the face of the half-edge, or came into it.
    outwards: bool,
}

struct Tracer {
    draft: Draft,
    visits: Vec<Visit>,
    yarns: Vec<Yarn>,
    /// For every visit of the draft its number in the net.
    number: Vec<u32>,
    /// For every port of a half-edge how the yarn crossed it.
    crossed: Vec<Option<Crossed>>,
    /// The colour that goes on.
    dye: Option<Dye>,
}

impl Tracer {
    /// Follows the yarn that enters a piece at `from` to its end, or round.
    fn follow(&mut self, piece_at: &PieceAt, from: Port, open: bool, used: &mut [bool]) {
        let start = self.visits.len();
        self.dye = None;
        let mut entry = from;
        while let Some(at) = piece_at.get(entry) {
            used[at] = true;
            let Piece { from: begin, to: end, first, end: last, dye, own } = self.draft.pieces[at];
            let forward = entry == begin;
            if own {
                self.dye = Some(dye);
            }
            self.cross(entry, false);
            for i in 0..last - first {
                let visit = if forward { first + i } else { last - 1 - i };
                self.pass(visit, self.dye.unwrap_or(dye), start, open);
            }
            let exit = if forward { end } else { begin };
            self.cross(exit, true);
            match self.draft.other_side(exit) {
                Some(next) if next != from => entry = next,
                _ => break,
            }
        }
        self.end_yarn(start, open);
    }

    fn cross(&mut self, port: Port, outwards: bool) {
        if let Some(crossed) = self.crossed.get_mut(port as usize) {
            *crossed = Some(Crossed { visits: self.visits.len() as u32, outwards });
        }
    }

    /// Adds a visit to the yarn that began at `start`; before it a tail where a yarn begins, or a node of its own where it
    /// turns back to the node it comes from (a segment without length).
    fn pass(&mut self, visit: u32, dye: Dye, start: usize, open: bool) {
        let node = self.draft.visits[visit as usize];
        if self.visits.len() == start {
            if open {
                self.free_node(node, TAIL, dye);
            }
        } else if self.visits.last().is_some_and(|v| v.node == node) {
            self.free_node(node, 1.0, dye);
        }
        self.number[visit as usize] = self.visits.len() as u32;
        self.push(node, dye);
    }

    fn push(&mut self, node: NodeId, dye: Dye) {
        self.visits.push(Visit { node, yarn: YarnId::new(self.yarns.len()), u: 0.0, dye });
    }

    /// Adds a node with one visit, outwards of `beside`.
    fn free_node(&mut self, beside: NodeId, steps: f64, dye: Dye) {
        let outward = self.draft.outward[beside.index()];
        let at = &self.draft.nodes[beside.index()];
        let (position, normal) = (at.position + outward * steps, at.normal);
        let node = self.draft.add_node(position, normal, NodeKind::Free, outward);
        let visit = self.draft.visits.len() as u32;
        self.draft.visits.push(node);
        self.draft.nodes[node.index()].visits.push(VisitId(visit));
        self.number.push(self.visits.len() as u32);
        self.push(node, dye);
    }

    fn end_yarn(&mut self, start: usize, open: bool) {
        let (Some(first), Some(last)) = (self.visits.get(start).copied(), self.visits.last().copied()) else {
            return;
        };
        if open {
            self.free_node(last.node, TAIL, last.dye);
        } else if first.node == last.node {
            self.free_node(last.node, 1.0, last.dye);
        }
        let mut u = 0.0;
        let position = |v: &Visit| self.draft.nodes[v.node.index()].position;
        let mut before = position(&first);
        for (i, visit) in self.visits[start..].iter_mut().enumerate() {
            let here = position(visit);
            u += if i == 0 { 0.0 } else { before.distance(here).max(SHORTEST) };
            visit.u = u;
            before = here;
        }
        self.yarns.push(Yarn {
            visits: start as u32..self.visits.len() as u32,
            period: (!open).then_some(u + before.distance(position(&first)).max(SHORTEST)),
        });
    }

    fn finish(mut self, stitches: &StitchMesh) -> YarnNet {
        let number = &self.number;
        let renumber = |v: &mut VisitId| v.0 = number[v.index()];
        for node in &mut self.draft.nodes {
            node.visits.iter_mut().for_each(renumber);
        }
        for contact in &mut self.draft.contacts {
            contact.new.iter_mut().for_each(renumber);
            contact.old.iter_mut().flatten().for_each(renumber);
        }
        // A segment begins at whichever of its ends the yarn meets first.
        let segment = |v: u32| VisitId(number[v as usize].min(number[v as usize + 1]));
        let taken_in = self.draft.take_in.iter();
        YarnNet {
            taken_in: taken_in.map(|(v, length)| TakenIn { segment: segment(*v), length: *length }).collect(),
            loops: loops(stitches, &self.crossed),
            nodes: self.draft.nodes,
            contacts: self.draft.contacts,
            visits: Arc::new(self.visits),
            yarns: self.yarns,
        }
    }
}

/// The loops of all stitches that go up into a stitch or a border, and come back. Others go up only: handed on from below by
/// stitches whose rows run the other way.
fn loops(stitches: &StitchMesh, crossed: &[Option<Crossed>]) -> Vec<Loop> {
    let mesh = stitches.mesh();
    let mut loops = Vec::with_capacity(stitches.loop_count());
    for face in mesh.faces() {
        let ends: SmallVec<[_; 4]> = stitches.tops(face).collect();
        for top in ends.into_iter().filter(|h| mesh.twin(*h).is_none_or(|t| stitches.is_bottom(t))) {
            let [left, right] = [1, 0].map(|place| crossed[course_port(top, place) as usize]);
            let (Some(left), Some(right)) = (left, right) else { continue };
            let (up, down) = if left.visits <= right.visits { (left, right) } else { (right, left) };
            // A loop that passes nothing at all is held by nothing, whichever way its yarn runs.
            if up.visits == down.visits || up.outwards && !down.outwards {
                loops.push(Loop { top, head: up.visits..down.visits });
            }
        }
    }
    loops
}
