//! A step at trial displacements: stress and internal force, and the tangent matrix.

use std::sync::Arc;

use igimp_linear::{Border, TangentMatrix};
use igimp_material::{MaterialError, TangentKind};

use super::{Reach, System};
use crate::equations::kinematics::ParticleTrial;
use crate::equations::residual::OutOfBalance;
use crate::equations::trial::Trial;
use crate::error::AssemblyError;
use crate::method::Kinematics;

impl<const D: usize> System<'_, D> {
    /// Stress and internal force at nodal step displacements `u` \[length\].
    ///
    /// # Errors
    /// As [`Self::evaluate_into`].
    pub fn evaluate(&self, u: &[[f64; D]], kind: TangentKind) -> Result<Trial<D>, AssemblyError> {
        let mut trial = Trial::default();
        self.evaluate_into(u, kind, &mut trial)?;
        Ok(trial)
    }

    /// Stress, internal force and the tangent matrix K = ∂f_int/∂u at nodal step displacements `u`
    /// \[length\].
    ///
    /// # Errors
    /// As [`Self::evaluate_into`].
    pub fn linearise(
        &self,
        u: &[[f64; D]],
        kind: TangentKind,
    ) -> Result<(Trial<D>, TangentMatrix), AssemblyError> {
        let mut trial = Trial::default();
        let mut matrix = self.matrix_from(None);
        self.linearise_into(u, kind, &mut trial, &mut matrix)?;
        Ok((trial, matrix))
    }

    /// Sets `trial` to nodal step displacements `u` \[length\]: stress and internal force.
    ///
    /// # Errors
    /// [`AssemblyError::Inverted`] or [`AssemblyError::Material`] of a particle that fails: of
    /// several always the same one; [`AssemblyError::Thrown`] of a rigid body. The trial is then of no use.
    pub fn evaluate_into(
        &self,
        u: &[[f64; D]],
        kind: TangentKind,
        trial: &mut Trial<D>,
    ) -> Result<(), AssemblyError> {
        self.holds_bodies_within(Reach::OF_CORRECTION, u)?;
        self.pass(u, kind, trial, None)?;
        for force in self.beside.forces() {
            force.add(u, &mut trial.f_int, None);
        }
        let inertia = self.inertia.as_ref();
        trial.inertia = inertia.map_or(0.0, |inertia| inertia.add(u, &mut trial.f_int, None));
        self.add_damping(u, &mut trial.f_int, None);
        Ok(())
    }

    /// Sets `trial` as [`Self::evaluate_into`] does and `matrix` to the tangent matrix, in the same
    /// pass over the particles.
    ///
    /// # Errors
    /// As [`Self::evaluate_into`].
    ///
    /// # Panics
    /// If the matrix has another pattern than this system.
    pub fn linearise_into(
        &self,
        u: &[[f64; D]],
        kind: TangentKind,
        trial: &mut Trial<D>,
        matrix: &mut TangentMatrix,
    ) -> Result<(), AssemblyError> {
        assert!(
            Arc::ptr_eq(&matrix.pattern, &self.pattern),
            "the matrix belongs to this step"
        );
        self.holds_bodies_within(Reach::OF_CORRECTION, u)?;
        matrix.symmetric = self.symmetric;
        self.pass(u, kind, trial, Some(&mut matrix.values))?;
        let of_grid = self.unknowns.of_grid();
        matrix.border = Border::zeros(self.unknowns.len() - of_grid, of_grid);
        let TangentMatrix { values, border, .. } = matrix;
        let mut add_block = |row: usize, column: usize, block: &[[f64; D]; D]| {
            let [row_node, column_node] = [row, column].map(|node| self.unknowns.block_node(node));
            for (b, column_unknown) in self.unknowns.of(column) {
                for (a, row_unknown) in self.unknowns.of(row) {
                    if row_unknown < of_grid && column_unknown < of_grid {
                        let (row, column) = (row_node, column_node);
                        let component = column_unknown - self.unknowns.before(column);
                        let rank = row_unknown - self.unknowns.before(row);
                        let place = self.table.value(&self.pattern, column, component, row);
                        values[place + rank] += block[a][b];
                    } else {
                        border.add(of_grid, row_unknown, column_unknown, block[a][b]);
                    }
                }
            }
        };
        for force in self.beside.forces() {
            force.add(u, &mut trial.f_int, Some(&mut add_block));
        }
        let inertia = self.inertia.as_ref();
        trial.inertia = inertia.map_or(0.0, |inertia| {
            inertia.add(u, &mut trial.f_int, Some(&mut add_block))
        });
        if let Some(inertia) = inertia {
            let place = |row, column, axis| self.place_of(row, column, axis);
            inertia.add_mass_of_soil(&mut matrix.values, &place);
        }
        self.add_damping(u, &mut trial.f_int, Some(&mut matrix.values));
        Ok(())
    }

    /// A matrix for [`Self::linearise_into`] in the memory of an earlier one: that one itself if its
    /// pattern still holds.
    pub fn matrix_from(&self, earlier: Option<TangentMatrix>) -> TangentMatrix {
        let mut values = earlier.map_or_else(Vec::new, |matrix| matrix.values);
        values.resize(self.pattern.stored(), 0.0);
        TangentMatrix {
            pattern: Arc::clone(&self.pattern),
            values,
            symmetric: self.symmetric,
            border: Border::default(),
        }
    }

    /// The out-of-balance force of a trial.
    ///
    /// # Errors
    /// [`AssemblyError::NonFinite`] when a nodal force is not finite.
    pub fn out_of_balance(&self, trial: &Trial<D>) -> Result<OutOfBalance, AssemblyError> {
        let mut residual = OutOfBalance::default();
        self.update_out_of_balance(&mut residual, trial)?;
        Ok(residual)
    }

    /// Rewrites the out-of-balance force with that of a trial.
    ///
    /// # Errors
    /// As [`Self::out_of_balance`].
    pub fn update_out_of_balance(
        &self,
        residual: &mut OutOfBalance,
        trial: &Trial<D>,
    ) -> Result<(), AssemblyError> {
        residual.update(&self.unknowns, &self.loads.f_ext, trial, self.round_off)
    }

    /// The first particle whose law answers a tangent that is not finite at nodal step
    /// displacements `u` \[length\], as an error that names it. A pass over all particles, for when
    /// a matrix was found not to be finite.
    ///
    /// # Errors
    /// [`AssemblyError::Material`]; those of [`Self::evaluate_into`].
    pub fn finite_tangents(&self, u: &[[f64; D]], kind: TangentKind) -> Result<(), AssemblyError> {
        let mut trial = ParticleTrial::at_rest();
        for particle in 0..self.particles.len() {
            let point = self.evaluate_particle(particle, u, kind, &mut trial)?;
            if !point.lifted.tangent().is_finite() {
                let quantity = "tangent";
                let source = MaterialError::NonFinite { quantity };
                return Err(AssemblyError::Material { particle, source });
            }
        }
        Ok(())
    }

    /// The volume that a particle's stress is multiplied by: V_0 with Kirchhoff stress in finite
    /// strain, V at the step's start with Cauchy stress in small strain.
    #[inline]
    pub(crate) fn reference_volume(&self, particle: usize) -> f64 {
        match self.method.kinematics {
            Kinematics::FiniteStrain => self.particles.volume0[particle],
            Kinematics::SmallStrain => self.particles.volume(particle),
        }
    }
}
