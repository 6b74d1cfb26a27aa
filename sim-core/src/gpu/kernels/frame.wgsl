// The reference normal at each control point of drawn yarn; see `drawn.rs`.
@group(0) @binding(0) var<storage, read> lays: array<Lay>;
@group(0) @binding(1) var<storage, read> normals: array<vec4<f32>>;
@group(0) @binding(2) var<storage, read_write> drawn: array<Drawn>;

fn position(i: u32) -> vec3<f32> {
    return vec3<f32>(drawn[i].x, drawn[i].y, drawn[i].z);
}

@compute @workgroup_size(WIDE)
fn frame(@builtin(global_invocation_id) id: vec3<u32>) {
    let i = id.x;
    if i >= arrayLength(&lays) || lays[i].inner == 0u {
        return;
    }
    let tangent = direction_at(position(i - 1u), position(i), position(i + 1u));
    let front = normals[lays[i].node].xyz;
    let across = front - dot(front, tangent) * tangent;
    // Where yarn runs along the normal, that says nothing.
    let normal = unit_or(select(vec3<f32>(0.0), across, length(across) > 1e-3), any_across(tangent));
    drawn[i].normal_x = normal.x;
    drawn[i].normal_y = normal.y;
    drawn[i].normal_z = normal.z;
}
