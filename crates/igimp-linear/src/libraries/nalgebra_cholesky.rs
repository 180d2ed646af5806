//! Symmetric positive definite systems: the Cholesky factorisation of `nalgebra-sparse`.
//!
//! An independent second to [`crate::FaerCholesky`], about ten times slower; it shares with it the
//! order of elimination and the refinement, and no line of the factorisation.

use std::sync::Arc;

use nalgebra::DMatrixViewMut;
use nalgebra_sparse::factorization::{CscCholesky, CscSymbolicCholesky};
use nalgebra_sparse::pattern::SparsityPattern;

use crate::check::{self, Inspection};
use crate::refine::{Accuracy, Refinement};
use crate::{
    CompressedColumns, LinearSolver, LinearSolverError, NestedDissection, Pattern, SolveReport,
    TangentMatrix,
};

/// Column-by-column Cholesky factorisation for symmetric positive definite matrices.
#[derive(Default)]
pub struct NalgebraCholesky {
    accuracy: Accuracy,
    analyses: usize,
    analysis: Option<Analysis>,
    factors: Option<CscCholesky<f64>>,
    inspection: Inspection,
    refinement: Refinement,
}

struct Analysis {
    pattern: Arc<Pattern>,
    symbolic: CscSymbolicCholesky,
    /// Unknowns in order of elimination.
    order: Vec<usize>,
    /// Where each value of the permuted matrix stands in the given one.
    sources: Vec<usize>,
}

impl NalgebraCholesky {
    /// A solver with other demands on the residual than the default.
    pub fn with_accuracy(accuracy: Accuracy) -> Self {
        Self {
            accuracy,
            ..Self::default()
        }
    }
}

impl LinearSolver for NalgebraCholesky {
    fn name(&self) -> &'static str {
        "nalgebra-llt"
    }

    fn analyse(&mut self, pattern: &Arc<Pattern>) -> Result<(), LinearSolverError> {
        if check::same_pattern(
            self.analysis.as_ref().map(|analysis| &analysis.pattern),
            pattern,
        ) {
            return Ok(());
        }
        self.factors = None;
        self.analysis = None;
        self.analysis = Some(Analysis::new(pattern)?);
        self.analyses += 1;
        Ok(())
    }

    fn factor(&mut self, matrix: &TangentMatrix) -> Result<(), LinearSolverError> {
        self.analyse(&matrix.pattern)?;
        self.factors = None;
        if !matrix.symmetric {
            return Err(LinearSolverError::NotSymmetric);
        }
        self.inspection.inspect(matrix)?;
        let analysis = self
            .analysis
            .as_ref()
            .ok_or(LinearSolverError::NotFactored)?;
        let values: Vec<f64> = analysis
            .sources
            .iter()
            .map(|&entry| matrix.values[entry])
            .collect();
        let factors = CscCholesky::factor_numerical(analysis.symbolic.clone(), &values)
            .map_err(|_| LinearSolverError::NotPositiveDefinite { unknown: None })?;
        let lower = factors.l();
        let roots = lower
            .col_offsets()
            .iter()
            .map(|&start| lower.values().get(start));
        let pivots = analysis.order.iter().zip(roots.flatten());
        check::sound_pivots(
            &self.inspection.diagonal,
            pivots.map(|(&unknown, root)| (unknown, root * root)),
        )?;
        self.factors = Some(factors);
        Ok(())
    }

    fn solve(
        &mut self,
        matrix: &TangentMatrix,
        rhs: &[f64],
        solution: &mut [f64],
    ) -> Result<SolveReport, LinearSolverError> {
        let (Some(Analysis { order, .. }), Some(factors)) = (&self.analysis, &self.factors) else {
            return Err(LinearSolverError::NotFactored);
        };
        let unknowns = matrix.pattern.unknowns();
        check::length("the matrix", unknowns, order.len())?;
        let mut permuted = vec![0.0; order.len()];
        let accuracy = &self.accuracy;
        let refined = self
            .refinement
            .solve(matrix, rhs, solution, accuracy, |vector| {
                for (permuted, &unknown) in permuted.iter_mut().zip(order) {
                    *permuted = vector[unknown];
                }
                factors.solve_mut(DMatrixViewMut::from_slice(&mut permuted, order.len(), 1));
                for (&permuted, &unknown) in permuted.iter().zip(order) {
                    vector[unknown] = permuted;
                }
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
        let unknowns = order.len();
        let mut position = vec![0; unknowns];
        for (new, &old) in order.iter().enumerate() {
            position[old] = new;
        }
        let CompressedColumns { col_ptr, row_idx } = pattern.compressed_columns();
        let mut offsets = vec![0];
        let mut rows = Vec::with_capacity(pattern.stored());
        let mut sources = Vec::with_capacity(pattern.stored());
        let mut column: Vec<(usize, usize)> = Vec::new();
        for &old in &order {
            let entries = col_ptr[old]..col_ptr[old + 1];
            column.clear();
            column.extend(entries.map(|entry| (position[row_idx[entry]], entry)));
            column.sort_unstable();
            rows.extend(column.iter().map(|&(row, _)| row));
            sources.extend(column.iter().map(|&(_, entry)| entry));
            offsets.push(rows.len());
        }
        let permuted =
            SparsityPattern::try_from_offsets_and_indices(unknowns, unknowns, offsets, rows)
                .map_err(|_| LinearSolverError::InvalidPattern {
                    reason: "not square",
                    block: 0,
                })?;
        let symbolic = CscSymbolicCholesky::factor(permuted);
        Ok(Self {
            pattern: Arc::clone(pattern),
            symbolic,
            order,
            sources,
        })
    }
}
