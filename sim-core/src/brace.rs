//! Braces: a step that a few segments would spoil is solved again with those segments held.
//!
//! # Theory
//! A linearised step knows the contacts that there are when it begins. Where two crossings rush towards each other along a yarn, the
//! contact between them (`parallel.rs`) begins in the middle of the step, which the system knows nothing of; the yarn between them is
//! used up, and at half of the time step again. So such segments are found when the step has been solved, and it is solved again
//! with what it did not know of, as in an active set method. For a segment with Δu of yarn, in that step alone:
//! - it would lose more than half of its yarn: a spring k/2 (¾ Δu − Δu')² on Δu' at the end of the step, k being k_c of the contact;
//! - its ends would move too far against each other: they are tied to each other by a dashpot k h on their relative velocity,
//!   k = k_s / Δu being the stiffness of the segment along itself, in all directions here.
//!
//! Both act between the ends of a segment: momentum is kept, and of spin what single segments have.
//!
//! # Practice
//! In a sweater of 10 400 loops one segment of a seam made h fall from 16.7 to 0.26 ms, and 17 steps went by until it was back. Held, one
//! more solution does. It is one by conjugate gradients with the factor that was made for the step without braces, from its solution: each
//! brace is one or three eigenvalues beside the many at 1, and 3 … 25 iterations do, with what contacts of layers need. What does not hold when it has been
//! braced [`MOST_TIMES`] is left to a shorter step, as are the many segments that find their first shape in a piece that was just laid. The
//! GPU has no braces: its steps are halved.
//!
//! What needs braces again and again is a sign that something is drawn shorter than it can be. Nearly every step of 55 400 loops did
//! while sewing yarn was pulled tighter than its borders are thick.

use crate::assembly::System;
use crate::material::Material;
use crate::model::{FROZEN, Model};
use crate::step::Rejection;
use stitch_mesh::yarn_net::YarnState;

/// Solutions with braces before the time step is halved.
const MOST_TIMES: usize = 4;

/// Segments of which one may be held; more are a sign that the whole step is too long.
const SEGMENTS_FOR_ONE: usize = 1_000;

/// What a brace becomes stronger by where it did not do.
const STRONGER: f64 = 10.0;

/// Part of its yarn that a segment is to keep.
const KEPT: f64 = 0.75;

/// What a segment may not do in one step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Excess {
    /// Lose more than half of its yarn.
    Shrinking,
    /// Move its ends against each other by more than [`LEAP`](crate::step::LEAP) allows.
    Leaping,
}

/// A segment that goes too far, by its number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Failure {
    pub segment: usize,
    pub excess: Excess,
}

impl From<Failure> for Rejection {
    fn from(Failure { segment, excess }: Failure) -> Self {
        match excess {
            Excess::Shrinking => Self::Shrinking(segment),
            Excess::Leaping => Self::Leaping(segment),
        }
    }
}

/// The segments held in a step, each with what its brace is stronger by than the first one was.
#[derive(Debug)]
pub(crate) struct Braces {
    held: Vec<(Failure, f64)>,
    times: usize,
    most: usize,
}

impl Braces {
    /// None yet, for a net of so many segments.
    pub fn new(segments: usize) -> Self {
        Self { held: Vec::new(), times: 0, most: segments / SEGMENTS_FOR_ONE }
    }

    /// Whether no segment is held.
    pub fn is_empty(&self) -> bool {
        self.held.is_empty()
    }

    /// Holds these segments too, and more strongly those that are held already. An error if that would be too often or too many.
    pub fn hold(&mut self, failures: &[Failure]) -> Result<(), Rejection> {
        let Some(first) = failures.first() else { return Ok(()) };
        if self.times == MOST_TIMES || failures.len() > self.most {
            return Err((*first).into());
        }
        self.times += 1;
        for failure in failures {
            match self.held.iter_mut().find(|(held, _)| held == failure) {
                Some((_, strength)) => *strength *= STRONGER,
                None => self.held.push((*failure, 1.0)),
            }
        }
        Ok(())
    }

    /// Adds all of them to the system of a step of `h` from `state`.
    pub fn add(&self, model: &Model, system: &mut System, materials: &[Material], state: &YarnState, h: f64) {
        for (Failure { segment, excess }, strength) in &self.held {
            let term = &model.segments[*segment];
            let material = &materials[term.dye as usize];
            let nodes = term.stencil.nodes.map(|n| n.index());
            let visits = term.stencil.visits.map(|v| v.index());
            let yarn = state.sliding[visits[1]] + term.stencil.turn[1] - state.sliding[visits[0]];
            match excess {
                Excess::Shrinking => {
                    let stiffness = strength * material.parallel_stiffness;
                    let force = stiffness * (KEPT - 1.0) * yarn;
                    let unknowns = visits.map(|v| model.sliding[v]);
                    for (unknown, impulse) in unknowns.into_iter().zip([-h * force, h * force]) {
                        if unknown != FROZEN {
                            system.rhs[unknown as usize] += impulse;
                        }
                    }
                    join(model, system, nodes, unknowns, h * h * stiffness);
                }
                Excess::Leaping => {
                    let stiffness = strength * material.stretch_stiffness() / yarn;
                    for axis in 0..3 {
                        let unknowns = nodes.map(|n| model.start[n] + axis);
                        join(model, system, nodes, unknowns, h * h * stiffness);
                    }
                }
            }
        }
    }
}

/// Adds `mass` times the difference of two rates squared, each an unknown of one of two nodes; one that is frozen is zero.
fn join(model: &Model, system: &mut System, nodes: [usize; 2], unknowns: [u32; 2], mass: f64) {
    for unknown in unknowns.into_iter().filter(|u| *u != FROZEN) {
        system.matrix.add_diagonal(unknown as usize, mass);
    }
    if unknowns.contains(&FROZEN) {
        return;
    }
    let [a, b] = [0, 1].map(|end| (nodes[end], unknowns[end] - model.start[nodes[end]]));
    let ((column, j), (row, i)) = (a.min(b), a.max(b));
    let block = system.matrix.block(row, column);
    let place = system.matrix.place(model.start[column], block, i, j);
    system.matrix.value[place] -= mass;
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::friction::Anchors;
    use crate::scene::Scene;
    use crate::step::{Stepper, Stuck};
    use glam::DVec3;

    const H: f64 = 2e-3;

    /// Free stockinette, a segment in its middle and its stepper.
    fn swatch() -> (Stepper, Stuck, usize) {
        let model = crate::testing::swatch_model(8, 8);
        let state = model.net.laid_state();
        let middle = model.segments.len() / 2;
        let segment = (middle..).find(|s| !model.segments[*s].in_contact).unwrap();
        let material = Material::for_loop_width(3e-3);
        let stepper = Stepper::new(model, &material.into(), None);
        let anchors = Anchors::at(&stepper.stacks, &state.sliding);
        (stepper, Stuck { state, anchors }, segment)
    }

    fn scene() -> Scene {
        Scene { gravity: DVec3::ZERO, time_step: H, ..Scene::default() }
    }

    /// What goes too far in a step without braces.
    fn unheld(stepper: &mut Stepper, now: &Stuck) -> Vec<Failure> {
        let next = stepper.attempt(now, &scene(), 0.0, H, &Braces::new(0)).unwrap().next.state;
        stepper.judge(&now.state, &next).unwrap()
    }

    /// That nothing goes too far in the same step with these segments held.
    fn held(stepper: &mut Stepper, now: &Stuck, failures: Vec<Failure>) {
        let mut braces = Braces::new(SEGMENTS_FOR_ONE * failures.len());
        braces.hold(&failures).unwrap();
        let next = stepper.attempt(now, &scene(), 0.0, H, &braces).unwrap().next.state;
        assert_eq!(stepper.judge(&now.state, &next), Ok(Vec::new()));
    }

    #[test]
    fn segments_keep_half_of_their_yarn() {
        let (mut stepper, mut now, segment) = swatch();
        let [a, b] = stepper.model.segments[segment].stencil.visits.map(|v| v.index());
        // On both sides the yarn is so tight that more is pulled out of its neighbours than they have.
        for (outer, inner) in [(a - 1, a), (b + 1, b)] {
            now.state.sliding[outer] += 0.8 * (now.state.sliding[inner] - now.state.sliding[outer]);
        }
        let failures = unheld(&mut stepper, &now);
        assert!(failures.iter().any(|f| f.excess == Excess::Shrinking), "{failures:?}");
        held(&mut stepper, &now, failures);
    }

    #[test]
    fn ends_are_held_together_and_momentum_is_kept() {
        let (mut stepper, mut now, segment) = swatch();
        let [a, b] = stepper.model.segments[segment].stencil.nodes.map(|n| n.index());
        let along = now.state.position[b] - now.state.position[a];
        now.state.velocity[a] = 12.0 / H * along.length() * along.any_orthonormal_vector();
        now.state.velocity[b] = -now.state.velocity[a];
        let failures = unheld(&mut stepper, &now);
        assert!(failures.contains(&Failure { segment, excess: Excess::Leaping }), "{failures:?}");
        held(&mut stepper, &now, failures);

        // What holds two ends resists no motion that they have in common.
        let mut braces = Braces::new(SEGMENTS_FOR_ONE);
        braces.hold(&[Failure { segment, excess: Excess::Leaping }]).unwrap();
        let Stepper { model, system, materials, .. } = &mut stepper;
        let diagonal =
            |system: &System| system.matrix.value[system.matrix.column[model.start[a] as usize] as usize];
        let (before, was) = (system.matrix.translated(), diagonal(system));
        braces.add(model, system, materials, &now.state, H);
        assert!(diagonal(system) > 1.05 * was);
        let change = system.matrix.translated() - before;
        assert!(change.to_cols_array().iter().all(|x| x.abs() < 1e-9 * was));
    }

    #[test]
    fn braces_give_up() {
        let failure = |segment| Failure { segment, excess: Excess::Shrinking };
        let mut braces = Braces::new(2 * SEGMENTS_FOR_ONE);
        for _ in 0..MOST_TIMES {
            assert_eq!(braces.hold(&[failure(3)]), Ok(()));
        }
        assert_eq!(braces.held, [(failure(3), STRONGER.powi(MOST_TIMES as i32 - 1))]);
        assert_eq!(braces.hold(&[failure(3)]), Err(Rejection::Shrinking(3)));
        let many = [5, 6, 7].map(failure);
        assert_eq!(Braces::new(2 * SEGMENTS_FOR_ONE).hold(&many), Err(Rejection::Shrinking(5)));
    }
}
