//! The device that everything is drawn on: taken from a window, or opened without one.

use crate::RenderError;

/// A wgpu device with its queue and the facts about the adapter that drawing depends on. Cheap to clone.
#[derive(Clone, Debug)]
pub struct Gpu {
    /// Makes buffers, textures and pipelines.
    pub device: wgpu::Device,
    /// Takes uploads and command buffers.
    pub queue: wgpu::Queue,
    /// Name, backend and kind of the adapter.
    pub adapter_info: wgpu::AdapterInfo,
}

impl Gpu {
    /// Wraps a device somebody else made, for example the one of a window.
    ///
    /// # Errors
    /// It speaks OpenGL, in which shaders can't look up depths.
    pub fn new(
        adapter: &wgpu::Adapter,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
    ) -> Result<Self, RenderError> {
        let adapter_info = adapter.get_info();
        if adapter_info.backend == wgpu::Backend::Gl {
            return Err(RenderError::OpenGl(adapter_info.name));
        }
        Ok(Self { device: device.clone(), queue: queue.clone(), adapter_info })
    }

    /// Opens the best adapter of the machine without a window; a software one will do.
    pub fn headless() -> Result<Self, RenderError> {
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle_from_env());
        let options = wgpu::RequestAdapterOptions {
            power_preference: wgpu::PowerPreference::HighPerformance,
            ..Default::default()
        };
        let adapter =
            pollster::block_on(instance.request_adapter(&options)).map_err(|_| RenderError::NoAdapter)?;
        let descriptor = wgpu::DeviceDescriptor {
            label: Some("headless"),
            required_limits: adapter.limits(),
            ..Default::default()
        };
        let (device, queue) = pollster::block_on(adapter.request_device(&descriptor))?;
        Self::new(&adapter, &device, &queue)
    }

    /// Whether the processor itself does the drawing, so that frames must be cheap.
    pub fn is_software(&self) -> bool {
        self.adapter_info.device_type == wgpu::DeviceType::Cpu
    }

    /// Samples a pixel: four where multisampling is nearly free, one on software adapters, where it costs five times
    /// the frame.
    pub fn sample_count(&self) -> u32 {
        if self.is_software() { 1 } else { 4 }
    }
}
