// Where each run of drawn yarn is, for a renderer to leave out what is not seen; see `drawn.rs`.
@group(0) @binding(0) var<storage, read> runs: array<Part>;
@group(0) @binding(1) var<storage, read> drawn: array<Drawn>;
@group(0) @binding(2) var<storage, read_write> bounds: array<Bound>;

fn position(i: u32) -> vec3<f32> {
    return vec3<f32>(drawn[i].x, drawn[i].y, drawn[i].z);
}

@compute @workgroup_size(NARROW)
fn bound(@builtin(global_invocation_id) id: vec3<u32>) {
    let run = runs[min(id.x, arrayLength(&runs) - 1u)];
    if id.x >= arrayLength(&runs) || run.count == 0u {
        return;
    }
    var middle = vec3<f32>(0.0);
    for (var k = 0u; k <= run.count; k++) {
        middle += position(run.first + k) / f32(run.count + 1u);
    }
    var far = distance(middle, position(run.first));
    var yarn = 0.0;
    for (var k = 1u; k <= run.count; k++) {
        let x = position(run.first + k);
        far = max(far, distance(middle, x));
        yarn += distance(x, position(run.first + k - 1u));
    }
    bounds[id.x] = Bound(middle.x, middle.y, middle.z, far, yarn / f32(run.count));
}
