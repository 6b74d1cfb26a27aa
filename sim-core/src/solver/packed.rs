//! Fronts of a factor in sixteen bits a number.
//!
//! # Theory
//! Every application of a factor reads all of it, forwards and backwards, and for more than some hundred loops that is most of what it
//! costs. A preconditioner need not be exact: each column of U = C⁻ᵀ and of Q is kept as whole numbers up to 32 767 times a scale of
//! its own, so the error is at most 1.5e-5 of the largest entry of the column. (Measured on stockinette: 13.0 iterations where the
//! factor in single precision needs 12.8. Ten bits do too; seven, as in bfloat16, need 22.)
//!
//! # Practice
//! Rows lie in bands of [`LANES`], the columns of a band one after the other, so that products are sums of whole vectors. Of U,
//! which is triangular, a band has only the columns from its first row on. A second copy for the way back, transposed so that it could
//! be read straight ahead too, makes it slower: what has just been read forwards is still in the cache.

/// Rows in a band: a vector register of the common kind.
pub(crate) const LANES: usize = 8;

/// A column of a band.
pub(crate) type Tile = [i16; LANES];

/// Columns that are added up beside each other, so that additions need not wait for each other.
const BESIDE: usize = 4;

/// The largest entry of a column becomes this number.
const MOST: f32 = 32_767.0;

/// 1.5 · 2²³, the middle of the numbers in single precision that are whole and lie one apart.
const ROUNDING: f32 = 12_582_912.0;

/// The tiles of a front with `n` unknowns and `m` rows: of U, of Q, and some behind that are never used, so that there are always four
/// to be read at once.
pub(crate) fn tile_count(n: usize, m: usize) -> usize {
    before(n.div_ceil(LANES), n) + m.div_ceil(LANES) * n + BESIDE - 1
}

/// Tiles of U before a band.
fn before(band: usize, n: usize) -> usize {
    band * n - LANES * band * band.saturating_sub(1) / 2
}

/// A packed front.
#[derive(Clone, Copy)]
pub(crate) struct Packed<'a> {
    /// Its tiles, as in [`tile_count`].
    pub tiles: &'a [Tile],
    /// Scale of each column of U and of Q, [n].
    pub scale: &'a [[f32; 2]],
    /// m.
    pub rows: usize,
}

/// Packs U and, from the front (C; Q), Q. Both are stored by columns.
pub(crate) fn pack(inverse: &[f32], front: &[f32], scale: &mut [[f32; 2]], tiles: &mut [Tile]) {
    pulp::Arch::new().dispatch(Packing { inverse, front, scale, tiles });
}

struct Packing<'a> {
    inverse: &'a [f32],
    front: &'a [f32],
    scale: &'a mut [[f32; 2]],
    tiles: &'a mut [Tile],
}

impl pulp::WithSimd for Packing<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _: S) {
        let Self { inverse, front, scale, tiles } = self;
        let n = scale.len();
        let height = front.len() / n;
        let (upper, below) = tiles.split_at_mut(before(n.div_ceil(LANES), n));
        for (j, (own, column)) in inverse.chunks_exact(n).zip(front.chunks_exact(height)).enumerate() {
            let (own, others) = (&own[..=j], &column[n..]);
            scale[j] = [own, others].map(|part| (largest(part) / MOST).max(f32::MIN_POSITIVE));
            let [by_upper, by_below] = scale[j].map(|scale| 1.0 / scale);
            let (whole, rest) = own.as_chunks();
            for (band, rows) in whole.iter().enumerate() {
                upper[before(band, n) + j - band * LANES] = whole_numbers(rows, by_upper);
            }
            if !rest.is_empty() {
                upper[before(whole.len(), n) + j - whole.len() * LANES] =
                    whole_numbers(&padded(rest), by_upper);
            }
            let (whole, rest) = others.as_chunks();
            for (band, rows) in whole.iter().enumerate() {
                below[band * n + j] = whole_numbers(rows, by_below);
            }
            if !rest.is_empty() {
                below[whole.len() * n + j] = whole_numbers(&padded(rest), by_below);
            }
        }
    }
}

/// Fewer than [`LANES`] numbers, zeros behind.
#[inline(always)]
fn padded(numbers: &[f32]) -> [f32; LANES] {
    let mut lanes = [0.0; LANES];
    for (lane, x) in lanes.iter_mut().zip(numbers) {
        *lane = *x;
    }
    lanes
}

#[inline(always)]
fn largest(part: &[f32]) -> f32 {
    let mut most = [0.0_f32; LANES];
    let (whole, rest) = part.as_chunks::<LANES>();
    for x in whole {
        for l in 0..LANES {
            most[l] = most[l].max(x[l].abs());
        }
    }
    most.iter().chain(rest).fold(0.0_f32, |most, x| most.max(x.abs()))
}

/// What is nearest to each of `numbers` times `by`.
#[inline(always)]
fn whole_numbers(numbers: &[f32; LANES], by: f32) -> Tile {
    let mut tile = [0; LANES];
    for l in 0..LANES {
        // Adding the constant leaves no bits for fractions, which rounds without a call; the whole number is what it adds to its bits.
        let bits = (numbers[l] * by + ROUNDING).to_bits() as i32;
        tile[l] = (bits - ROUNDING.to_bits() as i32) as i16;
    }
    tile
}

/// Memory for products with a front.
#[derive(Default)]
pub(crate) struct Scratch {
    /// A vector, each entry times the scale of its column.
    scaled: Vec<f32>,
    /// Q y, zeros behind.
    pub change: Vec<[f32; LANES]>,
    /// A vector, zeros behind.
    lanes: Vec<[f32; LANES]>,
}

impl Packed<'_> {
    /// Turns `own` into y = Uᵀ `own`, and sets the change to Q y.
    #[inline(always)]
    pub fn forwards(&self, own: &mut [f32], scratch: &mut Scratch) {
        let n = own.len();
        let Scratch { scaled, change, lanes } = scratch;
        pad(own, lanes);
        scaled.clear();
        for (j, four) in (0..).step_by(BESIDE).zip(own.chunks_mut(BESIDE)) {
            let at = |band| before(band, n) + j - band * LANES;
            let sums = transposed_product(self.tiles, lanes, j / LANES + 1, at);
            for (k, y) in four.iter_mut().enumerate() {
                *y = self.scale[j + k][0] * sums[k];
                scaled.push(*y * self.scale[j + k][1]);
            }
        }
        let below = &self.tiles[before(n.div_ceil(LANES), n)..];
        change.clear();
        for tiles in below.chunks_exact(n).take(self.rows.div_ceil(LANES)) {
            change.push(product(tiles, scaled));
        }
    }

    /// Turns `own`, which is y, into U (y − Qᵀ `known`).
    #[inline(always)]
    pub fn backwards(&self, own: &mut [f32], known: &[f32], scratch: &mut Scratch) {
        let n = own.len();
        let Scratch { scaled, lanes, .. } = scratch;
        let (mut upper, below) = self.tiles.split_at(before(n.div_ceil(LANES), n));
        pad(known, lanes);
        scaled.clear();
        for (j, four) in (0..).step_by(BESIDE).zip(own.chunks(BESIDE)) {
            let sums = transposed_product(below, lanes, lanes.len(), |band| band * n + j);
            for (k, y) in four.iter().enumerate() {
                let [upper, below] = self.scale[j + k];
                scaled.push(upper * (y - below * sums[k]));
            }
        }
        for (first, rows) in (0..).step_by(LANES).zip(own.chunks_mut(LANES)) {
            let (tiles, rest) = upper.split_at(n - first);
            rows.copy_from_slice(&product(tiles, &scaled[first..])[..rows.len()]);
            upper = rest;
        }
    }
}

/// `vector` in lanes, zeros behind.
#[inline(always)]
fn pad(vector: &[f32], lanes: &mut Vec<[f32; LANES]>) {
    lanes.clear();
    let (whole, rest) = vector.as_chunks::<LANES>();
    lanes.extend_from_slice(whole);
    if !rest.is_empty() {
        lanes.push(padded(rest));
    }
}

/// Σⱼ of tile j times xⱼ.
#[inline(always)]
fn product(tiles: &[Tile], x: &[f32]) -> [f32; LANES] {
    let mut sums = [[0.0; LANES]; BESIDE];
    let (fours, rest) = tiles.as_chunks::<BESIDE>();
    for (tiles, x) in fours.iter().zip(x.as_chunks::<BESIDE>().0) {
        for k in 0..BESIDE {
            for l in 0..LANES {
                sums[k][l] += f32::from(tiles[k][l]) * x[k];
            }
        }
    }
    for (tile, x) in rest.iter().zip(&x[fours.len() * BESIDE..]) {
        for l in 0..LANES {
            sums[0][l] += f32::from(tile[l]) * x;
        }
    }
    let mut sum = [0.0; LANES];
    for l in 0..LANES {
        sum[l] = (sums[0][l] + sums[1][l]) + (sums[2][l] + sums[3][l]);
    }
    sum
}

/// Σ over the first `bands` of four columns times x; in each band they lie from `at(band)` on. Beyond the last column the sums are
/// those of something else.
#[inline(always)]
fn transposed_product(
    tiles: &[Tile],
    x: &[[f32; LANES]],
    bands: usize,
    at: impl Fn(usize) -> usize,
) -> [f32; BESIDE] {
    let mut sums = [[0.0; LANES]; BESIDE];
    for (band, x) in x[..bands].iter().enumerate() {
        let Some(four) = tiles[at(band)..].first_chunk::<BESIDE>() else { break };
        for k in 0..BESIDE {
            for l in 0..LANES {
                sums[k][l] += f32::from(four[k][l]) * x[l];
            }
        }
    }
    // Seeing how lanes are added up, the compiler would transpose every tile.
    let sums = std::hint::black_box(sums);
    let mut out = [0.0; BESIDE];
    for (out, sum) in out.iter_mut().zip(&sums) {
        *out = total(sum);
    }
    out
}

/// The lanes of a sum added up.
#[inline(always)]
fn total(sum: &[f32; LANES]) -> f32 {
    let halves: [f32; 4] = [sum[0] + sum[4], sum[1] + sum[5], sum[2] + sum[6], sum[3] + sum[7]];
    (halves[0] + halves[2]) + (halves[1] + halves[3])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn packed_fronts_multiply_as_they_did() {
        let number = |i: usize| crate::noise::unit_hash(i as u64) as f32 - 0.5;
        for (n, m) in [(1, 0), (3, 5), (8, 8), (21, 40), (40, 85)] {
            // Columns of very different size.
            let size = |j: usize| 10f32.powi(j as i32 % 3);
            let upper = |i: usize, j: usize| if i > j { 0.0 } else { number(131 * i + j) * size(j) };
            let below = |i: usize, j: usize| number(7_000 + 131 * i + j) * size(j);
            let inverse: Vec<f32> = (0..n).flat_map(|j| (0..n).map(move |i| upper(i, j))).collect();
            let front: Vec<f32> = (0..n)
                .flat_map(|j| (0..n + m).map(move |i| if i < n { 9.0 } else { below(i - n, j) }))
                .collect();
            let (mut scale, mut tiles) = (vec![[0.0; 2]; n], vec![[0; LANES]; tile_count(n, m)]);
            pack(&inverse, &front, &mut scale, &mut tiles);
            let packed = Packed { tiles: &tiles, scale: &scale, rows: m };
            let x: Vec<f32> = (0..n).map(|i| number(7 + i)).collect();
            let known: Vec<f32> = (0..m).map(|i| number(900 + i)).collect();
            // 1.5e-5 of each product, of which the largest come to 50 and, through both factors, to 50 times 40 · 50.
            let (once, twice) = (1e-3 * (n + m) as f32, 0.1 * (n + m) as f32);

            let (mut y, mut scratch) = (x.clone(), Scratch::default());
            packed.forwards(&mut y, &mut scratch);
            let change = scratch.change.as_flattened();
            assert!(change.len() >= m && change[m..].iter().all(|x| *x == 0.0));
            let expected = |j: usize| (0..n).map(|i| upper(i, j) * x[i]).sum::<f32>();
            assert!((0..n).all(|j| (y[j] - expected(j)).abs() < once));
            let expected = |i: usize| (0..n).map(|j| below(i, j) * y[j]).sum::<f32>();
            assert!((0..m).all(|i| (change[i] - expected(i)).abs() < twice));

            let mut z = x.clone();
            packed.backwards(&mut z, &known, &mut scratch);
            let right: Vec<f32> =
                (0..n).map(|j| x[j] - (0..m).map(|i| below(i, j) * known[i]).sum::<f32>()).collect();
            let expected = |i: usize| (0..n).map(|j| upper(i, j) * right[j]).sum::<f32>();
            assert!((0..n).all(|i| (z[i] - expected(i)).abs() < twice));
        }
    }
}
