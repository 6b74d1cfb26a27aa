// Mass, stretch, gravity, air and spacing of each segment: `assembly::segment`.
@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<uniform> counts: Counts;
@group(0) @binding(2) var<storage, read> segments: array<Segment>;
@group(0) @binding(3) var<storage, read> materials: array<Material>;
@group(0) @binding(4) var<storage, read> position: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read> velocity: array<vec4<f32>>;
@group(0) @binding(6) var<storage, read> visits: array<vec4<f32>>;
@group(0) @binding(7) var<storage, read> rigid: Rigid;
@group(0) @binding(8) var<storage, read_write> elements: array<vec4<f32>>;

@compute @workgroup_size(WIDE)
fn segment(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= counts.segments {
        return;
    }
    let term = segments[id.x];
    let yarn = materials[term.dye];
    let h = params.h;
    let r = position[term.node_1].xyz - position[term.node_0].xyz;
    let v_0 = velocity[term.node_0].xyz;
    let v_1 = velocity[term.node_1].xyz;
    let u_0 = visits[term.visit_0];
    let u_1 = visits[term.visit_1];
    let length_u = term.laid - params.taken_in * term.taken + (u_1.x - u_0.x);
    let du = max(length_u, LEAST_LENGTH);
    let l = max(sqrt(dot(r, r) + term.climb * term.climb), LEAST_LENGTH);
    let d = r / l;
    let ratio = l / du;
    let share = max(ratio, 0.5 * (1.0 + ratio));
    let w = r / du;

    // Mass: the material at the ends moves with a₀ and a₁.
    let unit = yarn.density * du / 6.0;
    let a_0 = v_0 - w * u_0.y;
    let a_1 = v_1 - w * u_1.y;
    let p_0 = unit * (2.0 * a_0 + a_1);
    let p_1 = unit * (2.0 * a_1 + a_0);
    let speed = 0.5 * length(v_0 + v_1);
    let drag = 0.5 * params.air * yarn.diameter * (speed + yarn.creep * pow(speed, 1.0 / 3.0));
    let damping = h * (yarn.mass_damping + drag / yarn.density);
    let momentum_0 = vec4<f32>(p_0, -dot(w, p_0) + unit * SLIDING_MASS * u_0.y);
    let momentum_1 = vec4<f32>(p_1, -dot(w, p_1) + unit * SLIDING_MASS * u_1.y);

    // Stretch.
    let tension = yarn.stretch * (l - du) / du;
    let by_du = -0.5 * tension * (1.0 + ratio);
    let along = h * h * yarn.stretch / du;
    let across = h * h * max(yarn.stretch * (1.0 / du - 1.0 / l), 0.0);
    let apart = v_1 - v_0;
    let slip = u_1.y - u_0.y;
    let stretching = along * (dot(d, apart) - share * slip);
    let omega = vec3<f32>(rigid.omega_x, rigid.omega_y, rigid.omega_z);
    let spin = across * cross(omega, r);
    let braked_x = stretching * d + across * (apart - d * dot(d, apart));

    // Gravity.
    let weight = yarn.density * vec3<f32>(params.gravity_x, params.gravity_y, params.gravity_z);
    let origin = vec3<f32>(params.origin_x, params.origin_y, params.origin_z);
    let middle = 0.5 * (position[term.node_0].xyz + position[term.node_1].xyz) + origin;
    let weight_x = 0.5 * length_u * weight;
    let weight_u = dot(weight, middle);

    // Contact length, or parallel contact: a force that shortens Δu, and its stiffness.
    var pull: f32;
    var stiffness: f32;
    if term.in_contact != 0u {
        pull = yarn.length * (length_u / term.rest - 1.0);
        stiffness = yarn.length / term.rest;
    } else {
        let overlap = min(term.closeness * yarn.parallel_distance, term.rest) - length_u;
        pull = select(0.0, -yarn.parallel * overlap, overlap > 0.0);
        stiffness = select(0.0, yarn.parallel, overlap > 0.0);
    }
    let slack = yarn.stretch / du * max(share / BEYOND - share * share, 0.0);
    let spacing = h * (h + yarn.stiffness_damping) * stiffness + h * h * slack;

    // Impulse on the second end; the opposite on the first.
    let impulse = vec4<f32>(-h * tension * d + spin, h * (weight_u - by_du - pull));
    let both = vec4<f32>(h * weight_x, 0.0);
    let brake = vec4<f32>(braked_x, -share * stretching + spacing * slip);
    let first = id.x * SEGMENT_OUT;
    elements[first] = vec4<f32>(d, share);
    elements[first + 1u] = vec4<f32>(w, (1.0 + damping) * unit);
    elements[first + 2u] = vec4<f32>(along, across, spacing, tension);
    elements[first + 3u] = both - impulse + momentum_0;
    elements[first + 4u] = both + impulse + momentum_1;
    elements[first + 5u] = both - impulse + brake - damping * momentum_0;
    elements[first + 6u] = both + impulse - brake - damping * momentum_1;
}
