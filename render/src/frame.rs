//! What every shader knows about the frame: camera, lights, and where the shadow map lies.

use glam::{Mat4, Vec2, Vec4};

/// The uniform block `Frame` of `frame.wgsl`; the same fields in the same order.
#[repr(C)]
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
pub(crate) struct Frame {
    /// World to clip space of this pass.
    pub view_projection: Mat4,
    /// World to the clip space of the shadow map.
    pub shadow_projection: Mat4,
    /// The eye [m], w = 1; or the direction towards an eye at infinity, w = 0.
    pub eye: Vec4,
    /// Directions towards the lights and upwards, w unused.
    pub key: Vec4,
    pub fill: Vec4,
    pub rim: Vec4,
    pub up: Vec4,
    /// Size of the picture [px].
    pub size: Vec2,
    /// Distance of the near plane [m].
    pub near: f32,
    /// Pixels that a metre covers one metre from the eye.
    pub pixels_per_radian: f32,
    /// Reach of ambient occlusion [m]; 0 for none.
    pub occlusion_radius: f32,
    /// Width of a texel of the shadow map [m]; 0 for no shadows.
    pub shadow_texel: f32,
    /// Pixels of the scene for one of the picture, along a side.
    pub supersampling: f32,
    pub padding: f32,
}

/// The WGSL of the block, which the other shaders start with.
pub(crate) const WGSL: &str = include_str!("frame.wgsl");

/// The uniform buffer and the bind group of one pass.
#[derive(Debug)]
pub(crate) struct FrameBuffer {
    pub buffer: wgpu::Buffer,
}

impl FrameBuffer {
    pub fn new(device: &wgpu::Device) -> Self {
        let buffer = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("frame"),
            size: size_of::<Frame>() as u64,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        Self { buffer }
    }

    pub fn write(&self, queue: &wgpu::Queue, frame: &Frame) {
        queue.write_buffer(&self.buffer, 0, bytemuck::bytes_of(frame));
    }
}
