//! The device that simulates, and what can go wrong with it.

use super::kernel::{Kernels, SOURCES};
use std::ops::Range;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

/// Why the GPU can't simulate, or no longer. The state of the last good step is kept, so the work can go on on the CPU.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum GpuError {
    /// The machine has no adapter at all.
    #[error("there is no GPU here, nor a software one")]
    NoAdapter,
    /// The adapter gives no device.
    #[error("the GPU gives no device: {0}")]
    NoDevice(String),
    /// The device has been taken away, or has crashed.
    #[error("the GPU was lost: {0}")]
    Lost(String),
    /// Its memory is used up.
    #[error("the GPU has not enough memory: {0}")]
    OutOfMemory(String),
    /// The device refused something; a mistake in this program.
    #[error("the GPU refused: {0}")]
    Refused(String),
    /// A net that the kernels are not made for.
    #[error("the GPU can't simulate this: {0}")]
    Unsupported(String),
}

/// A device with its queue. Cheap to clone.
#[derive(Clone)]
pub struct GpuDevice {
    pub(crate) device: wgpu::Device,
    pub(crate) queue: wgpu::Queue,
    /// Name, backend and kind of the adapter.
    pub adapter: wgpu::AdapterInfo,
    /// Whether somebody else draws on it.
    pub(crate) draws: bool,
    /// What went wrong first.
    failure: Arc<Mutex<Option<GpuError>>>,
    /// Compiled when they are first needed, once for all simulations.
    kernels: Arc<OnceLock<Result<Kernels, GpuError>>>,
}

impl GpuDevice {
    /// Opens the best adapter of the machine; a software one will do. Asks for no more than every WebGPU device grants, but for the largest
    /// bindings there are.
    ///
    /// # Errors
    /// No adapter, or one without compute shaders.
    pub fn open() -> Result<Self, GpuError> {
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle_from_env());
        let options = wgpu::RequestAdapterOptions {
            power_preference: wgpu::PowerPreference::HighPerformance,
            ..Default::default()
        };
        let adapter =
            pollster::block_on(instance.request_adapter(&options)).map_err(|_| GpuError::NoAdapter)?;
        let descriptor = wgpu::DeviceDescriptor {
            label: Some("simulation"),
            required_limits: wgpu::Limits {
                max_storage_buffer_binding_size: adapter.limits().max_storage_buffer_binding_size,
                max_buffer_size: adapter.limits().max_buffer_size,
                ..LIMITS
            },
            ..Default::default()
        };
        let (device, queue) = pollster::block_on(adapter.request_device(&descriptor))
            .map_err(|error| GpuError::NoDevice(error.to_string()))?;
        Ok(Self { draws: false, ..Self::of(adapter.get_info(), &device, &queue)? })
    }

    /// Simulates on a device that somebody else made and draws on. What goes wrong on it is taken down
    /// here from now on.
    ///
    /// # Errors
    /// Its limits are lower than those of every WebGPU device.
    pub fn of(
        adapter: wgpu::AdapterInfo,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
    ) -> Result<Self, GpuError> {
        if !LIMITS.check_limits(&device.limits()) {
            return Err(GpuError::NoDevice("its limits are too low for compute shaders".to_owned()));
        }
        let failure = Arc::new(Mutex::new(None));
        let failed = Arc::clone(&failure);
        device.set_device_lost_callback(move |_, message| keep(&failed, GpuError::Lost(message)));
        let failed = Arc::clone(&failure);
        device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| {
            let error = match error {
                wgpu::Error::OutOfMemory { source } => GpuError::OutOfMemory(source.to_string()),
                other => GpuError::Refused(other.to_string()),
            };
            keep(&failed, error);
        }));
        let (device, queue) = (device.clone(), queue.clone());
        Ok(Self { device, queue, adapter, draws: true, failure, kernels: Arc::default() })
    }

    /// Whether the processor itself does the work, which it can do better without the detour.
    pub fn is_software(&self) -> bool {
        self.adapter.device_type == wgpu::DeviceType::Cpu
    }

    /// Numbers that a binding may have.
    pub(crate) fn largest_binding(&self) -> u64 {
        let limits = self.device.limits();
        // Buffers are made of sixteens of bytes.
        limits.max_storage_buffer_binding_size.min(limits.max_buffer_size).min(FARTHEST) / 16 * 4
    }

    /// The kernels, compiled.
    pub(crate) fn kernels(&self) -> Result<Kernels, GpuError> {
        self.kernels.get_or_init(|| Kernels::compile(self, SOURCES)).clone()
    }

    /// Takes the device away, as a driver does that crashes.
    #[cfg(test)]
    pub(crate) fn destroy(&self) {
        self.device.destroy();
    }

    /// Whether nothing has gone wrong since this was last asked. A lost device stays lost.
    pub(crate) fn check(&self) -> Result<(), GpuError> {
        // A lost device first refuses everything, and then says why.
        let _ = self.device.poll(wgpu::PollType::Poll);
        let mut failure = self.failure.lock().unwrap_or_else(PoisonError::into_inner);
        match failure.take() {
            Some(error) => {
                *failure = Some(error.clone()).filter(|e| matches!(e, GpuError::Lost(_)));
                Err(error)
            }
            None => Ok(()),
        }
    }

    /// A buffer that kernels read and write.
    pub(crate) fn buffer(&self, name: &str, bytes: u64) -> wgpu::Buffer {
        let size = bytes.max(16).next_multiple_of(16);
        let usage = wgpu::BufferUsages::STORAGE
            | wgpu::BufferUsages::UNIFORM
            | wgpu::BufferUsages::COPY_DST
            | wgpu::BufferUsages::COPY_SRC;
        self.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some(name),
            size,
            usage,
            mapped_at_creation: false,
        })
    }

    /// A buffer filled with `data`.
    pub(crate) fn upload<T: bytemuck::Pod>(&self, name: &str, data: &[T]) -> wgpu::Buffer {
        let buffer = self.buffer(name, size_of_val(data) as u64);
        self.queue.write_buffer(&buffer, 0, bytemuck::cast_slice(data));
        buffer
    }

    /// What is in parts of buffers, one after the other. Waits for all that was submitted before.
    pub(crate) fn read(&self, buffers: &[(&wgpu::Buffer, Range<u64>)]) -> Result<Vec<Vec<u8>>, GpuError> {
        let size = |range: &Range<u64>| (range.end - range.start).next_multiple_of(16);
        let total: u64 = buffers.iter().map(|(_, range)| size(range)).sum();
        let staging = self.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("read back"),
            size: total.max(16),
            usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let mut encoder = self.device.create_command_encoder(&Default::default());
        let mut at = 0;
        for (buffer, range) in buffers {
            encoder.copy_buffer_to_buffer(buffer, range.start, &staging, at, range.end - range.start);
            at += size(range);
        }
        self.queue.submit([encoder.finish()]);
        let slice = staging.slice(..);
        slice.map_async(wgpu::MapMode::Read, |_| {});
        if let Err(error) = self.device.poll(wgpu::PollType::wait_indefinitely()) {
            self.check()?;
            return Err(GpuError::Lost(error.to_string()));
        }
        self.check()?;
        let mapped = slice.get_mapped_range().map_err(|error| GpuError::Lost(error.to_string()))?;
        let mut at = 0;
        let mut parts = Vec::with_capacity(buffers.len());
        for (_, range) in buffers {
            parts.push(mapped[at as usize..(at + range.end - range.start) as usize].to_vec());
            at += size(range);
        }
        Ok(parts)
    }
}

/// The limits that every WebGPU device has: 128 MiB a binding, 256 MiB a buffer, eight storage buffers a kernel, 16 KiB of
/// workgroup memory.
pub(crate) const LIMITS: wgpu::Limits = wgpu::Limits::defaults();

/// Size of a buffer up to which 32 bits count its bytes, for whoever does, with a sign [bytes].
const FARTHEST: u64 = 1 << 31;

/// Keeps the first failure, or the loss of the device, from which the others follow.
fn keep(failure: &Mutex<Option<GpuError>>, error: GpuError) {
    match &error {
        // A mistake in this program, perhaps in what else it does with the device.
        GpuError::Refused(_) => tracing::error!(%error),
        _ => tracing::warn!(%error),
    }
    let mut kept = failure.lock().unwrap_or_else(PoisonError::into_inner);
    if kept.is_none() || matches!(error, GpuError::Lost(_)) {
        *kept = Some(error);
    }
}
