// Ambient occlusion in screen space, from the depth of the scene, at half its resolution.
//
// A point is in a hollow if its surroundings come nearer to the eye than it. Taps come in opposite pairs, and only the
// sum of a pair counts: on a plane, however tilted, one tap is as much nearer as the other is farther, so planes stay
// bright without any normals.
//
// The type of `depth`, multisampled or not, and PAIRS are written in by occlusion.rs.

@group(0) @binding(1) var depth: DEPTH_TEXTURE;
@group(1) @binding(0) var coarse: texture_2d<f32>;

// How dark the deepest hollow is: never black, for light between yarns bounces on.
const STRENGTH = 1.15;
const DEEPEST = 0.38;
const NOTHING = 1e9;

@vertex
fn cover(@builtin(vertex_index) corner: u32) -> @builtin(position) vec4f {
    return vec4f(f32(corner & 1u) * 4.0 - 1.0, f32(corner >> 1u) * 4.0 - 1.0, 0.0, 1.0);
}

fn distance_at(pixel: vec2i) -> f32 {
    let clamped = clamp(pixel, vec2i(0), vec2i(frame.size) - 1);
    let d = textureLoad(depth, clamped, 0);
    return select(NOTHING, frame.near / d, d > 0.0);
}

// How much nearer than `here` a tap is, in reaches: what is much nearer is another thing in front and hollows nothing.
fn rise(here: f32, pixel: vec2i) -> f32 {
    let d = (here - distance_at(pixel)) / frame.occlusion_radius;
    return select(max(d, -1.0), max(0.0, 2.0 - d), d > 1.0);
}

// Red: light that arrives, 0…1. Green: distance [m].
@fragment
fn find_hollows(@builtin(position) position: vec4f) -> @location(0) vec2f {
    let half_pixel = vec2i(position.xy);
    let pixel = half_pixel * 2;
    let here = distance_at(pixel);
    let reach = frame.occlusion_radius * frame.pixels_per_radian / here;
    if here == NOTHING || reach < 1.5 {
        return vec2f(1.0, here);
    }
    // Sixteen rotations in a 4 × 4 pattern, which the blur averages out.
    let turn = f32((half_pixel.x & 3) * 4 + ((half_pixel.y & 3) * 7 + (half_pixel.x & 3) * 3) % 4) / 16.0;
    var sum = 0.0;
    for (var k = 0; k < PAIRS; k++) {
        let angle = 3.14159265 * (turn + f32(k) * 0.618034);
        let radius = reach * sqrt((f32(k) + 0.5) / f32(PAIRS));
        let offset = vec2i(round(vec2f(cos(angle), sin(angle)) * radius));
        sum += clamp(rise(here, pixel + offset) + rise(here, pixel - offset), 0.0, 1.0);
    }
    return vec2f(max(DEEPEST, 1.0 - STRENGTH * sum / f32(PAIRS)), here);
}

// Mean over 4 × 4, of what is about as far away.
@fragment
fn blur(@builtin(position) position: vec4f) -> @location(0) vec2f {
    let pixel = vec2i(position.xy);
    let here = textureLoad(coarse, pixel, 0);
    if here.g == NOTHING || frame.occlusion_radius == 0.0 {
        return vec2f(1.0, here.g);
    }
    let last = vec2i(textureDimensions(coarse)) - 1;
    var sum = 0.0;
    var weight = 0.0;
    for (var y = -2; y < 2; y++) {
        for (var x = -2; x < 2; x++) {
            let tap = textureLoad(coarse, clamp(pixel + vec2i(x, y), vec2i(0), last), 0);
            let w = max(0.0, 1.0 - abs(tap.g - here.g) / frame.occlusion_radius) + 1e-4;
            sum += w * tap.r;
            weight += w;
        }
    }
    return vec2f(sum / weight, here.g);
}
