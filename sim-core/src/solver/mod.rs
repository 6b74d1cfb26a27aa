//! The linear system of a step: a sparse symmetric matrix of node blocks, and two ways to solve it.
//!
//! # Theory
//! A complete factorisation of n unknowns takes some n^1.5 operations. Conjugate gradients with an incomplete one take
//! time in proportion to n and to their iterations, which are few where what makes the system hard is local: axial stretch. Garments
//! that move freely in long steps have slow motions of large parts too, and iterations then grow as the root of n. So conjugate
//! gradients begin, and where they took longer than a complete factorisation would have, that solves the next systems. What
//! both take is reckoned in operations and bytes, not timed, so that every machine takes the same way, as long as it has room in
//! memory (`room.rs`).
//!
//! # Practice
//! A step in all at h = 5 ms, on one core:
//!
//! | stockinette | complete | incomplete | its iterations |
//! |---|---|---|---|
//! | 8 × 8 | 2.4 ms | 2.3 ms | 5 |
//! | 16 × 16 | 12 ms | 9 ms | 7 |
//! | 24 × 24 | 37 ms | 20 ms | 7 |
//! | 32 × 32 | 77 ms | 45 ms | 8 |
//! | 41 × 41 | 116 ms | 72 ms | 9 … 14 |
//!
//! - Blocks of two courses of a wale, taken from the net, and single precision do for plain, rib, garter, seed and twisted
//!   fabric, tubes and increases: 9 … 20 iterations to 1e-4, as many at any size.
//! - Without fill, IC(0), there are blocks that are not positive definite even in stockinette, and 52 … 300 iterations (of
//!   24 with one level of fill, to 1e-6). Stacks of three and gathered rows stay hard with one level: 46 … 48.
//! - Hanging stockinette of 1 000, 3 200, 10 600, 32 400, 102 000 and 325 000 loops, h = 5 ms, two cores: 12, 16, 17, 18, 18, 24 iterations, and
//!   36, 34, 40, 40, 42, 53 ms for each 1 000 loops (`purlwise bench growth`): a loop costs 1.45 times as much at last. 1 000 loops are
//!   left to one core, so of processor time a loop takes 2.5 times as much as those, and 1.7 times as much as one of 3 200.
//! - Most of the time of an iteration is that of reading the factor, 5.5 KB a loop and direction, and the matrix, 4.4 KB.
//! - The complete factor of a sweater of 10 400 loops takes 0.37 s on two cores and that of 57 000 3.4 … 4.6 s, at 110 … 160 Gflop/s; the
//!   tail of contacts between layers leaves some 8 iterations to it. The incomplete one took 35 … 55 and 69 … 220 iterations there
//!   at h = 1/60 s. That of a t-shirt of 100 000 loops takes 11 s, that of 327 000 63 s.
//! - The smallest eigenvalues of what is left after the incomplete factorisation are many, not a few: 0.05 … 0.2 at 3 000 loops, 0.01 … 0.1
//!   at 10 400, without a gap. Deflation by 32 … 64 Ritz vectors of earlier steps makes 13 iterations of 20, and costs what that saves.
//!   The best coarse space of translations of patches of 250 loops there is, of least energy, makes 23 of 43; relaxed by three and six
//!   applications of the preconditioner 36 and 30. Left unrelaxed it locks, as yarn between two patches does not stretch.
//!   Complete fill among nodes nearer than 0.1 m instead of all leaves 57 iterations, 0.2 m leaves 5 and saves a tenth.
//! - A diagonal that makes up for dropped products, so that translations are kept (modified IC), leaves half of the systems not
//!   positive definite. Contacts are not to blame (as many iterations without them), nor are shifted diagonals.
//! - Starting from velocities continued in a straight line takes an iteration more than starting from the old ones.

#[cfg(test)]
mod agreement;
pub(crate) mod dissection;
mod elimination;
pub(crate) mod factor;
pub(crate) mod gradients;
pub(crate) mod groups;
pub(crate) mod matrix;
mod packed;
mod panel;
mod parts;
pub(crate) mod pattern;
pub(crate) mod product;
mod room;
mod separator;
pub(crate) mod tail;
mod vectors;

use crate::costs::{Costs, Stage, Watch};
use crate::model::Model;
use factor::Factor;
use gradients::{NotConverged, Solved};
use matrix::BlockMatrix;
use pattern::Pattern;

/// Why a system could not be solved.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum SolveError {
    /// The matrix has no factorisation: a pivot is zero, negative or NaN.
    #[error("the system matrix is not positive definite")]
    NotPositiveDefinite,
    /// Conjugate gradients did not get near enough to the solution.
    #[error("the system did not converge")]
    NotConverged,
}

/// Unknowns above which an incomplete factorisation is faster than a complete one.
const CROSSOVER: usize = 1_500;

/// Error at which a solution is good enough, relative to the solution, in the norm of the energy. Hanging stockinette of 24 × 24
/// stitches is, after 0.2 s and 65 mm, at most 8 µm from where the direct solver has it with 1e-4, and some 100 µm with 1e-3.
pub(crate) const TOLERANCE: f64 = 5e-4;

/// Systems solved directly after one for which that would have been faster: what made that one hard is still there in the next few,
/// and trying in vain costs as much as solving. Each time that it was in vain again it is twice as many, at most [`MOST_DIRECT_AFTER`].
const DIRECT_AFTER: u32 = 16;

/// See [`DIRECT_AFTER`].
const MOST_DIRECT_AFTER: u32 = 256;

/// Iterations after which to give up; a direct solution is faster then, where there is one.
const MOST_ITERATIONS: usize = 80;

/// Iterations after which to give up where nothing else is left: the systems of shorter steps take fewer.
const MOST_ITERATIONS_ALONE: usize = 240;

/// Iterations after which a complete factor made for a matrix that was a little different is given up: with braces it takes 3 … 25.
const MOST_ITERATIONS_AGAIN: usize = 30;

/// Time of an operation of a complete factorisation, over that of reading a byte in an iteration.
const OPERATION_BY_BYTE: f64 = 0.1;

/// Iterations that a complete factorisation leaves to be done, for the tail, counted as those with an incomplete one: 6 of twice the time.
const ITERATIONS_OF_TAIL: usize = 12;

/// Iterations after which to give up with a complete factorisation, which leaves rounding and the tail to them.
const MOST_ITERATIONS_OF_TAIL: usize = 400;

/// How the systems of a step are solved.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Method {
    /// By a complete factorisation: the faster for little fabric, the safer for all.
    Direct,
    /// By conjugate gradients with an incomplete one, whose cost grows with the fabric and no faster.
    Iterative,
}

/// Solves the systems of one net.
pub(crate) struct Solver {
    /// None for a small system.
    incomplete: Option<Factor>,
    /// Made when it is first needed.
    complete: Option<Factor>,
    /// Whether the complete one is used as soon as it is the faster, and not only where the other fails.
    adapts: bool,
    /// Whether there is room in memory for the complete one.
    has_room: bool,
    /// Systems to go before the incomplete factorisation is tried again.
    direct_for: u32,
    /// What that number will be when the incomplete factorisation is the slower next.
    direct_after: u32,
    /// How the last system was solved.
    last: Method,
}

impl Solver {
    /// Solves systems with the pattern of `matrix` by `method`, or by the faster one.
    pub fn new(model: &Model, matrix: &BlockMatrix, method: Option<Method>) -> Self {
        let small = matrix.dof_count() <= CROSSOVER;
        match method {
            Some(Method::Direct) => Self::direct(model, matrix),
            Some(Method::Iterative) => Self::iterative(model, matrix),
            None if small => Self::direct(model, matrix),
            None => Self { adapts: true, ..Self::iterative(model, matrix) },
        }
    }

    /// How it solves the next system.
    pub fn method(&self) -> Method {
        if self.incomplete.is_some() && self.direct_for == 0 { Method::Iterative } else { Method::Direct }
    }

    /// Solves by a complete factorisation.
    pub fn direct(model: &Model, matrix: &BlockMatrix) -> Self {
        let complete = Factor::new(Pattern::complete(model, matrix));
        Self {
            incomplete: None,
            complete: Some(complete),
            adapts: false,
            has_room: true,
            direct_for: 0,
            direct_after: DIRECT_AFTER,
            last: Method::Direct,
        }
    }

    /// Solves by an incomplete factorisation, and where that fails by a complete one if there is room for that.
    pub fn iterative(model: &Model, matrix: &BlockMatrix) -> Self {
        let incomplete = Factor::new(Pattern::incomplete(model, matrix));
        Self {
            incomplete: Some(incomplete),
            complete: None,
            adapts: false,
            has_room: room::is_there_for(model.net.nodes.len()),
            direct_for: 0,
            direct_after: DIRECT_AFTER,
            last: Method::Iterative,
        }
    }

    /// Like [`Solver::solve`], of a matrix that has changed in a few places since the last one was solved: the factor that was made
    /// for that does, unless it turns out not to.
    pub fn solve_again(
        &mut self,
        model: &Model,
        matrix: &BlockMatrix,
        rhs: &[f64],
        x: &mut [f64],
        costs: &mut Costs,
    ) -> Result<(), SolveError> {
        let nodes = &model.start[..model.net.nodes.len()];
        let (factor, most) = match self.last {
            Method::Direct => (&mut self.complete, MOST_ITERATIONS_AGAIN),
            Method::Iterative => (&mut self.incomplete, MOST_ITERATIONS),
        };
        if let Some(factor) = factor {
            let guess = x.to_vec();
            if iterate(matrix, factor, nodes, rhs, x, most, costs).is_ok() {
                return Ok(());
            }
            x.copy_from_slice(&guess);
        }
        self.solve(model, matrix, rhs, x, costs)
    }

    /// Replaces the guess in `x` by the solution of `matrix` x = `rhs`.
    pub fn solve(
        &mut self,
        model: &Model,
        matrix: &BlockMatrix,
        rhs: &[f64],
        x: &mut [f64],
        costs: &mut Costs,
    ) -> Result<(), SolveError> {
        let nodes = &model.start[..model.net.nodes.len()];
        if self.direct_for > 0 {
            self.direct_for -= 1;
        } else if let Some(incomplete) = &mut self.incomplete {
            let as_fast = iterations_as_fast(model, matrix, incomplete);
            let in_vain_before = self.direct_after > DIRECT_AFTER;
            let most = match (self.has_room, self.adapts) {
                (false, _) => MOST_ITERATIONS_ALONE,
                (true, true) if in_vain_before => as_fast,
                // By then it has cost as much again as the better way would have.
                (true, true) => 2 * as_fast,
                (true, false) => MOST_ITERATIONS,
            };
            let before = costs.iterations;
            let solved = factorised(incomplete, matrix, costs)
                .and_then(|factor| iterate(matrix, factor, nodes, rhs, x, most, costs));
            let slow = self.adapts && costs.iterations - before > as_fast as u64;
            if self.has_room && (slow || solved.is_err()) {
                self.direct_for = self.direct_after;
                self.direct_after = (2 * self.direct_after).min(MOST_DIRECT_AFTER);
            } else {
                self.direct_after = DIRECT_AFTER;
            }
            if !self.has_room || solved.is_ok() {
                self.last = Method::Iterative;
                return solved;
            }
            tracing::debug!("the incomplete factorisation failed, solving directly");
        }
        let complete = match &mut self.complete {
            Some(complete) => complete,
            none => {
                let mut watch = Watch::start();
                let laid_out = none.insert(Factor::new(Pattern::complete(model, matrix)));
                watch.lap(costs, Stage::Factorisation);
                laid_out
            }
        };
        self.last = Method::Direct;
        let factor = factorised(complete, matrix, costs)?;
        iterate(matrix, factor, nodes, rhs, x, MOST_ITERATIONS_OF_TAIL, costs)
    }
}

/// Iterations with an incomplete factorisation that take as long as a complete one.
fn iterations_as_fast(model: &Model, matrix: &BlockMatrix, incomplete: &Factor) -> usize {
    let operations = dissection::operations(model.net.nodes.len());
    (OPERATION_BY_BYTE * operations / bytes_read(matrix, incomplete) as f64) as usize + ITERATIONS_OF_TAIL
}

/// Memory read for an iteration: the factor forwards and backwards, and the matrix once [bytes].
fn bytes_read(matrix: &BlockMatrix, factor: &Factor) -> u64 {
    2 * factor.bytes() + size_of_val(&matrix.value[..]) as u64
}

/// The factor, made anew of `matrix`.
fn factorised<'a>(
    factor: &'a mut Factor,
    matrix: &BlockMatrix,
    costs: &mut Costs,
) -> Result<&'a mut Factor, SolveError> {
    let mut watch = Watch::start();
    let made = factor.factorise(matrix);
    watch.lap(costs, Stage::Factorisation);
    costs.operations += factor.operations();
    made.map(|()| factor).map_err(|_| SolveError::NotPositiveDefinite)
}

/// Replaces the guess in `x` by the solution to [`TOLERANCE`], in at most so many iterations.
fn iterate(
    matrix: &BlockMatrix,
    factor: &mut Factor,
    nodes: &[u32],
    rhs: &[f64],
    x: &mut [f64],
    most: usize,
    costs: &mut Costs,
) -> Result<(), SolveError> {
    let mut watch = Watch::start();
    let solved = gradients::solve(matrix, factor, nodes, rhs, x, (most, TOLERANCE));
    watch.lap(costs, Stage::Iterations);
    let (Ok(Solved { iterations, .. }) | Err(NotConverged { iterations })) = solved;
    costs.iterations += iterations as u64;
    costs.bytes += (iterations as u64 + 1) * bytes_read(matrix, factor);
    costs.residual = solved.map_err(|_| SolveError::NotConverged)?.error;
    Ok(())
}
