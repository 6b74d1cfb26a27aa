//! Pages: laid out with egui, drawn without a window.

use anyhow::Result;
use egui::{
    Align2, Color32, ColorImage, Context, FontId, Pos2, Rect, TextureHandle, TextureOptions, Ui, Vec2,
};
use egui_wgpu::wgpu;
use image::RgbaImage;
use render::{Gpu, read_back};

/// A picture that the page can show.
pub(crate) fn texture(context: &Context, picture: &RgbaImage) -> TextureHandle {
    let size = [picture.width() as usize, picture.height() as usize];
    let image = ColorImage::from_rgba_unmultiplied(size, picture.as_raw());
    context.load_texture("swatch", image, TextureOptions::LINEAR)
}

/// Lays out a page with egui and draws it into a picture of `size` pixels, `scale` of them to a point.
///
/// # Errors
/// A device that cannot draw.
pub(crate) fn draw(
    gpu: &Gpu,
    context: &Context,
    size: [u32; 2],
    scale: f32,
    contents: impl Fn(&mut Ui),
) -> Result<RgbaImage> {
    let screen = Rect::from_min_size(Pos2::ZERO, Vec2::new(size[0] as f32, size[1] as f32) / scale);
    let input = || egui::RawInput { screen_rect: Some(screen), ..Default::default() };
    context.set_pixels_per_point(scale);
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
    let jobs = context.tessellate(output.shapes, scale);
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
    let descriptor = egui_wgpu::ScreenDescriptor { size_in_pixels: size, pixels_per_point: scale };
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

/// Pictures of one size in rows of `across`, each with its name below.
///
/// # Errors
/// A device that cannot draw.
pub(crate) fn beside(gpu: &Gpu, pictures: &[(&str, RgbaImage)], across: usize) -> Result<RgbaImage> {
    /// Height of a name [pixels].
    const NAME: f32 = 34.0;
    let Some((_, first)) = pictures.first() else { return Ok(RgbaImage::new(1, 1)) };
    let cell = Vec2::new(first.width() as f32, first.height() as f32 + NAME);
    let context = Context::default();
    let textures: Vec<(&str, TextureHandle)> =
        pictures.iter().map(|(name, picture)| (*name, texture(&context, picture))).collect();
    let size = [cell.x * across as f32, cell.y * pictures.len().div_ceil(across) as f32];
    draw(gpu, &context, size.map(|x| x as u32), 1.0, |ui| {
        for (i, (name, picture)) in textures.iter().enumerate() {
            let corner = Pos2::ZERO + Vec2::new((i % across) as f32, (i / across) as f32) * cell;
            let place = Rect::from_min_size(corner, cell - Vec2::new(0.0, NAME));
            let whole = Rect::from_min_max(Pos2::ZERO, Pos2::new(1.0, 1.0));
            ui.painter().image(picture.id(), place, whole, Color32::WHITE);
            let below = place.center_bottom() + Vec2::new(0.0, 6.0);
            ui.painter().text(below, Align2::CENTER_TOP, name, FontId::proportional(20.0), Color32::BLACK);
        }
    })
}
