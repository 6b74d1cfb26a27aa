//! Hem and collar of a garment (Cirio et al., Fig. 7): in stockinette they roll up to the outside, in garter they do not.

#![allow(clippy::unwrap_used, clippy::panic, reason = "helpers of tests are tests, which clippy cannot see")]

use app::bundled::find;
use app::command::Command;
use app::fabric::Fabric;
use app::project::Project;
use glam::{DVec2, DVec3};
use sim_core::{Scene, Simulator};
use stitch_mesh::ids::FaceId;

/// By how much the outermost two rows of stitches are turned to the outside against the two rows behind them [°]: the mean over
/// the columns that begin on `edge` and are followed inwards by `next`, `along` the axis of the garment. (Single rows of
/// garter stand out in turn.)
fn turn(
    fabric: &Fabric,
    simulator: &Simulator,
    (edge, along): (&[FaceId], DVec3),
    next: impl Fn(FaceId) -> Option<FaceId>,
) -> f64 {
    let mesh = fabric.stitches.mesh();
    let mut middles = vec![(DVec3::ZERO, 0.0); mesh.face_count()];
    for (node, x) in simulator.net().nodes.iter().zip(&simulator.state().position) {
        if let Some(face) = node.face {
            let (sum, count) = &mut middles[face.index()];
            (*sum, *count) = (*sum + *x, *count + 1.0);
        }
    }
    let middle = |f: FaceId| middles[f.index()].0 / middles[f.index()].1;
    let turned = |first: &FaceId| {
        let column: Vec<DVec3> =
            std::iter::successors(Some(*first), |f| next(*f)).take(5).map(middle).collect();
        let [a, _, b, _, c] = column[..] else { panic!("the edge is too near to another") };
        let outwards = a.with_y(0.0).normalize();
        let direction = |v: DVec3| DVec2::new(v.dot(along), v.dot(outwards));
        direction(b - c).angle_to(direction(a - b)).to_degrees()
    };
    edge.iter().map(turned).sum::<f64>() / edge.len() as f64
}

/// How far hem and collar of the slipover turn in half a second on its bust [°].
fn hem_and_collar(project: &Project) -> [f64; 2] {
    let fabric = project.fabric().unwrap();
    // Gravity is to wrapping as the width of a loop: in this one loops weigh what those of 6 mm do.
    let gravity = project.scene.gravity * (6e-3 / project.size.width);
    let scene = Scene { gravity, ..project.scene.clone() };
    let state = (*fabric.state()).clone();
    let mut simulator = Simulator::new(fabric.net(), project.materials.clone(), scene, state).unwrap();
    let rows = fabric.stitches.rows();
    let turns = |simulator: &Simulator| {
        let stitches = &fabric.stitches;
        let (first, last) = (&rows[0].faces, &rows[rows.len() - 1].faces);
        let hem = turn(fabric, simulator, (first, DVec3::NEG_Y), |f| stitches.above(f).next());
        [hem, turn(fabric, simulator, (last, DVec3::Y), |f| stitches.below(f).next())]
    };
    let laid = turns(&simulator);
    while simulator.time_s() < 0.5 {
        simulator.step().unwrap();
    }
    let facts = simulator.facts();
    let worn = turns(&simulator);
    assert!(facts.max_stretch < 0.02 && facts.max_penetration_mm < 3.0);
    [worn[0] - laid[0], worn[1] - laid[1]]
}

#[test]
fn hem_and_collar_of_stockinette_roll_to_the_outside_and_those_of_garter_do_not() {
    let stockinette = find("slipover").unwrap().of_loops(1_200).unwrap();
    let garter = Command::SetChart { chart: vec!["k".into(), "p".into()], rows: None, faces: None };
    let garter = garter.apply(&stockinette).unwrap();
    let [hem, collar] = hem_and_collar(&stockinette);
    let [flat_hem, flat_collar] = hem_and_collar(&garter);
    assert!(hem > 30.0 && collar > 6.0, "stockinette {hem:.1}° {collar:.1}°");
    assert!(flat_hem.abs() < 10.0 && flat_collar.abs() < 4.0, "garter {flat_hem:.1}° {flat_collar:.1}°");
}
