// The guess of conjugate gradients is the old velocities; the residual is what they leave.
@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> nodes: array<Node>;
@group(0) @binding(2) var<storage, read> stacked: array<Stacked>;
@group(0) @binding(3) var<storage, read> velocity: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> visits: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read> load: array<vec2<f32>>;
@group(0) @binding(6) var<storage, read_write> x: array<f32>;
@group(0) @binding(7) var<storage, read_write> r: array<f32>;

@compute @workgroup_size(WIDE)
fn begin(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= params.node_count {
        return;
    }
    let node = nodes[id.x];
    for (var i = 0u; i < node.size; i++) {
        if i < 3u {
            x[node.dof + i] = velocity[id.x][i];
        } else {
            x[node.dof + i] = visits[stacked[node.visit + i - 3u].visit].y;
        }
        r[node.dof + i] = load[node.dof + i].y;
    }
}
