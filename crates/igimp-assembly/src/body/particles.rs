//! Particles as a structure of arrays. Their state is read everywhere and written in two places
//! only: here when a body is seeded, and in `commit` when a step is accepted.

use std::ops::Deref;

use igimp_material::{
    ConstitutiveModel, History, MaterialError, Ratios, Regime, ScaledLaw, Tensor,
};

use crate::body::columns::{
    Column, ColumnRequest, ColumnValues, Entry, Internal, Range, columns, is_idle, require,
};
use crate::error::AssemblyError;
use crate::laws::SharedLaw;
use igimp_rigid::Domains;
use igimp_shape::matrices::{determinant, identity};

/// Particles that are handled together: fixed, so that results do not depend on the number of
/// threads.
pub(crate) const CHUNK: usize = 1024;

/// How many times as long as it was seeded a domain is drawn at most \[-\]: by far more only single particles of spray are
/// stretched, which count up to one cell.
const LONGEST_DRAWN: f64 = 6.0;

/// Data of a particle before the first step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ParticleSeed<const D: usize> {
    /// Centre \[length\].
    pub x: [f64; D],
    /// Half-lengths l_p of the domain \[length\].
    pub half_length: [f64; D],
    /// Volume V_0 \[length^D; per unit thickness in plane strain, of the whole circle in an axisymmetric section\].
    pub volume: f64,
    /// Density ρ_0 \[mass/length³\].
    pub density: f64,
    /// Index of the constitutive law in the list of laws.
    pub law: usize,
    /// Centroid of its soil within the domain, from the middle, over half-lengths \[-\]: zero where soil fills the domain.
    pub centroid: [f64; D],
}

columns! {
    |seed, number|
    /// Centre x_p \[length\].
    x: [f64; D] = seed.x, Range::Finite;
    /// Displacement since seeding or the last reset \[length\].
    displacement: [f64; D] = [0.0; D], Range::Finite;
    /// Velocity \[length/time\].
    velocity: [f64; D] = [0.0; D], Range::Finite, optional;
    /// Acceleration \[length/time²\].
    acceleration: [f64; D] = [0.0; D], Range::Finite, optional;
    /// Deformation gradient F; the out-of-plane stretch is 1 in plane strain \[-\].
    def_grad: [[f64; D]; D] = identity(), Range::Invertible;
    /// Strain around the axis F_θθ − 1; zero unless the section is axisymmetric \[-\].
    hoop_strain: f64 = 0.0, Range::AboveMinusOne, optional;
    /// Elastic left Cauchy–Green tensor b_e, 3 × 3 with zz in plane strain \[-\].
    b_e: Tensor = identity(), Range::Finite;
    /// Cauchy stress that the law answers, 3 × 3, tension positive: effective stress σ′ where there is water, else σ
    /// \[force/length²\].
    sigma: Tensor = [[0.0; 3]; 3], Range::Finite;
    /// Current half-lengths l_p \[length\].
    half_length: [f64; D] = seed.half_length, Range::Positive;
    /// Half-lengths as seeded \[length\].
    half_length0: [f64; D] = seed.half_length, Range::Positive;
    /// Centroid of its soil within the domain as seeded, from the middle, over half-lengths \[-\].
    centroid: [f64; D] = seed.centroid, Range::WithinOne;
    /// Volume as seeded V_0 \[length^D\].
    volume0: f64 = seed.volume, Range::Positive;
    /// Mass \[mass\].
    mass: f64 = seed.volume * seed.density, Range::NotNegative;
    /// Given pore pressure u in the last step, compression positive \[force/length²\].
    pore_pressure: f64 = 0.0, Range::Finite;
    /// Excess pore pressure that the soil made itself, compression positive \[force/length²\].
    excess: f64 = 0.0, Range::Finite;
    /// By how much the excess pore pressure at the particle differs from that mean of its cells, where water flows
    /// \[force/length²\].
    excess_within_cell: f64 = 0.0, Range::Finite, optional;
    /// Rate at which the water by volume grew in the last step in which it flowed \[1/time\].
    water_rate: f64 = 0.0, Range::Finite, optional;
    /// ln of its permeability over the greatest of its material \[-\].
    ln_permeability_ratio: f64 = 0.0, Range::Finite, optional;
    /// The number that a particle was seeded with and keeps, whatever others come and go.
    number: usize = number, Range::Finite;
    /// Index of the constitutive law.
    law: usize = seed.law, Range::Finite;
    /// Strength, friction and stiffness over those of the law \[-\].
    ratios: Ratios = Ratios::ONE, Range::Positive;
    /// Accumulated plastic strain invariant \[-\].
    eps_p_eq: f64 = 0.0, Range::Finite;
    /// Internal variables of the law, in the order of [`ConstitutiveModel::internal_variables`].
    internal: Internal = [0.0; _], Range::Finite, optional;
    /// Where the last return to the yield surface ended.
    regime: Regime = Regime::Elastic, Range::Finite;
}

/// The particles of a body: [`ParticleFields`] that can be read but not written.
#[derive(Clone, Debug, PartialEq)]
pub struct Particles<const D: usize> {
    fields: ParticleFields<D>,
}

impl<const D: usize> Deref for Particles<D> {
    type Target = ParticleFields<D>;

    fn deref(&self) -> &ParticleFields<D> {
        &self.fields
    }
}

impl<const D: usize> Particles<D> {
    /// Seeds a body, stress-free and undeformed.
    ///
    /// # Errors
    /// [`AssemblyError::EmptyBody`] without seeds; [`AssemblyError::InvalidParticle`] for a
    /// position that is not finite, a volume or half-length that is not positive, or a negative
    /// density.
    pub fn new(seeds: &[ParticleSeed<D>]) -> Result<Self, AssemblyError> {
        if seeds.is_empty() {
            return Err(AssemblyError::EmptyBody);
        }
        for (particle, seed) in seeds.iter().enumerate() {
            validate(particle, seed)?;
        }
        Ok(Self {
            fields: ParticleFields::seeded(seeds),
        })
    }

    /// Particles with a state that was saved before.
    ///
    /// # Errors
    /// [`AssemblyError::EmptyBody`] without particles; [`AssemblyError::InvalidParticle`] for the
    /// first particle with a number that is not finite, a deformation gradient without positive
    /// determinant, a half-length or volume that is not positive, or a negative mass.
    ///
    /// # Panics
    /// If the arrays differ in length.
    pub fn from_fields(fields: ParticleFields<D>) -> Result<Self, AssemblyError> {
        let n = fields.x.len();
        if n == 0 {
            return Err(AssemblyError::EmptyBody);
        }
        assert!(fields.are_of(n), "arrays of one body have one length");
        (0..n).try_for_each(|particle| fields.validate(particle))?;
        Ok(Self { fields })
    }

    /// The particles as seeded with strength, friction and stiffness that are multiples of those of their laws, one
    /// entry per particle. They carry them from then on.
    ///
    /// # Errors
    /// [`AssemblyError::InvalidParticle`] for the first ratio that is not finite or not positive; one of friction may be
    /// zero.
    ///
    /// # Panics
    /// If there are more or fewer entries than particles.
    pub fn with_ratios(self, ratios: Vec<Ratios>) -> Result<Self, AssemblyError> {
        Self::from_fields(ParticleFields {
            ratios,
            ..self.fields
        })
    }

    /// The particles with permeabilities over the greatest of their material \[-\], one entry per particle. They carry them
    /// from then on.
    ///
    /// # Errors
    /// [`AssemblyError::InvalidParticle`] for the first ratio that is not positive and finite.
    ///
    /// # Panics
    /// If there are more or fewer entries than particles.
    pub fn with_permeability_ratios(self, ratios: &[f64]) -> Result<Self, AssemblyError> {
        Self::from_fields(ParticleFields {
            ln_permeability_ratio: ratios.iter().map(|ratio| ratio.ln()).collect(),
            ..self.fields
        })
    }

    /// The particles with the memory that their laws begin with where there is no stress yet ([`ConstitutiveModel::initial_history`]).
    ///
    /// # Errors
    /// [`AssemblyError::Material`] of a law that cannot be made, as [`ask_law`](Self::ask_law) says.
    pub fn with_initial_histories(self, laws: &[SharedLaw]) -> Result<Self, AssemblyError> {
        let remembers = |law: &SharedLaw| !law.internal_variables().is_empty();
        if !laws.iter().any(remembers) {
            return Ok(self);
        }
        let history = |particle| {
            let initial = |law: &dyn ConstitutiveModel| law.initial_history(&[0.0; 3]).internal;
            let asked = self.ask_law(particle, laws, initial);
            asked.map_err(|source| AssemblyError::Material { particle, source })
        };
        let internal = (0..self.len()).map(history).collect::<Result<_, _>>()?;
        Self::from_fields(ParticleFields {
            internal,
            ..self.fields
        })
    }

    /// Asks the law of a particle at the strength, friction and stiffness of that particle (theory, eq. 19b); `laws`
    /// are those that particles name. Where all ratios are 1 this is the law itself; a law with friction of its own is
    /// made for the asking.
    ///
    /// # Errors
    /// [`MaterialError::InvalidParameter`] for a stiffness beyond the numbers, and for friction and cohesion of zero.
    ///
    /// # Panics
    /// If there is no such particle, or not its law.
    #[inline]
    pub fn ask_law<T>(
        &self,
        particle: usize,
        laws: &[SharedLaw],
        ask: impl FnOnce(&dyn ConstitutiveModel) -> T,
    ) -> Result<T, MaterialError> {
        let law: &dyn ConstitutiveModel = &*laws[self.fields.law[particle]];
        let ratios = self.fields.ratios[particle];
        // It is asked in one place, so that what asks is compiled into it.
        let at_friction;
        let scaled;
        let asked: &dyn ConstitutiveModel = if ratios.are_one() {
            law
        } else {
            at_friction = if ratios.has_friction_of_its_own() {
                law.at_friction(ratios.friction)?
            } else {
                None
            };
            scaled = ScaledLaw::new(at_friction.as_deref().unwrap_or(law), ratios)?;
            &scaled
        };
        Ok(ask(asked))
    }

    /// Young's modulus of a particle \[force/length²\], `laws` being those that particles name.
    ///
    /// # Panics
    /// If there is no such particle, or not its law.
    #[inline]
    pub fn young(&self, particle: usize, laws: &[SharedLaw]) -> f64 {
        let young = laws[self.fields.law[particle]].stiffness_bound().young();
        young * self.fields.ratios[particle].stiffness
    }

    /// Those particles alone that a rule keeps by their places.
    ///
    /// # Errors
    /// [`AssemblyError::EmptyBody`] if it keeps none.
    pub fn keeping(&self, keep: impl Fn(usize) -> bool) -> Result<Self, AssemblyError> {
        let kept: Vec<usize> = (0..self.len()).filter(|&particle| keep(particle)).collect();
        Self::from_fields(self.fields.picked(&kept))
    }

    /// These particles with others behind them.
    #[must_use]
    pub fn joined_by(&self, others: &Self) -> Self {
        Self {
            fields: self.fields.joined(&others.fields),
        }
    }

    /// The history that the law of a particle sees.
    #[inline]
    pub fn history(&self, particle: usize) -> History {
        History {
            eps_p_eq: self.fields.eps_p_eq[particle],
            internal: self.fields.internal[particle],
        }
    }

    /// Where the particle of a number is, if it is there.
    pub fn place_of(&self, number: usize) -> Option<usize> {
        if self.fields.number.get(number) == Some(&number) {
            return Some(number);
        }
        self.fields.number.iter().position(|&n| n == number)
    }

    /// The arrays, handed over.
    pub fn into_fields(self) -> ParticleFields<D> {
        self.fields
    }

    /// The domains as they stand, for bodies beside them.
    pub(crate) fn domains(&self) -> Domains<'_, D> {
        Domains {
            x: &self.x,
            half_length: &self.half_length,
            half_length0: &self.half_length0,
        }
    }

    /// Number of particles.
    pub fn len(&self) -> usize {
        self.fields.x.len()
    }

    /// Whether there is no particle: never, by construction.
    pub fn is_empty(&self) -> bool {
        self.fields.x.is_empty()
    }

    /// Current volume V = det F · V_0 of a particle \[length^D\].
    pub fn volume(&self, particle: usize) -> f64 {
        self.volume_ratio(particle) * self.fields.volume0[particle]
    }

    /// Half-lengths of the box by which results draw and measure a particle \[length\]: its domain, at most six times as long as
    /// it was seeded. Domains of single particles that flow off stretch without end.
    pub fn drawn_half_length(&self, particle: usize) -> [f64; D] {
        let (now, seeded) = (&self.half_length[particle], &self.half_length0[particle]);
        std::array::from_fn(|axis| now[axis].min(LONGEST_DRAWN * seeded[axis]))
    }

    /// Ratio of the volume of a particle to that at the start J = det F \[-\].
    pub fn volume_ratio(&self, particle: usize) -> f64 {
        volume_ratio(
            &self.fields.def_grad[particle],
            self.fields.hoop_strain[particle],
        )
    }

    /// Deformation gradient of a particle in three directions, 3 × 3: beyond those of the plane the stretch around the axis, or
    /// none \[-\].
    pub fn whole_def_grad(&self, particle: usize) -> Tensor {
        let mut whole = identity();
        for (row, values) in std::iter::zip(&mut whole, &self.fields.def_grad[particle]) {
            row[..D].copy_from_slice(values);
        }
        whole[2][2] += self.fields.hoop_strain[particle];
        whole
    }

    /// Total Cauchy stress σ of a particle, tension positive: that of its law, less the pressure of the water in
    /// its pores \[force/length²\].
    pub fn total_stress(&self, particle: usize) -> Tensor {
        let mut sigma = self.fields.sigma[particle];
        let u = self.fields.pore_pressure[particle] + self.fields.excess[particle];
        for axis in 0..3 {
            sigma[axis][axis] -= u;
        }
        sigma
    }

    /// Counts displacements from the present positions on; nothing else changes.
    pub fn reset_displacements(&mut self) {
        self.fields.displacement.fill([0.0; D]);
    }

    /// The arrays for writing: for `commit` alone.
    pub(crate) fn fields_mut(&mut self) -> &mut ParticleFields<D> {
        &mut self.fields
    }
}

/// J = det F, with the stretch around the axis \[-\].
pub(crate) fn volume_ratio<const D: usize>(def_grad: &[[f64; D]; D], hoop_strain: f64) -> f64 {
    determinant(def_grad) * (1.0 + hoop_strain)
}

fn validate<const D: usize>(particle: usize, seed: &ParticleSeed<D>) -> Result<(), AssemblyError> {
    let hold = |field, values: &[f64], range| require(particle, field, values, range);
    hold("x", &seed.x, Range::Finite)?;
    hold("half_length", &seed.half_length, Range::Positive)?;
    hold("centroid", &seed.centroid, Range::WithinOne)?;
    hold("volume", &[seed.volume], Range::Positive)?;
    hold("density", &[seed.density], Range::NotNegative)
}
