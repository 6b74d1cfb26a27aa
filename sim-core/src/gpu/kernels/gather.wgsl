// Sums what the elements around each node add to its rows of the system: the scatter of `assembly.rs`, turned round.
@group(0) @binding(0) var<uniform> counts: Counts;
@group(0) @binding(1) var<storage, read> nodes: array<Node>;
@group(0) @binding(2) var<storage, read> entries: array<u32>;
@group(0) @binding(3) var<storage, read> elements: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read_write> values: array<f32>;
@group(0) @binding(5) var<storage, read_write> load: array<vec2<f32>>;

// One row of a node: where its entries are, where what it has for a motion of all nodes is, and which part of the node it is
// (3: a sliding coordinate).
struct Row {
    first: u32,
    size: u32,
    rigid: u32,
    part: u32,
}

// Column of the first unknown of the node at the other end, and place of the sliding coordinate there, 0 if frozen.
fn column(entry: u32, role: u32) -> vec2<u32> {
    let word = (entries[entry + 1u + (role >> 1u)] >> (16u * (role & 1u))) & 0xffffu;
    return vec2<u32>(word & 0xfffu, word >> 12u);
}

fn add(row: Row, to: vec2<u32>, v: vec4<f32>) {
    for (var j = 0u; j < 3u; j++) {
        values[row.first + (to.x + j) * row.size] += v[j];
    }
    if to.y != 0u {
        values[row.first + (to.x + to.y) * row.size] += v.w;
    }
}

fn of_segment(row: Row, entry: u32, first: u32, role: u32) -> vec2<f32> {
    let d = elements[first];
    let w = elements[first + 1u];
    let k = elements[first + 2u];
    let mass = w.w;
    let g = vec4<f32>(d.xyz, -d.w);
    var unit = vec4<f32>(0.0);
    unit[row.part] = 1.0;
    var inertia = vec4<f32>(mass * unit.xyz, -mass * dot(w.xyz, unit.xyz));
    var stiffness = k.x * dot(g, unit) * g;
    if row.part < 3u {
        stiffness += vec4<f32>(k.y * (unit.xyz - d.xyz * dot(d.xyz, unit.xyz)), 0.0);
    } else {
        inertia = vec4<f32>(-mass * w.xyz, mass * dot(w.xyz, w.xyz));
        stiffness.w += k.z;
    }
    // Stiffness cancels there.
    for (var j = 0u; j < 3u; j++) {
        values[row.rigid + j * row.size] += 3.0 * inertia[j];
    }
    for (var other = 0u; other < 2u; other++) {
        if other == role {
            var v = 2.0 * inertia + stiffness;
            v.w += select(0.0, mass * SLIDING_MASS, row.part == 3u);
            add(row, column(entry, other), v);
        } else {
            add(row, column(entry, other), inertia - stiffness);
        }
    }
    return vec2<f32>(elements[first + 3u + role][row.part], elements[first + 5u + role][row.part]);
}

fn of_bend(row: Row, entry: u32, first: u32, role: u32) -> vec2<f32> {
    let a = elements[first];
    let b = elements[first + 1u];
    let n = elements[first + 2u];
    let k = elements[first + 3u];
    let f = elements[first + 4u];
    let ends = vec3<f32>(-1.0, 0.0, 1.0);
    let tilts = vec3<f32>(k.x, -(k.x + k.y), k.y);
    var turns = array<vec4<f32>, 3>(
        vec4<f32>(-a.xyz, -n.w),
        vec4<f32>(a.xyz - b.xyz, 0.0),
        vec4<f32>(b.xyz, n.w),
    );
    let turn = turns[role][row.part];
    let is_u = row.part == 3u;
    let tilt = select(tilts[role] * n[row.part], 0.0, is_u);
    let end = select(0.0, ends[role], is_u);
    for (var other = 0u; other < 3u; other++) {
        var v = a.w * turn * turns[other] + vec4<f32>(b.w * tilt * tilts[other] * n.xyz, 0.0);
        v.w += k.z * end * ends[other];
        add(row, column(entry, other), v);
    }
    // −∂V/∂q, what the rigid motion adds, and what the velocity takes away.
    let brake = f.z * turn + f.w * tilt + elements[first + 5u].x * end;
    let force = select(-k.w * turn, f.x * end, is_u);
    return vec2<f32>(force + f.y * tilt) - vec2<f32>(0.0, brake);
}

fn of_wrap(row: Row, entry: u32, first: u32, role: u32) -> vec2<f32> {
    let a = elements[first];
    let b = elements[first + 1u];
    let out_a = elements[first + 2u];
    let out_b = elements[first + 3u];
    let force_a = elements[first + 4u];
    let force_b = elements[first + 5u];
    let brake = elements[first + 6u];
    let on_a = vec4<f32>(1.0, a.w - 1.0, -a.w, 0.0);
    let on_b = vec4<f32>(0.0, b.w - 1.0, -b.w, 1.0);
    let part = row.part;
    let turn = on_a[role] * a[part] + on_b[role] * b[part];
    let in_a = on_a[role] * out_a[part];
    let in_b = on_b[role] * out_b[part];
    for (var other = 0u; other < 4u; other++) {
        let v = force_a.w * turn * (on_a[other] * a.xyz + on_b[other] * b.xyz)
            + out_a.w * in_a * on_a[other] * out_a.xyz
            + out_b.w * in_b * on_b[other] * out_b.xyz;
        add(row, column(entry, other), vec4<f32>(v, 0.0));
    }
    let force = on_a[role] * force_a[part] + on_b[role] * force_b[part];
    return vec2<f32>(force, force - force_b.w * turn - brake.x * in_a - brake.y * in_b);
}

fn of_shear(row: Row, entry: u32, first: u32, role: u32) -> vec2<f32> {
    let a = elements[first];
    let b = elements[first + 1u];
    var turns = array<vec3<f32>, 4>(a.xyz, -a.xyz, -b.xyz, b.xyz);
    let turn = turns[role][row.part];
    for (var other = 0u; other < 4u; other++) {
        add(row, column(entry, other), vec4<f32>(a.w * turn * turns[other], 0.0));
    }
    return vec2<f32>(b.w * turn, (b.w - elements[first + 2u].w) * turn);
}

// Eight invocations a node, each with every eighth of its rows.
@compute @workgroup_size(WIDE)
fn gather(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x / 8u >= counts.node_count {
        return;
    }
    let node = nodes[counts.first_node + id.x / 8u];
    for (var i = id.x % 8u; i < node.size; i += 8u) {
        let width = node.width;
        for (var j = 0u; j < width + RIGID; j++) {
            values[node.value + i + j * node.size] = 0.0;
        }
        var sum = vec2<f32>(0.0);
        for (var entry = node.entry; entry < node.entry_end; entry += 3u) {
            let word = entries[entry];
            let kind = word & 3u;
            let role = (word >> 2u) & 3u;
            let index = word >> 4u;
            let place = column(entry, role).y;
            if i >= 3u && place != i {
                continue;
            }
            let row = Row(node.value + i, node.size, node.value + i + width * node.size, min(i, 3u));
            if kind == OF_SEGMENT {
                sum += of_segment(row, entry, index * SEGMENT_OUT, role);
            } else if kind == OF_BEND {
                sum += of_bend(row, entry, counts.bends_at + index * BEND_OUT, role);
            } else if kind == OF_WRAP {
                sum += of_wrap(row, entry, counts.wraps_at + index * WRAP_OUT, role);
            } else {
                sum += of_shear(row, entry, counts.shears_at + index * SHEAR_OUT, role);
            }
        }
        load[node.dof + i] = sum;
    }
}
