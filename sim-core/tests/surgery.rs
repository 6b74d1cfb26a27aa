//! Yarn that is cut, pulled out and runs.

#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "helpers of tests are tests, and clippy can't tell"
)]

mod common;

use common::{WIDTH, run, stockinette, swatch};
use glam::DVec3;
use sim_core::{Material, Operation, Pin, Scene, Simulator};
use std::sync::Arc;
use stitch_mesh::ids::VisitId;
use stitch_mesh::yarn_net::YarnNet;

fn slippery(net: &Arc<YarnNet>, friction: f64) -> Simulator {
    let material = Material { friction, ..Material::for_loop_width(WIDTH) };
    Simulator::new(net, material, Scene::empty(), net.laid_state()).unwrap()
}

/// Column and row of the stitch that a node lies in.
fn place(net: &YarnNet, node: usize, wide: usize) -> Option<(usize, usize)> {
    net.nodes[node].face.map(|f| (f.index() % wide, f.index() / wide))
}

/// Pins where the nodes are on all stitches that are `chosen` by column and row.
fn pins(simulator: &Simulator, wide: usize, chosen: impl Fn(usize, usize) -> bool) -> Vec<Pin> {
    let held = |(node, target): (usize, &DVec3)| {
        let (column, row) = place(simulator.net(), node, wide)?;
        chosen(column, row).then_some(Pin { node: node as u32, target: *target, stiffness: 5.0 })
    };
    simulator.state().position.iter().enumerate().filter_map(held).collect()
}

/// Moves every pin by what `velocity` says of its stitch, while the simulation runs until `end`, or `done`.
fn pull(
    simulator: &mut Simulator,
    end: f64,
    velocity: impl Fn(&YarnNet, &Pin) -> DVec3,
    done: impl Fn(&Simulator) -> bool,
) {
    while simulator.time_s() < end && !done(simulator) {
        let step = simulator.step().unwrap().time_step;
        let mut scene = simulator.scene().clone();
        for pin in &mut scene.pins {
            pin.target += step * velocity(simulator.net(), pin);
        }
        simulator.set_scene(scene).unwrap();
    }
}

/// Length of unstretched yarn of each yarn.
fn lengths(simulator: &Simulator) -> Vec<f64> {
    let (net, u) = (simulator.net(), &simulator.state().sliding);
    let of = |y: &stitch_mesh::yarn_net::Yarn| u[y.visits.end as usize - 1] - u[y.visits.start as usize];
    net.yarns.iter().map(of).collect()
}

#[test]
fn a_row_can_be_pulled_out_of_the_fabric() {
    let (side, row) = (6, 3);
    let net = swatch(side, side, |_, t| t % 2 == 1);
    let mut simulator = slippery(&net, 0.1);
    run(&mut simulator, 0.1);
    let in_row =
        |v: &VisitId| place(&net, net.visits[v.index()].node.index(), side).is_some_and(|(_, r)| r == row);
    let of_row: Vec<VisitId> = net.contacts.iter().flat_map(|c| c.new).filter(in_row).collect();
    let (first, last) = (of_row.iter().min().unwrap(), of_row.iter().max().unwrap());
    // The later cut first: it leaves the ids before it as they are.
    simulator.operate(Operation::Cut(*last)).unwrap();
    simulator.operate(Operation::Cut(VisitId(first.0 - 1))).unwrap();
    let pulled = 1;
    let end = simulator.net().yarns[pulled].visits.end - 1;
    let end = simulator.net().visits[end as usize].node;
    let at = simulator.state().position[end.index()];
    let outwards = DVec3::new(at.x.signum() * 0.2, 0.0, 0.0);
    let at_side = |i: usize| i.is_multiple_of(side - 1);
    let border = |c: usize, r: usize| r != row && (at_side(c) || at_side(r));
    let mut held = pins(&simulator, side, border);
    held.push(Pin { node: end.0, target: at, stiffness: 5.0 });
    simulator.set_scene(Scene { pins: held, ..Scene::empty() }).unwrap();

    let (contacts, before) = (simulator.net().contacts.len(), lengths(&simulator));
    let ends = |s: &Simulator| s.net().yarns[pulled].visits.len() == 2;
    let move_end = |net: &YarnNet, pin: &Pin| {
        let border = place(net, pin.node as usize, side).is_some();
        if border { DVec3::ZERO } else { outwards }
    };
    pull(&mut simulator, 1.5, move_end, ends);
    let released = contacts - simulator.net().contacts.len();
    println!("{released} of {contacts} contacts released, {:?}", simulator.facts());
    assert!(ends(&simulator), "nothing but its two ends is left of the row's way through the fabric");
    // Its own contacts with the row below and those of the row above with it, and perhaps a loop at the side that ran.
    assert!((4 * side..=4 * side + 4).contains(&released));
    for (before, after) in before.iter().zip(lengths(&simulator)) {
        assert!((before - after).abs() < 1e-9 * before, "yarn slides, it is neither made nor lost");
    }
}

#[test]
fn a_dropped_stitch_runs_when_the_fabric_is_stretched() {
    let (wide, high) = (9, 12);
    let net = stockinette(wide, high);
    let column = wide / 2;
    // Two contacts a stitch: at least five ladders. When it starts to run is a matter of chance.
    let ran = |s: &Simulator| s.net().contacts.len() + 10 <= net.contacts.len();
    let stretched = |dropped: bool| {
        let mut simulator = slippery(&net, 0.01);
        let sides = pins(&simulator, wide, |c, _| c % (wide - 1) == 0);
        simulator.set_scene(Scene { pins: sides, ..Scene::empty() }).unwrap();
        run(&mut simulator, 0.1);
        if dropped {
            let in_top =
                |v: u32| place(&net, net.visits[v as usize].node.index(), wide) == Some((column, high - 2));
            let top = net.loops.iter().find(|l| l.head.clone().any(in_top)).unwrap();
            let head = top.head.clone().map(VisitId).collect();
            simulator.operate(Operation::Release(head)).unwrap();
        }
        let apart = |net: &YarnNet, pin: &Pin| {
            let (c, _) = place(net, pin.node as usize, wide).unwrap();
            DVec3::new(if c == 0 { -0.02 } else { 0.02 }, 0.0, 0.0)
        };
        pull(&mut simulator, 1.5, apart, ran);
        println!(
            "{} contacts of {}, {:?}",
            simulator.net().contacts.len(),
            net.contacts.len(),
            simulator.facts()
        );
        simulator
    };
    let whole = stretched(false);
    assert_eq!(whole.net().contacts.len(), net.contacts.len(), "a whole fabric does not run");
    assert!(ran(&stretched(true)));
}
