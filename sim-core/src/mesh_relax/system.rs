//! The linear system of a step: forces and stiffness in the few directions in which each vertex may move.
//!
//! Each vertex has a frame of `D` directions, 0 in length where it may not move: two in the tangent plane, one along the
//! border, three in free space. Forces and blocks are projected onto the frames as they are made, so that the system has
//! `D` unknowns a vertex and its solution is tangential by construction. That is what Baraff & Witkin's filter does within
//! every iteration of modified CG (*Large Steps in Cloth Simulation*, 1998, §5), done once; the iterates are the same and the
//! matrix has less than half of the numbers.
//!
//! A row is assembled by its own vertex from all springs at it. So springs are worked out two or three times over, but rows
//! are independent: they run in parallel, without locks, and the sums are the same whatever the number of threads.

use super::elements::Elements;
use super::lists::Lists;
use super::params::RelaxParams;
use super::{fold, shear, stretch, strut};
use glam::DVec3;
use rayon::prelude::*;

/// Vertices worked on at once.
pub(super) const CHUNK: usize = 1024;

/// Directions in which a vertex may move.
pub(super) type Frame<const D: usize> = [DVec3; D];
/// One vertex's part of a vector, and its part of the matrix.
pub(super) type Small<const D: usize> = [f64; D];
pub(super) type Block<const D: usize> = [[f64; D]; D];

/// A spring seen from one of its ends.
struct SpringAt {
    other: u32,
    /// Block of `other` in the row.
    block: u32,
    rest: f64,
}

/// A corner or a strut (i, j, k) seen from one of its vertices.
struct TripleAt {
    vertices: [u32; 3],
    blocks: [u32; 3],
    role: usize,
}

/// Which vertices touch which, and by what.
pub(super) struct System<const D: usize> {
    springs: Lists<SpringAt>,
    corners: Lists<TripleAt>,
    struts: Lists<TripleAt>,
    /// Columns of every row, its own vertex first.
    columns: Lists<u32>,
    /// Blocks, in the order of `columns` [κ].
    values: Vec<Block<D>>,
    /// Inverse blocks of the diagonal.
    inverse: Vec<Block<D>>,
    /// −∇V in the frames, [vertex_count].
    pub force: Vec<Small<D>>,
    params: RelaxParams,
    rest_wale: f64,
}

impl<const D: usize> System<D> {
    pub fn new(count: usize, elements: &Elements, params: &RelaxParams, rest_wale: f64) -> Self {
        let both = |[a, b]: [u32; 2]| [(a, b), (b, a)];
        let mut pairs: Vec<(u32, u32)> = (0..count as u32).map(|v| (v, v)).collect();
        pairs.extend(elements.springs.iter().flat_map(|s| both(s.ends)));
        let triples = || elements.corners.iter().chain(&elements.struts);
        pairs.extend(
            triples().flat_map(|[i, j, k]| [[*i, *j], [*j, *k], [*i, *k]].into_iter().flat_map(both)),
        );
        // Sorted by row and column, the own vertex in front.
        pairs.par_sort_unstable_by_key(|(v, w)| (*v, v != w, *w));
        pairs.dedup();
        let columns = Lists::new(count, pairs);
        let block = |v: u32, w: u32| {
            let at = columns.of(v as usize).iter().position(|c| *c == w);
            columns.start[v as usize] + at.unwrap_or(0) as u32
        };
        let springs = elements.springs.iter().flat_map(|s| {
            both(s.ends).map(|(v, other)| (v, SpringAt { other, block: block(v, other), rest: s.rest }))
        });
        let at = |triple: &[u32; 3]| {
            let vertices = *triple;
            (0..3).map(move |role| {
                let v = vertices[role];
                (v, TripleAt { vertices, blocks: vertices.map(|w| block(v, w)), role })
            })
        };
        Self {
            springs: Lists::new(count, springs.collect()),
            corners: Lists::new(count, elements.corners.iter().flat_map(at).collect()),
            struts: Lists::new(count, elements.struts.iter().flat_map(at).collect()),
            values: vec![[[0.0; D]; D]; columns.items.len()],
            inverse: vec![[[0.0; D]; D]; count],
            force: vec![[0.0; D]; count],
            columns,
            params: *params,
            rest_wale,
        }
    }

    /// Works out the force and the matrix I/h + K at positions `x`.
    pub fn assemble(&mut self, x: &[DVec3], frames: &[Frame<D>], normals: &[DVec3], over_h: f64) {
        let mut rows: Vec<&mut [Block<D>]> = Vec::with_capacity(x.len());
        let mut rest = &mut self.values[..];
        for v in 0..x.len() {
            let (row, after) = rest.split_at_mut(self.columns.of(v).len());
            rows.push(row);
            rest = after;
        }
        let at = Row {
            x,
            frames,
            normals,
            springs: &self.springs,
            corners: &self.corners,
            struts: &self.struts,
            start: &self.columns.start,
            params: &self.params,
            rest_wale: self.rest_wale,
        };
        let outputs = (rows, &mut self.force, &mut self.inverse);
        outputs.into_par_iter().with_min_len(CHUNK / 4).enumerate().for_each(|(v, (row, force, inverse))| {
            at.fill(v, row, force);
            for d in 0..D {
                row[0][d][d] += over_h;
            }
            *inverse = inverted(&row[0]);
        });
    }

    /// Sets `y` to the matrix times `x`, and gives x·y, chunk by chunk.
    pub fn product(&self, x: &[Small<D>], y: &mut [Small<D>]) -> f64 {
        let parts = y.par_chunks_mut(CHUNK).enumerate().map(|(chunk, part)| {
            let mut dot = 0.0;
            for (i, out) in part.iter_mut().enumerate() {
                let v = chunk * CHUNK + i;
                let span = self.columns.start[v] as usize..self.columns.start[v + 1] as usize;
                let mut sum = [0.0; D];
                for (block, w) in self.values[span.clone()].iter().zip(&self.columns.items[span]) {
                    let other = &x[*w as usize];
                    for r in 0..D {
                        for c in 0..D {
                            sum[r] += block[r][c] * other[c];
                        }
                    }
                }
                (0..D).for_each(|r| dot += sum[r] * x[v][r]);
                *out = sum;
            }
            dot
        });
        parts.collect::<Vec<f64>>().iter().sum()
    }

    /// The preconditioner: r times the inverse blocks of the diagonal.
    pub fn precondition(&self, v: usize, r: &Small<D>) -> Small<D> {
        let block = &self.inverse[v];
        std::array::from_fn(|i| (0..D).map(|j| block[i][j] * r[j]).sum())
    }
}

/// What a row is made of.
struct Row<'a, const D: usize> {
    x: &'a [DVec3],
    frames: &'a [Frame<D>],
    normals: &'a [DVec3],
    springs: &'a Lists<SpringAt>,
    corners: &'a Lists<TripleAt>,
    struts: &'a Lists<TripleAt>,
    start: &'a [u32],
    params: &'a RelaxParams,
    rest_wale: f64,
}

impl<const D: usize> Row<'_, D> {
    /// The force on a vertex and its row of K.
    fn fill(&self, v: usize, row: &mut [Block<D>], force: &mut Small<D>) {
        let RelaxParams { stretch, shear, wale, fold, .. } = *self.params;
        let (frame, first) = (&self.frames[v], self.start[v]);
        row.fill([[0.0; D]; D]);
        let mut gradient = DVec3::ZERO;
        for SpringAt { other, block, rest } in self.springs.of(v) {
            let r = self.x[v] - self.x[*other as usize];
            let e = stretch::expand(r, *rest);
            gradient += stretch * e.slope * e.direction;
            let (along, across) = (stretch * e.along, stretch * e.across);
            self.line(frame, *other, e.direction, [along, across], row, (block - first) as usize);
        }
        for TripleAt { vertices, blocks, role } in self.corners.of(v) {
            let at = vertices.map(|w| self.x[w as usize]);
            let (c, g) = shear::expand(at);
            gradient += 0.5 * shear * c * g[*role];
            let own = project(frame, g[*role] * (0.5 * shear));
            for (w, (b, g)) in vertices.iter().zip(blocks.iter().zip(&g)) {
                add_outer(&mut row[(b - first) as usize], &own, &project(&self.frames[*w as usize], *g));
            }
            if let Some((slope, curvature, g)) = fold::expand(at, self.normals[vertices[1] as usize]) {
                gradient += fold * slope * g[*role];
                let own = project(frame, g[*role] * (fold * curvature));
                for (w, (b, g)) in vertices.iter().zip(blocks.iter().zip(&g)) {
                    add_outer(&mut row[(b - first) as usize], &own, &project(&self.frames[*w as usize], *g));
                }
            }
        }
        for TripleAt { vertices, blocks, role } in self.struts.of(v) {
            let e = strut::expand(vertices.map(|w| self.x[w as usize]), self.rest_wale);
            gradient += wale * e.gradient[*role];
            let own = project(frame, e.s[*role] * (wale * e.along));
            for (w, (b, s)) in vertices.iter().zip(blocks.iter().zip(&e.s)) {
                add_outer(&mut row[(b - first) as usize], &own, &project(&self.frames[*w as usize], *s));
            }
            // The two edges across themselves: each joins an outer vertex with the middle one.
            for (end, across, direction) in [(0, e.across[0], e.e[0]), (2, e.across[1], e.e[1])] {
                let other = match *role {
                    1 => end,
                    role if role == end => 1,
                    _ => continue,
                };
                let across = if direction == DVec3::ZERO { 0.0 } else { wale * across };
                let b = (blocks[other] - first) as usize;
                self.line(frame, vertices[other], direction, [0.0, across], row, b);
            }
        }
        *force = project(frame, -gradient);
    }

    /// Adds the stiffness of a line to another vertex: `along` d̂d̂ᵀ + `across` (I − d̂d̂ᵀ).
    fn line(
        &self,
        frame: &Frame<D>,
        other: u32,
        direction: DVec3,
        [along, across]: [f64; 2],
        row: &mut [Block<D>],
        block: usize,
    ) {
        let theirs = &self.frames[other as usize];
        let (own, far) = (project(frame, direction), project(theirs, direction));
        for r in 0..D {
            for c in 0..D {
                let spread =
                    if across > 0.0 { [frame[r].dot(frame[c]), frame[r].dot(theirs[c])] } else { [0.0; 2] };
                row[0][r][c] += across * spread[0] + (along - across) * own[r] * own[c];
                row[block][r][c] -= across * spread[1] + (along - across) * own[r] * far[c];
            }
        }
    }
}

fn project<const D: usize>(frame: &Frame<D>, v: DVec3) -> Small<D> {
    std::array::from_fn(|d| frame[d].dot(v))
}

fn add_outer<const D: usize>(block: &mut Block<D>, a: &Small<D>, b: &Small<D>) {
    for r in 0..D {
        for c in 0..D {
            block[r][c] += a[r] * b[c];
        }
    }
}

/// Inverse of a positive definite block, by Gauss–Jordan without pivots; a pivot that rounding has spoilt counts as 1.
fn inverted<const D: usize>(block: &Block<D>) -> Block<D> {
    let mut a = *block;
    let mut inverse: Block<D> = std::array::from_fn(|i| std::array::from_fn(|j| f64::from(u8::from(i == j))));
    for p in 0..D {
        let pivot = if a[p][p] > 0.0 { 1.0 / a[p][p] } else { 1.0 };
        for c in 0..D {
            (a[p][c], inverse[p][c]) = (a[p][c] * pivot, inverse[p][c] * pivot);
        }
        for r in (0..D).filter(|r| *r != p) {
            let factor = a[r][p];
            for c in 0..D {
                a[r][c] -= factor * a[p][c];
                inverse[r][c] -= factor * inverse[p][c];
            }
        }
    }
    inverse
}

/// V at positions `x` with these normals: springs, corners and struts of `elements`.
pub(super) fn energy(
    elements: &Elements,
    params: &RelaxParams,
    rest_wale: f64,
    x: &[DVec3],
    normals: &[DVec3],
) -> f64 {
    let RelaxParams { stretch, shear, wale, fold, .. } = *params;
    let at = |v: u32| x[v as usize];
    let springs = in_chunks(&elements.springs, |s| {
        let [a, b] = s.ends.map(at);
        stretch * stretch::energy(a - b, s.rest)
    });
    let corners = in_chunks(&elements.corners, |t| {
        let points = t.map(at);
        shear * shear::energy(points) + fold * fold::energy(points, normals[t[1] as usize])
    });
    let struts = in_chunks(&elements.struts, |t| wale * strut::energy(t.map(at), rest_wale));
    springs + corners + struts
}

/// A sum whose bits do not depend on the number of threads.
fn in_chunks<T: Sync>(items: &[T], of: impl Fn(&T) -> f64 + Sync) -> f64 {
    let parts = items.par_chunks(CHUNK).map(|chunk| chunk.iter().map(&of).sum::<f64>());
    parts.collect::<Vec<f64>>().iter().sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh_relax::params::RestLengths;
    use crate::noise::unit_hash;
    use stitch_mesh::edge_counts::StitchSize;
    use stitch_mesh::pieces::tube;

    struct Case {
        elements: Elements,
        system: System<3>,
        x: Vec<DVec3>,
        normals: Vec<DVec3>,
        params: RelaxParams,
        wale: f64,
    }

    /// A crumpled tube, with all forces at work.
    fn case(fold: f64) -> Case {
        let piece = tube(9, 6, StitchSize::of_width(1e-3)).unwrap();
        let rest = RestLengths { course: 1.1e-3, wale: 0.8e-3 };
        let elements = Elements::new(&piece, &rest);
        let noise = |i: usize| 0.5 * (unit_hash(i as u64) - 0.5);
        let crumpled = |(v, p): (usize, &DVec3)| {
            *p / rest.unit() + DVec3::new(noise(3 * v), noise(3 * v + 1), noise(3 * v + 2))
        };
        let x: Vec<DVec3> = piece.mesh().positions().iter().enumerate().map(crumpled).collect();
        let params = RelaxParams { stretch: 1.3, shear: 0.7, wale: 1.9, fold, ..RelaxParams::default() };
        let wale = rest.wale / rest.unit();
        let mut system = System::<3>::new(x.len(), &elements, &params, wale);
        let normals = piece.mesh().vertex_normals();
        system.assemble(&x, &vec![DVec3::AXES; x.len()], &normals, 0.01);
        Case { elements, system, x, normals, params, wale }
    }

    fn direction(count: usize, seed: u64) -> Vec<Small<3>> {
        let at = |v: usize| [0, 1, 2].map(|d| unit_hash(seed + (3 * v + d) as u64) - 0.5);
        (0..count).map(at).collect()
    }

    fn dot(a: &[Small<3>], b: &[Small<3>]) -> f64 {
        a.as_flattened().iter().zip(b.as_flattened()).map(|(a, b)| a * b).sum()
    }

    #[test]
    fn the_assembled_force_is_the_slope_of_the_energy() {
        let Case { elements, system, x, normals, params, wale } = case(0.4);
        let way = direction(x.len(), 7);
        let energy_at = |t: f64| {
            let moved: Vec<DVec3> = x.iter().zip(&way).map(|(x, w)| *x + t * DVec3::from_array(*w)).collect();
            energy(&elements, &params, wale, &moved, &normals)
        };
        let h = 1e-4;
        let slope =
            (8.0 * (energy_at(h) - energy_at(-h)) - (energy_at(2.0 * h) - energy_at(-2.0 * h))) / (12.0 * h);
        assert!((slope + dot(&system.force, &way)).abs() < 1e-7 * slope.abs(), "{slope}");
    }

    #[test]
    fn forces_balance() {
        let Case { system, x, .. } = case(0.0);
        let force = |v: usize| DVec3::from_array(system.force[v]);
        let (sum, turn) = (0..x.len())
            .fold((DVec3::ZERO, DVec3::ZERO), |(s, t), v| (s + force(v), t + x[v].cross(force(v))));
        assert!(sum.length() < 1e-11 && force(0).length() > 0.1, "{sum}");
        // Folding holds its normals fast and so is left out: it alone turns things.
        assert!(turn.length() < 1e-11, "{turn}");
    }

    #[test]
    fn the_matrix_is_symmetric_and_positive_definite() {
        let Case { system, x, .. } = case(0.4);
        let (a, b) = (direction(x.len(), 100), direction(x.len(), 9000));
        let (mut ka, mut kb) = (a.clone(), a.clone());
        assert!(system.product(&a, &mut ka) > 0.0 && system.product(&b, &mut kb) > 0.0);
        assert!((dot(&a, &kb) - dot(&b, &ka)).abs() < 1e-10 * dot(&a, &ka).abs());
    }

    #[test]
    fn a_block_times_its_inverse() {
        let block = [[4.0, 1.0, 0.5], [1.0, 3.0, 0.2], [0.5, 0.2, 2.0]];
        let inverse = inverted(&block);
        for i in 0..3 {
            for j in 0..3 {
                let product: f64 = (0..3).map(|k| block[i][k] * inverse[k][j]).sum();
                assert!((product - f64::from(u8::from(i == j))).abs() < 1e-14);
            }
        }
        assert!(inverted(&[[0.0; 2]; 2]).as_flattened().iter().all(|v| v.is_finite()));
    }
}
