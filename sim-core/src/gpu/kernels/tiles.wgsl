// Products of panels, a workgroup for some rows of a front: `solver/elimination.rs`.
@group(0) @binding(0) var<uniform> part: Part;
@group(0) @binding(1) var<storage, read> groups: array<Group>;
@group(0) @binding(2) var<storage, read> tiles: array<Tile>;
@group(0) @binding(3) var<storage, read> sources: array<Source>;
@group(0) @binding(4) var<storage, read> shared_rows: array<u32>;
@group(0) @binding(5) var<storage, read_write> factor: array<f32>;
@group(0) @binding(6) var<storage, read> factor_before: array<f32>;

// As many columns of both panels as there are invocations on a side, one after the other, each in fours.
var<workgroup> left: array<vec4<f32>, WIDE>;
var<workgroup> right: array<vec4<f32>, WIDE>;
var<workgroup> beyond: array<f32, WIDE>;

// An invocation has four rows of the product, and five columns of those: four beside each other, and one beyond the first 64.
struct Product {
    a: vec4<f32>,
    b: vec4<f32>,
    c: vec4<f32>,
    d: vec4<f32>,
    e: vec4<f32>,
}

fn multiplied(lane: u32, depth: u32, columns: u32, before: Product) -> Product {
    var sums = before;
    for (var k = 0u; k < depth; k++) {
        let rows = left[k * SIDE + lane % SIDE];
        let by = right[k * SIDE + lane / SIDE];
        sums.a += by.x * rows;
        sums.b += by.y * rows;
        sums.c += by.z * rows;
        sums.d += by.w * rows;
        if columns > TILE {
            sums.e += beyond[k * SIDE + lane / SIDE] * rows;
        }
    }
    return sums;
}

// Its columns one after the other.
fn sums_of(sums: Product, which: u32) -> vec4<f32> {
    switch which {
        case 0u: { return sums.a; }
        case 1u: { return sums.b; }
        case 2u: { return sums.c; }
        case 3u: { return sums.d; }
        default: { return sums.e; }
    }
}

fn column_of(lane: u32, which: u32) -> u32 {
    return select(TILE + lane / SIDE, 4u * (lane / SIDE) + which, which < 4u);
}

// Q = P C⁻ᵀ, where C⁻¹ is already.
@compute @workgroup_size(WIDE)
fn divide(@builtin(local_invocation_index) lane: u32, @builtin(workgroup_id) id: vec3<u32>) {
    let tile = tiles[part.first + id.x];
    let group = groups[tile.group];
    let n = group.size;
    let height = n + group.row_count;
    let i = 4u * (lane % SIDE);
    var sums = Product();
    for (var first = 0u; first < n; first += SIDE) {
        let depth = min(SIDE, n - first);
        workgroupBarrier();
        if lane / SIDE < depth {
            let column = group.front + (first + lane / SIDE) * height;
            if i < tile.row_count {
                var rows = vec4<f32>(0.0);
                for (var a = 0u; a < min(4u, tile.row_count - i); a++) {
                    rows[a] = factor[column + tile.row + i + a];
                }
                left[lane] = rows;
            }
            // Above the diagonal are zeros.
            if i < n {
                var rows = vec4<f32>(0.0);
                for (var a = 0u; a < min(4u, n - i); a++) {
                    rows[a] = factor[column + i + a];
                }
                right[lane] = rows;
            }
            if TILE + lane % SIDE < n {
                beyond[lane] = factor[column + TILE + lane % SIDE];
            }
        }
        workgroupBarrier();
        if i < tile.row_count {
            sums = multiplied(lane, depth, n, sums);
        }
    }
    for (var b = 0u; b < ACROSS; b++) {
        let column = column_of(lane, b);
        if i < tile.row_count && column < n {
            let at = group.front + column * height + tile.row + i;
            let sum = sums_of(sums, b);
            for (var a = 0u; a < min(4u, tile.row_count - i); a++) {
                factor[at + a] = sum[a];
            }
        }
    }
}

// An entry of an earlier group.
fn earlier(source: Source, at: u32) -> f32 {
    if source.before == 0u {
        return factor[at];
    }
    return factor_before[at];
}

// Takes Q Qᵀ of earlier groups away from a front.
@compute @workgroup_size(WIDE)
fn take_away(@builtin(local_invocation_index) lane: u32, @builtin(workgroup_id) id: vec3<u32>) {
    let tile = tiles[part.first + id.x];
    let group = groups[tile.group];
    let height = group.size + group.row_count;
    let i = 4u * (lane % SIDE);
    for (var s = tile.source; s < tile.source_end; s++) {
        let source = sources[s];
        let giver = groups[source.group];
        let rows = source.row_count;
        let columns = source.column_count;
        var sums = Product();
        for (var first = 0u; first < giver.size; first += SIDE) {
            let depth = min(SIDE, giver.size - first);
            workgroupBarrier();
            if lane / SIDE < depth {
                let below = giver.front + (first + lane / SIDE) * (giver.size + giver.row_count) + giver.size;
                if i < rows {
                    var four = vec4<f32>(0.0);
                    for (var a = 0u; a < min(4u, rows - i); a++) {
                        four[a] = earlier(source, below + (shared_rows[source.row + i + a] & 0xffffu));
                    }
                    left[lane] = four;
                }
                if i < columns {
                    var four = vec4<f32>(0.0);
                    for (var a = 0u; a < min(4u, columns - i); a++) {
                        four[a] = earlier(source, below + (shared_rows[source.column + i + a] & 0xffffu));
                    }
                    right[lane] = four;
                }
                if TILE + lane % SIDE < columns {
                    beyond[lane] = earlier(source, below + (shared_rows[source.column + TILE + lane % SIDE] & 0xffffu));
                }
            }
            workgroupBarrier();
            if i < rows && 4u * (lane / SIDE) < columns {
                sums = multiplied(lane, depth, columns, sums);
            }
        }
        // The source before may have changed the same entries.
        storageBarrier();
        for (var b = 0u; b < ACROSS; b++) {
            let column = column_of(lane, b);
            if i < rows && column < columns {
                let at = group.front + (shared_rows[source.column + column] >> 16u) * height;
                let sum = sums_of(sums, b);
                for (var a = 0u; a < min(4u, rows - i); a++) {
                    factor[at + (shared_rows[source.row + i + a] >> 16u)] -= sum[a];
                }
            }
        }
    }
}
