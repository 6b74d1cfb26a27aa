// How far the frame of drawn yarn rolls from each control point to the next; see `drawn.rs`.
@group(0) @binding(0) var<storage, read> lays: array<Lay>;
@group(0) @binding(1) var<storage, read> drawn: array<Drawn>;
@group(0) @binding(2) var<storage, read_write> stretches: array<vec2<f32>>;

fn position(i: u32) -> vec3<f32> {
    return vec3<f32>(drawn[i].x, drawn[i].y, drawn[i].z);
}

fn normal(i: u32) -> vec3<f32> {
    return vec3<f32>(drawn[i].normal_x, drawn[i].normal_y, drawn[i].normal_z);
}

@compute @workgroup_size(WIDE)
fn roll(@builtin(global_invocation_id) id: vec3<u32>) {
    let i = id.x;
    if i >= arrayLength(&lays) || lays[i].inner == 0u || lays[i + 1u].inner == 0u {
        return;
    }
    let a = direction_at(position(i - 1u), position(i), position(i + 1u));
    let b = direction_at(position(i), position(i + 1u), position(i + 2u));
    let n = normal(i);
    // By the smallest rotation of one tangent into the other.
    let moved = n - (a + b) * (dot(b, n) / max(1.0 + dot(a, b), 1e-4));
    let next = normal(i + 1u);
    let sine = dot(cross(b, moved), next);
    let turn = angle(abs(sine), dot(moved, next));
    stretches[i].y = select(turn, -turn, sine < 0.0);
}
