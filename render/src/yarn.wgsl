// Yarn: tubes and ribbons along splines, evaluated here from control points, and wool on them.
//
// SAMPLES, SIDES, PLIES, PITCH and END are written in front of this file by yarn.rs.

const TAU = 6.283185307;
// Tubes are this much wider than the yarn: there only some fibres stand off it.
const HALO = 1.06;

struct ControlPoint {
    position: vec3f,
    arc: f32,
    normal: vec3f,
    curve: u32,
}

struct Curve {
    color: vec3f,
    radius: f32,
    roll: f32,
}

@group(1) @binding(0) var<storage, read> points: array<ControlPoint>;
@group(1) @binding(1) var<storage, read> curves: array<Curve>;

// A point of the centre line with its frame.
struct Station {
    center: vec3f,
    tangent: vec3f,
    normal: vec3f,
    radius: f32,
    arc: f32,
    color: vec3f,
}

fn station(instance: u32, vertex: u32) -> Station {
    let step = vertex / (SIDES + 1u);
    let t = f32(step) / f32(SAMPLES);
    let start = points[instance];
    let end = points[instance + 1u];
    let curve = curves[start.curve & ~END];
    let before = points[instance - 1u].position;
    let after = points[instance + 2u].position;
    let spline = catmull_rom(before, start.position, end.position, after, t);
    let first = catmull_rom(before, start.position, end.position, after, 0.0);
    let chord = end.position - start.position;
    let tangent = direction(spline.tangent, chord);

    // The start's normal, taken along by the smallest rotation, then rolled.
    let a = direction(first.tangent, chord);
    let moved = start.normal - (a + tangent) * (dot(tangent, start.normal) / max(1.0 + dot(a, tangent), 1e-4));
    let straight = normalize(moved - tangent * dot(moved, tangent));
    let roll = curve.roll * t;
    let normal = straight * cos(roll) + cross(tangent, straight) * sin(roll);

    // Cut yarn ends in a point rather than in a hole.
    let cut = (step == 0u && (start.curve & END) != 0u) || (step == SAMPLES && (end.curve & END) != 0u);
    let radius = select(curve.radius, 0.0, cut);
    return Station(spline.position, tangent, normal, radius, mix(start.arc, end.arc, t), curve.color);
}

fn direction(tangent: vec3f, otherwise: vec3f) -> vec3f {
    if dot(tangent, tangent) > 1e-20 {
        return normalize(tangent);
    }
    return select(vec3f(1.0, 0.0, 0.0), normalize(otherwise), dot(otherwise, otherwise) > 1e-20);
}

struct Corner {
    @builtin(position) clip: vec4f,
    @location(0) position: vec3f,
    // Of a tube: the normal. Of a ribbon: the part of the normal across the line of sight.
    @location(1) normal: vec3f,
    // Of a tube: the tangent. Of a ribbon: the normal of its middle.
    @location(2) axis: vec3f,
    // Length in diameters, and angle about the yarn.
    @location(3) around: vec2f,
    @location(4) color: vec3f,
}

@vertex
fn tube_vertex(@builtin(instance_index) instance: u32, @builtin(vertex_index) vertex: u32) -> Corner {
    let s = station(instance, vertex);
    let angle = TAU * f32(vertex % (SIDES + 1u)) / f32(SIDES);
    let normal = s.normal * cos(angle) + cross(s.tangent, s.normal) * sin(angle);
    let position = s.center + normal * s.radius * HALO;
    let clip = frame.view_projection * vec4f(position, 1.0);
    return Corner(clip, position, normal, s.tangent, vec2f(s.arc, angle), s.color);
}

// The two edges of a ribbon: across the line of sight and the yarn.
fn ribbon_side(s: Station, vertex: u32) -> vec3f {
    let side = cross(s.tangent, towards_eye(s.center));
    let across = select(-1.0, 1.0, vertex % (SIDES + 1u) != 0u);
    return across * side * inverseSqrt(max(dot(side, side), 1e-12));
}

@vertex
fn ribbon_vertex(@builtin(instance_index) instance: u32, @builtin(vertex_index) vertex: u32) -> Corner {
    let s = station(instance, vertex);
    let side = ribbon_side(s, vertex);
    let position = s.center + side * s.radius;
    let clip = frame.view_projection * vec4f(position, 1.0);
    let eye = towards_eye(s.center);
    let facing = normalize(eye - s.tangent * dot(eye, s.tangent) * 0.999);
    return Corner(clip, position, side, facing, vec2f(s.arc, 0.0), s.color);
}

// Shadows are cast by ribbons through the centre line. The lit half of the yarn lies in front of them, so yarn does not
// shade itself by mistake.
@vertex
fn shadow_vertex(@builtin(instance_index) instance: u32, @builtin(vertex_index) vertex: u32) -> @builtin(position) vec4f {
    let s = station(instance, vertex);
    return frame.view_projection * vec4f(s.center + ribbon_side(s, vertex) * s.radius, 1.0);
}

// A hash of two integers as a number in 0…1 (PCG).
fn hash(cell: vec2i) -> f32 {
    var h = bitcast<u32>(cell.x) * 747796405u + bitcast<u32>(cell.y) * 2891336453u + 1u;
    h = ((h >> ((h >> 28u) + 4u)) ^ h) * 277803737u;
    return f32((h >> 22u) ^ h & 0xffffu) / 65535.0;
}

// Value noise in 0…1.
fn noise(p: vec2f) -> f32 {
    let cell = vec2i(floor(p));
    let f = fract(p);
    let u = f * f * (3.0 - 2.0 * f);
    let low = mix(hash(cell), hash(cell + vec2i(1, 0)), u.x);
    let high = mix(hash(cell + vec2i(0, 1)), hash(cell + vec2i(1, 1)), u.x);
    return mix(low, high, u.y);
}

// Relief and shade of the plies and fibres at a point of the surface.
struct Wool {
    normal: vec3f,
    // Factor of the light.
    shade: f32,
    // 0…1: which places a fibre covers, for the halo.
    cover: f32,
}

fn wool(normal: vec3f, tangent: vec3f, around: vec2f) -> Wool {
    let phase = PLIES * (around.y / TAU + around.x / PITCH);
    let blur = fwidth(phase);
    if blur > 0.6 {
        return Wool(normal, 1.0, 1.0);
    }
    // Each ply is a little cylinder: its normal leans from −1 to 1 across it, along the gradient of the phase.
    let gradient = cross(tangent, normal) + tangent * (0.5 * TAU / PITCH);
    let lean = 2.0 * fract(phase) - 1.0;
    let clear = 1.0 - smoothstep(0.12, 0.6, blur);
    let groove = smoothstep(0.45, 1.0, abs(lean)) * clear;

    // Fibres run along the plies, a little across them, so noise that is long that way.
    var fibres = 0.0;
    var slope = 0.0;
    var cover = 1.0;
    let locks_clear = 1.0 - smoothstep(0.03, 0.12, blur);
    if locks_clear > 0.0 {
        let locks = vec2f(phase * 8.0 + around.x * 0.9, around.x * 1.1);
        let hairs = vec2f(phase * 27.0 - around.x * 2.3, around.x * 2.1 + 17.3);
        let hairs_clear = 1.0 - smoothstep(0.012, 0.045, blur);
        let lock = noise(locks);
        let hair = noise(hairs);
        fibres = (0.5 * (lock - 0.5) + 0.75 * (hair - 0.5) * hairs_clear) * locks_clear;
        let lock_slope = noise(locks + vec2f(0.4, 0.0)) - lock;
        let hair_slope = noise(hairs + vec2f(0.4, 0.0)) - hair;
        slope = (0.5 * lock_slope + 0.6 * hair_slope * hairs_clear) * locks_clear;
        cover = mix(1.0, 0.45 * lock + 0.55 * hair, hairs_clear);
    }
    let relief = 0.66 * lean * (1.0 - 0.6 * groove) * clear - slope;
    return Wool(normalize(normal + gradient * relief), (1.0 - 0.42 * groove) * (1.0 + 0.55 * fibres), cover);
}

// Light from wool towards the eye. `normal` is that of the surface, `round` that of the yarn as a whole.
fn yarn_light(position: vec3f, round: vec3f, normal: vec3f, shade: f32, color: vec3f) -> vec4f {
    let visibility = key_visibility(position, round);
    // Fibres stand off the yarn: at grazing angles there are more of them, and they are lit from everywhere.
    let graze = 1.0 - max(0.0, dot(round, towards_eye(position)));
    let fuzz = graze * graze * graze * (0.10 + 0.26 * visibility * wrapped(dot(round, frame.key.xyz), 0.6));
    let light = diffuse_light(normal, visibility, 0.3);
    return vec4f((color * light + mix(color, vec3f(1.0), 0.35) * fuzz) * shade, 1.0);
}

@fragment
fn tube_fragment(in: Corner) -> @location(0) vec4f {
    let round = normalize(in.normal);
    let detail = wool(round, normalize(in.axis), in.around);
    // The outline frays: towards the edge only single fibres remain.
    let edge = 1.0 - abs(dot(round, towards_eye(in.position)));
    if detail.cover < smoothstep(0.62, 1.0, edge) * 0.8 {
        discard;
    }
    return yarn_light(in.position, round, detail.normal, detail.shade, in.color);
}

@fragment
fn ribbon_fragment(in: Corner) -> @location(0) vec4f {
    let across = dot(in.normal, in.normal);
    let round = normalize(in.normal + in.axis * sqrt(max(0.0, 1.0 - across)));
    return yarn_light(in.position, round, round, 1.0, in.color);
}
