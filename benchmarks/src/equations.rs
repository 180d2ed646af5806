//! Linear equations as assembly makes them: tangent and out-of-balance force of a block.

use igimp_linear::{LinearSolver, LinearSolverError, MultifrontalLu, SolverKind, TangentMatrix};

use crate::BenchResult;
use crate::block::{Block, Soil};
use crate::pass::Pass;

/// A direct method, with the soil whose tangent it is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direct {
    /// Cholesky factorisation, von Mises soil.
    Cholesky,
    /// LU factorisation, Mohr–Coulomb soil.
    Lu,
}

impl Direct {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Cholesky, Self::Lu];

    /// Name in the bench's identifier.
    pub fn name(self) -> &'static str {
        match self {
            Self::Cholesky => "cholesky",
            Self::Lu => "lu",
        }
    }

    /// The soil whose tangent it factorises.
    pub fn soil(self) -> Soil {
        match self {
            Self::Cholesky => Soil::VonMises,
            Self::Lu => Soil::MohrCoulomb,
        }
    }

    /// A fresh solver.
    pub fn solver(self) -> Box<dyn LinearSolver> {
        match self {
            Self::Cholesky => SolverKind::MultifrontalCholesky.build(),
            Self::Lu => SolverKind::Multifrontal.build(),
        }
    }
}

/// A system of linear equations.
#[derive(Clone, Debug)]
pub struct Equations {
    /// The tangent.
    pub matrix: TangentMatrix,
    force: Vec<f64>,
}

impl Equations {
    /// The equations of a block with so many cells along a side.
    ///
    /// # Errors
    /// Only for a block without cells.
    pub fn new(soil: Soil, cells: usize) -> BenchResult<Self> {
        let block: Block<2> = Block::new(soil, cells)?;
        let stencils = block.stencils()?;
        let (matrix, force) = Pass::new(&block, &stencils)?.equations()?;
        Ok(Self { matrix, force })
    }

    /// Solves the equations with a solver that has factorised them.
    ///
    /// # Errors
    /// Those of [`LinearSolver::solve`].
    pub fn solve(
        &self,
        solver: &mut dyn LinearSolver,
        du: &mut Vec<f64>,
    ) -> Result<(), LinearSolverError> {
        du.resize(self.force.len(), 0.0);
        solver.solve(&self.matrix, &self.force, du).map(drop)
    }

    /// Floating-point operations of a factorisation on the nested dissection. A Cholesky
    /// factorisation does half of what an LU factorisation does.
    ///
    /// # Errors
    /// Never: the pattern is that of an assembled matrix.
    pub fn operations(&self, method: Direct) -> Result<f64, LinearSolverError> {
        let mut solver = MultifrontalLu::default();
        solver.analyse(&self.matrix.pattern)?;
        let operations = solver.factor_operations();
        Ok(match method {
            Direct::Cholesky => 0.5 * operations,
            Direct::Lu => operations,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_tangents_are_regular() {
        for method in Direct::ALL {
            let equations = Equations::new(method.soil(), 20).unwrap();
            let mut solver = method.solver();
            solver.factor(&equations.matrix).unwrap();
            let mut du = Vec::new();
            equations.solve(&mut *solver, &mut du).unwrap();
            let mut force = vec![0.0; du.len()];
            equations.matrix.multiply(&du, &mut force);
            let off = std::iter::zip(&force, &equations.force)
                .fold(0.0, |most: f64, (a, b)| most.max((a - b).abs()));
            let size = equations.force.iter().fold(0.0, |m: f64, f| m.max(f.abs()));
            assert!(off < 1e-9 * size, "{method:?}: {off} of {size}");
        }
    }

    #[test]
    fn operations_grow_with_the_power_three_halves() {
        let of = |cells| {
            let equations = Equations::new(Soil::VonMises, cells).unwrap();
            equations.operations(Direct::Lu).unwrap()
        };
        let exponent = (of(64) / of(32)).log2() / 2.0;
        assert!((1.4..1.7).contains(&exponent), "{exponent}");
    }
}
