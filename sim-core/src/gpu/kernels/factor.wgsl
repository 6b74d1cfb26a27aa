// Incomplete Cholesky factorisation, one workgroup a group: `solver/factor.rs`, left-looking. The front of a group is
// (C⁻¹; Q) with D = C Cᵀ its diagonal block and Q = P C⁻ᵀ, P the rows below; it first takes Q Qᵀ of earlier groups away.
@group(0) @binding(0) var<uniform> part: Part;
@group(0) @binding(1) var<storage, read> nodes: array<Node>;
@group(0) @binding(2) var<storage, read> blocks: array<Block>;
@group(0) @binding(3) var<storage, read> values: array<f32>;
@group(0) @binding(4) var<storage, read> groups: array<Group>;
@group(0) @binding(5) var<storage, read> sources: array<Source>;
// Of each row that two fronts share: its place in the rows of the source (low half), and in the front.
@group(0) @binding(6) var<storage, read> shared_rows: array<u32>;
@group(0) @binding(7) var<storage, read_write> factor: array<f32>;
@group(0) @binding(8) var<storage, read> factor_before: array<f32>;
@group(0) @binding(9) var<uniform> params: Params;

// Rows of C, one after the other.
var<workgroup> triangle: array<f32, MOST_TRIANGLE>;
var<workgroup> failed: u32;

fn row(i: u32) -> u32 {
    return i * (i + 1u) / 2u;
}

fn subtract(group: Group, lane: u32) {
    let height = group.size + group.row_count;
    for (var s = group.source; s < group.source_end; s++) {
        let source = sources[s];
        let earlier = groups[source.group];
        let earlier_height = earlier.size + earlier.row_count;
        for (var pair = lane; pair < source.count * source.columns; pair += NARROW) {
            let i = shared_rows[source.first + pair % source.count];
            let j = shared_rows[source.first + pair / source.count];
            var at_i = earlier.front + earlier.size + (i & 0xffffu);
            var at_j = earlier.front + earlier.size + (j & 0xffffu);
            var sum = 0.0;
            if source.before == 0u {
                for (var k = 0u; k < earlier.size; k++) {
                    sum += factor[at_i] * factor[at_j];
                    at_i += earlier_height;
                    at_j += earlier_height;
                }
            } else {
                for (var k = 0u; k < earlier.size; k++) {
                    sum += factor_before[at_i] * factor_before[at_j];
                    at_i += earlier_height;
                    at_j += earlier_height;
                }
            }
            factor[group.front + (j >> 16u) * height + (i >> 16u)] -= sum;
        }
        storageBarrier();
    }
}

@compute @workgroup_size(NARROW)
fn factorise(@builtin(local_invocation_index) lane: u32, @builtin(workgroup_id) id: vec3<u32>) {
    let group = groups[part.first + id.x];
    let n = group.size;
    let height = n + group.row_count;
    for (var i = lane; i < n * height; i += NARROW) {
        factor[group.front + i] = 0.0;
    }
    storageBarrier();
    for (var m = group.node; m < group.node_end; m++) {
        let node = nodes[m];
        let column = node.dof - group.dof;
        var before = 0u;
        for (var b = node.block; b < node.block_end; b++) {
            let block = blocks[b];
            if block.front != NONE {
                for (var k = lane; k < block.size * node.size; k += NARROW) {
                    let j = k % node.size;
                    let i = k / node.size;
                    let value = values[node.value + (before + i) * node.size + j];
                    let firmer = select(1.0, 1.0 + params.shift, block.front + i == column + j);
                    factor[group.front + (column + j) * height + block.front + i] = firmer * value;
                }
            }
            before += block.size;
        }
    }
    storageBarrier();
    subtract(group, lane);

    // Where dropping has made the block indefinite, a part of its diagonal is added, more with every try.
    // (Of a whole step that takes many iterations because of it, see `shift.rs`.)
    var shift = 0.0;
    for (var attempt = 0u; attempt < 8u; attempt++) {
        if lane == 0u {
            failed = 0u;
        }
        for (var k = lane; k < n * n; k += NARROW) {
            let j = k % n;
            let i = k / n;
            if j <= i {
                let value = factor[group.front + j * height + i];
                triangle[row(i) + j] = select(value, value + shift * abs(value) + select(0.0, 1e-30, shift > 0.0), i == j);
            }
        }
        workgroupBarrier();
        for (var j = 0u; j < n; j++) {
            let pivot = triangle[row(j) + j];
            let good = pivot > 0.0;
            let root = sqrt(select(1.0, pivot, good));
            for (var i = j + 1u + lane; i < n; i += NARROW) {
                triangle[row(i) + j] /= root;
            }
            workgroupBarrier();
            for (var i = j + 1u + lane; i < n; i += NARROW) {
                let l = triangle[row(i) + j];
                for (var k = j + 1u; k <= i; k++) {
                    triangle[row(i) + k] -= l * triangle[row(k) + j];
                }
            }
            if lane == 0u {
                triangle[row(j) + j] = root;
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

    // C⁻¹, a column an invocation: its own numbers alone.
    for (var c = lane; c < n; c += NARROW) {
        let column = group.front + c * height;
        for (var i = 0u; i < c; i++) {
            factor[column + i] = 0.0;
        }
        for (var i = c; i < n; i++) {
            var sum = select(0.0, 1.0, i == c);
            for (var k = c; k < i; k++) {
                sum -= triangle[row(i) + k] * factor[column + k];
            }
            factor[column + i] = sum / triangle[row(i) + i];
        }
    }
    // Q = P C⁻ᵀ, a row an invocation.
    for (var r = lane; r < group.row_count; r += NARROW) {
        let first = group.front + n + r;
        for (var i = 0u; i < n; i++) {
            var sum = factor[first + i * height];
            for (var k = 0u; k < i; k++) {
                sum -= triangle[row(i) + k] * factor[first + k * height];
            }
            factor[first + i * height] = sum / triangle[row(i) + i];
        }
    }
}
