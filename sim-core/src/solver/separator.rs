//! The fewest nodes that keep two sets of nodes apart.
//!
//! # Theory
//! Menger: as many as there are paths from one set to the other of which no two share a node. Dinic finds the paths many at a time:
//! levels by a search in breadth through what the paths so far have left, then paths that climb from level to level, until a search
//! no longer arrives. Each node is two states, one before it and one after it, with room for one path between them; a path may
//! also go back along another, which takes that apart and joins the ends anew. Where the last search reached what is before a node and
//! not what is after it, the node is in the separator. Searching from the other set gives a second separator, just as small.

/// No node: none comes before or after on a path, as there is no path.
const NONE: u32 = u32::MAX;

/// No node: the path begins or ends in a set.
const END: u32 = u32::MAX - 1;

/// The nodes between two sets.
pub(crate) struct Band {
    /// First of each node's neighbours in `neighbours`, [count + 1].
    pub first: Vec<u32>,
    /// Neighbours in the band; each pair of nodes is in it both ways.
    pub neighbours: Vec<u32>,
    /// Whether each node touches the first and the second set, [count] each.
    pub touches: [Vec<bool>; 2],
}

/// Where a node of a band goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Side {
    /// To the first set.
    First,
    /// To the second set.
    Second,
    /// Between them.
    Separator,
}

impl Band {
    /// The smallest separators nearest to the first and to the second set: the side of each node.
    pub fn separated(&self) -> [Vec<Side>; 2] {
        let mut paths = Paths::new(self);
        while paths.climb(true) {
            paths.fill();
        }
        paths.climb(false);
        let near_first = paths.sides(Side::First, Side::Second);
        let Paths { before, after, level, .. } = paths;
        let [first, second] = self.touches.clone();
        let reversed =
            Band { first: self.first.clone(), neighbours: self.neighbours.clone(), touches: [second, first] };
        let mut back = Paths { band: &reversed, before: after, after: before, level };
        back.climb(false);
        [near_first, back.sides(Side::Second, Side::First)]
    }
}

/// What a state leads to.
enum Way {
    To(usize),
    Closed,
    NoMore,
}

/// Paths through a band. The states of node v are 2v, before it, and 2v + 1, after it.
struct Paths<'a> {
    band: &'a Band,
    /// The node before each on its path.
    before: Vec<u32>,
    /// The node after each.
    after: Vec<u32>,
    /// Of each state, from 1; 0 where the last search did not arrive.
    level: Vec<u32>,
}

impl<'a> Paths<'a> {
    fn new(band: &'a Band) -> Self {
        let count = band.first.len() - 1;
        Self { band, before: vec![NONE; count], after: vec![NONE; count], level: vec![0; 2 * count] }
    }

    /// The `option`th way on from a state.
    fn way(&self, state: usize, option: usize) -> Way {
        let v = state / 2;
        let on_path = self.before[v] != NONE;
        if state.is_multiple_of(2) {
            return match (option, self.before[v]) {
                (0, NONE) => Way::To(state + 1),
                (0, END) => Way::Closed,
                // Back along the path through this node.
                (0, u) => Way::To(2 * u as usize + 1),
                _ => Way::NoMore,
            };
        }
        let Some(neighbour) = option.checked_sub(1) else {
            return if on_path { Way::To(state - 1) } else { Way::Closed };
        };
        let own = &self.band.neighbours[self.band.first[v] as usize..self.band.first[v + 1] as usize];
        match own.get(neighbour) {
            Some(w) if self.after[v] == *w => Way::Closed,
            Some(w) => Way::To(2 * *w as usize),
            None => Way::NoMore,
        }
    }

    /// Whether the second set is next.
    fn arrives(&self, state: usize) -> bool {
        let v = state / 2;
        state % 2 == 1 && self.band.touches[1][v] && self.after[v] != END
    }

    /// Levels, of all states that can be reached or until the second set is; whether it is.
    fn climb(&mut self, until_second: bool) -> bool {
        self.level.fill(0);
        let touching = self.band.touches[0].iter().enumerate().filter(|(_, touches)| **touches);
        let mut queue: Vec<usize> = touching.map(|(v, _)| 2 * v).collect();
        queue.iter().for_each(|state| self.level[*state] = 1);
        let mut top = u32::MAX;
        let mut at = 0;
        while let Some(&state) = queue.get(at).filter(|state| self.level[**state] < top) {
            at += 1;
            if until_second && self.arrives(state) {
                top = self.level[state];
                continue;
            }
            for option in 0.. {
                match self.way(state, option) {
                    Way::To(next) if self.level[next] == 0 => {
                        self.level[next] = self.level[state] + 1;
                        queue.push(next);
                    }
                    Way::To(_) | Way::Closed => {}
                    Way::NoMore => break,
                }
            }
        }
        top < u32::MAX
    }

    /// Adds paths that climb from level to level, until there are no more.
    fn fill(&mut self) {
        let mut entered = vec![false; self.level.len()];
        let mut option = vec![0; self.level.len()];
        let mut path: Vec<usize> = Vec::new();
        for start in (0..self.level.len()).step_by(2).filter(|s| self.band.touches[0][s / 2]) {
            path.clear();
            if !std::mem::replace(&mut entered[start], true) {
                path.push(start);
            }
            while let Some(&state) = path.last() {
                if self.arrives(state) {
                    self.add(&path);
                    break;
                }
                match self.way(state, option[state]) {
                    Way::To(next) if !entered[next] && self.level[next] == self.level[state] + 1 => {
                        entered[next] = true;
                        path.push(next);
                    }
                    Way::To(_) | Way::Closed => {}
                    Way::NoMore => drop(path.pop()),
                }
                option[state] += 1;
            }
        }
    }

    fn add(&mut self, path: &[usize]) {
        let steps = || path.windows(2).map(|s| [s[0], s[1]]).filter(|[a, b]| a / 2 != b / 2);
        for [from, to] in steps().filter(|[from, _]| from.is_multiple_of(2)) {
            // Back along another path, which no longer goes from one to the other.
            self.before[from / 2] = NONE;
            self.after[to / 2] = NONE;
        }
        for [from, to] in steps().filter(|[from, _]| !from.is_multiple_of(2)) {
            self.after[from / 2] = to as u32 / 2;
            self.before[to / 2] = from as u32 / 2;
        }
        if let [first, .., last] = path {
            self.before[first / 2] = END;
            self.after[last / 2] = END;
        }
    }

    /// Sides by the last search.
    fn sides(&self, reached: Side, other: Side) -> Vec<Side> {
        let side = |level: &[u32; 2]| match level {
            [0, _] => other,
            [_, 0] => Side::Separator,
            _ => reached,
        };
        self.level.as_chunks().0.iter().map(side).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::noise::unit_hash;

    /// A band of `count` nodes with edges between neighbours, and the nodes that touch each set.
    fn band(count: usize, edges: &[(usize, usize)], touching: [&[usize]; 2]) -> Band {
        let mut lists = vec![Vec::new(); count];
        for (a, b) in edges {
            lists[*a].push(*b as u32);
            lists[*b].push(*a as u32);
        }
        let mut first = vec![0];
        for list in &lists {
            first.push(first[first.len() - 1] + list.len() as u32);
        }
        let touches = touching.map(|nodes| (0..count).map(|v| nodes.contains(&v)).collect());
        Band { first, neighbours: lists.concat(), touches }
    }

    /// Whether removing `removed` leaves no way from the first set to the second.
    fn separates(band: &Band, removed: impl Fn(usize) -> bool) -> bool {
        let count = band.first.len() - 1;
        let mut queue: Vec<usize> = (0..count).filter(|v| band.touches[0][*v] && !removed(*v)).collect();
        let mut seen: Vec<bool> = (0..count).map(|v| queue.contains(&v)).collect();
        let mut at = 0;
        while let Some(&v) = queue.get(at) {
            at += 1;
            for w in &band.neighbours[band.first[v] as usize..band.first[v + 1] as usize] {
                let w = *w as usize;
                if !removed(w) && !std::mem::replace(&mut seen[w], true) {
                    queue.push(w);
                }
            }
        }
        !queue.iter().any(|v| band.touches[1][*v])
    }

    #[test]
    fn an_hourglass_is_cut_at_its_waist() {
        // 0 1 2 – 3 4 – 5 6 7, each row joined to the next.
        let rows: [&[usize]; 3] = [&[0, 1, 2], &[3, 4], &[5, 6, 7]];
        let edges: Vec<_> =
            rows.windows(2).flat_map(|r| r[0].iter().flat_map(|a| r[1].iter().map(|b| (*a, *b)))).collect();
        let hourglass = band(8, &edges, [rows[0], rows[2]]);
        for sides in hourglass.separated() {
            let expected = |v| match v {
                0..3 => Side::First,
                3..5 => Side::Separator,
                _ => Side::Second,
            };
            assert!((0..8).map(expected).eq(sides));
        }
    }

    #[test]
    fn of_many_smallest_separators_each_set_gets_its_nearest() {
        let chain = band(4, &[(0, 1), (1, 2), (2, 3)], [&[0], &[3]]);
        let [near_first, near_second] = chain.separated();
        assert_eq!(near_first[0], Side::Separator);
        assert_eq!(near_first[1..], [Side::Second; 3]);
        assert_eq!(near_second[..3], [Side::First; 3]);
        assert_eq!(near_second[3], Side::Separator);
    }

    /// Against all sets of nodes there are.
    #[test]
    fn separators_are_smallest() {
        let count = 9;
        let mut sizes = Vec::new();
        for seed in 0..300 {
            let mut hash = (1000 * seed..).map(unit_hash);
            let mut edges = Vec::new();
            for a in 0..count {
                edges.extend((0..a).filter(|_| hash.next().unwrap() < 0.3).map(|b| (a, b)));
            }
            let mut touching = || (0..count).filter(|_| hash.next().unwrap() < 0.35).collect::<Vec<_>>();
            let band = band(count, &edges, [&touching(), &touching()]);
            let smallest = (0..1u32 << count)
                .filter(|set| separates(&band, |v| set >> v & 1 == 1))
                .map(u32::count_ones)
                .min()
                .unwrap();
            for sides in band.separated() {
                let found = sides.iter().filter(|s| **s == Side::Separator).count();
                assert_eq!(found, smallest as usize, "seed {seed}");
                assert!(separates(&band, |v| sides[v] == Side::Separator), "seed {seed}");
                for (v, side) in sides.iter().enumerate() {
                    let neighbours = &band.neighbours[band.first[v] as usize..band.first[v + 1] as usize];
                    let apart = |w: &u32| [*side, sides[*w as usize]] != [Side::First, Side::Second];
                    assert!(neighbours.iter().all(apart), "seed {seed}");
                    assert!(!(band.touches[0][v] && *side == Side::Second));
                    assert!(!(band.touches[1][v] && *side == Side::First));
                }
            }
            sizes.push(smallest);
        }
        assert!((0..4).all(|size| sizes.contains(&size)), "all cases are met");
    }
}
