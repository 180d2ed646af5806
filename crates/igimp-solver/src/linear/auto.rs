//! The default: a direct method or an iteration, by what the matrix asks for.
//!
//! In the plane, and for small systems, a factorisation: Cholesky for symmetric matrices, LU for the others. In space its
//! operations grow with the square of the number of unknowns, those of an iteration with multigrid little more than with the
//! number itself; what the plan of elimination and the matrix tell decides. An iteration that does not converge
//! while it costs less than a factorisation is given up for one, if the factors fit into the memory that is allowed.

use std::sync::Arc;

use igimp_assembly::{Pattern, TangentMatrix};

use super::check::Inspection;
use super::multifrontal::Engine;
use super::multigrid::{Demand, Iteration};
use super::{Accuracy, LinearEffort, LinearSolver, LinearSolverError, Reason, SolveReport};

/// Cost of one iteration for each stored entry, in operations of a factorisation.
const ITERATION: f64 = 180.0;
/// Cost of setting up an iteration for each stored entry, in operations of a factorisation.
const SET_UP: f64 = 1200.0;
/// Iterations that a system is expected to take.
const EXPECTED: f64 = 60.0;
/// Iterations where there is no factorisation to fall back to.
const MOST: usize = 1500;
/// Iterations that are tried at least where one was asked for.
const TRIED: usize = 300;
/// Memory allowed for factors \[bytes\], unless told otherwise.
const FACTOR_BYTES: usize = 8 << 30;

/// Chooses between a multifrontal factorisation and an iteration with multigrid.
///
/// Near collapse a symmetric tangent can lose positive definiteness; the matrix then goes to LU. Both
/// share plan and memory. What is chosen depends on the matrix, and within a step on whether an iteration failed
/// before.
pub struct AutoSolver {
    engine: Engine,
    iteration: Iteration,
    inspection: Inspection,
    /// Whether iteration was asked for.
    by_iteration: bool,
    factor_bytes: usize,
    asked: f64,
    state: State,
    /// Why iteration was given up in this step.
    given_up: Option<Reason>,
    effort: LinearEffort,
}

/// What solves for the matrix at hand.
#[derive(Clone, Copy, PartialEq, Eq)]
enum State {
    Nothing,
    Factorised,
    /// So many iterations, and whether a factorisation may follow.
    Iterating(usize, bool),
}

impl Default for AutoSolver {
    fn default() -> Self {
        Self::with_accuracy(Accuracy::default())
    }
}

impl AutoSolver {
    /// A solver with other demands on the residual than the default.
    pub fn with_accuracy(accuracy: Accuracy) -> Self {
        Self {
            asked: accuracy.target,
            engine: Engine::with_accuracy(accuracy),
            iteration: Iteration::default(),
            inspection: Inspection::default(),
            by_iteration: false,
            factor_bytes: FACTOR_BYTES,
            state: State::Nothing,
            given_up: None,
            effort: LinearEffort::default(),
        }
    }

    /// The same that iterates wherever there is more than one grid, in the plane too.
    pub fn by_iteration() -> Self {
        Self {
            by_iteration: true,
            ..Self::default()
        }
    }

    /// The same with another limit for the memory of factors \[bytes\].
    #[must_use]
    pub fn with_factor_bytes(self, factor_bytes: usize) -> Self {
        Self {
            factor_bytes,
            ..self
        }
    }

    /// What to do with a matrix, and why.
    fn choose(&mut self, matrix: &TangentMatrix) -> Result<(State, Reason), LinearSolverError> {
        let pattern = &matrix.pattern;
        let unknowns = pattern.unknowns();
        let in_space = pattern.blocks.iter().any(|block| block.place[2] != 0);
        if !in_space && !self.by_iteration {
            return Ok((State::Factorised, Reason::Plane));
        }
        if !self.iteration.analyse(pattern)? {
            return Ok((State::Factorised, Reason::Small { unknowns }));
        }
        let (bytes, operations) = self.engine.cost(matrix.symmetric);
        let stored = pattern.stored() as f64;
        let iterations = ((operations - SET_UP * stored) / (ITERATION * stored)).max(0.0) as usize;
        let (factors, allowed) = (bytes, self.factor_bytes);
        if factors > allowed {
            let reason = Reason::Memory { factors, allowed };
            return Ok((State::Iterating(MOST, false), reason));
        }
        if let Some(reason) = &self.given_up {
            return Ok((State::Factorised, reason.clone()));
        }
        if self.by_iteration {
            return Ok((State::Iterating(iterations.max(TRIED), true), Reason::Asked));
        }
        Ok(if iterations as f64 > EXPECTED {
            let reason = Reason::IterationFaster {
                unknowns,
                iterations,
            };
            (State::Iterating(iterations, true), reason)
        } else {
            let reason = Reason::FactorisationFaster {
                unknowns,
                iterations,
            };
            (State::Factorised, reason)
        })
    }

    /// Factorises by what suits the matrix.
    fn factorise(&mut self, matrix: &TangentMatrix) -> Result<(), LinearSolverError> {
        self.state = State::Nothing;
        let factorised = if matrix.symmetric {
            match self.engine.factor_cholesky(matrix) {
                Err(LinearSolverError::NotPositiveDefinite { .. }) => self.engine.factor_lu(matrix),
                other => other,
            }
        } else {
            self.engine.factor_lu(matrix)
        };
        factorised?;
        self.state = State::Factorised;
        Ok(())
    }

    fn count(&mut self, report: &SolveReport) {
        self.effort.method = report.method;
        self.effort.solutions += 1;
        if matches!(self.state, State::Iterating(..)) {
            self.effort.iterations += report.refinements;
            self.effort.most_iterations = self.effort.most_iterations.max(report.refinements);
        }
    }
}

impl LinearSolver for AutoSolver {
    fn name(&self) -> &'static str {
        if self.by_iteration {
            "multigrid"
        } else {
            "auto"
        }
    }

    fn analyse(&mut self, pattern: &Arc<Pattern>) -> Result<(), LinearSolverError> {
        self.engine.analyse(pattern)
    }

    fn factor(&mut self, matrix: &TangentMatrix) -> Result<(), LinearSolverError> {
        self.state = State::Nothing;
        self.engine.analyse(&matrix.pattern)?;
        let (state, reason) = self.choose(matrix)?;
        self.effort.reason = reason;
        if state == State::Factorised {
            return self.factorise(matrix);
        }
        self.inspection.inspect(matrix)?;
        self.iteration.set(matrix, &self.inspection.diagonal);
        self.state = state;
        Ok(())
    }

    fn solve(
        &mut self,
        matrix: &TangentMatrix,
        rhs: &[f64],
        solution: &mut [f64],
    ) -> Result<SolveReport, LinearSolverError> {
        let (most, may_fall_back) = match self.state {
            State::Nothing => return Err(LinearSolverError::NotFactored),
            State::Factorised => {
                let report = self.engine.solve(matrix, rhs, solution)?;
                self.count(&report);
                return Ok(report);
            }
            State::Iterating(most, may_fall_back) => (most, may_fall_back),
        };
        let demand = Demand {
            target: self.asked,
            tolerance: self.engine.accuracy.tolerance,
            most,
        };
        match self.iteration.solve(matrix, rhs, solution, &demand) {
            Ok(report) => {
                self.count(&report);
                Ok(report)
            }
            Err(LinearSolverError::NotConverged { iterations, .. }) if may_fall_back => {
                self.effort.lost_iterations += iterations;
                self.effort.reason = Reason::NotConverged { iterations };
                self.given_up = Some(self.effort.reason.clone());
                self.factorise(matrix)?;
                let report = self.engine.solve(matrix, rhs, solution)?;
                self.count(&report);
                Ok(report)
            }
            Err(LinearSolverError::NotConverged {
                iterations,
                relative_residual,
                tolerance,
                ..
            }) => Err(LinearSolverError::NotConverged {
                iterations,
                relative_residual,
                tolerance,
                factor_bytes: self.engine.cost(matrix.symmetric).0,
            }),
            Err(other) => Err(other),
        }
    }

    fn analyses(&self) -> usize {
        self.engine.analyses
    }

    fn start_step(&mut self) {
        self.given_up = None;
        self.effort = LinearEffort::default();
    }

    fn ask_for(&mut self, relative_residual: f64) {
        self.asked = relative_residual.max(self.engine.accuracy.target);
    }

    fn effort(&self) -> LinearEffort {
        self.effort.clone()
    }
}
