//! Pulling slowly: loading up to a force, and unloading the same way back.
//!
//! The jaws move by small strokes. Each takes an interval: in its first part they move, then they wait, and the force is the mean
//! over its last part. Where it rises steeply the strokes become shorter, so that a stroke never costs more than a part of
//! the largest force.

use super::bench::Bench;
use super::jaws::Jaws;
use anyhow::Result;
use sim_core::{Energies, Simulator};

/// Simulated time of a stroke [s].
const INTERVAL: f64 = 0.15;
/// Part of it in which the jaws move, and part at its end over which the force is measured.
const MOVING: f64 = 0.6;
const MEASURED: f64 = 0.2;
/// A stroke becomes shorter when it raises the force by more than this part of the largest.
const STEEP: f64 = 0.08;
/// Strokes after which loading ends whatever the force.
pub(super) const MOST_STROKES: usize = 160;

/// The fabric after a stroke.
#[derive(Clone, Copy, Debug)]
pub(super) struct Reading {
    /// Distance between the jaws [m].
    pub distance: f64,
    /// Force [N].
    pub force: f64,
    /// Work of the jaws since they gripped [J].
    pub work: f64,
    pub energies: Energies,
}

/// A reading of how the jaws stand now.
pub(super) fn read(jaws: &Jaws, simulator: &Simulator) -> Reading {
    let state = simulator.state();
    let (distance, force, work) = (jaws.distance(state), jaws.force(state), jaws.work());
    Reading { distance, force, work, energies: simulator.energies() }
}

/// One stroke [m], and the fabric after it.
pub(super) fn stroke(
    bench: &mut Bench,
    simulator: &mut Simulator,
    jaws: &mut Jaws,
    by: f64,
) -> Result<Reading> {
    let begin = simulator.time_s();
    let (mut moved, mut sum, mut count) = (0.0, 0.0, 0.0);
    loop {
        let part = (simulator.time_s() - begin) / INTERVAL;
        if part >= 1.0 - 1e-9 {
            break;
        }
        let place = by * ((part + simulator.scene().time_step / INTERVAL) / MOVING).min(1.0);
        jaws.open(simulator, place - moved)?;
        moved = place;
        bench.step(simulator)?;
        jaws.count_work(simulator.state());
        if part >= 1.0 - MEASURED - 1e-9 {
            (sum, count) = (sum + jaws.force(simulator.state()), count + 1.0);
        }
    }
    Ok(Reading { force: sum / f64::max(count, 1.0), ..read(jaws, simulator) })
}

/// Pulls until the force is `limit` [N], the first strokes `longest` [m]. Gives the strokes; `each` is told every reading.
pub(super) fn load(
    bench: &mut Bench,
    simulator: &mut Simulator,
    jaws: &mut Jaws,
    (limit, longest): (f64, f64),
    each: &mut dyn FnMut(&mut Bench, Reading),
) -> Result<Vec<f64>> {
    let (mut by, mut before) = (longest, 0.0);
    let mut strokes = Vec::new();
    while strokes.len() < MOST_STROKES {
        let reading = stroke(bench, simulator, jaws, by)?;
        strokes.push(by);
        each(bench, reading);
        if reading.force >= limit {
            break;
        }
        // A stroke of the next length raises the force about as the last one did.
        let rise = (reading.force - before) / limit;
        by = (by * (STEEP / rise.max(1e-9)).min(1.3)).clamp(longest / 50.0, longest);
        before = reading.force;
    }
    Ok(strokes)
}

/// Lets the jaws go back by the strokes of [`load`], until hardly any force is left of `limit` [N].
pub(super) fn unload(
    bench: &mut Bench,
    simulator: &mut Simulator,
    jaws: &mut Jaws,
    (limit, strokes): (f64, &[f64]),
    each: &mut dyn FnMut(&mut Bench, Reading),
) -> Result<()> {
    for by in strokes.iter().rev() {
        let reading = stroke(bench, simulator, jaws, -by)?;
        each(bench, reading);
        if reading.force < 1e-4 * limit {
            break;
        }
    }
    Ok(())
}
