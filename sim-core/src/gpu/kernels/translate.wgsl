// Makes the error of the solution zero along translations: `gradients::translate`. What resists a translation is the
// mass of the yarn and what holds it.
@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> nodes: array<Node>;
@group(0) @binding(2) var<storage, read> held: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> r: array<f32>;
@group(0) @binding(4) var<storage, read> x: array<f32>;
@group(0) @binding(5) var<storage, read_write> sums: array<vec4<f32>>;
@group(0) @binding(6) var<storage, read_write> moving: array<vec4<f32>>;
@group(0) @binding(7) var<storage, read_write> shift: vec4<f32>;
@group(0) @binding(8) var<storage, read_write> held_sums: array<vec4<f32>>;

var<workgroup> lanes: array<array<vec4<f32>, 2>, WIDE>;

fn sum_of_lanes(lane: u32) -> array<vec4<f32>, 2> {
    for (var span = WIDE / 2u; span > 0u; span /= 2u) {
        workgroupBarrier();
        if lane < span {
            for (var k = 0u; k < 2u; k++) {
                lanes[lane][k] += lanes[lane + span][k];
            }
        }
    }
    workgroupBarrier();
    return lanes[0];
}

// What holds the fabric against the world, which contacts of its layers do not.
@compute @workgroup_size(WIDE)
fn held_span(@builtin(local_invocation_index) lane: u32, @builtin(workgroup_id) id: vec3<u32>) {
    var mine: array<vec4<f32>, 2>;
    for (var k = 0u; k < SUM_SPAN / WIDE; k++) {
        let i = id.x * SUM_SPAN + k * WIDE + lane;
        if i < params.node_count {
            mine[0] += held[3u * i];
            mine[1] += vec4<f32>(held[3u * i + 1u].xy, (1.0 + params.h * params.mass_damping) * nodes[i].mass, 0.0);
        }
    }
    lanes[lane] = mine;
    let all = sum_of_lanes(lane);
    if lane == 0u {
        held_sums[2u * id.x] = all[0];
        held_sums[2u * id.x + 1u] = all[1];
    }
}

// The residual along translations.
@compute @workgroup_size(WIDE)
fn translate_span(@builtin(local_invocation_index) lane: u32, @builtin(workgroup_id) id: vec3<u32>) {
    var mine: array<vec4<f32>, 2>;
    for (var k = 0u; k < SUM_SPAN / WIDE; k++) {
        let i = id.x * SUM_SPAN + k * WIDE + lane;
        if i < params.node_count {
            let dof = nodes[i].dof;
            mine[0] += vec4<f32>(r[dof], r[dof + 1u], r[dof + 2u], 0.0);
        }
    }
    lanes[lane] = mine;
    let all = sum_of_lanes(lane);
    if lane == 0u {
        sums[id.x] = all[0];
    }
}

@compute @workgroup_size(WIDE)
fn translate(@builtin(local_invocation_index) lane: u32) {
    let spans = (params.node_count + SUM_SPAN - 1u) / SUM_SPAN;
    var mine: array<vec4<f32>, 2>;
    for (var i = lane; i < spans; i += WIDE) {
        mine[0] += held_sums[2u * i];
        mine[1] += held_sums[2u * i + 1u];
    }
    lanes[lane] = mine;
    let all = sum_of_lanes(lane);
    workgroupBarrier();
    mine = array<vec4<f32>, 2>();
    for (var i = lane; i < spans; i += WIDE) {
        mine[0] += sums[i];
    }
    lanes[lane] = mine;
    let left = sum_of_lanes(lane)[0].xyz;
    if lane == 0u {
        let mass = all[1].z;
        let first = vec3<f32>(all[0].x + mass, all[1].y, all[1].x) / mass;
        let second = vec3<f32>(all[1].y, all[0].y + mass, all[0].w) / mass;
        let third = vec3<f32>(all[1].x, all[0].w, all[0].z + mass) / mass;
        let rest = left / mass;
        let determinant = dot(first, cross(second, third));
        let found = (rest.x * cross(second, third) + rest.y * cross(third, first) + rest.z * cross(first, second)) / determinant;
        let is_good = is_finite(found.x) && is_finite(found.y) && is_finite(found.z);
        shift = vec4<f32>(select(vec3<f32>(0.0), found, is_good), 0.0);
    }
}

// The velocities that were solved for.
@compute @workgroup_size(WIDE)
fn settle(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x < params.node_count {
        let dof = nodes[id.x].dof;
        moving[id.x] = vec4<f32>(x[dof], x[dof + 1u], x[dof + 2u], 0.0) + shift;
    }
}
