//! The yarn of a woven piece: ends and picks one after the other, from crossing to crossing, with a fringe at both ends.

use super::{Cell, Woven};
use crate::dye::Dye;
use crate::ids::{NodeId, VisitId, YarnId};
use crate::yarn_net::{Node, NodeKind, Visit, Yarn, YarnNet};
use glam::DVec3;
use smallvec::{SmallVec, smallvec};
use std::sync::Arc;

/// Length of the fringe beyond the last crossing, in spacings.
const FRINGE: f64 = 0.8;

impl Woven {
    /// The yarn of the piece. Its crossings come first among the nodes, pick by pick, each from the left.
    pub fn lay(&self) -> YarnNet {
        let [across, up, normal] = self.axes();
        let crossings = self.ends * self.picks;
        let place = |s: f64, t: f64| {
            let from_middle = |at: f64, count: usize| (at - 0.5 * (count as f64 - 1.0)) * self.spacing;
            self.middle + across * from_middle(s, self.ends) + up * from_middle(t, self.picks)
        };
        let node = |position: DVec3, kind: NodeKind| {
            let visits = SmallVec::new();
            Node { position, normal, visits, face: None, kind }
        };
        let mut net = YarnNet::default();
        for pick in 0..self.picks {
            net.nodes.extend((0..self.ends).map(|end| node(place(end as f64, pick as f64), NodeKind::Woven)));
        }
        let mut visits: Vec<Visit> = Vec::with_capacity(2 * (crossings + self.ends + self.picks));
        // A yarn from crossing to crossing, and whether it is in front there; the places beyond its ends.
        let mut weave = |run: &mut dyn Iterator<Item = (usize, bool)>, fringe: [DVec3; 2], dye: Dye| {
            let yarn = YarnId::new(net.yarns.len());
            let start = visits.len();
            let mut u = 0.0;
            let mut visit = |net: &mut YarnNet, node: usize, step: f64| {
                u += step;
                net.nodes[node].visits.push(VisitId::new(visits.len()));
                visits.push(Visit { node: NodeId::new(node), yarn, u, dye });
            };
            let tail = |net: &mut YarnNet, position| {
                net.nodes.push(node(position, NodeKind::Free));
                net.nodes.len() - 1
            };
            let first = tail(&mut net, fringe[0]);
            visit(&mut net, first, 0.0);
            let mut before = None;
            for (node, in_front) in run {
                let step = match before {
                    None => FRINGE * self.spacing,
                    Some(was) if was == in_front => self.spacing,
                    Some(_) => self.spacing.hypot(2.0 * self.radius()),
                };
                visit(&mut net, node, step);
                before = Some(in_front);
            }
            let last = tail(&mut net, fringe[1]);
            visit(&mut net, last, FRINGE * self.spacing);
            net.yarns.push(Yarn { visits: start as u32..visits.len() as u32, period: None });
        };
        let beyond = |count: usize| [-FRINGE, count as f64 - 1.0 + FRINGE];
        for end in 0..self.ends {
            let mut run =
                (0..self.picks).map(|pick| (pick * self.ends + end, self.draft.at(end, pick) == Cell::Warp));
            weave(&mut run, beyond(self.picks).map(|t| place(end as f64, t)), self.warp.at(end));
        }
        for pick in 0..self.picks {
            let mut run =
                (0..self.ends).map(|end| (pick * self.ends + end, self.draft.at(end, pick) == Cell::Weft));
            weave(&mut run, beyond(self.ends).map(|s| place(s, pick as f64)), self.weft.at(pick));
        }
        // The warp was there first; where the weft lies in front they change places.
        for (i, node) in net.nodes[..crossings].iter_mut().enumerate() {
            if self.draft.at(i % self.ends, i / self.ends) == Cell::Weft {
                let [warp, weft] = [node.visits[0], node.visits[1]];
                node.visits = smallvec![weft, warp];
            }
        }
        net.visits = Arc::new(visits);
        net
    }
}
