// Yarn: tubes, ribbons and threads along splines, evaluated here from control points, and wool on them.
//
// SAMPLES, SIDES, PLIES, PITCH and END are written in front of this file by yarn.rs.

const TAU = 6.283185307;
// Tubes are this much wider than the yarn: there only some fibres stand off it.
const HALO = 1.06;

struct ControlPoint {
    position: vec3f,
    arc: f32,
    normal: vec3f,
    stretch: u32,
}

// Yarn of one thickness.
struct Stretch {
    radius: f32,
    roll: f32,
}

@group(1) @binding(0) var<storage, read> points: array<ControlPoint>;
@group(1) @binding(1) var<storage, read> stretches: array<Stretch>;
@group(1) @binding(2) var<storage, read> dyes: array<u32>;

// A vertex number counts spans, steps along a span and sides around it, in the finest level's grid. The end of a span is
// the start of the next; after a curve's last span comes one of which only the start is drawn.
fn span_of(vertex: u32) -> u32 {
    return vertex / (SAMPLES * (SIDES + 1u));
}

fn step_of(vertex: u32) -> u32 {
    return vertex / (SIDES + 1u) % SAMPLES;
}

fn side_of(vertex: u32) -> u32 {
    return vertex % (SIDES + 1u);
}

// A point of the centre line.
struct Station {
    center: vec3f,
    tangent: vec3f,
    radius: f32,
    color: vec3f,
}

// sRGB in the bytes of a number, as light adds up.
fn linear(dye: u32) -> vec3f {
    let c = unpack4x8unorm(dye).rgb;
    return select(pow((c + 0.055) / 1.055, vec3f(2.4)), c / 12.92, c <= vec3f(0.04045));
}

fn station(vertex: u32) -> Station {
    let span = span_of(vertex);
    let step = step_of(vertex);
    let start = points[span];
    let end = points[span + 1u];
    let before = points[span - 1u].position;
    let after = points[span + 2u].position;
    let spline = catmull_rom(before, start.position, end.position, after, f32(step) / f32(SAMPLES));
    let stretch = stretches[start.stretch & ~END];
    // Cut yarn ends in a point rather than in a hole.
    let cut = step == 0u && (start.stretch & END) != 0u;
    let radius = select(stretch.radius, 0.0, cut);
    return Station(spline.position, direction(spline.tangent, end.position - start.position), radius, linear(dyes[span]));
}

// The reference normal at a station: that of the span's start, taken along by the smallest rotation, then rolled.
fn reference_normal(vertex: u32, tangent: vec3f) -> vec3f {
    let span = span_of(vertex);
    let start = points[span];
    let end = points[span + 1u].position;
    let first = catmull_rom(points[span - 1u].position, start.position, end, points[span + 2u].position, 0.0);
    let a = direction(first.tangent, end - start.position);
    let moved = start.normal - (a + tangent) * (dot(tangent, start.normal) / max(1.0 + dot(a, tangent), 1e-4));
    let straight = normalize(moved - tangent * dot(moved, tangent));
    let roll = stretches[start.stretch & ~END].roll * f32(step_of(vertex)) / f32(SAMPLES);
    return straight * cos(roll) + cross(tangent, straight) * sin(roll);
}

fn direction(tangent: vec3f, otherwise: vec3f) -> vec3f {
    if dot(tangent, tangent) > 1e-20 {
        return normalize(tangent);
    }
    return select(vec3f(1.0, 0.0, 0.0), normalize(otherwise), dot(otherwise, otherwise) > 1e-20);
}

struct TubeCorner {
    @builtin(position) clip: vec4f,
    @location(0) position: vec3f,
    @location(1) normal: vec3f,
    @location(2) tangent: vec3f,
    // Length in diameters, and angle about the yarn.
    @location(3) around: vec2f,
    @location(4) @interpolate(flat) color: vec3f,
}

@vertex
fn tube_vertex(@builtin(vertex_index) vertex: u32) -> TubeCorner {
    let s = station(vertex);
    let reference = reference_normal(vertex, s.tangent);
    let angle = TAU * f32(side_of(vertex)) / f32(SIDES);
    let normal = reference * cos(angle) + cross(s.tangent, reference) * sin(angle);
    let position = s.center + normal * s.radius * HALO;
    let clip = frame.view_projection * vec4f(position, 1.0);
    let span = span_of(vertex);
    let arc = mix(points[span].arc, points[span + 1u].arc, f32(step_of(vertex)) / f32(SAMPLES));
    return TubeCorner(clip, position, normal, s.tangent, vec2f(arc, angle), s.color);
}

// A ribbon's normals run in a half circle from one edge over the middle to the other, so every cosine of light is
// across · (its cosine with the edge) + √(1 − across²) · (its cosine with the middle): vertices carry those cosines.
struct RibbonCorner {
    @builtin(position) clip: vec4f,
    @location(0) position: vec3f,
    @location(1) across: f32,
    @location(2) edge: vec4f,
    @location(3) middle: vec4f,
    @location(4) @interpolate(flat) color: vec3f,
}

// Unit vector to the right of the yarn, across the line of sight.
fn ribbon_side(s: Station) -> vec3f {
    let side = cross(s.tangent, towards_eye(s.center));
    return side * inverseSqrt(max(dot(side, side), 1e-12));
}

fn ribbon_across(vertex: u32) -> f32 {
    return select(-1.0, 1.0, side_of(vertex) != 0u);
}

@vertex
fn ribbon_vertex(@builtin(vertex_index) vertex: u32) -> RibbonCorner {
    let s = station(vertex);
    let side = ribbon_side(s);
    let middle = cross(side, s.tangent);
    let across = ribbon_across(vertex);
    let position = s.center + side * across * s.radius;
    let clip = frame.view_projection * vec4f(position, 1.0);
    return RibbonCorner(clip, position, across, light_cosines(side), light_cosines(middle), s.color);
}

// Shadows are cast by ribbons through the centre line. The lit half of the yarn lies in front of them, so yarn does not
// shade itself by mistake.
@vertex
fn shadow_vertex(@builtin(vertex_index) vertex: u32) -> @builtin(position) vec4f {
    let s = station(vertex);
    return frame.view_projection * vec4f(s.center + ribbon_side(s) * ribbon_across(vertex) * s.radius, 1.0);
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

// The plies' phase: whole numbers are the grooves between them.
fn ply_phase(around: vec2f) -> f32 {
    return PLIES * (around.y / TAU + around.x / PITCH);
}

// Fibres: how much lighter a place is, how steep it is across the ply, and whether a fibre covers it. They run along the
// plies, a little across them, so this is noise that is long that way; what is finer than a pixel fades out.
fn fibres(phase: f32, arc: f32, blur: f32) -> vec3f {
    let locks_clear = 1.0 - smoothstep(0.02, 0.055, blur);
    let hairs_clear = 1.0 - smoothstep(0.012, 0.035, blur);
    if locks_clear == 0.0 {
        return vec3f(0.0, 0.0, 1.0);
    }
    let locks = vec2f(phase * 8.0 + arc * 1.6, arc * 2.4);
    let lock = noise(locks);
    let lock_slope = noise(locks + vec2f(0.4, 0.0)) - lock;
    if hairs_clear == 0.0 {
        return vec3f(0.5 * (lock - 0.5), 0.5 * lock_slope, 1.0 / locks_clear) * locks_clear;
    }
    let hairs = vec2f(phase * 30.0 - arc * 9.0, arc * 5.5 + 17.3);
    let hair = noise(hairs);
    let hair_slope = noise(hairs + vec2f(0.4, 0.0)) - hair;
    let lightness = 0.5 * (lock - 0.5) + 0.75 * (hair - 0.5) * hairs_clear;
    let slope = 0.5 * lock_slope + 0.6 * hair_slope * hairs_clear;
    return vec3f(lightness * locks_clear, slope * locks_clear, mix(1.0, 0.45 * lock + 0.55 * hair, hairs_clear));
}

fn wool(normal: vec3f, tangent: vec3f, around: vec2f) -> Wool {
    let phase = ply_phase(around);
    let blur = fwidth(phase);
    // Each ply is a little cylinder: its normal leans from −1 to 1 across it, along the gradient of the phase.
    let gradient = cross(tangent, normal) + tangent * (0.5 * TAU / PITCH);
    let lean = 2.0 * fract(phase) - 1.0;
    let clear = 1.0 - smoothstep(0.12, 0.6, blur);
    let groove = smoothstep(0.45, 1.0, abs(lean)) * clear;
    let fibre = fibres(phase, around.x, blur);
    let relief = 0.66 * lean * (1.0 - 0.6 * groove) * clear - fibre.y;
    let shade = (1.0 - 0.42 * groove) * (1.0 + 0.55 * fibre.x);
    return Wool(normalize(normal + gradient * relief), shade, fibre.z);
}

// Light from wool towards the eye: `cosines` of the surface with the lights, `key` of the yarn as a whole with the key
// light, `facing` of it with the eye.
fn yarn_light(color: vec3f, cosines: vec4f, visibility: f32, key: f32, facing: f32, shade: f32) -> vec4f {
    // Fibres stand off the yarn: at grazing angles there are more of them, and they are lit from everywhere.
    let graze = 1.0 - max(0.0, facing);
    let fuzz = graze * graze * graze * (0.10 + 0.26 * visibility * wrapped(key, 0.6));
    let light = diffuse_light(cosines, visibility, 0.3);
    return vec4f((color * light + mix(color, vec3f(1.0), 0.35) * fuzz) * shade, 1.0);
}

fn tube_light(in: TubeCorner, round: vec3f, facing: f32, detail: Wool) -> vec4f {
    let visibility = key_visibility(in.position, round);
    let key = dot(round, frame.key.xyz);
    return yarn_light(in.color, light_cosines(detail.normal), visibility, key, facing, detail.shade);
}

@fragment
fn tube_fragment(in: TubeCorner) -> @location(0) vec4f {
    let round = normalize(in.normal);
    let facing = dot(round, towards_eye(in.position));
    return tube_light(in, round, facing, wool(round, normalize(in.tangent), in.around));
}

// For yarn so near that single fibres show: the outline frays, towards the edge only single fibres remain. An entry point
// of its own because `discard` takes the early depth test away.
@fragment
fn frayed_fragment(in: TubeCorner) -> @location(0) vec4f {
    let round = normalize(in.normal);
    let facing = dot(round, towards_eye(in.position));
    let detail = wool(round, normalize(in.tangent), in.around);
    if detail.cover < smoothstep(0.62, 1.0, 1.0 - abs(facing)) * 0.8 {
        discard;
    }
    return tube_light(in, round, facing, detail);
}

// Light from a place across a ribbon, −1…1 from edge to edge, whose cosines of light are those of `edge` and `middle`.
fn ribbon_light(color: vec3f, across: f32, edge: vec4f, middle: vec4f, visibility: f32) -> vec4f {
    let facing = sqrt(max(0.0, 1.0 - across * across));
    let cosines = across * edge + facing * middle;
    return yarn_light(color, cosines, visibility, cosines.x, facing, 1.0);
}

@fragment
fn ribbon_fragment(in: RibbonCorner) -> @location(0) vec4f {
    // The ribbon lies in the middle of the yarn, behind its lit surface: that is off the surface enough for shadows.
    let visibility = key_visibility(in.position, frame.key.xyz);
    return ribbon_light(in.color, in.across, in.edge, in.middle, visibility);
}

// A ribbon about as wide as a pixel, which takes in all that is across it.
struct ThreadCorner {
    @builtin(position) clip: vec4f,
    @location(0) @interpolate(flat) light: vec4f,
}

// Places across a thread, the light of which is averaged.
const ACROSS = vec4f(-0.75, -0.25, 0.25, 0.75);

@vertex
fn thread_vertex(@builtin(vertex_index) vertex: u32) -> ThreadCorner {
    let s = station(vertex);
    let side = ribbon_side(s);
    let edge = light_cosines(side);
    let middle = light_cosines(cross(side, s.tangent));
    let visibility = key_visibility(s.center, frame.key.xyz);
    var light = vec4f(0.0);
    for (var i = 0; i < 4; i++) {
        light += ribbon_light(s.color, ACROSS[i], edge, middle, visibility) / 4.0;
    }
    let position = s.center + side * ribbon_across(vertex) * s.radius;
    return ThreadCorner(frame.view_projection * vec4f(position, 1.0), light);
}

@fragment
fn thread_fragment(in: ThreadCorner) -> @location(0) vec4f {
    return in.light;
}
