//! Factors in single precision: half of the memory, and a preconditioner instead of an inverse (theory, eq. 25c).

use super::super::refine::max_norm;
use super::super::{LinearSolverError, SolveReport};
use super::cholesky::{Cholesky, CholeskyFactors};
use super::factors::Factors;
use super::lu::{Lu, LuFactors};
use super::scratch::Scratch;
use super::substitution::Vectors;
use super::tree::plan::Plan;
use crate::krylov::preconditioned::{Demand, LinearSystem, Method, Preconditioned};

/// Largest number of iterations: more would say that the factors are of no use.
const MOST: usize = 60;

/// Names of the methods.
const NAMES: [&str; 2] = ["single-cg", "single-gmres"];

/// Factors in single precision, and the memory to make them and to use them.
#[derive(Default)]
pub(super) struct Single {
    factors: Factors<f32>,
    scratch: Scratch<f32>,
    vectors: Vectors<f32>,
    preconditioned: Preconditioned,
}

impl Single {
    /// The relative residual that is aimed at, and the one that a solution may have that is handed out \[-\].
    pub(super) fn demand(target: f64, tolerance: f64) -> Demand {
        Demand {
            target,
            tolerance,
            patience: MOST,
            most: MOST,
        }
    }

    /// Factorises by Cholesky.
    pub(super) fn factor_cholesky(
        &mut self,
        plan: &Plan,
        kernel: &Cholesky,
    ) -> Result<(), LinearSolverError> {
        self.factors.compute(plan, kernel, &self.scratch)
    }

    /// Factorises by LU. A pivot that was lost and replaced spoils the preconditioner a little, which shows in the
    /// iterations.
    pub(super) fn factor_lu(&mut self, plan: &Plan, kernel: &Lu) -> Result<(), LinearSolverError> {
        self.factors.compute(plan, kernel, &self.scratch)
    }

    /// Solves K x = b by an iteration with the factors; `scale` is the diagonal of S where S K S was factorised by LU.
    pub(super) fn solve(
        &mut self,
        plan: &Plan,
        scale: Option<&[f64]>,
        system: LinearSystem<'_>,
        solution: &mut [f64],
        demand: &Demand,
    ) -> Result<SolveReport, LinearSolverError> {
        let Self {
            factors,
            scratch,
            vectors,
            preconditioned,
        } = self;
        let mut failure = Ok(());
        let mut apply = |r: &[f64], z: &mut [f64]| {
            // Of a size that single precision has room for around it.
            let size = max_norm(r);
            let size = if size > 0.0 { size } else { 1.0 };
            for (z, r) in z.iter_mut().zip(r) {
                *z = r / size;
            }
            let solved = if scale.is_some() {
                vectors.solve::<LuFactors>(plan, factors, scale, scratch, z)
            } else {
                vectors.solve::<CholeskyFactors>(plan, factors, None, scratch, z)
            };
            failure = std::mem::replace(&mut failure, Ok(())).and(solved);
            for z in z {
                *z *= size;
            }
        };
        let method = Method {
            by_gradients: system.matrix.symmetric && !system.matrix.pattern.has_scalars(),
            names: NAMES,
        };
        let report = preconditioned.solve(system, solution, demand, method, &mut apply);
        failure?;
        let report = report?;
        Ok(SolveReport {
            perturbed_pivots: factors.record.replaced,
            pivot_growth: factors.record.largest.max(1.0),
            ..report
        })
    }
}
