// The twin of stitch_mesh::yarn_curves::catmull_rom, with the derivative beside the value.

// Coincident points would divide by zero: the shortest knot interval, as in the twin.
const SHORTEST_KNOT = 1e-3;

struct Spline {
    position: vec3f,
    tangent: vec3f, // d position / d knot, not normalised
}

fn knot(a: vec3f, b: vec3f) -> f32 {
    return max(sqrt(distance(a, b)), SHORTEST_KNOT);
}

fn spline_mix(a: Spline, b: Spline, t: f32, start: f32, end: f32) -> Spline {
    let s = (t - start) / (end - start);
    let position = a.position + (b.position - a.position) * s;
    let tangent = a.tangent + (b.tangent - a.tangent) * s + (b.position - a.position) / (end - start);
    return Spline(position, tangent);
}

// Centripetal Catmull–Rom between p1 and p2 at t in 0…1, by Barry and Goldman's pyramid.
fn catmull_rom(p0: vec3f, p1: vec3f, p2: vec3f, p3: vec3f, at: f32) -> Spline {
    let t1 = knot(p0, p1);
    let t2 = t1 + knot(p1, p2);
    let t3 = t2 + knot(p2, p3);
    let t = t1 + (t2 - t1) * at;
    let q0 = Spline(p0, vec3f(0.0));
    let q1 = Spline(p1, vec3f(0.0));
    let q2 = Spline(p2, vec3f(0.0));
    let q3 = Spline(p3, vec3f(0.0));
    let a1 = spline_mix(q0, q1, t, 0.0, t1);
    let a2 = spline_mix(q1, q2, t, t1, t2);
    let a3 = spline_mix(q2, q3, t, t2, t3);
    let b1 = spline_mix(a1, a2, t, 0.0, t2);
    let b2 = spline_mix(a2, a3, t, t1, t3);
    return spline_mix(b1, b2, t, t1, t2);
}
