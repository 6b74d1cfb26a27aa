// Solves L y = r for one group a workgroup, and hands Q y on to the rows below.
@group(0) @binding(0) var<uniform> part: Part;
@group(0) @binding(1) var<storage, read> nodes: array<Node>;
@group(0) @binding(2) var<storage, read> groups: array<Group>;
// For each node where in `handed` the changes of its unknowns begin.
@group(0) @binding(3) var<storage, read> incoming: array<u32>;
@group(0) @binding(4) var<storage, read> factor: array<f32>;
@group(0) @binding(5) var<storage, read> r: array<f32>;
@group(0) @binding(6) var<storage, read_write> handed: array<f32>;
@group(0) @binding(7) var<storage, read_write> y: array<f32>;
@group(0) @binding(8) var<storage, read> status: Status;

// What each invocation has of the sums of its unknowns.
var<workgroup> shares: array<f32, SHARES>;
var<workgroup> known: array<f32, MOST_GROUP>;
var<workgroup> solved: array<f32, MOST_GROUP>;

@compute @workgroup_size(WIDE)
fn forward(@builtin(local_invocation_index) lane: u32, @builtin(workgroup_id) id: vec3<u32>) {
    if status.solved != 0u {
        return;
    }
    let group = groups[part.first + id.x];
    let n = group.size;
    let height = n + group.row_count;
    // Each sixteen of invocations has every sixteenth unknown, and goes down what is handed to it together.
    for (var b = 0u; b < ACROSS; b++) {
        let i = b * SIDE + lane / SIDE;
        var sum = 0.0;
        if i < n {
            var m = group.node;
            while m + 1u < group.node_end && nodes[m + 1u].dof <= group.dof + i {
                m++;
            }
            let place = group.dof + i - nodes[m].dof;
            for (var k = nodes[m].incoming + lane % SIDE; k < nodes[m].incoming_end; k += SIDE) {
                sum += handed[incoming[k] + place];
            }
        }
        shares[b * WIDE + lane] = sum;
    }
    workgroupBarrier();
    for (var i = lane; i < n; i += WIDE) {
        var sum = r[group.dof + i];
        for (var k = 0u; k < SIDE; k++) {
            sum -= shares[(i / SIDE) * WIDE + (i % SIDE) * SIDE + k];
        }
        known[i] = sum;
    }
    workgroupBarrier();
    for (var i = lane; i < n; i += WIDE) {
        var sum = 0.0;
        for (var k = 0u; k <= i; k++) {
            sum += factor[group.front + k * height + i] * known[k];
        }
        solved[i] = sum;
        y[group.dof + i] = sum;
    }
    workgroupBarrier();
    for (var i = lane; i < group.row_count; i += WIDE) {
        var sum = 0.0;
        for (var k = 0u; k < n; k++) {
            sum += factor[group.front + k * height + n + i] * solved[k];
        }
        handed[group.row + i] = sum;
    }
}
