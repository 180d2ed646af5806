//! Motion that is prescribed: of nodes by supports, of rigid bodies by their drives.

use igimp_material::TangentKind;

use super::System;
use crate::conditions::rigid_motion::Drive;
use crate::equations::kinematics::{Linearisation, ParticleTrial};
use crate::equations::linearised::Linearised;
use crate::error::AssemblyError;

impl<const D: usize> System<'_, D> {
    /// Whether any node or body is made to move.
    pub fn prescribes_motion(&self) -> bool {
        let moves = |drive: &Drive| matches!(drive, Drive::Moved(by) if *by != 0.0);
        self.conditions.constraints.prescribe_motion()
            || self.loads.motions.iter().flatten().any(moves)
    }

    /// Nodal step displacements that carry the prescribed motion and zeros elsewhere \[length\].
    pub fn prescribed_motion(&self) -> Vec<[f64; D]> {
        (0..self.node_count())
            .map(|node| std::array::from_fn(|axis| self.prescribed(node, axis).unwrap_or(0.0)))
            .collect()
    }

    /// The prescribed step displacement of a node along an axis \[length\], if any. The rotation of a body
    /// counts as the displacement at a distance of its size.
    pub(super) fn prescribed(&self, node: usize, axis: usize) -> Option<f64> {
        let of_grid = self.conditions.grid.node_count();
        let Some(beyond) = node.checked_sub(of_grid) else {
            return self.conditions.constraints.of(node, axis);
        };
        match self.loads.motions.get(beyond)?[axis] {
            Drive::Moved(by) => Some(by),
            Drive::Loaded(_) => None,
        }
    }

    /// The change of internal force K_fp u_p by unknown that the prescribed step displacements
    /// cause \[force\], with the tangent at nodal step displacements `u` \[length\]: the part of the first
    /// correction that is known (theory, eq. 25).
    ///
    /// # Errors
    /// As [`Self::evaluate_into`].
    pub fn force_of_prescribed_motion(
        &self,
        u: &[[f64; D]],
        kind: TangentKind,
    ) -> Result<Vec<f64>, AssemblyError> {
        let mut force = vec![0.0; self.unknowns.len()];
        let moves = |node: usize| {
            (0..D).any(|axis| {
                self.prescribed(node, axis)
                    .is_some_and(|value| value != 0.0)
            })
        };
        let mut trial = ParticleTrial::at_rest();
        let mut linearised = Linearised::default();
        for particle in 0..self.particles.len() {
            let (supports, hoops) = self.stencils.with_hoops(particle);
            if !supports.iter().any(|support| moves(support.node)) {
                continue;
            }
            let point = self.evaluate_particle(particle, u, kind, &mut trial)?;
            let volume = self.reference_volume(particle);
            linearised.push((supports, self.around((supports, hoops), u)), &point);
            self.add_scalars_of_motion(particle, (&point, &linearised), u, &mut force);
            let kinematics = self.method.kinematics_of_step();
            linearised.linearise_particle(&point, volume, kinematics);
            for (j, column) in supports.iter().enumerate() {
                if !moves(column.node) {
                    continue;
                }
                let columns = linearised.columns(j);
                for (i, row) in supports.iter().enumerate() {
                    for (a, unknown) in self.unknowns.of(row.node) {
                        for c in 0..D {
                            let value = self.prescribed(column.node, c).unwrap_or(0.0);
                            force[unknown] += columns[c][i * D + a] * value;
                        }
                    }
                }
            }
        }
        let mut add_block = |row: usize, column: usize, block: &[[f64; D]; D]| {
            for (a, unknown) in self.unknowns.of(row) {
                for (b, entry) in block[a].iter().enumerate() {
                    force[unknown] += entry * self.prescribed(column, b).unwrap_or(0.0);
                }
            }
        };
        let mut unused = vec![[0.0; D]; u.len()];
        for forces in self.beside.forces() {
            forces.add(u, &mut unused, Some(&mut add_block));
        }
        if let Some(inertia) = &self.inertia {
            inertia.add(u, &mut unused, Some(&mut add_block));
        }
        Ok(force)
    }

    /// Adds the effect of prescribed step displacements on the scalars of a particle, by unknown \[force\].
    fn add_scalars_of_motion(
        &self,
        particle: usize,
        (point, linearised): (&Linearisation<D>, &Linearised<D>),
        u: &[[f64; D]],
        force: &mut [f64],
    ) {
        let (supports, hoops) = self.stencils.with_hoops(particle);
        let moved = |node: usize, axis: usize| self.prescribed(node, axis).unwrap_or(0.0);
        let first = self.unknowns.first_scalar();
        let mut add = |place: usize, by: f64| {
            if let Some(unknown) = self.unknowns.index(first + place, 0) {
                force[unknown] += by;
            }
        };
        let water = &self.beside.consolidation;
        if let Some(water) = water.of_particle(particle, (supports, hoops), u) {
            water.add_force_of_motion(supports, &moved, &mut add);
        }
        if let Some(strain) = self.strain_of_particle(particle, point, u) {
            let gradients = (linearised.g(), linearised.g_bar());
            strain.add_force_of_motion(supports, gradients, &moved, &mut add);
        }
    }
}
