//! Cables, slipped loops, spirals, live edges, seams and colours, laid.

use super::lay;
use super::tests::check;
use crate::cable::Cable;
use crate::dye::Dye;
use crate::edge_counts::{EdgeCounts, StitchSize};
use crate::grid::grid;
use crate::ids::{FaceId, VertexId, VisitId};
use crate::pieces::{rectangle, tube};
use crate::seam::Seam;
use crate::stitch_mesh::StitchMesh;
use crate::tessellate::tessellate;
use crate::unravel::loose_loops;
use crate::wrapping::Wrapping;
use crate::yarn_net::{NodeKind, YarnNet};

/// Every loop is held.
fn holds(stitches: &StitchMesh, net: &YarnNet) {
    assert_eq!(loose_loops(stitches, net), []);
}

/// Numbers of yarns with ends and of rings.
fn yarns(net: &YarnNet) -> (usize, usize) {
    let closed = net.yarns.iter().filter(|y| y.period.is_some()).count();
    (net.yarns.len() - closed, closed)
}

/// The course edges above the stitches `first..=last` of a row: vertices from left to right.
fn path_above(stitches: &StitchMesh, row: usize, first: usize, last: usize) -> Vec<VertexId> {
    let mesh = stitches.mesh();
    let tops: Vec<_> =
        stitches.rows()[row].faces[first..=last].iter().flat_map(|f| stitches.tops(*f)).collect();
    std::iter::once(mesh.tip(tops[0])).chain(tops.iter().map(|h| mesh.origin(*h))).collect()
}

#[test]
fn a_loop_without_a_holder_is_found() {
    let stitches = rectangle(4, 4, StitchSize::of_width(3e-3)).unwrap();
    let mut net = lay(&stitches);
    holds(&stitches, &net);
    let top = stitches.tops(FaceId(5)).next().unwrap();
    let head = net.loops.iter().find(|l| l.top == top).unwrap().head.clone();
    assert!(!head.is_empty());
    for visit in head {
        let node = net.visits[visit as usize].node;
        net.nodes[node.index()].kind = NodeKind::Crossing;
    }
    // The stitch to the right shares no node with it.
    assert_eq!(loose_loops(&stitches, &net), [top]);
}

#[test]
fn slipped_loops_are_held_further_up() {
    let mut stitches = rectangle(5, 6, StitchSize::of_width(3e-3)).unwrap();
    for (face, symbol) in [(7, "s"), (12, "s"), (16, "x"), (28, "s"), (20, "x")] {
        stitches.set_stitch(FaceId(face), symbol.parse().unwrap()).unwrap();
    }
    let net = lay(&stitches);
    check(&net);
    holds(&stitches, &net);
    assert_eq!(yarns(&net), (1, 0));
    // The loop below both slips has its head in the stitch above them.
    let top = stitches.tops(FaceId(2)).next().unwrap();
    let head = net.loops.iter().find(|l| l.top == top).unwrap().head.clone();
    let faces: Vec<_> =
        head.map(|v| net.nodes[net.visits[v as usize].node.index()].face.unwrap().0).collect();
    assert_eq!(faces, [7, 12, 17, 17, 17, 17, 12, 7]);
}

#[test]
fn a_slip_and_a_knit_in_one_loop() {
    let mut labelled = grid(1, 1);
    let mut counts = EdgeCounts::from_size(&labelled, StitchSize::of_width(0.01)).unwrap();
    let wales = labelled.wales(FaceId(0)).unwrap();
    counts.counts.iter_mut().for_each(|c| *c = 1);
    counts.counts[labelled.mesh().edge(labelled.tops(wales)[0]).index()] = 2;
    labelled.flip_row(FaceId(0)).unwrap();
    labelled.flip_row(FaceId(0)).unwrap();
    let mut stitches = tessellate(&labelled, &counts).unwrap();
    for symbol in ["sk", "ks", "xk", "pk1"] {
        stitches.set_stitch(FaceId(0), symbol.parse().unwrap()).unwrap();
        let net = lay(&stitches);
        check(&net);
        holds(&stitches, &net);
    }
}

#[test]
fn a_cable_crosses_leg_by_leg() {
    let mut stitches = rectangle(8, 6, StitchSize::of_width(3e-3)).unwrap();
    let plain = lay(&stitches);
    stitches.set_cable(Cable::cross(path_above(&stitches, 2, 2, 5), 2, 2, true)).unwrap();
    let net = lay(&stitches);
    check(&net);
    holds(&stitches, &net);
    assert_eq!(yarns(&net), (1, 0));
    let crossings: Vec<_> = net.nodes.iter().filter(|n| n.kind == NodeKind::Crossing).collect();
    assert_eq!(crossings.len(), 16);
    assert_eq!(net.nodes.len(), plain.nodes.len() + 16);
    // In front is always a leg of the right strand: made by stitch 4 or 5 of the row.
    let row = &stitches.rows()[2].faces;
    let strand = |face: FaceId| -> Vec<u32> {
        let top = stitches.tops(face).next().unwrap();
        net.loops.iter().find(|l| l.top == top).unwrap().head.clone().collect()
    };
    for node in crossings {
        assert!([row[4], row[5]].iter().any(|f| strand(*f).contains(&node.visits[0].0)));
        assert!([row[2], row[3]].iter().any(|f| strand(*f).contains(&node.visits[1].0)));
    }
    // The first loop of the left strand is held by the third stitch above.
    let held_in =
        strand(row[2]).iter().filter_map(|v| net.nodes[net.visits[*v as usize].node.index()].face).next();
    assert_eq!(held_in, Some(stitches.rows()[3].faces[4]));
    assert!(net.taken_in.iter().all(|t| t.length > 0.0));
}

#[test]
fn cables_up_to_eight_over_eight_and_plaits() {
    let mut stitches = rectangle(16, 12, StitchSize::of_width(3e-3)).unwrap();
    for (row, left, right) in [(1, 8, 8), (3, 1, 1), (5, 3, 5)] {
        let path = path_above(&stitches, row, 0, left as usize + right as usize - 1);
        stitches.set_cable(Cable::cross(path, left, right, false)).unwrap();
    }
    let three = Cable {
        path: path_above(&stitches, 8, 4, 8),
        strands: vec![2, 1, 2],
        order: vec![2, 1, 0],
        front: vec![2, 0, 1],
    };
    stitches.set_cable(three).unwrap();
    let net = lay(&stitches);
    check(&net);
    holds(&stitches, &net);
    assert_eq!(yarns(&net), (1, 0));
}

#[test]
fn cables_that_cannot_cross_say_why() {
    let mut stitches = rectangle(6, 3, StitchSize::of_width(3e-3)).unwrap();
    let path = path_above(&stitches, 0, 1, 4);
    let set = |stitches: &mut StitchMesh, cable: Cable| stitches.set_cable(cable).unwrap_err().to_string();
    let cross = |path: &[VertexId], n, m| Cable::cross(path.to_vec(), n, m, true);
    assert!(set(&mut stitches, cross(&path, 2, 1)).contains("3 loops, but the cable lies on 4"));
    assert!(set(&mut stitches, cross(&path, 4, 0)).contains("at least two strands"));
    let mut backwards = path.clone();
    backwards.reverse();
    assert!(set(&mut stitches, cross(&backwards, 2, 2)).contains("left to right"));
    let at_the_border = path_above(&stitches, 2, 0, 3);
    assert!(set(&mut stitches, cross(&at_the_border, 2, 2)).contains("between two rows"));
    let straight = Cable { order: vec![0, 1], ..cross(&path, 2, 2) };
    assert!(set(&mut stitches, straight).contains("nothing crosses"));
    let twice = Cable { front: vec![1, 1], ..cross(&path, 2, 2) };
    assert!(set(&mut stitches, twice).contains("front has to name"));
    let mut narrow = tube(3, 3, StitchSize::of_width(3e-3)).unwrap();
    let round: Vec<VertexId> = [3, 4, 5, 3, 4].map(VertexId).to_vec();
    assert!(set(&mut narrow, cross(&round, 2, 2)).contains("goes round the tube"));
    stitches.set_cable(cross(&path, 2, 2)).unwrap();
    assert!(set(&mut stitches, cross(&path, 2, 2)).contains("in a cable already"));
    assert_eq!(stitches.clear_cables(&[[path[1], path[0]]]), 1);
    stitches.set_cable(cross(&path, 2, 2)).unwrap();
}

#[test]
fn a_spiral_tube_is_one_yarn() {
    let mut stitches = tube(12, 5, StitchSize::of_width(3e-3)).unwrap();
    let rings = lay(&stitches);
    assert_eq!(yarns(&rings), (0, 7), "five rows, cast-on and bind-off");
    stitches.set_spiral(true);
    let spiral = lay(&stitches);
    check(&spiral);
    holds(&stitches, &spiral);
    assert_eq!(yarns(&spiral), (1, 0));
    // Nothing but the two tails and the end drawn through the last loop is longer than a step up of one row.
    let long = spiral.segments().filter(|s| {
        let [a, b] = s.ends.map(|v| spiral.nodes[spiral.visits[v.index()].node.index()].position);
        a.distance(b) > 5e-3
    });
    assert_eq!(long.count(), 0);
}

#[test]
fn live_loops_stay_open() {
    let mut stitches = rectangle(6, 4, StitchSize::of_width(3e-3)).unwrap();
    let top = path_above(&stitches, 3, 0, 5);
    for ends in top.windows(2) {
        stitches.set_live([ends[0], ends[1]], true).unwrap();
    }
    let net = lay(&stitches);
    check(&net);
    holds(&stitches, &net);
    assert_eq!(yarns(&net), (1, 0));
    assert!(net.nodes.iter().filter(|n| n.face.is_none()).all(|n| n.visits.len() == 1), "no bind-off");
    // Some live, the rest bound off.
    stitches.set_live([top[2], top[3]], false).unwrap();
    stitches.set_live([top[3], top[4]], false).unwrap();
    let net = lay(&stitches);
    check(&net);
    holds(&stitches, &net);
    let bottom = stitches.bottoms(FaceId(0)).next().unwrap();
    let ends = [stitches.mesh().origin(bottom), stitches.mesh().tip(bottom)];
    assert!(stitches.set_live(ends, true).is_err());
}

#[test]
fn seams_catch_every_edge_of_both_sides() {
    // A piece folded into a tube: its row ends are sewn together, six on one side to six on the other.
    let mut stitches = rectangle(8, 6, StitchSize::of_width(3e-3)).unwrap();
    let (v, last) = (|i: usize| VertexId::new(i), 8);
    let left: Vec<_> = (0..=6).map(|j| v(j * 9)).collect();
    let right: Vec<_> = (0..=6).map(|j| v(j * 9 + last)).collect();
    stitches.sew(Seam { a: left.clone(), b: right.clone() }).unwrap();
    let net = lay(&stitches);
    check(&net);
    holds(&stitches, &net);
    assert_eq!(yarns(&net), (2, 0), "the fabric and the sewing yarn");
    let sewn = |net: &YarnNet| {
        let catches = net.nodes.iter().filter(|n| {
            let yarns: Vec<_> = n.visits.iter().map(|v| net.visits[v.index()].yarn).collect();
            n.kind == NodeKind::Seam && yarns.len() == 2 && yarns[0] != yarns[1]
        });
        catches.count()
    };
    assert_eq!(sewn(&net), 12);
    // Different numbers of stitches: a bound-off edge to row ends.
    let again = stitches.sew(Seam { a: left.clone(), b: right });
    assert!(again.unwrap_err().to_string().contains("sewn twice"));
    assert_eq!(stitches.unsew(&[[left[1], left[0]]]), 1);
    let top: Vec<_> = (0..=8).map(|i| v(6 * 9 + i)).collect();
    stitches.sew(Seam { a: left, b: top }).unwrap();
    let net = lay(&stitches);
    check(&net);
    assert_eq!(sewn(&net), 6 + 8);
    let inner = stitches.sew(Seam { a: vec![v(10), v(11)], b: vec![v(0), v(1)] });
    assert!(inner.unwrap_err().to_string().contains("not an edge of the border"));
}

#[test]
fn a_pulled_seam_has_room_for_both_borders() {
    let width = 3e-3;
    let mut stitches = rectangle(8, 6, StitchSize::of_width(width)).unwrap();
    let v = |i: usize| VertexId::new(i);
    let left: Vec<_> = (0..=6).map(|j| v(j * 9)).collect();
    let right: Vec<_> = (0..=6).map(|j| v(j * 9 + 8)).collect();
    let top: Vec<_> = (0..=8).map(|i| v(6 * 9 + i)).collect();
    // How long the segments that are taken in are in the end.
    let pulled = |stitches: &StitchMesh| -> Vec<f64> {
        let net = lay(stitches);
        let laid = |v: VisitId| net.visits[net.next(v).unwrap().index()].u - net.visits[v.index()].u;
        net.taken_in.iter().map(|t| (laid(t.segment) - t.length) / width).collect()
    };
    stitches.sew(Seam { a: left.clone(), b: right }).unwrap();
    // To and fro between the edges of one row, and on to the next: a quarter of a stitch on either side, and yarn between.
    let across = 0.5 + 0.33 * 0.75_f64.sqrt();
    for (i, length) in pulled(&stitches).into_iter().enumerate() {
        let along = if i % 2 == 0 { 0.0 } else { 0.75 };
        assert!((length - across.hypot(along)).abs() < 1e-6, "{i}: {length}");
    }
    // Of 6 + 8 edges some that follow each other are on one side. From one to the next the yarn stays as it lies.
    stitches.unsew(&[[left[1], left[0]]]);
    stitches.sew(Seam { a: left, b: top }).unwrap();
    let lengths = pulled(&stitches);
    assert!(lengths.len() < 6 + 8 - 1 && lengths.iter().all(|l| (0.6..1.4).contains(l)), "{lengths:?}");
}

#[test]
fn yarn_has_the_colour_it_was_worked_with() {
    let mut stitches = rectangle(4, 4, StitchSize::of_width(3e-3)).unwrap();
    let red = Dye([200, 30, 30]);
    stitches.set_dye(FaceId(5), red).unwrap();
    let net = lay(&stitches);
    // The stitch's own yarn is red: at its nodes one of two visits. Its loop is red up in the stitch above as well.
    let reds = |face: u32| {
        let nodes = net.nodes.iter().filter(|n| n.face == Some(FaceId(face)));
        nodes.flat_map(|n| &n.visits).filter(|v| net.visits[v.index()].dye == red).count()
    };
    assert_eq!((reds(5), reds(9), reds(1), reds(4), reds(6)), (4, 4, 0, 0, 0));
}

#[test]
fn contacts_are_wrapped_as_their_stitch() {
    let mut stitches = rectangle(4, 4, StitchSize::of_width(3e-3)).unwrap();
    let (tight, slack) =
        (Wrapping { modulus: 2.0, angle: Some(1.0) }, Wrapping { modulus: 0.5, angle: None });
    stitches.set_wrapping(FaceId(5), tight).unwrap();
    stitches.set_wrapping(FaceId(13), slack).unwrap();
    let net = lay(&stitches);
    let faces = |wrapping: Wrapping| -> Vec<_> {
        let contacts = net.contacts.iter().filter(|c| c.wrapping == wrapping);
        contacts.map(|c| net.nodes[net.visits[c.new[0].index()].node.index()].face).collect()
    };
    assert_eq!(faces(tight), [Some(FaceId(5)); 2]);
    // Above a stitch of the last row its bind-off is wrapped as it is.
    assert_eq!(faces(slack), [Some(FaceId(13)), Some(FaceId(13)), None, None]);
    let bad = stitches.set_wrapping(FaceId(5), Wrapping { modulus: -1.0, angle: None });
    assert!(bad.is_err() && stitches.set_wrapping(FaceId(16), tight).is_err());
    assert_eq!(stitches.wrappings()[5], tight);
}
