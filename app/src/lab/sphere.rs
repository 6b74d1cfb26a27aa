//! Six fabrics dropped on a sphere (Cirio et al., Fig. 12): of the same yarn, the five knits about the same size and the plain weave
//! somewhat smaller, and each falls its own way.
//!
//! What is measured: how far the fabric comes down, and how much of the level it still covers.

use super::bench::Bench;
use super::report::{Picture, Table};
use super::specimen::LOOP;
use crate::library::ENTRIES;
use crate::solids::solids;
use crate::written::repeated;
use anyhow::{Context, Result};
use glam::DVec3;
use patterns::knit::knit;
use patterns::knitspeak::{Pattern, Width};
use render::{Drawing, NamedView};
use sim_core::{Body, Material, Materials, Scene, Simulator, curves};
use std::sync::Arc;
use stitch_mesh::edge_counts::StitchSize;
use stitch_mesh::lay::lay;
use stitch_mesh::stitch_mesh::StitchMesh;
use stitch_mesh::weave::{FILL, Stripes, Woven};
use stitch_mesh::yarn_net::YarnNet;

/// Names in the pattern library, and how often each is repeated across and upwards to come out at about the same size.
const KNITTED: [(&str, usize, usize); 5] = [
    ("Feather and Fan", 2, 12),
    ("Openwork Diamonds", 4, 4),
    ("Flame Chevron", 5, 2),
    ("Garter Stitch", 36, 24),
    ("2x2 Rib", 9, 24),
];
/// Ends and picks of the plain weave.
const WOVEN: usize = 46;
/// Radius of the sphere [m] and its coefficient of friction.
const RADIUS: f64 = 0.028;
const FRICTION: f64 = 0.5;
/// Simulated time, and the time step [s].
const TIME: f64 = 0.8;
const STEP: f64 = 0.01;

/// A fabric with its name.
struct Fabric {
    name: &'static str,
    net: Arc<YarnNet>,
    materials: Materials,
}

/// Drops one fabric after another.
pub fn run(bench: &mut Bench) -> Result<()> {
    let fabrics = fabrics()?;
    bench.plan(TIME * fabrics.len() as f64);
    let mut shown = Vec::new();
    let mut rows = Vec::new();
    for fabric in fabrics {
        let mut simulator = drop(&fabric)?;
        bench.run(&mut simulator, TIME)?;
        let x = &simulator.state().position;
        let lowest = x.iter().map(|x| x.y).fold(f64::INFINITY, f64::min);
        let reach = (x.iter().map(|x| x.with_y(0.0).length_squared()).sum::<f64>() / x.len() as f64).sqrt();
        let [hang, reach] = [RADIUS - lowest, reach].map(|x| 1e3 * x);
        let key = fabric.name.to_lowercase().replace(' ', "_");
        bench.report.figure(format!("{key}_hang_mm"), hang);
        bench.report.figure(format!("{key}_reach_mm"), reach);
        rows.push(vec![rows.len() as f64 + 1.0, hang, reach]);
        let yarn = curves(&fabric.net, simulator.state(), &fabric.materials);
        let drawing =
            Drawing { yarn, solids: solids(simulator.scene(), simulator.time_s()), ..Drawing::default() };
        shown.push((fabric.name.to_owned(), drawing));
        let view = NamedView::ThreeQuarter;
        bench.report.pictures = vec![Picture { name: "sphere", view, shown: shown.clone() }];
    }
    let columns = vec!["fabric", "hang_mm", "reach_mm"];
    bench.report.tables.push(Table { name: "sphere", columns, rows });
    Ok(())
}

/// All fabrics, of one yarn.
fn fabrics() -> Result<Vec<Fabric>> {
    let knitted = |(name, across, high)| -> Result<Fabric> {
        let net = Arc::new(lay(&knitted(name, across, high).context(name)?));
        Ok(Fabric { name, net, materials: Material::for_loop_width(LOOP).into() })
    };
    KNITTED.into_iter().map(knitted).chain([woven()]).collect()
}

/// Plain weave of the same yarn.
fn woven() -> Result<Fabric> {
    let material = Material::for_loop_width(LOOP);
    let piece = Woven {
        draft: "plain".parse()?,
        ends: WOVEN,
        picks: WOVEN,
        spacing: material.drawn_radius / FILL,
        warp: Stripes::default(),
        weft: Stripes::default(),
        middle: DVec3::ZERO,
        flat: false,
    };
    piece.check()?;
    Ok(Fabric { name: "Plain Weave", net: Arc::new(piece.lay()), materials: material.into() })
}

/// A fabric of the library.
fn knitted(name: &str, across: usize, high: usize) -> Result<StitchMesh> {
    let entry = ENTRIES.iter().find(|e| e.title == name).context("not in the library")?;
    let pattern = Pattern::read(entry.text)?;
    let worked = repeated(pattern.work(Width::Repeats(across))?, high)?;
    Ok(knit(&pattern, &worked, StitchSize::of_width(LOOP))?)
}

/// A simulation of a fabric level above the sphere, face up.
fn drop(fabric: &Fabric) -> Result<Simulator> {
    let mut state = fabric.net.laid_state();
    let middle = state.position.iter().sum::<DVec3>() / state.position.len() as f64;
    for x in &mut state.position {
        let from = *x - middle;
        *x = DVec3::new(from.x, RADIUS + 3e-3 + from.z, -from.y);
    }
    let ball = Body::Sphere { center: DVec3::ZERO, radius: RADIUS, friction: FRICTION };
    let scene = Scene { bodies: vec![ball], time_step: STEP, ..Scene::default() };
    Ok(Simulator::new(&fabric.net, fabric.materials.clone(), scene, state)?)
}
