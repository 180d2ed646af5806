//! The one place where the state of particles changes: an accepted step (theory, eq. 10 with small
//! strain, eq. 15 with finite strain, eq. 29 for the domains).

use igimp_material::Tensor;
use igimp_shape::Grid;
use rayon::prelude::*;

use crate::body::particles::{CHUNK, ParticleFields, Particles, volume_ratio};
use crate::contributions::consolidation::PoresAfter;
use crate::contributions::inertia::Motion;
use crate::equations::kinematics::ParticleTrial;
use crate::equations::trial::Trial;
use crate::error::AssemblyError;
use crate::method::{DomainUpdate, Geometry, Kinematics, Method};
use crate::step::hoops::Hoop;
use crate::step::stencils::Stencils;
use igimp_rigid::RigidBody;
use igimp_shape::matrices::{congruence, determinant, identity, multiply, rotation, transpose};

impl<const D: usize> Particles<D> {
    /// Accepts a converged trial: x, F, b_e, σ, l_p and history become those at nodal step
    /// displacements `u` \[length\]. On a given geometry x, F and l_p stay.
    pub fn commit(
        &mut self,
        stencils: &Stencils<D>,
        method: &Method,
        trial: &Trial<D>,
        u: &[[f64; D]],
    ) {
        let mut slots = vec![0_u32; self.len()];
        for (slot, &particle) in stencils.order().iter().enumerate() {
            slots[particle as usize] = slot as u32;
        }
        let fields = self.fields_mut();
        let moving = (
            &mut fields.x,
            &mut fields.displacement,
            &mut fields.half_length,
            &fields.half_length0,
            &mut fields.def_grad,
            &mut fields.hoop_strain,
        );
        let stressed = (
            &mut fields.b_e,
            &mut fields.sigma,
            &mut fields.eps_p_eq,
            &mut fields.internal,
            &mut fields.regime,
            &mut fields.excess,
        );
        let particles = moving.into_par_iter().zip(stressed.into_par_iter());
        particles
            .zip(slots)
            .enumerate()
            .with_min_len(CHUNK)
            .for_each(|(particle, ((moving, stressed), slot))| {
                let (x, displacement, half_length, half_length0, def_grad, hoop_strain) = moving;
                let (b_e, sigma, eps_p_eq, internal, regime, excess) = stressed;
                let point = &trial.particles[slot as usize];
                let step = stencils.displacement(particle, u);
                for axis in 0..D {
                    displacement[axis] += step[axis];
                }
                match method.geometry {
                    Geometry::Moving => {
                        for axis in 0..D {
                            x[axis] += step[axis];
                        }
                        *def_grad = multiply(&point.delta_def_grad, def_grad);
                        let (supports, hoops) = stencils.with_hoops(particle);
                        if !hoops.is_empty() {
                            let strain = Hoop::strain(supports, hoops, u).value;
                            *hoop_strain = (1.0 + *hoop_strain) * (1.0 + strain) - 1.0;
                        }
                        let ratio = volume_ratio(def_grad, *hoop_strain);
                        let update = method.domain_update;
                        *half_length = updated_half_length(update, half_length0, def_grad);
                        (*b_e, *sigma) = stress_state(method.kinematics, point, ratio);
                    }
                    Geometry::Given => {
                        *b_e = point.b_e();
                        *sigma = match method.kinematics {
                            Kinematics::FiniteStrain => {
                                divided(&point.tau, volume_ratio(def_grad, *hoop_strain))
                            }
                            Kinematics::SmallStrain => point.tau,
                        };
                    }
                }
                *excess = match method.kinematics {
                    _ if point.excess == 0.0 => 0.0,
                    Kinematics::FiniteStrain => point.excess / volume_ratio(def_grad, *hoop_strain),
                    Kinematics::SmallStrain => point.excess,
                };
                (*eps_p_eq, *internal) = (point.history.eps_p_eq, point.history.internal);
                *regime = point.regime;
            });
    }

    /// Gives the particles of an accepted step the velocities and accelerations that its nodes end with.
    pub fn accelerate(&mut self, stencils: &Stencils<D>, motion: &Motion<D>) {
        let fields = self.fields_mut();
        let columns = (&mut fields.velocity, &mut fields.acceleration).into_par_iter();
        (columns.enumerate().with_min_len(CHUNK)).for_each(
            |(particle, (velocity, acceleration))| {
                *velocity = motion.of_particle(velocity, stencils.of(particle));
                *acceleration = interpolate(stencils, particle, &motion.acceleration);
            },
        );
    }

    /// Takes all motion from the particles, as before a step in statics.
    pub fn rest(&mut self) {
        let fields = self.fields_mut();
        fields.velocity.fill([0.0; D]);
        fields.acceleration.fill([0.0; D]);
    }

    /// The particles with velocities to begin with \[length/time\].
    ///
    /// # Errors
    /// [`AssemblyError::InvalidParticle`] for a velocity that is not finite.
    ///
    /// # Panics
    /// If there are more or fewer entries than particles.
    pub fn with_velocities(self, velocity: Vec<[f64; D]>) -> Result<Self, AssemblyError> {
        Self::from_fields(ParticleFields {
            velocity,
            ..(*self).clone()
        })
    }

    /// Moves particles that stand too close to rigid bodies, or within them, off these, as [`System::bodies_at`]
    /// does after a step: for bodies that are put where a side cuts the parts of cells that soil is seeded in.
    /// Nothing but their place changes. How many were moved.
    ///
    /// [`System::bodies_at`]: crate::System::bodies_at
    pub fn resolve_overlap(&mut self, bodies: &[RigidBody<D>]) -> usize {
        let ways = igimp_rigid::seeded_too_close(bodies, self.domains());
        self.push_out(&ways);
        ways.len()
    }

    /// Keeps what an accepted step leaves in the pores.
    pub fn fill_pores(&mut self, pores: &PoresAfter) {
        let fields = self.fields_mut();
        if pores.given.is_empty() {
            fields.pore_pressure.fill(0.0);
        } else {
            fields.pore_pressure.copy_from_slice(&pores.given);
        }
        for point in &pores.excess {
            fields.excess[point.particle] = point.excess;
            fields.excess_within_cell[point.particle] = point.within_cell;
            fields.water_rate[point.particle] = point.rate;
        }
    }

    /// Moves particles of an accepted step, such as those that stand too close to a rigid body; nothing
    /// but their place changes.
    pub fn push_out(&mut self, by: &[(usize, [f64; D])]) {
        let fields = self.fields_mut();
        for (particle, way) in by {
            for axis in 0..D {
                fields.x[*particle][axis] += way[axis];
                fields.displacement[*particle][axis] += way[axis];
            }
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
        (0..self.len())
            .into_par_iter()
            .with_min_len(CHUNK)
            .find_map_first(|particle| {
                let displacement = stencils.displacement(particle, u);
                let x: [f64; D] =
                    std::array::from_fn(|axis| self.x[particle][axis] + displacement[axis]);
                (!grid.contains(&x)).then_some((particle, x))
            })
    }
}

/// The mean of nodal values over a particle, Σ_i S_i a_i.
fn interpolate<const D: usize>(
    stencils: &Stencils<D>,
    particle: usize,
    nodal: &[[f64; D]],
) -> [f64; D] {
    let mut mean = [0.0; D];
    for support in stencils.of(particle) {
        for axis in 0..D {
            mean[axis] += support.value * nodal[support.node][axis];
        }
    }
    mean
}

/// b_e and σ of an accepted particle. In small strain both are rotated with the step.
fn stress_state<const D: usize>(
    kinematics: Kinematics,
    point: &ParticleTrial<D>,
    det_f: f64,
) -> (Tensor, Tensor) {
    match kinematics {
        Kinematics::FiniteStrain => (point.b_e(), divided(&point.tau, det_f)),
        Kinematics::SmallStrain => {
            let in_plane = rotation(&point.delta_def_grad);
            let mut turn = identity::<3>();
            for a in 0..D {
                turn[a][..D].copy_from_slice(&in_plane[a]);
            }
            (
                congruence(&turn, &point.b_e()),
                congruence(&turn, &point.tau),
            )
        }
    }
}

/// Cauchy stress of a Kirchhoff stress.
fn divided(tau: &Tensor, det_f: f64) -> Tensor {
    tau.map(|row| row.map(|component| component / det_f))
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
        DomainUpdate::Moments => return second_moments(half_length0, def_grad),
        DomainUpdate::ScaledMoments => {
            let lengths = second_moments(half_length0, def_grad);
            let volume = determinant(def_grad) * half_length0.iter().product::<f64>();
            let factor = (volume / lengths.iter().product::<f64>()).powf(1.0 / D as f64);
            return lengths.map(|length| factor * length);
        }
    };
    std::array::from_fn(|axis| half_length0[axis] * stretch[axis])
}

/// The half-lengths of the box along the axes that has the second moments of a deformed domain \[length\].
fn second_moments<const D: usize>(half_length0: &[f64; D], def_grad: &[[f64; D]; D]) -> [f64; D] {
    def_grad.map(|row| {
        let sides = std::iter::zip(row, half_length0);
        let squares = sides.map(|(f, side)| (f * side).powi(2));
        squares.sum::<f64>().sqrt()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// GOAL: the domain that has the second moments of a deformed one keeps its height where soil is sheared along a floor, turns with the
    /// soil, and follows a stretch along the axes.
    /// ORACLE: second moments of parallelograms by hand; the diagonal of U as the control, which grows across the shear.
    #[test]
    fn domains_have_the_second_moments_of_deformed_ones() {
        let sides = [2.0, 1.0];
        let moments = |f: [[f64; 2]; 2]| updated_half_length(DomainUpdate::Moments, &sides, &f);
        let near = |found: [f64; 2], exact: [f64; 2]| {
            assert!(
                std::iter::zip(found, exact).all(|(a, b)| (a - b).abs() < 1e-12),
                "{found:?}"
            );
        };
        let shear = [[1.0, 3.0], [0.0, 1.0]];
        near(moments(shear), [13.0_f64.sqrt(), 1.0]);
        near(moments([[0.0, -1.0], [1.0, 0.0]]), [1.0, 2.0]);
        near(moments([[0.5, 0.0], [0.0, -3.0]]), [1.0, 3.0]);
        let across = updated_half_length(DomainUpdate::DiagonalU, &sides, &shear)[1];
        assert!(across > 3.0, "{across}");
    }

    /// GOAL: a domain of scaled moments has the volume of the deformed one whatever its stretch, shear and turn; it follows a stretch
    /// along the axes, and is a square where soil is stretched halfway between them.
    /// ORACLE: volumes by det F; squares by symmetry; moments without the scale as the control, which are far too large there.
    #[test]
    fn scaled_domains_have_the_volume_of_deformed_ones() {
        let sides = [2.0, 1.0];
        let scaled = |f: [[f64; 2]; 2], sides: [f64; 2]| {
            updated_half_length(DomainUpdate::ScaledMoments, &sides, &f)
        };
        for f in [
            [[1.0, 3.0], [0.0, 1.0]],
            [[0.3, -1.2], [0.9, 0.4]],
            [[0.0, -1.0], [1.0, 0.0]],
        ] {
            let [a, b] = scaled(f, sides);
            assert!(
                (a * b - 2.0 * determinant(&f)).abs() < 1e-12,
                "{f:?}: {a}, {b}"
            );
        }
        let [a, b] = scaled([[5.0, 0.0], [0.0, 0.2]], sides);
        assert!((a - 10.0).abs() + (b - 0.2).abs() < 1e-12, "{a}, {b}");
        // Five times as long along a line of 45°.
        let slanting = [[2.6, 2.4], [2.4, 2.6]];
        let [a, b] = scaled(slanting, [1.0; 2]);
        assert!((a - 1.0).abs() + (b - 1.0).abs() < 1e-12, "{a}, {b}");
        let loose = updated_half_length(DomainUpdate::Moments, &[1.0; 2], &slanting)[0];
        assert!(loose > 3.0, "{loose}");
        let solid = [[2.0, 0.3, 0.0], [0.1, 0.5, 0.2], [0.0, -0.4, 1.5]];
        let box_of = updated_half_length(DomainUpdate::ScaledMoments, &[1.0, 2.0, 3.0], &solid);
        let volume: f64 = box_of.iter().product();
        assert!(
            (volume - 6.0 * determinant(&solid)).abs() < 1e-12,
            "{box_of:?}"
        );
    }
}
