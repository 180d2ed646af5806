//! General systems: the sparse LU of `faer` with free partial pivoting, the last resort.
//!
//! Its column order (COLAMD) knows nothing of the grid, so it needs several times the memory and
//! the time of the multifrontal LU; but its pivots may come from anywhere, so it only fails where
//! the matrix itself is singular.

use std::sync::Arc;

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::sparse::SparseColMatRef;
use faer::sparse::linalg::LuError;
use faer::sparse::linalg::lu::{self, LuRef, LuSymbolicParams, NumericLu, SymbolicLu};
use faer::{Conj, MatMut, Par, Spec};

use super::faer_cholesky::symbolic_view;
use crate::check::{self, Inspection};
use crate::refine::{Accuracy, Refinement, probe};
use crate::{
    CompressedColumns, LinearSolver, LinearSolverError, Pattern, SolveReport, TangentMatrix,
};

/// LU with partial pivoting for any non-singular matrix.
#[derive(Default)]
pub struct GeneralLu {
    accuracy: Accuracy,
    analyses: usize,
    analysis: Option<Analysis>,
    numeric: NumericLu<usize, f64>,
    inspection: Inspection,
    refinement: Refinement,
    factored: bool,
}

struct Analysis {
    pattern: Arc<Pattern>,
    columns: CompressedColumns,
    symbolic: SymbolicLu<usize>,
    workspace: MemBuffer,
}

impl GeneralLu {
    /// A solver with other demands on the residual than the default.
    pub fn with_accuracy(accuracy: Accuracy) -> Self {
        Self {
            accuracy,
            ..Self::default()
        }
    }

    fn solve_factored(
        &mut self,
        matrix: &TangentMatrix,
        rhs: &[f64],
        solution: &mut [f64],
    ) -> Result<SolveReport, LinearSolverError> {
        let Some(analysis) = &mut self.analysis else {
            return Err(LinearSolverError::NotFactored);
        };
        let unknowns = matrix.pattern.unknowns();
        check::length("the matrix", unknowns, analysis.pattern.unknowns())?;
        let Analysis {
            symbolic,
            workspace,
            ..
        } = analysis;
        let factors = LuRef::new_unchecked(symbolic, &self.numeric);
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
            "faer-lu",
            refined.relative_residual,
            refined.refinements,
        ))
    }
}

impl LinearSolver for GeneralLu {
    fn name(&self) -> &'static str {
        "faer-lu"
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
        check::valid_pattern(pattern)?;
        let out_of_memory = LinearSolverError::OutOfMemory { part: "LU factors" };
        let columns = pattern.compressed_columns();
        let symbolic =
            lu::factorize_symbolic_lu(symbolic_view(&columns), LuSymbolicParams::default())
                .map_err(|_| out_of_memory.clone())?;
        let scratch = symbolic
            .factorize_numeric_lu_scratch::<f64>(Par::Seq, Spec::default())
            .or(symbolic.solve_in_place_scratch::<f64>(1, Par::Seq));
        let workspace = MemBuffer::try_new(scratch).map_err(|_| out_of_memory)?;
        self.analysis = Some(Analysis {
            pattern: Arc::clone(pattern),
            columns,
            symbolic,
            workspace,
        });
        self.analyses += 1;
        Ok(())
    }

    /// As for every solver; besides, a solve with a known right-hand side shows here and not later
    /// whether the matrix is singular.
    fn factor(&mut self, matrix: &TangentMatrix) -> Result<(), LinearSolverError> {
        self.analyse(&matrix.pattern)?;
        self.factored = false;
        self.inspection.inspect(matrix)?;
        let analysis = self
            .analysis
            .as_mut()
            .ok_or(LinearSolverError::NotFactored)?;
        analysis
            .symbolic
            .factorize_numeric_lu(
                &mut self.numeric,
                SparseColMatRef::new(symbolic_view(&analysis.columns), &matrix.values),
                Par::Seq,
                MemStack::new(&mut analysis.workspace),
                Spec::default(),
            )
            .map_err(|error| match error {
                LuError::SymbolicSingular { .. } => LinearSolverError::Singular { unknown: None },
                LuError::Generic(_) => LinearSolverError::OutOfMemory { part: "LU factors" },
            })?;
        probe(matrix.pattern.unknowns(), None, |rhs, solution| {
            self.solve_factored(matrix, rhs, solution)
        })?;
        self.factored = true;
        Ok(())
    }

    fn solve(
        &mut self,
        matrix: &TangentMatrix,
        rhs: &[f64],
        solution: &mut [f64],
    ) -> Result<SolveReport, LinearSolverError> {
        if !self.factored {
            return Err(LinearSolverError::NotFactored);
        }
        self.solve_factored(matrix, rhs, solution)
    }

    fn analyses(&self) -> usize {
        self.analyses
    }
}
