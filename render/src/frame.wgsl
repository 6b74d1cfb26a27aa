// What every shader knows about the frame; the twin of `Frame` in frame.rs.
struct Frame {
    view_projection: mat4x4f,
    shadow_projection: mat4x4f,
    eye: vec4f,
    key: vec4f,
    fill: vec4f,
    rim: vec4f,
    up: vec4f,
    size: vec2f,
    near: f32,
    pixels_per_radian: f32,
    occlusion_radius: f32,
    shadow_texel: f32,
    supersampling: f32,
}

@group(0) @binding(0) var<uniform> frame: Frame;

// Unit vector from a point of the world towards the eye.
fn towards_eye(position: vec3f) -> vec3f {
    return normalize(frame.eye.xyz - position * frame.eye.w);
}
