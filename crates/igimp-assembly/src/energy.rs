//! The energy of a step that takes time: where the work of loads goes (theory, eqs. 64 to 66).

use igimp_material::{MaterialError, Tensor, logarithmic_strain};
use rayon::prelude::*;

use crate::body::particles::CHUNK;
use crate::contributions::inertia::Motion;
use crate::contributions::nodal_forces::NodalForces;
use crate::contributions::nodal_mass::product;
use crate::equations::kinematics::{Gradients, ParticleTrial};
use crate::equations::system::System;
use crate::equations::trial::Trial;
use crate::error::AssemblyError;
use crate::method::Kinematics;
use igimp_shape::matrices::determinant;

/// The energy of a step \[force·length\]. Work of loads and of supports comes in; the other terms are where it goes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StepEnergy {
    /// Kinetic energy of particles and rigid bodies at the end of the step.
    pub kinetic: f64,
    /// Its increase.
    pub kinetic_gain: f64,
    /// Elastic energy of the soil at the end of the step, the excess pore pressure included.
    pub elastic: f64,
    /// Its increase.
    pub elastic_gain: f64,
    /// Plastic work, of the stress at the end of the step.
    pub plastic: f64,
    /// Work on contact with rigid bodies: friction, and energy of the penalty.
    pub contact: f64,
    /// Work on reinforcement.
    pub reinforcement: f64,
    /// Work of gravity, loads and forces on rigid bodies, and of −M a in the frame of ground that moves.
    pub loads: f64,
    /// Work of the supports.
    pub supports: f64,
    /// Work against dashpots and springs of walls, less that of the forces which they carry.
    pub boundaries: f64,
    /// Work against the pressure of given water beyond its reference.
    pub water: f64,
    /// Work against damping of soil, drag and ghost penalty.
    pub damping: f64,
    /// Kinetic energy that the scheme of time integration takes.
    pub scheme: f64,
    /// Kinetic energy that the map between particles and grid takes.
    pub map: f64,
    /// Work of stress that is neither elastic nor plastic: the error of integration along the step.
    pub integration: f64,
    /// Work of the out-of-balance force that is left.
    pub unbalanced: f64,
}

impl StepEnergy {
    /// Input less all that it goes into: round-off.
    pub fn imbalance(&self) -> f64 {
        let gone = self.kinetic_gain
            + self.elastic_gain
            + self.plastic
            + self.contact
            + self.reinforcement
            + self.water
            + self.damping
            + self.boundaries
            + self.scheme
            + self.map
            + self.integration;
        self.loads + self.supports - self.unbalanced - gone
    }
}

/// The energy of one particle in a step.
#[derive(Clone, Copy, Debug, Default)]
struct ParticleEnergy {
    kinetic_before: f64,
    kinetic: f64,
    elastic_before: f64,
    elastic: f64,
    plastic: f64,
    water: f64,
}

impl<const D: usize> System<'_, D> {
    /// The energy of a step by nodal displacements `u` \[length\] that leads to `trial`; none in statics.
    ///
    /// # Errors
    /// [`AssemblyError::Material`] of a particle whose elastic strain cannot be found.
    pub fn energy(
        &self,
        trial: &Trial<D>,
        u: &[[f64; D]],
    ) -> Result<Option<StepEnergy>, AssemblyError> {
        let Some(inertia) = &self.inertia else {
            return Ok(None);
        };
        let motion = inertia.motion(u);
        let parts = self.energy_of_particles(trial, u, &motion)?;
        let sum = |part: fn(&ParticleEnergy) -> f64| parts.iter().map(part).sum::<f64>();
        // Of the work of a force, the weight of that at the end.
        let theta = inertia.step().scheme.weights().sum;
        let still = vec![[0.0; D]; u.len()];
        let work_of = |forces: &dyn NodalForces<D>, at: &[[f64; D]]| {
            let mut force = vec![[0.0; D]; at.len()];
            forces.add(at, &mut force, None);
            product(&force, u)
        };
        let [ghost, drag, contact, reinforcement, .., turning] = (self.beside.forces())
            .map(|forces| theta * work_of(forces, u) + (1.0 - theta) * work_of(forces, &still));
        let ground = self.work_of_ground(inertia, u);
        let mut energy = StepEnergy {
            kinetic: sum(|part| part.kinetic),
            elastic: sum(|part| part.elastic),
            plastic: sum(|part| part.plastic),
            water: sum(|part| part.water),
            contact,
            reinforcement,
            damping: ghost + drag + ground.damping,
            boundaries: ground.boundaries,
            loads: product(self.f_ext(), u) - turning - ground.carried,
            supports: product(&self.reactions(trial), u),
            unbalanced: theta * self.work_out_of_balance(trial, u),
            ..StepEnergy::default()
        };
        energy.elastic_gain = energy.elastic - sum(|part| part.elastic_before);
        // Of particles, and of the grid that takes their motion over for the step.
        let Motion { before, after, .. } = &motion;
        let gained = inertia.gained(&motion, u);
        let duration = inertia.step().duration;
        let centred = inertia.of_centres(u);
        let accelerating = product(&gained, &centred) / duration;
        energy.integration = energy.loads + energy.supports
            - energy.unbalanced
            - accelerating
            - (energy.elastic_gain + energy.plastic + energy.water)
            - (contact + reinforcement + energy.damping + energy.boundaries);
        let of_grid = |v: &[[f64; D]]| 0.5 * product(&inertia.times(v), v);
        // Energy that bodies gain by their turn.
        let turned = |a: &[[f64; D]], b: &[[f64; D]]| 0.5 * inertia.turned_product([a, b], u);
        let of_bodies = |v: &[[f64; D]]| {
            let mut v = v.to_vec();
            v[..self.conditions().grid.node_count()].fill([0.0; D]);
            of_grid(&v)
        };
        let kinetic_before = sum(|part| part.kinetic_before) + of_bodies(before);
        energy.kinetic += of_bodies(after) + turned(after, after);
        energy.kinetic_gain = energy.kinetic - kinetic_before;
        energy.map = kinetic_before
            - of_grid(before)
            - (energy.kinetic - of_grid(after) - turned(after, after));
        let mean: Vec<[f64; D]> = std::iter::zip(&*centred, std::iter::zip(after, before))
            .map(|(u, (after, before))| {
                std::array::from_fn(|a| u[a] / duration - 0.5 * (after[a] + before[a]))
            })
            .collect();
        energy.scheme = product(&gained, &mean) + turned(before, after);
        Ok(Some(energy))
    }

    /// The work of the out-of-balance force where displacement is unknown \[force·length\].
    fn work_out_of_balance(&self, trial: &Trial<D>, u: &[[f64; D]]) -> f64 {
        let mut work = 0.0;
        for (node, u) in u.iter().enumerate() {
            for axis in 0..D {
                if self.unknowns.index(node, axis).is_some() {
                    work += (self.f_ext()[node][axis] - trial.f_int[node][axis]) * u[axis];
                }
            }
        }
        work
    }

    /// By particle, in the order of slots.
    fn energy_of_particles(
        &self,
        trial: &Trial<D>,
        u: &[[f64; D]],
        motion: &Motion<D>,
    ) -> Result<Vec<ParticleEnergy>, AssemblyError> {
        let order = self.stencils.order();
        (0..order.len())
            .into_par_iter()
            .with_min_len(CHUNK)
            .map(|slot| {
                let particle = order[slot] as usize;
                self.energy_of_particle(&trial.particles[slot], particle, u, motion)
                    .map_err(|source| AssemblyError::Material { particle, source })
            })
            .collect()
    }

    fn energy_of_particle(
        &self,
        end: &ParticleTrial<D>,
        particle: usize,
        u: &[[f64; D]],
        motion: &Motion<D>,
    ) -> Result<ParticleEnergy, MaterialError> {
        let particles = self.particles;
        let supports = self.stencils.of(particle);
        let stretch = match self.method.kinematics {
            Kinematics::FiniteStrain => particles.volume_ratio(particle),
            Kinematics::SmallStrain => 1.0,
        };
        let volume = self.reference_volume(particle);
        let strain = logarithmic_strain(&particles.b_e[particle])?;
        let before = stretch * contracted(&particles.sigma[particle], &strain);
        let principal = std::array::from_fn::<f64, 3, _>(|k| {
            (0..3)
                .map(|a| {
                    end.frame[k][a] * (0..3).map(|b| end.tau[a][b] * end.frame[k][b]).sum::<f64>()
                })
                .sum()
        });
        let dot = |strain: &[f64; 3]| (0..3).map(|k| principal[k] * strain[k]).sum::<f64>();
        let pores = &self.loads.pores;
        let response = pores.response(particles, self.method, (particle, None));
        let stored = |excess: f64| match response.stiffness {
            0.0 => 0.0,
            stiffness => excess * excess / stiffness,
        };
        let dilation = || {
            let gradients = Gradients::of(self.stencils.with_hoops(particle), u);
            let mut mean = gradients.bar;
            for (a, row) in mean.iter_mut().enumerate() {
                row[a] += 1.0;
            }
            let around = gradients.hoop.map_or(1.0, |hoop| 1.0 + hoop.bar);
            (determinant(&mean) * around).ln()
        };
        let mass = particles.mass[particle] + self.loads.pores.mass(particle);
        let kinetic = |v: &[f64; D]| 0.5 * mass * v.iter().map(|v| v * v).sum::<f64>();
        Ok(ParticleEnergy {
            kinetic_before: kinetic(&particles.velocity[particle]),
            kinetic: kinetic(&motion.of_particle(&particles.velocity[particle], supports)),
            elastic_before: 0.5 * volume * (before + stored(response.excess)),
            elastic: 0.5 * volume * (dot(&end.eps_e) + stored(end.excess)),
            plastic: volume * dot(&end.delta_eps_p),
            water: match response.given {
                0.0 => 0.0,
                given => volume * given * dilation(),
            },
        })
    }
}

/// The double contraction a : b.
pub(crate) fn contracted(a: &Tensor, b: &Tensor) -> f64 {
    let pairs = std::iter::zip(a.as_flattened(), b.as_flattened());
    pairs.map(|(a, b)| a * b).sum()
}
