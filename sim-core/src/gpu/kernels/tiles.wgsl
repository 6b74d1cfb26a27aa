// Products of panels, a workgroup for some rows of a front: `solver/elimination.rs`.
@group(0) @binding(0) var<uniform> part: Part;
@group(0) @binding(1) var<storage, read> groups: array<Group>;
@group(0) @binding(2) var<storage, read> tiles: array<Tile>;
@group(0) @binding(3) var<storage, read> sources: array<Source>;
@group(0) @binding(4) var<storage, read> shared_rows: array<u32>;
@group(0) @binding(5) var<storage, read_write> factor: array<f32>;
@group(0) @binding(6) var<storage, read> factor_elsewhere: array<f32>;

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

// Four entries one below the other, zeros behind the last `count`.
fn four_below(at: u32, count: u32) -> vec4<f32> {
    var b = 0.0;
    var c = 0.0;
    var d = 0.0;
    if count > 1u {
        b = factor[at + 1u];
    }
    if count > 2u {
        c = factor[at + 2u];
    }
    if count > 3u {
        d = factor[at + 3u];
    }
    return vec4<f32>(factor[at], b, c, d);
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
                left[lane] = four_below(column + tile.row + i, tile.row_count - i);
            }
            // Above the diagonal are zeros.
            if i < n {
                right[lane] = four_below(column + i, n - i);
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

// An entry of an earlier group, in the column that begins there, of a shared row.
fn earlier(source: Source, column: u32, shared_row: u32) -> f32 {
    let at = column + (shared_rows[shared_row] & 0xffffu);
    if source.elsewhere == 0u {
        return factor[at];
    }
    return factor_elsewhere[at];
}

// Four of them, zeros behind the last `count`.
fn four_earlier(source: Source, column: u32, first: u32, count: u32) -> vec4<f32> {
    var b = 0.0;
    var c = 0.0;
    var d = 0.0;
    if count > 1u {
        b = earlier(source, column, first + 1u);
    }
    if count > 2u {
        c = earlier(source, column, first + 2u);
    }
    if count > 3u {
        d = earlier(source, column, first + 3u);
    }
    return vec4<f32>(earlier(source, column, first), b, c, d);
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
                    left[lane] = four_earlier(source, below, source.row + i, rows - i);
                }
                if i < columns {
                    right[lane] = four_earlier(source, below, source.column + i, columns - i);
                }
                if TILE + lane % SIDE < columns {
                    beyond[lane] = earlier(source, below, source.column + TILE + lane % SIDE);
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
