//! The contact sheet of stitches: a settled swatch of each, from the front and from the back, with its symbol and name.

use anyhow::{Context, Result};
use egui::{Align, Color32, ColorImage, Layout, RichText, TextureHandle, TextureOptions, Ui, Vec2};
use egui_wgpu::wgpu;
use glam::Vec3;
use image::RgbaImage;
use render::{Bounds, Camera, Drawing, Gpu, NamedView, read_back, render_image};
use sim_core::{Material, Pin, Scene, Simulator, curves};
use std::sync::Arc;
use stitch_mesh::cable::Cable;
use stitch_mesh::dye::Dye;
use stitch_mesh::edge_counts::StitchSize;
use stitch_mesh::lay::lay;
use stitch_mesh::stitch::Stitch;
use stitch_mesh::stitch_mesh::StitchMesh;
use stitch_mesh::swatches::{self, STITCHES};

/// Width of a loop [m].
const LOOP: f64 = 3e-3;
/// Simulated time after which a swatch is drawn [s].
const TIME: f64 = 0.5;
/// Side of a picture [pixels].
const PICTURE: u32 = 190;
/// Swatches side by side.
const ACROSS: usize = 5;
/// Height of what stands below a picture, of a heading, and the gap between swatches [pixels].
const TEXT: f32 = 40.0;
const HEADING: f32 = 44.0;
const GAP: f32 = 14.0;

/// Colour of the yarn of the stitch that a swatch is about.
const SHOWN: Dye = Dye([0xc9, 0x6a, 0x3c]);

/// A swatch and what stands below it.
struct Swatch {
    stitches: StitchMesh,
    symbol: String,
    name: String,
}

/// Draws the sheet. `watch` is told how many swatches of how many are done.
///
/// # Errors
/// A swatch that cannot be simulated, or a device that cannot draw.
pub fn draw(gpu: &Gpu, watch: &mut dyn FnMut(usize, usize)) -> Result<RgbaImage> {
    let groups = groups()?;
    let count = groups.iter().map(|(_, swatches)| swatches.len()).sum();
    let mut done = 0;
    let context = egui::Context::default();
    let mut pages = Vec::new();
    for (heading, swatches) in groups {
        let mut pictures = Vec::new();
        for swatch in swatches {
            let sides = both_sides(gpu, &swatch.stitches).with_context(|| swatch.symbol.clone())?;
            let textures = sides.map(|picture| texture(&context, &picture));
            pictures.push((textures, swatch.symbol, swatch.name));
            done += 1;
            watch(done, count);
        }
        pages.push((heading, pictures));
    }
    let lines: usize = pages.iter().map(|(_, pictures)| pictures.len().div_ceil(ACROSS)).sum();
    let side = PICTURE as f32;
    let width = ACROSS as f32 * (2.0 * side + 2.0 * GAP) + 2.0 * GAP;
    let height = lines as f32 * (side + TEXT + GAP) + pages.len() as f32 * HEADING + 3.0 * GAP;
    page(gpu, &context, [width as u32, height as u32], |ui| {
        ui.spacing_mut().item_spacing = Vec2::splat(0.0);
        for (heading, pictures) in &pages {
            ui.allocate_ui(Vec2::new(width - 2.0 * GAP, HEADING), |ui| {
                ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
                    ui.label(RichText::new(*heading).size(22.0).color(Color32::from_gray(40)));
                });
            });
            for line in pictures.chunks(ACROSS) {
                ui.horizontal(|ui| line.iter().for_each(|entry| swatch(ui, entry)));
                ui.add_space(GAP);
            }
        }
    })
}

fn swatch(ui: &mut Ui, (sides, symbol, name): &([TextureHandle; 2], String, String)) {
    let side = PICTURE as f32;
    ui.allocate_ui(Vec2::new(2.0 * side + 2.0 * GAP, side + TEXT), |ui| {
        ui.set_max_width(2.0 * side + GAP);
        ui.vertical(|ui| {
            ui.horizontal(|ui| {
                for texture in sides {
                    ui.image((texture.id(), Vec2::splat(side)));
                    ui.add_space(2.0);
                }
            });
            ui.add_space(3.0);
            ui.horizontal(|ui| {
                ui.label(RichText::new(symbol).size(17.0).monospace().color(Color32::BLACK));
                ui.add_space(10.0);
                let name = RichText::new(name).size(13.0).color(Color32::from_gray(60));
                let rest = Vec2::new(ui.available_width().min(2.0 * side - 80.0), 18.0);
                ui.add_sized(rest, egui::Label::new(name).halign(Align::Min).truncate());
            });
        });
    });
}

/// All swatches under their headings.
fn groups() -> Result<Vec<(&'static str, Vec<Swatch>)>> {
    let size = StitchSize::of_width(LOOP);
    let mut groups = Vec::new();
    for (heading, symbols) in STITCHES {
        let swatch = |symbol: &&str| -> Result<Swatch> {
            let stitch: Stitch = symbol.parse()?;
            let mut stitches = swatches::of_stitch(&stitch, size)?;
            let middle = stitches.rows()[3].faces[3];
            stitches.set_dye(middle, SHOWN)?;
            let name = format!("{}: {}", stitch.abbreviation(), stitch.description());
            Ok(Swatch { stitches, symbol: (*symbol).to_owned(), name })
        };
        groups.push((heading, symbols.iter().map(swatch).collect::<Result<Vec<_>>>()?));
    }
    let cross = |n, m, to_left| Cable::cross(vec![], n, m, to_left);
    let rope = |cable: Cable| vec![(0, cable); 3];
    let strands = [(0, false), (2, true), (0, false), (2, true)];
    let plait = strands.map(|(left, to_left)| (left, cross(2, 2, to_left)));
    let cables = [
        ("1/1 left", "two loops crossed", rope(cross(1, 1, true)), 10),
        ("2/2 left", "C4F", rope(cross(2, 2, true)), 17),
        ("2/2 right", "C4B", rope(cross(2, 2, false)), 17),
        ("3/3 left", "C6F", rope(cross(3, 3, true)), 23),
        ("3/3 right", "C6B", rope(cross(3, 3, false)), 23),
        ("2/2/2", "plait of three strands", plait.to_vec(), 16),
    ];
    let cables = cables.into_iter().map(|(symbol, name, crossings, height)| -> Result<Swatch> {
        let stitches = swatches::of_cable(&crossings, height, size)?;
        Ok(Swatch { stitches, symbol: symbol.to_owned(), name: name.to_owned() })
    });
    groups.push(("Cables", cables.collect::<Result<Vec<_>>>()?));
    Ok(groups)
}

/// A swatch settled with its border held, as pinned out on a board, seen from the front and from the back.
fn both_sides(gpu: &Gpu, stitches: &StitchMesh) -> Result<[RgbaImage; 2]> {
    let net = Arc::new(lay(stitches));
    let material = Material::for_loop_width(LOOP);
    let mut scene = Scene::empty();
    let stiffness = material.stretch_stiffness() / LOOP;
    // Pinned out on a board: stitches on all sides, cables above and below only, as they draw together.
    let is_cabled = !stitches.cables().is_empty();
    let is_edge = |h| stitches.mesh().twin(h).is_none() && !(is_cabled && stitches.is_wale(h));
    let held = net.nodes.iter().enumerate().filter(|(_, n)| match n.face {
        Some(face) => stitches.mesh().face_half_edges(face).any(is_edge),
        None => n.visits.len() > 2,
    });
    scene.pins = held.map(|(i, n)| Pin { node: i as u32, target: n.position, stiffness }).collect();
    let mut simulator = Simulator::new(&net, material.clone(), scene, net.laid_state())?;
    while simulator.time_s() < TIME {
        simulator.step()?;
    }
    let yarn = curves(&net, simulator.state(), material.drawn_radius);
    let drawing = Drawing { yarn, ..Drawing::default() };
    let [low, high] = stitches.mesh().bounds().map(|p| p.as_vec3());
    // The border is cut off: the stitch is in the middle.
    let middle = (low + high) / 2.0;
    let reach = Vec3::splat((high - low).truncate().min_element() * 0.36);
    let bounds = Bounds::of([middle - reach, middle + reach]).context("a swatch without extent")?;
    let picture = |view: NamedView| -> Result<RgbaImage> {
        let camera = Camera::named(view, bounds, 1.0);
        Ok(render_image(gpu, [PICTURE * 2, PICTURE * 2], &camera, &drawing)?)
    };
    Ok([picture(NamedView::Front)?, picture(NamedView::Back)?])
}

fn texture(context: &egui::Context, picture: &RgbaImage) -> TextureHandle {
    let size = [picture.width() as usize, picture.height() as usize];
    let image = ColorImage::from_rgba_unmultiplied(size, picture.as_raw());
    context.load_texture("swatch", image, TextureOptions::LINEAR)
}

/// Lays out a page with egui and draws it into a picture.
fn page(gpu: &Gpu, context: &egui::Context, size: [u32; 2], contents: impl Fn(&mut Ui)) -> Result<RgbaImage> {
    let screen = egui::Rect::from_min_size(egui::Pos2::ZERO, Vec2::new(size[0] as f32, size[1] as f32));
    let input = || egui::RawInput { screen_rect: Some(screen), ..Default::default() };
    let frame = egui::Frame::NONE.fill(Color32::from_gray(244)).inner_margin(GAP);
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
