// Control points of the yarns as they are drawn: `curves::offsets`, `curves::middles`.
@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> nodes: array<Node>;
@group(0) @binding(2) var<storage, read> stacked: array<Stacked>;
@group(0) @binding(3) var<storage, read> materials: array<Material>;
@group(0) @binding(4) var<storage, read> position: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read> normals: array<vec4<f32>>;
@group(0) @binding(6) var<storage, read> joints: array<Joint>;
@group(0) @binding(7) var<storage, read> old_dyes: array<u32>;
// One for each visit, then those in the middle of stitch contacts; the last number is 1 where there is a point.
@group(0) @binding(8) var<storage, read_write> points: array<vec4<f32>>;

fn radius(dye: u32) -> f32 {
    return 0.5 * materials[dye].diameter;
}

// Yarns that lie on each other at a node, front to back, the middle of the stack at the node.
@compute @workgroup_size(WIDE)
fn lay_points(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= params.node_count {
        return;
    }
    let node = nodes[id.x];
    let end = node.visit + max(node.size, 4u) - 3u;
    var top = 0.0;
    for (var k = node.visit; k < end; k++) {
        top += radius(stacked[k].dye);
    }
    for (var k = node.visit; k < end; k++) {
        let r = radius(stacked[k].dye);
        points[stacked[k].visit] = vec4<f32>(position[id.x].xyz + (top - r) * normals[id.x].xyz, 1.0);
        top -= 2.0 * r;
    }
}

// The points in the middle of a stitch contact: the new yarn first, then the old ones front to back.
@compute @workgroup_size(WIDE)
fn lay_middles(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= params.joint_count {
        return;
    }
    let joint = joints[id.x];
    let r = position[joint.node_1].xyz - position[joint.node_0].xyz;
    let middle = 0.5 * (position[joint.node_1].xyz + position[joint.node_0].xyz);
    let axis = unit_or(r, vec3<f32>(0.0));
    let side = joint.side * unit_or(cross(normals[joint.node_0].xyz, axis), vec3<f32>(0.0));
    let normal = unit_or(normals[joint.node_0].xyz + normals[joint.node_1].xyz, vec3<f32>(0.0));
    let is_there = select(0.0, 1.0, length(r) > 1e-30);
    var top = 0.0;
    var thickest = 0.0;
    for (var k = joint.old; k < joint.old_end; k++) {
        top += radius(old_dyes[k]);
        thickest = max(thickest, radius(old_dyes[k]));
    }
    points[joint.point] = vec4<f32>(middle - thickest * side, is_there);
    for (var k = joint.old; k < joint.old_end; k++) {
        let r = radius(old_dyes[k]);
        let at = middle + radius(joint.dye) * side + (top - r) * normal;
        points[joint.point + 1u + k - joint.old] = vec4<f32>(at, is_there);
        top -= 2.0 * r;
    }
}
