//! From pieces to yarns: joined pieces are followed, loose ends get tails, arc lengths are measured.

use super::draft::Draft;
use super::{Port, course_port};
use crate::dye::Dye;
use crate::ids::{HalfEdgeId, NodeId, VisitId, YarnId};
use crate::stitch_mesh::StitchMesh;
use crate::yarn_net::{Loop, Node, NodeKind, TakenIn, Visit, Yarn, YarnNet};
use glam::DVec3;
use rayon::prelude::*;
use smallvec::smallvec;
use std::sync::Arc;

/// Length of a tail, in steps of [`Draft::outward`].
const TAIL: f64 = 1.2;

/// The least yarn of a segment [m]: edits can fold faces so that nodes of two of them lie in one place.
const SHORTEST: f64 = 1e-5;

/// Makes the net of a draft.
pub fn trace(mut draft: Draft<'_>) -> YarnNet {
    let mut nodes = Vec::with_capacity(draft.node_count() + draft.node_count() / 8);
    let (traced, ()) = rayon::join(
        || Tracer::all(&draft),
        || draft.faces.nodes(draft.vertex_normals).collect_into_vec(&mut nodes),
    );
    let Traced { number, crossed, mut visits, mut yarns, free } = traced;
    let numbered = |v: u32| VisitId(number[v as usize]);
    nodes.append(&mut draft.nodes);
    nodes.par_iter_mut().for_each(|node| node.visits.iter_mut().for_each(|v| *v = numbered(v.0)));
    nodes.extend(free);
    for contact in &mut draft.contacts {
        contact.new.iter_mut().chain(contact.old.iter_mut().flatten()).for_each(|v| *v = numbered(v.0));
    }
    let ((loops, contacts), ()) = rayon::join(
        || {
            let beyond = std::mem::take(&mut draft.contacts);
            (loops(draft.faces.stitches(), &crossed), draft.faces.contacts(numbered).chain(beyond).collect())
        },
        || measure(&mut visits, &mut yarns, &nodes),
    );
    // A segment begins at whichever of its ends the yarn meets first.
    let segment = |v: u32| numbered(v).min(numbered(v + 1));
    let taken_in = draft.take_in.iter();
    YarnNet {
        taken_in: taken_in.map(|(v, length)| TakenIn { segment: segment(*v), length: *length }).collect(),
        loops,
        nodes,
        contacts,
        visits: Arc::new(visits),
        yarns,
    }
}

/// How yarn crosses an edge: how many visits there had been before, doubled, and one more if it left the face of the half-edge.
type Crossed = u32;

/// Yarn does not cross.
const NOT: Crossed = Crossed::MAX;

/// What is found by following all yarns.
struct Traced {
    /// For every visit of the draft its number in the net.
    number: Vec<u32>,
    /// For every port of a half-edge how the yarn crossed it.
    crossed: Vec<Crossed>,
    /// All visits; where along their yarn has still to be measured.
    visits: Vec<Visit>,
    yarns: Vec<Yarn>,
    /// Tails and turns, whose nodes come after those of the draft.
    free: Vec<Node>,
}

struct Tracer<'a> {
    draft: &'a Draft<'a>,
    traced: Traced,
    /// Which pieces have been followed.
    used: Vec<bool>,
    /// The colour that goes on.
    dye: Option<Dye>,
}

impl<'a> Tracer<'a> {
    /// Follows all yarns: open ones first, from their loose ends, then what is left: rings.
    fn all(draft: &'a Draft<'a>) -> Traced {
        let mut tracer = Self {
            draft,
            traced: Traced {
                number: vec![0; draft.visit_count()],
                crossed: vec![NOT; draft.faces.port_count()],
                visits: Vec::with_capacity(draft.visit_count() + 2),
                yarns: Vec::new(),
                free: Vec::new(),
            },
            used: vec![false; draft.piece_count()],
            dye: None,
        };
        for (piece, ends) in draft.ends().enumerate() {
            if !tracer.used[piece]
                && let Some(end) = ends.into_iter().find(|end| draft.is_loose(*end))
            {
                tracer.follow(end, true);
            }
        }
        for (piece, [from, _]) in draft.ends().enumerate() {
            if !tracer.used[piece] {
                tracer.follow(from, false);
            }
        }
        tracer.traced
    }

    /// Follows the yarn that enters a piece at `from` to its end, or round.
    fn follow(&mut self, from: Port, open: bool) {
        let start = self.traced.visits.len();
        self.dye = None;
        let mut entry = from;
        while let Some(piece) = self.draft.piece_at(entry) {
            self.used[piece.number as usize] = true;
            let forward = entry == piece.from;
            if piece.own {
                self.dye = Some(piece.dye);
            }
            let dye = self.dye.unwrap_or(piece.dye);
            self.cross(entry, false);
            for i in 0..piece.nodes.len() {
                let i = if forward { i } else { piece.nodes.len() - 1 - i };
                let node = NodeId(piece.nodes_before + piece.nodes[i]);
                self.pass(piece.first + i as u32, node, dye, start, open);
            }
            let exit = if forward { piece.to } else { piece.from };
            self.cross(exit, true);
            match self.draft.other_side(exit) {
                Some(next) if next != from => entry = next,
                _ => break,
            }
        }
        self.end_yarn(start, open);
    }

    fn cross(&mut self, port: Port, outwards: bool) {
        if let Some(crossed) = self.traced.crossed.get_mut(port as usize) {
            *crossed = 2 * self.traced.visits.len() as Crossed + Crossed::from(outwards);
        }
    }

    /// Adds a visit to the yarn that began at `start`; before it a tail where a yarn begins, or a node of its own where it
    /// turns back to the node it comes from (a segment without length).
    fn pass(&mut self, visit: u32, node: NodeId, dye: Dye, start: usize, open: bool) {
        if self.traced.visits.len() == start {
            if open {
                self.free_node(node, TAIL, dye);
            }
        } else if self.traced.visits.last().is_some_and(|v| v.node == node) {
            self.free_node(node, 1.0, dye);
        }
        self.traced.number[visit as usize] = self.traced.visits.len() as u32;
        self.push(node, dye);
    }

    fn push(&mut self, node: NodeId, dye: Dye) {
        let yarn = YarnId::new(self.traced.yarns.len());
        self.traced.visits.push(Visit { node, yarn, u: 0.0, dye });
    }

    /// Adds a node with one visit, outwards of `beside`.
    fn free_node(&mut self, beside: NodeId, steps: f64, dye: Dye) {
        let (at, outward) = self.draft.node(beside);
        let node = NodeId::new(self.draft.node_count() + self.traced.free.len());
        self.traced.free.push(Node {
            position: at.position + outward * steps,
            visits: smallvec![VisitId::new(self.traced.visits.len())],
            face: None,
            kind: NodeKind::Free,
            ..at
        });
        self.push(node, dye);
    }

    fn end_yarn(&mut self, start: usize, open: bool) {
        let visits = &self.traced.visits;
        let (Some(first), Some(last)) = (visits.get(start).copied(), visits.last().copied()) else {
            return;
        };
        if open {
            self.free_node(last.node, TAIL, last.dye);
        } else if first.node == last.node {
            self.free_node(last.node, 1.0, last.dye);
        }
        let visits = start as u32..self.traced.visits.len() as u32;
        self.traced.yarns.push(Yarn { visits, period: (!open).then_some(0.0) });
    }
}

/// Visits that are measured in one go.
const MEASURED: usize = 1 << 12;

/// Measures where along their yarns the visits lie.
fn measure(visits: &mut [Visit], yarns: &mut [Yarn], nodes: &[Node]) {
    let position = |v: &Visit| nodes[v.node.index()].position;
    let apart = |a: DVec3, b: DVec3| a.distance(b).max(SHORTEST);
    // First the way of each from the visit before it, whichever yarn that is of.
    let begin: Vec<DVec3> = visits
        .first()
        .into_iter()
        .chain(visits.iter().skip(MEASURED - 1).step_by(MEASURED))
        .map(position)
        .collect();
    visits.par_chunks_mut(MEASURED).zip(begin).for_each(|(chunk, mut before)| {
        for visit in chunk {
            let at = position(visit);
            visit.u = apart(before, at);
            before = at;
        }
    });
    for yarn in yarns {
        let visits = &mut visits[yarn.visits.start as usize..yarn.visits.end as usize];
        let (Some(first), Some(last)) = (visits.first().map(position), visits.last().map(position)) else {
            continue;
        };
        visits[0].u = 0.0;
        let mut u = 0.0;
        for visit in &mut visits[1..] {
            u += visit.u;
            visit.u = u;
        }
        yarn.period = yarn.period.map(|_| u + apart(last, first));
    }
}

/// The loops of all stitches that go up into a stitch or a border, and come back. Others go up only: handed on from below by
/// stitches whose rows run the other way.
fn loops(stitches: &StitchMesh, crossed: &[Crossed]) -> Vec<Loop> {
    let mesh = stitches.mesh();
    let goes_up = |h: &HalfEdgeId| mesh.twin(*h).is_none_or(|t| stitches.is_bottom(t));
    let mut loops = Vec::with_capacity(stitches.loop_count());
    for top in mesh.faces().flat_map(|f| stitches.tops(f)).filter(goes_up) {
        let [left, right] = [1, 0].map(|place| crossed[course_port(top, place) as usize]);
        if left == NOT || right == NOT {
            continue;
        }
        let [up, down] = if left / 2 <= right / 2 { [left, right] } else { [right, left] };
        let outwards = |crossed: Crossed| crossed % 2 == 1;
        // A loop that passes nothing at all is held by nothing, whichever way its yarn runs.
        if up / 2 == down / 2 || outwards(up) && !outwards(down) {
            loops.push(Loop { top, head: up / 2..down / 2 });
        }
    }
    loops
}
