// A picture over all of the viewport, as large as it or smaller.

@group(0) @binding(0) var picture: texture_2d<f32>;
@group(0) @binding(1) var between: sampler;

struct Pixel {
    @builtin(position) clip: vec4f,
    @location(0) uv: vec2f,
}

@vertex
fn cover(@builtin(vertex_index) corner: u32) -> Pixel {
    let p = vec2f(f32(corner & 1u) * 4.0 - 1.0, f32(corner >> 1u) * 4.0 - 1.0);
    return Pixel(vec4f(p, 0.0, 1.0), vec2f(0.5 + 0.5 * p.x, 0.5 - 0.5 * p.y));
}

@fragment
fn paste(in: Pixel) -> @location(0) vec4f {
    return textureSample(picture, between, in.uv);
}
