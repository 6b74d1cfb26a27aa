// Layers of the fabric that lie on each other: `layers.rs`, `near_pairs.rs`. Nodes are found through chains, one a cell of a
// hashed grid. Each node sees its contacts itself, in the order of the other nodes, so that sums always come out the same.
@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> nodes: array<Node>;
@group(0) @binding(2) var<storage, read> position: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> velocity: array<vec4<f32>>;
// First node of each cell's chain; then the number of contacts, and the largest speed against the mean, as bits.
@group(0) @binding(4) var<storage, read_write> heads: array<atomic<u32>>;
@group(0) @binding(5) var<storage, read_write> links: array<u32>;
@group(0) @binding(6) var<storage, read_write> contacts: array<Contact>;
@group(0) @binding(7) var<storage, read_write> contacts_of: array<vec2<u32>>;
@group(0) @binding(8) var<storage, read_write> held: array<vec4<f32>>;

fn reach() -> f32 {
    let fastest = bitcast<f32>(atomicLoad(&heads[params.cell_count + 1u]));
    return min(params.touching + 2.0 * params.h * fastest, FARTHEST * params.touching);
}

fn cell(x: vec3<f32>, size: f32) -> vec3<i32> {
    return vec3<i32>(floor(x / size));
}

fn bucket(c: vec3<i32>) -> u32 {
    let u = bitcast<vec3<u32>>(c);
    return ((u.x * 73856093u) ^ (u.y * 19349663u) ^ (u.z * 83492791u)) % params.cell_count;
}

@compute @workgroup_size(WIDE)
fn link(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x < params.node_count {
        let at = bucket(cell(position[id.x].xyz, reach()));
        // Cells keep node + 1, so that a cleared one is empty.
        links[id.x] = atomicExchange(&heads[at], id.x + 1u);
    }
}

// How near something at `apart` that flies with `v` comes in a step.
fn nearest(apart: vec3<f32>, v: vec3<f32>) -> f32 {
    let time = clamp(-dot(apart, v) / max(dot(v, v), 1e-30), 0.0, params.h);
    return length(apart + time * v);
}

fn distance_kept(a: u32, b: u32) -> f32 {
    let laid = vec3<f32>(nodes[a].laid_x - nodes[b].laid_x, nodes[a].laid_y - nodes[b].laid_y, nodes[a].laid_z - nodes[b].laid_z);
    return min(nodes[a].clearance + nodes[b].clearance, NEAREST * length(laid));
}

@compute @workgroup_size(NARROW)
fn meet(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= params.node_count {
        return;
    }
    let a = id.x;
    let x = position[a].xyz;
    let v = velocity[a].xyz;
    let size = reach();
    let home = cell(x, size);
    var found: array<u32, MOST_CONTACTS>;
    var count = 0u;
    for (var k = 0; k < 27; k++) {
        let there = home + vec3<i32>(k % 3 - 1, (k / 3) % 3 - 1, k / 9 - 1);
        var next = atomicLoad(&heads[bucket(there)]);
        while next != 0u {
            let b = next - 1u;
            next = links[b];
            let apart = x - position[b].xyz;
            if b == a || dot(apart, apart) >= size * size || any(cell(position[b].xyz, size) != there) {
                continue;
            }
            if nearest(apart, v - velocity[b].xyz) >= distance_kept(a, b) || dot(apart, apart) == 0.0 {
                continue;
            }
            if count == MOST_CONTACTS {
                atomicOr(&heads[params.cell_count], CROWDED);
                continue;
            }
            var i = count;
            while i > 0u && found[i - 1u] > b {
                found[i] = found[i - 1u];
                i--;
            }
            found[i] = b;
            count++;
        }
    }
    var first = 0u;
    if count > 0u {
        first = atomicAdd(&heads[params.cell_count], count);
    }
    if first + count > params.contact_capacity {
        count = 0u;
    }
    contacts_of[a] = vec2<u32>(first, first + count);
    let h = params.h;
    for (var i = 0u; i < count; i++) {
        let b = found[i];
        let apart = x - position[b].xyz;
        let normal = apart / length(apart);
        let gap = length(apart) - distance_kept(a, b);
        let mass = min(nodes[a].mass, nodes[b].mass);
        let stiffness = params.stiffness_by_mass * mass;
        let past = v - velocity[b].xyz;
        let slip = length(past - dot(past, normal) * normal);
        let press = stiffness * max(-gap, 0.0);
        let drag = min(nodes[a].grip * nodes[b].grip * press / max(slip, 1e-12), mass / h);
        let along = h * h * stiffness;
        let across = h * drag;
        contacts[first + i] = Contact(b, normal.x, normal.y, normal.z, along, across);
        let beside = (along - across) * normal.yzx * normal.zxy;
        held[3u * a] += vec4<f32>((along - across) * normal * normal + across, beside.x);
        let brought = across * velocity[b].xyz + (along - across) * dot(normal, velocity[b].xyz) * normal;
        held[3u * a + 1u] += vec4<f32>(beside.yz, brought.xy);
        held[3u * a + 2u] += vec4<f32>(-h * stiffness * gap * normal, brought.z);
    }
}
