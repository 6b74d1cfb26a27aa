//! A net on the device: steps as submissions, and what comes back from them.

use super::GpuError;
use super::buffers::Buffers;
use super::constants::NONE;
use super::device::GpuDevice;
use super::kernel::{Kernels, Task, record};
use super::layout::{Body as BodyRecord, Params, Pin as PinRecord, Status};
use super::stages::{Stages, parts, stage_of};
use super::tables::{Tables, yarns};
use crate::costs::{Costs, Watch};
use crate::material::Material;

/// What a step says about itself.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Verdict {
    pub status: Status,
    /// The first segment that is wrong, and what is wrong with it in its lower two bits; NONE if all are right.
    pub worst: u32,
    /// Segments that turn too far.
    pub left: u32,
    /// Contacts of layers that were wanted.
    pub contacts: u32,
    /// Contacts with bodies.
    pub touching: u32,
}

impl Verdict {
    /// Iterations of conjugate gradients. The first look at the error counts as one in the status.
    pub fn iterations(&self) -> u32 {
        self.status.iterations.saturating_sub(1)
    }
}

/// A net on the device.
pub(crate) struct System {
    pub gpu: GpuDevice,
    pub kernels: Kernels,
    pub tables: Tables,
    pub buffers: Buffers,
    stages: Stages,
    /// Springs that the stages are listed for.
    pins: usize,
}

impl System {
    /// Puts `tables` on the device.
    pub fn new(
        gpu: &GpuDevice,
        kernels: Kernels,
        tables: Tables,
        materials: &[Material],
    ) -> Result<Self, GpuError> {
        let mut buffers = Buffers::new(gpu, &tables, materials);
        buffers.replace("part", gpu.upload("part", &parts(&tables, 0)));
        let stages = Stages::list(gpu, &kernels, &buffers, &tables, 0)?;
        gpu.check()?;
        Ok(Self { gpu: gpu.clone(), kernels, tables, buffers, stages, pins: 0 })
    }

    /// What is in a buffer of a chunk.
    #[cfg(test)]
    pub fn read_chunk(&self, chunk: usize, name: &str) -> Vec<f32> {
        let buffer = self.buffers.find(Some(chunk), name).unwrap();
        let parts = self.gpu.read(&[(buffer, 0..buffer.size())]).unwrap();
        bytemuck::pod_collect_to_vec(&parts[0])
    }

    /// Whether there was room for all contacts of layers.
    pub fn had_room(&self, verdict: &Verdict) -> bool {
        verdict.contacts <= self.buffers.contact_capacity
    }

    /// Numbers in the parameters that follow from the net.
    pub fn sized(&self, params: Params) -> Params {
        Params {
            node_count: self.tables.nodes.len() as u32,
            dof_count: self.tables.dof_count(),
            visit_count: self.tables.visit_count,
            cell_count: self.buffers.cell_count,
            contact_capacity: self.buffers.contact_capacity,
            joint_count: self.tables.joints.len() as u32,
            ..params
        }
    }

    /// Writes numbers to the beginning of a buffer.
    pub fn write<T: bytemuck::Pod>(&self, name: &str, data: &[T]) {
        self.gpu.queue.write_buffer(self.buffers.whole(name), 0, bytemuck::cast_slice(data));
    }

    /// Changes what follows from materials.
    pub fn set_materials(&mut self, materials: &[Material]) {
        self.write("materials", &yarns(materials));
        self.write("nodes", &self.tables.nodes);
        for (c, chunk) in self.tables.chunks.iter().enumerate() {
            if let Some(buffer) = self.buffers.find(Some(c), "shears") {
                self.gpu.queue.write_buffer(buffer, 0, bytemuck::cast_slice(&chunk.shears));
            }
        }
    }

    /// Puts bodies and springs where they are, as many as there were or others.
    pub fn set_surroundings(&mut self, bodies: &[BodyRecord], pins: &[PinRecord]) -> Result<(), GpuError> {
        let grown = [self.put("bodies", bodies), self.put("pins", pins)];
        if grown.contains(&true) || self.pins != pins.len() {
            self.pins = pins.len();
            self.list_stages()?;
        }
        Ok(())
    }

    /// Puts the distances of meshes among the bodies on the device.
    pub fn set_fields(&mut self, distances: &[f32]) -> Result<(), GpuError> {
        if self.put("fields", distances) { self.list_stages() } else { Ok(()) }
    }

    /// Writes a buffer, a larger one in its place if it has to be. Tells whether it had to.
    fn put<T: bytemuck::Pod>(&mut self, name: &'static str, data: &[T]) -> bool {
        let grows = self.buffers.whole(name).size() < size_of_val(data) as u64;
        if grows {
            self.buffers.replace(name, self.gpu.upload(name, data));
        } else {
            self.write(name, data);
        }
        grows
    }

    fn list_stages(&mut self) -> Result<(), GpuError> {
        let pins = self.pins as u32;
        self.buffers.replace("part", self.gpu.upload("part", &parts(&self.tables, pins)));
        self.stages = Stages::list(&self.gpu, &self.kernels, &self.buffers, &self.tables, pins)?;
        Ok(())
    }

    /// The stages before the linear system up to and with the last dispatch of `stage`.
    #[cfg(test)]
    pub fn prepare_until(&self, params: Params, stage: &str) {
        self.write("params", &[params]);
        let last = self.stages.prepare.iter().rposition(|t| t.stage == stage).unwrap();
        let mut submission = Submission::begin(&self.gpu, None);
        self.clear(&mut submission);
        submission.record(&self.stages.prepare[..=last]);
        submission.submit();
    }

    /// Factorises what has been prepared, and so many iterations.
    #[cfg(test)]
    pub fn solve_prepared(&self, iterations: u32) -> Result<Verdict, GpuError> {
        let mut submission = Submission::begin(&self.gpu, None);
        submission.record(self.stages.factorise.iter().flatten().chain(&self.stages.solve));
        (0..iterations).for_each(|_| submission.record(&self.stages.iterate));
        submission.submit();
        self.verdict()
    }

    /// A whole step with up to `iterations`, in one submission, and what came of it. Where costs are wanted every stage is
    /// submitted by itself and waited for.
    pub fn step(
        &self,
        params: Params,
        iterations: u32,
        costs: Option<&mut Costs>,
    ) -> Result<Verdict, GpuError> {
        self.write("params", &[params]);
        let mut submission = Submission::begin(&self.gpu, costs);
        self.clear(&mut submission);
        let Stages { prepare, factorise, solve, .. } = &self.stages;
        submission.record(prepare);
        for (i, piece) in factorise.iter().enumerate() {
            if i > 0 {
                submission.go_on();
            }
            submission.record(piece);
        }
        submission.record(solve);
        self.end_step(submission, iterations)
    }

    /// Goes on with a step whose iterations were too few.
    pub fn go_on(&self, iterations: u32, costs: Option<&mut Costs>) -> Result<Verdict, GpuError> {
        self.end_step(Submission::begin(&self.gpu, costs), iterations)
    }

    fn clear(&self, submission: &mut Submission) {
        for name in ["heads", "status", "touching", "p"] {
            submission.encoder.clear_buffer(self.buffers.whole(name), 0, None);
        }
        for factor in self.buffers.of_chunks("factor") {
            submission.encoder.clear_buffer(factor, 0, None);
        }
    }

    /// So many iterations, none once they are done; then the new state, whether it may follow the old, and if so in its place.
    fn end_step(&self, mut submission: Submission, iterations: u32) -> Result<Verdict, GpuError> {
        self.write("faults", &[NONE, 0]);
        submission.encoder.clear_buffer(self.buffers.whole("back"), 0, None);
        (0..iterations).for_each(|_| submission.record(&self.stages.iterate));
        submission.record(&self.stages.settle);
        for (from, to) in [("position", "next_position"), ("visits", "next_visits")] {
            let [from, to] = [from, to].map(|name| self.buffers.whole(name));
            submission.encoder.copy_buffer_to_buffer(from, 0, to, 0, from.size());
        }
        submission.record(&self.stages.finish);
        submission.submit();
        self.verdict()
    }

    /// Lays the control points of the yarns as they are drawn, and does what follows with them.
    pub fn lay_points(&self, params: Params, then: &[Task]) {
        self.write("params", &[params]);
        let mut submission = Submission::begin(&self.gpu, None);
        submission.record(self.stages.draw.iter().chain(then));
        submission.submit();
    }

    fn verdict(&self) -> Result<Verdict, GpuError> {
        let whole = |name: &str| {
            let buffer = self.buffers.whole(name);
            (buffer, 0..buffer.size())
        };
        let cells = 4 * u64::from(self.buffers.cell_count);
        let counters = (self.buffers.whole("heads"), cells..cells + 4);
        let all = self.gpu.read(&[whole("status"), whole("faults"), whole("touching"), counters])?;
        let word = |bytes: &[u8]| bytemuck::pod_read_unaligned::<u32>(&bytes[..4]);
        Ok(Verdict {
            status: bytemuck::pod_read_unaligned(&all[0][..size_of::<Status>()]),
            worst: word(&all[1]),
            left: word(&all[1][4..]),
            contacts: word(&all[3]),
            touching: word(&all[2]),
        })
    }

    /// What is in buffers, as numbers.
    pub fn read<const N: usize>(&self, names: [&str; N]) -> Result<[Vec<f32>; N], GpuError> {
        let buffers = names.map(|name| self.buffers.whole(name));
        let mut parts = self.gpu.read(&buffers.map(|buffer| (buffer, 0..buffer.size())))?.into_iter();
        Ok(names.map(|_| bytemuck::pod_collect_to_vec(&parts.next().unwrap_or_default())))
    }
}

/// Dispatches on their way to the device.
struct Submission<'a> {
    gpu: &'a GpuDevice,
    encoder: wgpu::CommandEncoder,
    timed: Option<(Watch, &'a mut Costs)>,
}

impl<'a> Submission<'a> {
    fn begin(gpu: &'a GpuDevice, costs: Option<&'a mut Costs>) -> Self {
        let encoder = gpu.device.create_command_encoder(&Default::default());
        Self { gpu, encoder, timed: costs.map(|costs| (Watch::start(), costs)) }
    }

    /// Adds dispatches, one after the other.
    fn record<'t>(&mut self, tasks: impl IntoIterator<Item = &'t Task>) {
        let tasks: Vec<&Task> = tasks.into_iter().collect();
        let timed = self.timed.is_some();
        for run in tasks.chunk_by(|a, b| !timed || stage_of(a) == stage_of(b)) {
            record(&mut self.encoder.begin_compute_pass(&Default::default()), run.iter().copied());
            if timed {
                self.go_on();
            }
            if let Some((watch, costs)) = &mut self.timed {
                // What went wrong shows when the verdict is read.
                let _ = self.gpu.device.poll(wgpu::PollType::wait_indefinitely());
                watch.lap(costs, stage_of(run[0]));
            }
        }
    }

    /// Submits what has been recorded, and begins again.
    fn go_on(&mut self) {
        let next = self.gpu.device.create_command_encoder(&Default::default());
        self.gpu.queue.submit([std::mem::replace(&mut self.encoder, next).finish()]);
    }

    fn submit(self) {
        self.gpu.queue.submit([self.encoder.finish()]);
    }
}
