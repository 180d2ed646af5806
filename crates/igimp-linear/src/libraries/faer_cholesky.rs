//! Symmetric positive definite systems: the supernodal Cholesky factorisation of
//! `faer` on the nested dissection.
//!
//! T. A. Davis, *Direct Methods for Sparse Linear Systems*, SIAM 2006, ch. 4. A tangent with
//! associated flow is symmetric and, before collapse, positive definite; a pivot that is not
//! positive is an error here, and [`crate::AutoSolver`] then turns to LU.

use std::sync::Arc;

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::LltRegularization;
use faer::perm::PermRef;
use faer::sparse::linalg::cholesky::{
    self, CholeskySymbolicParams, LltRef, SymbolicCholesky, SymbolicCholeskyRaw, SymmetricOrdering,
};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, MatMut, Par, Side, Spec};

use crate::check::{self, Inspection};
use crate::refine::{Accuracy, Refinement};
use crate::{
    CompressedColumns, LinearSolver, LinearSolverError, NestedDissection, Pattern, SolveReport,
    TangentMatrix,
};

/// Supernodal Cholesky factorisation for symmetric positive definite matrices; reads the lower triangle only.
#[derive(Default)]
pub struct FaerCholesky {
    accuracy: Accuracy,
    analyses: usize,
    analysis: Option<Analysis>,
    factors: Vec<f64>,
    inspection: Inspection,
    refinement: Refinement,
    factored: bool,
}

struct Analysis {
    pattern: Arc<Pattern>,
    columns: CompressedColumns,
    symbolic: SymbolicCholesky<usize>,
    workspace: MemBuffer,
}

impl FaerCholesky {
    /// A solver with other demands on the residual than the default.
    pub fn with_accuracy(accuracy: Accuracy) -> Self {
        Self {
            accuracy,
            ..Self::default()
        }
    }

    /// Number of entries of the factor L of the pattern analysed last, zero before.
    pub fn factor_entries(&self) -> usize {
        self.analysis
            .as_ref()
            .map_or(0, |analysis| analysis.symbolic.len_val())
    }
}

impl LinearSolver for FaerCholesky {
    fn name(&self) -> &'static str {
        "faer-llt"
    }

    fn analyse(&mut self, pattern: &Arc<Pattern>) -> Result<(), LinearSolverError> {
        if check::same_pattern(
            self.analysis.as_ref().map(|analysis| &analysis.pattern),
            pattern,
        ) {
            return Ok(());
        }
        self.factored = false;
        self.analysis = None;
        self.analysis = Some(Analysis::new(pattern)?);
        self.analyses += 1;
        Ok(())
    }

    fn factor(&mut self, matrix: &TangentMatrix) -> Result<(), LinearSolverError> {
        self.analyse(&matrix.pattern)?;
        self.factored = false;
        if !matrix.symmetric {
            return Err(LinearSolverError::NotSymmetric);
        }
        self.inspection.inspect(matrix)?;
        let analysis = self
            .analysis
            .as_mut()
            .ok_or(LinearSolverError::NotFactored)?;
        self.factors.resize(analysis.symbolic.len_val(), 0.0);
        analysis.factor(matrix, &self.inspection.diagonal, &mut self.factors)?;
        self.factored = true;
        Ok(())
    }

    fn solve(
        &mut self,
        matrix: &TangentMatrix,
        rhs: &[f64],
        solution: &mut [f64],
    ) -> Result<SolveReport, LinearSolverError> {
        let (Some(analysis), true) = (&mut self.analysis, self.factored) else {
            return Err(LinearSolverError::NotFactored);
        };
        let unknowns = matrix.pattern.unknowns();
        check::length("the matrix", unknowns, analysis.pattern.unknowns())?;
        let Analysis {
            symbolic,
            workspace,
            ..
        } = analysis;
        let factors = LltRef::new(symbolic, &self.factors);
        let accuracy = &self.accuracy;
        let refined = self
            .refinement
            .solve(matrix, rhs, solution, accuracy, |vector| {
                let rows = vector.len();
                factors.solve_in_place_with_conj(
                    Conj::No,
                    MatMut::from_column_major_slice_mut(vector, rows, 1),
                    Par::Seq,
                    MemStack::new(workspace),
                );
            })?;
        Ok(SolveReport::new(
            self.name(),
            refined.relative_residual,
            refined.refinements,
        ))
    }

    fn analyses(&self) -> usize {
        self.analyses
    }
}

impl Analysis {
    fn new(pattern: &Arc<Pattern>) -> Result<Self, LinearSolverError> {
        check::valid_pattern(pattern)?;
        let order = NestedDissection::new(pattern).unknowns(pattern);
        let mut position = vec![0; order.len()];
        for (new, &old) in order.iter().enumerate() {
            position[old] = new;
        }
        let out_of_memory = LinearSolverError::OutOfMemory {
            part: "Cholesky factor",
        };
        let columns = pattern.compressed_columns();
        let symbolic = cholesky::factorize_symbolic_cholesky(
            symbolic_view(&columns),
            Side::Lower,
            SymmetricOrdering::Custom(PermRef::new_checked(&order, &position, order.len())),
            CholeskySymbolicParams::default(),
        )
        .map_err(|_| out_of_memory.clone())?;
        let scratch = symbolic
            .factorize_numeric_llt_scratch::<f64>(Par::Seq, Spec::default())
            .or(symbolic.solve_in_place_scratch::<f64>(1, Par::Seq));
        let workspace = MemBuffer::try_new(scratch).map_err(|_| out_of_memory)?;
        Ok(Self {
            pattern: Arc::clone(pattern),
            columns,
            symbolic,
            workspace,
        })
    }

    fn factor(
        &mut self,
        matrix: &TangentMatrix,
        diagonal: &[f64],
        factors: &mut [f64],
    ) -> Result<(), LinearSolverError> {
        self.symbolic
            .factorize_numeric_llt(
                factors,
                SparseColMatRef::new(symbolic_view(&self.columns), &matrix.values),
                Side::Lower,
                LltRegularization::default(),
                Par::Seq,
                MemStack::new(&mut self.workspace),
                Spec::default(),
            )
            .map_err(|_| LinearSolverError::NotPositiveDefinite { unknown: None })?;
        let order = self.symbolic.perm().map(|perm| perm.arrays().0);
        let roots = self.pivot_roots(factors).into_iter().enumerate();
        let unknown_of = |k| order.map_or(k, |order| order[k]);
        check::sound_pivots(
            diagonal,
            roots.map(|(k, root)| (unknown_of(k), root * root)),
        )
    }

    /// The square roots of the pivots, the diagonal of L, in order of elimination.
    fn pivot_roots(&self, factors: &[f64]) -> Vec<f64> {
        match self.symbolic.raw() {
            SymbolicCholeskyRaw::Simplicial(simplicial) => {
                let columns = &simplicial.col_ptr()[..simplicial.ncols()];
                columns.iter().map(|&start| factors[start]).collect()
            }
            SymbolicCholeskyRaw::Supernodal(supernodal) => {
                let mut roots = Vec::with_capacity(supernodal.ncols());
                for node in 0..supernodal.n_supernodes() {
                    let first = supernodal.col_ptr_for_val()[node];
                    let columns =
                        supernodal.supernode_end()[node] - supernodal.supernode_begin()[node];
                    let rows = columns + supernodal.supernode(node).pattern().len();
                    roots.extend((0..columns).map(|k| factors[first + k * (rows + 1)]));
                }
                roots
            }
        }
    }
}

/// A pattern as `faer` sees it.
pub(crate) fn symbolic_view(columns: &CompressedColumns) -> SymbolicSparseColMatRef<'_, usize> {
    let unknowns = columns.col_ptr.len() - 1;
    let (col_ptr, row_idx) = (&columns.col_ptr, &columns.row_idx);
    SymbolicSparseColMatRef::new_checked(unknowns, unknowns, col_ptr, None, row_idx)
}
