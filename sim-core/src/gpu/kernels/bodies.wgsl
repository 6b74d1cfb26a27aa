// Contact of each node with the bodies around: `body.rs`, `body_contact.rs`, `closed_mesh.rs`. Begins the sum of what holds a
// node: the six numbers of a symmetric block (xx, yy, zz, yz | xz, xy), an impulse (first three of the third vector), and what
// the velocities of other nodes take to it (last two of the second and last of the third).
@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> nodes: array<Node>;
@group(0) @binding(2) var<storage, read> bodies: array<Body>;
@group(0) @binding(3) var<storage, read> fields: array<f32>;
@group(0) @binding(4) var<storage, read> position: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read> velocity: array<vec4<f32>>;
@group(0) @binding(6) var<storage, read_write> held: array<vec4<f32>>;
@group(0) @binding(7) var<storage, read_write> touching: atomic<u32>;

fn around(r: vec3<f32>, radius: f32) -> vec4<f32> {
    return vec4<f32>(unit_or(r, vec3<f32>(0.0, 1.0, 0.0)), length(r) - radius);
}

fn of_box(x: vec3<f32>, half: vec3<f32>) -> vec4<f32> {
    let beyond = abs(x) - half;
    let outside = max(beyond, vec3<f32>(0.0));
    let way = select(vec3<f32>(-1.0), vec3<f32>(1.0), x >= vec3<f32>(0.0));
    if any(outside > vec3<f32>(0.0)) {
        let distance = length(outside);
        return vec4<f32>(outside / distance * way, distance);
    }
    let depth = max(beyond.x, max(beyond.y, beyond.z));
    var normal = vec3<f32>(0.0);
    if beyond.x == depth {
        normal.x = way.x;
    } else if beyond.y == depth {
        normal.y = way.y;
    } else {
        normal.z = way.z;
    }
    return vec4<f32>(normal, depth);
}

fn of_mesh(body: Body, x: vec3<f32>) -> vec4<f32> {
    let corners = vec3<u32>(body.corners_x, body.corners_y, body.corners_z);
    let most = vec3<f32>(corners - 1u);
    let place = (x - vec3<f32>(body.a_x, body.a_y, body.a_z)) / body.size;
    let inside = clamp(place, vec3<f32>(0.0), most);
    let first = min(floor(inside), most - 1.0);
    let part = inside - first;
    let cell = vec3<u32>(first);
    let start = body.field + cell.x + corners.x * (cell.y + corners.y * cell.z);
    // Along x at the four edges, along y at the two faces, along z.
    var edges: array<f32, 4>;
    var slopes: array<f32, 4>;
    for (var i = 0u; i < 4u; i++) {
        let at = start + corners.x * ((i & 1u) + corners.y * (i >> 1u));
        edges[i] = mix(fields[at], fields[at + 1u], part.x);
        slopes[i] = fields[at + 1u] - fields[at];
    }
    let near = mix(edges[0], edges[1], part.y);
    let far = mix(edges[2], edges[3], part.y);
    let gradient = vec3<f32>(
        mix(mix(slopes[0], slopes[1], part.y), mix(slopes[2], slopes[3], part.y), part.z),
        mix(edges[1] - edges[0], edges[3] - edges[2], part.z),
        far - near,
    );
    let beyond = body.size * (place - inside);
    let is_inside = all(beyond == vec3<f32>(0.0));
    let normal = unit_or(select(beyond, gradient, is_inside), vec3<f32>(0.0, 1.0, 0.0));
    return vec4<f32>(normal, mix(near, far, part.z) + length(beyond));
}

// Normal and signed distance of the resting body.
fn surface(body: Body, x: vec3<f32>) -> vec4<f32> {
    let a = vec3<f32>(body.a_x, body.a_y, body.a_z);
    let b = vec3<f32>(body.b_x, body.b_y, body.b_z);
    if body.kind == 0u {
        return vec4<f32>(0.0, 1.0, 0.0, x.y - body.a_y);
    } else if body.kind == 1u {
        return around(x - a, body.size);
    } else if body.kind == 2u {
        let axis = b - a;
        let t = clamp(dot(x - a, axis) / max(dot(axis, axis), 1e-30), 0.0, 1.0);
        return around(x - a - t * axis, body.size);
    } else if body.kind == 3u {
        let turn = vec4<f32>(body.turn_x, body.turn_y, body.turn_z, body.turn_w);
        let found = of_box(turned_back(turn, x - a), 0.5 * b);
        return vec4<f32>(turned(turn, found.xyz), found.w);
    }
    return of_mesh(body, x);
}

@compute @workgroup_size(NARROW)
fn hold_off(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= params.node_count {
        return;
    }
    let h = params.h;
    let x = position[id.x].xyz;
    let v = velocity[id.x].xyz;
    let mass = nodes[id.x].mass;
    let stiffness = max(params.stiffness_by_mass, FIRM / nodes[id.x].clearance) * mass;
    var diagonal = vec3<f32>(0.0);
    var beside = vec3<f32>(0.0);
    var impulse = vec3<f32>(0.0);
    var touches = 0u;
    for (var i = 0u; i < params.body_count; i++) {
        let body = bodies[i];
        let to = vec4<f32>(body.to_x, body.to_y, body.to_z, body.to_w);
        let from_turn = vec4<f32>(body.from_x, body.from_y, body.from_z, body.from_w);
        let resting = turned_back(to, x - vec3<f32>(body.to_shift_x, body.to_shift_y, body.to_shift_z));
        let found = surface(body, resting);
        let normal = turned(to, found.xyz);
        let gap = found.w - nodes[id.x].clearance;
        var moving = vec3<f32>(0.0);
        if body.moves != 0u {
            let was = turned(from_turn, resting) + vec3<f32>(body.from_shift_x, body.from_shift_y, body.from_shift_z);
            moving = (x - was) / h;
        }
        if gap + h * min(dot(v, normal), dot(moving, normal)) >= 0.0 {
            continue;
        }
        let past = v - moving;
        let slip = length(past - dot(past, normal) * normal);
        let press = body.friction * stiffness * max(-gap - h * dot(moving, normal), 0.0);
        let drag = min(press / max(slip, 1e-12), MOST_DRAG * mass / h);
        let along = h * (h * stiffness - drag);
        diagonal += along * normal * normal + h * drag;
        beside += along * normal.yzx * normal.zxy;
        impulse += h * (drag * (moving - dot(moving, normal) * normal) - stiffness * gap * normal);
        touches += 1u;
    }
    if touches > 0u {
        atomicAdd(&touching, touches);
    }
    held[3u * id.x] = vec4<f32>(diagonal, beside.x);
    held[3u * id.x + 1u] = vec4<f32>(beside.y, beside.z, 0.0, 0.0);
    held[3u * id.x + 2u] = vec4<f32>(impulse, 0.0);
}
