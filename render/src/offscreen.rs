//! Pictures without a window.

use image::RgbaImage;

use crate::{Camera, Drawing, Gpu, Quality, RenderError, Renderer, Scene, Viewport};

/// Draws a still of `size` pixels.
pub fn render_image(
    gpu: &Gpu,
    size: [u32; 2],
    camera: &Camera,
    drawing: &Drawing,
) -> Result<RgbaImage, RenderError> {
    let renderer = Renderer::new(gpu, Quality::Still);
    let viewport = Viewport::new(gpu, &renderer, size)?;
    let mut scene = Scene::new();
    scene.set(gpu, drawing)?;
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    renderer.draw(gpu, &mut encoder, &viewport, camera, &scene);
    gpu.queue.submit([encoder.finish()]);
    read_back(gpu, viewport.picture())
}

/// Waits for what was submitted and copies a picture (four bytes a pixel) into memory.
pub fn read_back(gpu: &Gpu, picture: &wgpu::Texture) -> Result<RgbaImage, RenderError> {
    let (width, height) = (picture.width(), picture.height());
    let row = width * 4;
    // Rows of a copied texture are padded.
    let stride = row.next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
    let buffer = gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("picture"),
        size: u64::from(stride) * u64::from(height),
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
        mapped_at_creation: false,
    });
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    encoder.copy_texture_to_buffer(
        picture.as_image_copy(),
        wgpu::TexelCopyBufferInfo {
            buffer: &buffer,
            layout: wgpu::TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some(stride),
                rows_per_image: None,
            },
        },
        picture.size(),
    );
    gpu.queue.submit([encoder.finish()]);

    let failed = |error: &dyn std::fmt::Display| RenderError::ReadBack(error.to_string());
    let (sender, receiver) = std::sync::mpsc::channel();
    buffer.map_async(wgpu::MapMode::Read, .., move |result| {
        // The receiver waits below, unless polling failed and it is gone already.
        let _ = sender.send(result);
    });
    gpu.device.poll(wgpu::PollType::wait_indefinitely()).map_err(|error| failed(&error))?;
    receiver.recv().map_err(|error| failed(&error))?.map_err(|error| failed(&error))?;
    let mapped = buffer.get_mapped_range(..).map_err(|error| failed(&error))?;
    let pixels = mapped.chunks(stride as usize).flat_map(|padded| &padded[..row as usize]).copied().collect();
    RgbaImage::from_raw(width, height, pixels).ok_or_else(|| failed(&"its size is wrong"))
}
