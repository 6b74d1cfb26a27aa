// Solves Lᵀ z = y for one group a workgroup, the later unknowns being known.
@group(0) @binding(0) var<uniform> part: Part;
@group(0) @binding(1) var<storage, read> groups: array<Group>;
@group(0) @binding(2) var<storage, read> rows: array<u32>;
@group(0) @binding(3) var<storage, read> factor: array<f32>;
@group(0) @binding(4) var<storage, read> y: array<f32>;
@group(0) @binding(5) var<storage, read_write> z: array<f32>;
@group(0) @binding(6) var<storage, read> status: Status;

// What each invocation has of the sums of its columns.
var<workgroup> shares: array<f32, SHARES>;
var<workgroup> known: array<f32, MOST_GROUP>;

@compute @workgroup_size(WIDE)
fn backward(@builtin(local_invocation_index) lane: u32, @builtin(workgroup_id) id: vec3<u32>) {
    if status.solved != 0u {
        return;
    }
    let group = groups[part.first + id.x];
    let n = group.size;
    let height = n + group.row_count;
    // Invocations go down the rows in sixteens, as these lie; each sixteen has every sixteenth column.
    var sums: array<f32, ACROSS>;
    for (var k = lane % SIDE; k < group.row_count; k += SIDE) {
        let later = z[rows[group.row + k]];
        for (var b = 0u; b < ACROSS; b++) {
            let i = b * SIDE + lane / SIDE;
            if i < n {
                sums[b] += factor[group.front + i * height + n + k] * later;
            }
        }
    }
    for (var b = 0u; b < ACROSS; b++) {
        shares[b * WIDE + lane] = sums[b];
    }
    workgroupBarrier();
    for (var i = lane; i < n; i += WIDE) {
        var sum = y[group.dof + i];
        for (var k = 0u; k < SIDE; k++) {
            sum -= shares[(i / SIDE) * WIDE + (i % SIDE) * SIDE + k];
        }
        known[i] = sum;
    }
    workgroupBarrier();
    for (var i = lane; i < n; i += WIDE) {
        let column = group.front + i * height;
        var sum = 0.0;
        for (var k = i; k < n; k++) {
            sum += factor[column + k] * known[k];
        }
        z[group.dof + i] = sum;
    }
}
