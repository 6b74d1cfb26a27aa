//! Stitches that are wrapped otherwise than their material has it.

mod common;

use common::{WIDTH, free, mean_position, run, stockinette};
use sim_core::{Material, Materials, Model, Scene, Simulator};
use std::sync::Arc;
use stitch_mesh::ids::FaceId;
use stitch_mesh::wrapping::Wrapping;
use stitch_mesh::yarn_net::{StitchContact, YarnNet};

/// Stockinette with other wrapping in the stitches (by column) that are chosen.
fn wrapped(wide: usize, high: usize, wrapping: Wrapping, chosen: impl Fn(usize) -> bool) -> Arc<YarnNet> {
    let mut net = (*stockinette(wide, high)).clone();
    let (nodes, visits) = (net.nodes.clone(), net.visits.clone());
    let face = |c: &StitchContact| nodes[visits[c.new[0].index()].node.index()].face;
    for contact in &mut net.contacts {
        if face(contact).is_some_and(|f: FaceId| chosen(f.index() % wide)) {
            contact.wrapping = wrapping;
        }
    }
    Arc::new(net)
}

/// The same with all contacts, those of the bind-off too.
fn all_wrapped(wrapping: Wrapping) -> Arc<YarnNet> {
    let mut net = (*stockinette(6, 6)).clone();
    net.contacts.iter_mut().for_each(|c| c.wrapping = wrapping);
    Arc::new(net)
}

#[test]
fn stitches_that_all_differ_from_their_material_do_what_another_material_does() {
    let wool = Material::for_loop_width(WIDTH);
    let after = |net: &Arc<YarnNet>, material: Material| {
        let mut simulator = Simulator::new(net, material, Scene::empty(), net.laid_state()).unwrap();
        run(&mut simulator, 0.05);
        simulator.state().clone()
    };
    let plain = all_wrapped(Wrapping::OF_MATERIAL);
    let other = all_wrapped(Wrapping { modulus: 0.5, angle: Some(0.7) });
    let soft = Material { wrap_stiffness: 0.5 * wool.wrap_stiffness, wrap_angle: 0.7, ..wool.clone() };
    let same = after(&other, wool.clone());
    assert_eq!(same, after(&plain, soft));
    assert_ne!(same, after(&plain, wool.clone()));
    // An angle of its own stays what it is when the material becomes another, and the factor goes along.
    let turned = Material { wrap_stiffness: 2.0 * wool.wrap_stiffness, wrap_angle: 2.0, ..wool.clone() };
    assert_eq!(after(&other, turned), after(&plain, Material { wrap_angle: 0.7, ..wool }));
}

#[test]
fn energy_of_wrapping_is_the_sum_of_what_stitches_have_in_proportion_to_their_moduli() {
    let materials = Materials::from(Material::for_loop_width(WIDTH));
    let energy = |net: Arc<YarnNet>| {
        let state = net.laid_state();
        Model::new(net).unwrap().energies(&materials, &state)
    };
    let times = |modulus: f64| Wrapping { modulus, angle: None };
    let part = |modulus: f64| energy(wrapped(6, 6, times(modulus), |column| column < 2));
    let (none, one, three) = (part(0.0), part(1.0), part(3.0));
    assert!(one.wrap > 0.0 && none.wrap > 0.3 * one.wrap && none.wrap < 0.9 * one.wrap);
    let expected = none.wrap + 3.0 * (one.wrap - none.wrap);
    assert!((three.wrap / expected - 1.0).abs() < 1e-12, "{} {expected}", three.wrap);
    assert_eq!(energy(all_wrapped(times(0.0))).wrap, 0.0);
    assert_eq!([none.stretch, none.bend, none.spacing], [three.stretch, three.bend, three.spacing]);
}

/// Without the wrapping of its right half stockinette rolls its left side, and the right one lies flat.
#[test]
fn stockinette_curls_where_its_stitches_are_wrapped() {
    let (wide, high) = (24, 24);
    // By how much the outermost columns are turned against those behind them, half way up the left and the right side [°].
    let turns = |net: Arc<YarnNet>| {
        let mut simulator = free(&net);
        run(&mut simulator, 0.2);
        assert!(simulator.facts().max_stretch < 0.02);
        [[0, 3, 6], [wide - 1, wide - 4, wide - 7]].map(|columns| {
            let [outer, middle, inner] = columns.map(|column| {
                mean_position(&net, simulator.state(), |f| {
                    f % wide == column && (8..16).contains(&(f / wide))
                })
            });
            (outer - middle).angle_between(middle - inner).to_degrees()
        })
    };
    let slack = Wrapping { modulus: 0.0, angle: None };
    let [left, right] = turns(stockinette(wide, high));
    let [still, flat] = turns(wrapped(wide, high, slack, |column| column >= wide / 2));
    println!("left {left:.1} right {right:.1}, right half slack: left {still:.1} right {flat:.1}");
    assert!(left > 20.0 && right > 20.0 && still > 20.0);
    assert!(flat < 5.0);
}
