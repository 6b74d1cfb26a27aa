// Unit normal of the fabric at each node, towards the front: `curves::normal`.
@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> nodes: array<Node>;
@group(0) @binding(2) var<storage, read> around: array<u32>;
@group(0) @binding(3) var<storage, read> position: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read_write> normals: array<vec4<f32>>;

fn laid(n: u32) -> vec3<f32> {
    return vec3<f32>(nodes[n].laid_x, nodes[n].laid_y, nodes[n].laid_z);
}

@compute @workgroup_size(WIDE)
fn normal(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= params.node_count {
        return;
    }
    let node = nodes[id.x];
    let front = vec3<f32>(node.normal_x, node.normal_y, node.normal_z);
    let here = position[id.x].xyz;
    let was = laid(id.x);
    var vote = vec3<f32>(0.0);
    for (var i = node.around; i < node.around_end; i++) {
        let a = around[i];
        for (var j = i + 1u; j < node.around_end; j++) {
            let b = around[j];
            let area = dot(front, cross(laid(a) - was, laid(b) - was));
            // In squared millimetres, far from the smallest numbers there are.
            vote += 1e6 * area * (1e6 * cross(position[a].xyz - here, position[b].xyz - here));
        }
    }
    normals[id.x] = vec4<f32>(unit_or(vote, front), 0.0);
}
