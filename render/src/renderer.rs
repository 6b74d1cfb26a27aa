//! The passes of a frame in their order.

use glam::Vec2;

use crate::compose::Compose;
use crate::damage::{Part, Wipe};
use crate::frame::Frame;
use crate::light::Lights;
use crate::lines::LinePipeline;
use crate::occlusion::Occlusion;
use crate::pipeline::{UNIFORM, begin_pass, bind_group_layout, texture};
use crate::shadow::{ShadowFrustum, ShadowMap};
use crate::surface::SurfacePipelines;
use crate::yarn::YarnPipelines;
use crate::{Camera, Gpu, Scene, Viewport};

/// How far ambient occlusion looks around a point, in radii of the thickest yarn: to the next yarn but one.
const OCCLUSION_REACH: f32 = 4.0;
/// How many times further yarn may lie beside its spline in a rough picture. Of a garment of 9 500 loops a step then takes in four spans
/// of yarn instead of two.
const ROUGHER: f32 = 2.0;
/// Hollows that reach less far at what is looked at are left out of a rough picture [px].
const LEAST_ROUGH_HOLLOW: f32 = 3.0;

/// What a picture is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quality {
    /// A window: on software adapters without shadows and without antialiasing.
    Interactive,
    /// A picture to keep: four pixels for each, with shadows everywhere.
    Still,
}

/// Everything that does not depend on the size of the picture. Make one a device and quality; pipelines take a while.
#[derive(Debug)]
pub struct Renderer {
    shadows: bool,
    pub(crate) samples: u32,
    pub(crate) supersampling: u32,
    pub(crate) frame_layout: wgpu::BindGroupLayout,
    pub(crate) lit_frame_layout: wgpu::BindGroupLayout,
    pub(crate) shadow_map: ShadowMap,
    pub(crate) occlusion: Occlusion,
    pub(crate) compose: Compose,
    wipe: Wipe,
    surfaces: SurfacePipelines,
    lines: LinePipeline,
    yarn: YarnPipelines,
}

impl Renderer {
    /// Compiles the shaders.
    pub fn new(gpu: &Gpu, quality: Quality) -> Self {
        let device = &gpu.device;
        let shadows = quality == Quality::Still || !gpu.is_software();
        let samples = gpu.sample_count();
        let supersampling = if quality == Quality::Still { 2 } else { 1 };
        let stages = wgpu::ShaderStages::VERTEX_FRAGMENT;
        let frame_layout = bind_group_layout(device, "frame", stages, &[UNIFORM]);
        let shadow_types = [
            UNIFORM,
            texture(wgpu::TextureSampleType::Depth, false),
            wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Comparison),
        ];
        let lit_frame_layout = bind_group_layout(device, "lit frame", stages, &shadow_types);
        Self {
            shadows,
            samples,
            supersampling,
            shadow_map: ShadowMap::new(device, shadows),
            occlusion: Occlusion::new(device, samples, if quality == Quality::Still { 8 } else { 4 }),
            compose: Compose::new(device, samples, supersampling),
            wipe: Wipe::new(device, samples),
            surfaces: SurfacePipelines::new(device, &frame_layout, &lit_frame_layout, samples, shadows),
            lines: LinePipeline::new(device, &frame_layout, samples),
            yarn: YarnPipelines::new(gpu, &frame_layout, &lit_frame_layout, samples, shadows),
            frame_layout,
            lit_frame_layout,
        }
    }

    /// Records the drawing of what has changed in a scene since it was drawn into a viewport's picture with the same camera: in
    /// the part of the picture around it, if that is small. The picture becomes what [`Self::draw`] would make it.
    pub fn redraw(
        &self,
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        viewport: &Viewport,
        camera: &Camera,
        scene: &Scene,
    ) {
        let size = self.scene_size(viewport);
        // Shadows and hollows reach beyond what casts them.
        let local =
            !self.shadows && scene.yarn.radius() == 0.0 && !scene.lines.flips(self.scale(camera, size));
        let part = scene.damage.part(camera, size, self.supersampling as f32).filter(|_| local);
        let Some(part) = part else {
            self.draw(gpu, encoder, viewport, camera, scene);
            return;
        };
        let [left, top, width, height] = part.rectangle;
        let color = (&viewport.color, viewport.resolved.as_ref());
        let mut pass = begin_pass(encoder, "part", Some(color), Some((&viewport.depth, 0.0)), true);
        pass.set_scissor_rect(left, top, width, height);
        self.wipe.draw(&mut pass);
        self.draw_surfaces(&mut pass, viewport, scene, self.scale(camera, size), Some(&part));
        drop(pass);
        let [left, top] = [left, top].map(|pixels| pixels / self.supersampling);
        let [right, bottom] =
            [0, 1].map(|i| (part.rectangle[i] + part.rectangle[i + 2]).div_ceil(self.supersampling));
        let of_picture = [left, top, right - left, bottom - top];
        self.compose.draw(encoder, &viewport.compose, viewport.view(), Some(of_picture));
    }

    /// Size of what is drawn for a picture [px].
    fn scene_size(&self, viewport: &Viewport) -> Vec2 {
        Vec2::from(viewport.size().map(|pixels| (pixels * self.supersampling) as f32))
    }

    /// Pixels of the picture that a metre covers at the distance of what the camera looks at.
    fn scale(&self, camera: &Camera, size: Vec2) -> f32 {
        camera.pixels_per_radian(size.y) / camera.distance / self.supersampling as f32
    }

    /// Draws everything but yarn, all or what reaches into a part of the picture.
    fn draw_surfaces(
        &self,
        pass: &mut wgpu::RenderPass,
        viewport: &Viewport,
        scene: &Scene,
        scale: f32,
        part: Option<&Part>,
    ) {
        pass.set_bind_group(0, &viewport.lit_frame, &[]);
        self.surfaces.draw_faces(pass, &scene.faces, part);
        self.surfaces.draw_solids(pass, &scene.solids);
        pass.set_bind_group(0, &viewport.plain_frame, &[]);
        self.lines.draw_outlines(pass, &scene.lines, scale, part);
        self.lines.draw(pass, &scene.marks, part);
    }

    /// Records the drawing of a scene into a viewport's picture. A viewport is drawn once a submission.
    pub fn draw(
        &self,
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        viewport: &Viewport,
        camera: &Camera,
        scene: &Scene,
    ) {
        let size = self.scene_size(viewport);
        let lights = Lights::around(camera);
        let frustum = scene.bounds().filter(|_| self.shadows);
        let frustum = frustum.map(|bounds| ShadowFrustum::new(bounds, camera, size.x / size.y, lights.key));
        let hollows = scene.yarn.radius() * OCCLUSION_REACH;
        let left_out = viewport.rough && hollows * self.scale(camera, size) < LEAST_ROUGH_HOLLOW;
        let hollows = if left_out { 0.0 } else { hollows };
        let frame = Frame {
            supersampling: self.supersampling as f32,
            ..frame(camera, size, &lights, frustum.as_ref(), hollows)
        };
        viewport.camera.write(&gpu.queue, &frame);

        if let Some(frustum) = &frustum {
            let view_projection = frustum.projection;
            viewport
                .light
                .write(&gpu.queue, &Frame { view_projection, eye: lights.key.extend(0.0), ..frame });
            let mut pass = begin_pass(encoder, "shadows", None, Some((&self.shadow_map.view, 1.0)), false);
            pass.set_bind_group(0, &viewport.light_frame, &[]);
            self.surfaces.draw_shadow(&mut pass, &scene.faces);
            self.surfaces.draw_shadow(&mut pass, &scene.solids);
            self.yarn.draw_shadow(gpu, &mut pass, &scene.yarn, |center, reach| frustum.scale(center, reach));
        }

        let rougher = if viewport.rough { ROUGHER } else { 1.0 };
        let color = (&viewport.color, viewport.resolved.as_ref());
        let mut pass = begin_pass(encoder, "scene", Some(color), Some((&viewport.depth, 0.0)), false);
        pass.set_bind_group(0, &viewport.lit_frame, &[]);
        self.yarn.draw(gpu, &mut pass, &scene.yarn, rougher, camera.scale_at(size));
        self.draw_surfaces(&mut pass, viewport, scene, self.scale(camera, size), None);
        drop(pass);

        if frame.occlusion_radius > 0.0 {
            self.occlusion.draw(encoder, &viewport.occlusion);
        }
        self.compose.draw(encoder, &viewport.compose, viewport.view(), None);
    }
}

fn frame(
    camera: &Camera,
    size: Vec2,
    lights: &Lights,
    shadows: Option<&ShadowFrustum>,
    occlusion: f32,
) -> Frame {
    Frame {
        view_projection: camera.view_projection(size.x / size.y),
        shadow_projection: shadows.map(|frustum| frustum.projection).unwrap_or_default(),
        eye: camera.eye().extend(1.0),
        key: lights.key.extend(0.0),
        fill: lights.fill.extend(0.0),
        rim: lights.rim.extend(0.0),
        up: lights.up.extend(0.0),
        size,
        near: camera.near(),
        pixels_per_radian: camera.pixels_per_radian(size.y),
        occlusion_radius: occlusion,
        shadow_texel: shadows.map_or(0.0, ShadowFrustum::texel),
        supersampling: 1.0,
        padding: 0.0,
    }
}
