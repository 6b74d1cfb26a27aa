// Compression of each stack, and the springs that stand for the friction it carries: `friction.rs`, `Stepper::add_friction`.
@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> nodes: array<Node>;
@group(0) @binding(2) var<storage, read> stacked: array<Stacked>;
@group(0) @binding(3) var<storage, read> materials: array<Material>;
@group(0) @binding(4) var<storage, read> pull: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read> normals: array<vec4<f32>>;
@group(0) @binding(6) var<storage, read> visits: array<vec4<f32>>;
// Of each stacked visit: anchor and stiffness of its own spring, and of that to the parallel yarn behind it.
@group(0) @binding(7) var<storage, read_write> springs: array<vec4<f32>>;

// Anchor and stiffness for something at `u` that slides with `rate`: `FrictionSpring::new`.
fn spring(anchor: f32, u: f32, rate: f32, limit: f32, stick: f32) -> vec2<f32> {
    let reach = limit / max(stick, 1e-12);
    let moved = clamp(anchor, u - reach, u + reach);
    let stretch = abs(u - moved + params.h * rate);
    return vec2<f32>(moved, min(stick, limit / max(stretch, 1e-12)));
}

@compute @workgroup_size(NARROW)
fn friction(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= params.node_count || nodes[id.x].size <= 4u {
        return;
    }
    let first = nodes[id.x].visit;
    let contacts = nodes[id.x].size - 4u;
    let back = -normals[id.x].xyz;

    // Λ by Thomas' algorithm; pivots going down, solutions going up.
    var whole: array<vec3<f32>, MOST_STACK>;
    var pivots: array<f32, MOST_STACK>;
    var above = 0.0;
    var force = vec3<f32>(0.0);
    for (var i = 0u; i < contacts; i++) {
        force = pull[first + i].xyz - pull[first + i + 1u].xyz + force * above;
        pivots[i] = 2.0 - above;
        above = 1.0 / pivots[i];
        whole[i] = force;
    }
    var below = vec3<f32>(0.0);
    for (var i = contacts; i > 0u; i--) {
        below = (whole[i - 1u] + below) / pivots[i - 1u];
        whole[i - 1u] = below;
    }

    // λ ≥ 0 by projected Gauss–Seidel, along the contact force where yarns cross, along the normal where they are parallel.
    var lambda: array<f32, MOST_STACK>;
    for (var i = 0u; i < contacts; i++) {
        let d = select(unit_or(whole[i], vec3<f32>(0.0)), back, stacked[first + i].parallel != 0u);
        lambda[i] = max(dot(whole[i], d), 0.0);
        whole[i] = d;
    }
    if contacts > 1u {
        for (var sweep = 0u; sweep < SWEEPS; sweep++) {
            var change = 0.0;
            var largest = 0.0;
            for (var i = 0u; i < contacts; i++) {
                var best = dot(pull[first + i].xyz - pull[first + i + 1u].xyz, whole[i]);
                if i > 0u {
                    best += lambda[i - 1u] * dot(whole[i - 1u], whole[i]);
                }
                if i + 1u < contacts {
                    best += lambda[i + 1u] * dot(whole[i + 1u], whole[i]);
                }
                best = max(0.5 * best, 0.0);
                change = max(change, abs(best - lambda[i]));
                largest = max(largest, best);
                lambda[i] = best;
            }
            if change <= 1e-7 * largest {
                break;
            }
        }
    }

    var limits: array<f32, MOST_STACK>;
    for (var i = 0u; i <= contacts; i++) {
        limits[i] = 0.0;
        let v = visits[stacked[first + i].visit];
        springs[first + i] = vec4<f32>(v.z, 0.0, v.w, 0.0);
    }
    for (var i = 0u; i < contacts; i++) {
        let a = stacked[first + i];
        let b = stacked[first + i + 1u];
        let yarn = materials[a.dye];
        let other = materials[b.dye];
        let limit = sqrt(yarn.friction * other.friction) * (lambda[i] + sqrt(yarn.cohesion * other.cohesion));
        if a.parallel == 0u {
            limits[i] += limit;
            limits[i + 1u] += limit;
            continue;
        }
        let apart = visits[a.visit] - visits[b.visit];
        let between = spring(visits[a.visit].w, apart.x, apart.y, limit, yarn.stick);
        springs[first + i].z = between.x;
        springs[first + i].w = between.y;
    }
    for (var i = 0u; i <= contacts; i++) {
        if limits[i] > 0.0 {
            let v = visits[stacked[first + i].visit];
            let own = spring(v.z, v.x, v.y, limits[i], materials[stacked[first + i].dye].stick);
            springs[first + i].x = own.x;
            springs[first + i].y = own.y;
        }
    }
}
