// q = A p, eight invocations a node: `solver/product.rs`, and the contacts of layers, `solver/tail.rs`.
//
// Stiffness acts on how a node moves against its neighbours. In a sum over its row the motion that they have in common would cancel, but
// for rounding of the size of the mass; so differences are taken first, and what a motion in common has is summed beside (`gather.wgsl`).
@group(0) @binding(0) var<uniform> counts: Counts;
@group(0) @binding(1) var<storage, read> nodes: array<Node>;
@group(0) @binding(2) var<storage, read> blocks: array<Block>;
@group(0) @binding(3) var<storage, read> values: array<f32>;
@group(0) @binding(4) var<storage, read> contacts: array<Contact>;
@group(0) @binding(5) var<storage, read> contacts_of: array<vec2<u32>>;
@group(0) @binding(6) var<storage, read> p: array<f32>;
@group(0) @binding(7) var<storage, read_write> q: array<f32>;
@group(0) @binding(8) var<storage, read> status: Status;

@compute @workgroup_size(WIDE)
fn product(@builtin(global_invocation_id) id: vec3<u32>) {
    if status.solved != 0u || id.x / 8u >= counts.node_count {
        return;
    }
    let n = counts.first_node + id.x / 8u;
    let node = nodes[n];
    for (var i = id.x % 8u; i < node.size; i += 8u) {
        var at = node.value + i;
        var sum = 0.0;
        for (var b = node.block; b < node.block_end; b++) {
            let block = blocks[b];
            for (var j = 0u; j < 3u; j++) {
                sum += values[at] * (p[block.dof + j] - p[node.dof + j]);
                at += node.size;
            }
            for (var j = 3u; j < block.size; j++) {
                sum += values[at] * p[block.dof + j];
                at += node.size;
            }
        }
        for (var j = 0u; j < RIGID; j++) {
            sum += values[at] * p[node.dof + j];
            at += node.size;
        }
        if i < 3u {
            for (var c = contacts_of[n].x; c < contacts_of[n].y; c++) {
                let contact = contacts[c];
                let other = nodes[contact.node].dof;
                let there = vec3<f32>(p[other], p[other + 1u], p[other + 2u]);
                let normal = vec3<f32>(contact.normal_x, contact.normal_y, contact.normal_z);
                sum -= contact.across * there[i] + (contact.along - contact.across) * dot(normal, there) * normal[i];
            }
        }
        q[node.dof + i] = sum;
    }
}
