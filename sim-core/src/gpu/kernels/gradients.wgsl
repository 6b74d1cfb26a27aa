// The vector updates of conjugate gradients: `solver/gradients.rs`.
@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read_write> x: array<f32>;
@group(0) @binding(2) var<storage, read_write> r: array<f32>;
@group(0) @binding(3) var<storage, read_write> p: array<f32>;
@group(0) @binding(4) var<storage, read> q: array<f32>;
@group(0) @binding(5) var<storage, read> z: array<f32>;
@group(0) @binding(6) var<storage, read> status: Status;

@compute @workgroup_size(WIDE)
fn go(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x < params.dof_count && status.solved == 0u {
        x[id.x] += status.alpha * p[id.x];
        r[id.x] -= status.alpha * q[id.x];
    }
}

@compute @workgroup_size(WIDE)
fn turn(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x < params.dof_count && status.solved == 0u {
        p[id.x] = z[id.x] + status.beta * p[id.x];
    }
}
