// Bending between two segments: `bend.rs`.
@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<uniform> counts: Counts;
@group(0) @binding(2) var<storage, read> bends: array<Bend>;
@group(0) @binding(3) var<storage, read> materials: array<Material>;
@group(0) @binding(4) var<storage, read> position: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read> velocity: array<vec4<f32>>;
@group(0) @binding(6) var<storage, read> visits: array<vec4<f32>>;
@group(0) @binding(7) var<storage, read> rigid: Rigid;
@group(0) @binding(8) var<storage, read_write> elements: array<vec4<f32>>;

@compute @workgroup_size(WIDE)
fn bend(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= counts.bends {
        return;
    }
    let term = bends[id.x];
    let yarn = materials[term.dye];
    let h = params.h;
    let a = position[term.node_1].xyz - position[term.node_0].xyz;
    let b = position[term.node_2].xyz - position[term.node_1].xyz;
    let length_a = max(length(a), LEAST_LENGTH);
    let length_b = max(length(b), LEAST_LENGTH);
    let d_a = a / length_a;
    let d_b = b / length_b;
    let binormal = cross(d_a, d_b);
    let sine = length(binormal);
    // In single precision the binormal of a straighter yarn is noise.
    var n = binormal / max(sine, 1e-30);
    if sine < 1e-7 {
        n = any_across(unit_or(d_a, vec3<f32>(1.0, 0.0, 0.0)));
    }
    let theta = angle(sine, dot(d_a, d_b));
    let u_0 = visits[term.visit_0];
    let u_2 = visits[term.visit_2];
    let du = max(term.laid - params.taken_in * term.taken + (u_2.x - u_0.x), LEAST_LENGTH);

    let jam = BEND_JAM_FACTOR * yarn.bend;
    let over = max(theta - term.jam_angle, 0.0);
    let f = yarn.bend * theta * theta + jam * over * over;
    var slope = 2.0 * yarn.bend * theta + 2.0 * jam * over;
    let curvature = 2.0 * yarn.bend + select(0.0, 2.0 * jam, over > 0.0);

    let by_a = -cross(n, d_a) / length_a;
    let by_b = cross(n, d_b) / length_b;
    let by_du = -slope / (curvature * du);
    let damped = h * (h + yarn.stiffness_damping);
    let in_plane = damped * curvature / du;
    let rest = damped * max(2.0 * f - slope * slope / curvature, 0.0) / (du * du * du);
    // f'/Δu cot(θ/2)/2; θ → 0: 2 k_b/Δu. sin θ/(1 + cos θ) = tan(θ/2).
    let half_tangent = tan(0.5 * max(theta, 1e-4));
    let steep = select(slope, 2e-4 * yarn.bend, theta < 1e-4);
    let tilt = max(steep / (2.0 * half_tangent) / du, 0.0);

    let v_a = velocity[term.node_1].xyz - velocity[term.node_0].xyz;
    let v_b = velocity[term.node_2].xyz - velocity[term.node_1].xyz;
    let slip = u_2.y - u_0.y;
    let bending = in_plane * (dot(by_a, v_a) + dot(by_b, v_b) + by_du * slip);
    let tilting = damped * tilt * (dot(n, v_b) / length_b - dot(n, v_a) / length_a);
    let omega = vec3<f32>(rigid.omega_x, rigid.omega_y, rigid.omega_z);
    let spin = damped * tilt * dot(n, cross(omega, d_b - d_a));

    let first = counts.bends_at + id.x * BEND_OUT;
    elements[first] = vec4<f32>(by_a, in_plane);
    elements[first + 1u] = vec4<f32>(by_b, damped * tilt);
    elements[first + 2u] = vec4<f32>(n, by_du);
    elements[first + 3u] = vec4<f32>(1.0 / length_a, 1.0 / length_b, rest, h * slope / du);
    elements[first + 4u] = vec4<f32>(h * f / (du * du), spin, bending, tilting);
    elements[first + 5u] = vec4<f32>(rest * slip, 0.0, 0.0, 0.0);
}
