//! Taking in: segments that a net lays longer than they are to be are shortened while the simulation begins.
//!
//! The legs of a cable are laid straight across it, sewing yarn straight across the gap; a knitter would have pulled both
//! tight. Cut to length at once they would jump, so the yarn is drawn out of them over [`TIME`]; where sewing yarn was laid too short
//! it is let out. Drawing a length out of a segment moves all later sliding coordinates of its yarn down by it, and makes a closed yarn
//! so much shorter.
//!
//! Of the whole that a yarn is to give, each of those segments gives in proportion to what it has just then above its length in the end,
//! and so with what it is to get. The yarn of a cable slides meanwhile, so a length of its own for each would be drawn out of some that
//! no longer have it. Sewing yarn does not slide ([`NodeKind::Seam`](stitch_mesh::yarn_net::NodeKind::Seam)), so each of its segments goes
//! its own way there in equal steps. When it did, what a gap needed no more ran on to where the yarn follows one border, pushed its stitches
//! apart to three times their width and gathered those between: in a sweater of 55 400 loops the armholes crumpled just before they were closed.
//!
//! How far that has come is part of the state ([`YarnState::taken_in`], 0 to 1), so a fabric that is opened again goes on.

use crate::friction::{Anchors, Stack};
use crate::model::Model;
use std::sync::Arc;
use stitch_mesh::ids::VisitId;
use stitch_mesh::yarn_net::{TakenIn, YarnNet, YarnState};

/// How long taking in takes [s]. In half of that the gaps of a sweater of 55 400 loops close by 40 % of the length of a stitch of the seam
/// in a step of 1/30 s, and yarn in such a hurry is stretched by 4 %; so by 1.4 %.
const TIME: f64 = 0.8;

/// What is taken in of a net.
#[derive(Clone, Debug, Default)]
pub(crate) struct TakeIn {
    /// By how much the sliding coordinate of each visit goes down in all, [visit_count], or empty if nothing is taken in [m].
    total: Vec<f64>,
    /// By how much the whole of each yarn becomes shorter, [yarn_count] [m].
    of_yarn: Vec<f64>,
    /// The sliding coordinates that were laid, [visit_count], or empty if nothing is taken in [m].
    laid: Vec<f64>,
}

impl TakeIn {
    pub fn new(net: &YarnNet) -> Self {
        if net.taken_in.is_empty() {
            return Self::default();
        }
        let mut total = vec![0.0; net.visits.len()];
        for taken in &net.taken_in {
            if let Some(next) = net.next(taken.segment) {
                // Where a closed yarn meets its beginning only its whole becomes shorter.
                let at = if next > taken.segment { Some(next) } else { None };
                at.into_iter().for_each(|v| total[v.index()] += taken.length);
            }
        }
        let mut of_yarn = vec![0.0; net.yarns.len()];
        for taken in &net.taken_in {
            of_yarn[net.visits[taken.segment.index()].yarn.index()] += taken.length;
        }
        for yarn in &net.yarns {
            let mut sum = 0.0;
            for v in yarn.visits.clone() {
                sum += total[v as usize];
                total[v as usize] = sum;
            }
        }
        Self { total, of_yarn, laid: net.visits.iter().map(|v| v.u).collect() }
    }

    /// Shortens the turn of the elements where closed yarns meet their beginning, by `part` of the whole.
    pub fn shorten_turns(&self, model: &mut Model, part: f64) {
        if self.total.is_empty() || part == 0.0 {
            return;
        }
        let net = model.net.clone();
        let shorter = |visit: VisitId| part * self.of_yarn[net.visits[visit.index()].yarn.index()];
        for segment in &mut model.segments {
            shorten(&mut segment.stencil.turn, shorter(segment.stencil.visits[0]));
        }
        for bend in &mut model.bends {
            shorten(&mut bend.stencil.turn, shorter(bend.stencil.visits[0]));
        }
    }

    /// By how much the sliding coordinate of a visit goes down in all [m].
    pub fn total(&self, visit: VisitId) -> f64 {
        self.total.get(visit.index()).copied().unwrap_or_default()
    }

    /// By how much the yarn from one visit to another becomes shorter in all, `around` where a closed yarn meets its beginning in
    /// between [m].
    pub fn taken(&self, net: &YarnNet, from: VisitId, to: VisitId, around: bool) -> f64 {
        let yarn = net.visits[from.index()].yarn;
        let of_yarn = self.of_yarn.get(yarn.index()).copied().unwrap_or_default();
        self.total(to) - self.total(from) + if around { of_yarn } else { 0.0 }
    }

    /// The net with `part` of it taken in for good and no more to come; none if there is nothing to take in.
    pub fn settle(&self, net: &YarnNet, part: f64) -> Option<YarnNet> {
        if self.total.is_empty() {
            return None;
        }
        let mut settled = YarnNet { taken_in: Vec::new(), ..net.clone() };
        for (visit, total) in Arc::make_mut(&mut settled.visits).iter_mut().zip(&self.total) {
            visit.u -= part * total;
        }
        for (yarn, total) in settled.yarns.iter_mut().zip(&self.of_yarn) {
            yarn.period = yarn.period.map(|period| period - part * total);
        }
        Some(settled)
    }

    /// Whether there is no more to take in once `part` of it all has been.
    pub fn is_over(&self, part: f64) -> bool {
        self.total.is_empty() || part >= 1.0
    }

    /// Takes in as much as a step of `h` [s] does, and moves the anchors of friction along.
    pub fn step(
        &self,
        model: &mut Model,
        state: &mut YarnState,
        (stacks, anchors): (&[Stack], &mut Anchors),
        h: f64,
    ) {
        if self.is_over(state.taken_in) {
            return;
        }
        let part = (h / TIME).min(1.0 - state.taken_in);
        let shift = self.shifts(&model.net, state, part);
        for (u, shift) in state.sliding.iter_mut().zip(&shift) {
            *u += shift;
        }
        anchors.shift(stacks, |v| shift[v]);
        state.taken_in += part;
        self.shorten_turns(model, part);
    }

    /// What is added to each sliding coordinate when `part` of it all is taken in, [visit_count] [m].
    fn shifts(&self, net: &YarnNet, state: &YarnState, part: f64) -> Vec<f64> {
        // Of each yarn the segments that are shortened, and those that are let out.
        let kind = |taken: &TakenIn| {
            [net.visits[taken.segment.index()].yarn.index(), usize::from(taken.length < 0.0)]
        };
        let share = |taken: &TakenIn| {
            let has = self.length(net, taken.segment, &state.sliding, state.taken_in);
            let laid = self.length(net, taken.segment, &self.laid, 0.0);
            let sign = taken.length.signum();
            Share { has, spare: (sign * (has - (laid - taken.length))).max(0.0), wanted: part * taken.length }
        };
        let mut all = vec![[Share::default(); 2]; net.yarns.len()];
        let mut shift = vec![0.0; net.visits.len()];
        for taken in &net.taken_in {
            let [yarn, sign] = kind(taken);
            all[yarn][sign] = all[yarn][sign].and(share(taken));
        }
        for taken in &net.taken_in {
            let [yarn, sign] = kind(taken);
            if let Some(next) = net.next(taken.segment).filter(|next| *next > taken.segment) {
                shift[next.index()] -= all[yarn][sign].draw(share(taken));
            }
        }
        for yarn in &net.yarns {
            let mut sum = 0.0;
            for v in yarn.visits.clone() {
                sum += shift[v as usize];
                shift[v as usize] = sum;
            }
        }
        shift
    }

    /// Yarn from a visit to the next, with these sliding coordinates and so much of all taken in [m].
    fn length(&self, net: &YarnNet, segment: VisitId, sliding: &[f64], taken_in: f64) -> f64 {
        let Some(next) = net.next(segment) else { return 0.0 };
        let yarn = net.visits[segment.index()].yarn.index();
        let turn = || net.yarns[yarn].period.map_or(0.0, |period| period - taken_in * self.of_yarn[yarn]);
        let around = if next > segment { 0.0 } else { turn() };
        sliding[next.index()] + around - sliding[segment.index()]
    }
}

/// Yarn that a segment has, or several segments; what of it they have to give before they are as long as they are to be; and what
/// they are to give now [m].
#[derive(Clone, Copy, Default)]
struct Share {
    has: f64,
    spare: f64,
    wanted: f64,
}

impl Share {
    fn and(self, other: Self) -> Self {
        Self {
            has: self.has + other.has,
            spare: self.spare + other.spare,
            wanted: self.wanted + other.wanted,
        }
    }

    /// What one of all these segments gives: spare yarn first, and where that is not enough in proportion to what it has.
    fn draw(self, one: Self) -> f64 {
        let from_spare = self.wanted.clamp(-self.spare, self.spare);
        let part = |of: f64, all: f64| if all > 0.0 { of / all } else { 0.0 };
        from_spare * part(one.spare, self.spare) + (self.wanted - from_spare) * part(one.has, self.has)
    }
}

fn shorten<const K: usize>(turn: &mut [f64; K], length: f64) {
    turn.iter_mut().filter(|t| **t > 0.0).for_each(|t| *t -= length);
}

#[cfg(test)]
mod tests {
    use super::{TIME, TakeIn};
    use crate::{Material, Scene, Simulator};
    use std::sync::Arc;
    use stitch_mesh::cable::Cable;
    use stitch_mesh::edge_counts::StitchSize;
    use stitch_mesh::ids::{FaceId, VertexId};
    use stitch_mesh::lay::lay;
    use stitch_mesh::pieces::{rectangle, tube};
    use stitch_mesh::seam::Seam;
    use stitch_mesh::stitch_mesh::StitchMesh;
    use stitch_mesh::yarn_net::{TakenIn, YarnNet, YarnState};

    /// Unstretched yarn there is, from the sliding coordinates of a simulation.
    fn yarn_length(simulator: &Simulator) -> f64 {
        let segments = &simulator.model().segments;
        segments.iter().map(|s| s.stencil.coordinates::<8>(simulator.state())).map(|q| q[7] - q[3]).sum()
    }

    fn laid_length(net: &YarnNet) -> f64 {
        net.segments()
            .map(|s| net.visits[s.ends[1].index()].u + s.wrap - net.visits[s.ends[0].index()].u)
            .sum()
    }

    fn with_cable(mut stitches: StitchMesh, path: [u32; 5]) -> Arc<YarnNet> {
        stitches.set_cable(Cable::cross(path.map(VertexId).to_vec(), 2, 2, true)).unwrap();
        Arc::new(lay(&stitches))
    }

    #[test]
    fn what_is_to_be_taken_in_is_taken_in_and_no_more() {
        let size = StitchSize::of_width(3e-3);
        let flat = with_cable(rectangle(8, 6, size).unwrap(), [29, 30, 31, 32, 33]);
        // Across the place where the rings of a tube begin, so that the shortened turn matters.
        let tube = tube(12, 6, size).unwrap();
        let first = tube.mesh().first_half_edge(FaceId(24));
        let base = tube.mesh().origin(first).0;
        let round = with_cable(tube, [base + 10, base + 11, base, base + 1, base + 2]);
        for net in [flat, round] {
            let target: f64 = net.taken_in.iter().map(|t| t.length).sum();
            assert!(target > 1e-3);
            let mut simulator =
                Simulator::new(&net, Material::for_loop_width(3e-3), Scene::empty(), net.laid_state())
                    .unwrap();
            let mut lengths = vec![yarn_length(&simulator)];
            assert!((lengths[0] - laid_length(&net)).abs() < 1e-9);
            while simulator.time_s() < 0.5 * TIME {
                simulator.step().unwrap();
            }
            lengths.push(yarn_length(&simulator));
            // Going on from a saved state goes on with the rest.
            let state = simulator.state().clone();
            let mut simulator =
                Simulator::new(&net, Material::for_loop_width(3e-3), Scene::empty(), state).unwrap();
            assert!((yarn_length(&simulator) - lengths[1]).abs() < 1e-9);
            while simulator.time_s() < 0.5 * TIME {
                simulator.step().unwrap();
            }
            lengths.push(yarn_length(&simulator));
            let taken: Vec<f64> = lengths.windows(2).map(|w| (w[0] - w[1]) / target).collect();
            assert!((taken[0] - 0.5).abs() < 0.05 && (taken[0] + taken[1] - 1.0).abs() < 1e-6, "{taken:?}");
        }
    }

    /// A piece whose left side is sewn to its right side.
    fn sewn() -> Arc<YarnNet> {
        let mut stitches = rectangle(8, 6, StitchSize::of_width(3e-3)).unwrap();
        let side = |first: usize| (0..=6).map(|row| VertexId::new(9 * row + first)).collect();
        stitches.sew(Seam { a: side(0), b: side(8) }).unwrap();
        Arc::new(lay(&stitches))
    }

    #[test]
    fn every_stitch_of_a_seam_comes_to_its_own_length() {
        let mut net = YarnNet::clone(&sewn());
        // One was laid too short, and is let out.
        net.taken_in[3].length = -1e-3;
        let net = Arc::new(net);
        let (material, scene) = (Material::for_loop_width(3e-3), Scene { time_step: 0.02, ..Scene::empty() });
        let mut simulator = Simulator::new(&net, material, scene, net.laid_state()).unwrap();
        assert!(net.taken_in.len() > 8);
        let lengths = |state: &YarnState| -> Vec<f64> {
            let to = |t: &TakenIn| net.next(t.segment).unwrap().index();
            net.taken_in.iter().map(|t| state.sliding[to(t)] - state.sliding[t.segment.index()]).collect()
        };
        let laid = lengths(simulator.state());
        while simulator.time_s() < TIME {
            simulator.step().unwrap();
            let part = simulator.state().taken_in;
            for ((now, laid), taken) in lengths(simulator.state()).iter().zip(&laid).zip(&net.taken_in) {
                assert!((now - (laid - part * taken.length)).abs() < 1e-9);
            }
        }
        assert!((simulator.state().taken_in - 1.0).abs() < 1e-9);
    }

    #[test]
    fn a_segment_that_is_short_enough_gives_nothing() {
        let net = with_cable(rectangle(8, 6, StitchSize::of_width(3e-3)).unwrap(), [29, 30, 31, 32, 33]);
        let take_in = TakeIn::new(&net);
        let taken = net.taken_in[1];
        let next = net.next(taken.segment).unwrap();
        let mut state = net.laid_state();
        let given = |state: &YarnState| {
            let shift = take_in.shifts(&net, state, 0.1);
            shift[taken.segment.index()] - shift[next.index()]
        };
        assert!(given(&state) > 0.0);
        // All that it is to lose has slid on into the next segment.
        state.sliding[next.index()] -= taken.length;
        assert!(given(&state).abs() < 1e-15, "{}", given(&state));
    }

    #[test]
    fn nothing_is_drawn_from_where_there_is_no_yarn() {
        let size = StitchSize::of_width(3e-3);
        let net = with_cable(rectangle(8, 6, size).unwrap(), [29, 30, 31, 32, 33]);
        let take_in = TakeIn::new(&net);
        // Nearly all the yarn of one segment that is taken in has slid on into the next.
        let poor = net.taken_in[1].segment;
        let next = net.next(poor).unwrap();
        let has = |state: &YarnState| state.sliding[next.index()] - state.sliding[poor.index()];
        let mut state = net.laid_state();
        let left = 0.02 * has(&state);
        state.sliding[next.index()] = state.sliding[poor.index()] + left;
        let shift = take_in.shifts(&net, &state, 0.5);
        let before = has(&state);
        state.sliding.iter_mut().zip(&shift).for_each(|(u, shift)| *u += shift);
        assert!(has(&state) > 0.4 * before, "{} of {before}", has(&state));
        // Its yarn gives what it is to give all the same.
        let yarn = &net.yarns[net.visits[poor.index()].yarn.index()];
        let of_yarn = |t: &&TakenIn| yarn.visits.contains(&t.segment.0);
        let wanted: f64 = net.taken_in.iter().filter(of_yarn).map(|t| t.length).sum();
        let last = yarn.visits.end as usize - 1;
        assert!(yarn.period.is_none() && (shift[last] + 0.5 * wanted).abs() < 1e-12);
    }
}
