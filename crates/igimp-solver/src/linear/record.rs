//! A record of what a solver is given and what it finds, for those who want to look at a system.

use std::fmt;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use igimp_assembly::{Pattern, TangentMatrix};

use super::{LinearSolver, LinearSolverError, SolveReport};

/// A linear system K x = b with the solution that was found.
#[derive(Clone, Debug)]
pub struct SolvedSystem {
    /// Its number since the record was last taken, from 1.
    pub number: usize,
    /// K.
    pub matrix: TangentMatrix,
    /// b, one entry per unknown.
    pub rhs: Vec<f64>,
    /// x, one entry per unknown.
    pub solution: Vec<f64>,
}

/// Keeps one of the systems that a solver solves: the n-th since the record was last taken, or the
/// last one while there are fewer. Clones share what is kept.
#[derive(Clone)]
pub struct Record {
    wanted: usize,
    kept: Arc<Mutex<Kept>>,
}

#[derive(Default)]
struct Kept {
    /// The matrix that was factorised last, if its system is to be kept.
    matrix: Option<TangentMatrix>,
    system: Option<SolvedSystem>,
}

impl Kept {
    fn count(&self) -> usize {
        self.system.as_ref().map_or(0, |system| system.number)
    }
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

    /// What was kept, if any system was solved; the record begins anew.
    pub fn take(&self) -> Option<SolvedSystem> {
        std::mem::take(&mut *self.kept()).system
    }

    /// What is kept is whole at any moment, also after a panic elsewhere.
    fn kept(&self) -> MutexGuard<'_, Kept> {
        self.kept.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl fmt::Debug for Record {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Record")
            .field("wanted", &self.wanted)
            .field("solved", &self.kept().count())
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
        let result = self.solver.factor(matrix);
        let mut kept = self.record.kept();
        let is_wanted = result.is_ok() && kept.count() < self.record.wanted;
        kept.matrix = is_wanted.then(|| matrix.clone());
        result
    }

    fn solve(
        &mut self,
        rhs: &[f64],
        solution: &mut [f64],
    ) -> Result<SolveReport, LinearSolverError> {
        let report = self.solver.solve(rhs, solution)?;
        let mut kept = self.record.kept();
        if let Some(matrix) = kept.matrix.take() {
            kept.system = Some(SolvedSystem {
                number: kept.count() + 1,
                matrix,
                rhs: rhs.to_vec(),
                solution: solution.to_vec(),
            });
        }
        Ok(report)
    }

    fn analyses(&self) -> usize {
        self.solver.analyses()
    }
}
