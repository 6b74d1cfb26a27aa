// The diagonal blocks of a level, one workgroup a group: D = C Cᵀ, of which C⁻¹ is kept (`solver/panel.rs`).
@group(0) @binding(0) var<uniform> part: Part;
@group(0) @binding(1) var<storage, read> groups: array<Group>;
@group(0) @binding(2) var<storage, read_write> factor: array<f32>;

// Rows up to the diagonal, one after the other: to the left of the column that is being eliminated C⁻¹ as far as it has come, to the right what is
// left of D. Every column takes its product with itself away from the right, and its product with its own row from the left, as Gauss and
// Jordan have it.
var<workgroup> triangle: array<f32, MOST_TRIANGLE>;
// The row of C⁻¹ up to the diagonal, and from there on the column of C.
var<workgroup> hook: array<f32, MOST_GROUP>;
var<workgroup> failed: u32;

fn row(i: u32) -> u32 {
    return i * (i + 1u) / 2u;
}

@compute @workgroup_size(WIDE)
fn eliminate(@builtin(local_invocation_index) lane: u32, @builtin(workgroup_id) id: vec3<u32>) {
    let group = groups[part.first + id.x];
    let n = group.size;
    let height = n + group.row_count;

    // Dropping can leave a block that is not positive definite; then a part of its diagonal is added, more with every try.
    // (Of a whole step that takes many iterations because of it, see `shift.rs`.)
    var shift = 0.0;
    for (var attempt = 0u; attempt < 8u; attempt++) {
        if lane == 0u {
            failed = 0u;
        }
        for (var j = lane / SIDE; j < n; j += SIDE) {
            for (var i = j + lane % SIDE; i < n; i += SIDE) {
                let value = factor[group.front + j * height + i];
                triangle[row(i) + j] = select(value, value + shift * abs(value) + select(0.0, 1e-30, shift > 0.0), i == j);
            }
        }
        workgroupBarrier();
        for (var j = 0u; j < n; j++) {
            let own = row(j);
            let pivot = triangle[own + j];
            let good = pivot > 0.0;
            let by = 1.0 / sqrt(select(1.0, pivot, good));
            for (var i = lane; i < n; i += WIDE) {
                if i > j {
                    hook[i] = triangle[row(i) + j] * by;
                    triangle[row(i) + j] = 0.0;
                } else if i < j {
                    hook[i] = triangle[own + i] * by;
                    triangle[own + i] = hook[i];
                } else {
                    hook[i] = by;
                }
            }
            workgroupBarrier();
            for (var i = j + 1u + lane / SIDE; i < n; i += SIDE) {
                for (var k = lane % SIDE; k <= i; k += SIDE) {
                    triangle[row(i) + k] -= hook[i] * hook[k];
                }
            }
            if lane == 0u {
                triangle[own + j] = by;
                if !good {
                    failed = 1u;
                }
            }
            workgroupBarrier();
        }
        if workgroupUniformLoad(&failed) == 0u {
            break;
        }
        shift = select(3.0 * shift, 1e-3, shift == 0.0);
    }

    for (var j = lane / SIDE; j < n; j += SIDE) {
        for (var i = lane % SIDE; i < n; i += SIDE) {
            var value = 0.0;
            if j <= i {
                value = triangle[row(i) + j];
            }
            factor[group.front + j * height + i] = value;
        }
    }
}
