//! The default: a direct method or an iteration, as the matrix demands.
//!
//! In the plane, and for small systems, a factorisation: Cholesky for symmetric matrices, LU for the others. In space its
//! operations grow with the square of the number of unknowns, those of an iteration with multigrid little more than with the
//! number itself; what the plan of elimination and the matrix tell decides. An iteration that does not converge
//! while it costs less than a factorisation is given up for one, if the factors fit into the memory that is allowed.

use std::sync::Arc;

use super::check::Inspection;
use super::multifrontal::Engine;
use super::multigrid::{Demand, Iteration};
use super::{
    Accuracy, Forecast, LinearEffort, LinearSolver, LinearSolverError, Reason, SolveReport,
};
use crate::{Pattern, TangentMatrix};

/// Cost of one iteration for each stored entry, in operations of a factorisation.
const ITERATION: f64 = 180.0;
/// Cost of setting up an iteration for each stored entry, in operations of a factorisation.
const SET_UP: f64 = 1200.0;
/// Iterations that a system is expected to take.
const EXPECTED: f64 = 60.0;
/// Iterations where there is no factorisation to fall back to.
const MOST: usize = 1500;
/// Share of the right-hand side that an iteration may leave where no factorisation can follow \[-\]: Newton's method then takes
/// more corrections, and its own residual decides (theory, eq. 25a).
const INEXACT: f64 = 0.1;
/// Iterations after which it may.
const PATIENCE: usize = 300;
/// Iterations that are tried at least where one was asked for.
const TRIED: usize = 300;
/// Memory allowed for factors where nobody knows the machine \[bytes\]: a choice. A run asks the machine instead.
pub(crate) const FACTOR_BYTES: usize = 8 << 30;

/// Chooses between a multifrontal factorisation and an iteration with multigrid.
///
/// Near collapse a symmetric tangent can lose positive definiteness; the matrix then goes to LU. Both
/// share plan and memory. The choice depends on the matrix, and within a step on whether an iteration failed
/// before.
pub struct AutoSolver {
    engine: Engine,
    iteration: Iteration,
    inspection: Inspection,
    /// Whether iteration was asked for.
    by_iteration: bool,
    /// Whether factors in single precision were asked for.
    in_single: bool,
    factor_bytes: usize,
    asked: f64,
    state: State,
    /// Why iteration was given up in this step.
    given_up: Option<Reason>,
    effort: LinearEffort,
}

/// The method for the matrix at hand.
#[derive(Clone, Copy, PartialEq, Eq)]
enum State {
    Nothing,
    Factorised,
    /// With factors in single precision.
    InSingle,
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
            in_single: false,
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

    /// The same that factorises in single precision and iterates with that; in double precision where it does not
    /// converge.
    pub fn in_single() -> Self {
        Self {
            in_single: true,
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

    /// The choice for the matrices of a pattern, before there is one, and the memory of their factors.
    ///
    /// # Errors
    /// As [`LinearSolver::analyse`].
    pub fn forecast(
        &mut self,
        pattern: &Arc<Pattern>,
        symmetric: bool,
    ) -> Result<Forecast, LinearSolverError> {
        self.engine.analyse(pattern)?;
        let (state, reason) = self.choose(pattern, symmetric)?;
        let (factor_bytes, operations) = self.engine.cost(symmetric);
        let fallback_bytes = match state {
            State::Iterating(_, true) if factor_bytes <= self.factor_bytes => factor_bytes,
            State::Iterating(_, true) => factor_bytes / 2,
            _ => 0,
        };
        Ok(Forecast {
            iterates: matches!(state, State::Iterating(..)),
            reason,
            factor_bytes,
            fallback_bytes,
            operations,
        })
    }

    /// The choice for a matrix of a pattern that was analysed, and the reason.
    fn choose(
        &mut self,
        pattern: &Arc<Pattern>,
        symmetric: bool,
    ) -> Result<(State, Reason), LinearSolverError> {
        let unknowns = pattern.unknowns();
        if self.in_single {
            return Ok(match &self.given_up {
                Some(reason) => (State::Factorised, reason.clone()),
                None => (State::InSingle, Reason::Asked),
            });
        }
        let in_space = pattern.blocks.iter().any(|block| block.place[2] != 0);
        if !in_space && !self.by_iteration {
            return Ok((State::Factorised, Reason::Plane));
        }
        if !self.iteration.analyse(pattern)? {
            return Ok((State::Factorised, Reason::Small { unknowns }));
        }
        let (bytes, operations) = self.engine.cost(symmetric);
        let stored = pattern.stored() as f64;
        let iterations = ((operations - SET_UP * stored) / (ITERATION * stored)).max(0.0) as usize;
        let (factors, allowed) = (bytes, self.factor_bytes);
        let fits_in_single = factors / 2 <= allowed;
        if let Some(reason) = &self.given_up {
            let in_single = factors > allowed && fits_in_single;
            if in_single {
                return Ok((State::InSingle, reason.clone()));
            } else if factors <= allowed {
                return Ok((State::Factorised, reason.clone()));
            }
        }
        if factors > allowed {
            let reason = Reason::Memory { factors, allowed };
            let most = if fits_in_single {
                iterations.clamp(TRIED, MOST)
            } else {
                MOST
            };
            return Ok((State::Iterating(most, fits_in_single), reason));
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

    /// Factorises after an iteration was given up: in double precision if the factors fit or those in single did not serve, else in
    /// single.
    fn factorise_instead(
        &mut self,
        matrix: &TangentMatrix,
        iterations: usize,
    ) -> Result<(), LinearSolverError> {
        let (factors, allowed) = (self.engine.cost(matrix.symmetric).0, self.factor_bytes);
        self.effort.lost_iterations += iterations;
        if self.state == State::InSingle {
            return self.without_single(matrix, iterations);
        }
        let in_single = factors > allowed;
        self.effort.reason = if in_single {
            Reason::OnlySingle {
                iterations,
                factors,
                allowed,
            }
        } else {
            Reason::NotConverged { iterations }
        };
        self.given_up = Some(self.effort.reason.clone());
        if in_single {
            self.engine.factor_single(matrix)?;
            self.state = State::InSingle;
            return Ok(());
        }
        self.factorise(matrix)
    }

    /// The demand on an iteration of at most so many steps; stricter where more is asked for than factors are held to.
    fn demand(&self, most: usize, may_fall_back: bool) -> Demand {
        let usual = self.engine.accuracy.tolerance;
        let (tolerance, patience) = if may_fall_back || self.asked < usual {
            (usual, most)
        } else {
            (INEXACT, PATIENCE)
        };
        Demand {
            target: self.asked,
            tolerance,
            patience,
            most,
        }
    }

    /// An error with the memory that factors would take, if an iteration did not converge that they have no room beside.
    fn without_room(&self, error: LinearSolverError, matrix: &TangentMatrix) -> LinearSolverError {
        match error {
            LinearSolverError::NotConverged {
                iterations,
                relative_residual,
                tolerance,
                ..
            } => LinearSolverError::NotConverged {
                iterations,
                relative_residual,
                tolerance,
                factor_bytes: Some(self.engine.cost(matrix.symmetric).0),
            },
            other => other,
        }
    }

    /// Factorises in double precision because single does not serve.
    fn without_single(
        &mut self,
        matrix: &TangentMatrix,
        iterations: usize,
    ) -> Result<(), LinearSolverError> {
        self.effort.reason = Reason::SingleFailed { iterations };
        self.given_up = Some(self.effort.reason.clone());
        self.engine.forget_single();
        self.factorise(matrix)
    }

    /// Factorises by the method that suits the matrix.
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
        if matches!(self.state, State::Iterating(..) | State::InSingle) {
            self.effort.iterations += report.refinements;
            self.effort.most_iterations = self.effort.most_iterations.max(report.refinements);
        }
    }
}

impl LinearSolver for AutoSolver {
    fn name(&self) -> &'static str {
        if self.in_single {
            "single"
        } else if self.by_iteration {
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
        let (state, reason) = self.choose(&matrix.pattern, matrix.symmetric)?;
        self.effort.reason = reason;
        if state == State::Factorised {
            return self.factorise(matrix);
        }
        if state == State::InSingle {
            match self.engine.factor_single(matrix) {
                Err(LinearSolverError::NotPositiveDefinite { .. }) if self.in_single => {
                    return self.without_single(matrix, 0);
                }
                other => other?,
            }
            self.state = state;
            return Ok(());
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
        if let Some(report) = self.iterate(matrix, rhs, solution)? {
            return Ok(report);
        }
        let report = self.engine.solve(matrix, rhs, solution)?;
        self.count(&report);
        Ok(report)
    }

    fn iterate(
        &mut self,
        matrix: &TangentMatrix,
        rhs: &[f64],
        solution: &mut [f64],
    ) -> Result<Option<SolveReport>, LinearSolverError> {
        loop {
            let (found, may_fall_back) = match self.state {
                State::Nothing => return Err(LinearSolverError::NotFactored),
                State::Factorised => return Ok(None),
                State::InSingle => {
                    let engine = &mut self.engine;
                    let found = engine.solve_single(matrix, rhs, solution, self.asked);
                    (found, self.in_single)
                }
                State::Iterating(most, may_fall_back) => {
                    let demand = self.demand(most, may_fall_back);
                    let found = self.iteration.solve(matrix, rhs, solution, &demand);
                    (found, may_fall_back)
                }
            };
            match found {
                Ok(report) => {
                    self.count(&report);
                    return Ok(Some(report));
                }
                Err(LinearSolverError::NotConverged { iterations, .. }) if may_fall_back => {
                    self.factorise_instead(matrix, iterations)?;
                }
                Err(error) => return Err(self.without_room(error, matrix)),
            }
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
        self.engine.ask_for(relative_residual);
    }

    fn effort(&self) -> LinearEffort {
        self.effort.clone()
    }
}
