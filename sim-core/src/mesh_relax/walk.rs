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
