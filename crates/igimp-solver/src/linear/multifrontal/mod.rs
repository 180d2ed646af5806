//! Structurally symmetric systems: a multifrontal LU on the nested dissection.
//!
//! I. S. Duff & J. K. Reid (1983, 1984); J. W. H. Liu (1992). With non-associated flow the tangent
//! has a symmetric pattern and unsymmetric values. The elimination tree of the pattern then gives
//! a plan of dense eliminations for the supernodes ([`symbolic`]), with the pivots of each taken
//! from its own diagonal block only, so that the plan holds for all values. Where that leaves no
//! usable pivot, one is made up, and iterative refinement removes the error; where refinement
//! fails, [`GeneralLu`] with free pivoting is the last resort.

mod dense;
mod elimination_tree;
mod factors;
mod front;
mod scaling;
mod supernodes;
mod symbolic;

use std::sync::Arc;

use igimp_assembly::{Pattern, TangentMatrix};

use super::refine::{Accuracy, probe, solve_refined};
use super::{GeneralLu, LinearSolver, LinearSolverError, SolveReport, check};
use factors::Factors;
use symbolic::Symbolic;

/// Largest system that [`GeneralLu`] is tried on: it needs ten times the memory and the time.
const FALLBACK_UNKNOWNS: usize = 50_000;

/// Growth of the entries beyond which a bad residual is blamed on the restricted choice of pivots
/// and not on the condition of the matrix, about which free pivoting could do nothing.
const SUSPICIOUS_GROWTH: f64 = 1e6;

/// Multifrontal LU for structurally symmetric patterns.
#[derive(Default)]
pub struct MultifrontalLu {
    accuracy: Accuracy,
    analyses: usize,
    symbolic: Option<Symbolic>,
    factors: Factors,
    matrix: Option<TangentMatrix>,
    factored: bool,
    /// Takes over from the own factors where there is one.
    fallback: Option<Box<GeneralLu>>,
}

impl MultifrontalLu {
    /// A solver with other demands on the residual than the default.
    pub fn with_accuracy(accuracy: Accuracy) -> Self {
        Self {
            accuracy,
            ..Self::default()
        }
    }

    /// Number of entries of the factors L and U of the pattern analysed last, zero before.
    pub fn factor_entries(&self) -> usize {
        self.symbolic.as_ref().map_or(0, |plan| plan.factor_len)
    }

    /// Number of floating-point operations of a factorisation of the pattern analysed last.
    pub fn factor_operations(&self) -> f64 {
        self.symbolic.as_ref().map_or(0.0, Symbolic::operations)
    }

    fn solve_factored(
        &mut self,
        rhs: &[f64],
        solution: &mut [f64],
    ) -> Result<SolveReport, LinearSolverError> {
        let (Some(symbolic), Some(matrix)) = (&self.symbolic, &self.matrix) else {
            return Err(LinearSolverError::NotFactored);
        };
        let factors = &mut self.factors;
        let refined = solve_refined(matrix, rhs, solution, &self.accuracy, |vector| {
            factors.solve(symbolic, vector);
        })?;
        Ok(SolveReport {
            perturbed_pivots: factors.record.replaced,
            pivot_growth: factors.record.largest.max(1.0),
            ..SolveReport::new(
                "multifrontal-lu",
                refined.relative_residual,
                refined.refinements,
            )
        })
    }

    /// Whether another choice of pivots may help against an error.
    fn blames_pivots(&self, error: &LinearSolverError) -> bool {
        let record = &self.factors.record;
        let what_is_wrong = match error {
            LinearSolverError::Inaccurate { .. } => true,
            LinearSolverError::NonFinite { what, .. } => *what == "solution",
            _ => false,
        };
        what_is_wrong && (record.replaced > 0 || record.largest > SUSPICIOUS_GROWTH)
    }

    /// Factorises the kept matrix with free pivoting, unless it is too large for that.
    fn fall_back(&mut self, cause: LinearSolverError) -> Result<(), LinearSolverError> {
        let small = |matrix: &&TangentMatrix| matrix.pattern.unknowns() <= FALLBACK_UNKNOWNS;
        let Some(matrix) = self.matrix.as_ref().filter(small) else {
            return Err(cause);
        };
        let mut general = GeneralLu::with_accuracy(self.accuracy);
        match (general.factor(matrix), cause) {
            (Ok(()), _) => {
                self.fallback = Some(Box::new(general));
                Ok(())
            }
            (
                Err(LinearSolverError::Singular { .. }),
                named @ LinearSolverError::Singular { .. },
            ) => Err(named),
            (Err(error), _) => Err(error),
        }
    }
}

impl LinearSolver for MultifrontalLu {
    fn name(&self) -> &'static str {
        "multifrontal-lu"
    }

    fn analyse(&mut self, pattern: &Arc<Pattern>) -> Result<(), LinearSolverError> {
        if check::same_pattern(self.symbolic.as_ref().map(|plan| &plan.pattern), pattern) {
            return Ok(());
        }
        self.factored = false;
        self.fallback = None;
        self.symbolic = None;
        self.symbolic = Some(Symbolic::new(pattern)?);
        self.analyses += 1;
        Ok(())
    }

    /// As for every solver; where a pivot had to be made up, a solve with a known right-hand side
    /// shows here and not later whether the matrix is singular.
    fn factor(&mut self, matrix: &TangentMatrix) -> Result<(), LinearSolverError> {
        self.analyse(&matrix.pattern)?;
        self.factored = false;
        self.fallback = None;
        check::valid_values(matrix)?;
        let symbolic = self
            .symbolic
            .as_ref()
            .ok_or(LinearSolverError::NotFactored)?;
        self.factors.compute(symbolic, matrix)?;
        check::keep(&mut self.matrix, matrix);
        if let Some(position) = self.factors.record.first_replaced {
            let suspect = Some(symbolic.order[position]);
            let unknowns = matrix.pattern.unknowns();
            let probed = probe(unknowns, suspect, |rhs, x| self.solve_factored(rhs, x));
            probed.or_else(|cause| self.fall_back(cause))?;
        }
        self.factored = true;
        Ok(())
    }

    fn solve(
        &mut self,
        rhs: &[f64],
        solution: &mut [f64],
    ) -> Result<SolveReport, LinearSolverError> {
        if !self.factored {
            return Err(LinearSolverError::NotFactored);
        }
        if self.fallback.is_none() {
            match self.solve_factored(rhs, solution) {
                Err(cause) if self.blames_pivots(&cause) => self.fall_back(cause)?,
                other => return other,
            }
        }
        match &mut self.fallback {
            Some(general) => general.solve(rhs, solution),
            None => Err(LinearSolverError::NotFactored),
        }
    }

    fn analyses(&self) -> usize {
        self.analyses
    }
}
