// Shading with the studio lights. All surfaces here are matte: wool, paper, clay.
//
// SHADOWS is written in front of this file by light.rs. Where a branch is not taken by any pixel a software adapter works it out
// all the same, so shadows that there are not must not be in the code: looked up, they took a third of the time of a picture.

@group(0) @binding(1) var shadow_map: texture_depth_2d;
@group(0) @binding(2) var shadow_sampler: sampler_comparison;

const KEY_COLOR = vec3f(1.00, 0.965, 0.91) * 0.80;
const FILL_COLOR = vec3f(0.86, 0.92, 1.0) * 0.20;
const RIM_COLOR = vec3f(1.0, 0.98, 0.95) * 0.16;
const SKY_COLOR = vec3f(0.97, 0.985, 1.0) * 0.36;
const GROUND_COLOR = vec3f(1.0, 0.93, 0.86) * 0.17;

// Lambert's cosine for light that enters the material and leaves it a little further on: `wrap` 0 is stone, 1 is fog.
fn wrapped(cosine: f32, wrap: f32) -> f32 {
    return max(0.0, (cosine + wrap) / (1.0 + wrap));
}

// Share of the key light that reaches a point, softened over three by three texels.
fn key_visibility(position: vec3f, normal: vec3f) -> f32 {
    if !SHADOWS || frame.shadow_texel == 0.0 {
        return 1.0;
    }
    // Off the surface by a texel or two, or it would shade itself.
    let p = frame.shadow_projection * vec4f(position + normal * frame.shadow_texel * 2.0, 1.0);
    let uv = vec2f(0.5 + 0.5 * p.x, 0.5 - 0.5 * p.y);
    if any(abs(p.xy) > vec2f(1.0)) {
        return 1.0;
    }
    // The ground may lie beyond the map's far end, in the shadow of what is in it.
    let depth = min(p.z, 1.0);
    let texel = 1.0 / vec2f(textureDimensions(shadow_map));
    var sum = 0.0;
    for (var y = -1; y <= 1; y++) {
        for (var x = -1; x <= 1; x++) {
            let offset = vec2f(f32(x), f32(y)) * 1.4 * texel;
            sum += textureSampleCompareLevel(shadow_map, shadow_sampler, uv + offset, depth);
        }
    }
    return sum / 9.0;
}

// Cosines of a normal with the key, fill and rim lights, and upwards.
fn light_cosines(normal: vec3f) -> vec4f {
    return vec4f(dot(normal, frame.key.xyz), dot(normal, frame.fill.xyz), dot(normal, frame.rim.xyz), dot(normal, frame.up.xyz));
}

// Light that a matte point sends on, as a factor of its colour.
fn diffuse_light(cosines: vec4f, visibility: f32, wrap: f32) -> vec3f {
    let key = KEY_COLOR * (wrapped(cosines.x, wrap) * visibility);
    let fill = FILL_COLOR * wrapped(cosines.y, wrap);
    let rim = RIM_COLOR * wrapped(cosines.z, wrap);
    return key + fill + rim + mix(GROUND_COLOR, SKY_COLOR, 0.5 + 0.5 * cosines.w);
}
