//! Swatches and what to measure on them.

#![allow(dead_code, reason = "each suite uses a part of it")]
#![allow(clippy::unwrap_used, reason = "helpers of tests are tests, and clippy can't tell")]

use glam::DVec3;
use sim_core::{Material, Scene, Simulator};
use std::sync::Arc;
use stitch_mesh::edge_counts::StitchSize;
use stitch_mesh::ids::FaceId;
use stitch_mesh::lay::lay;
use stitch_mesh::pieces::rectangle;
use stitch_mesh::stitch::Stitch;
use stitch_mesh::yarn_net::{YarnNet, YarnState};

/// Loop width of the swatches [m].
pub const WIDTH: f64 = 3e-3;

/// A flat swatch, each stitch chosen by (column, row).
pub fn swatch(wide: usize, high: usize, purl: impl Fn(usize, usize) -> bool) -> Arc<YarnNet> {
    let mut stitches = rectangle(wide, high, StitchSize::of_width(WIDTH)).unwrap();
    for i in (0..wide * high).filter(|i| purl(i % wide, i / wide)) {
        stitches.set_stitch(FaceId::new(i), Stitch::purl()).unwrap();
    }
    Arc::new(lay(&stitches))
}

/// All knit.
pub fn stockinette(wide: usize, high: usize) -> Arc<YarnNet> {
    swatch(wide, high, |_, _| false)
}

/// A swatch free in space.
pub fn free(net: &Arc<YarnNet>) -> Simulator {
    Simulator::new(net, Material::for_loop_width(WIDTH), Scene::empty(), net.laid_state()).unwrap()
}

/// Steps until `time_s`.
pub fn run(simulator: &mut Simulator, time_s: f64) {
    while simulator.time_s() < time_s {
        simulator.step().unwrap();
    }
}

/// Size of the box around the nodes [m].
pub fn size(state: &YarnState) -> DVec3 {
    let low = state.position.iter().copied().reduce(DVec3::min).unwrap();
    let high = state.position.iter().copied().reduce(DVec3::max).unwrap();
    high - low
}

/// Mean position of the nodes of the faces that are `chosen` [m].
pub fn mean_position(net: &YarnNet, state: &YarnState, chosen: impl Fn(usize) -> bool) -> DVec3 {
    let all = net.nodes.iter().zip(&state.position);
    let those = all.filter(|(n, _)| n.face.is_some_and(|f| chosen(f.index())));
    let (sum, count) = those.fold((DVec3::ZERO, 0.0), |(s, c), (_, x)| (s + *x, c + 1.0));
    sum / count
}

/// Mean height over the middle of the fabric's bottom, top, left and right edge, in the frame of the fabric's middle,
/// positive to the front [m].
pub fn edge_heights(net: &YarnNet, state: &YarnState, wide: usize, high: usize) -> [f64; 4] {
    let place = |face: usize| ((face % wide) as f64 + 0.5) / wide as f64;
    let row = |face: usize| ((face / wide) as f64 + 0.5) / high as f64;
    let mean =
        |chosen: &dyn Fn(f64, f64) -> bool| mean_position(net, state, |face| chosen(place(face), row(face)));
    let inner = |x: f64| (0.35..0.65).contains(&x);
    let middle = mean(&|s, t| inner(s) && inner(t));
    let across = mean(&|s, t| s > 0.6 && s < 0.8 && inner(t)) - mean(&|s, t| s > 0.2 && s < 0.4 && inner(t));
    let along = mean(&|s, t| t > 0.6 && t < 0.8 && inner(s)) - mean(&|s, t| t > 0.2 && t < 0.4 && inner(s));
    let normal = across.cross(along).normalize();
    let (first_row, last_row) = (1.0 / high as f64, 1.0 - 1.0 / high as f64);
    let (first_column, last_column) = (1.0 / wide as f64, 1.0 - 1.0 / wide as f64);
    let height = |chosen: &dyn Fn(f64, f64) -> bool| (mean(chosen) - middle).dot(normal);
    [
        height(&|s, t| t < first_row && inner(s)),
        height(&|s, t| t > last_row && inner(s)),
        height(&|s, t| s < first_column && inner(t)),
        height(&|s, t| s > last_column && inner(t)),
    ]
}

/// Least distance of two nodes that were laid more than two stitches apart, over the thickness of the yarns stacked at both:
/// less than 1 where layers of the fabric are pressed into each other.
pub fn least_layer_distance(net: &YarnNet, state: &YarnState, drawn_radius: f64) -> f64 {
    let mut least = f64::INFINITY;
    for (a, b) in (0..net.nodes.len()).flat_map(|a| (0..a).map(move |b| (a, b))) {
        if net.nodes[a].position.distance(net.nodes[b].position) > 2.0 * WIDTH {
            let yarns = (net.nodes[a].visits.len() + net.nodes[b].visits.len()) as f64;
            least = least.min(state.position[a].distance(state.position[b]) / (yarns * drawn_radius));
        }
    }
    least
}
