//! The one place where the state of particles changes: an accepted step.

use igimp_material::Tensor;
use igimp_shape::Grid;

use crate::kinematics::ParticleTrial;
use crate::method::{DomainUpdate, Kinematics, Method};
use crate::particles::Particles;
use crate::small::{congruence, determinant, identity, multiply, rotation, transpose};
use crate::stencils::Stencils;
use crate::system::Trial;

impl<const D: usize> Particles<D> {
    /// Accepts a converged trial: x, F, b_e, σ, l_p and history become those at nodal step
    /// displacements `u` \[length\].
    pub fn commit(
        &mut self,
        stencils: &Stencils<D>,
        method: &Method,
        trial: Trial<D>,
        u: &[[f64; D]],
    ) {
        for (particle, own) in trial.particles.into_iter().enumerate() {
            let displacement = interpolate(stencils, particle, u);
            let fields = self.fields_mut();
            let def_grad = multiply(&own.delta_def_grad, &fields.def_grad[particle]);
            let (b_e, sigma) = stress_state(method.kinematics, &own, determinant(&def_grad));
            let half_length0 = &fields.half_length0[particle];
            fields.half_length[particle] =
                updated_half_length(method.domain_update, half_length0, &def_grad);
            for axis in 0..D {
                fields.x[particle][axis] += displacement[axis];
                fields.displacement[particle][axis] += displacement[axis];
            }
            fields.def_grad[particle] = def_grad;
            fields.b_e[particle] = b_e;
            fields.sigma[particle] = sigma;
            fields.history[particle] = own.lifted.history;
            fields.regime[particle] = own.lifted.regime;
        }
    }

    /// The first particle that nodal step displacements `u` would carry off the grid, with its
    /// new position \[length\].
    pub fn leaving(
        &self,
        grid: &Grid<D>,
        stencils: &Stencils<D>,
        u: &[[f64; D]],
    ) -> Option<(usize, [f64; D])> {
        (0..self.len()).find_map(|particle| {
            let displacement = interpolate(stencils, particle, u);
            let x: [f64; D] =
                std::array::from_fn(|axis| self.x[particle][axis] + displacement[axis]);
            (!grid.contains(&x)).then_some((particle, x))
        })
    }
}

/// The displacement of a particle, Σ_i S_i u_i.
fn interpolate<const D: usize>(
    stencils: &Stencils<D>,
    particle: usize,
    u: &[[f64; D]],
) -> [f64; D] {
    let mut displacement = [0.0; D];
    for support in stencils.of(particle) {
        for axis in 0..D {
            displacement[axis] += support.value * u[support.node][axis];
        }
    }
    displacement
}

/// b_e and σ of an accepted particle. In small strain both are rotated with the step.
fn stress_state<const D: usize>(
    kinematics: Kinematics,
    own: &ParticleTrial<D>,
    det_f: f64,
) -> (Tensor, Tensor) {
    match kinematics {
        Kinematics::FiniteStrain => (
            own.lifted.b_e(),
            own.lifted
                .tau
                .map(|row| row.map(|component| component / det_f)),
        ),
        Kinematics::SmallStrain => {
            let in_plane = rotation(&own.delta_def_grad);
            let mut turn = identity::<3>();
            for a in 0..D {
                turn[a][..D].copy_from_slice(&in_plane[a]);
            }
            (
                congruence(&turn, &own.lifted.b_e()),
                congruence(&turn, &own.lifted.tau),
            )
        }
    }
}

/// Half-lengths after the deformation F \[length\].
fn updated_half_length<const D: usize>(
    update: DomainUpdate,
    half_length0: &[f64; D],
    def_grad: &[[f64; D]; D],
) -> [f64; D] {
    let stretch: [f64; D] = match update {
        DomainUpdate::Fixed => [1.0; D],
        DomainUpdate::DiagonalF => std::array::from_fn(|axis| def_grad[axis][axis].abs()),
        DomainUpdate::DiagonalU => {
            let right_stretch = multiply(&transpose(&rotation(def_grad)), def_grad);
            std::array::from_fn(|axis| right_stretch[axis][axis])
        }
        DomainUpdate::RootJ => [determinant(def_grad).powf(1.0 / D as f64); D],
    };
    std::array::from_fn(|axis| half_length0[axis] * stretch[axis])
}
