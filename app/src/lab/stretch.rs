//! Force against extension (Cirio et al., Fig. 11): three regimes, and which energy carries each.
//!
//! The usual fabric is a 2 × 2 rib, pulled along the course. What the jaws do in a regime is set against what each energy gains
//! over it; what none of them gains is lost to friction and damping. The regimes come from the force alone
//! (`regimes`), so that the energies can contradict the paper.
//!
//! They bear it out: ridges flatten against wrapping (bending gives energy back meanwhile), loops straighten against
//! bending, yarn stretches. What the paper does not say is how much friction takes: in the second regime, where yarn slides
//! through its contacts, more than any one energy. Springs of friction that stick hold a part of the third.

use super::bench::Bench;
use super::jaws::Jaws;
use super::pull::{Reading, load, read, unload};
use super::regimes::{Regime, three};
use super::report::{Line, Plot, Table};
use super::specimen::Specimen;
use super::{Direction, Setup};
use anyhow::{Context, Result};
use render::NamedView;
use sim_core::{Energies, Scene};

/// Stitches and rows of the usual fabric.
const SIZE: [usize; 2] = [20, 12];
/// Force at which loading ends, for each gripped node [N].
const LIMIT: f64 = 0.3;
/// The longest stroke, over the laid length.
const STROKE: f64 = 0.025;
/// Time to relax before [s].
const RELAXING: f64 = 1.0;

/// One of the energies.
type Kind = fn(&Energies) -> f64;

/// The energies by name.
const KINDS: [(&str, Kind); 5] = [
    ("wrapping", |e| e.wrap),
    ("bending", |e| e.bend),
    ("stretch", |e| e.stretch),
    ("spacing", |e| e.spacing),
    ("sticking", |e| e.sticking),
];

/// The readings of loading and of unloading.
type Curve = [Vec<Reading>; 2];

/// Loads and unloads.
pub fn run(bench: &mut Bench, setup: &Setup) -> Result<()> {
    let specimen = match &setup.pattern {
        Some(text) => Specimen::of_pattern(text)?,
        None => Specimen::rectangle(SIZE[0], SIZE[1], |s, _| s / 2 % 2 == 1)?,
    };
    bench.plan(20.0);
    let curve = measure(bench, &specimen, setup.direction)?;
    tell(bench, setup.direction, &curve)
}

/// Relaxes a specimen, loads and unloads it.
fn measure(bench: &mut Bench, specimen: &Specimen, direction: Direction) -> Result<Curve> {
    let mut simulator = specimen.simulate(Scene::empty())?;
    let laid = Jaws::grip(specimen, simulator.state(), direction)?.distance(simulator.state());
    bench.run(&mut simulator, RELAXING)?;
    bench.report.pictures.push(specimen.picture("relaxed", NamedView::Front, &simulator));
    let mut jaws = Jaws::grip(specimen, simulator.state(), direction)?;
    let limit = LIMIT * jaws.held();
    let mut curve = [vec![read(&jaws, &simulator)], Vec::new()];
    let strokes = load(bench, &mut simulator, &mut jaws, (limit, STROKE * laid), &mut |bench, reading| {
        curve[0].push(reading);
        bench.report.plots = vec![force_plot(direction, &curve, None)];
    })?;
    bench.report.pictures.push(specimen.picture("pulled", NamedView::Front, &simulator));
    curve[1].extend(curve[0].last().copied());
    unload(bench, &mut simulator, &mut jaws, (limit, &strokes), &mut |bench, reading| {
        curve[1].push(reading);
        bench.report.plots = vec![force_plot(direction, &curve, None)];
    })?;
    bench.report.pictures.push(specimen.picture("unloaded", NamedView::Front, &simulator));
    Ok(curve)
}

/// The regimes of loading. Points are counted without the first, which is the grip before any pull.
fn regimes([loading, _]: &Curve) -> Result<[Regime; 3]> {
    let first = loading[0].distance;
    let points: Vec<[f64; 2]> = loading[1..].iter().map(|r| [r.distance - first, r.force]).collect();
    three(&points).context("the force rose too steeply for three regimes to be told apart")
}

/// Work of the jaws from the first reading to the last [J].
fn work(readings: &[Reading]) -> f64 {
    readings.last().map_or(0.0, |r| r.work) - readings.first().map_or(0.0, |r| r.work)
}

/// Part of the work over some readings that each energy gains.
fn shares(part: &[Reading]) -> [f64; KINDS.len()] {
    let (begin, end) = (&part[0].energies, &part[part.len() - 1].energies);
    KINDS.map(|(_, of)| (of(end) - of(begin)) / work(part))
}

/// Figures, tables and plots.
fn tell(bench: &mut Bench, direction: Direction, curve: &Curve) -> Result<()> {
    let [loading, unloading] = curve;
    let regimes = regimes(curve)?;
    let report = &mut bench.report;
    for (number, regime) in (1..).zip(&regimes) {
        report.figure(format!("slope_{number}"), regime.slope);
    }
    report.figure("loading_work_j", work(loading));
    report.figure("unloading_work_j", -work(unloading));
    report.figure("rest_length_mm", 1e3 * loading[0].distance);
    report.figure("largest_force_n", loading.iter().map(|r| r.force).fold(0.0, f64::max));
    for (number, regime) in (1..).zip(&regimes) {
        let part = &loading[1..][regime.first..=regime.last];
        let [begin, end] = [&part[0], &part[part.len() - 1]].map(|r| 1e3 * r.distance);
        report.figure(format!("begin_{number}_mm"), begin);
        report.figure(format!("work_{number}_j"), work(part));
        let shares = shares(part);
        let lost = 1.0 - shares.iter().sum::<f64>();
        let mut named: Vec<(&str, f64)> = KINDS.iter().map(|k| k.0).zip(shares).collect();
        named.push(("lost", lost));
        named.iter().for_each(|(name, share)| report.figure(format!("{name}_share_{number}"), *share));
        named.sort_by(|a, b| b.1.total_cmp(&a.1));
        let told: Vec<String> = named.iter().map(|(n, s)| format!("{n} {:.0} %", 100.0 * s)).collect();
        report.remarks.push(format!(
            "regime {number}: {begin:.0} to {end:.0} mm, {:.3} N/m; where the work goes: {}",
            regime.slope,
            told.join(", ")
        ));
    }
    let row = |unloads: f64| {
        move |r: &Reading| {
            let e = r.energies;
            vec![
                unloads,
                1e3 * r.distance,
                r.force,
                e.stretch,
                e.bend,
                e.wrap,
                e.spacing,
                e.sticking,
                e.kinetic,
            ]
        }
    };
    report.tables.push(Table {
        name: "stretch",
        columns: vec![
            "unloading",
            "length_mm",
            "force_n",
            "work_j",
            "stretch_j",
            "bend_j",
            "wrap_j",
            "spacing_j",
            "sticking_j",
            "kinetic_j",
        ],
        rows: loading.iter().map(row(0.0)).chain(unloading.iter().map(row(1.0))).collect(),
    });
    let all = force_plot(direction, curve, Some(&regimes));
    report.plots = vec![small_forces(&all), all, energy_plot(loading)];
    Ok(())
}

fn force_plot(direction: Direction, [loading, unloading]: &Curve, regimes: Option<&[Regime; 3]>) -> Plot {
    let points = |readings: &[Reading]| readings.iter().map(|r| [1e3 * r.distance, r.force]).collect();
    let mut lines = vec![Line::new("loading", points(loading)), Line::new("unloading", points(unloading))];
    let first = loading[0].distance;
    for (number, regime) in (1..).zip(regimes.into_iter().flatten()) {
        let at = |i: usize| {
            let x = loading[1 + i].distance;
            [1e3 * x, regime.offset + regime.slope * (x - first)]
        };
        let name = format!("regime {number}: {:.3} N/m", regime.slope);
        lines.push(Line::dashed(name, vec![at(regime.first), at(regime.last)]));
    }
    let way = match direction {
        Direction::Course => "along the course",
        Direction::Wale => "along the wale",
    };
    let title = format!("Force against length, {way}");
    Plot { name: "force", title, x: "length [mm]", y: "force [N]", lines }
}

/// The lower end of a plot of forces, where the first regime can be seen.
fn small_forces(plot: &Plot) -> Plot {
    /// Part of the largest force that shows.
    const SHOWN: f64 = 0.05;
    let most = SHOWN * plot.lines[0].points.iter().map(|p| p[1]).fold(0.0, f64::max);
    let mut small =
        Plot { name: "small-forces", title: format!("{}: small forces", plot.title), ..plot.clone() };
    for line in &mut small.lines {
        line.points.retain(|p| p[1] <= most);
    }
    small.lines.retain(|line| line.points.len() > 1);
    small
}

fn energy_plot(loading: &[Reading]) -> Plot {
    let gains = |name: &str, of: &dyn Fn(&Reading) -> f64| {
        Line::new(name, loading.iter().map(|r| [1e3 * r.distance, 1e3 * (of(r) - of(&loading[0]))]).collect())
    };
    let mut lines: Vec<Line> = KINDS.iter().map(|(name, of)| gains(name, &|r| of(&r.energies))).collect();
    lines.push(Line { dashed: true, ..gains("work of the jaws", &|r| r.work) });
    let title = "Energy gained while loading".to_owned();
    Plot { name: "energy", title, x: "length [mm]", y: "energy [mJ]", lines }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::ops::ControlFlow;

    /// Force at a length [N], between two readings.
    fn force_at(readings: &[Reading], length: f64) -> Option<f64> {
        readings.windows(2).find_map(|pair| {
            let [a, b] = [pair[0].distance, pair[1].distance];
            let part = (length - a) / (b - a);
            (0.0..=1.0).contains(&part).then(|| pair[0].force + part * (pair[1].force - pair[0].force))
        })
    }

    /// Fig. 11 of the paper, on a small piece.
    #[test]
    fn rib_meets_wrapping_then_bending_then_stretch_and_unloads_below() {
        let mut watch = |_: f64, _: &super::super::Report| ControlFlow::Continue(());
        let mut bench = Bench::new(&mut watch);
        let rib = Specimen::rectangle(8, 5, |s, _| s / 2 % 2 == 1).unwrap();
        let curve = measure(&mut bench, &rib, Direction::Course).unwrap();
        let regimes = regimes(&curve).unwrap();
        let parts = regimes.map(|r| shares(&curve[0][1..][r.first..=r.last]));
        println!("{:?}\n{parts:.2?}", regimes.map(|r| r.slope));
        assert!(regimes.windows(2).all(|r| r[1].slope > 5.0 * r[0].slope));
        let carries = |part: [f64; KINDS.len()]| {
            (0..3).max_by(|a, b| part[*a].total_cmp(&part[*b])).map(|k| KINDS[k].0)
        };
        assert_eq!(parts.map(carries), [Some("wrapping"), Some("bending"), Some("stretch")]);
        let [loading, unloading] = &curve;
        for reading in &unloading[2..] {
            let Some(load) = force_at(loading, reading.distance) else { continue };
            assert!(reading.force < 1.001 * load, "{} N, loading {load} N", reading.force);
        }
        assert!(-work(unloading) < 0.95 * work(loading));
    }
}
