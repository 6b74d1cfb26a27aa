//! What is added to the diagonal before an incomplete factorisation, where dropping leaves it indefinite. A complete one never needs it.
//!
//! The CPU factorises again with the next of [`SHIFTS`] when a pivot is not positive. Here a step is one submission, so a group that meets such a
//! pivot shifts its own and goes on. That saves the step, but not its iterations: in a sweater of 3 076 loops 235 without a shift, 87, 22 and 40 with
//! the three. Where nothing is indefinite a shift only costs: 12 iterations of a pullover, 23 with the first. So a step that takes many
//! iterations has the next one try the next shift, and the one with the fewest is kept.

use crate::solver::factor::SHIFTS;

/// Iterations with which nobody looks for a better shift.
const FEW: u32 = 40;

/// Steps until what each shift has taken is forgotten, as what was indefinite may not be any more.
const MEMORY: u32 = 100;

/// The shift in use, and what others took.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Shift {
    now: usize,
    /// Iterations that each took when it was last tried.
    taken: [Option<u32>; SHIFTS.len()],
    steps: u32,
}

impl Shift {
    /// Part of the diagonal that is added to it.
    pub fn part(&self) -> f32 {
        SHIFTS[self.now]
    }

    /// A step has been solved in so many iterations; chooses for the next one.
    pub fn solved_in(&mut self, iterations: u32) {
        self.steps += 1;
        if self.steps == MEMORY {
            *self = Self::default();
            return;
        }
        self.taken[self.now] = Some(iterations);
        if iterations <= FEW || !self.try_next() {
            let tried = self.taken.iter().enumerate().filter_map(|(i, taken)| Some((i, (*taken)?)));
            self.now = tried.min_by_key(|(_, taken)| *taken).map_or(self.now, |(i, _)| i);
        }
    }

    /// A step has not been solved. Whether there is another shift to try it with.
    pub fn failed(&mut self) -> bool {
        self.taken[self.now] = Some(u32::MAX);
        self.try_next()
    }

    fn try_next(&mut self) -> bool {
        let next = self.now + 1;
        let is_new = self.taken.get(next).is_some_and(Option::is_none);
        if is_new {
            self.now = next;
        }
        is_new
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The shifts of steps that take so many iterations with each of them.
    fn shifts(taken: [u32; 4], steps: usize) -> Vec<usize> {
        let mut shift = Shift::default();
        let step = |_| {
            let now = shift.now;
            shift.solved_in(taken[now]);
            now
        };
        (0..steps).map(step).collect()
    }

    #[test]
    fn the_shift_with_the_fewest_iterations_is_found_and_kept() {
        assert_eq!(shifts([12, 23, 30, 40], 4), [0, 0, 0, 0]);
        assert_eq!(shifts([235, 87, 22, 40], 5), [0, 1, 2, 2, 2]);
        assert_eq!(shifts([52, 70, 80, 90], 7), [0, 1, 2, 3, 0, 0, 0]);
        assert_eq!(shifts([90, 50, 60, 70], MEMORY as usize + 1)[4..], {
            let mut then = vec![1; MEMORY as usize - 3];
            then[MEMORY as usize - 4] = 0;
            then
        });
    }

    #[test]
    fn a_step_is_tried_with_every_shift_and_then_given_up() {
        let mut shift = Shift::default();
        for part in [0.0, 1e-3, 4e-3] {
            assert_eq!(shift.part(), part);
            assert!(shift.failed());
        }
        assert!(!shift.failed());
        // A shorter step may do with any of them.
        shift.solved_in(300);
        assert_eq!(shift.part(), SHIFTS[3]);
    }
}
