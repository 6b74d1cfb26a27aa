//! Which solver a simulation is to have.
//!
//! # Practice
//! A direct solution is the faster for little fabric, conjugate gradients for more (`solver/mod.rs`). A step on the GPU is
//! some hundred dispatches at least, each of some microseconds, and the longer chains of its factorisation leave most of a large GPU idle in little
//! fabric: it has something to gain where the CPU takes tens of milliseconds. A software adapter never has.

use crate::gpu::{GpuDevice, GpuError};
use crate::solver::Method;
use std::sync::{Arc, OnceLock};

/// Nodes of a net from which on a GPU is taken; four a loop.
const LARGE: usize = 4_000;

/// Which solver a simulation is to have.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum SolverChoice {
    /// The one that is fastest for the fabric on this machine.
    #[default]
    Auto,
    /// The faster one on the CPU.
    Cpu,
    /// A complete factorisation, on the CPU.
    Direct,
    /// Conjugate gradients, on the CPU.
    Iterative,
    /// Conjugate gradients on the GPU, if only a software one.
    Gpu,
}

impl SolverChoice {
    /// How to solve on the CPU; none for the faster way.
    pub(crate) fn method(self) -> Option<Method> {
        match self {
            Self::Auto | Self::Cpu | Self::Gpu => None,
            Self::Direct => Some(Method::Direct),
            Self::Iterative => Some(Method::Iterative),
        }
    }

    /// Whether a net of so many nodes is to be simulated on the GPU.
    pub(crate) fn is_gpu(self, gpu: &SharedGpu, node_count: usize) -> bool {
        match self {
            Self::Gpu => true,
            Self::Auto => node_count >= LARGE && gpu.get().is_ok_and(|gpu| !gpu.is_software()),
            Self::Cpu | Self::Direct | Self::Iterative => false,
        }
    }
}

/// The GPU that simulations share: one that is given, or the best of the machine, opened when it is first wanted.
#[derive(Clone, Default)]
pub struct SharedGpu {
    given: Option<(wgpu::AdapterInfo, wgpu::Device, wgpu::Queue)>,
    opened: Arc<OnceLock<Result<GpuDevice, GpuError>>>,
}

impl SharedGpu {
    /// The device that somebody else draws on, so that what is simulated there need not be fetched to be drawn; not where the
    /// processor does the drawing, which would have to wait for the simulation.
    pub fn of(adapter: &wgpu::AdapterInfo, device: &wgpu::Device, queue: &wgpu::Queue) -> Self {
        let is_software = adapter.device_type == wgpu::DeviceType::Cpu;
        let given = (!is_software).then(|| (adapter.clone(), device.clone(), queue.clone()));
        Self { given, ..Self::default() }
    }

    /// The device.
    ///
    /// # Errors
    /// There is none.
    pub fn get(&self) -> Result<GpuDevice, GpuError> {
        let open = || match &self.given {
            Some((adapter, device, queue)) => GpuDevice::of(adapter.clone(), device, queue),
            None => GpuDevice::open(),
        };
        self.opened.get_or_init(open).clone()
    }
}

impl From<GpuDevice> for SharedGpu {
    fn from(gpu: GpuDevice) -> Self {
        Self { given: None, opened: Arc::new(OnceLock::from(Ok(gpu))) }
    }
}
