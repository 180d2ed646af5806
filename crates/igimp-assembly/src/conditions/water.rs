//! Given water in the pores of soil, as a step finds it (theory, eqs. 51 to 54).
//!
//! Pore pressure u is positive in compression, as everywhere in soil mechanics.

use std::fmt::Debug;
use std::sync::Arc;

use crate::body::particles::Particles;
use crate::error::AssemblyError;
use crate::laws::SharedLaw;
use crate::method::Section;
use igimp_material::{ConstitutiveModel, principal_values};

/// State of given water at a particle, at full gravity.
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
    /// Density as seeded, without that of the water \[mass/length³\].
    pub density: f64,
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
    pub fn pore_site(&self, particle: usize, section: Section) -> PoreSite<'_, D> {
        let domain0: f64 = (self.half_length0[particle].iter())
            .map(|half_length| 2.0 * half_length)
            .product();
        // Soil of a body of revolution was seeded at the radius of its centroid.
        let radius =
            self.x[particle][0] + self.centroid[particle][0] * self.half_length[particle][0];
        let radius0 = radius / (1.0 + self.hoop_strain[particle]);
        PoreSite {
            number: self.number[particle],
            law: self.law[particle],
            density: self.mass[particle] / self.volume0[particle],
            x: &self.x[particle],
            half_length: &self.half_length[particle],
            filled: self.volume0[particle] / (domain0 * section.thickness(radius0)),
        }
    }

    /// How far soil that joined a particle as it was seeded, reaches beyond its domain \[length\] (theory, eq. 45i).
    pub fn beyond_domain(&self, particle: usize, section: Section) -> [f64; D] {
        let (site, centroid) = (self.pore_site(particle, section), &self.centroid[particle]);
        let twice = if site.filled > 1.0 { 2.0 } else { 0.0 };
        std::array::from_fn(|axis| twice * centroid[axis] * site.half_length[axis])
    }
}

/// Given water. Pure: the same particle at the same place finds the same.
pub trait PoreWater<const D: usize>: Debug + Send + Sync {
    /// The water in the domain of a particle.
    fn at(&self, site: PoreSite<'_, D>) -> PoreState<D>;
}

/// The water of a step.
#[derive(Clone, Debug)]
pub struct Water<const D: usize> {
    /// The given field; none: dry.
    pub given: Option<Arc<dyn PoreWater<D>>>,
    /// Factor on its pressure, the multiple of gravity \[-\].
    pub factor: f64,
    /// Bulk modulus of the water over the porosity, K_w/n, by law; zero or absent where water leaves as it likes.
    pub stiffness: Vec<PoreStiffness>,
}

/// Bulk modulus of the water over the porosity, K_w/n, in soil of one law.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PoreStiffness {
    /// Where the soil has the constants of its law \[force/length²\].
    pub modulus: f64,
    /// Whether it varies as the stiffness of the soil does, from place to place and with stress: it follows from a Poisson's ratio of
    /// undrained soil. Else it is one.
    pub goes_with_soil: bool,
}

impl PoreStiffness {
    /// In the soil of a particle with the stiffness of its law's constants \[force/length²\].
    fn at_constants<const D: usize>(&self, particles: &Particles<D>, particle: usize) -> f64 {
        if self.goes_with_soil {
            self.modulus * particles.ratios[particle].stiffness
        } else {
            self.modulus
        }
    }

    /// In the soil of a particle with its stiffness in the state that it is in (theory, eq. 54a) \[force/length²\].
    ///
    /// # Errors
    /// [`AssemblyError::Material`] of a law that cannot be made.
    pub(crate) fn of<const D: usize>(
        &self,
        particles: &Particles<D>,
        particle: usize,
        laws: &[SharedLaw],
    ) -> Result<f64, AssemblyError> {
        let bound = &laws[particles.law[particle]];
        if !self.goes_with_soil || bound.has_linear_elasticity() {
            return Ok(self.at_constants(particles, particle));
        }
        let eps_e = principal_values::<D>(&particles.b_e[particle]).map(|b| 0.5 * b.ln());
        let history = particles.history(particle);
        let bulk = |law: &dyn ConstitutiveModel| law.elastic_stiffness(&eps_e, &history).bulk();
        let bulk = (particles.ask_law(particle, laws, bulk))
            .map_err(|source| AssemblyError::Material { particle, source })?;
        Ok(self.modulus * bulk / bound.stiffness_bound().bulk())
    }
}

impl From<f64> for PoreStiffness {
    fn from(modulus: f64) -> Self {
        Self {
            modulus,
            goes_with_soil: false,
        }
    }
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
    /// K_w/n of a particle whose soil is as stiff as the constants of its law say \[force/length²\].
    #[inline]
    pub(crate) fn stiffness_of(&self, particles: &Particles<D>, particle: usize) -> f64 {
        let stiffness = self.stiffness.get(particles.law[particle]);
        stiffness.map_or(0.0, |stiffness| stiffness.at_constants(particles, particle))
    }

    /// Refuses numbers that are not finite.
    pub(crate) fn is_finite(&self) -> Result<(), AssemblyError> {
        if !self.factor.is_finite() {
            let quantity = "factor on pore pressure";
            return Err(AssemblyError::NonFinite { quantity, index: 0 });
        }
        let bad = |pore: &PoreStiffness| !(pore.modulus.is_finite() && pore.modulus >= 0.0);
        match self.stiffness.iter().position(bad) {
            Some(index) => {
                let quantity = "bulk modulus of pore water";
                Err(AssemblyError::NonFinite { quantity, index })
            }
            None => Ok(()),
        }
    }
}
