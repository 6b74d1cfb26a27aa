// Places and velocities of nodes that segments have drawn back: the end of `overshoot::draw_back`.
@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> back: array<vec4<f32>>;
@group(0) @binding(2) var<storage, read_write> next_position: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read_write> moving: array<vec4<f32>>;

@compute @workgroup_size(WIDE)
fn come_back(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= params.node_count {
        return;
    }
    next_position[id.x] = vec4<f32>(next_position[id.x].xyz + back[id.x].xyz, 0.0);
    moving[id.x] = vec4<f32>(moving[id.x].xyz + back[id.x].xyz / params.h, 0.0);
}
