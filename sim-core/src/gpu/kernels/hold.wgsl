// Adds to the system what touches single nodes: friction springs, bodies, pins and layers.
@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<uniform> counts: Counts;
@group(0) @binding(2) var<storage, read> nodes: array<Node>;
@group(0) @binding(3) var<storage, read> stacked: array<Stacked>;
@group(0) @binding(4) var<storage, read> springs: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read> visits: array<vec4<f32>>;
@group(0) @binding(6) var<storage, read> velocity: array<vec4<f32>>;
@group(0) @binding(7) var<storage, read> held: array<vec4<f32>>;
@group(0) @binding(8) var<storage, read_write> values: array<f32>;
@group(0) @binding(9) var<storage, read_write> load: array<vec2<f32>>;

@compute @workgroup_size(WIDE)
fn hold(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= counts.node_count {
        return;
    }
    let n = counts.first_node + id.x;
    let node = nodes[n];
    let h = params.h;
    let size = node.size;
    let diagonal = node.value + node.own * size;

    // The symmetric block of what holds the position, and its impulse.
    let k = held[3u * n];
    let l = held[3u * n + 1u];
    let impulse = held[3u * n + 2u].xyz;
    let brought = vec3<f32>(l.zw, held[3u * n + 2u].w);
    let block = mat3x3<f32>(vec3<f32>(k.x, l.y, l.x), vec3<f32>(l.y, k.y, k.w), vec3<f32>(l.x, k.w, k.z));
    let brake = block * velocity[n].xyz;
    for (var i = 0u; i < 3u; i++) {
        for (var j = 0u; j < 3u; j++) {
            values[diagonal + j * size + i] += block[j][i];
            values[node.value + (node.width + j) * size + i] += block[j][i];
        }
        load[node.dof + i] += vec2<f32>(impulse[i], impulse[i] + brought[i] - brake[i]);
    }

    for (var i = 3u; i < size; i++) {
        let s = springs[node.visit + i - 3u];
        let v = visits[stacked[node.visit + i - 3u].visit];
        values[diagonal + i * size + i] += h * h * s.y;
        load[node.dof + i] -= h * s.y * vec2<f32>(v.x - s.x, v.x - s.x + h * v.y);
        if s.w > 0.0 {
            let apart = v - visits[stacked[node.visit + i - 2u].visit];
            let force = h * s.w * vec2<f32>(apart.x - s.z, apart.x - s.z + h * apart.y);
            load[node.dof + i] -= force;
            load[node.dof + i + 1u] += force;
            let stiffness = h * h * s.w;
            values[diagonal + i * size + i] += stiffness;
            values[diagonal + (i + 1u) * size + i + 1u] += stiffness;
            values[diagonal + i * size + i + 1u] -= stiffness;
            values[diagonal + (i + 1u) * size + i] -= stiffness;
        }
    }
}
