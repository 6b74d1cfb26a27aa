//! The stages of a step, as a list that can be read: `step.rs` in dispatches.

use super::GpuError;
use super::buffers::Buffers;
use super::constants::{NARROW, SUM_SPAN, WIDE};
use super::device::GpuDevice;
use super::kernel::{Kernels, PART_STRIDE, Task};
use super::layout::Part;
use super::tables::Tables;
use crate::costs::Stage;
use crate::overshoot::SWEEPS;
use std::ops::Range;

/// The dispatches of a step, in their order.
pub(crate) struct Stages {
    /// Everything up to the linear system.
    pub prepare: Vec<Task>,
    /// In pieces that are submitted one by one: systems take a device away that is at one for too long.
    pub factorise: Vec<Vec<Task>>,
    /// Conjugate gradients begin.
    pub solve: Vec<Task>,
    /// One iteration.
    pub iterate: Vec<Task>,
    /// From the solution to velocities.
    pub settle: Vec<Task>,
    /// The new state, and whether it may follow the old.
    pub finish: Vec<Task>,
    /// Control points of the yarns as they are drawn.
    pub draw: Vec<Task>,
}

/// Operations of a factorisation that are submitted at once: a tenth of a second on a small device.
const MOST_OPERATIONS: u64 = 20_000_000_000;

/// What dispatches are made of.
struct Maker<'a> {
    gpu: &'a GpuDevice,
    kernels: &'a Kernels,
    buffers: &'a Buffers,
}

impl Maker<'_> {
    /// A dispatch over everything, or over a chunk.
    fn task(
        &self,
        stage: &str,
        chunk: Option<usize>,
        workgroups: u32,
        part: Option<u32>,
        aliases: &[(&str, &str)],
    ) -> Result<Task, GpuError> {
        self.kernels.task(self.gpu, stage, workgroups, part, |name| {
            let name = aliases.iter().find(|(from, _)| *from == name).map_or(name, |(_, to)| *to);
            self.buffers.find(chunk, name)
        })
    }

    /// A dispatch over a part of a chunk, for which the factor of another one may be needed.
    fn part_task(
        &self,
        stage: &str,
        [from, chunk]: [usize; 2],
        place: u32,
        range: &Range<u32>,
    ) -> Result<Task, GpuError> {
        self.kernels.task(self.gpu, stage, range.end - range.start, Some(place), |name| match name {
            "factor_elsewhere" if from != chunk => self.buffers.find(Some(from), "factor"),
            _ => self.buffers.find(Some(chunk), name),
        })
    }
}

impl Stages {
    /// The stages of a step of the net in `tables`, whose buffers are those, with so many springs.
    pub fn list(
        gpu: &GpuDevice,
        kernels: &Kernels,
        buffers: &Buffers,
        tables: &Tables,
        pins: u32,
    ) -> Result<Self, GpuError> {
        let maker = Maker { gpu, kernels, buffers };
        let nodes = tables.nodes.len() as u32;
        let (wide_nodes, narrow_nodes) = (nodes.div_ceil(WIDE), nodes.div_ceil(NARROW));
        let (dofs, node_spans) = (tables.dof_count(), nodes.div_ceil(SUM_SPAN));
        let (wide_dofs, dof_spans) = (dofs.div_ceil(WIDE), dofs.div_ceil(SUM_SPAN));
        let all = |stage: &str, workgroups: u32| maker.task(stage, None, workgroups, None, &[]);
        let now = |stage: &str, workgroups: u32| {
            maker.task(stage, None, workgroups, None, &[("moving", "velocity")])
        };

        let mut prepare = vec![
            now("weigh_span", node_spans)?,
            now("weigh", 1)?,
            now("spin_span", node_spans)?,
            now("measure", 1)?,
            now("race", wide_nodes)?,
            all("normal", wide_nodes)?,
            all("hold_off", narrow_nodes)?,
        ];
        if pins > 0 {
            prepare.push(maker.task("pin", None, pins.div_ceil(NARROW), Some(0), &[])?);
        }
        prepare.extend([all("held_span", node_spans)?, all("link", wide_nodes)?, all("meet", narrow_nodes)?]);
        for (c, chunk) in tables.chunks.iter().enumerate() {
            let counts = &chunk.counts;
            let each = |stage: &str, count: u32| maker.task(stage, Some(c), count.div_ceil(WIDE), None, &[]);
            prepare.extend([
                each("segment", counts.segments)?,
                each("bend", counts.bends)?,
                each("wrap", counts.wraps)?,
                each("shear", counts.shears)?,
                each("gather", 8 * counts.node_count)?,
                each("pull_at", counts.node_count)?,
            ]);
        }
        prepare.push(all("friction", narrow_nodes)?);
        for (c, chunk) in tables.chunks.iter().enumerate() {
            prepare.push(maker.task("hold", Some(c), chunk.counts.node_count.div_ceil(WIDE), None, &[])?);
        }

        // Level by level, forwards and backwards.
        let mut factorise = vec![Vec::new()];
        let mut operations = 0;
        for (c, chunk) in tables.chunks.iter().enumerate() {
            let workgroups = (8 * chunk.counts.node_count).div_ceil(WIDE);
            factorise[0].push(maker.task("fill", Some(c), workgroups, None, &[])?);
        }
        let mut sweeps: [Vec<Task>; 2] = Default::default();
        let mut place = 0;
        let mut on_part = |stage: &str, [from, chunk]: [usize; 2], range: &Range<u32>| {
            place += PART_STRIDE;
            maker.part_task(stage, [from, chunk], place, range)
        };
        for (groups, level) in tables.pattern.levels.iter().zip(&tables.pattern.changes.levels) {
            let mut tasks = Vec::new();
            for (chunk, range) in groups {
                let eliminate = on_part("eliminate", [*chunk; 2], range)?;
                for (sweep, stage) in sweeps.iter_mut().zip(["forward", "backward"]) {
                    // Products are used up by then.
                    let aliases = &[("y", "q")];
                    sweep.push(maker.task(
                        stage,
                        Some(*chunk),
                        eliminate.workgroups,
                        eliminate.part,
                        aliases,
                    )?);
                }
                tasks.push(eliminate);
            }
            for (chunk, range) in &level.below {
                tasks.push(on_part("divide", [*chunk; 2], range)?);
            }
            for (chunks, range) in &level.later {
                tasks.push(on_part("take_away", *chunks, range)?);
            }
            operations += level.operations;
            match factorise.last_mut().filter(|_| operations <= MOST_OPERATIONS) {
                Some(piece) => piece.extend(tasks),
                None => {
                    factorise.push(tasks);
                    operations = level.operations;
                }
            }
        }
        let [forward, mut backward] = sweeps;
        backward.reverse();
        let precondition = || forward.iter().chain(&backward).map(Task::again);
        let of =
            |stage: &str, a: &str, b: &str| maker.task(stage, None, dof_spans, None, &[("a", a), ("b", b)]);
        let one = |stage: &str| maker.task(stage, None, 1, None, &[("a", "r"), ("b", "z")]);

        let mut solve = vec![all("begin", wide_nodes)?];
        solve.extend(precondition());
        solve.extend([of("sum_span", "r", "z")?, one("judge_error")?, all("turn", wide_dofs)?]);

        let mut iterate = Vec::new();
        for (c, chunk) in tables.chunks.iter().enumerate() {
            iterate.push(maker.task(
                "product",
                Some(c),
                (8 * chunk.counts.node_count).div_ceil(WIDE),
                None,
                &[],
            )?);
        }
        iterate.extend([of("sum_span", "p", "q")?, one("choose_step")?, all("go", wide_dofs)?]);
        iterate.extend(precondition());
        iterate.extend([of("sum_span", "r", "z")?, one("judge_error")?, all("turn", wide_dofs)?]);

        let settle = vec![
            all("translate_span", node_spans)?,
            all("translate", 1)?,
            all("settle", wide_nodes)?,
            all("weigh_span", node_spans)?,
            all("weigh", 1)?,
            all("spin_span", node_spans)?,
            all("keep", 1)?,
        ];
        let mut finish = vec![all("advance", wide_nodes)?];
        const { assert!(SWEEPS.is_multiple_of(2), "the last sweep writes where the first reads") };
        for (round, sweep) in
            ["draw_back", "draw_far_back"].into_iter().flat_map(|r| (0..SWEEPS).map(move |s| (r, s)))
        {
            let aliases: &[_] =
                if sweep % 2 == 0 { &[] } else { &[("back", "back_next"), ("back_next", "back")] };
            for (c, chunk) in tables.chunks.iter().enumerate() {
                let workgroups = chunk.counts.node_count.div_ceil(WIDE);
                finish.push(maker.task(round, Some(c), workgroups, None, aliases)?);
            }
        }
        finish.push(all("come_back", wide_nodes)?);
        for (c, chunk) in tables.chunks.iter().enumerate() {
            finish.push(maker.task("judge", Some(c), chunk.counts.segments.div_ceil(WIDE), None, &[])?);
        }
        finish.push(all("commit", nodes.max(tables.visit_count).div_ceil(WIDE))?);
        let joints = tables.joints.len() as u32;
        let draw = vec![
            all("normal", wide_nodes)?,
            all("lay_points", wide_nodes)?,
            all("lay_middles", joints.div_ceil(WIDE))?,
        ];
        Ok(Self { prepare, factorise, solve, iterate, settle, finish, draw })
    }
}

/// The parts that dispatches over a part work on: pins, then level by level [bytes].
pub(crate) fn parts(tables: &Tables, pins: u32) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut lay = |first: u32, count: u32| {
        bytes.extend_from_slice(bytemuck::bytes_of(&Part { first, count }));
        bytes.resize(bytes.len().next_multiple_of(PART_STRIDE as usize), 0_u8);
    };
    lay(0, pins);
    for range in tables.pattern.runs() {
        lay(range.start, range.end - range.start);
    }
    bytes
}

/// The stage of the CPU's step that a dispatch belongs to.
pub(crate) fn stage_of(task: &Task) -> Stage {
    match task.stage {
        "segment" | "bend" | "wrap" | "shear" | "gather" | "pull_at" => Stage::Assembly,
        "normal" | "friction" => Stage::Friction,
        "hold_off" | "pin" | "held_span" | "link" | "meet" | "hold" => Stage::Contacts,
        "fill" | "eliminate" | "divide" | "take_away" => Stage::Factorisation,
        "begin" | "forward" | "backward" | "product" | "sum_span" | "choose_step" | "judge_error" | "go"
        | "turn" => Stage::Iterations,
        _ => Stage::Rest,
    }
}
