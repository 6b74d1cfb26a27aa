//! What segments gain in length by turning, taken off again.
//!
//! # Theory
//! The system of a step is linear: for a segment r with ends that move by h v₀ and h v₁ it reckons with the length
//! ℓ = |r| + h (v₁ − v₀)·r/|r|, and balances forces for that. But the ends move along straight lines, and where the segment
//! turns by an angle φ its true length |r + h (v₁ − v₀)| is greater by some φ²/2. In a garment that falls on a body segments turn
//! by 0.4 in a sixtieth of a second. They come out 8 % too long, the next step draws them back with all the stiffness that yarn
//! has, and lengths swing from step to step.
//!
//! So both ends are drawn together until the length is ℓ: along the segment, in inverse proportion to their masses. These
//! are impulses between two points in the line through both, which keep momentum and angular momentum. Where a body, a pin or
//! another layer holds a node with stiffness k and drag c, it counts as heavier by h²k + hc, which is what the step counts it as:
//! otherwise yarn would pull at jaws that don't give. But at most as [`HEAVIEST`] times heavier. Yarn that is really stretched stays
//! so; at rest, and in a step that turns nothing, nothing happens.
//!
//! # Practice
//! All segments at once, again and again, each by a part of what it has too much (Jacobi): the order of segments does not matter,
//! and the kernels on the GPU do the same. The sweater of 3 000 loops falling on its mannequin, h = 1/60 s: stretch 0.4 … 1.5 % where
//! it was 2 … 11 %, and fewer steps that are taken again.
//!
//! What is drawn back goes on to the neighbours, a segment a sweep, so no number of sweeps takes off all. And the more is drawn back
//! in a step, the faster it moves in the next: with 100 sweeps a sweater that lands on shoulders in steps of 1/30 s has steps that need
//! braces. So a second round of sweeps takes only what is far too long.
//!
//! A body holds a node by some hundred masses of its yarn in steps of 1/30 s. Between two such a light node goes nowhere: a sweep draws it to the
//! one and back to the other, and the heavy ones hardly move. Nearly all segments that came out more than 2 % too long were there.
//! With ten masses they sink 30 µm into a body, and the next step puts them out again.
//!
//! Of 451 709 segments of the sweater of 55 400 loops, those more than 2 % too long in ten steps of at most 1/30 s in which it is let go and lands:
//!
//! | sweeps | at most so many masses | segments | worst |
//! |---|---|---|---|
//! | 100 | all that hold | 0, 2, 0, 1, 0, 0, 6, 7, 26, 20 | 7.5 % |
//! | 100 | 10 | 0, 2, 0, 0, 0, 0, 3, 4, 18, 0 | 2.9 % |
//! | 40 | 10 | 29, 2, 0, 0, 0, 14, 8, 0, 3, 0 | 3.5 % |
//! | 40 and 40 | 10 | none | 1.8 % |
//!
//! (The two in the second step were slack, and their stiffness in `stretch.rs` was another one before the last line.)
//!
//! In fine yarn a sweep goes a shorter way, and one segment after the other is too long as far as fabric turns at once: where a t-shirt of
//! 30 500 loops lands on shoulders with 0.7 m/s, 11 363 of its 250 000 segments stay more than 2 % too long in a step of 1/30 s, up to 15 %, and
//! 10 % in the next. As φ² falls with the square of the time step, it is halved where a step leaves more than a few so: twice there, and from then
//! on no segment is stretched by more than the 2.5 % with which straps carry it in the end. Of sweaters
//! only that of 55 400 loops has such a step, with 17 segments stretched by more than 2 % and one by 4.3 %. Little fabric is given more: of a swatch
//! of 36 loops that is yanked away by one node, at most steps of 10 ms, steps are 7.2 ms in the mean without this, with stretch up to 55 %; 6.7 ms and
//! 6 % if 5 % may be left; and 2.4 ms and 2 % if 2 %.
//!
//! What does not help: sweeps with momentum, 0.8 of the last one's, go further and oscillate, so that steps have to be taken again.
//! Letting a segment keep half of its yarn in the same manner, where it would lose more: the next step finds it overstretched and
//! fails. Steps of 1/45 s with 100 sweeps: 9.9 % in one segment, for half as much time again.

use crate::model::Model;
use glam::DVec3;
use stitch_mesh::yarn_net::YarnState;

/// Excess of length that stays, relative to the length, in a first and in a second round of sweeps. Down to it the rest is drawn back,
/// so that nothing jumps there.
pub(crate) const LEFT: [f64; 2] = [2e-3, 1e-2];

/// Sweeps over all segments in each round, at most.
pub(crate) const SWEEPS: usize = 40;

/// What holds a node counts at most as so many times the mass of its yarn.
pub(crate) const HEAVIEST: f64 = 10.0;

/// Part of the excess that a sweep takes off. Some four segments meet at a node, and together they may not take off more than twice
/// what there is.
pub(crate) const PART: f64 = 0.6;

/// Excess of length after both rounds, relative to the length, that a step may not leave in more than a few segments, of a little fabric and
/// of a large one.
const FAR: [f64; 2] = [5e-2, 2e-2];

/// Segments from which on a fabric is large; a loop has eight.
const LARGE: usize = 10_000;

/// Segments that may be left with it in any fabric.
const LITTLE: usize = 8;

/// Of so many segments one more may be.
const SEGMENTS_FOR_ONE: usize = 100_000;

/// A segment is not drawn back further than to this part of its length before the step.
pub(crate) const LEAST: f64 = 0.5;

/// Draws the ends of segments that have turned from `state` to `next` together, in a step of `h` [s]. `masses` of nodes
/// [node_count] [kg] and what holds each, as a mass [node_count] [kg]. Gives the number of segments that are still too long by more than is [`far`].
pub(crate) fn draw_back(
    model: &Model,
    (masses, held): (&[f64], &[f64]),
    state: &YarnState,
    next: &mut YarnState,
    h: f64,
) -> usize {
    let reckoned = |nodes: [usize; 2]| {
        let [a, b] = nodes;
        let r = state.position[b] - state.position[a];
        let moved = next.position[b] - next.position[a] - r;
        let length = r.length();
        (length + r.dot(moved) / length).max(LEAST * length)
    };
    let ends = |i: usize| model.segments[i].stencil.nodes.map(|n| n.index());
    let reckoned: Vec<f64> = (0..model.segments.len()).map(|i| reckoned(ends(i))).collect();
    let firm: Vec<f64> = masses.iter().zip(held).map(|(m, held)| m + held.min(HEAVIEST * m)).collect();
    let count = next.position.len();
    let (mut shift, mut add) = (vec![DVec3::ZERO; count], vec![DVec3::ZERO; count]);
    // Nodes that the last sweep has drawn at: between two others is nothing new.
    let (mut drawn, mut draws) = (vec![true; count], vec![false; count]);
    for left in LEFT.into_iter().flat_map(|left| [left; SWEEPS]) {
        for (i, reckoned) in reckoned.iter().enumerate() {
            let [a, b] = ends(i);
            if !(drawn[a] || drawn[b]) {
                continue;
            }
            let r = next.position[b] + shift[b] - next.position[a] - shift[a];
            let (length, most) = (r.length(), (1.0 + left) * reckoned);
            if length > most {
                let by = PART * (length - most) / length / (firm[a] + firm[b]) * r;
                add[a] += firm[b] * by;
                add[b] -= firm[a] * by;
                (draws[a], draws[b]) = (true, true);
            }
        }
        shift.iter_mut().zip(&mut add).for_each(|(shift, add)| *shift += std::mem::take(add));
        std::mem::swap(&mut drawn, &mut draws);
        draws.fill(false);
        if !drawn.contains(&true) {
            break;
        }
    }
    for ((x, v), shift) in next.position.iter_mut().zip(&mut next.velocity).zip(&shift) {
        *x += *shift;
        *v += *shift / h;
    }
    let far = far(reckoned.len());
    let is_far = |(i, reckoned): (usize, &f64)| {
        let [a, b] = ends(i);
        next.position[a].distance(next.position[b]) > (1.0 + far) * reckoned
    };
    reckoned.iter().enumerate().filter(|x| is_far(*x)).count()
}

/// Excess of length that a step may leave in a few segments of so many, relative to the length.
pub(crate) fn far(segments: usize) -> f64 {
    FAR[usize::from(segments >= LARGE)]
}

/// Segments that may be left too long by a step in a fabric of so many.
pub(crate) fn most_left(segments: usize) -> usize {
    LITTLE + segments / SEGMENTS_FOR_ONE
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::noise::unit_hash;
    use crate::testing::swatch_model;

    const STEP: f64 = 0.01;

    /// A swatch, its state, and that state moved on by velocities of up to `speed` in all directions.
    fn moved_on(speed: f64) -> (Model, Vec<f64>, YarnState, YarnState) {
        let model = swatch_model(5, 4);
        let state = model.net.laid_state();
        let mut next = state.clone();
        let number = |i: usize| 2.0 * unit_hash(i as u64) - 1.0;
        for (i, (x, v)) in next.position.iter_mut().zip(&mut next.velocity).enumerate() {
            *v = speed * DVec3::new(number(3 * i), number(3 * i + 1), number(3 * i + 2));
            *x += STEP * *v;
        }
        let masses = (0..state.position.len()).map(|i| 1e-6 * (1.0 + unit_hash(1000 + i as u64))).collect();
        (model, masses, state, next)
    }

    fn free(masses: &[f64]) -> Vec<f64> {
        vec![0.0; masses.len()]
    }

    /// Greatest part by which a segment is longer than the linear step reckons with.
    fn excess(model: &Model, state: &YarnState, linear: &YarnState, next: &YarnState) -> f64 {
        let of = |nodes: [usize; 2]| {
            let span = |s: &YarnState| s.position[nodes[1]] - s.position[nodes[0]];
            let (r, moved) = (span(state), span(linear) - span(state));
            let reckoned = (r.length() + r.normalize().dot(moved)).max(LEAST * r.length());
            span(next).length() / reckoned - 1.0
        };
        model.segments.iter().map(|s| of(s.stencil.nodes.map(|n| n.index()))).fold(0.0, f64::max)
    }

    #[test]
    fn segments_that_turn_come_back_to_the_length_that_was_reckoned_with() {
        let (model, masses, state, linear) = moved_on(0.03);
        let mut next = linear.clone();
        draw_back(&model, (&masses, &free(&masses)), &state, &mut next, STEP);
        let (before, after) =
            (excess(&model, &state, &linear, &linear), excess(&model, &state, &linear, &next));
        assert!(before > 0.05 && after < 0.1 * before, "{before} {after}");
        for i in 0..state.position.len() {
            let flown = (next.position[i] - state.position[i]) / STEP;
            assert!(flown.distance(next.velocity[i]) < 1e-12);
        }
    }

    #[test]
    fn between_nodes_that_are_held_segments_come_back_as_well() {
        let (model, masses, state, linear) = moved_on(0.02);
        let held: Vec<f64> =
            masses.iter().enumerate().map(|(i, m)| f64::from(i % 3 != 0) * 400.0 * m).collect();
        let mut next = linear.clone();
        draw_back(&model, (&masses, &held), &state, &mut next, STEP);
        let after = excess(&model, &state, &linear, &next);
        assert!(after < 1.5 * LEFT[1], "{after}");
        let moved = |held: bool| {
            let nodes = (0..masses.len()).filter(|i| (i % 3 != 0) == held);
            nodes.map(|i| next.position[i].distance(linear.position[i])).fold(0.0, f64::max)
        };
        assert!(moved(true) < 0.7 * moved(false), "{} against {}", moved(true), moved(false));
    }

    #[test]
    fn segments_that_turn_too_far_are_counted() {
        for (speed, none_left) in [(0.01, true), (0.3, false)] {
            let (model, masses, state, linear) = moved_on(speed);
            let mut next = linear.clone();
            let left = draw_back(&model, (&masses, &free(&masses)), &state, &mut next, STEP);
            assert_eq!(left == 0, none_left, "{left} at {speed} m/s");
            assert_eq!(excess(&model, &state, &linear, &next) < far(model.segments.len()), none_left);
        }
    }

    #[test]
    fn momentum_and_angular_momentum_are_kept() {
        let (model, masses, state, linear) = moved_on(0.03);
        let mut next = linear.clone();
        draw_back(&model, (&masses, &free(&masses)), &state, &mut next, STEP);
        // About the places before: what is taken off, over all nodes, neither pushes nor turns.
        let sum = |of: &dyn Fn(usize) -> DVec3| (0..masses.len()).map(|i| masses[i] * of(i)).sum::<DVec3>();
        let change = |i: usize| next.velocity[i] - linear.velocity[i];
        let moved: f64 = (0..masses.len()).map(|i| masses[i] * change(i).length()).sum();
        assert!(moved > 0.0 && sum(&change).length() < 1e-12 * moved);
        // Sweeps change places in between, so angular momentum is kept to the size of these changes: less than a tenth of a
        // millimetre, where the swatch has arms of a centimetre.
        let turn = sum(&|i| next.position[i].cross(change(i))).length();
        assert!(turn < 1e-4 * moved, "{turn:e} of {moved:e}");
    }

    #[test]
    fn what_is_stretched_and_what_is_carried_stays() {
        let (model, masses, state, _) = moved_on(0.0);
        let mut next = state.clone();
        for x in &mut next.position {
            *x = 1.1 * *x + DVec3::new(0.0, 0.2, 0.1);
        }
        let expected = next.clone();
        draw_back(&model, (&masses, &free(&masses)), &state, &mut next, STEP);
        assert_eq!(next, expected);
    }
}
