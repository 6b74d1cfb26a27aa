// Nothing, infinitely far away, all over the picture or a part of it.

@vertex
fn cover(@builtin(vertex_index) corner: u32) -> @builtin(position) vec4f {
    return vec4f(f32(corner & 1u) * 4.0 - 1.0, f32(corner >> 1u) * 4.0 - 1.0, 0.0, 1.0);
}

@fragment
fn nothing() -> @location(0) vec4f {
    return vec4f(0.0);
}
