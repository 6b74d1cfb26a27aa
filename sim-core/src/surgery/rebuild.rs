//! A net built from pieces of the yarns of another one.

use super::Operated;
use glam::DVec3;
use smallvec::SmallVec;
use std::sync::Arc;
use stitch_mesh::dye::Dye;
use stitch_mesh::ids::{NodeId, VisitId, YarnId};
use stitch_mesh::yarn_net::{Loop, Node, NodeKind, StitchContact, Visit, Yarn, YarnNet, YarnState};

/// A place along a yarn: one it had, or a new end.
#[derive(Clone, Debug)]
pub(super) struct Stop {
    place: Place,
    /// Sliding coordinate as laid and in the state [m].
    u: [f64; 2],
    dye: Dye,
}

#[derive(Clone, Debug)]
enum Place {
    /// A visit, and by how much its sliding coordinates have been moved [m].
    Old(VisitId, f64),
    End {
        /// Position as laid and in the state [m].
        position: [DVec3; 2],
        velocity: DVec3,
        normal: DVec3,
    },
}

/// A yarn to be.
#[derive(Clone, Debug)]
pub(super) struct Piece {
    pub stops: Vec<Stop>,
    pub period: Option<f64>,
}

impl Stop {
    /// A visit as it is, its sliding coordinate moved by `shift`.
    pub fn at(net: &YarnNet, state: &YarnState, visit: VisitId, shift: f64) -> Self {
        let laid = &net.visits[visit.index()];
        let u = [laid.u + shift, state.sliding[visit.index()] + shift];
        Self { place: Place::Old(visit, shift), u, dye: laid.dye }
    }

    /// A new end at `part` of the way between two consecutive visits; `turn` is added to the second sliding coordinate.
    pub fn between(net: &YarnNet, state: &YarnState, visits: [VisitId; 2], turn: f64, part: f64) -> Self {
        let [a, b] = visits.map(|v| v.index());
        let [n, m] = visits.map(|v| net.visits[v.index()].node.index());
        let mix = |from: f64, to: f64| from + part * (to - from);
        let laid = net.nodes[n].position.lerp(net.nodes[m].position, part);
        Self {
            place: Place::End {
                position: [laid, state.position[n].lerp(state.position[m], part)],
                velocity: state.velocity[n].lerp(state.velocity[m], part),
                normal: net.nodes[n].normal,
            },
            u: [mix(net.visits[a].u, net.visits[b].u + turn), mix(state.sliding[a], state.sliding[b] + turn)],
            dye: net.visits[a].dye,
        }
    }

    /// The same place along the yarn on a node of its own.
    pub fn alone(&self, net: &YarnNet, state: &YarnState) -> Self {
        let Place::Old(visit, _) = self.place else { return self.clone() };
        let node = net.visits[visit.index()].node.index();
        let place = Place::End {
            position: [net.nodes[node].position, state.position[node]],
            velocity: state.velocity[node],
            normal: net.nodes[node].normal,
        };
        Self { place, ..*self }
    }

    /// The same further along.
    pub fn moved(mut self, by: f64) -> Self {
        self.u = self.u.map(|u| u + by);
        if let Place::Old(_, shift) = &mut self.place {
            *shift += by;
        }
        self
    }

    /// The visit that it was.
    pub fn visit(&self) -> Option<VisitId> {
        match self.place {
            Place::Old(visit, _) => Some(visit),
            Place::End { .. } => None,
        }
    }
}

/// The net whose yarns are `pieces`, and the state that continues `state`. Pieces without a segment are left out.
pub(super) fn rebuild(net: &YarnNet, state: &YarnState, mut pieces: Vec<Piece>) -> Operated {
    pieces.retain(|p| p.stops.len() > 1);
    let mut new_visit = vec![None; net.visits.len()];
    let stops = || pieces.iter().flat_map(|p| &p.stops);
    for (new, visit) in stops().enumerate().filter_map(|(i, s)| Some((VisitId::new(i), s.visit()?))) {
        new_visit[visit.index()] = Some(new);
    }

    let mut nodes = Vec::new();
    let mut position = Vec::new();
    let mut velocity = Vec::new();
    let mut node_of = vec![None; net.nodes.len()];
    for (old, node) in net.nodes.iter().enumerate() {
        let visits: SmallVec<[VisitId; 3]> =
            node.visits.iter().filter_map(|v| new_visit[v.index()]).collect();
        if visits.is_empty() {
            continue;
        }
        let left_alone = visits.len() == 1 && node.visits.len() > 1;
        let kind = if left_alone { NodeKind::Loose } else { node.kind };
        node_of[old] = Some(NodeId::new(nodes.len()));
        nodes.push(Node { visits, kind, ..node.clone() });
        position.push(state.position[old]);
        velocity.push(state.velocity[old]);
    }

    let mut visits = Vec::new();
    let mut yarns = Vec::new();
    let mut was = Vec::new();
    for (yarn, piece) in pieces.iter().enumerate() {
        let first = visits.len() as u32;
        for stop in &piece.stops {
            let id = VisitId::new(visits.len());
            let (node, from) = match stop.place {
                Place::Old(visit, shift) => {
                    (node_of[net.visits[visit.index()].node.index()], Some((visit, shift)))
                }
                Place::End { position: [laid, now], velocity: v, normal } => {
                    let (visits, kind) = (SmallVec::from_slice(&[id]), NodeKind::Loose);
                    nodes.push(Node { position: laid, normal, visits, face: None, kind });
                    position.push(now);
                    velocity.push(v);
                    (Some(NodeId::new(nodes.len() - 1)), None)
                }
            };
            // A visit that stays keeps its node.
            let Some(node) = node else { continue };
            visits.push(Visit { node, yarn: YarnId::new(yarn), u: stop.u[0], dye: stop.dye });
            was.push(from);
        }
        yarns.push(Yarn { visits: first..visits.len() as u32, period: piece.period });
    }

    let sliding = stops().map(|s| s.u[1]).collect();
    let rate = |from: &Option<(VisitId, f64)>| from.map_or(0.0, |(v, _)| state.sliding_velocity[v.index()]);
    let sliding_velocity = was.iter().map(rate).collect();
    let mut made = YarnNet {
        nodes,
        visits: Arc::new(visits),
        yarns,
        contacts: Vec::new(),
        loops: net.loops.iter().map(|l| remapped(l, &new_visit)).collect(),
        taken_in: Vec::new(),
    };
    made.contacts = net.contacts.iter().filter_map(|c| lasting(c, &new_visit, &made)).collect();
    let state = YarnState { position, velocity, sliding, sliding_velocity, taken_in: 1.0 };
    Operated { net: made, state, was, node: node_of }
}

/// A loop, its head as far as it is left; an empty head lies before the visit that comes after it.
fn remapped(l: &Loop, new: &[Option<VisitId>]) -> Loop {
    let left: SmallVec<[u32; 8]> = l.head.clone().filter_map(|v| new[v as usize]).map(|v| v.0).collect();
    let head = match (left.iter().min(), left.iter().max()) {
        (Some(first), Some(last)) if (last - first) as usize + 1 == left.len() => *first..*last + 1,
        // Cut in two: no loop any more, but two ends.
        (Some(_), Some(_)) => 0..0,
        _ => {
            let after = new.get(l.head.end as usize).copied().flatten().map_or(0, |v| v.0);
            after..after
        }
    };
    Loop { top: l.top, head }
}

/// What is left of a contact: none without both ends of the new yarn, or without any old loop.
fn lasting(c: &StitchContact, new: &[Option<VisitId>], net: &YarnNet) -> Option<StitchContact> {
    let pair = |ends: &[VisitId; 2]| {
        let [a, b] = [new[ends[0].index()]?, new[ends[1].index()]?];
        (net.next(a) == Some(b) || net.next(b) == Some(a)).then_some([a, b])
    };
    let old: SmallVec<[[VisitId; 2]; 1]> = c.old.iter().filter_map(pair).collect();
    let new_yarn = pair(&c.new)?;
    (!old.is_empty()).then_some(StitchContact { new: new_yarn, old, ..c.clone() })
}
