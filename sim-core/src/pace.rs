//! Simulated time against the time on the clock.
//!
//! A step is due when as much time has gone by as it simulates. One that took too long is made up for by those after it, which
//! follow each other without a pause, but only as far as [`MOST_BEHIND`]: what a simulation is behind by more is dropped. So a
//! hitch does not show, and fabric that is too large for its machine moves slowly rather than in jumps.

use std::time::{Duration, Instant};

/// Steps that may be due at once.
const MOST_BEHIND: u32 = 2;

/// When the next step is due.
pub(crate) struct Pace {
    due: Instant,
}

impl Pace {
    /// One step is due at once.
    pub fn starting(now: Instant) -> Self {
        Self { due: now }
    }

    /// Time until the next step is due.
    pub fn until_due(&self, now: Instant) -> Duration {
        self.due.saturating_duration_since(now)
    }

    /// A step of `h` is over.
    pub fn step(&mut self, h: Duration, now: Instant) {
        let earliest = now.checked_sub(MOST_BEHIND * h).unwrap_or(now);
        self.due = (self.due + h).max(earliest);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const H: Duration = Duration::from_millis(5);

    /// Steps taken in so many milliseconds, each taking as long as `cost` tells of its number [ms].
    fn steps_in(time: u64, cost: impl Fn(u32) -> u64) -> u32 {
        let start = Instant::now();
        let (mut now, mut pace, mut steps) = (start, Pace::starting(start), 0);
        while now - start < Duration::from_millis(time) {
            now += pace.until_due(now) + Duration::from_millis(cost(steps));
            pace.step(H, now);
            steps += 1;
        }
        steps
    }

    #[test]
    fn time_goes_as_on_the_clock() {
        // One at once, one every 5 ms.
        assert_eq!(steps_in(1_000, |_| 1), 201);
        // Late by one step now and then: made up for.
        assert_eq!(steps_in(1_000, |n| if n % 50 == 25 { 9 } else { 1 }), 201);
    }

    #[test]
    fn what_is_behind_by_more_is_dropped() {
        // A pause of a second in which nothing moves, but for two steps.
        let with_pause = steps_in(2_000, |n| if n == 100 { 1_000 } else { 1 });
        assert!((201..=204).contains(&with_pause), "{with_pause}");
        // Too slow for its machine: one after the other.
        assert_eq!(steps_in(1_000, |_| 20), 50);
    }
}
