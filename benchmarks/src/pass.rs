//! One step's system of a block: what is set up once, and what every Newton iteration repeats.

use std::mem::size_of;

use igimp_assembly::{AssemblyError, ParticleTrial, Stencils, System, Trial};
use igimp_linear::TangentMatrix;
use igimp_material::{History, TangentKind, Tensor};
use igimp_shape::Support;

use crate::BenchResult;
use crate::block::Block;

/// The system of a block at its trial displacement, with a matrix to write into.
#[derive(Debug)]
pub struct Pass<'a, const D: usize> {
    block: &'a Block<D>,
    stencils: &'a Stencils<D>,
    system: System<'a, D>,
    trial: Trial<D>,
    matrix: TangentMatrix,
}

impl<'a, const D: usize> Pass<'a, D> {
    /// The system of a block, evaluated once.
    ///
    /// # Errors
    /// Never: a block has one law, free nodes, and a trial displacement that all particles bear.
    pub fn new(block: &'a Block<D>, stencils: &'a Stencils<D>) -> Result<Self, AssemblyError> {
        Self::with_tangent(block, stencils, TangentKind::Consistent)
    }

    /// The same with another tangent in the matrix.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn with_tangent(
        block: &'a Block<D>,
        stencils: &'a Stencils<D>,
        kind: TangentKind,
    ) -> Result<Self, AssemblyError> {
        let system = block.system(stencils)?;
        let (trial, matrix) = system.linearise(&block.u, kind)?;
        Ok(Self {
            block,
            stencils,
            system,
            trial,
            matrix,
        })
    }

    /// What a step does once: stencils, unknowns and pattern.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn set_up(block: &Block<D>) -> Result<(), AssemblyError> {
        let stencils = block.stencils()?;
        block.system(&stencils).map(drop)
    }

    /// What follows the last correction of a step: stress and internal force.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn evaluate(&mut self) -> Result<(), AssemblyError> {
        let kind = TangentKind::Consistent;
        self.system
            .evaluate_into(&self.block.u, kind, &mut self.trial)
    }

    /// An iteration: stress, internal force and the tangent matrix in one pass.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn linearise(&mut self) -> Result<(), AssemblyError> {
        let kind = TangentKind::Consistent;
        self.system
            .linearise_into(&self.block.u, kind, &mut self.trial, &mut self.matrix)
    }

    /// The bytes that an iteration cannot do without: every array of the step read or written once,
    /// the values of the matrix both. Nodal arrays stay in the caches and do not count.
    pub fn bytes(&self) -> usize {
        let supports: usize = (0..self.block.len())
            .map(|particle| self.stencils.of(particle).len())
            .sum();
        let of_particle = size_of::<Tensor>() // elastic left Cauchy–Green tensor
            + size_of::<History>()
            + size_of::<f64>() // volume
            + size_of::<usize>() // law
            + size_of::<ParticleTrial<D>>();
        supports * size_of::<Support<D>>()
            + self.block.len() * of_particle
            + 2 * self.matrix.values.len() * size_of::<f64>()
    }

    /// Entries that a particle adds to the matrix on average: the square of its nodes times
    /// directions.
    pub fn entries_per_particle(&self) -> f64 {
        let entries = |particle| (D * self.stencils.of(particle).len()).pow(2);
        let all: usize = (0..self.block.len()).map(entries).sum();
        all as f64 / self.block.len() as f64
    }

    /// The tangent matrix and the out-of-balance force of the trial.
    ///
    /// # Errors
    /// Never: all nodal forces are finite.
    pub fn equations(self) -> BenchResult<(TangentMatrix, Vec<f64>)> {
        let force = self.system.out_of_balance(&self.trial)?.force;
        Ok((self.matrix, force))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::block::Soil;

    #[test]
    fn an_iteration_repeats_itself() {
        let block: Block<2> = Block::new(Soil::MohrCoulomb, 8).unwrap();
        Pass::set_up(&block).unwrap();
        let stencils = block.stencils().unwrap();
        let mut pass = Pass::new(&block, &stencils).unwrap();
        let before = pass.matrix.values.clone();
        pass.matrix.values.fill(0.0);
        pass.linearise().unwrap();
        assert_eq!(pass.matrix.values, before);
    }

    #[test]
    fn an_iteration_moves_at_least_its_matrix_and_its_supports() {
        let block: Block<2> = Block::new(Soil::VonMises, 8).unwrap();
        let stencils = block.stencils().unwrap();
        let pass = Pass::new(&block, &stencils).unwrap();
        let least = 16 * pass.matrix.pattern.stored() + 4 * 48 * block.len();
        assert!(pass.bytes() > least);
        assert!(pass.bytes() < 4 * least);
    }
}
