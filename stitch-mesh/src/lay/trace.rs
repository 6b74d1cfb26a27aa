//! From pieces to yarns: joined pieces are followed, loose ends get tails, arc lengths are measured.

use super::{Draft, DraftNode, DraftVisit, Piece, Port};
use crate::ids::{NodeId, VisitId, YarnId};
use crate::yarn_net::{Node, StitchContact, Visit, Yarn, YarnNet};
use smallvec::SmallVec;

/// Colour of yarn that nobody has dyed, linear RGB: undyed wool.
const UNDYED: [f32; 3] = [0.72, 0.62, 0.47];

/// Length of a tail, in steps of [`DraftNode::outward`].
const TAIL: f64 = 1.2;

/// Makes the net of a draft.
pub fn trace(mut draft: Draft) -> YarnNet {
    let piece_at = draft.piece_at_ports();
    let mut used = vec![false; draft.pieces.len()];
    let mut net = YarnNet::default();
    let mut final_visit = Vec::new();
    let is_loose =
        |draft: &Draft, port: Port| draft.joined[port].is_none_or(|other| piece_at[other].is_none());
    // Open yarns first, from their loose ends, then what is left: rings.
    for open in [true, false] {
        for start in 0..draft.pieces.len() {
            let Piece { from, to, .. } = draft.pieces[start];
            let from = match open {
                true if is_loose(&draft, from) => from,
                true if is_loose(&draft, to) => to,
                false => from,
                true => continue,
            };
            if used[start] {
                continue;
            }
            let mut run: Vec<DraftVisit> = Vec::new();
            for (piece, forward) in draft.follow(&piece_at, from).0 {
                used[piece] = true;
                let visits = &draft.pieces[piece].visits;
                if forward { run.extend(visits) } else { run.extend(visits.iter().rev()) }
            }
            let run = with_turns(&mut draft, run, open);
            if run.len() > 1 {
                add_yarn(&mut net, &draft, &run, !open, &mut final_visit);
            }
        }
    }
    let place = |v: &DraftVisit| final_visit.get(*v).copied().flatten();
    net.contacts = draft
        .contacts
        .iter()
        .filter_map(|c| {
            let pair = |[a, b]: &[DraftVisit; 2]| Some([place(a)?, place(b)?]);
            let old: Option<SmallVec<_>> = c.old.iter().map(pair).collect();
            Some(StitchContact { handedness: c.handedness, new: pair(&c.new)?, old: old? })
        })
        .collect();
    net.nodes = draft
        .nodes
        .iter()
        .map(|n| Node {
            position: n.position,
            normal: n.normal,
            visits: n.stack.iter().filter_map(place).collect(),
            face: n.face,
        })
        .collect();
    net
}

/// Puts a node of its own where a yarn turns back to the node it comes from (a segment without length), and at loose ends.
fn with_turns(draft: &mut Draft, run: Vec<DraftVisit>, open: bool) -> Vec<DraftVisit> {
    let mut out = Vec::with_capacity(run.len() + 2);
    if let (true, Some(first)) = (open, run.first()) {
        out.push(free_node(draft, *first, TAIL));
    }
    for (i, visit) in run.iter().enumerate() {
        out.push(*visit);
        let next = if i + 1 < run.len() { Some(run[i + 1]) } else { run.first().copied().filter(|_| !open) };
        if next.is_some_and(|n| n != *visit && draft.visits[n] == draft.visits[*visit]) {
            out.push(free_node(draft, *visit, 1.0));
        }
    }
    if let (true, Some(last)) = (open, run.last()) {
        out.push(free_node(draft, *last, TAIL));
    }
    out
}

/// A node with one visit, outwards of the node of `visit`.
fn free_node(draft: &mut Draft, visit: DraftVisit, steps: f64) -> DraftVisit {
    let beside = &draft.nodes[draft.visits[visit].index()];
    let node = DraftNode {
        position: beside.position + beside.outward * steps,
        normal: beside.normal,
        outward: beside.outward,
        face: None,
        stack: SmallVec::new(),
    };
    let node = draft.node(node);
    let visit = draft.visit(node);
    draft.nodes[node.index()].stack.push(visit);
    visit
}

fn add_yarn(
    net: &mut YarnNet,
    draft: &Draft,
    run: &[DraftVisit],
    closed: bool,
    final_visit: &mut Vec<Option<VisitId>>,
) {
    let yarn = YarnId::new(net.yarns.len());
    let start = net.visits.len() as u32;
    let position = |v: DraftVisit| draft.nodes[draft.visits[v].index()].position;
    final_visit.resize(draft.visits.len(), None); // turns and tails have been added
    let mut u = 0.0;
    let mut before: Option<DraftVisit> = None;
    for visit in run {
        u += before.map_or(0.0, |b| position(b).distance(position(*visit)));
        final_visit[*visit] = Some(VisitId::new(net.visits.len()));
        let node: NodeId = draft.visits[*visit];
        net.visits.push(Visit { node, yarn, u });
        before = Some(*visit);
    }
    let closing = position(run[run.len() - 1]).distance(position(run[0]));
    net.yarns.push(Yarn {
        visits: start..net.visits.len() as u32,
        period: closed.then_some(u + closing),
        color: UNDYED,
    });
}
