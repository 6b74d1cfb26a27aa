//! Pairs of points that lie near each other.

use glam::{DVec3, IVec3};

/// Calls `visit` once for every pair of points closer than `reach`, the lower index first, in an order that depends on the
/// points alone.
///
/// Points are sorted into cells of the size of `reach`, column by column along z, so that the three cells around a height in
/// a neighbouring column are one run of the list.
pub(crate) fn near_pairs(points: &[DVec3], reach: f64, mut visit: impl FnMut(usize, usize)) {
    let cell = |x: &DVec3| (*x / reach).floor().as_ivec3();
    let key = |c: IVec3| (c.x, c.y, c.z);
    let mut sorted: Vec<((i32, i32, i32), u32)> =
        points.iter().enumerate().map(|(i, x)| (key(cell(x)), i as u32)).collect();
    sorted.sort_unstable();
    // Where each of the four columns ahead has been read up to: as the list is sorted, they are only read onwards.
    let ahead = [(0, 1), (1, -1), (1, 0), (1, 1)];
    let mut from = [0; 4];
    let close = |a: u32, b: u32| points[a as usize].distance_squared(points[b as usize]) < reach * reach;
    let mut meet = |a: u32, b: u32| {
        if close(a, b) {
            visit(a.min(b) as usize, a.max(b) as usize);
        }
    };
    for (place, &((x, y, z), i)) in sorted.iter().enumerate() {
        let own = sorted[place + 1..].iter().take_while(|((a, b, c), _)| (*a, *b) == (x, y) && *c <= z + 1);
        own.for_each(|(_, j)| meet(i, *j));
        for (start, (dx, dy)) in from.iter_mut().zip(ahead) {
            let first = (x + dx, y + dy, z - 1);
            *start += sorted[*start..].iter().take_while(|(key, _)| *key < first).count();
            let run = sorted[*start..].iter().take_while(|(key, _)| *key <= (x + dx, y + dy, z + 1));
            run.for_each(|(_, j)| meet(i, *j));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::noise::unit_hash;

    #[test]
    fn all_pairs_are_found_once() {
        let points: Vec<DVec3> = (0..400)
            .map(|i| DVec3::from_array(std::array::from_fn(|k| unit_hash(3 * i + k as u64) - 0.5)))
            .collect();
        for reach in [0.02, 0.1, 0.3, 3.0] {
            let mut found = Vec::new();
            near_pairs(&points, reach, |a, b| found.push((a, b)));
            found.sort_unstable();
            let near = |(a, b): &(usize, usize)| points[*a].distance(points[*b]) < reach;
            let expected: Vec<_> =
                (0..400).flat_map(|a| (a + 1..400).map(move |b| (a, b))).filter(near).collect();
            assert_eq!(found, expected);
        }
    }
}
