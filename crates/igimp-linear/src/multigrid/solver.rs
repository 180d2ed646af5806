//! Iteration with a geometric multigrid as preconditioner, for one matrix after the other.

use std::sync::Arc;

use super::super::{LinearSolverError, SolveReport, check};
use super::coupled::Coupled;
use super::cycle::Cycle;
use crate::krylov::preconditioned::{Demand, LinearSystem, Method, Preconditioned};
use crate::{Pattern, TangentMatrix};

/// Names of the methods: of soil, and of soil and water.
const NAMES: [&str; 2] = ["multigrid-cg", "multigrid-gmres"];
const COUPLED_NAMES: [&str; 2] = ["multigrid-coupled-gmres"; 2];

/// Grids and values of the matrix at hand.
#[derive(Default)]
pub(crate) struct Iteration {
    pattern: Option<Arc<Pattern>>,
    blocks: Option<Blocks>,
    preconditioned: Preconditioned,
}

/// The blocks of a matrix.
enum Blocks {
    Soil(Box<Cycle>),
    SoilAndWater(Box<Coupled>),
}

impl Blocks {
    fn new(pattern: &Arc<Pattern>) -> Result<Self, LinearSolverError> {
        Ok(if pattern.has_scalars() {
            Self::SoilAndWater(Box::new(Coupled::new(pattern)?))
        } else {
            Self::Soil(Box::new(Cycle::new(pattern)?))
        })
    }

    fn levels(&self) -> usize {
        match self {
            Self::Soil(cycle) => cycle.levels(),
            Self::SoilAndWater(coupled) => coupled.levels(),
        }
    }

    fn unknowns(&self) -> usize {
        match self {
            Self::Soil(cycle) => cycle.unknowns(),
            Self::SoilAndWater(coupled) => coupled.unknowns(),
        }
    }
}

impl Iteration {
    /// Makes the grids of a pattern, unless they are there. Whether there is more than one.
    pub(crate) fn analyse(&mut self, pattern: &Arc<Pattern>) -> Result<bool, LinearSolverError> {
        if !check::same_pattern(self.pattern.as_ref(), pattern) {
            self.blocks = None;
            self.blocks = Some(Blocks::new(pattern)?);
            self.pattern = Some(Arc::clone(pattern));
        }
        Ok(self
            .blocks
            .as_ref()
            .is_some_and(|blocks| blocks.levels() > 1))
    }

    /// Takes over the values of a matrix whose pattern was analysed.
    pub(crate) fn set(&mut self, matrix: &TangentMatrix, diagonal: &[f64]) {
        match &mut self.blocks {
            None => {}
            Some(Blocks::Soil(cycle)) => cycle.set(matrix, diagonal),
            Some(Blocks::SoilAndWater(coupled)) => coupled.set(matrix),
        }
    }

    /// Solves K x = b.
    pub(crate) fn solve(
        &mut self,
        matrix: &TangentMatrix,
        rhs: &[f64],
        solution: &mut [f64],
        demand: &Demand,
    ) -> Result<SolveReport, LinearSolverError> {
        let Some(blocks) = &mut self.blocks else {
            return Err(LinearSolverError::NotFactored);
        };
        check::length("the matrix", matrix.pattern.unknowns(), blocks.unknowns())?;
        let (by_gradients, names) = match blocks {
            Blocks::Soil(cycle) => (matrix.symmetric && !cycle.is_indefinite(), NAMES),
            Blocks::SoilAndWater(_) => (false, COUPLED_NAMES),
        };
        let method = Method {
            by_gradients,
            names,
        };
        let mut apply = |r: &[f64], z: &mut [f64]| match blocks {
            Blocks::Soil(cycle) => cycle.apply(matrix, r, z),
            Blocks::SoilAndWater(coupled) => coupled.apply(r, z),
        };
        let system = LinearSystem { matrix, rhs };
        (self.preconditioned).solve(system, solution, demand, method, &mut apply)
    }
}
