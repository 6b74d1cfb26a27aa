//! Kernels: WGSL sources, their bindings read from the sources themselves.
//!
//! A binding has the name of the buffer that belongs there, so what a kernel works on stands in one place, at its top.

use super::device::{GpuDevice, GpuError};
use super::layout::prelude;
use std::collections::BTreeMap;
use wgpu::naga;

/// The name of a kernel file, its text and the stages in it.
pub(crate) type Source = (&'static str, &'static str, &'static [&'static str]);

/// All kernel files.
pub(crate) const SOURCES: &[Source] = &[
    (
        "rigid",
        include_str!("kernels/rigid.wgsl"),
        &["weigh_span", "weigh", "spin_span", "measure", "keep", "race"],
    ),
    ("segment", include_str!("kernels/segment.wgsl"), &["segment"]),
    ("bend", include_str!("kernels/bend.wgsl"), &["bend"]),
    ("wrap", include_str!("kernels/wrap.wgsl"), &["wrap"]),
    ("shear", include_str!("kernels/shear.wgsl"), &["shear"]),
    ("gather", include_str!("kernels/gather.wgsl"), &["gather"]),
    ("pull", include_str!("kernels/pull.wgsl"), &["pull_at"]),
    ("normal", include_str!("kernels/normal.wgsl"), &["normal"]),
    ("friction", include_str!("kernels/friction.wgsl"), &["friction"]),
    ("bodies", include_str!("kernels/bodies.wgsl"), &["hold_off"]),
    ("pins", include_str!("kernels/pins.wgsl"), &["pin"]),
    ("layers", include_str!("kernels/layers.wgsl"), &["link", "meet"]),
    ("hold", include_str!("kernels/hold.wgsl"), &["hold"]),
    ("fill", include_str!("kernels/fill.wgsl"), &["fill"]),
    ("eliminate", include_str!("kernels/eliminate.wgsl"), &["eliminate"]),
    ("tiles", include_str!("kernels/tiles.wgsl"), &["divide", "take_away"]),
    ("begin", include_str!("kernels/begin.wgsl"), &["begin"]),
    ("forward", include_str!("kernels/forward.wgsl"), &["forward"]),
    ("backward", include_str!("kernels/backward.wgsl"), &["backward"]),
    ("product", include_str!("kernels/product.wgsl"), &["product"]),
    ("sums", include_str!("kernels/sums.wgsl"), &["sum_span", "choose_step", "judge_error"]),
    ("gradients", include_str!("kernels/gradients.wgsl"), &["go", "turn"]),
    (
        "translate",
        include_str!("kernels/translate.wgsl"),
        &["held_span", "translate_span", "translate", "settle"],
    ),
    ("advance", include_str!("kernels/advance.wgsl"), &["advance"]),
    ("overshoot", include_str!("kernels/overshoot.wgsl"), &["draw_back", "draw_far_back"]),
    ("come_back", include_str!("kernels/come_back.wgsl"), &["come_back"]),
    ("judge", include_str!("kernels/judge.wgsl"), &["judge"]),
    ("commit", include_str!("kernels/commit.wgsl"), &["commit"]),
    ("points", include_str!("kernels/points.wgsl"), &["lay_points", "lay_middles"]),
    ("drawn", include_str!("kernels/drawn.wgsl"), &["lay_out"]),
    ("frame", include_str!("kernels/frame.wgsl"), &["frame"]),
    ("roll", include_str!("kernels/roll.wgsl"), &["roll"]),
    ("bound", include_str!("kernels/bound.wgsl"), &["bound"]),
];

/// A binding of a kernel file.
#[derive(Clone)]
struct Binding {
    place: u32,
    name: String,
    kind: wgpu::BufferBindingType,
}

/// What the stages of one kernel file work on.
#[derive(Clone)]
struct Kernel {
    layout: wgpu::BindGroupLayout,
    bindings: Vec<Binding>,
}

/// All kernels, compiled.
#[derive(Clone)]
pub(crate) struct Kernels {
    files: BTreeMap<&'static str, Kernel>,
    stages: BTreeMap<&'static str, (&'static str, wgpu::ComputePipeline)>,
}

/// One dispatch, ready to be recorded.
pub(crate) struct Task {
    pub stage: &'static str,
    pub pipeline: wgpu::ComputePipeline,
    pub bindings: wgpu::BindGroup,
    /// Place of its `Part` in the buffer of all parts, for kernels that have one [bytes].
    pub part: Option<u32>,
    pub workgroups: u32,
}

impl Task {
    /// The same once more.
    pub fn again(&self) -> Self {
        Self {
            stage: self.stage,
            pipeline: self.pipeline.clone(),
            bindings: self.bindings.clone(),
            part: self.part,
            workgroups: self.workgroups,
        }
    }
}

/// Bytes from one `Part` to the next, as dynamic offsets have to be aligned.
pub(crate) const PART_STRIDE: u32 = 256;

/// The whole source of a kernel file.
pub(crate) fn source(text: &str) -> String {
    format!("{}\n{text}", prelude())
}

impl Kernels {
    /// Compiles `sources`, normally [`SOURCES`].
    pub fn compile(gpu: &GpuDevice, sources: &[Source]) -> Result<Self, GpuError> {
        let mut kernels = Self { files: BTreeMap::new(), stages: BTreeMap::new() };
        for (file, text, stages) in sources {
            let whole = source(text);
            let bindings = bindings(&whole).map_err(GpuError::Refused)?;
            let entry = |b: &Binding| wgpu::BindGroupLayoutEntry {
                binding: b.place,
                visibility: wgpu::ShaderStages::COMPUTE,
                ty: wgpu::BindingType::Buffer {
                    ty: b.kind,
                    has_dynamic_offset: b.name == "part",
                    min_binding_size: None,
                },
                count: None,
            };
            let entries: Vec<_> = bindings.iter().map(entry).collect();
            let layout = gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
                label: Some(file),
                entries: &entries,
            });
            let pipeline_layout = gpu.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                label: Some(file),
                bind_group_layouts: &[Some(&layout)],
                ..Default::default()
            });
            let module = gpu.device.create_shader_module(wgpu::ShaderModuleDescriptor {
                label: Some(file),
                source: wgpu::ShaderSource::Wgsl(whole.into()),
            });
            for stage in *stages {
                let pipeline = gpu.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                    label: Some(stage),
                    layout: Some(&pipeline_layout),
                    module: &module,
                    entry_point: Some(stage),
                    compilation_options: Default::default(),
                    cache: None,
                });
                kernels.stages.insert(stage, (file, pipeline));
            }
            kernels.files.insert(file, Kernel { layout, bindings });
        }
        gpu.check()?;
        Ok(kernels)
    }

    /// A dispatch of `stage` on the buffers that `find` knows by their names.
    pub fn task<'a>(
        &self,
        gpu: &GpuDevice,
        stage: &str,
        workgroups: u32,
        part: Option<u32>,
        find: impl Fn(&str) -> Option<&'a wgpu::Buffer>,
    ) -> Result<Task, GpuError> {
        let missing = |what: &str| GpuError::Refused(format!("{stage}: there is no {what}"));
        let (stage, (file, pipeline)) =
            self.stages.get_key_value(stage).ok_or_else(|| missing("such stage"))?;
        let kernel = self.files.get(file).ok_or_else(|| missing("kernel"))?;
        let mut entries = Vec::with_capacity(kernel.bindings.len());
        for binding in &kernel.bindings {
            let buffer = find(&binding.name).ok_or_else(|| missing(&binding.name))?;
            let size = if binding.name == "part" { wgpu::BufferSize::new(8) } else { None };
            let resource = wgpu::BindingResource::Buffer(wgpu::BufferBinding { buffer, offset: 0, size });
            entries.push(wgpu::BindGroupEntry { binding: binding.place, resource });
        }
        let descriptor =
            wgpu::BindGroupDescriptor { label: Some(stage), layout: &kernel.layout, entries: &entries };
        let bindings = gpu.device.create_bind_group(&descriptor);
        Ok(Task { stage, pipeline: pipeline.clone(), bindings, part, workgroups })
    }
}

/// What a source declares to work on.
fn bindings(source: &str) -> Result<Vec<Binding>, String> {
    let module = naga::front::wgsl::parse_str(source).map_err(|e| e.emit_to_string(source))?;
    let mut found = Vec::new();
    for (_, variable) in module.global_variables.iter() {
        let (Some(place), Some(name)) = (&variable.binding, &variable.name) else { continue };
        let kind = match variable.space {
            naga::AddressSpace::Uniform => wgpu::BufferBindingType::Uniform,
            naga::AddressSpace::Storage { access } => {
                wgpu::BufferBindingType::Storage { read_only: !access.contains(naga::StorageAccess::STORE) }
            }
            _ => continue,
        };
        found.push(Binding { place: place.binding, name: name.clone(), kind });
    }
    Ok(found)
}

/// Records dispatches one after the other.
pub(crate) fn record<'a>(pass: &mut wgpu::ComputePass<'_>, tasks: impl IntoIterator<Item = &'a Task>) {
    for task in tasks {
        if task.workgroups > 0 {
            pass.set_pipeline(&task.pipeline);
            pass.set_bind_group(0, &task.bindings, task.part.as_slice());
            pass.dispatch_workgroups(task.workgroups, 1, 1);
        }
    }
}
