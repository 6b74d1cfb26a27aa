// Shear between warp and weft, and what taut yarn presses at their crossing: `shear.rs`, `woven.rs`.
@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<uniform> counts: Counts;
@group(0) @binding(2) var<storage, read> shears: array<Shear>;
@group(0) @binding(3) var<storage, read> position: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> velocity: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read> visits: array<vec4<f32>>;
@group(0) @binding(6) var<storage, read_write> elements: array<vec4<f32>>;

fn press(r: vec3<f32>, laid: f32, climb: f32, stretch: f32, share: f32) -> f32 {
    let l = sqrt(dot(r, r) + climb * climb);
    let yarn = abs(laid);
    return share * max(stretch * (l / yarn - 1.0), 0.0) * climb / l;
}

@compute @workgroup_size(WIDE)
fn shear(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= counts.shears {
        return;
    }
    let term = shears[id.x];
    let h = params.h;
    let a = position[term.node_0].xyz - position[term.node_1].xyz;
    let b = position[term.node_3].xyz - position[term.node_2].xyz;
    let square_a = max(dot(a, a), LEAST_LENGTH * LEAST_LENGTH);
    let square_b = max(dot(b, b), LEAST_LENGTH * LEAST_LENGTH);
    let normal = cross(a, b);
    let sine = length(normal);
    var n = normal / max(sine, 1e-30);
    if sine <= 1e-7 * sqrt(square_a * square_b) {
        n = any_across(unit_or(a, vec3<f32>(1.0, 0.0, 0.0)));
    }
    let gamma = angle(sine, dot(a, b)) - term.rest;
    let over = max(abs(gamma) - term.jam, 0.0);
    let jam = SHEAR_JAM_FACTOR * term.stiffness;
    let slope = term.stiffness * gamma + jam * select(-over, over, gamma >= 0.0);
    let curvature = term.stiffness + select(0.0, jam, over > 0.0);
    let by_a = -cross(n, a) / square_a;
    let by_b = cross(n, b) / square_b;
    let k = h * (h + term.stiffness_damping) * term.length * curvature;
    let v_a = velocity[term.node_0].xyz - velocity[term.node_1].xyz;
    let v_b = velocity[term.node_3].xyz - velocity[term.node_2].xyz;
    let shearing = k * (dot(by_a, v_a) + dot(by_b, v_b));

    let laid_a = term.laid_0 + visits[term.visit_1].x - visits[term.visit_0].x;
    let laid_b = term.laid_1 + visits[term.visit_3].x - visits[term.visit_2].x;
    let front = -term.sense * press(a, laid_a, term.climb_0, term.stretch_0, term.share_0) * n;
    let behind = term.sense * press(b, laid_b, term.climb_1, term.stretch_1, term.share_1) * n;
    let first = counts.shears_at + id.x * SHEAR_OUT;
    elements[first] = vec4<f32>(by_a, k);
    elements[first + 1u] = vec4<f32>(by_b, -h * term.length * slope);
    elements[first + 2u] = vec4<f32>(front, shearing);
    elements[first + 3u] = vec4<f32>(behind, 0.0);
}
