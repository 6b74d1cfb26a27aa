//! Sparse Cholesky factorisation, its symbolic part kept for the life of a net.

use super::gradients::Preconditioner;
use super::matrix::BlockMatrix;
use super::ordering::elimination_order;
use crate::model::Model;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::perm::PermRef;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, LltRef, SymbolicCholesky, SymmetricOrdering, factorize_symbolic_cholesky,
};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, MatMut, Par, Side};

/// Why a system could not be solved.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum SolveError {
    /// The matrix has no factorisation: a pivot is zero, negative or NaN.
    #[error("the system matrix is not positive definite")]
    NotPositiveDefinite,
    /// Memory for the factors ran out.
    #[error("not enough memory to factorise {0} unknowns")]
    OutOfMemory(usize),
    /// Conjugate gradients did not get near enough to the solution.
    #[error("the system did not converge")]
    NotConverged,
}

/// The factors of a matrix and the memory to make them in.
pub(crate) struct Cholesky {
    symbolic: SymbolicCholesky<u32>,
    factor: Vec<f64>,
    scratch: MemBuffer,
}

impl Cholesky {
    /// Orders the unknowns and lays out the factors.
    pub fn new(model: &Model, matrix: &BlockMatrix) -> Result<Self, SolveError> {
        let out_of_memory = SolveError::OutOfMemory(matrix.dof_count());
        let order = elimination_order(model);
        let mut place = vec![0; order.len()];
        for (new, old) in order.iter().enumerate() {
            place[*old as usize] = new as u32;
        }
        let symbolic = factorize_symbolic_cholesky(
            pattern(matrix),
            Side::Lower,
            SymmetricOrdering::Custom(PermRef::new_checked(&order, &place, order.len())),
            CholeskySymbolicParams::default(),
        )
        .map_err(|_| out_of_memory)?;
        let need =
            symbolic
                .factorize_numeric_llt_scratch::<f64>(Par::Seq, Default::default())
                .or(symbolic.solve_in_place_scratch::<f64>(1, Par::Seq));
        let scratch = MemBuffer::try_new(need).map_err(|_| out_of_memory)?;
        let factor = vec![0.0; symbolic.len_val()];
        Ok(Self { symbolic, factor, scratch })
    }

    /// Makes the factors of `matrix`, its tail left out.
    pub fn factorise(&mut self, matrix: &BlockMatrix) -> Result<(), SolveError> {
        let system = SparseColMatRef::new(pattern(matrix), matrix.value.as_slice());
        let stack = MemStack::new(&mut self.scratch);
        self.symbolic
            .factorize_numeric_llt(
                &mut self.factor,
                system,
                Side::Lower,
                Default::default(),
                Par::Seq,
                stack,
                Default::default(),
            )
            .map_err(|_| SolveError::NotPositiveDefinite)?;
        Ok(())
    }
}

impl Preconditioner for Cholesky {
    fn apply(&mut self, r: &[f64], z: &mut [f64]) {
        z.copy_from_slice(r);
        let count = z.len();
        LltRef::new(&self.symbolic, &self.factor).solve_in_place_with_conj(
            Conj::No,
            MatMut::from_column_major_slice_mut(z, count, 1),
            Par::Seq,
            MemStack::new(&mut self.scratch),
        );
    }
}

fn pattern(matrix: &BlockMatrix) -> SymbolicSparseColMatRef<'_, u32> {
    let count = matrix.dof_count();
    SymbolicSparseColMatRef::new_checked(count, count, &matrix.column, None, &matrix.row)
}
