// The state at the end of the step: `step::advanced`, `Stepper::keep_rotation`.
@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> nodes: array<Node>;
@group(0) @binding(2) var<storage, read> stacked: array<Stacked>;
@group(0) @binding(3) var<storage, read> springs: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> x: array<f32>;
@group(0) @binding(5) var<storage, read> rigid: Rigid;
@group(0) @binding(6) var<storage, read_write> next_position: array<vec4<f32>>;
@group(0) @binding(7) var<storage, read_write> moving: array<vec4<f32>>;
@group(0) @binding(8) var<storage, read_write> next_visits: array<vec4<f32>>;

@compute @workgroup_size(WIDE)
fn advance(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= params.node_count {
        return;
    }
    let node = nodes[id.x];
    let was = next_position[id.x].xyz;
    let center = vec3<f32>(rigid.center_x, rigid.center_y, rigid.center_z);
    let kept = vec3<f32>(rigid.kept_x, rigid.kept_y, rigid.kept_z);
    let v = moving[id.x].xyz + cross(kept, was - center);
    moving[id.x] = vec4<f32>(v, 0.0);
    next_position[id.x] = vec4<f32>(was + params.h * v, 0.0);
    // A lone yarn does not slide.
    if node.size < 5u {
        return;
    }
    for (var i = 3u; i < node.size; i++) {
        let k = node.visit + i - 3u;
        let s = springs[k];
        let u = next_visits[stacked[k].visit].x;
        let rate = x[node.dof + i];
        next_visits[stacked[k].visit] = vec4<f32>(u + params.h * rate, rate, s.x, s.z);
    }
}
