// Yarn for a renderer on the same device; see `drawn.rs`. Where yarn lies, entry by entry.
@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> lays: array<Lay>;
@group(0) @binding(2) var<storage, read> points: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> visits: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read_write> drawn: array<Drawn>;

// A control point; one that is missing lies between its neighbours.
fn point_at(lay: Lay) -> vec3<f32> {
    let p = points[lay.point];
    return select(0.5 * (points[lay.before].xyz + points[lay.after].xyz), p.xyz, p.w > 0.0);
}

@compute @workgroup_size(WIDE)
fn lay_out(@builtin(global_invocation_id) id: vec3<u32>) {
    let i = id.x;
    if i >= arrayLength(&lays) {
        return;
    }
    let lay = lays[i];
    var x = point_at(lay);
    if lay.mirror != NONE {
        x = 2.0 * point_at(lays[lay.mirror]) - x;
    }
    x += vec3<f32>(params.origin_x, params.origin_y, params.origin_z);
    drawn[i].x = x.x;
    drawn[i].y = x.y;
    drawn[i].z = x.z;
    drawn[i].arc = lay.arc + visits[lay.visit].x / lay.diameter;
    drawn[i].stretch = i | lay.mark;
}
