// Whether the new state may follow the old: `Stepper::judge`, and how many segments `overshoot::draw_back` has left too long.
@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<uniform> counts: Counts;
@group(0) @binding(2) var<storage, read> segments: array<Segment>;
@group(0) @binding(3) var<storage, read> position: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> next_position: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read> visits: array<vec4<f32>>;
@group(0) @binding(6) var<storage, read> next_visits: array<vec4<f32>>;
@group(0) @binding(7) var<storage, read> back: array<vec4<f32>>;
// The first segment that is wrong, and what is wrong with it in its lower two bits, NONE if all are right; and how many turn too far.
@group(0) @binding(8) var<storage, read_write> faults: array<atomic<u32>, 2>;
// Behind the cells, how many contacts of layers were wanted.
@group(0) @binding(9) var<storage, read> heads: array<u32>;

@compute @workgroup_size(WIDE)
fn judge(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x == 0u && heads[params.cell_count] > params.contact_capacity {
        atomicMin(&faults[0], 0u);
    }
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
        atomicMin(&faults[0], term.id * 4u + wrong);
    }
    // What the linear step reckoned with. A segment between two chunks is in both.
    let before = length(r);
    let moved = next_r - (back[term.node_1].xyz - back[term.node_0].xyz) - r;
    let reckoned = max(before + dot(r, moved) / before, DRAWN_LEAST * before);
    if length(next_r) > (1.0 + params.far) * reckoned && term.node_0 - counts.first_node < counts.node_count {
        atomicAdd(&faults[1], 1u);
    }
}
