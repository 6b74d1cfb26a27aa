//! The buffers of a net on the device and the stages of a step, as a list that can be read: `step.rs` in dispatches.

use super::GpuError;
use super::device::{GpuDevice, LIMITS};
use super::kernel::{Kernels, PART_STRIDE, Task, record};
use super::layout::{
    Body as BodyRecord, Contact, NARROW, NONE, Params, Part, Pin as PinRecord, Rigid, SUM_SPAN, Status, WIDE,
};
use super::tables::{Tables, yarns};
use crate::material::Material;
use std::collections::BTreeMap;

/// What a step says about itself.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Verdict {
    pub status: Status,
    /// The first segment that is wrong, and what is wrong with it in its lower two bits; NONE if all are right.
    pub worst: u32,
    /// Contacts of layers that were wanted.
    pub contacts: u32,
    /// Contacts with bodies.
    pub touching: u32,
}

/// A net on the device.
pub(crate) struct System {
    pub gpu: GpuDevice,
    kernels: Kernels,
    pub tables: Tables,
    buffers: BTreeMap<&'static str, wgpu::Buffer>,
    chunks: Vec<BTreeMap<&'static str, wgpu::Buffer>>,
    visit_count: u32,
    cell_count: u32,
    contact_capacity: u32,
    prepare: Vec<Task>,
    factorise: Vec<Task>,
    solve: Vec<Task>,
    iterate: Vec<Task>,
    settle: Vec<Task>,
    finish: Vec<Task>,
    draw: Vec<Task>,
}

impl System {
    /// Puts `tables` on the device.
    pub fn new(
        gpu: &GpuDevice,
        kernels: Kernels,
        tables: Tables,
        materials: &[Material],
        visit_count: usize,
    ) -> Result<Self, GpuError> {
        let nodes = tables.nodes.len() as u64;
        let dofs = u64::from(tables.dof_count());
        let visits = visit_count as u64;
        let most_contacts = LIMITS.max_storage_buffer_binding_size / size_of::<Contact>() as u64;
        let contact_capacity = (8 * nodes).min(most_contacts);
        let cell_count = nodes.next_power_of_two();
        let spans = |count: u64| count.div_ceil(u64::from(SUM_SPAN));
        let elements =
            tables.chunks.iter().map(super::tables::Chunk::element_count).max().unwrap_or_default();
        let p = &tables.pattern;
        let mut buffers = BTreeMap::new();
        let mut keep = |name: &'static str, buffer: wgpu::Buffer| {
            buffers.insert(name, buffer);
        };
        keep("params", gpu.upload("params", &[Params::default()]));
        keep("materials", gpu.upload("materials", &yarns(materials)));
        keep("nodes", gpu.upload("nodes", &tables.nodes));
        keep("stacked", gpu.upload("stacked", &tables.stacked));
        keep("pulls", gpu.upload("pulls", &tables.pulls));
        keep("around", gpu.upload("around", &tables.around));
        keep("incoming", gpu.upload("incoming", &tables.incoming));
        keep("joints", gpu.upload("joints", &tables.joints));
        keep("old_dyes", gpu.upload("old_dyes", &tables.old_dyes));
        keep("groups", gpu.upload("groups", &p.groups));
        keep("sources", gpu.upload("sources", &p.sources));
        keep("shared_rows", gpu.upload("shared_rows", &p.shared_rows));
        keep("rows", gpu.upload("rows", &p.row_dofs));
        keep("bodies", gpu.upload("bodies", &[BodyRecord::default()]));
        keep("fields", gpu.upload("fields", &[0.0_f32]));
        keep("pins", gpu.upload("pins", &[PinRecord::default()]));
        for (name, bytes) in [
            ("position", 16 * nodes),
            ("velocity", 16 * nodes),
            ("next_position", 16 * nodes),
            ("moving", 16 * nodes),
            ("normals", 16 * nodes),
            ("held", 48 * nodes),
            ("links", 4 * nodes),
            ("contacts_of", 8 * nodes),
            ("contacts", size_of::<Contact>() as u64 * contact_capacity),
            ("heads", 4 * (cell_count + 2)),
            ("visits", 16 * visits),
            ("next_visits", 16 * visits),
            ("pull", 16 * tables.stacked.len() as u64),
            ("springs", 16 * tables.stacked.len() as u64),
            ("points", 16 * u64::from(tables.point_count())),
            ("load", 8 * dofs),
            ("x", 4 * dofs),
            ("r", 4 * dofs),
            ("p", 4 * dofs),
            ("q", 4 * dofs),
            ("z", 4 * dofs),
            ("y", 4 * dofs),
            ("handed", 4 * u64::from(p.handed_count)),
            ("partial", 8 * spans(dofs)),
            ("sums", 48 * spans(nodes)),
            ("held_sums", 32 * spans(nodes)),
            ("elements", 16 * u64::from(elements)),
            ("rigid", size_of::<Rigid>() as u64),
            ("status", size_of::<Status>() as u64),
            ("worst", 4),
            ("touching", 4),
            ("shift", 16),
            ("nothing", 16),
        ] {
            keep(name, gpu.buffer(name, bytes));
        }
        let chunks = tables.chunks.iter().map(|c| {
            BTreeMap::from([
                ("counts", gpu.upload("counts", &[c.counts])),
                ("segments", gpu.upload("segments", &c.segments)),
                ("bends", gpu.upload("bends", &c.bends)),
                ("wraps", gpu.upload("wraps", &c.wraps)),
                ("shears", gpu.upload("shears", &c.shears)),
                ("entries", gpu.upload("entries", &c.entries)),
                ("blocks", gpu.upload("blocks", &c.blocks)),
                ("values", gpu.buffer("values", 4 * u64::from(c.value_count))),
                ("factor", gpu.buffer("factor", 4 * c.factor_count)),
            ])
        });
        let chunks: Vec<_> = chunks.collect();
        let mut system = Self {
            gpu: gpu.clone(),
            kernels,
            tables,
            buffers,
            chunks,
            visit_count: visit_count as u32,
            cell_count: cell_count as u32,
            contact_capacity: contact_capacity as u32,
            prepare: Vec::new(),
            factorise: Vec::new(),
            solve: Vec::new(),
            iterate: Vec::new(),
            settle: Vec::new(),
            finish: Vec::new(),
            draw: Vec::new(),
        };
        system.lay_parts(0);
        system.list_stages(0)?;
        gpu.check()?;
        Ok(system)
    }

    /// Bytes of the largest buffer that is not cut into chunks, elements left out, whose results are those of one chunk at a time.
    #[cfg(test)]
    pub fn largest_whole(&self) -> u64 {
        let whole = self.buffers.iter().filter(|(name, _)| !["elements", "contacts", "part"].contains(*name));
        whole.map(|(_, buffer)| buffer.size()).max().unwrap_or_default()
    }

    /// What is in a buffer of a chunk.
    #[cfg(test)]
    pub fn read_chunk(&self, chunk: usize, name: &str) -> Vec<f32> {
        let buffer = &self.chunks[chunk][name];
        let parts = self.gpu.read(&[(buffer, 0..buffer.size())]).unwrap();
        bytemuck::pod_collect_to_vec(&parts[0])
    }

    /// Whether there was room for all contacts of layers.
    pub fn had_room(&self, verdict: &Verdict) -> bool {
        verdict.contacts <= self.contact_capacity
    }

    /// Numbers in the parameters that follow from the net.
    pub fn sized(&self, params: Params) -> Params {
        Params {
            node_count: self.tables.nodes.len() as u32,
            dof_count: self.tables.dof_count(),
            visit_count: self.visit_count,
            cell_count: self.cell_count,
            contact_capacity: self.contact_capacity,
            joint_count: self.tables.joints.len() as u32,
            ..params
        }
    }

    /// Writes numbers to the beginning of a buffer.
    pub fn write<T: bytemuck::Pod>(&self, name: &str, data: &[T]) {
        if let Some(buffer) = self.buffers.get(name) {
            self.gpu.queue.write_buffer(buffer, 0, bytemuck::cast_slice(data));
        }
    }

    /// Changes what follows from materials.
    pub fn set_materials(&mut self, materials: &[Material]) {
        self.write("materials", &yarns(materials));
        self.write("nodes", &self.tables.nodes);
        for (chunk, buffers) in self.tables.chunks.iter().zip(&self.chunks) {
            self.gpu.queue.write_buffer(&buffers["shears"], 0, bytemuck::cast_slice(&chunk.shears));
        }
    }

    /// Changes bodies and pins.
    pub fn set_surroundings(
        &mut self,
        bodies: &[BodyRecord],
        fields: Option<&[f32]>,
        pins: &[PinRecord],
        most_pins: u32,
    ) -> Result<(), GpuError> {
        let mut stale = false;
        for (name, bytes) in [
            ("bodies", size_of_val(bodies)),
            ("fields", fields.map_or(0, size_of_val)),
            ("pins", most_pins as usize * size_of::<PinRecord>()),
        ] {
            if self.buffers[name].size() < bytes as u64 {
                self.buffers.insert(name, self.gpu.buffer(name, bytes as u64));
                stale = true;
            }
        }
        self.write("bodies", bodies);
        self.write("pins", pins);
        if let Some(fields) = fields {
            self.write("fields", fields);
        }
        if stale || self.prepare.iter().all(|t| t.part.is_none()) == (most_pins > 0) {
            self.lay_parts(most_pins);
            self.list_stages(most_pins)?;
        }
        Ok(())
    }

    /// The parts that dispatches over a part work on: pins, then level by level.
    fn lay_parts(&mut self, pins: u32) {
        let mut bytes = Vec::new();
        let mut lay = |first: u32, count: u32| {
            bytes.extend_from_slice(bytemuck::bytes_of(&Part { first, count }));
            bytes.resize(bytes.len().next_multiple_of(PART_STRIDE as usize), 0_u8);
        };
        lay(0, pins);
        for (_, range) in self.tables.pattern.levels.iter().flatten() {
            lay(range.start, range.end - range.start);
        }
        self.buffers.insert("part", self.gpu.upload("part", &bytes));
    }

    /// A dispatch over everything, or over a chunk.
    fn task(
        &self,
        stage: &str,
        chunk: Option<usize>,
        workgroups: u32,
        part: Option<u32>,
        aliases: &[(&str, &str)],
    ) -> Result<Task, GpuError> {
        self.kernels.task(&self.gpu, stage, workgroups, part, |name| {
            let name = aliases.iter().find(|(from, _)| *from == name).map_or(name, |(_, to)| *to);
            if name == "factor_before" {
                let before = chunk.and_then(|c| c.checked_sub(1)).and_then(|c| self.chunks[c].get("factor"));
                return before.or_else(|| self.buffers.get("nothing"));
            }
            chunk.and_then(|c| self.chunks[c].get(name)).or_else(|| self.buffers.get(name))
        })
    }

    /// The stages of a step, in their order.
    fn list_stages(&mut self, pins: u32) -> Result<(), GpuError> {
        let nodes = self.tables.nodes.len() as u32;
        let (wide_nodes, narrow_nodes) = (nodes.div_ceil(WIDE), nodes.div_ceil(NARROW));
        let (dofs, node_spans) = (self.tables.dof_count(), nodes.div_ceil(SUM_SPAN));
        let (wide_dofs, dof_spans) = (dofs.div_ceil(WIDE), dofs.div_ceil(SUM_SPAN));
        let all = |stage: &str, workgroups: u32| self.task(stage, None, workgroups, None, &[]);
        let now = |stage: &str, workgroups: u32| {
            self.task(stage, None, workgroups, None, &[("moving", "velocity")])
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
            prepare.push(self.task("pin", None, pins.div_ceil(NARROW), Some(0), &[])?);
        }
        prepare.extend([all("held_span", node_spans)?, all("link", wide_nodes)?, all("meet", narrow_nodes)?]);
        for (c, chunk) in self.tables.chunks.iter().enumerate() {
            let counts = &chunk.counts;
            let each = |stage: &str, count: u32| self.task(stage, Some(c), count.div_ceil(WIDE), None, &[]);
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
        for (c, chunk) in self.tables.chunks.iter().enumerate() {
            prepare.push(self.task("hold", Some(c), chunk.counts.node_count.div_ceil(WIDE), None, &[])?);
        }

        // Level by level, forwards and backwards.
        let mut sweeps: [Vec<Task>; 3] = Default::default();
        let mut place = 0;
        for (chunk, range) in self.tables.pattern.levels.iter().flatten() {
            place += PART_STRIDE;
            for (sweep, stage) in sweeps.iter_mut().zip(["factorise", "forward", "backward"]) {
                sweep.push(self.task(stage, Some(*chunk), range.end - range.start, Some(place), &[])?);
            }
        }
        let [factorise, forward, mut backward] = sweeps;
        backward.reverse();
        let precondition = || forward.iter().chain(&backward).map(Task::again);
        let of =
            |stage: &str, a: &str, b: &str| self.task(stage, None, dof_spans, None, &[("a", a), ("b", b)]);
        let one = |stage: &str| self.task(stage, None, 1, None, &[("a", "r"), ("b", "z")]);

        let mut solve = vec![all("begin", wide_nodes)?];
        solve.extend(precondition());
        solve.extend([of("sum_span", "r", "z")?, one("judge_error")?, all("turn", wide_dofs)?]);

        let mut iterate = Vec::new();
        for (c, chunk) in self.tables.chunks.iter().enumerate() {
            iterate.push(self.task(
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
        for (c, chunk) in self.tables.chunks.iter().enumerate() {
            finish.push(self.task("judge", Some(c), chunk.counts.segments.div_ceil(WIDE), None, &[])?);
        }
        finish.push(all("commit", nodes.max(self.visit_count).div_ceil(WIDE))?);
        let joints = self.tables.joints.len() as u32;
        let draw = vec![
            all("normal", wide_nodes)?,
            all("lay_points", wide_nodes)?,
            all("lay_middles", joints.div_ceil(WIDE))?,
        ];
        self.draw = draw;
        (self.prepare, self.factorise, self.solve) = (prepare, factorise, solve);
        (self.iterate, self.settle, self.finish) = (iterate, settle, finish);
        Ok(())
    }

    /// The first half of a step: everything up to the linear system and its preconditioner.
    pub fn prepare(&self, encoder: &mut wgpu::CommandEncoder) {
        for name in ["heads", "status", "touching", "p"] {
            encoder.clear_buffer(&self.buffers[name], 0, None);
        }
        let mut pass = encoder.begin_compute_pass(&Default::default());
        record(&mut pass, &self.prepare);
    }

    /// The stages before the linear system up to and with the last dispatch of `stage`.
    #[cfg(test)]
    pub fn prepare_until(&self, params: Params, stage: &str) {
        self.write("params", &[params]);
        let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
        for name in ["heads", "status", "touching", "p"] {
            encoder.clear_buffer(&self.buffers[name], 0, None);
        }
        let last = self.prepare.iter().rposition(|t| t.stage == stage).unwrap();
        let mut pass = encoder.begin_compute_pass(&Default::default());
        record(&mut pass, &self.prepare[..=last]);
        drop(pass);
        self.gpu.queue.submit([encoder.finish()]);
    }

    /// Factorises what has been prepared, and so many iterations.
    #[cfg(test)]
    pub fn solve_prepared(&self, iterations: u32) -> Result<Verdict, GpuError> {
        let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
        self.solve(&mut encoder);
        self.iterate(&mut encoder, iterations);
        self.gpu.queue.submit([encoder.finish()]);
        self.verdict()
    }

    /// Factorises conjugate gradients.
    pub fn solve(&self, encoder: &mut wgpu::CommandEncoder) {
        let mut pass = encoder.begin_compute_pass(&Default::default());
        record(&mut pass, &self.factorise);
        record(&mut pass, &self.solve);
    }

    /// So many iterations; none once they are done.
    pub fn iterate(&self, encoder: &mut wgpu::CommandEncoder, count: u32) {
        let mut pass = encoder.begin_compute_pass(&Default::default());
        (0..count).for_each(|_| record(&mut pass, &self.iterate));
    }

    /// The second half: the new state, whether it may follow the old, and if so in its place.
    pub fn finish(&self, encoder: &mut wgpu::CommandEncoder) {
        let mut pass = encoder.begin_compute_pass(&Default::default());
        record(&mut pass, &self.settle);
        drop(pass);
        for (from, to) in [("position", "next_position"), ("visits", "next_visits")] {
            let (from, to) = (&self.buffers[from], &self.buffers[to]);
            encoder.copy_buffer_to_buffer(from, 0, to, 0, from.size());
        }
        let mut pass = encoder.begin_compute_pass(&Default::default());
        record(&mut pass, &self.finish);
    }

    /// A whole step with up to `iterations`, in one submission, and what came of it.
    pub fn step(&self, params: Params, iterations: u32) -> Result<Verdict, GpuError> {
        self.write("params", &[params]);
        self.write("worst", &[NONE]);
        let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
        self.prepare(&mut encoder);
        self.solve(&mut encoder);
        self.iterate(&mut encoder, iterations);
        self.finish(&mut encoder);
        self.gpu.queue.submit([encoder.finish()]);
        self.verdict()
    }

    /// Goes on with a step whose iterations were too few.
    pub fn go_on(&self, iterations: u32) -> Result<Verdict, GpuError> {
        self.write("worst", &[NONE]);
        let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
        self.iterate(&mut encoder, iterations);
        self.finish(&mut encoder);
        self.gpu.queue.submit([encoder.finish()]);
        self.verdict()
    }

    /// Control points of the yarns as they are drawn.
    pub fn points(&self, params: Params) -> Result<Vec<f32>, GpuError> {
        self.write("params", &[params]);
        let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
        let mut pass = encoder.begin_compute_pass(&Default::default());
        record(&mut pass, &self.draw);
        drop(pass);
        self.gpu.queue.submit([encoder.finish()]);
        let [points] = self.read(["points"])?;
        Ok(points)
    }

    fn verdict(&self) -> Result<Verdict, GpuError> {
        let whole = |name: &str| (&self.buffers[name], 0..self.buffers[name].size());
        let cells = 4 * u64::from(self.cell_count);
        let counters = (&self.buffers["heads"], cells..cells + 4);
        let all = self.gpu.read(&[whole("status"), whole("worst"), whole("touching"), counters])?;
        let word = |bytes: &[u8]| bytemuck::pod_read_unaligned::<u32>(&bytes[..4]);
        Ok(Verdict {
            status: bytemuck::pod_read_unaligned(&all[0][..size_of::<Status>()]),
            worst: word(&all[1]),
            contacts: word(&all[3]),
            touching: word(&all[2]),
        })
    }

    /// What is in buffers, as numbers.
    pub fn read<const N: usize>(&self, names: [&str; N]) -> Result<[Vec<f32>; N], GpuError> {
        let wanted = names.map(|name| (&self.buffers[name], 0..self.buffers[name].size()));
        let mut parts = self.gpu.read(&wanted)?.into_iter();
        Ok(names.map(|_| bytemuck::pod_collect_to_vec(&parts.next().unwrap_or_default())))
    }
}
