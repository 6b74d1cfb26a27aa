// Scalar products, in two stages so that they always come out the same: each workgroup adds up its span, then one workgroup
// adds up the spans, and decides what follows from the sum.
@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> a: array<f32>;
@group(0) @binding(2) var<storage, read> b: array<f32>;
@group(0) @binding(3) var<storage, read> load: array<vec2<f32>>;
@group(0) @binding(4) var<storage, read> x: array<f32>;
@group(0) @binding(5) var<storage, read_write> partial: array<vec2<f32>>;
@group(0) @binding(6) var<storage, read_write> status: Status;

var<workgroup> lanes: array<vec2<f32>, WIDE>;

fn sum_of_lanes(lane: u32) -> vec2<f32> {
    for (var span = WIDE / 2u; span > 0u; span /= 2u) {
        workgroupBarrier();
        if lane < span {
            lanes[lane] += lanes[lane + span];
        }
    }
    workgroupBarrier();
    return lanes[0];
}

// a·b, and b·x of the system.
@compute @workgroup_size(WIDE)
fn sum_span(@builtin(local_invocation_index) lane: u32, @builtin(workgroup_id) id: vec3<u32>) {
    var sum = vec2<f32>(0.0);
    for (var k = 0u; k < SUM_SPAN / WIDE; k++) {
        let i = id.x * SUM_SPAN + k * WIDE + lane;
        if i < params.dof_count {
            sum += vec2<f32>(a[i] * b[i], load[i].x * x[i]);
        }
    }
    lanes[lane] = sum;
    let total = sum_of_lanes(lane);
    if lane == 0u {
        partial[id.x] = total;
    }
}

fn total(lane: u32) -> vec2<f32> {
    let spans = (params.dof_count + SUM_SPAN - 1u) / SUM_SPAN;
    var sum = vec2<f32>(0.0);
    for (var i = lane; i < spans; i += WIDE) {
        sum += partial[i];
    }
    lanes[lane] = sum;
    return sum_of_lanes(lane);
}

// α = r·z / p·Ap.
@compute @workgroup_size(WIDE)
fn choose_step(@builtin(local_invocation_index) lane: u32) {
    let curvature = total(lane).x;
    if lane == 0u && status.solved == 0u {
        if curvature > 0.0 && is_finite(curvature) {
            status.alpha = status.error / curvature;
        } else {
            status.alpha = 0.0;
            status.solved = 2u;
        }
    }
}

// β, and whether the error is small enough.
@compute @workgroup_size(WIDE)
fn judge_error(@builtin(local_invocation_index) lane: u32) {
    let sums = total(lane);
    if lane == 0u && status.solved == 0u {
        status.beta = select(0.0, sums.x / status.error, status.error > 0.0);
        status.error = sums.x;
        status.goal = params.tolerance * abs(sums.y);
        status.iterations += 1u;
        if !is_finite(sums.x) || !is_finite(sums.y) {
            status.solved = 2u;
        } else if sums.x <= status.goal {
            status.solved = 1u;
        }
    }
}
