//! Water in the pores of soil: pressure that is given as a field, and pressure that soil itself makes where its
//! water cannot leave (theory, eqs. 51 to 54).
//!
//! Pore pressure u is positive in compression, as everywhere in soil mechanics; laws see effective stress
//! σ′ = σ + u I alone.
//!
//! Given water acts in two ways. A *reference* field, continuous and on the surface of the soil equal to the pressure
//! of the free water there, acts by its gradient on every particle: buoyancy and seepage, with the pressure of ponds on the
//! ground and without any surface. By how much the pressure in the pores differs from it acts as a stress.

use std::sync::Arc;

use rayon::prelude::*;

use crate::body::particles::{CHUNK, Particles};
use crate::conditions::StepConditions;
use crate::conditions::water::{PoreState, PoreWater};
use crate::error::AssemblyError;
use crate::method::{Kinematics, Method, Section};
use crate::step::stencils::Stencils;

/// Stress of pore water at a particle.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PoreResponse {
    /// Excess pore pressure at the start of the step, in the stress that the law speaks of \[force/length²\].
    pub(crate) excess: f64,
    /// Mean stress that given water adds, tension positive \[force/length²\].
    pub(crate) given: f64,
    /// K_w/n \[force/length²\].
    pub(crate) stiffness: f64,
    /// Excess pore pressure where it is an unknown, in that stress at the volume of the start \[force/length²\].
    pub(crate) unknown: Option<f64>,
}

impl PoreResponse {
    /// Whether soil is as if there were no water.
    #[inline]
    pub(crate) fn is_none(&self) -> bool {
        self.excess == 0.0 && self.given == 0.0 && self.stiffness == 0.0 && self.unknown.is_none()
    }

    /// Whether the change of volume enters.
    #[inline]
    pub(crate) fn asks_for_volume(&self) -> bool {
        self.stiffness != 0.0 || self.unknown.is_some()
    }

    /// Excess pore pressure after a step that stretched the volume by the factor exp(`ln_volume`), and how fast it falls with
    /// that logarithm \[force/length²\]. A pressure that is an unknown grows with the volume that it acts on, where that moves
    /// (theory, eq. 98).
    #[inline]
    pub(crate) fn excess_after(&self, ln_volume: f64, kinematics: Kinematics) -> (f64, f64) {
        match (self.unknown, kinematics) {
            (None, _) => (self.excess - self.stiffness * ln_volume, self.stiffness),
            (Some(unknown), Kinematics::SmallStrain) => (unknown, 0.0),
            (Some(unknown), Kinematics::FiniteStrain) => {
                let excess = unknown * ln_volume.exp();
                (excess, -excess)
            }
        }
    }
}

/// A given field at the particles of a step: it is asked once.
#[derive(Clone, Debug)]
pub(crate) struct Asked<const D: usize> {
    field: Arc<dyn PoreWater<D>>,
    states: Arc<[PoreState<D>]>,
}

impl<const D: usize> Asked<D> {
    /// The `earlier` answers at the same particles, if they are of this field; else it is asked.
    pub(crate) fn of(
        field: &Arc<dyn PoreWater<D>>,
        (particles, section): (&Particles<D>, Section),
        earlier: Option<&Self>,
    ) -> Self {
        if let Some(earlier) = earlier.filter(|asked| Arc::ptr_eq(&asked.field, field)) {
            return earlier.clone();
        }
        let at = |particle| field.at(particles.pore_site(particle, section));
        let all = (0..particles.len()).into_par_iter().with_min_len(CHUNK);
        Self {
            field: Arc::clone(field),
            states: all.map(at).collect(),
        }
    }
}

/// Given water at the particles of a step.
#[derive(Debug, Default)]
pub(crate) struct Pores {
    /// Pore pressure u by particle; empty: dry \[force/length²\].
    pub(crate) pressure: Vec<f64>,
    /// The mean stress that stands for the pressure beyond the reference, in the stress that laws speak of; empty: none
    /// \[force/length²\].
    stress: Vec<f64>,
    /// Mass of water by particle beyond that of the soil as seeded; empty: dry \[mass\].
    mass: Vec<f64>,
    /// K_w/n by particle, of the soil as it is at the start of the step; empty: zero \[force/length²\].
    stiffness: Vec<f64>,
}

impl Pores {
    /// Adds the forces of given water, as it was `asked` at the particles, to the nodal external force `f_ext` \[force\].
    ///
    /// # Errors
    /// [`AssemblyError::NonFinite`] for water that is not finite at a particle, [`AssemblyError::Material`] of a law that cannot be
    /// made.
    pub(crate) fn fill<const D: usize>(
        particles: &Particles<D>,
        stencils: &Stencils<D>,
        conditions: &StepConditions<D>,
        (method, asked): (&Method, Option<&Asked<D>>),
        f_ext: &mut [[f64; D]],
    ) -> Result<Self, AssemblyError> {
        let water = &conditions.water;
        let n = particles.len();
        let stiffness = if water.stiffness.is_empty() {
            Vec::new()
        } else {
            (0..n)
                .into_par_iter()
                .with_min_len(CHUNK)
                .map(|particle| {
                    let pore = water.stiffness.get(particles.law[particle]);
                    pore.map_or(Ok(0.0), |p| p.of(particles, particle, &conditions.laws))
                })
                .collect::<Result<_, _>>()?
        };
        let Some(Asked { states, .. }) = asked else {
            return Ok(Self {
                stiffness,
                ..Self::default()
            });
        };
        let gravity = &conditions.loads.gravity;
        let mut pores = Self {
            pressure: vec![0.0; n],
            stress: vec![0.0; n],
            mass: vec![0.0; n],
            stiffness,
        };
        for &particle in stencils.order() {
            let particle = particle as usize;
            let state = &states[particle];
            let volume0 = particles.volume0[particle];
            let stretch = particles.volume_ratio(particle);
            let density = state.added_density + (stretch - 1.0) * state.water_density;
            pores.mass[particle] = volume0 * density;
            let force: [f64; D] = std::array::from_fn(|axis| {
                let weight = density * gravity[axis];
                volume0 * (weight - stretch * water.factor * state.gradient[axis])
            });
            let difference = water.factor * (state.pressure - state.reference);
            if !(force.iter().all(|force| force.is_finite()) && difference.is_finite()) {
                let quantity = "given pore pressure at particle";
                return Err(AssemblyError::NonFinite {
                    quantity,
                    index: particle,
                });
            }
            for support in stencils.of(particle) {
                for axis in 0..D {
                    f_ext[support.node][axis] += support.value * force[axis];
                }
            }
            pores.pressure[particle] = water.factor * state.pressure;
            pores.stress[particle] = match method.kinematics {
                Kinematics::FiniteStrain => -stretch * difference,
                Kinematics::SmallStrain => -difference,
            };
        }
        if pores.stress.iter().all(|&stress| stress == 0.0) {
            pores.stress = Vec::new();
        }
        Ok(pores)
    }

    /// Mass of water in a particle beyond that of the soil as seeded \[mass\].
    pub(crate) fn mass(&self, particle: usize) -> f64 {
        self.mass.get(particle).copied().unwrap_or(0.0)
    }

    /// The stress of water at a particle.
    #[inline]
    pub(crate) fn response<const D: usize>(
        &self,
        particles: &Particles<D>,
        method: &Method,
        (particle, unknown): (usize, Option<f64>),
    ) -> PoreResponse {
        let at_volume = |pressure: f64| {
            if pressure != 0.0 && method.kinematics == Kinematics::FiniteStrain {
                pressure * particles.volume_ratio(particle)
            } else {
                pressure
            }
        };
        PoreResponse {
            excess: at_volume(particles.excess[particle]),
            given: self.stress.get(particle).copied().unwrap_or(0.0),
            stiffness: self.stiffness.get(particle).copied().unwrap_or(0.0),
            unknown: unknown.map(at_volume),
        }
    }
}
