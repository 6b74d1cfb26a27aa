// Triangles in flat colours: polygons of meshes, and bodies.

// The back of a surface is this much darker than its front.
const BACK = 0.62;

struct Corner {
    @builtin(position) clip: vec4f,
    @location(0) position: vec3f,
    @location(1) normal: vec3f,
    @location(2) color: vec3f,
    @location(3) opacity: f32,
}

@vertex
fn surface_vertex(
    @location(0) position: vec3f,
    @location(1) normal: vec3f,
    @location(2) color: vec4f,
) -> Corner {
    return Corner(frame.view_projection * vec4f(position, 1.0), position, normal, color.rgb, color.a);
}

@fragment
fn surface_fragment(in: Corner, @builtin(front_facing) front: bool) -> @location(0) vec4f {
    let normal = select(-1.0, 1.0, front) * normalize(in.normal);
    let light = diffuse_light(light_cosines(normal), key_visibility(in.position, normal), 0.1);
    // What is not opaque shows the background, nothing else: only the rim of the ground is not.
    return vec4f(in.color * light * select(BACK, 1.0, front), 1.0) * in.opacity;
}

// Faces are flat: without shadows one light falls on all of a face. To a software adapter what does not vary over a triangle is
// half the work.

struct FlatCorner {
    @builtin(position) clip: vec4f,
    @location(0) @interpolate(flat) front: vec3f,
    @location(1) @interpolate(flat) back: vec3f,
}

@vertex
fn flat_vertex(
    @location(0) position: vec3f,
    @location(1) normal: vec3f,
    @location(2) color: vec4f,
) -> FlatCorner {
    let front = diffuse_light(light_cosines(normal), 1.0, 0.1);
    let back = diffuse_light(light_cosines(-normal), 1.0, 0.1) * BACK;
    return FlatCorner(frame.view_projection * vec4f(position, 1.0), color.rgb * front, color.rgb * back);
}

@fragment
fn flat_fragment(in: FlatCorner, @builtin(front_facing) front: bool) -> @location(0) vec4f {
    return vec4f(select(in.back, in.front, front), 1.0);
}
