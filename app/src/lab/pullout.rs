//! Pull-out (Cirio et al., Fig. 13): a row's yarn is drawn out of garter stitch by its end, contact by contact, and the rows
//! beside it come apart.
//!
//! The borders are held except at the row, whose yarn is cut loose at both sides. With the friction of wool the yarn locks, as
//! wrapped ropes do: every contact multiplies the tension, and what is pulled is the fabric. So the yarn is a slippery one.

use super::bench::Bench;
use super::report::{Line, Picture, Plot, Table};
use super::specimen::Specimen;
use anyhow::{Context, Result};
use glam::DVec3;
use render::NamedView;
use sim_core::{Operation, Pin, Scene, Simulator};
use stitch_mesh::ids::{FaceId, VisitId, YarnId};
use stitch_mesh::yarn_net::NodeKind;

/// Stitches and rows.
const SIZE: [usize; 2] = [10, 10];
/// The row that is pulled.
const ROW: usize = 5;
/// Coefficient of friction.
const FRICTION: f64 = 0.1;
/// Time to relax before [s].
const RELAXING: f64 = 0.3;
/// Speed at which the end is pulled [m/s], how far at most [m], and how stiffly [N/m].
const SPEED: f64 = 0.15;
const FARTHEST: f64 = 0.3;
const STIFFNESS: f64 = 20.0;
/// Stiffness of what holds the borders [N/m].
const HOLD: f64 = 10.0;
/// Share of the contacts that are gone in the second picture.
const HALFWAY: f64 = 0.5;

/// Cuts the row loose and pulls.
pub fn run(bench: &mut Bench) -> Result<()> {
    bench.plan(RELAXING + FARTHEST / SPEED);
    let mut specimen = Specimen::rectangle(SIZE[0], SIZE[1], |_, t| t % 2 == 1)?;
    specimen.materials.base.friction = FRICTION;
    let mut simulator = specimen.simulate(Scene::empty())?;
    bench.run(&mut simulator, RELAXING)?;
    let yarn = cut_loose(&specimen, &mut simulator)?;
    let (start, outwards) = hold(&specimen, &mut simulator, yarn)?;
    let picture =
        |name, simulator: &Simulator| -> Picture { specimen.picture(name, NamedView::Front, simulator) };
    let before = contacts(&simulator, yarn);
    let mut pictures = vec![picture("cut", &simulator)];
    let mut rows = Vec::new();
    let mut pulled = 0.0;
    let mut left = before;
    while left > 0 && pulled < FARTHEST {
        let step = bench.step(&mut simulator)?.time_step;
        pulled += SPEED * step;
        let mut scene = simulator.scene().clone();
        let end = scene.pins.last_mut().context("the end of the row is not held")?;
        end.target = start + pulled * outwards;
        let force = end.stiffness * end.target.distance(simulator.state().position[end.node as usize]);
        simulator.set_scene(scene)?;
        left = contacts(&simulator, yarn);
        rows.push(vec![1e3 * pulled, force, left as f64]);
        if pictures.len() == 1 && left as f64 <= HALFWAY * before as f64 {
            pictures.push(picture("halfway", &simulator));
        }
    }
    pictures.push(picture("pulled-out", &simulator));
    let report = &mut bench.report;
    report.figure("contacts_before", before as f64);
    report.figure("contacts_released", (before - left) as f64);
    report.figure("largest_force_n", rows.iter().map(|r| r[1]).fold(0.0, f64::max));
    report.figure("rejected_steps", simulator.facts().rejected_steps as f64);
    let curve = |name: &'static str, title: &str, y, column: usize| {
        let points = rows.iter().map(|r| [r[0], r[column]]).collect();
        Plot { name, title: title.to_owned(), x: "pulled [mm]", y, lines: vec![Line::new(name, points)] }
    };
    report.plots = vec![
        curve("force", "Pulling a row out of garter stitch", "force at its end [N]", 1),
        curve("contacts", "Pulling a row out of garter stitch", "contacts left of the row's yarn", 2),
    ];
    let columns = vec!["pulled_mm", "force_n", "contacts"];
    report.tables.push(Table { name: "pullout", columns, rows });
    report.pictures = pictures;
    Ok(())
}

/// Cuts the yarn of the row at both sides. Gives the yarn between.
fn cut_loose(specimen: &Specimen, simulator: &mut Simulator) -> Result<YarnId> {
    let net = &specimen.net;
    let in_row = |v: &VisitId| {
        let face = net.nodes[net.visits[v.index()].node.index()].face;
        face.is_some_and(|f| specimen.rows[ROW].contains(&f))
    };
    let of_row: Vec<VisitId> = net.contacts.iter().flat_map(|c| c.new).filter(in_row).collect();
    let first = of_row.iter().min().context("the row has no contacts")?;
    let last = of_row.iter().max().context("the row has no contacts")?;
    let yarn = net.visits[first.index()].yarn;
    // The later cut first: it leaves all ids before it as they are.
    simulator.operate(Operation::Cut(*last))?;
    simulator.operate(Operation::Cut(VisitId(first.0 - 1)))?;
    Ok(YarnId(yarn.0 + 1))
}

/// Holds the borders except at the row, and the later end of its yarn. Gives where that is and which way is out.
fn hold(specimen: &Specimen, simulator: &mut Simulator, yarn: YarnId) -> Result<(DVec3, DVec3)> {
    let net = simulator.net();
    let x = &simulator.state().position;
    let on_border = |face: FaceId| {
        let row = specimen.rows.iter().position(|row| row.contains(&face));
        row.is_some_and(|r| {
            let faces = &specimen.rows[r];
            let side = [faces.first(), faces.last()].contains(&Some(&face));
            r != ROW && (side || r == 0 || r + 1 == specimen.rows.len())
        })
    };
    let held = net.nodes.iter().enumerate().filter(|(_, n)| n.face.is_some_and(on_border));
    let mut pins: Vec<Pin> =
        held.map(|(i, _)| Pin { node: i as u32, target: x[i], stiffness: HOLD }).collect();
    let end = net.visits[net.yarns[yarn.index()].visits.end as usize - 1].node;
    let start = x[end.index()];
    pins.push(Pin { node: end.0, target: start, stiffness: STIFFNESS });
    let outwards = DVec3::X * start.x.signum();
    simulator.set_scene(Scene { pins, ..Scene::empty() })?;
    Ok((start, outwards))
}

/// Nodes that the yarn shares with another one.
fn contacts(simulator: &Simulator, yarn: YarnId) -> usize {
    let net = simulator.net();
    let visits = net.yarns[yarn.index()].visits.clone();
    let nodes = visits.map(|v| &net.nodes[net.visits[v as usize].node.index()]);
    nodes.filter(|n| !matches!(n.kind, NodeKind::Loose | NodeKind::Free)).count()
}
