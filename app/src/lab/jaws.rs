//! Jaws: springs that grip one node a row on both sides of a specimen (or one a column, along the wale) and move apart.
//!
//! Along the axis every spring pulls its node to a place; across it the place goes along with the node, so the fabric may grow
//! narrower as it grows longer. (Clamping whole columns of a curled fabric measures the clamp.)

use super::specimen::Specimen;
use anyhow::{Result, bail};
use glam::DVec3;
use sim_core::{Pin, Simulator};
use stitch_mesh::ids::{FaceId, NodeId};
use stitch_mesh::yarn_net::YarnState;

/// Stiffness of one spring [N/m]. Gives way by some millimetres under the largest forces; what is measured is where the
/// nodes are, not the jaws.
const STIFFNESS: f64 = 20.0;

/// Along the rows or across them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, clap::ValueEnum)]
pub enum Direction {
    /// Along the rows
    #[default]
    Course,
    /// Along the columns
    Wale,
}

impl Direction {
    /// Unit vector in a piece as laid.
    pub(super) fn axis(self) -> DVec3 {
        match self {
            Self::Course => DVec3::X,
            Self::Wale => DVec3::Y,
        }
    }
}

/// A spring and its node.
struct Grip {
    node: NodeId,
    /// −1 or 1.
    side: f64,
    /// Place on the axis to which it pulls [m].
    place: f64,
    /// Place of the node when work was counted last [m], and the force then, outwards [N].
    counted: (f64, f64),
}

/// A pair of jaws.
pub(super) struct Jaws {
    axis: DVec3,
    grips: Vec<Grip>,
    /// Work done on the fabric [J].
    work: f64,
}

impl Jaws {
    /// Grips a specimen where it is.
    pub fn grip(specimen: &Specimen, state: &YarnState, direction: Direction) -> Result<Self> {
        let axis = direction.axis();
        // The outermost node of a stitch as laid.
        let outer = |face: FaceId, side: f64| {
            let nodes = specimen.net.nodes.iter().enumerate();
            let inside = nodes.filter(|(_, n)| n.face == Some(face));
            let out = |x: DVec3| side * x.dot(axis);
            inside
                .max_by(|(_, a), (_, b)| out(a.position).total_cmp(&out(b.position)))
                .map(|(i, _)| (NodeId::new(i), side))
        };
        let (low, high): (Vec<FaceId>, Vec<FaceId>) = match direction {
            Direction::Course => {
                specimen.rows.iter().filter_map(|row| Some((*row.first()?, *row.last()?))).unzip()
            }
            Direction::Wale => match (specimen.rows.first(), specimen.rows.last()) {
                (Some(first), Some(last)) => (first.clone(), last.clone()),
                _ => (Vec::new(), Vec::new()),
            },
        };
        let (low, high) = (low.into_iter().map(|f| (f, -1.0)), high.into_iter().map(|f| (f, 1.0)));
        let held = low.chain(high).filter_map(|(face, side)| outer(face, side));
        let grip = |(node, side): (NodeId, f64)| {
            let place = state.position[node.index()].dot(axis);
            Grip { node, side, place, counted: (place, 0.0) }
        };
        let grips: Vec<Grip> = held.map(grip).collect();
        if [-1.0, 1.0].iter().any(|side| grips.iter().all(|g| g.side != *side)) {
            bail!("the piece has nothing to grip");
        }
        Ok(Self { axis, grips, work: 0.0 })
    }

    /// How many nodes each jaw holds, in the mean.
    pub fn held(&self) -> f64 {
        self.grips.len() as f64 / 2.0
    }

    /// Moves the jaws apart [m], and lets them go along with the fabric across.
    pub fn open(&mut self, simulator: &mut Simulator, by: f64) -> Result<()> {
        self.grips.iter_mut().for_each(|g| g.place += 0.5 * by * g.side);
        let mut scene = simulator.scene().clone();
        let x = &simulator.state().position;
        let target = |g: &Grip| {
            let x = x[g.node.index()];
            x + (g.place - x.dot(self.axis)) * self.axis
        };
        let pin = |g| Pin { target: target(g), node: g.node.0, stiffness: STIFFNESS };
        scene.pins = self.grips.iter().map(pin).collect();
        Ok(simulator.set_scene(scene)?)
    }

    /// Counts the work done since it was counted last: node by node, as stiff rows move less and pull more than others.
    pub fn count_work(&mut self, state: &YarnState) {
        for grip in &mut self.grips {
            let x = state.position[grip.node.index()].dot(self.axis);
            let force = STIFFNESS * grip.side * (grip.place - x);
            self.work += 0.5 * (force + grip.counted.1) * grip.side * (x - grip.counted.0);
            grip.counted = (x, force);
        }
    }

    /// Work done on the fabric so far [J].
    pub fn work(&self) -> f64 {
        self.work
    }

    /// Distance between the gripped nodes of both sides, in the mean [m].
    pub fn distance(&self, state: &YarnState) -> f64 {
        let mean = |side: f64| {
            let places = self.grips.iter().filter(|g| g.side == side);
            let places = places.map(|g| state.position[g.node.index()].dot(self.axis));
            let (sum, count) = places.fold((0.0, 0.0), |(s, c), x| (s + x, c + 1.0));
            sum / f64::max(count, 1.0)
        };
        mean(1.0) - mean(-1.0)
    }

    /// Force with which the jaws pull, the mean of both [N].
    pub fn force(&self, state: &YarnState) -> f64 {
        let of = |g: &Grip| STIFFNESS * g.side * (g.place - state.position[g.node.index()].dot(self.axis));
        0.5 * self.grips.iter().map(of).sum::<f64>()
    }
}
