use super::*;
use crate::testing::swatch_model;
use crate::{Material, Scene, Simulator};
use stitch_mesh::edge_counts::StitchSize;
use stitch_mesh::lay::lay;
use stitch_mesh::pieces::tube;
use stitch_mesh::yarn_net::NodeKind;

/// Everything in the net refers to something that is there, and back.
fn check(net: &YarnNet, state: &YarnState) {
    assert!(state.fits(net) && state.is_finite());
    for (i, node) in net.nodes.iter().enumerate() {
        assert!(!node.visits.is_empty(), "bare node {i}");
        for visit in &node.visits {
            assert_eq!(net.visits[visit.index()].node, NodeId::new(i));
        }
    }
    let mut next = 0;
    for (y, yarn) in net.yarns.iter().enumerate() {
        assert_eq!(yarn.visits.start, next);
        assert!(yarn.visits.len() > 1);
        next = yarn.visits.end;
        assert!(yarn.visits.clone().all(|v| net.visits[v as usize].yarn == YarnId::new(y)));
    }
    assert_eq!(next as usize, net.visits.len());
    for (v, visit) in net.visits.iter().enumerate() {
        assert!(net.nodes[visit.node.index()].visits.contains(&VisitId::new(v)));
    }
    let model = crate::Model::new(Arc::new(net.clone())).unwrap();
    for s in &model.segments {
        let q: [f64; 8] = s.stencil.coordinates(state);
        assert!(q[7] > q[3], "no yarn on a segment");
    }
    assert!(net.loops.iter().all(|l| l.head.end as usize <= net.visits.len()));
}

/// Unstretched yarn in a state.
fn yarn_length(net: &YarnNet, state: &YarnState) -> f64 {
    net.segments().map(|s| state.sliding[s.ends[1].index()] + s.wrap - state.sliding[s.ends[0].index()]).sum()
}

#[test]
fn a_cut_makes_two_yarns_of_an_open_one() {
    let net = swatch_model(5, 5).net;
    let state = net.laid_state();
    for v in [0, 7, 40, net.yarns[0].visits.end - 2] {
        let done = operate(&net, &state, &Operation::Cut(VisitId(v))).unwrap();
        check(&done.net, &done.state);
        assert_eq!(done.net.yarns.len(), net.yarns.len() + 1);
        let segment = net.visits[v as usize + 1].u - net.visits[v as usize].u;
        let lost = yarn_length(&net, &state) - yarn_length(&done.net, &done.state);
        assert!((lost - KERF * segment).abs() < 1e-12);
        assert_eq!(done.net.nodes.iter().filter(|n| n.kind == NodeKind::Loose).count(), 2);
    }
    let end = VisitId(net.yarns[0].visits.end - 1);
    assert_eq!(operate(&net, &state, &Operation::Cut(end)).unwrap_err(), SurgeryError::YarnEnd(end));
    assert!(operate(&net, &state, &Operation::Cut(VisitId(1 << 20))).is_err());
}

#[test]
fn a_loop_is_unheld_when_it_is_dropped_and_no_loop_when_it_is_cut() {
    let net = swatch_model(5, 5).net;
    let state = net.laid_state();
    assert_eq!(slip::unheld(&net).count(), 0);
    let held = net.loops.iter().find(|l| l.head.len() == 4).unwrap();
    let cut = operate(&net, &state, &Operation::Cut(VisitId(held.head.start + 1))).unwrap();
    assert_eq!(slip::unheld(&cut.net).count(), 0);
    let dropped = Operation::Release(held.head.clone().map(VisitId).collect());
    let dropped = operate(&net, &state, &dropped).unwrap();
    let around: Vec<[VisitId; 2]> = slip::unheld(&dropped.net).collect();
    assert_eq!(around, [[VisitId(held.head.start - 1), VisitId(held.head.start)]]);
}

#[test]
fn a_cut_opens_a_closed_yarn_wherever_it_is() {
    let net = lay(&tube(6, 4, StitchSize::of_width(3e-3)).unwrap());
    let state = net.laid_state();
    let ring = net.yarns.iter().position(|y| y.period.is_some()).unwrap();
    let visits = net.yarns[ring].visits.clone();
    for v in [visits.start, visits.start + 9, visits.end - 1] {
        let done = operate(&net, &state, &Operation::Cut(VisitId(v))).unwrap();
        check(&done.net, &done.state);
        assert_eq!(done.net.yarns.len(), net.yarns.len());
        assert_eq!(done.net.yarns[ring].period, None);
        let lost = yarn_length(&net, &state) - yarn_length(&done.net, &done.state);
        assert!(lost > 0.0 && lost < 1e-3);
    }
}

#[test]
fn what_is_released_leaves_its_node_to_the_other_yarn() {
    let net = swatch_model(5, 5).net;
    let state = net.laid_state();
    let contact = &net.contacts[net.contacts.len() / 2];
    let visit = contact.new[0];
    let done = operate(&net, &state, &Operation::Release(vec![visit])).unwrap();
    check(&done.net, &done.state);
    assert_eq!(done.net.nodes.len(), net.nodes.len());
    assert_eq!(done.net.visits.len(), net.visits.len() - 1);
    assert_eq!(done.net.contacts.len(), net.contacts.len() - 1);
    assert!((yarn_length(&net, &state) - yarn_length(&done.net, &done.state)).abs() < 1e-12);
    let node = done.node[net.visits[visit.index()].node.index()].unwrap();
    assert_eq!(done.net.nodes[node.index()].kind, NodeKind::Loose);
}

#[test]
fn surgery_is_done_again_on_the_laid_net() {
    let net = swatch_model(6, 6).net;
    let material = Material::for_loop_width(3e-3);
    let mut simulator = Simulator::new(&net, material, Scene::empty(), net.laid_state()).unwrap();
    simulator.operate(Operation::Cut(VisitId(60))).unwrap();
    for _ in 0..10 {
        simulator.step().unwrap();
    }
    simulator.operate(Operation::Cut(VisitId(20))).unwrap();
    let (again, nodes) = simulator.surgery().replay(&net).unwrap();
    assert!(nodes.iter().all(Option::is_some), "a cut takes no node away");
    assert_eq!(again.nodes.len(), simulator.net().nodes.len());
    assert_eq!(again.yarns.len(), simulator.net().yarns.len());
    check(&again, simulator.state());
}
