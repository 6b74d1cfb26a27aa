// Whether the new state may follow the old: `Stepper::judge`. Then it takes its place.
@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<uniform> counts: Counts;
@group(0) @binding(2) var<storage, read> segments: array<Segment>;
@group(0) @binding(3) var<storage, read> position: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> next_position: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read> visits: array<vec4<f32>>;
@group(0) @binding(6) var<storage, read> next_visits: array<vec4<f32>>;
// The first segment that is wrong, and what is wrong with it in its lower two bits; NONE if all are right.
@group(0) @binding(7) var<storage, read_write> worst: atomic<u32>;

@compute @workgroup_size(WIDE)
fn judge(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= counts.segments {
        return;
    }
    let term = segments[id.x];
    let laid = term.laid - params.taken_in * term.taken;
    let yarn = laid + (visits[term.visit_1].x - visits[term.visit_0].x);
    let next_yarn = laid + (next_visits[term.visit_1].x - next_visits[term.visit_0].x);
    let r = position[term.node_1].xyz - position[term.node_0].xyz;
    let next_r = next_position[term.node_1].xyz - next_position[term.node_0].xyz;
    let change = length(next_r - r);
    var wrong = 0u;
    if !is_finite(change) || !is_finite(next_yarn) {
        wrong = REJECTED_NOT_FINITE;
    } else if next_yarn < 0.5 * yarn {
        wrong = REJECTED_SHRINKING;
    } else if change > LEAP * max(length(r), yarn) {
        wrong = REJECTED_LEAPING;
    }
    if wrong != 0u {
        atomicMin(&worst, term.id * 4u + wrong);
    }
}
