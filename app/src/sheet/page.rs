//! Pages: laid out with egui, drawn without a window.

use anyhow::Result;
use egui::{Color32, ColorImage, TextureHandle, TextureOptions, Ui, Vec2};
use egui_wgpu::wgpu;
use image::RgbaImage;
use render::{Gpu, read_back};

/// A picture that the page can show.
pub(super) fn texture(context: &egui::Context, picture: &RgbaImage) -> TextureHandle {
    let size = [picture.width() as usize, picture.height() as usize];
    let image = ColorImage::from_rgba_unmultiplied(size, picture.as_raw());
    context.load_texture("swatch", image, TextureOptions::LINEAR)
}

/// Lays out a page with egui and draws it into a picture.
///
/// # Errors
/// A device that cannot draw.
pub(super) fn draw(
    gpu: &Gpu,
    context: &egui::Context,
    size: [u32; 2],
    contents: impl Fn(&mut Ui),
) -> Result<RgbaImage> {
    let screen = egui::Rect::from_min_size(egui::Pos2::ZERO, Vec2::new(size[0] as f32, size[1] as f32));
    let input = || egui::RawInput { screen_rect: Some(screen), ..Default::default() };
    let frame = egui::Frame::NONE.fill(Color32::from_gray(244));
    let run = || {
        context.run_ui(input(), |ui| {
            egui::CentralPanel::default().frame(frame).show(ui, &contents);
        })
    };
    // The first run finds out how large things are.
    let mut first = run();
    let mut output = run();
    let format = wgpu::TextureFormat::Rgba8Unorm;
    let mut painter = egui_wgpu::Renderer::new(&gpu.device, format, egui_wgpu::RendererOptions::default());
    for mut textures in
        [std::mem::take(&mut first.textures_delta), std::mem::take(&mut output.textures_delta)]
    {
        for (id, deltas) in std::mem::take(&mut textures.set) {
            deltas.iter().for_each(|delta| painter.update_texture(&gpu.device, &gpu.queue, id, delta));
        }
    }
    let jobs = context.tessellate(output.shapes, 1.0);
    let target = gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: Some("page"),
        size: wgpu::Extent3d { width: size[0], height: size[1], depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
        view_formats: &[],
    });
    let descriptor = egui_wgpu::ScreenDescriptor { size_in_pixels: size, pixels_per_point: 1.0 };
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    let uploads = painter.update_buffers(&gpu.device, &gpu.queue, &mut encoder, &jobs, &descriptor);
    {
        let view = target.create_view(&Default::default());
        let mut pass = encoder
            .begin_render_pass(&wgpu::RenderPassDescriptor {
                label: Some("page"),
                color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                    view: &view,
                    resolve_target: None,
                    depth_slice: None,
                    ops: wgpu::Operations {
                        load: wgpu::LoadOp::Clear(wgpu::Color::WHITE),
                        store: wgpu::StoreOp::Store,
                    },
                })],
                ..Default::default()
            })
            .forget_lifetime();
        painter.render(&mut pass, &jobs, &descriptor);
    }
    gpu.queue.submit(uploads.into_iter().chain([encoder.finish()]));
    Ok(read_back(gpu, &target)?)
}
