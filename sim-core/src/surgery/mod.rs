//! Surgery: yarn is cut, and yarn that has slipped out of a contact leaves it, while the fabric is simulated.
//!
//! # Theory
//! Cirio et al. §5.2.4 (Fig. 13): a contact is persistent only as long as its yarns are wrapped around each other. Where one
//! leaves, the node of five unknowns becomes two of three: the node stays with the yarn that stays, and the other goes on
//! from its neighbours, a free end on the node of its own that it has had. What this module does is topology alone; `slip.rs`
//! decides when.
//!
//! # Practice
//! An operation makes a new net and the state that continues the old one. Ids are those of the net it is done on, and change
//! with it; [`Operated`] tells which visit was which. Operations are kept in order ([`Surgery`]), so that a saved project can
//! do them again on the net it lays.
//!
//! | operation | what happens |
//! |---|---|
//! | [`Operation::Cut`] | a segment is cut in its middle: an open yarn becomes two, a closed one is opened |
//! | [`Operation::Release`] | visits leave their nodes; a node that nobody visits goes, and so does a yarn without a segment |
//!
//! The end of a yarn that is released gets a node of its own. A node that is left with one visit becomes [`NodeKind::Loose`]; a contact lasts while both ends of its new yarn and of one
//! old loop do. What was still to be taken in of a cable's legs stays as it is at the first operation.

mod rebuild;
pub(crate) mod slip;

use crate::take_in::TakeIn;
use rebuild::{Piece, Stop, rebuild};
use serde::{Deserialize, Serialize};
use std::sync::Arc;
use stitch_mesh::ids::{NodeId, VisitId, YarnId};
use stitch_mesh::yarn_net::{YarnNet, YarnState};

/// Share of a segment between the two ends that a cut leaves: they have to have some distance.
const KERF: f64 = 0.2;

/// One change of the topology of a net.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Operation {
    /// Cuts the yarn between a visit and the next one.
    Cut(VisitId),
    /// Takes visits out of their nodes.
    Release(Vec<VisitId>),
}

/// What has been done to a net since it was laid.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Surgery {
    /// How much of the net was taken in by then, 0 to 1.
    pub taken_in: f64,
    /// The operations in their order.
    pub operations: Vec<Operation>,
}

/// Why there is no such operation.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum SurgeryError {
    /// The net has no such visit.
    #[error("surgery: there is no visit {0} in a net of {1}")]
    NoVisit(VisitId, usize),
    /// The visit is the end of its yarn.
    #[error("surgery: nothing to cut, the yarn ends at visit {0}")]
    YarnEnd(VisitId),
}

/// A net and a state after an operation.
#[derive(Clone, Debug)]
pub struct Operated {
    /// The net.
    pub net: YarnNet,
    /// The state that continues the one before.
    pub state: YarnState,
    /// Which visit each one was, and by how much its sliding coordinates have been moved [m]; none for new ends.
    pub was: Vec<Option<(VisitId, f64)>>,
    /// Which node each old one is, if it is still there, [old node_count].
    pub node: Vec<Option<NodeId>>,
}

impl Surgery {
    /// Adds an operation on a net that is taken in so far.
    pub fn add(&mut self, operation: Operation, taken_in: f64) {
        if self.operations.is_empty() {
            self.taken_in = taken_in;
        }
        self.operations.push(operation);
    }

    /// This surgery, and then another on the net that it has left.
    pub fn then(mut self, next: &Self) -> Self {
        next.operations.iter().for_each(|o| self.add(o.clone(), next.taken_in));
        self
    }

    /// The net that a net has become, and which node each one of it is now, if it is still there. Positions are those that
    /// nodes would have as laid.
    ///
    /// # Errors
    /// The operations belong to another net.
    pub fn replay(&self, laid: &Arc<YarnNet>) -> Result<(Arc<YarnNet>, Vec<Option<NodeId>>), SurgeryError> {
        let mut state = laid.laid_state();
        state.taken_in = self.taken_in;
        let mut net = Arc::clone(laid);
        let mut nodes: Vec<Option<NodeId>> = (0..laid.nodes.len()).map(|n| Some(NodeId::new(n))).collect();
        for operation in &self.operations {
            let done = operate(&net, &state, operation)?;
            (net, state) = (Arc::new(done.net), done.state);
            nodes.iter_mut().for_each(|n| *n = n.and_then(|n| done.node[n.index()]));
        }
        Ok((net, nodes))
    }
}

/// Does `operation` on a net in a state.
///
/// # Errors
/// The net has no such visit, or nothing to cut there.
pub fn operate(net: &YarnNet, state: &YarnState, operation: &Operation) -> Result<Operated, SurgeryError> {
    let settled = TakeIn::new(net).settle(net, state.taken_in);
    let net = settled.as_ref().unwrap_or(net);
    let known = |v: &VisitId| {
        let count = net.visits.len();
        if v.index() < count { Ok(()) } else { Err(SurgeryError::NoVisit(*v, count)) }
    };
    let pieces = match operation {
        Operation::Cut(segment) => {
            known(segment)?;
            cut(net, state, *segment)?
        }
        Operation::Release(visits) => {
            visits.iter().try_for_each(known)?;
            release(net, state, visits)
        }
    };
    Ok(rebuild(net, state, pieces))
}

/// The yarn `id` as it is.
fn whole(net: &YarnNet, state: &YarnState, id: YarnId) -> Piece {
    let yarn = &net.yarns[id.index()];
    let stops = yarn.visits.clone().map(|v| Stop::at(net, state, VisitId(v), 0.0)).collect();
    Piece { stops, period: yarn.period }
}

fn cut(net: &YarnNet, state: &YarnState, segment: VisitId) -> Result<Vec<Piece>, SurgeryError> {
    let next = net.next(segment).ok_or(SurgeryError::YarnEnd(segment))?;
    let mut pieces = Vec::with_capacity(net.yarns.len() + 1);
    for id in (0..net.yarns.len()).map(YarnId::new) {
        let piece = whole(net, state, id);
        if net.visits[segment.index()].yarn != id {
            pieces.push(piece);
            continue;
        }
        let place = segment.index() - net.yarns[id.index()].visits.start as usize + 1;
        let turn = if next > segment { 0.0 } else { piece.period.unwrap_or_default() };
        let ends = [0.5 - 0.5 * KERF, 0.5 + 0.5 * KERF]
            .map(|part| Stop::between(net, state, [segment, next], turn, part));
        let mut first = piece.stops;
        let mut second = first.split_off(place);
        let [before, after] = ends;
        first.push(before);
        match piece.period {
            None => {
                second.insert(0, after);
                pieces.push(Piece { stops: first, period: None });
                pieces.push(Piece { stops: second, period: None });
            }
            Some(period) => {
                // From behind the cut once around to before it; what lay before the seam now comes after a whole turn.
                let mut stops = vec![if turn > 0.0 { after.moved(-period) } else { after }];
                stops.extend(second);
                stops.extend(first.into_iter().map(|s| if turn > 0.0 { s } else { s.moved(period) }));
                pieces.push(Piece { stops, period: None });
            }
        }
    }
    Ok(pieces)
}

fn release(net: &YarnNet, state: &YarnState, visits: &[VisitId]) -> Vec<Piece> {
    let mut pieces: Vec<Piece> =
        (0..net.yarns.len()).map(|yarn| whole(net, state, YarnId::new(yarn))).collect();
    let goes = |stop: &Stop| stop.visit().is_some_and(|v| visits.contains(&v));
    for piece in &mut pieces {
        if piece.period.is_none() {
            // An end needs a node to itself: in the stack of another yarn nothing would hold its sliding coordinate.
            for place in [0, piece.stops.len() - 1] {
                if goes(&piece.stops[place]) {
                    piece.stops[place] = piece.stops[place].alone(net, state);
                }
            }
        }
        piece.stops.retain(|s| !goes(s));
    }
    pieces
}

#[cfg(test)]
mod tests;
