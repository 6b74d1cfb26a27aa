// The rigid rotation of the fabric, in two stages twice: `rigid.rs`. Of the velocities at the start of a step (`measure`),
// of those at its end (`keep`), and what is left of the residual along translations (`translate`).
@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> nodes: array<Node>;
@group(0) @binding(2) var<storage, read> position: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> moving: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read_write> sums: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read_write> rigid: Rigid;
@group(0) @binding(6) var<storage, read> touching: u32;
// See `layers.wgsl`.
@group(0) @binding(7) var<storage, read_write> heads: array<atomic<u32>>;

var<workgroup> lanes: array<array<vec4<f32>, 3>, WIDE>;

fn sum_of_lanes(lane: u32) -> array<vec4<f32>, 3> {
    for (var span = WIDE / 2u; span > 0u; span /= 2u) {
        workgroupBarrier();
        if lane < span {
            for (var k = 0u; k < 3u; k++) {
                lanes[lane][k] += lanes[lane + span][k];
            }
        }
    }
    workgroupBarrier();
    return lanes[0];
}

fn leave(lane: u32, group: u32, mine: array<vec4<f32>, 3>) {
    lanes[lane] = mine;
    let all = sum_of_lanes(lane);
    if lane == 0u {
        for (var k = 0u; k < 3u; k++) {
            sums[3u * group + k] = all[k];
        }
    }
}

fn total(lane: u32) -> array<vec4<f32>, 3> {
    let spans = (params.node_count + SUM_SPAN - 1u) / SUM_SPAN;
    var mine: array<vec4<f32>, 3>;
    for (var i = lane; i < spans; i += WIDE) {
        for (var k = 0u; k < 3u; k++) {
            mine[k] += sums[3u * i + k];
        }
    }
    lanes[lane] = mine;
    return sum_of_lanes(lane);
}

// Mass, centre and momentum.
@compute @workgroup_size(WIDE)
fn weigh_span(@builtin(local_invocation_index) lane: u32, @builtin(workgroup_id) id: vec3<u32>) {
    var mine: array<vec4<f32>, 3>;
    for (var k = 0u; k < SUM_SPAN / WIDE; k++) {
        let i = id.x * SUM_SPAN + k * WIDE + lane;
        if i < params.node_count {
            let m = nodes[i].mass;
            mine[0] += m * vec4<f32>(position[i].xyz, 1.0);
            mine[1] += m * vec4<f32>(moving[i].xyz, 0.0);
        }
    }
    leave(lane, id.x, mine);
}

@compute @workgroup_size(WIDE)
fn weigh(@builtin(local_invocation_index) lane: u32) {
    let all = total(lane);
    if lane == 0u {
        let mass = all[0].w;
        rigid.mass = mass;
        rigid.center_x = all[0].x / mass;
        rigid.center_y = all[0].y / mass;
        rigid.center_z = all[0].z / mass;
        rigid.mean_x = all[1].x / mass;
        rigid.mean_y = all[1].y / mass;
        rigid.mean_z = all[1].z / mass;
    }
}

// Inertia (xx, yy, zz, – | yz, xz, xy, –) and spin about the centre.
@compute @workgroup_size(WIDE)
fn spin_span(@builtin(local_invocation_index) lane: u32, @builtin(workgroup_id) id: vec3<u32>) {
    var mine: array<vec4<f32>, 3>;
    let center = vec3<f32>(rigid.center_x, rigid.center_y, rigid.center_z);
    let mean = vec3<f32>(rigid.mean_x, rigid.mean_y, rigid.mean_z);
    for (var k = 0u; k < SUM_SPAN / WIDE; k++) {
        let i = id.x * SUM_SPAN + k * WIDE + lane;
        if i < params.node_count {
            let m = nodes[i].mass;
            let x = position[i].xyz - center;
            mine[0] += vec4<f32>(m * (vec3<f32>(dot(x, x)) - x * x), 0.0);
            mine[1] -= vec4<f32>(m * x.yzx * x.zxy, 0.0);
            mine[2] += vec4<f32>(m * cross(x, moving[i].xyz - mean), 0.0);
        }
    }
    leave(lane, id.x, mine);
}

// ω = inertia⁻¹ spin; none where the nodes lie on a line.
fn omega(all: array<vec4<f32>, 3>) -> vec3<f32> {
    let trace = all[0].x + all[0].y + all[0].z;
    let d = all[0].xyz / trace;
    let o = all[1].xyz / trace;
    let first = vec3<f32>(d.x, o.z, o.y);
    let second = vec3<f32>(o.z, d.y, o.x);
    let third = vec3<f32>(o.y, o.x, d.z);
    let determinant = dot(first, cross(second, third));
    if !(determinant > 1e-6) {
        return vec3<f32>(0.0);
    }
    let spin = all[2].xyz / trace;
    return (spin.x * cross(second, third) + spin.y * cross(third, first) + spin.z * cross(first, second)) / determinant;
}

@compute @workgroup_size(WIDE)
fn measure(@builtin(local_invocation_index) lane: u32) {
    let all = total(lane);
    if lane == 0u {
        let found = omega(all);
        rigid.omega_x = found.x;
        rigid.omega_y = found.y;
        rigid.omega_z = found.z;
    }
}

// What has to be added to the rotation at the end of a step, so that the fabric keeps the one it began with.
@compute @workgroup_size(WIDE)
fn keep(@builtin(local_invocation_index) lane: u32) {
    let all = total(lane);
    if lane == 0u {
        var lacks = vec3<f32>(0.0);
        if params.is_free != 0u && touching == 0u {
            let began = vec3<f32>(rigid.omega_x, rigid.omega_y, rigid.omega_z);
            lacks = began / (1.0 + params.h * params.mass_damping) - omega(all);
        }
        rigid.kept_x = lacks.x;
        rigid.kept_y = lacks.y;
        rigid.kept_z = lacks.z;
    }
}

// The largest speed against the mean: how far nodes of different layers may come towards each other.
@compute @workgroup_size(WIDE)
fn race(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x < params.node_count {
        let mean = vec3<f32>(rigid.mean_x, rigid.mean_y, rigid.mean_z);
        atomicMax(&heads[params.cell_count + 1u], bitcast<u32>(length(moving[id.x].xyz - mean)));
    }
}
