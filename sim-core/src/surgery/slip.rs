//! When yarn slips out.
//!
//! Nothing keeps yarn from sliding up to a loose node ([`NodeKind::Loose`]), or through the head of a loop that nothing holds.
//! What comes closer to it than contacts are apart in a fabric lets go:
//! - a loose **end** draws out of the contact next to it, which stays with the other yarn;
//! - a loose node **within** a yarn, left behind by another one, is taken out (a short segment collapses);
//! - a **loop** that nothing holds is drawn through the loop it was knitted into, out of both of its stitch contacts. The one
//!   below is then held by nothing either, and so it runs, ladder by ladder.

use super::Operation;
use crate::materials::Materials;
use std::collections::BTreeSet;
use stitch_mesh::ids::VisitId;
use stitch_mesh::yarn_net::{NodeKind, YarnNet, YarnState};

/// Yarn between a contact and a loose node at which it lets go, over the distance that contacts keep along a yarn.
const NEAR: f64 = 0.9;

/// What has slipped in `state`, if anything.
pub(crate) fn slipped(net: &YarnNet, state: &YarnState, materials: &Materials) -> Option<Operation> {
    let mut free = BTreeSet::new();
    let near = |a: VisitId, b: VisitId, turn: f64| {
        let limit = NEAR * materials.of(net.visits[a.index()].dye).parallel_distance;
        state.sliding[b.index()] + turn - state.sliding[a.index()] < limit
    };
    let is_loose = |v: VisitId| net.nodes[net.visits[v.index()].node.index()].kind == NodeKind::Loose;
    for segment in net.segments() {
        let [a, b] = segment.ends;
        if !(is_loose(a) || is_loose(b)) || !near(a, b, segment.wrap) {
            continue;
        }
        let (loose, other) = if is_loose(a) { (a, b) } else { (b, a) };
        let is_end = |v: VisitId| net.prev(v).is_none() || net.next(v).is_none();
        match (is_end(loose), is_end(other)) {
            (false, _) => free.insert(loose),
            (true, false) => free.insert(other),
            // A scrap of yarn between two ends.
            (true, true) => false,
        };
    }
    for [before, after] in unheld(net).filter(|[a, b]| near(*a, *b, 0.0)) {
        for contact in net.contacts.iter().filter(|c| c.new.contains(&before) || c.new.contains(&after)) {
            free.extend(contact.new);
        }
        free.extend([before, after]);
    }
    (!free.is_empty()).then(|| Operation::Release(free.into_iter().collect()))
}

/// The visits around the heads of loops that nothing holds any more.
pub(crate) fn unheld(net: &YarnNet) -> impl Iterator<Item = [VisitId; 2]> + '_ {
    let gone = net.loops.iter().filter(|l| l.head.is_empty() && l.head.end > 0);
    gone.filter_map(|l| {
        let after = VisitId(l.head.end);
        Some([net.prev(after)?, after]).filter(|[before, after]| before < after)
    })
}
