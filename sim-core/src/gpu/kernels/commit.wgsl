// The new state takes the place of the old, if it may.
@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> next_position: array<vec4<f32>>;
@group(0) @binding(2) var<storage, read> moving: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> next_visits: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read_write> position: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read_write> velocity: array<vec4<f32>>;
@group(0) @binding(6) var<storage, read_write> visits: array<vec4<f32>>;
@group(0) @binding(7) var<storage, read> status: Status;
@group(0) @binding(8) var<storage, read> faults: array<u32, 2>;

@compute @workgroup_size(WIDE)
fn commit(@builtin(global_invocation_id) id: vec3<u32>) {
    if status.solved != 1u || faults[0] != NONE || faults[1] > params.most_left {
        return;
    }
    if id.x < params.node_count {
        position[id.x] = next_position[id.x];
        velocity[id.x] = moving[id.x];
    }
    if id.x < params.visit_count {
        visits[id.x] = next_visits[id.x];
    }
}
