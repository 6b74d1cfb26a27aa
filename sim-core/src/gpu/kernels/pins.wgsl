// Springs that hold nodes, one a node at most: `pin.rs`.
@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<uniform> part: Part;
@group(0) @binding(2) var<storage, read> pins: array<Pin>;
@group(0) @binding(3) var<storage, read> position: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read_write> held: array<vec4<f32>>;

@compute @workgroup_size(NARROW)
fn pin(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= part.count {
        return;
    }
    let spring = pins[id.x];
    let h = params.h;
    let off = vec3<f32>(spring.x, spring.y, spring.z) - position[spring.node].xyz;
    let first = 3u * spring.node;
    held[first] += vec4<f32>(vec3<f32>(h * h * spring.stiffness), 0.0);
    held[first + 2u] += vec4<f32>(h * spring.stiffness * off, 0.0);
}
