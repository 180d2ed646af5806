//! The whole of a multifrontal solver: plan, factors, solution, and what to do when pivots fail.

use std::sync::Arc;

use super::super::check::{self, Inspection};
use super::super::refine::{Accuracy, Refinement, probe};
use super::super::{GeneralLu, LinearSolver, LinearSolverError, SolveReport};
use super::cholesky::{Cholesky, CholeskyFactors};
use super::factors::Factors;
use super::kernel::Kernel;
use super::lu::{Lu, LuFactors};
use super::scaling::Scaling;
use super::scratch::Scratch;
use super::single::Single;
use super::substitution::Vectors;
use super::tree::plan::Plan;
use crate::krylov::preconditioned::LinearSystem;
use crate::{Pattern, TangentMatrix};

/// Largest system that [`GeneralLu`] is tried on: it needs ten times the memory and the time.
const FALLBACK_UNKNOWNS: usize = 50_000;

/// Growth of the entries beyond which a bad residual is blamed on the restricted choice of pivots
/// and not on the condition of the matrix, about which free pivoting could do nothing.
const SUSPICIOUS_GROWTH: f64 = 1e6;

/// Relative residual beyond which a solution is refined in any case \[-\]: one pass more costs little beside
/// the factorisation, and Newton's method does not have to come back for its error.
const REFINED: f64 = 1e-9;

/// Plan and factors of one matrix after the other.
#[derive(Default)]
pub(crate) struct Engine {
    pub(crate) accuracy: Accuracy,
    /// The relative residual that was asked for \[-\]; the target of `accuracy` where nobody has asked.
    asked: Option<f64>,
    pub(crate) analyses: usize,
    pub(super) plan: Option<Plan>,
    factors: Factors<f64>,
    scaling: Scaling,
    inspection: Inspection,
    scratch: Scratch<f64>,
    vectors: Vectors<f64>,
    refinement: Refinement,
    /// Takes the place of the factors in double precision while it is used.
    single: Box<Single>,
    factored: Option<Factorisation>,
}

/// The factorisation that is stored.
enum Factorisation {
    Cholesky,
    Lu,
    /// In single precision: Cholesky, or LU.
    Single {
        by_cholesky: bool,
    },
    /// Takes over from the own factors where they fail.
    General(Box<GeneralLu>),
}

impl Engine {
    pub(crate) fn with_accuracy(accuracy: Accuracy) -> Self {
        Self {
            accuracy,
            ..Self::default()
        }
    }

    /// Asks the next solutions for a relative residual. They are refined to that, at least to [`REFINED`], and
    /// never beyond the target of the accuracy.
    pub(crate) fn ask_for(&mut self, relative_residual: f64) {
        self.asked = Some(relative_residual);
    }

    /// How well solutions with factors must hold.
    fn wanted(&self) -> Accuracy {
        let finest = self.accuracy.target;
        Accuracy {
            target: (self.asked).map_or(finest, |asked| asked.min(REFINED).max(finest)),
            ..self.accuracy
        }
    }

    /// Makes a plan, unless there is one that holds for the pattern.
    pub(crate) fn analyse(&mut self, pattern: &Arc<Pattern>) -> Result<(), LinearSolverError> {
        if let Some(plan) = &mut self.plan {
            if check::same_pattern(Some(&plan.pattern), pattern) {
                return Ok(());
            }
            self.factored = None;
            if plan.adopt(pattern)? {
                return Ok(());
            }
        }
        self.plan = None;
        self.plan = Some(Plan::new(pattern)?);
        self.analyses += 1;
        Ok(())
    }

    /// Entries of the factors of the pattern analysed last, zero before.
    pub(super) fn entries<K: Kernel<f64>>(&self) -> usize {
        let tasks = self.plan.iter().flat_map(|plan| &plan.tasks);
        tasks.map(|task| K::entries(&task.total)).sum()
    }

    /// Bytes of factors and contributions of the pattern analysed last, by Cholesky where it is `symmetric` and
    /// by LU otherwise, and the operations that they take.
    pub(crate) fn cost(&self, symmetric: bool) -> (usize, f64) {
        let Some(plan) = &self.plan else {
            return (0, 0.0);
        };
        let (entries, shape, share) = if symmetric {
            (
                self.entries::<Cholesky>(),
                <Cholesky as Kernel<f64>>::SHAPE,
                0.5,
            )
        } else {
            (self.entries::<Lu>(), <Lu as Kernel<f64>>::SHAPE, 1.0)
        };
        let contributions = plan.contribution_entries(shape);
        (8 * (entries + contributions), share * plan.operations())
    }

    /// Prepares a factorisation: nothing is factorised until it succeeds.
    fn prepare(&mut self, matrix: &TangentMatrix) -> Result<(), LinearSolverError> {
        self.analyse(&matrix.pattern)?;
        self.factored = None;
        self.inspection.inspect(matrix)
    }

    /// Factorises in single precision, by Cholesky where the matrix is symmetric. The memory of factors in double
    /// precision is given back.
    pub(crate) fn factor_single(
        &mut self,
        matrix: &TangentMatrix,
    ) -> Result<(), LinearSolverError> {
        self.prepare(matrix)?;
        (self.factors, self.scratch) = Default::default();
        let plan = self.plan.as_ref().ok_or(LinearSolverError::NotFactored)?;
        let by_cholesky = matrix.symmetric;
        if by_cholesky {
            let diagonal = &self.inspection.diagonal;
            (self.single).factor_cholesky(plan, &Cholesky { matrix, diagonal })?;
        } else {
            self.scaling.fit(matrix, &self.inspection.diagonal);
            let scale = &self.scaling.scale;
            self.single.factor_lu(plan, &Lu { matrix, scale })?;
        }
        self.factored = Some(Factorisation::Single { by_cholesky });
        Ok(())
    }

    /// Gives back the memory of factors in single precision.
    pub(crate) fn forget_single(&mut self) {
        *self.single = Single::default();
    }

    /// Solves with factors in single precision to a relative residual, in the Euclidean norm.
    pub(crate) fn solve_single(
        &mut self,
        matrix: &TangentMatrix,
        rhs: &[f64],
        solution: &mut [f64],
        target: f64,
    ) -> Result<SolveReport, LinearSolverError> {
        let (Some(plan), Some(Factorisation::Single { by_cholesky })) =
            (&self.plan, &self.factored)
        else {
            return Err(LinearSolverError::NotFactored);
        };
        check::length("the matrix", matrix.pattern.unknowns(), plan.unknowns())?;
        let scale = (!by_cholesky).then_some(&self.scaling.scale[..]);
        let demand = Single::demand(target, self.accuracy.tolerance);
        let system = LinearSystem { matrix, rhs };
        (self.single).solve(plan, scale, system, solution, &demand)
    }

    /// Factorises a symmetric matrix, positive definite, or quasi-definite with pore pressures among its unknowns.
    pub(crate) fn factor_cholesky(
        &mut self,
        matrix: &TangentMatrix,
    ) -> Result<(), LinearSolverError> {
        self.prepare(matrix)?;
        let plan = self.plan.as_ref().ok_or(LinearSolverError::NotFactored)?;
        let kernel = Cholesky {
            matrix,
            diagonal: &self.inspection.diagonal,
        };
        self.factors.compute(plan, &kernel, &self.scratch)?;
        self.factored = Some(Factorisation::Cholesky);
        Ok(())
    }

    /// Factorises a matrix by LU; where a pivot had to be made up, a solve with a known right-hand
    /// side shows here and not later whether the matrix is singular.
    pub(crate) fn factor_lu(&mut self, matrix: &TangentMatrix) -> Result<(), LinearSolverError> {
        self.prepare(matrix)?;
        self.scaling.fit(matrix, &self.inspection.diagonal);
        let plan = self.plan.as_ref().ok_or(LinearSolverError::NotFactored)?;
        let kernel = Lu {
            matrix,
            scale: &self.scaling.scale,
        };
        self.factors.compute(plan, &kernel, &self.scratch)?;
        let suspect = self
            .factors
            .record
            .first_replaced
            .map(|position| plan.unknown_at(position));
        self.factored = Some(Factorisation::Lu);
        if suspect.is_some() {
            let unknowns = matrix.pattern.unknowns();
            let probed = probe(unknowns, suspect, |rhs, x| self.substitute(matrix, rhs, x));
            if let Err(cause) = probed {
                self.factored = None;
                self.fall_back(matrix, cause)?;
            }
        }
        Ok(())
    }

    /// Solves for the matrix factorised last.
    pub(crate) fn solve(
        &mut self,
        matrix: &TangentMatrix,
        rhs: &[f64],
        solution: &mut [f64],
    ) -> Result<SolveReport, LinearSolverError> {
        if let (Some(plan), Some(_)) = (&self.plan, &self.factored) {
            let unknowns = matrix.pattern.unknowns();
            check::length("the matrix", unknowns, plan.unknowns())?;
        }
        match &mut self.factored {
            None | Some(Factorisation::Single { .. }) => {
                return Err(LinearSolverError::NotFactored);
            }
            Some(Factorisation::General(general)) => return general.solve(matrix, rhs, solution),
            Some(Factorisation::Cholesky | Factorisation::Lu) => {}
        }
        let mut found = self.substitute(matrix, rhs, solution);
        if self.has_signs() && matches!(found, Err(LinearSolverError::Inaccurate { .. })) {
            self.factor_lu(matrix)?;
            found = self.substitute(matrix, rhs, solution);
        }
        match found {
            Err(cause) if self.blames_pivots(&cause) => self.fall_back(matrix, cause)?,
            other => return other,
        }
        match &mut self.factored {
            Some(Factorisation::General(general)) => general.solve(matrix, rhs, solution),
            _ => Err(LinearSolverError::NotFactored),
        }
    }

    /// Whether the factors are symmetric with pivots of both signs, in an order that growth may make inaccurate.
    fn has_signs(&self) -> bool {
        let plan = self.plan.as_ref();
        matches!(self.factored, Some(Factorisation::Cholesky))
            && plan.is_some_and(|plan| plan.pattern.has_scalars())
    }

    /// Solves with the factors.
    fn substitute(
        &mut self,
        matrix: &TangentMatrix,
        rhs: &[f64],
        solution: &mut [f64],
    ) -> Result<SolveReport, LinearSolverError> {
        let accuracy = self.wanted();
        let has_signs = self.has_signs();
        let plan = self.plan.as_ref().ok_or(LinearSolverError::NotFactored)?;
        let (factors, scratch) = (&self.factors, &self.scratch);
        let (vectors, scale) = (&mut self.vectors, &self.scaling.scale[..]);
        let by_cholesky = matches!(self.factored, Some(Factorisation::Cholesky));
        let mut failure = Ok(());
        let refined = self
            .refinement
            .solve(matrix, rhs, solution, &accuracy, |vector| {
                let solved = if by_cholesky {
                    vectors.solve::<CholeskyFactors>(plan, factors, None, scratch, vector)
                } else {
                    vectors.solve::<LuFactors>(plan, factors, Some(scale), scratch, vector)
                };
                failure = std::mem::replace(&mut failure, Ok(())).and(solved);
            });
        failure?;
        let refined = refined?;
        let (residual, refinements) = (refined.relative_residual, refined.refinements);
        if by_cholesky {
            let name = ["multifrontal-llt", "multifrontal-ldlt"][usize::from(has_signs)];
            return Ok(SolveReport::new(name, residual, refinements));
        }
        Ok(SolveReport {
            perturbed_pivots: factors.record.replaced,
            pivot_growth: factors.record.largest.max(1.0),
            ..SolveReport::new("multifrontal-lu", residual, refinements)
        })
    }

    /// Whether another choice of pivots may help against an error.
    fn blames_pivots(&self, error: &LinearSolverError) -> bool {
        let record = &self.factors.record;
        let is_wrong = match error {
            LinearSolverError::Inaccurate { .. } => true,
            LinearSolverError::NonFinite { array, .. } => *array == "solution",
            _ => false,
        };
        is_wrong && (record.replaced > 0 || record.largest > SUSPICIOUS_GROWTH)
    }

    /// Factorises the matrix with free pivoting, unless it is too large for that.
    fn fall_back(
        &mut self,
        matrix: &TangentMatrix,
        cause: LinearSolverError,
    ) -> Result<(), LinearSolverError> {
        if matrix.pattern.unknowns() > FALLBACK_UNKNOWNS {
            return Err(cause);
        }
        let mut general = GeneralLu::with_accuracy(self.wanted());
        match (general.factor(matrix), cause) {
            (Ok(()), _) => {
                self.factored = Some(Factorisation::General(Box::new(general)));
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
