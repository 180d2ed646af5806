//! How PETSc solves a system: by factors of MUMPS, by smoothed aggregation, or as its options say.

use crate::foreign::{ForeignError, Solver, World};

/// Prefixes of the options that tune a method.
const MUMPS: &str = "mumps_";
const GAMG: &str = "gamg_";
/// Vectors that GMRES keeps.
const VECTORS: i32 = 60;
/// Options of smoothed aggregation that a user may replace: all couplings of nodes count, and the smoother keeps the blocks of
/// nodes and is the same for any order of the rows.
const OF_GAMG: [(&str, &str); 5] = [
    ("-gamg_pc_gamg_type", "agg"),
    ("-gamg_pc_gamg_threshold", "0"),
    ("-gamg_pc_gamg_agg_nsmooths", "1"),
    ("-gamg_mg_levels_ksp_type", "chebyshev"),
    ("-gamg_mg_levels_pc_type", "pbjacobi"),
];

/// A method.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Method {
    /// MUMPS for symmetric positive definite matrices.
    Cholesky,
    /// MUMPS for symmetric matrices, quasi-definite ones among them.
    Ldlt,
    /// MUMPS for all matrices.
    Lu,
    /// Conjugate gradients with smoothed aggregation.
    GamgSymmetric,
    /// Generalised minimal residuals with smoothed aggregation.
    Gamg,
    /// What the options of PETSc say, for a matrix that is not symmetric.
    Options,
    /// The same for a symmetric one.
    OptionsSymmetric,
}

impl Method {
    const ALL: [Self; 7] = [
        Self::Cholesky,
        Self::Ldlt,
        Self::Lu,
        Self::GamgSymmetric,
        Self::Gamg,
        Self::Options,
        Self::OptionsSymmetric,
    ];

    /// Its name in reports.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Cholesky => "petsc-mumps-llt",
            Self::Ldlt => "petsc-mumps-ldlt",
            Self::Lu => "petsc-mumps-lu",
            Self::GamgSymmetric => "petsc-gamg-cg",
            Self::Gamg => "petsc-gamg-gmres",
            Self::Options | Self::OptionsSymmetric => "petsc-options",
        }
    }

    /// Its number in commands.
    pub(crate) fn number(self) -> u64 {
        self as u64
    }

    /// The method of a number.
    pub(crate) fn of_number(number: u64) -> Self {
        Self::ALL[number as usize]
    }

    pub(crate) fn is_symmetric(self) -> bool {
        matches!(
            self,
            Self::Cholesky | Self::Ldlt | Self::GamgSymmetric | Self::OptionsSymmetric
        )
    }

    pub(crate) fn is_definite(self) -> bool {
        matches!(self, Self::Cholesky | Self::GamgSymmetric)
    }

    /// Whether it factorises.
    pub(crate) fn is_direct(self) -> bool {
        matches!(self, Self::Cholesky | Self::Ldlt | Self::Lu)
    }

    /// Whether it goes by the motions of a rigid body.
    pub(crate) fn wants_motions(self) -> bool {
        !self.is_direct()
    }

    /// Gives PETSc the options that a user did not.
    pub(crate) fn defaults(world: &World) -> Result<(), ForeignError> {
        for (name, value) in OF_GAMG {
            world.default_option(name, value)?;
        }
        Ok(())
    }

    /// A solver of this method.
    pub(crate) fn solver(self, world: &World) -> Result<Solver, ForeignError> {
        let (prefix, kind, by) = match self {
            Self::Cholesky | Self::Ldlt => (MUMPS, "preonly", "cholesky"),
            Self::Lu => (MUMPS, "preonly", "lu"),
            Self::GamgSymmetric => (GAMG, "cg", "gamg"),
            Self::Gamg => (GAMG, "gmres", "gamg"),
            Self::OptionsSymmetric | Self::Options => ("", "gmres", ""),
        };
        let mut solver = Solver::new(world, prefix, kind, by)?;
        if !self.is_direct() {
            solver.by_residual(VECTORS)?;
        }
        if matches!(self, Self::Gamg | Self::Options | Self::OptionsSymmetric) {
            solver.precondition_right()?;
        }
        Ok(solver)
    }

    /// Hands a solver that has its matrix the options; MUMPS a workspace of so many percent beyond its estimate (`ICNTL(14)`).
    pub(crate) fn prepare(self, solver: &mut Solver, workspace: u64) -> Result<(), ForeignError> {
        if self.is_direct() {
            solver.use_mumps(&[(14, workspace as i32)])?;
        }
        solver.take_options()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_name_methods() {
        for method in Method::ALL {
            assert_eq!(Method::of_number(method.number()), method);
        }
    }
}
