// Lengths that segments gain by turning, taken off again: `overshoot::draw_back`. A sweep reads `back` and writes `back_next`.
@group(0) @binding(0) var<uniform> counts: Counts;
@group(0) @binding(1) var<storage, read> nodes: array<Node>;
@group(0) @binding(2) var<storage, read> entries: array<u32>;
@group(0) @binding(3) var<storage, read> segments: array<Segment>;
@group(0) @binding(4) var<storage, read> position: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read> next_position: array<vec4<f32>>;
@group(0) @binding(6) var<storage, read> held: array<vec4<f32>>;
@group(0) @binding(7) var<storage, read> back: array<vec4<f32>>;
@group(0) @binding(8) var<storage, read_write> back_next: array<vec4<f32>>;

// Mass of a node with what holds it.
fn firm(node: u32) -> f32 {
    let h = held[3u * node];
    let mass = nodes[node].mass;
    return mass + min((h.x + h.y + h.z) / 3.0, DRAWN_HEAVIEST * mass);
}

// How far one end is drawn to the other.
fn drawn(own: u32, other: u32, left: f32) -> vec3<f32> {
    let r = position[other].xyz - position[own].xyz;
    let moved = (next_position[other].xyz - next_position[own].xyz) - r;
    let before = length(r);
    let most = (1.0 + left) * max(before + dot(r, moved) / before, DRAWN_LEAST * before);
    let after = r + moved + (back[other].xyz - back[own].xyz);
    let length = length(after);
    if length <= most {
        return vec3<f32>(0.0);
    }
    let share = firm(other) / (firm(own) + firm(other));
    return DRAWN_PART * share * (length - most) / length * after;
}

// One sweep at one node.
fn sweep(index: u32, left: f32) {
    if index >= counts.node_count {
        return;
    }
    let own = counts.first_node + index;
    let node = nodes[own];
    var sum = back[own].xyz;
    for (var entry = node.entry; entry < node.entry_end; entry += 3u) {
        let word = entries[entry];
        if (word & 3u) == OF_SEGMENT {
            let term = segments[word >> 4u];
            let is_first = ((word >> 2u) & 3u) == 0u;
            sum += drawn(own, select(term.node_0, term.node_1, is_first), left);
        }
    }
    back_next[own] = vec4<f32>(sum, 0.0);
}

// The first round.
@compute @workgroup_size(WIDE)
fn draw_back(@builtin(global_invocation_id) id: vec3<u32>) {
    sweep(id.x, DRAWN_LEFT);
}

// The second round.
@compute @workgroup_size(WIDE)
fn draw_far_back(@builtin(global_invocation_id) id: vec3<u32>) {
    sweep(id.x, DRAWN_FAR_LEFT);
}
