//! Figures that tell how a simulation is doing.

use crate::body::Placed;
use crate::clearance::least_distance;
use crate::curves::curves;
use crate::forces::HoldFact;
use crate::materials::Materials;
use crate::model::{Model, SegmentTerm};
use crate::scene::Scene;
use crate::step::clearances;
use glam::DVec3;
use serde::{Deserialize, Serialize};
use stitch_mesh::yarn_net::YarnState;

/// Figures of a simulation.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Facts {
    /// Which solver: "cpu".
    pub solver: String,
    /// Steps taken.
    pub steps: u64,
    /// Simulated time [s].
    pub time_s: f64,
    /// Kinetic energy [J].
    pub kinetic_j: f64,
    /// Largest strain of a segment: 0 unstretched, 0.01 one percent longer than its yarn.
    pub max_stretch: f64,
    /// Least distance of two yarns' centre lines over the diameter of the thinnest yarn as drawn; 1 and more: no overlap.
    pub min_yarn_distance_over_diameter: f64,
    /// How deep the yarn is in a body at the worst place [mm].
    pub max_penetration_mm: f64,
    /// Steps thrown away and taken again with half the time step.
    pub rejected_steps: u64,
    /// What holds the fabric, or touches it, and how hard.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub holds: Vec<HoldFact>,
}

/// Largest strain of a segment.
pub(crate) fn max_stretch(model: &Model, state: &YarnState) -> f64 {
    let strain = |term: &SegmentTerm| {
        let q: [f64; 8] = term.stencil.coordinates(state);
        let r = crate::local::point(&q, 4) - crate::local::point(&q, 0);
        r.length().hypot(term.climb) / (q[7] - q[3]) - 1.0
    };
    model.segments.iter().map(strain).fold(0.0, f64::max)
}

/// The figures that follow from a state; the others stay empty.
pub(crate) fn measure(
    model: &Model,
    materials: &Materials,
    (scene, time_s): (&Scene, f64),
    state: &YarnState,
) -> Facts {
    let bodies: Vec<Placed<'_>> = scene.bodies.iter().map(|b| Placed::new(b, time_s, 0.0)).collect();
    let depth = |(x, clearance): (&DVec3, f64)| {
        let near = bodies.iter().filter(|b| b.is_near([*x, *x], clearance));
        near.map(|b| clearance - b.distance(*x).0).fold(0.0, f64::max)
    };
    let deepest = state.position.iter().zip(clearances(model, materials)).map(depth).fold(0.0, f64::max);
    let drawn = curves(&model.net, state, materials);
    let radii = drawn.curves.iter().flat_map(|c| &c.radii);
    let thinnest = f64::from(radii.copied().fold(f32::INFINITY, f32::min));
    Facts {
        max_stretch: max_stretch(model, state),
        min_yarn_distance_over_diameter: least_distance(&drawn) / (2.0 * thinnest),
        max_penetration_mm: 1e3 * deepest,
        ..Facts::default()
    }
}
