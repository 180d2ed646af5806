//! A record of the input and the result of a solver, for those who want to look at a system.

use std::fmt;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use super::{LinearEffort, LinearSolver, LinearSolverError, SolveReport};
use crate::{Pattern, TangentMatrix};

/// A linear system K x = b with the solution that was found.
#[derive(Clone, Debug)]
pub struct SolvedSystem {
    /// Its number since the record was last taken, from 1.
    pub number: usize,
    /// K.
    pub matrix: TangentMatrix,
    /// b, the out-of-balance force, one entry per unknown \[force\].
    pub rhs: Vec<f64>,
    /// x, the correction found, one entry per unknown \[length\].
    pub solution: Vec<f64>,
}

/// Keeps one of the systems that a solver solves: the n-th since the record was last taken, or the
/// last one while there are fewer. Clones share the record.
#[derive(Clone)]
pub struct Record {
    wanted: usize,
    kept: Arc<Mutex<Option<SolvedSystem>>>,
}

impl Record {
    /// A record of the system with this number, from 1.
    pub fn of_system(number: usize) -> Self {
        Self {
            wanted: number,
            kept: Arc::default(),
        }
    }

    /// The solver, with its systems recorded here. Its solutions are the same to the bit.
    pub fn around(&self, solver: Box<dyn LinearSolver>) -> Box<dyn LinearSolver> {
        Box::new(Recorded {
            solver,
            record: self.clone(),
        })
    }

    /// The recorded system, if one was solved; the record begins anew.
    pub fn take(&self) -> Option<SolvedSystem> {
        self.kept().take()
    }

    /// Keeps a system if it is the one that is wanted, or comes before it.
    fn keep(&self, matrix: &TangentMatrix, rhs: &[f64], solution: &[f64]) {
        let mut kept = self.kept();
        let solved = number(kept.as_ref());
        if solved < self.wanted {
            *kept = Some(SolvedSystem {
                number: solved + 1,
                matrix: matrix.clone(),
                rhs: rhs.to_vec(),
                solution: solution.to_vec(),
            });
        }
    }

    /// The record is complete at any moment, also after a panic elsewhere.
    fn kept(&self) -> MutexGuard<'_, Option<SolvedSystem>> {
        self.kept.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl fmt::Debug for Record {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Record")
            .field("wanted", &self.wanted)
            .field("solved", &number(self.kept().as_ref()))
            .finish_non_exhaustive()
    }
}

/// A solver with a record.
struct Recorded {
    solver: Box<dyn LinearSolver>,
    record: Record,
}

impl LinearSolver for Recorded {
    fn name(&self) -> &'static str {
        self.solver.name()
    }

    fn analyse(&mut self, pattern: &Arc<Pattern>) -> Result<(), LinearSolverError> {
        self.solver.analyse(pattern)
    }

    fn factor(&mut self, matrix: &TangentMatrix) -> Result<(), LinearSolverError> {
        self.solver.factor(matrix)
    }

    fn solve(
        &mut self,
        matrix: &TangentMatrix,
        rhs: &[f64],
        solution: &mut [f64],
    ) -> Result<SolveReport, LinearSolverError> {
        let report = self.solver.solve(matrix, rhs, solution)?;
        self.record.keep(matrix, rhs, solution);
        Ok(report)
    }

    fn iterate(
        &mut self,
        matrix: &TangentMatrix,
        rhs: &[f64],
        solution: &mut [f64],
    ) -> Result<Option<SolveReport>, LinearSolverError> {
        let report = self.solver.iterate(matrix, rhs, solution)?;
        if report.is_some() {
            self.record.keep(matrix, rhs, solution);
        }
        Ok(report)
    }

    fn analyses(&self) -> usize {
        self.solver.analyses()
    }

    fn start_step(&mut self) {
        self.solver.start_step();
    }

    fn ask_for(&mut self, relative_residual: f64) {
        self.solver.ask_for(relative_residual);
    }

    fn effort(&self) -> LinearEffort {
        self.solver.effort()
    }
}

/// The number of a system that was kept, 0 without one.
fn number(kept: Option<&SolvedSystem>) -> usize {
    kept.map_or(0, |system| system.number)
}
