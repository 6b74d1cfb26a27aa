//! Rest-shape compensation: a garment that keeps the size in which it was laid.
//!
//! # Theory
//! Cirio et al. §4.1 and Fig. 6: laid loops are not at rest. Set free, yarn straightens and wraps, loops become shorter or
//! narrower, and a garment shrinks and wrinkles. So a small rectangle of the fabric is relaxed first, without gravity,
//! and the shapes of its loops are carried into the garment.
//!
//! Carried over are
//! - the **yarn**: the rectangle is laid larger by a growth (g_course, g_wale), found by iteration, such that it relaxes to the
//!   size in which it *should* lie; a segment r = α a + β b + γ n of the garment, in the frame of its face, gets the rest length
//!   |α g_course a + β g_wale b + γ n|;
//! - the **shape**: places (α, β, γ) of the nodes of each stitch relative to its middle, as relaxed;
//! - the **slide**: for each segment Δu relaxed over Δu laid.
//!
//! The frame of a face is made of the middles of stitches, not of mesh corners, so that it is the same thing in a relaxed
//! fabric, which has no mesh: a along the course and b along the wale, each the mean way to the neighbours, and n across both,
//! as long as their mean.
//!
//! The rectangle is kept from curling, as the garment is by being closed: every node has a weak spring to the plane, which
//! goes along with it within the plane. So weak that ribs fold, and that a curl reaches two stitches inwards, no further.
//!
//! # Practice
//! Yarn and shape are kept apart, as they are everywhere else: the net is given its rest lengths, and a state in which the
//! loops have their shapes. So everything that follows from rest lengths (contact lengths, jams) is that of the laid
//! rectangle, which is what was relaxed. Stitches find their shape by kind and by the kinds around them: a knit beside a
//! purl takes after a knit beside a purl.
//!
//! These shapes are means over stitches that lean to and fro, so at the start yarn is some percent longer than its way (7 % in a
//! tube of stockinette). The fabric takes that slack up at once, swells a little, and comes back to its size with the
//! time that it needs to settle anyway.
//!
//! # Differences from the paper
//! The paper takes the loop shapes over as they are. Their size then decides: a garment tessellated with stitches of another size
//! than that of the relaxed rectangle would be strained again. Here the rectangle is fitted to the size of the garment's
//! stitches.

mod frames;
mod sample;

use crate::materials::Materials;
use crate::scene::{Pin, Scene};
use crate::simulator::{SimError, Simulator};
use frames::{Frame, at, centers, coordinates, frames};
use glam::DVec3;
use sample::Sample;
use serde::{Deserialize, Serialize};
use std::collections::HashMap;
use std::sync::Arc;
use stitch_mesh::ids::{FaceId, NodeId, VisitId, YarnId};
use stitch_mesh::stitch::Stitch;
use stitch_mesh::stitch_mesh::StitchMesh;
use stitch_mesh::yarn_net::{YarnNet, YarnState};

/// Times the rectangle is laid, each larger by what the last one lacked.
const ROUNDS: usize = 6;
/// Simulated time to relax loops of 3 mm [s], in steps of [s]. Larger loops do the same more slowly.
const TIME: f64 = 1.0;
const STEP: f64 = 5e-3;
/// Stiffness of the springs to the plane for loops of 3 mm [N/m].
const FLAT: f64 = 0.01;

/// What relaxed loops look like; see the module.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RestShape {
    /// g_course, g_wale: laid size over relaxed size.
    growth: [f64; 2],
    stitches: Vec<StitchShape>,
}

/// A stitch and what it looks like among certain others.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct StitchShape {
    stitch: Stitch,
    /// The stitches on its left and right, below and above; none at a border.
    around: [Option<Stitch>; 4],
    /// Its nodes, in their order in the net.
    nodes: Vec<NodeShape>,
}

/// A node of a stitch.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct NodeShape {
    /// α, β, γ.
    place: DVec3,
    /// For each visit, front to back, both ways along its yarn: where the way leads, and Δu relaxed over Δu laid.
    slides: Vec<[(Way, f64); 2]>,
}

/// Where a segment leads: number of the node in its stitch, and whether that is another stitch.
type Way = (u16, bool);

impl RestShape {
    /// Relaxes a flat rectangle in the plane z = 0 whose stitches have the size that they are to keep. `watch` is told how much
    /// is done, from 0 to 1.
    ///
    /// # Errors
    /// The rectangle cannot be simulated.
    pub fn relax(
        sample: &StitchMesh,
        materials: &Materials,
        watch: &mut dyn FnMut(f64),
    ) -> Result<Self, SimError> {
        let wanted = Sample::new(sample.clone());
        let wanted_size = wanted.size(&wanted.net.laid_state());
        let slower = wanted_size[0] / 3e-3;
        let scene = Scene { time_step: slower * STEP, ..Scene::empty() };
        let time = slower * TIME;
        let mut growth = [1.0, 1.0];
        let mut round = 0;
        loop {
            let scale = DVec3::new(growth[0], growth[1], 1.0);
            let positions = sample.mesh().positions().iter().map(|x| *x * scale).collect();
            // A mesh that is valid stays so when it is stretched.
            let laid = Sample::new(sample.moved_to(positions).unwrap_or_else(|_| sample.clone()));
            let mut simulator =
                Simulator::new(&laid.net, materials.clone(), scene.clone(), laid.net.laid_state())?;
            while simulator.time_s() < time {
                simulator
                    .set_scene(Scene { pins: flat(simulator.state(), slower * FLAT), ..scene.clone() })?;
                simulator.step()?;
                watch((round as f64 + simulator.time_s() / time) / ROUNDS as f64);
            }
            round += 1;
            if round == ROUNDS {
                return Ok(Self { growth, stitches: laid.shapes(simulator.state()) });
            }
            let size = laid.size(simulator.state());
            for i in 0..2 {
                growth[i] *= wanted_size[i] / size[i];
            }
        }
    }

    /// By how much loops are laid larger than they lie at rest, along course and wale.
    pub fn growth(&self) -> [f64; 2] {
        self.growth
    }

    /// Gives the yarn of a fabric its rest lengths, and the state in which its loops have their shapes.
    pub fn apply(&self, stitches: &StitchMesh, net: &mut YarnNet) -> YarnState {
        let laid = net.laid_state();
        let frames = frames(stitches, &centers(stitches, net, &laid));
        let local = local_numbers(net);
        let shapes: Vec<Option<&StitchShape>> =
            stitches.mesh().faces().map(|f| self.shape_of(stitches, f)).collect();
        let shape_of = |node: NodeId| {
            let face = net.nodes[node.index()].face?;
            let shape = shapes[face.index()]?;
            Some((&frames[face.index()], shape.nodes.get(local[node.index()] as usize)?))
        };
        let mut state = laid;
        for (i, x) in state.position.iter_mut().enumerate() {
            if let Some((frame, shape)) = shape_of(NodeId::new(i)) {
                *x = at(frame, shape.place);
            }
        }
        let slide = |from: VisitId, to: VisitId| {
            let (_, shape) = shape_of(net.visits[from.index()].node)?;
            let rank = rank(net, from)?;
            let next = way(net, &local, from, to);
            shape.slides.get(rank)?.iter().find(|(n, _)| *n == next).map(|(_, ratio)| *ratio)
        };
        let mut rest = vec![0.0; net.visits.len()];
        let mut slid = vec![0.0; net.visits.len()];
        let mut periods = vec![None; net.yarns.len()];
        for (y, yarn) in net.yarns.iter().enumerate() {
            // Rest length and Δu of each segment.
            let segments = net.segments_of(YarnId::new(y)).map(|segment| {
                let [a, b] = segment.ends;
                let nodes = segment.ends.map(|v| net.visits[v.index()].node);
                let faces = nodes.map(|n| net.nodes[n.index()].face);
                let grown = faces.map(|f| {
                    let r = net.nodes[nodes[1].index()].position - net.nodes[nodes[0].index()].position;
                    f.map(|f| self.grown(&frames[f.index()], r))
                });
                match (grown, slide(a, b), slide(b, a)) {
                    ([Some(x), Some(y)], Some(p), Some(q)) => [0.5 * (x + y), 0.25 * (x + y) * (p + q)],
                    // At the border yarn is as long as its way.
                    _ => {
                        [state.position[nodes[0].index()]
                            .distance(state.position[nodes[1].index()])
                            .max(1e-5); 2]
                    }
                }
            });
            let segments: Vec<[f64; 2]> = segments.collect();
            let sum = |i: usize| segments.iter().map(|s| s[i]).sum::<f64>();
            // Sliding changes no yarn's length.
            let keep = sum(0) / sum(1);
            let (mut u, mut s) = (0.0, 0.0);
            for (visit, segment) in
                yarn.visits.clone().zip(segments.iter().map(Some).chain(std::iter::repeat(None)))
            {
                (rest[visit as usize], slid[visit as usize]) = (u, s);
                if let Some([length, slide]) = segment {
                    (u, s) = (u + length, s + slide * keep);
                }
            }
            periods[y] = yarn.period.map(|_| u);
        }
        let visits = Arc::make_mut(&mut net.visits);
        visits.iter_mut().zip(rest).for_each(|(visit, u)| visit.u = u);
        net.yarns.iter_mut().zip(periods).for_each(|(yarn, period)| yarn.period = period);
        state.sliding = slid;
        state
    }

    /// Length of the vector `r` [m] when its face has grown.
    fn grown(&self, frame: &Frame, r: DVec3) -> f64 {
        let p = coordinates(frame, frame[0] + r);
        let [_, a, b, n] = *frame;
        (p.x * self.growth[0] * a + p.y * self.growth[1] * b + p.z * n).length()
    }

    /// The shape of a stitch: of the same kind, and among the most neighbours of the same kind.
    fn shape_of(&self, stitches: &StitchMesh, face: FaceId) -> Option<&StitchShape> {
        let around = around(stitches, face);
        let alike = |s: &&StitchShape| s.around.iter().zip(&around).filter(|(a, b)| a == b).count();
        self.stitches.iter().filter(|s| s.stitch == *stitches.stitch(face)).max_by_key(alike)
    }
}

/// Springs to the plane z = 0.
fn flat(state: &YarnState, stiffness: f64) -> Vec<Pin> {
    let pin = |(i, x): (usize, &DVec3)| Pin { node: i as u32, target: x.with_z(0.0), stiffness };
    state.position.iter().enumerate().map(pin).collect()
}

/// The number of each node among those of its stitch, [node_count].
fn local_numbers(net: &YarnNet) -> Vec<u16> {
    let mut next: HashMap<Option<FaceId>, u16> = HashMap::new();
    let number = |face: Option<FaceId>| {
        let next = next.entry(face).or_default();
        *next = next.saturating_add(1);
        *next - 1
    };
    net.nodes.iter().map(|n| n.face).map(number).collect()
}

/// Where the segment between two visits leads.
fn way(net: &YarnNet, local: &[u16], from: VisitId, to: VisitId) -> Way {
    let [from, to] = [from, to].map(|v| net.visits[v.index()].node.index());
    (local[to], net.nodes[from].face != net.nodes[to].face)
}

/// Place of a visit in its stack, front to back.
fn rank(net: &YarnNet, visit: VisitId) -> Option<usize> {
    net.nodes[net.visits[visit.index()].node.index()].visits.iter().position(|v| *v == visit)
}

/// The stitches on the left and right, below and above.
fn around(stitches: &StitchMesh, face: FaceId) -> [Option<Stitch>; 4] {
    let mesh = stitches.mesh();
    let beside = [stitches.left(face), stitches.right(face)].map(|h| mesh.face_across(h));
    let [left, right] = beside;
    [left, right, stitches.below(face).next(), stitches.above(face).next()]
        .map(|f| f.map(|f| stitches.stitch(f).clone()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::Material;
    use stitch_mesh::edge_counts::StitchSize;
    use stitch_mesh::lay::lay;
    use stitch_mesh::pieces::{rectangle, tube};

    /// Area between the middles of stitches of a tube [m²].
    fn area(stitches: &StitchMesh, net: &YarnNet, state: &YarnState) -> f64 {
        let frames = frames(stitches, &centers(stitches, net, state));
        frames.iter().map(|[_, a, b, _]| a.cross(*b).length()).sum()
    }

    /// Area after being set free, over that as laid.
    fn kept(stitches: &StitchMesh, net: YarnNet, start: YarnState, laid: f64) -> f64 {
        let net = Arc::new(net);
        let material = Material::for_loop_width(3e-3);
        let mut simulator = Simulator::new(&net, material, Scene::empty(), start).unwrap();
        while simulator.time_s() < 1.2 {
            simulator.step().unwrap();
        }
        area(stitches, &net, simulator.state()) / laid
    }

    #[test]
    fn a_compensated_tube_keeps_its_size_and_every_yarn_its_length() {
        let size = StitchSize::of_width(3e-3);
        let sample = rectangle(12, 14, size).unwrap();
        let shape = RestShape::relax(&sample, &Material::for_loop_width(3e-3).into(), &mut |_| {}).unwrap();
        let garment = tube(14, 12, size).unwrap();
        let plain = lay(&garment);
        let laid = area(&garment, &plain, &plain.laid_state());
        let without = kept(&garment, plain.clone(), plain.laid_state(), laid);
        let mut net = plain.clone();
        let start = shape.apply(&garment, &mut net);
        for yarn in &net.yarns {
            let (first, last) = (yarn.visits.start as usize, yarn.visits.end as usize - 1);
            assert!((first..last).all(|v| start.sliding[v] < start.sliding[v + 1]));
            match yarn.period {
                Some(period) => assert!(start.sliding[last] - start.sliding[first] < period),
                None => assert!((start.sliding[last] - net.visits[last].u).abs() < 1e-9),
            }
        }
        let with = kept(&garment, net, start, laid);
        println!("growth {:?}: {with:.3} with, {without:.3} without", shape.growth());
        assert!((with - 1.0).abs() < 0.5 * (without - 1.0).abs() && (with - 1.0).abs() < 0.05);
    }
}
