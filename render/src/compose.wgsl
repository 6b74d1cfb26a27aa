// The picture: the scene, darkened in its hollows, over the background, tone-mapped and encoded as sRGB.
//
// The type of `depth` is written in by compose.rs: multisampled or not.

@group(0) @binding(1) var depth: DEPTH_TEXTURE;
@group(0) @binding(2) var scene: texture_2d<f32>;
@group(0) @binding(3) var hollows: texture_2d<f32>;

// The background: warm light grey, linear.
const ABOVE = vec3f(0.815, 0.800, 0.775);
const BELOW = vec3f(0.600, 0.580, 0.550);
const SHOULDER = 0.75;

struct Pixel {
    @builtin(position) clip: vec4f,
    @location(0) uv: vec2f,
}

@vertex
fn cover(@builtin(vertex_index) corner: u32) -> Pixel {
    let p = vec2f(f32(corner & 1u) * 4.0 - 1.0, f32(corner >> 1u) * 4.0 - 1.0);
    return Pixel(vec4f(p, 0.0, 1.0), vec2f(0.5 + 0.5 * p.x, 0.5 - 0.5 * p.y));
}

fn background(uv: vec2f) -> vec3f {
    let corner = length((uv - vec2f(0.5, 0.45)) * vec2f(0.9, 1.0));
    return mix(ABOVE, BELOW, smoothstep(0.15, 0.95, corner));
}

// Occlusion at a pixel of the scene, from the four half-resolution values around it that are about as far away.
fn occlusion(pixel: vec2i) -> f32 {
    let d = textureLoad(depth, pixel, 0);
    if frame.occlusion_radius == 0.0 || d == 0.0 {
        return 1.0;
    }
    let here = frame.near / d;
    let p = (vec2f(pixel) + 0.5) / 2.0 - 0.5;
    let base = vec2i(floor(p));
    let f = p - floor(p);
    let last = vec2i(textureDimensions(hollows)) - 1;
    var sum = 0.0;
    var weight = 0.0;
    for (var i = 0; i < 4; i++) {
        let step = vec2i(i & 1, i >> 1);
        let tap = textureLoad(hollows, clamp(base + step, vec2i(0), last), 0);
        let bilinear = mix(1.0 - f, f, vec2f(step));
        let w = bilinear.x * bilinear.y * max(0.0, 1.0 - abs(tap.g - here) / frame.occlusion_radius) + 1e-4;
        sum += w * tap.r;
        weight += w;
    }
    return sum / weight;
}

// Linear up to the shoulder, then ever more slowly towards white.
fn tone(color: vec3f) -> vec3f {
    let over = (color - SHOULDER) / (1.0 - SHOULDER);
    return select(color, SHOULDER + (1.0 - SHOULDER) * over / (1.0 + over), color > vec3f(SHOULDER));
}

fn srgb(linear: vec3f) -> vec3f {
    let curve = 1.055 * pow(max(linear, vec3f(0.0)), vec3f(1.0 / 2.4)) - 0.055;
    return select(curve, 12.92 * linear, linear < vec3f(0.0031308));
}

// Half a step of eight bits up or down, so that the background shows no bands (Jimenez' interleaved gradient noise).
fn dither(pixel: vec2f) -> f32 {
    return (fract(52.9829189 * fract(dot(pixel, vec2f(0.06711056, 0.00583715)))) - 0.5) / 255.0;
}

@fragment
fn compose(in: Pixel) -> @location(0) vec4f {
    // The scene is as large as the picture, or a whole number of times larger.
    let target_pixel = vec2i(in.clip.xy);
    var sum = vec4f(0.0);
    for (var y = 0; y < SUPERSAMPLING; y++) {
        for (var x = 0; x < SUPERSAMPLING; x++) {
            let pixel = target_pixel * SUPERSAMPLING + vec2i(x, y);
            let color = textureLoad(scene, pixel, 0);
            if color.a > 0.0 {
                sum += vec4f(tone(color.rgb * occlusion(pixel)), color.a);
            }
        }
    }
    sum /= f32(SUPERSAMPLING * SUPERSAMPLING);
    let picture = srgb(sum.rgb + background(in.uv) * (1.0 - sum.a));
    return vec4f(picture + dither(in.clip.xy), 1.0);
}
