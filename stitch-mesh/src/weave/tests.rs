use super::*;
use crate::dye::Dye;
use crate::ids::VisitId;
use crate::yarn_net::{NodeKind, YarnNet};

fn piece(draft: &str, ends: usize, picks: usize) -> Woven {
    Woven {
        draft: draft.parse().unwrap(),
        ends,
        picks,
        spacing: 2e-3,
        warp: Dye([1, 2, 3]).into(),
        weft: Dye([4, 5, 6]).into(),
        middle: DVec3::new(0.1, 0.2, 0.3),
        flat: false,
    }
}

/// Whether a visit lies in front at its node.
fn in_front(net: &YarnNet, visit: u32) -> bool {
    net.nodes[net.visits[visit as usize].node.index()].visits[0] == VisitId(visit)
}

/// How often each yarn changes sides, and the most crossings that it stays on one: `[changes, longest float]`.
fn run(net: &YarnNet, yarn: usize) -> [usize; 2] {
    let visits = net.yarns[yarn].visits.clone();
    let sides: Vec<bool> = (visits.start + 1..visits.end - 1).map(|v| in_front(net, v)).collect();
    let floats = sides.chunk_by(|a, b| a == b);
    [floats.clone().count() - 1, floats.map(<[bool]>::len).max().unwrap()]
}

#[test]
fn drafts_are_read_and_written() {
    let text = "// a basket\n\n 11 00 // the third pick\n##..\n. . # #\n..##\n";
    let draft: WeaveDraft = text.parse().unwrap();
    assert_eq!(draft.repeat(), [4, 4]);
    assert_eq!(draft.to_string(), "##..\n##..\n..##\n..##");
    assert_eq!(draft.to_string().parse(), Ok(draft.clone()));
    assert_eq!((draft.at(0, 0), draft.at(0, 2), draft.at(5, 7)), (Cell::Weft, Cell::Warp, Cell::Warp));
    for (name, text) in WeaveDraft::NAMED {
        assert_eq!(name.parse::<WeaveDraft>().unwrap().to_string(), text);
    }
}

#[test]
fn what_is_no_draft_says_where() {
    let error = |text: &str| text.parse::<WeaveDraft>().unwrap_err().to_string();
    assert!(error("// nothing\n\n").contains("no picks"));
    assert!(error("#.\n.x").starts_with("line 2, column 2: 'x' is neither"));
    assert!(error("#.#\n\n.# // short").starts_with("line 3, column 3: this pick crosses 2 ends"));
    assert!(error("#.\n. #.").starts_with("line 2, column 4: this pick crosses 3 ends"));
    assert_eq!(
        error("#.\n##").as_str(),
        "line 2, column 1: this pick lies behind all ends, so nothing would hold it"
    );
    assert_eq!(
        error("// ends\n #.\n#.\n#.").as_str(),
        "line 2, column 2: this end lies in front of all picks, so nothing would hold it"
    );
    assert!(error(&"#.".repeat(501)).starts_with("line 1, column 1001"));
    assert!(error(&"#.\n.#\n".repeat(501)).starts_with("line 1001, column 1"));
}

#[test]
fn pieces_that_cannot_be_woven_are_named() {
    let error = |change: &dyn Fn(&mut Woven)| {
        let mut piece = piece("plain", 4, 4);
        change(&mut piece);
        piece.check().unwrap_err()
    };
    assert_eq!(error(&|p| p.ends = 1), WovenError::Count(1, "ends"));
    assert_eq!(error(&|p| p.picks = 9999), WovenError::Count(9999, "picks"));
    assert!(matches!(error(&|p| p.spacing = f64::NAN), WovenError::Spacing(_)));
    assert_eq!(error(&|p| p.middle.y = f64::INFINITY), WovenError::Place);
    assert_eq!(piece("twill", 8, 8).check(), Ok(()));
}

#[test]
fn every_crossing_has_one_end_and_one_pick() {
    for draft in ["plain", "twill", "satin"] {
        let net = piece(draft, 10, 20).lay();
        assert_eq!((net.yarns.len(), net.nodes.len()), (30, 200 + 60));
        for (i, node) in net.nodes.iter().enumerate() {
            let mut yarns: Vec<usize> =
                node.visits.iter().map(|v| net.visits[v.index()].yarn.index()).collect();
            yarns.sort_unstable();
            match node.kind {
                NodeKind::Woven => assert_eq!(yarns, [i % 10, 10 + i / 10]),
                _ => assert_eq!(yarns.len(), 1),
            }
            assert!(node.visits.iter().all(|v| net.visits[v.index()].node.index() == i));
        }
    }
}

#[test]
fn yarns_float_as_the_weave_has_it() {
    for (draft, float, changes) in [("plain", 1, 19), ("twill", 2, 9), ("satin", 4, 7)] {
        let net = piece(draft, 20, 20).lay();
        for yarn in 0..40 {
            let [changed, longest] = run(&net, yarn);
            assert_eq!(longest, float, "{draft}");
            assert!(changed.abs_diff(changes) <= 1, "{draft}: {changed}");
        }
    }
}

#[test]
fn yarn_that_changes_sides_is_longer_than_its_way() {
    let woven = piece("satin", 5, 10);
    let net = woven.lay();
    for segment in net.segments() {
        let [a, b] = segment.ends.map(|v| net.visits[v.index()]);
        let [p, q] = [a, b].map(|v| &net.nodes[v.node.index()]);
        let apart = p.position.distance(q.position);
        let rest = b.u - a.u;
        if p.kind == NodeKind::Woven && q.kind == NodeKind::Woven {
            let climbs = in_front(&net, segment.ends[0].0) != in_front(&net, segment.ends[1].0);
            let expected = if climbs { apart.hypot(2.0 * woven.radius()) } else { apart };
            assert!((rest - expected).abs() < 1e-12);
        } else {
            assert!((rest - apart).abs() < 1e-12);
        }
    }
}

#[test]
fn a_piece_lies_where_it_is_put() {
    let standing = piece("plain", 4, 6);
    let lying = Woven { flat: true, ..standing.clone() };
    for woven in [standing, lying] {
        let net = woven.lay();
        let middle = net.nodes.iter().map(|n| n.position).sum::<DVec3>() / net.nodes.len() as f64;
        assert!(middle.distance(woven.middle) < 1e-12);
        let [a, b, c, d] = woven.corners();
        let front = (b - a).cross(d - a);
        assert!((c - b).distance(d - a) < 1e-12);
        assert!((front.length() - 8e-3 * 12e-3).abs() < 1e-12);
        assert!(net.nodes.iter().all(|n| n.normal.dot(front) > 0.0));
        assert_eq!(net.nodes[0].normal, if woven.flat { DVec3::Y } else { DVec3::Z });
    }
}

#[test]
fn stripes_of_warp_and_weft_make_checks() {
    let [red, black] = [[0xc0, 0x40, 0x30], [0x30, 0x30, 0x34]].map(Dye);
    let (warp, weft) = ("#c04030*2,#303034".parse().unwrap(), black.into());
    let cloth = Woven { warp, weft, ..piece("plain", 4, 2) };
    let net = cloth.lay();
    for (yarn, dye) in net.yarns.iter().zip([red, red, black, red, black, black]) {
        assert!(yarn.visits.clone().all(|v| net.visits[v as usize].dye == dye));
    }
}
