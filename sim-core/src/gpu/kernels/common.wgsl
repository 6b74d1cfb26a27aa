
// atan2(sine, cosine) for sine ≥ 0, to two units in the last place; the built-in one may be off by 4096.
fn angle(sine: f32, cosine: f32) -> f32 {
    let small = min(sine, abs(cosine));
    let large = max(sine, abs(cosine));
    var t = small / max(large, 1e-37);
    var turned = 0.0;
    if t > 0.41421356 {
        t = (t - 1.0) / (t + 1.0);
        turned = 0.25 * PI;
    }
    let s = t * t;
    var a = turned + t + t * s * (((8.05374449538e-2 * s - 1.38776856032e-1) * s + 1.99777106478e-1) * s - 3.33329491539e-1);
    if sine > abs(cosine) {
        a = HALF_PI - a;
    }
    if cosine < 0.0 {
        a = PI - a;
    }
    return a;
}

// Any unit vector across the unit vector `d`: the one that glam takes.
fn any_across(d: vec3<f32>) -> vec3<f32> {
    let side = select(-1.0, 1.0, d.z >= 0.0);
    let a = -1.0 / (side + d.z);
    return vec3<f32>(d.x * d.y * a, side + d.y * d.y * a, -d.y);
}

// `v` over its length, or `fallback` where it has none.
fn unit_or(v: vec3<f32>, fallback: vec3<f32>) -> vec3<f32> {
    let l = length(v);
    return select(fallback, v / max(l, 1e-30), l > 1e-30);
}

fn turned(q: vec4<f32>, v: vec3<f32>) -> vec3<f32> {
    return v + 2.0 * cross(q.xyz, cross(q.xyz, v) + q.w * v);
}

fn turned_back(q: vec4<f32>, v: vec3<f32>) -> vec3<f32> {
    return turned(vec4<f32>(-q.xyz, q.w), v);
}

// Whether a number is neither infinite nor NaN, by its bits: comparisons may be optimised away.
fn is_finite(x: f32) -> bool {
    return (bitcast<u32>(x) & 0x7f800000u) != 0x7f800000u;
}

// Unit tangent of the centripetal Catmull–Rom spline at the second of three control points; see `render`, `yarn/transport.rs`.
fn direction_at(p0: vec3<f32>, p1: vec3<f32>, p2: vec3<f32>) -> vec3<f32> {
    let d01 = max(sqrt(distance(p0, p1)), 1e-3);
    let d12 = max(sqrt(distance(p1, p2)), 1e-3);
    let derivative = (p1 - p0) / d01 - (p2 - p0) / (d01 + d12) + (p2 - p1) / d12;
    return unit_or(derivative, unit_or(p2 - p1, vec3<f32>(1.0, 0.0, 0.0)));
}
