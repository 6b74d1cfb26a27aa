// Stretch and bend force on each yarn of a stack, and what taut woven yarn presses.
@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<uniform> counts: Counts;
@group(0) @binding(2) var<storage, read> nodes: array<Node>;
@group(0) @binding(3) var<storage, read> stacked: array<Stacked>;
@group(0) @binding(4) var<storage, read> pulls: array<u32>;
@group(0) @binding(5) var<storage, read> elements: array<vec4<f32>>;
@group(0) @binding(6) var<storage, read_write> pull: array<vec4<f32>>;

fn by(word: u32) -> vec3<f32> {
    let kind = word & 3u;
    let role = (word >> 2u) & 3u;
    let index = word >> 4u;
    if kind == OF_SEGMENT {
        let first = index * SEGMENT_OUT;
        let tension = elements[first + 2u].w * elements[first].xyz;
        return select(-tension, tension, role == 0u);
    }
    if kind == OF_BEND {
        let first = counts.bends_at + index * BEND_OUT;
        let a = elements[first].xyz;
        let b = elements[first + 1u].xyz;
        let turn = select(select(b, a - b, role == 1u), -a, role == 0u);
        return -elements[first + 3u].w / params.h * turn;
    }
    return elements[counts.shears_at + index * SHEAR_OUT + 1u + role].xyz;
}

@compute @workgroup_size(WIDE)
fn pull_at(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= counts.node_count {
        return;
    }
    let node = nodes[counts.first_node + id.x];
    for (var k = node.visit; k < node.visit + node.size - 3u; k++) {
        var sum = vec3<f32>(0.0);
        for (var i = stacked[k].pull; i < stacked[k].pull_end; i++) {
            sum += by(pulls[i]);
        }
        pull[k] = vec4<f32>(sum, 0.0);
    }
}
