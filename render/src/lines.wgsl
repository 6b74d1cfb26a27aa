// Lines of constant width on the screen: each a quad of two triangles that faces the eye.

// Lines come forward by this part of their distance for each pixel of width and one more, so that they win over the
// surface they lie on, and wide lines, which mark something, over narrow ones.
const FORWARD = 0.0007;

struct Corner {
    @builtin(position) clip: vec4f,
    @location(0) color: vec3f,
}

@vertex
fn line_vertex(
    @location(0) start: vec3f,
    @location(1) end: vec3f,
    @location(2) color: vec3f,
    @location(3) width: f32,
    @builtin(vertex_index) corner: u32,
) -> Corner {
    var a = frame.view_projection * vec4f(start, 1.0);
    var b = frame.view_projection * vec4f(end, 1.0);
    // w is the distance ahead: an end behind the near plane slides along the line onto it.
    if a.w < frame.near && b.w > frame.near {
        a = mix(a, b, (frame.near - a.w) / (b.w - a.w));
    } else if b.w < frame.near && a.w > frame.near {
        b = mix(b, a, (frame.near - b.w) / (a.w - b.w));
    }
    let along = (b.xy / b.w - a.xy / a.w) * frame.size;
    let direction = select(vec2f(1.0, 0.0), normalize(along), dot(along, along) > 1e-12);
    let across = vec2f(-direction.y, direction.x) * select(-1.0, 1.0, (corner & 1u) == 1u);
    // Half a width beyond either end closes the joints of a polyline.
    let outwards = direction * select(-1.0, 1.0, corner >= 2u);
    var clip = a;
    if corner >= 2u {
        clip = b;
    }
    let offset = (across + outwards) * width * frame.supersampling / frame.size * clip.w;
    let depth = frame.near / (1.0 - FORWARD * (1.0 + width));
    return Corner(vec4f(clip.xy + offset, min(depth, clip.w), clip.w), color);
}

@fragment
fn line_fragment(in: Corner) -> @location(0) vec4f {
    return vec4f(in.color, 1.0);
}
