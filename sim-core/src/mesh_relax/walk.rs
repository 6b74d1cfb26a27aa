//! Walking on the surface: straight ahead, over the edges of triangles, to the end of the way or to the border.
//!
//! The way Δx is laid flat onto the triangle it starts on, keeping its length. At an edge it goes on into the next triangle
//! as if both were unfolded into one plane, so it is a geodesic of the triangulation. At a border it ends. On a border's
//! polyline it runs along it, and ends at a corner.

use super::surface::{NONE, Place, Surface};
use glam::DVec3;

/// Edges crossed at most: a way that circles round a point for rounding's sake ends there.
const MOST_EDGES: usize = 4096;

impl Surface {
    /// The place that is reached from `place` by going along `way`.
    pub fn walk(&self, place: &Place, way: DVec3) -> Place {
        if !(way.length_squared() > 0.0 && way.is_finite()) {
            return *place;
        }
        match *place {
            Place::Inside { triangle, at } => self.walk_inside(triangle, at, way),
            Place::Border { border, segment, at } => {
                let forward = way.dot(self.frame(place)[0]);
                self.walk_border(border, segment, at, forward)
            }
            Place::Corner { .. } => *place,
        }
    }

    fn walk_inside(&self, mut triangle: u32, mut at: [f64; 3], way: DVec3) -> Place {
        let [a, b, c] = self.corners(triangle as usize);
        let normal = (b - a).cross(c - a).normalize_or_zero();
        let mut way = (way - normal * way.dot(normal)).normalize_or_zero() * way.length();
        let mut entered = None;
        for _ in 0..MOST_EDGES {
            let corners = self.corners(triangle as usize);
            let Some(rate) = barycentric(corners, way) else { break };
            // The side opposite to corner i is met when its coordinate runs out.
            let meets =
                |i: usize| if rate[i] < 0.0 && entered != Some(i) { at[i] / -rate[i] } else { f64::INFINITY };
            let first = (0..3).min_by(|i, j| meets(*i).total_cmp(&meets(*j))).unwrap_or(0);
            let met = meets(first);
            let part = met.clamp(0.0, 1.0);
            (0..3).for_each(|i| at[i] = (at[i] + part * rate[i]).max(0.0));
            if met >= 1.0 {
                break;
            }
            at[first] = 0.0;
            way *= 1.0 - part;
            // Side (first + 1, first + 2), from the other side.
            let side = (first + 1) % 3;
            let next = self.across[triangle as usize][side];
            if next == NONE {
                break;
            }
            let (p, q) =
                (self.triangles[triangle as usize][side], self.triangles[triangle as usize][(side + 1) % 3]);
            let theirs = self.triangles[next as usize];
            let Some(opposite) = (0..3).find(|i| theirs[*i] != p && theirs[*i] != q) else { break };
            let weight = |v: u32| {
                if v == p {
                    at[side]
                } else if v == q {
                    at[(side + 1) % 3]
                } else {
                    0.0
                }
            };
            let edge = (self.points[q as usize] - self.points[p as usize]).normalize_or_zero();
            let along = way.dot(edge);
            let inwards = self.points[theirs[opposite] as usize] - self.points[p as usize];
            let inwards = (inwards - edge * inwards.dot(edge)).normalize_or_zero();
            let over = (way.length_squared() - along * along).max(0.0).sqrt();
            at = theirs.map(weight);
            (triangle, way, entered) = (next, along * edge + over * inwards, Some(opposite));
        }
        let sum: f64 = at.iter().sum();
        Place::Inside { triangle, at: at.map(|b| b / sum) }
    }

    fn walk_border(&self, border: u32, segment: u32, at: f64, forward: f64) -> Place {
        let (start, end) = (self.border_starts[border as usize], self.border_starts[border as usize + 1] - 1);
        let (mut segment, mut at, mut left) = (segment, at, forward);
        let is_corner = |point: u32| self.tangents[point as usize] == DVec3::ZERO;
        for _ in 0..MOST_EDGES {
            let [a, b] = self.segment(segment as usize);
            let length = a.distance(b).max(f64::MIN_POSITIVE);
            let goal = at + left / length;
            if (0.0..=1.0).contains(&goal) {
                at = goal;
                break;
            }
            let (turn, rest) = if goal < 0.0 { (segment, goal) } else { (segment + 1, goal - 1.0) };
            at = if goal < 0.0 { 0.0 } else { 1.0 };
            if is_corner(turn) {
                break;
            }
            left = rest * length;
            (segment, at) = match goal < 0.0 {
                true => (if segment == start { end - 1 } else { segment - 1 }, 1.0),
                false => (if segment + 1 == end { start } else { segment + 1 }, 0.0),
            };
        }
        Place::Border { border, segment, at }
    }
}

/// Change of barycentric coordinates along a vector in the plane of a triangle. None if the triangle has no area.
fn barycentric([a, b, c]: [DVec3; 3], v: DVec3) -> Option<[f64; 3]> {
    let (e, f) = (b - a, c - a);
    let (ee, ef, ff) = (e.dot(e), e.dot(f), f.dot(f));
    let determinant = ee * ff - ef * ef;
    if determinant <= 1e-24 * ee * ff {
        return None;
    }
    let (ve, vf) = (v.dot(e), v.dot(f));
    let (s, t) = ((ff * ve - ef * vf) / determinant, (ee * vf - ef * ve) / determinant);
    Some([-s - t, s, t])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::noise::unit_hash;
    use stitch_mesh::mesh::PolygonMesh;

    /// A sheet of 4 × 3 unit squares, bent round the y axis with a radius, or flat.
    fn sheet(radius: Option<f64>) -> Surface {
        let at = |i: u32| {
            let (x, y) = (f64::from(i % 5), f64::from(i / 5));
            match radius {
                Some(r) => DVec3::new(r * (x / r).sin(), y, r * (x / r).cos()),
                None => DVec3::new(x, y, 0.0),
            }
        };
        let face = |i: u32| {
            let a = i / 4 * 5 + i % 4;
            vec![a, a + 1, a + 6, a + 5]
        };
        let faces: Vec<Vec<u32>> = (0..12).map(face).collect();
        Surface::new(&PolygonMesh::new((0..20).map(at).collect(), &faces).unwrap(), 0)
    }

    fn anywhere(surface: &Surface, seed: u64) -> Place {
        let triangle = (unit_hash(seed) * surface.triangles.len() as f64) as u32;
        let (u, v) = (unit_hash(seed + 1000), unit_hash(seed + 2000));
        Place::Inside { triangle, at: [1.0 - u.max(v), (u - v).abs(), u.min(v)] }
    }

    #[test]
    fn on_a_plane_ways_are_straight_and_end_at_the_border() {
        let surface = sheet(None);
        let mut stopped = 0;
        for seed in 0..500 {
            let place = anywhere(&surface, seed);
            let from = surface.position(&place);
            let angle = unit_hash(seed + 3000) * std::f64::consts::TAU;
            let to = from + 2.0 * unit_hash(seed + 4000) * DVec3::new(angle.cos(), angle.sin(), 0.0);
            let reached = surface.position(&surface.walk(&place, to - from));
            let inside = (0.0..=4.0).contains(&to.x) && (0.0..=3.0).contains(&to.y);
            if inside && reached.distance(to) > 1e-12 {
                // Corners of the sheet are rounded off nowhere else than along its border, which is straight.
                panic!("{from} to {to} ended at {reached}");
            }
            if !inside {
                stopped += 1;
                let gap = [reached.x, 4.0 - reached.x, reached.y, 3.0 - reached.y];
                assert!(gap.iter().any(|g| g.abs() < 1e-12), "{reached} is not on the border");
                assert!((to - from).cross(reached - from).length() < 1e-12, "{reached} is beside the way");
            }
        }
        assert!(stopped > 50);
    }

    #[test]
    fn round_a_bend_ways_keep_their_length_and_their_pitch() {
        let surface = sheet(Some(2.0));
        for seed in 0..200 {
            let triangle = (0..surface.triangles.len() as u32).find(|t| {
                let [a, b, c] = surface.corners(*t as usize);
                let m = (a + b + c) / 3.0;
                m.distance(DVec3::new(1.6, 1.5, 1.1)) < 0.4 // in the middle: a way of 0.9 does not reach the border
            });
            let place = Place::Inside { triangle: triangle.unwrap(), at: [0.4, 0.3, 0.3] };
            let [u, v] = surface.frame(&place);
            let angle = unit_hash(seed) * std::f64::consts::TAU;
            let way = 0.9 * (u * angle.cos() + v * angle.sin());
            let (from, to) = (surface.position(&place), surface.position(&surface.walk(&place, way)));
            let round = |p: DVec3| p.x.atan2(p.z) * p.with_y(0.0).length();
            let (dx, dy) = (round(to) - round(from), to.y - from.y);
            assert!((dx.hypot(dy) - 0.9).abs() < 0.02, "{dx} {dy}");
            assert!((dy - way.y).abs() < 0.02, "climbs by {dy} instead of {}", way.y);
        }
    }

    #[test]
    fn on_a_border_ways_follow_it_to_the_corner() {
        let surface = sheet(None);
        let place = Place::Border { border: 0, segment: 5, at: 0.5 };
        let from = surface.position(&place);
        let [along, none] = surface.frame(&place);
        assert_eq!(none, DVec3::ZERO);
        let there = surface.walk(&place, 0.3 * along);
        assert!(surface.position(&there).distance(from + 0.3 * along) < 1e-12);
        assert!(surface.position(&surface.walk(&there, -0.3 * along)).distance(from) < 1e-12);
        for way in [10.0, -10.0] {
            let end = surface.position(&surface.walk(&place, way * along));
            let corners = [(0.0, 0.0), (4.0, 0.0), (4.0, 3.0), (0.0, 3.0)];
            assert!(corners.iter().any(|(x, y)| end.distance(DVec3::new(*x, *y, 0.0)) < 1e-12), "{end}");
        }
    }

    #[test]
    fn ways_without_length_or_sense_lead_nowhere() {
        let surface = sheet(None);
        let place = anywhere(&surface, 3);
        for way in [DVec3::ZERO, DVec3::NAN, DVec3::INFINITY] {
            assert_eq!(surface.walk(&place, way), place);
        }
        let straight_up = surface.walk(&place, DVec3::Z);
        assert!(surface.position(&straight_up).distance(surface.position(&place)) < 1e-12);
    }
}
