// Lays what the matrix has into the fronts of the factor, eight invocations a node: `Elimination::filled` in `solver/elimination.rs`.
@group(0) @binding(0) var<uniform> counts: Counts;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<storage, read> nodes: array<Node>;
@group(0) @binding(3) var<storage, read> blocks: array<Block>;
@group(0) @binding(4) var<storage, read> values: array<f32>;
@group(0) @binding(5) var<storage, read> groups: array<Group>;
@group(0) @binding(6) var<storage, read_write> factor: array<f32>;

@compute @workgroup_size(WIDE)
fn fill(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x / 8u >= counts.node_count {
        return;
    }
    let node = nodes[counts.first_node + id.x / 8u];
    let group = groups[node.group];
    for (var i = id.x % 8u; i < node.size; i += 8u) {
        let own = node.dof - group.dof + i;
        let column = group.front + own * (group.size + group.row_count);
        var at = node.value + i;
        for (var b = node.block; b < node.block_end; b++) {
            let block = blocks[b];
            for (var j = 0u; j < block.size; j++) {
                if block.front != NONE {
                    let row = block.front + j;
                    factor[column + row] = values[at] * select(1.0, 1.0 + params.shift, row == own);
                }
                at += node.size;
            }
        }
    }
}
