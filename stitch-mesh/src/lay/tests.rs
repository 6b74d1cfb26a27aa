//! What must hold for the yarn of any fabric.

use super::lay;
use crate::edge_counts::{EdgeCounts, StitchSize};
use crate::grid::grid;
use crate::ids::{FaceId, NodeId, VisitId};
use crate::pieces::tube;
use crate::stitch::Stitch;
use crate::stitch_mesh::StitchMesh;
use crate::tessellate::tessellate;
use crate::yarn_net::{NodeKind, YarnNet};
use proptest::prelude::*;

/// Everything that a net promises.
pub(super) fn check(net: &YarnNet) {
    let mut seen = vec![0; net.visits.len()];
    for (n, node) in net.nodes.iter().enumerate() {
        assert!(!node.visits.is_empty(), "node {n} has no yarn");
        assert!(node.position.is_finite() && (node.normal.length() - 1.0).abs() < 1e-9);
        for v in &node.visits {
            seen[v.index()] += 1;
            assert_eq!(net.visits[v.index()].node, NodeId::new(n));
        }
    }
    assert!(seen.iter().all(|n| *n == 1), "every visit is on the stack of its node once");
    let mut end = 0;
    for yarn in &net.yarns {
        assert_eq!(yarn.visits.start, end);
        end = yarn.visits.end;
    }
    assert_eq!(end as usize, net.visits.len());
    for segment in net.segments() {
        let [a, b] = segment.ends.map(|v| net.visits[v.index()]);
        let length = b.u + segment.wrap - a.u;
        let laid = net.nodes[a.node.index()].position.distance(net.nodes[b.node.index()].position);
        assert!(length > 1e-9 && (length - laid).abs() < 1e-9, "segments are laid at rest and have a length");
    }
    for contact in &net.contacts {
        assert!(contact.handedness.abs() == 1.0 && !contact.old.is_empty());
        let ends = contact.new.map(|v| net.visits[v.index()].node);
        for strand in contact.old.iter().chain([&contact.new]) {
            assert_eq!(strand.map(|v| net.visits[v.index()].node), ends);
            let [p, q] = *strand;
            assert!(net.next(p) == Some(q) || net.next(q) == Some(p), "the ends of a contact are neighbours");
        }
    }
}

fn fabric(wide: usize, high: usize, size: f64) -> StitchMesh {
    let labelled = grid(wide, high);
    tessellate(&labelled, &EdgeCounts::from_size(&labelled, StitchSize::of_width(size)).unwrap()).unwrap()
}

#[test]
fn flat_stockinette_is_one_yarn_with_four_nodes_a_loop() {
    let stitches = fabric(2, 2, 0.004);
    let net = lay(&stitches);
    check(&net);
    assert_eq!(net.yarns.len(), 1);
    assert!(net.yarns[0].period.is_none());
    let inside = net.nodes.iter().filter(|n| n.face.is_some()).count();
    assert_eq!(inside, 4 * stitches.loop_count());
    assert!(net.nodes.iter().filter(|n| n.face.is_some()).all(|n| n.visits.len() == 2));
}

#[test]
fn knit_and_purl_are_each_other_seen_from_behind() {
    let mut stitches = fabric(1, 1, 0.004);
    let knit = lay(&stitches);
    let faces: Vec<FaceId> = stitches.mesh().faces().collect();
    faces.iter().for_each(|f| stitches.set_stitch(*f, Stitch::purl()).unwrap());
    let purl = lay(&stitches);
    for (a, b) in knit.nodes.iter().zip(&purl.nodes).filter(|(n, _)| n.face.is_some()) {
        let mut turned = b.visits.clone();
        turned.reverse();
        assert_eq!(a.visits, turned);
    }
    for (a, b) in knit.contacts.iter().zip(&purl.contacts).take(stitches.loop_count() * 2) {
        assert_eq!(a.handedness, -b.handedness);
    }
}

#[test]
fn tube_is_closed_rows_without_an_end() {
    let stitches = tube(12, 5, StitchSize::of_width(0.003)).unwrap();
    let net = lay(&stitches);
    check(&net);
    assert!(net.yarns.iter().all(|y| y.period.is_some()));
    assert_eq!(net.yarns.len(), stitches.rows().len() + 2, "every row, the cast-on and the bind-off");
    assert!(net.nodes.iter().all(|n| n.visits.len() >= 2));
}

#[test]
fn opposed_rows_give_small_closed_yarns() {
    // Two rows of faces knitted towards each other: between them one closed yarn a wale (Fig. 8 of the paper).
    let mut labelled = grid(4, 2);
    labelled.flip_row(FaceId(4)).unwrap();
    let mut counts = EdgeCounts::from_size(&labelled, StitchSize::of_width(0.01)).unwrap();
    counts.counts.iter_mut().for_each(|c| *c = 1);
    let net = lay(&tessellate(&labelled, &counts).unwrap());
    check(&net);
    assert_eq!(net.yarns.iter().filter(|y| y.period.is_some()).count(), 3);
}

#[test]
fn a_stack_keeps_its_order_at_all_four_nodes() {
    let mut labelled = grid(1, 1);
    let mut counts = EdgeCounts::from_size(&labelled, StitchSize::of_width(0.01)).unwrap();
    let wales = labelled.wales(FaceId(0)).unwrap();
    counts.counts.iter_mut().for_each(|c| *c = 1);
    counts.counts[labelled.mesh().edge(labelled.bottoms(wales)[0]).index()] = 3;
    labelled.flip_row(FaceId(0)).unwrap();
    labelled.flip_row(FaceId(0)).unwrap();
    let mut stitches = tessellate(&labelled, &counts).unwrap();
    stitches.set_stitch(FaceId(0), "d312k".parse().unwrap()).unwrap();
    let net = lay(&stitches);
    check(&net);
    let nodes: Vec<_> = net.nodes.iter().filter(|n| n.face.is_some()).collect();
    assert_eq!(nodes.len(), 4);
    let contact = &net.contacts[0];
    let olds: Vec<VisitId> = contact.old.iter().map(|o| o[0]).collect();
    assert_eq!(nodes[0].visits[..3], olds[..], "in front of the new yarn at its foot");
    assert_eq!(nodes[1].visits[1..], contact.old.iter().map(|o| o[1]).collect::<Vec<_>>()[..]);
    // Third bottom in front: bottoms are visited from left to right along the cast-on.
    assert!(olds[0] > olds[2] && olds[2] > olds[1]);
}

#[test]
fn twisted_loops_cross_their_own_legs() {
    let mut stitches = fabric(1, 1, 0.004);
    stitches.set_stitch(FaceId(0), "k1".parse().unwrap()).unwrap();
    let net = lay(&stitches);
    check(&net);
    let crossings = net.nodes.iter().filter(|n| {
        n.visits.len() == 2 && {
            let [a, b] = [n.visits[0], n.visits[1]].map(|v| net.visits[v.index()].yarn);
            a == b
                && net.contacts.iter().all(|c| !c.new.contains(&n.visits[0]) && !c.new.contains(&n.visits[1]))
        }
    });
    // The crossing, and the two nodes at which the end is drawn through the last bind-off loop.
    assert_eq!(crossings.count(), 3);
}

/// Through the back loop the leg of the right foot crosses in front, knitted or purled; the other twist is its mirror image.
#[test]
fn through_the_back_loop_the_right_leg_is_in_front() {
    for (symbol, right_in_front) in [("k1", true), ("p1", true), ("k-1", false), ("p-1", false)] {
        let mut stitches = fabric(3, 3, 0.004);
        stitches.set_stitch(FaceId(4), symbol.parse().unwrap()).unwrap();
        let net = lay(&stitches);
        let crossing = net.nodes.iter().find(|n| n.kind == NodeKind::Crossing && n.face == Some(FaceId(4)));
        let crossing = crossing.unwrap();
        let place = |visit: usize| net.nodes[net.visits[visit].node.index()].position;
        let front = crossing.visits[0].index();
        // Of the two ways along the yarn one goes down to the foot, the other up through the top.
        let foot =
            [place(front - 1), place(front + 1)].into_iter().min_by(|a, b| a.y.total_cmp(&b.y)).unwrap();
        assert_eq!(foot.x > crossing.position.x, right_in_front, "{symbol}");
    }
}

proptest! {
    #[test]
    fn any_tessellation_and_any_stitches_make_a_sound_net(
        bottom in 1u32..7, top in 1u32..7, rows in 1u32..5, symbols in prop::collection::vec(0usize..4, 1..6),
    ) {
        let labelled = grid(2, 2);
        let mesh = labelled.mesh();
        let mut counts = vec![rows; mesh.edge_count()];
        for (r, row) in labelled.rows().iter().enumerate() {
            for w in row.faces.iter().filter_map(|f| labelled.wales(*f)) {
                labelled.bottoms(w).iter().for_each(|h| counts[mesh.edge(*h).index()] = if r == 0 { bottom } else { top });
                labelled.tops(w).iter().for_each(|h| counts[mesh.edge(*h).index()] = top);
            }
        }
        let mut stitches = tessellate(&labelled, &EdgeCounts { counts, marked: vec![] }).unwrap();
        for (i, face) in stitches.mesh().faces().enumerate() {
            let symbol = ["k", "p", "k1", "p-1"][symbols[i % symbols.len()]];
            let _ = stitches.set_stitch(face, symbol.parse().unwrap()); // only where it fits
        }
        check(&lay(&stitches));
    }
}
