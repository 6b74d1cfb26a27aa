// Wrapping of two yarns around each other: `wrap.rs`.
@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<uniform> counts: Counts;
@group(0) @binding(2) var<storage, read> wraps: array<Wrap>;
@group(0) @binding(3) var<storage, read> materials: array<Material>;
@group(0) @binding(4) var<storage, read> position: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read> velocity: array<vec4<f32>>;
@group(0) @binding(6) var<storage, read_write> elements: array<vec4<f32>>;

// One wing of the hinge: an outer point against the axis.
struct Wing {
    t: f32,
    out: vec3<f32>,
    s: f32,
    s_by_h: f32,
    slope: f32,
    curvature: f32,
}

fn wing(r: vec3<f32>, e: vec3<f32>, axis: f32, fade: f32) -> Wing {
    let along = dot(r, e);
    let across = r - along * e;
    let height = length(across);
    let root = max(sqrt(height * height + fade * fade), LEAST_LENGTH);
    let faded = (fade / root) * (fade / root);
    return Wing(
        along / axis,
        across / max(height, LEAST_LENGTH),
        height / root,
        1.0 / root,
        faded / root,
        -3.0 * (height / root) * faded / (root * root),
    );
}

@compute @workgroup_size(WIDE)
fn wrap(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= counts.wraps {
        return;
    }
    let term = wraps[id.x];
    let yarn = materials[term.dye];
    let h = params.h;
    let x_0 = position[term.node_1].xyz;
    let r = position[term.node_2].xyz - x_0;
    let axis = max(length(r), LEAST_LENGTH);
    let e = r / axis;
    let a = wing(position[term.node_0].xyz - x_0, e, axis, yarn.wrap_fade);
    let b = wing(position[term.node_3].xyz - x_0, e, axis, yarn.wrap_fade);
    let n_a = cross(e, a.out);
    let n_b = -cross(e, b.out);
    let cos_psi = dot(n_a, n_b);
    let sin_psi = dot(e, cross(n_a, n_b));
    let has_own = term.own_sin != 0.0 || term.own_cos != 0.0;
    let sin_rest = term.handedness * select(yarn.wrap_sin, term.own_sin, has_own);
    let cos_rest = select(yarn.wrap_cos, term.own_cos, has_own);
    let cosine = cos_psi * cos_rest + sin_psi * sin_rest;
    let sine = sin_psi * cos_rest - cos_psi * sin_rest;
    let k = yarn.wrap * term.rest;

    let force_a = k * (-sine * a.s_by_h * b.s * n_a - cosine * a.slope * b.s * a.out);
    let force_b = k * (-sine * a.s * b.s_by_h * n_b - cosine * a.s * b.slope * b.out);
    let damped = h * (h + yarn.stiffness_damping);
    let turn_a = -a.s_by_h * b.s * n_a;
    let turn_b = -a.s * b.s_by_h * n_b;
    let inward = damped * k * max(cosine, 0.0);
    let inward_a = -inward * a.curvature * b.s;
    let inward_b = -inward * a.s * b.curvature;

    // Velocities of the outer points against the axis.
    let v_0 = velocity[term.node_1].xyz;
    let v_axis = velocity[term.node_2].xyz - v_0;
    let v_a = velocity[term.node_0].xyz - v_0 - a.t * v_axis;
    let v_b = velocity[term.node_3].xyz - v_0 - b.t * v_axis;
    let turning = damped * k * (dot(turn_a, v_a) + dot(turn_b, v_b));

    let first = counts.wraps_at + id.x * WRAP_OUT;
    elements[first] = vec4<f32>(turn_a, a.t);
    elements[first + 1u] = vec4<f32>(turn_b, b.t);
    elements[first + 2u] = vec4<f32>(a.out, inward_a);
    elements[first + 3u] = vec4<f32>(b.out, inward_b);
    elements[first + 4u] = vec4<f32>(-h * force_a, damped * k);
    elements[first + 5u] = vec4<f32>(-h * force_b, turning);
    elements[first + 6u] = vec4<f32>(inward_a * dot(a.out, v_a), inward_b * dot(b.out, v_b), 0.0, 0.0);
}
