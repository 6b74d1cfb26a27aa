// Solves Lᵀ z = y for one group a workgroup, the later unknowns being known.
@group(0) @binding(0) var<uniform> part: Part;
@group(0) @binding(1) var<storage, read> groups: array<Group>;
@group(0) @binding(2) var<storage, read> rows: array<u32>;
@group(0) @binding(3) var<storage, read> factor: array<f32>;
@group(0) @binding(4) var<storage, read> y: array<f32>;
@group(0) @binding(5) var<storage, read_write> z: array<f32>;
@group(0) @binding(6) var<storage, read> status: Status;

var<workgroup> later: array<f32, NARROW>;
var<workgroup> known: array<f32, MOST_GROUP>;

@compute @workgroup_size(NARROW)
fn backward(@builtin(local_invocation_index) lane: u32, @builtin(workgroup_id) id: vec3<u32>) {
    if status.solved != 0u {
        return;
    }
    let group = groups[part.first + id.x];
    let n = group.size;
    let height = n + group.row_count;
    for (var i = lane; i < n; i += NARROW) {
        known[i] = y[group.dof + i];
    }
    for (var first = 0u; first < group.row_count; first += NARROW) {
        workgroupBarrier();
        if first + lane < group.row_count {
            later[lane] = z[rows[group.row + first + lane]];
        }
        workgroupBarrier();
        let count = min(NARROW, group.row_count - first);
        for (var i = lane; i < n; i += NARROW) {
            let column = group.front + i * height + n + first;
            var sum = 0.0;
            for (var k = 0u; k < count; k++) {
                sum += factor[column + k] * later[k];
            }
            known[i] -= sum;
        }
    }
    workgroupBarrier();
    for (var i = lane; i < n; i += NARROW) {
        let column = group.front + i * height;
        var sum = 0.0;
        for (var k = i; k < n; k++) {
            sum += factor[column + k] * known[k];
        }
        z[group.dof + i] = sum;
    }
}
