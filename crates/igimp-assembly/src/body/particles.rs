//! Particles as a structure of arrays. Their state is read everywhere and written in two places
//! only: here when a body is seeded, and in `commit` when a step is accepted.

use std::ops::Deref;

use igimp_material::{
    ConstitutiveModel, History, MaterialError, Ratios, Regime, ScaledLaw, Tensor,
};

use crate::error::AssemblyError;
use crate::laws::SharedLaw;
use crate::small::{determinant, identity};

/// Particles that are handled together: fixed, so that results do not depend on the number of
/// threads.
pub(crate) const CHUNK: usize = 1024;

/// What is known of a particle before the first step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ParticleSeed<const D: usize> {
    /// Centre \[length\].
    pub x: [f64; D],
    /// Half-lengths l_p of the domain \[length\].
    pub half_length: [f64; D],
    /// Volume V_0 \[length^D; per unit thickness in plane strain\].
    pub volume: f64,
    /// Density ρ_0 \[mass/length³\].
    pub density: f64,
    /// Index of the constitutive law in the list of laws.
    pub law: usize,
    /// Centroid of its soil within the domain, from the middle, over half-lengths \[-\]: zero where soil fills the domain.
    pub centroid: [f64; D],
}

/// The arrays, one entry per particle.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ParticleFields<const D: usize> {
    /// Centre x_p \[length\].
    pub x: Vec<[f64; D]>,
    /// Displacement since seeding or the last reset \[length\].
    pub displacement: Vec<[f64; D]>,
    /// Deformation gradient F; the out-of-plane stretch is 1 in plane strain \[-\].
    pub def_grad: Vec<[[f64; D]; D]>,
    /// Elastic left Cauchy–Green tensor b_e, 3 × 3 with zz in plane strain \[-\].
    pub b_e: Vec<Tensor>,
    /// Cauchy stress that the law answers, 3 × 3, tension positive: effective stress σ′ where there is water, else σ
    /// \[force/length²\].
    pub sigma: Vec<Tensor>,
    /// Current half-lengths l_p \[length\].
    pub half_length: Vec<[f64; D]>,
    /// Half-lengths as seeded \[length\].
    pub half_length0: Vec<[f64; D]>,
    /// Centroid of its soil within the domain as seeded, from the middle, over half-lengths \[-\].
    pub centroid: Vec<[f64; D]>,
    /// Volume as seeded V_0 \[length^D\].
    pub volume0: Vec<f64>,
    /// Mass \[mass\].
    pub mass: Vec<f64>,
    /// Given pore pressure u in the last step, compression positive \[force/length²\].
    pub pore_pressure: Vec<f64>,
    /// Excess pore pressure that the soil made itself, compression positive \[force/length²\].
    pub excess: Vec<f64>,
    /// The number that a particle was seeded with and keeps, whatever others come and go.
    pub number: Vec<usize>,
    /// Index of the constitutive law.
    pub law: Vec<usize>,
    /// Strength, friction and stiffness over those of the law \[-\].
    pub ratios: Vec<Ratios>,
    /// History of the law.
    pub history: Vec<History>,
    /// Where the last return to the yield surface ended.
    pub regime: Vec<Regime>,
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
        let n = seeds.len();
        let identity3 = identity::<3>();
        Ok(Self {
            fields: ParticleFields {
                x: seeds.iter().map(|seed| seed.x).collect(),
                displacement: vec![[0.0; D]; n],
                def_grad: vec![identity(); n],
                b_e: vec![identity3; n],
                sigma: vec![[[0.0; 3]; 3]; n],
                half_length: seeds.iter().map(|seed| seed.half_length).collect(),
                half_length0: seeds.iter().map(|seed| seed.half_length).collect(),
                centroid: seeds.iter().map(|seed| seed.centroid).collect(),
                volume0: seeds.iter().map(|seed| seed.volume).collect(),
                mass: seeds
                    .iter()
                    .map(|seed| seed.volume * seed.density)
                    .collect(),
                pore_pressure: vec![0.0; n],
                excess: vec![0.0; n],
                number: (0..n).collect(),
                law: seeds.iter().map(|seed| seed.law).collect(),
                ratios: vec![Ratios::ONE; n],
                history: vec![History::default(); n],
                regime: vec![Regime::Elastic; n],
            },
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
        let lengths = [
            fields.displacement.len(),
            fields.def_grad.len(),
            fields.b_e.len(),
            fields.sigma.len(),
            fields.half_length.len(),
            fields.half_length0.len(),
            fields.centroid.len(),
            fields.volume0.len(),
            fields.mass.len(),
            fields.pore_pressure.len(),
            fields.excess.len(),
            fields.number.len(),
            fields.law.len(),
            fields.ratios.len(),
            fields.history.len(),
            fields.regime.len(),
        ];
        assert!(
            lengths.iter().all(|&length| length == n),
            "arrays of one body have one length"
        );
        (0..n).try_for_each(|particle| validate_state(particle, &fields))?;
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
        let young = laws[self.fields.law[particle]].elasticity().young();
        young * self.fields.ratios[particle].stiffness
    }

    /// Those particles alone that a rule keeps by their places.
    ///
    /// # Errors
    /// [`AssemblyError::EmptyBody`] if it keeps none.
    pub fn keeping(&self, keep: impl Fn(usize) -> bool) -> Result<Self, AssemblyError> {
        let kept: Vec<usize> = (0..self.len()).filter(|&particle| keep(particle)).collect();
        let from = &self.fields;
        Self::from_fields(ParticleFields {
            x: picked(&from.x, &kept),
            displacement: picked(&from.displacement, &kept),
            def_grad: picked(&from.def_grad, &kept),
            b_e: picked(&from.b_e, &kept),
            sigma: picked(&from.sigma, &kept),
            half_length: picked(&from.half_length, &kept),
            half_length0: picked(&from.half_length0, &kept),
            centroid: picked(&from.centroid, &kept),
            volume0: picked(&from.volume0, &kept),
            mass: picked(&from.mass, &kept),
            pore_pressure: picked(&from.pore_pressure, &kept),
            excess: picked(&from.excess, &kept),
            number: picked(&from.number, &kept),
            law: picked(&from.law, &kept),
            ratios: picked(&from.ratios, &kept),
            history: picked(&from.history, &kept),
            regime: picked(&from.regime, &kept),
        })
    }

    /// These particles with others behind them.
    #[must_use]
    pub fn joined_by(&self, others: &Self) -> Self {
        let (a, b) = (&self.fields, &others.fields);
        Self {
            fields: ParticleFields {
                x: joined(&a.x, &b.x),
                displacement: joined(&a.displacement, &b.displacement),
                def_grad: joined(&a.def_grad, &b.def_grad),
                b_e: joined(&a.b_e, &b.b_e),
                sigma: joined(&a.sigma, &b.sigma),
                half_length: joined(&a.half_length, &b.half_length),
                half_length0: joined(&a.half_length0, &b.half_length0),
                centroid: joined(&a.centroid, &b.centroid),
                volume0: joined(&a.volume0, &b.volume0),
                mass: joined(&a.mass, &b.mass),
                pore_pressure: joined(&a.pore_pressure, &b.pore_pressure),
                excess: joined(&a.excess, &b.excess),
                number: joined(&a.number, &b.number),
                law: joined(&a.law, &b.law),
                ratios: joined(&a.ratios, &b.ratios),
                history: joined(&a.history, &b.history),
                regime: joined(&a.regime, &b.regime),
            },
        }
    }

    /// Where the particle of a number is, if it is there.
    pub fn place_of(&self, number: usize) -> Option<usize> {
        if self.fields.number.get(number) == Some(&number) {
            return Some(number);
        }
        self.fields.number.iter().position(|&own| own == number)
    }

    /// The arrays, handed over.
    pub fn into_fields(self) -> ParticleFields<D> {
        self.fields
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
        determinant(&self.fields.def_grad[particle]) * self.fields.volume0[particle]
    }

    /// Ratio of the volume of a particle to that at the start J = det F \[-\].
    pub fn volume_ratio(&self, particle: usize) -> f64 {
        determinant(&self.fields.def_grad[particle])
    }

    /// Total Cauchy stress σ of a particle, tension positive: what its law answers, less the pressure of the water in
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

fn picked<T: Clone>(from: &[T], which: &[usize]) -> Vec<T> {
    which.iter().map(|&k| from[k].clone()).collect()
}

fn joined<T: Clone>(a: &[T], b: &[T]) -> Vec<T> {
    [a, b].concat()
}

fn validate<const D: usize>(particle: usize, seed: &ParticleSeed<D>) -> Result<(), AssemblyError> {
    let hold = |field, values: &[f64], range| require(particle, field, values, range);
    hold("x", &seed.x, Range::Finite)?;
    hold("half_length", &seed.half_length, Range::Positive)?;
    hold("centroid", &seed.centroid, Range::WithinOne)?;
    hold("volume", &[seed.volume], Range::Positive)?;
    hold("density", &[seed.density], Range::NotNegative)
}

fn validate_state<const D: usize>(
    particle: usize,
    fields: &ParticleFields<D>,
) -> Result<(), AssemblyError> {
    let hold = |field, values: &[f64], range| require(particle, field, values, range);
    let def_grad = &fields.def_grad[particle];
    hold("x", &fields.x[particle], Range::Finite)?;
    hold(
        "displacement",
        &fields.displacement[particle],
        Range::Finite,
    )?;
    hold("def_grad", def_grad.as_flattened(), Range::Finite)?;
    hold("det def_grad", &[determinant(def_grad)], Range::Positive)?;
    hold("b_e", fields.b_e[particle].as_flattened(), Range::Finite)?;
    hold(
        "sigma",
        fields.sigma[particle].as_flattened(),
        Range::Finite,
    )?;
    hold(
        "half_length",
        &fields.half_length[particle],
        Range::Positive,
    )?;
    hold(
        "half_length0",
        &fields.half_length0[particle],
        Range::Positive,
    )?;
    hold("centroid", &fields.centroid[particle], Range::WithinOne)?;
    hold("volume0", &[fields.volume0[particle]], Range::Positive)?;
    hold("mass", &[fields.mass[particle]], Range::NotNegative)?;
    hold(
        "pore_pressure",
        &[fields.pore_pressure[particle]],
        Range::Finite,
    )?;
    hold("excess", &[fields.excess[particle]], Range::Finite)?;
    let Ratios {
        strength,
        friction,
        stiffness,
    } = fields.ratios[particle];
    hold("ratios", &[strength, stiffness], Range::Positive)?;
    hold("ratios", &[friction], Range::NotNegative)?;
    hold(
        "eps_p_eq",
        &[fields.history[particle].eps_p_eq],
        Range::Finite,
    )
}

/// What is accepted of a number.
#[derive(Clone, Copy)]
enum Range {
    Finite,
    Positive,
    NotNegative,
    WithinOne,
}

/// The error that names the first value out of its range.
fn require(
    particle: usize,
    field: &'static str,
    values: &[f64],
    range: Range,
) -> Result<(), AssemblyError> {
    let holds = |value: f64| {
        value.is_finite()
            && match range {
                Range::Finite => true,
                Range::Positive => value > 0.0,
                Range::NotNegative => value >= 0.0,
                Range::WithinOne => value.abs() < 1.0,
            }
    };
    match values.iter().find(|&&value| !holds(value)) {
        None => Ok(()),
        Some(&value) => Err(AssemblyError::InvalidParticle {
            particle,
            field,
            value,
            requirement: match range {
                Range::Finite => "finite",
                Range::Positive => "positive and finite",
                Range::NotNegative => "zero or positive, and finite",
                Range::WithinOne => "between -1 and 1",
            },
        }),
    }
}
