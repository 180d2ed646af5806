//! Water in the pores of soil: pressure that is given as a field, and pressure that soil itself makes where its
//! water cannot leave (theory, eqs. 51 to 54).
//!
//! Pore pressure u is positive in compression, as everywhere in soil mechanics; laws see effective stress
//! σ′ = σ + u I alone.
//!
//! What is given acts in two ways. A *reference* field, continuous and on the surface of the soil equal to the pressure
//! of the free water there, acts by its gradient on every particle: buoyancy and seepage, with the pressure of ponds on the
//! ground and without any surface. By how much the pressure in the pores differs from it acts as a stress.

use std::fmt::Debug;
use std::sync::Arc;

use rayon::prelude::*;

use crate::body::particles::Particles;
use crate::error::AssemblyError;
use crate::method::{Kinematics, Method};
use crate::small::determinant;
use crate::step::stencils::Stencils;
use crate::step::step_conditions::StepConditions;
use crate::step::supports::CHUNK;

/// What given water is at a particle, at full gravity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PoreState<const D: usize> {
    /// Mean pore pressure u over the domain; zero where the law is one of total stress \[force/length²\].
    pub pressure: f64,
    /// Mean of the reference pressure over the domain \[force/length²\].
    pub reference: f64,
    /// Mean gradient of the reference pressure over the domain \[force/length³\].
    pub gradient: [f64; D],
    /// By how much the water in the pores raises the density as seeded \[mass/length³\].
    pub added_density: f64,
    /// Density of the water that a change of volume takes in or gives off: that of water in full pores, zero in others
    /// \[mass/length³\].
    pub water_density: f64,
}

impl<const D: usize> PoreState<D> {
    /// No water.
    pub fn dry() -> Self {
        Self {
            pressure: 0.0,
            reference: 0.0,
            gradient: [0.0; D],
            added_density: 0.0,
            water_density: 0.0,
        }
    }
}

/// A particle that asks for its water.
#[derive(Clone, Copy, Debug)]
pub struct PoreSite<'a, const D: usize> {
    /// Its [`number`](crate::ParticleFields::number).
    pub number: usize,
    /// Index of its law.
    pub law: usize,
    /// Centre of its domain \[length\].
    pub x: &'a [f64; D],
    /// Half-lengths of its domain \[length\].
    pub half_length: &'a [f64; D],
    /// Its volume as seeded over that of its domain as seeded, which stretching does not change: less than 1 where the surface cuts the domain \[-\].
    pub filled: f64,
}

impl<const D: usize> Particles<D> {
    /// How a particle asks for its water.
    ///
    /// # Panics
    /// If there is no such particle.
    #[inline]
    pub fn pore_site(&self, particle: usize) -> PoreSite<'_, D> {
        let domain0: f64 = (self.half_length0[particle].iter())
            .map(|half_length| 2.0 * half_length)
            .product();
        PoreSite {
            number: self.number[particle],
            law: self.law[particle],
            x: &self.x[particle],
            half_length: &self.half_length[particle],
            filled: self.volume0[particle] / domain0,
        }
    }
}

/// Given water. Pure: the same particle at the same place finds the same.
pub trait PoreWater<const D: usize>: Debug + Send + Sync {
    /// What water is in the domain of a particle.
    fn at(&self, site: PoreSite<'_, D>) -> PoreState<D>;
}

/// The water of a step.
#[derive(Clone, Debug)]
pub struct Water<const D: usize> {
    /// The given field; none: dry.
    pub given: Option<Arc<dyn PoreWater<D>>>,
    /// Factor on its pressure, the multiple of gravity \[-\].
    pub factor: f64,
    /// Bulk modulus of the water over the porosity, K_w/n, by law; zero or absent where water leaves as it likes
    /// \[force/length²\].
    pub stiffness: Vec<f64>,
}

impl<const D: usize> Default for Water<D> {
    /// Dry.
    fn default() -> Self {
        Self {
            given: None,
            factor: 0.0,
            stiffness: Vec::new(),
        }
    }
}

impl<const D: usize> Water<D> {
    /// K_w/n of a particle \[force/length²\].
    #[inline]
    pub(crate) fn stiffness_of(&self, particles: &Particles<D>, particle: usize) -> f64 {
        let own = self.stiffness.get(particles.law[particle]);
        own.map_or(0.0, |own| own * particles.ratios[particle].stiffness)
    }

    /// Refuses numbers that are not finite.
    pub(crate) fn is_finite(&self) -> Result<(), AssemblyError> {
        if !self.factor.is_finite() {
            let what = "factor on pore pressure";
            return Err(AssemblyError::NonFinite { what, index: 0 });
        }
        let bad = |own: &f64| !(own.is_finite() && *own >= 0.0);
        match self.stiffness.iter().position(bad) {
            Some(index) => {
                let what = "bulk modulus of pore water";
                Err(AssemblyError::NonFinite { what, index })
            }
            None => Ok(()),
        }
    }
}

/// What pore water adds to the stress of a particle.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PoreResponse {
    /// Excess pore pressure at the start of the step, in the stress that the law speaks of \[force/length²\].
    pub(crate) excess: f64,
    /// Mean stress that given water adds, tension positive \[force/length²\].
    pub(crate) given: f64,
    /// K_w/n \[force/length²\].
    pub(crate) stiffness: f64,
}

impl PoreResponse {
    /// Whether soil is as if there were no water.
    #[inline]
    pub(crate) fn is_none(&self) -> bool {
        self.excess == 0.0 && self.given == 0.0 && self.stiffness == 0.0
    }

    /// Excess pore pressure after a step that stretched the volume by the factor exp(`ln_volume`) \[force/length²\].
    #[inline]
    pub(crate) fn excess_after(&self, ln_volume: f64) -> f64 {
        self.excess - self.stiffness * ln_volume
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
}

impl Pores {
    /// Asks the given water at every particle and adds its forces to the nodal external force `f_ext` \[force\].
    ///
    /// # Errors
    /// [`AssemblyError::NonFinite`] for water that is not finite at a particle.
    pub(crate) fn fill<const D: usize>(
        particles: &Particles<D>,
        stencils: &Stencils<D>,
        conditions: &StepConditions<D>,
        method: &Method,
        f_ext: &mut [[f64; D]],
    ) -> Result<Self, AssemblyError> {
        let water = &conditions.water;
        let Some(given) = &water.given else {
            return Ok(Self::default());
        };
        let n = particles.len();
        let states: Vec<PoreState<D>> = (0..n)
            .into_par_iter()
            .with_min_len(CHUNK)
            .map(|particle| given.at(particles.pore_site(particle)))
            .collect();
        let gravity = &conditions.loads.gravity;
        let mut pores = Self {
            pressure: vec![0.0; n],
            stress: vec![0.0; n],
        };
        for &particle in stencils.order() {
            let particle = particle as usize;
            let own = &states[particle];
            let volume0 = particles.volume0[particle];
            let stretch = determinant(&particles.def_grad[particle]);
            let force: [f64; D] = std::array::from_fn(|axis| {
                let weight =
                    (own.added_density + (stretch - 1.0) * own.water_density) * gravity[axis];
                volume0 * (weight - stretch * water.factor * own.gradient[axis])
            });
            let difference = water.factor * (own.pressure - own.reference);
            if !(force.iter().all(|force| force.is_finite()) && difference.is_finite()) {
                let what = "given pore pressure at particle";
                return Err(AssemblyError::NonFinite {
                    what,
                    index: particle,
                });
            }
            for support in stencils.of(particle) {
                for axis in 0..D {
                    f_ext[support.node][axis] += support.value * force[axis];
                }
            }
            pores.pressure[particle] = water.factor * own.pressure;
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

    /// What water adds to the stress of a particle.
    #[inline]
    pub(crate) fn response<const D: usize>(
        &self,
        particles: &Particles<D>,
        water: &Water<D>,
        method: &Method,
        particle: usize,
    ) -> PoreResponse {
        let mut excess = particles.excess[particle];
        if excess != 0.0 && method.kinematics == Kinematics::FiniteStrain {
            excess *= determinant(&particles.def_grad[particle]);
        }
        PoreResponse {
            excess,
            given: self.stress.get(particle).copied().unwrap_or(0.0),
            stiffness: water.stiffness_of(particles, particle),
        }
    }
}

/// Forces that hold a body where a change has put it out of balance, until they are let go.
#[derive(Clone, Debug)]
pub struct HeldForces<const D: usize> {
    /// By node of the grid \[force\].
    pub forces: Arc<Vec<[f64; D]>>,
    /// The share that still acts \[-\].
    pub share: f64,
}

impl<const D: usize> HeldForces<D> {
    /// Adds them to the nodal external force. What a node holds that touches no soil any more is let go.
    pub(crate) fn add(&self, stencils: &Stencils<D>, f_ext: &mut [[f64; D]]) {
        for (node, force) in self.forces.iter().enumerate() {
            let master = stencils.master(node);
            if stencils.node_volume(master) > 0.0 {
                for axis in 0..D {
                    f_ext[master][axis] += self.share * force[axis];
                }
            }
        }
    }
}
