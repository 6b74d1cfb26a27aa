//! Tests that `catmull_rom.wgsl` is the twin of [`stitch_mesh::yarn_curves::catmull_rom`].

use glam::{Vec3, Vec4};
use stitch_mesh::yarn_curves::catmull_rom;

use crate::Gpu;
use crate::pipeline::{STORAGE, bind_group, bind_group_layout, shader};

const TWIN: &str = include_str!("catmull_rom.wgsl");
/// One invocation a span: four points in, the position at `t` = w of the first out.
const KERNEL: &str = "
@group(0) @binding(1) var<storage, read> spans: array<array<vec4f, 4>>;
@group(0) @binding(2) var<storage, read_write> results: array<array<vec4f, 2>>;

@compute @workgroup_size(64)
fn evaluate(@builtin(global_invocation_id) id: vec3u) {
    if id.x < arrayLength(&spans) {
        let p = spans[id.x];
        let spline = catmull_rom(p[0].xyz, p[1].xyz, p[2].xyz, p[3].xyz, p[0].w);
        results[id.x] = array(vec4f(spline.position, 0.0), vec4f(spline.tangent, 0.0));
    }
}";

type Span = ([Vec3; 4], f32);

/// Positions and tangents as the shader has them.
fn evaluate(source: &str, spans: &[Span]) -> Vec<[Vec4; 2]> {
    use wgpu::util::DeviceExt;
    let gpu = Gpu::headless().unwrap_or_else(|error| panic!("{error}"));
    let device = &gpu.device;
    let packed: Vec<_> = spans
        .iter()
        .map(|(p, t)| [p[0].extend(*t), p[1].extend(0.0), p[2].extend(0.0), p[3].extend(0.0)])
        .collect();
    let frame = crate::frame::FrameBuffer::new(device);
    let usage = wgpu::BufferUsages::STORAGE;
    let input = device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
        label: None,
        contents: bytemuck::cast_slice(&packed),
        usage,
    });
    let size = (spans.len() * size_of::<[Vec4; 2]>()) as u64;
    let buffer = |usage| {
        device.create_buffer(&wgpu::BufferDescriptor { label: None, size, usage, mapped_at_creation: false })
    };
    let output = buffer(usage | wgpu::BufferUsages::COPY_SRC);
    let mapped = buffer(wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST);
    let writable = wgpu::BindingType::Buffer {
        ty: wgpu::BufferBindingType::Storage { read_only: false },
        has_dynamic_offset: false,
        min_binding_size: None,
    };
    let types = [crate::pipeline::UNIFORM, STORAGE, writable];
    let layout = bind_group_layout(device, "twin", wgpu::ShaderStages::COMPUTE, &types);
    let resources =
        vec![frame.buffer.as_entire_binding(), input.as_entire_binding(), output.as_entire_binding()];
    let group = bind_group(device, &layout, resources);
    let pipeline_layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        bind_group_layouts: &[Some(&layout)],
        ..Default::default()
    });
    let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: Some("twin"),
        layout: Some(&pipeline_layout),
        module: &shader(device, "twin", &[source, KERNEL]),
        entry_point: Some("evaluate"),
        compilation_options: Default::default(),
        cache: None,
    });
    let mut encoder = device.create_command_encoder(&Default::default());
    let mut pass = encoder.begin_compute_pass(&Default::default());
    pass.set_pipeline(&pipeline);
    pass.set_bind_group(0, &group, &[]);
    pass.dispatch_workgroups(spans.len().div_ceil(64) as u32, 1, 1);
    drop(pass);
    encoder.copy_buffer_to_buffer(&output, 0, &mapped, 0, size);
    gpu.queue.submit([encoder.finish()]);
    mapped.map_async(wgpu::MapMode::Read, .., |result| result.unwrap());
    device.poll(wgpu::PollType::wait_indefinitely()).unwrap();
    bytemuck::cast_slice(&mapped.get_mapped_range(..).unwrap()).to_vec()
}

/// Spans a few millimetres long, as in fabric; every tenth has points that coincide.
fn spans() -> Vec<Span> {
    let mut state = 1u64;
    let mut random = move || {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (state >> 40) as f32 / (1u64 << 24) as f32
    };
    let span = |i: usize| {
        let mut points = [Vec3::ZERO; 4].map(|_| Vec3::new(random(), random(), random()) * 4e-3 + 0.1);
        if i.is_multiple_of(10) {
            points[2] = points[1];
            points[i / 10 % 2 * 3] = points[1];
        }
        (points, if i < 4 { (i % 2) as f32 } else { random() })
    };
    (0..1000).map(span).collect()
}

/// Largest distance between the shader's positions and the CPU's [m].
fn difference(source: &str) -> f32 {
    let spans = spans();
    let results = evaluate(source, &spans);
    spans
        .iter()
        .zip(results)
        .map(|(&(p, t), [found, _])| found.truncate().distance(catmull_rom(p, t)))
        .fold(0.0, f32::max)
}

/// f32 at 0.1 m from the origin resolves 7 nm; the pyramid loses a few times that.
const TOLERANCE: f32 = 2e-7;

#[test]
fn the_shader_draws_the_same_spline() {
    let difference = difference(TWIN);
    assert!(difference < TOLERANCE, "{difference} m apart");
}

#[test]
fn another_spline_is_told_apart() {
    // Chordal instead of centripetal; and another shortest knot, which only coincident points feel.
    let chordal = TWIN.replace("sqrt(distance(a, b))", "distance(a, b)");
    let knots = TWIN.replace("SHORTEST_KNOT = 1e-3", "SHORTEST_KNOT = 2e-2");
    for wrong in [chordal, knots] {
        assert_ne!(wrong, TWIN);
        assert!(difference(&wrong) > 10.0 * TOLERANCE);
    }
}

#[test]
fn tangents_are_the_derivative() {
    let step = 1e-2;
    // Away from the ends, and from points that coincide.
    let inner = |&(p, t): &Span| p[1] != p[2] && t > step && t < 1.0 - step;
    let spans: Vec<_> = spans().into_iter().filter(inner).collect();
    let results = evaluate(TWIN, &spans);
    for ((p, t), [_, tangent]) in spans.into_iter().zip(results) {
        let slope = catmull_rom(p, t + step) - catmull_rom(p, t - step);
        let cosine = slope.normalize().dot(tangent.truncate().normalize());
        assert!(cosine > 0.99, "{cosine} at {t}");
    }
}
