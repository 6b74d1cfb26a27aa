//! The nearest of many triangles or segments: a tree of boxes.

use glam::DVec3;

/// Primitives in a leaf.
const LEAF: usize = 4;

struct Node {
    low: DVec3,
    high: DVec3,
    /// A leaf: first primitive and number of them. Else number 0; the left child is the next node, and this the right one.
    first: u32,
    count: u32,
}

/// Boxes of primitives, halved at the median of their longest side.
pub(crate) struct Bvh {
    nodes: Vec<Node>,
    order: Vec<u32>,
}

impl Bvh {
    /// The tree of primitives with these corners.
    pub fn new<const N: usize>(count: usize, corners: impl Fn(usize) -> [DVec3; N]) -> Self {
        let bounds = |i: usize| {
            let corners = corners(i);
            (
                corners.iter().fold(corners[0], |a, b| a.min(*b)),
                corners.iter().fold(corners[0], |a, b| a.max(*b)),
            )
        };
        let boxes: Vec<(DVec3, DVec3)> = (0..count).map(bounds).collect();
        let mut tree = Self { nodes: Vec::new(), order: (0..count as u32).collect() };
        if count > 0 {
            tree.build(&boxes, 0, count);
        }
        tree
    }

    fn build(&mut self, boxes: &[(DVec3, DVec3)], first: usize, end: usize) {
        let part = &mut self.order[first..end];
        let (low, high) = part
            .iter()
            .map(|i| boxes[*i as usize])
            .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(l, h), (a, b)| (l.min(a), h.max(b)));
        let node = self.nodes.len();
        self.nodes.push(Node { low, high, first: first as u32, count: (end - first) as u32 });
        if end - first <= LEAF {
            return;
        }
        let size = high - low;
        let axis = if size.x >= size.y.max(size.z) { 0 } else { usize::from(size.y < size.z) + 1 };
        let key = |i: u32| boxes[i as usize].0[axis] + boxes[i as usize].1[axis];
        let half = part.len() / 2;
        part.select_nth_unstable_by(half, |a, b| key(*a).total_cmp(&key(*b)).then(a.cmp(b)));
        self.nodes[node].count = 0;
        self.build(boxes, first, first + half);
        self.nodes[node].first = self.nodes.len() as u32;
        self.build(boxes, first + half, end);
    }

    /// The primitive nearest to a point, with what `measure` says about it; `measure` gives the square of the distance first.
    /// None if there are no primitives.
    pub fn nearest<T>(&self, point: DVec3, measure: impl Fn(usize) -> (f64, T)) -> Option<(f64, usize, T)> {
        let mut best: Option<(f64, usize, T)> = None;
        let outside = |n: &Node| (point.clamp(n.low, n.high) - point).length_squared();
        let mut open = vec![0];
        while let Some(at) = open.pop() {
            let Some(node) = self.nodes.get(at) else { continue };
            if best.as_ref().is_some_and(|(d, ..)| outside(node) >= *d) {
                continue;
            }
            if node.count == 0 {
                let (left, right) = (at + 1, node.first as usize);
                let left_first = outside(&self.nodes[left]) <= outside(&self.nodes[right]);
                open.extend(if left_first { [right, left] } else { [left, right] });
                continue;
            }
            for i in &self.order[node.first as usize..(node.first + node.count) as usize] {
                let (distance, what) = measure(*i as usize);
                if best.as_ref().is_none_or(|(d, ..)| distance < *d) {
                    best = Some((distance, *i as usize, what));
                }
            }
        }
        best
    }
}

/// Barycentric coordinates of the point of a triangle nearest to `p` (Ericson, *Real-Time Collision Detection*, §5.1.5).
pub(crate) fn nearest_on_triangle([a, b, c]: [DVec3; 3], p: DVec3) -> [f64; 3] {
    let (ab, ac) = (b - a, c - a);
    let (d1, d2) = (ab.dot(p - a), ac.dot(p - a));
    if d1 <= 0.0 && d2 <= 0.0 {
        return [1.0, 0.0, 0.0];
    }
    let (d3, d4) = (ab.dot(p - b), ac.dot(p - b));
    if d3 >= 0.0 && d4 <= d3 {
        return [0.0, 1.0, 0.0];
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        let t = d1 / (d1 - d3);
        return [1.0 - t, t, 0.0];
    }
    let (d5, d6) = (ab.dot(p - c), ac.dot(p - c));
    if d6 >= 0.0 && d5 <= d6 {
        return [0.0, 0.0, 1.0];
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        let t = d2 / (d2 - d6);
        return [1.0 - t, 0.0, t];
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0 {
        let t = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return [0.0, 1.0 - t, t];
    }
    let sum = va + vb + vc;
    [va / sum, vb / sum, vc / sum]
}

/// How far along a segment its point nearest to `p` is, 0 … 1.
pub(crate) fn nearest_on_segment([a, b]: [DVec3; 2], p: DVec3) -> f64 {
    let along = b - a;
    let square = along.length_squared();
    if square > 0.0 { (along.dot(p - a) / square).clamp(0.0, 1.0) } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::noise::unit_hash;

    fn noise(i: u64) -> DVec3 {
        DVec3::new(unit_hash(3 * i), unit_hash(3 * i + 1), unit_hash(3 * i + 2))
    }

    #[test]
    fn the_tree_finds_what_a_search_through_all_finds() {
        let corner = |i: u64| noise(i / 3) + 0.1 * noise(i + 1000);
        let triangle = |i: usize| [0, 1, 2].map(|k| corner(3 * i as u64 + k));
        let tree = Bvh::new(200, triangle);
        for q in 0..300 {
            let p = 1.4 * noise(q + 50_000) - DVec3::splat(0.2);
            let measure = |i: usize| {
                let t = triangle(i);
                let b = nearest_on_triangle(t, p);
                ((b[0] * t[0] + b[1] * t[1] + b[2] * t[2] - p).length_squared(), ())
            };
            let brute = (0..200).map(|i| measure(i).0).fold(f64::INFINITY, f64::min);
            assert_eq!(tree.nearest(p, measure).unwrap().0, brute);
        }
        assert!(Bvh::new(0, triangle).nearest(DVec3::ZERO, |_| (0.0, ())).is_none());
    }

    #[test]
    fn no_point_of_a_triangle_is_nearer() {
        for q in 0..200 {
            let t = [0, 1, 2].map(|k| noise(7 * q + k));
            let p = 2.0 * noise(7 * q + 5) - DVec3::splat(0.5);
            let b = nearest_on_triangle(t, p);
            assert!((b.iter().sum::<f64>() - 1.0).abs() < 1e-12 && b.iter().all(|b| *b >= 0.0));
            let found = (b[0] * t[0] + b[1] * t[1] + b[2] * t[2]).distance(p);
            for i in 0..=20 {
                for j in 0..=20 - i {
                    let (u, v) = (f64::from(i) / 20.0, f64::from(j) / 20.0);
                    assert!((u * t[0] + v * t[1] + (1.0 - u - v) * t[2]).distance(p) >= found - 1e-12);
                }
            }
        }
    }
}
