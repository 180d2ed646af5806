//! The fields of a case on the particles of a body, in the printed sign: compression positive.
//!
//! Where there is water, normal stresses are total (σ) or effective (σ′ = σ + u I, tension positive) by name; without it the
//! two are the same numbers. Shear stress, deviatoric stress, plastic strain and mobilised strength are those of the law.

use igimp_assembly::{Particles, SharedLaw};
use igimp_material::{
    ConstitutiveModel, InternalVariable, Principal, ShearStrength, Tensor, principal_values,
};
use igimp_model::Field;
use igimp_schema::field::Sign;
pub use igimp_schema::field::{Axes, Dimension};

/// One value per particle, in SI units; stresses compression positive.
///
/// `laws` are those that the particles refer to by index; the share of mobilised strength refers to
/// their strength. It is not a number for a particle without a law or without a stretch.
pub fn values<const D: usize>(
    field: Field,
    particles: &Particles<D>,
    laws: &[SharedLaw],
) -> Vec<f64> {
    (0..particles.len())
        .map(|particle| value(field, particles, particle, laws))
        .collect()
}

/// The value of one particle, as [`values`] gives it.
///
/// # Panics
/// If there is no such particle.
pub fn value<const D: usize>(
    field: Field,
    particles: &Particles<D>,
    particle: usize,
    laws: &[SharedLaw],
) -> f64 {
    let effective = &particles.sigma[particle];
    let total = || particles.total_stress(particle);
    let displacement = &particles.displacement[particle];
    let velocity = &particles.velocity[particle];
    let acceleration = &particles.acceleration[particle];
    // Not `-sigma`: zero stays without a sign.
    match field {
        Field::Displacement => length(displacement),
        Field::DisplacementX => displacement[0],
        Field::DisplacementY => displacement[1],
        Field::DisplacementZ => component(displacement, 2),
        Field::X => particles.x[particle][0],
        Field::Y => particles.x[particle][1],
        Field::Z => component(&particles.x[particle], 2),
        Field::SigmaXx => 0.0 - total()[0][0],
        Field::SigmaYy => 0.0 - total()[1][1],
        Field::SigmaZz => 0.0 - total()[2][2],
        Field::TauXy => 0.0 - effective[0][1],
        Field::TauYz => 0.0 - effective[1][2],
        Field::TauXz => 0.0 - effective[0][2],
        Field::P => mean_pressure(&total()),
        Field::SigmaEffXx => 0.0 - effective[0][0],
        Field::SigmaEffYy => 0.0 - effective[1][1],
        Field::SigmaEffZz => 0.0 - effective[2][2],
        Field::PEff => mean_pressure(effective),
        Field::U => particles.pore_pressure[particle] + particles.excess[particle],
        Field::UExcess => particles.excess[particle],
        Field::Q => deviatoric_stress(effective),
        Field::PlasticStrain => particles.eps_p_eq[particle],
        Field::Utilisation => utilisation(particles, particle, laws).unwrap_or(f64::NAN),
        Field::Strength => {
            shear_strength(particles, particle, laws).map_or(f64::NAN, |s| s.cohesive)
        }
        Field::Friction => {
            shear_strength(particles, particle, laws).map_or(f64::NAN, |s| s.friction_angle)
        }
        Field::Young => young(particles, particle, laws).unwrap_or(f64::NAN),
        Field::Speed => length(velocity),
        Field::VelocityX => velocity[0],
        Field::VelocityY => velocity[1],
        Field::VelocityZ => component(velocity, 2),
        Field::Acceleration => length(acceleration),
        Field::AccelerationX => acceleration[0],
        Field::AccelerationY => acceleration[1],
        Field::AccelerationZ => component(acceleration, 2),
    }
}

/// The internal variables of the laws by particle, each under its name with its unit; not a number for a particle whose
/// law does not have it.
pub fn internal_variables<const D: usize>(
    particles: &Particles<D>,
    laws: &[SharedLaw],
) -> Vec<(String, Vec<f64>)> {
    let mut found: Vec<(InternalVariable, Vec<f64>)> = Vec::new();
    for (law, model) in laws.iter().enumerate() {
        for (k, variable) in model.internal_variables().iter().enumerate() {
            let place = found.iter().position(|(known, _)| known == variable);
            let place = place.unwrap_or_else(|| {
                found.push((*variable, vec![f64::NAN; particles.len()]));
                found.len() - 1
            });
            let of_law = (0..particles.len()).filter(|&particle| particles.law[particle] == law);
            for particle in of_law {
                found[place].1[particle] = particles.internal[particle][k];
            }
        }
    }
    let named = |variable: InternalVariable| format!("{} [{}]", variable.name, variable.unit);
    let columns = found.into_iter();
    columns
        .map(|(variable, values)| (named(variable), values))
        .collect()
}

/// A component of a vector; not a number for one that it does not have.
fn component<const D: usize>(vector: &[f64; D], axis: usize) -> f64 {
    vector.get(axis).copied().unwrap_or(f64::NAN)
}

/// The length of a vector.
pub fn length<const D: usize>(vector: &[f64; D]) -> f64 {
    let [x, y, rest @ ..] = &vector[..] else {
        return f64::NAN;
    };
    rest.iter().fold(x.hypot(*y), |length, z| length.hypot(*z))
}

/// Young's modulus of a particle in the state that it is in, that of `laws` at its ratios.
fn young<const D: usize>(
    particles: &Particles<D>,
    particle: usize,
    laws: &[SharedLaw],
) -> Option<f64> {
    if laws.get(particles.law[particle])?.has_linear_elasticity() {
        return Some(particles.young(particle, laws));
    }
    let eps_e = elastic_strain(particles, particle);
    let history = particles.history(particle);
    let modulus = |law: &dyn ConstitutiveModel| law.elastic_stiffness(&eps_e, &history).young();
    particles.ask_law(particle, laws, modulus).ok()
}

/// The strength that a particle carries after its history, that of `laws` at its ratios; none for soil without a limit.
fn shear_strength<const D: usize>(
    particles: &Particles<D>,
    particle: usize,
    laws: &[SharedLaw],
) -> Option<ShearStrength> {
    laws.get(particles.law[particle])?;
    let history = particles.history(particle);
    let strength = |law: &dyn ConstitutiveModel| law.shear_strength_at(&history);
    particles.ask_law(particle, laws, strength).ok().flatten()
}

/// p = −tr σ/3.
pub(super) fn mean_pressure(sigma: &Tensor) -> f64 {
    0.0 - (sigma[0][0] + sigma[1][1] + sigma[2][2]) / 3.0
}

/// q = √(3/2)‖s‖.
pub(super) fn deviatoric_stress(sigma: &Tensor) -> f64 {
    let mean = -mean_pressure(sigma);
    let normal: f64 = (0..3).map(|a| (sigma[a][a] - mean).powi(2)).sum();
    let shear = sigma[0][1].powi(2) + sigma[0][2].powi(2) + sigma[1][2].powi(2);
    (1.5 * (normal + 2.0 * shear)).sqrt()
}

/// Principal elastic Hencky strains of a particle \[-\].
fn elastic_strain<const D: usize>(particles: &Particles<D>, particle: usize) -> Principal {
    principal_values::<D>(&particles.b_e[particle]).map(|b| 0.5 * b.ln())
}

/// Share of the shear strength of a particle's law that its stress mobilises (theory, eq. 35).
///
/// The stress is that of the law, C ½ ln b_e: Kirchhoff stress with finite strain, Cauchy stress
/// with small strain.
fn utilisation<const D: usize>(
    particles: &Particles<D>,
    particle: usize,
    laws: &[SharedLaw],
) -> Option<f64> {
    laws.get(particles.law[particle])?;
    let eps_e = elastic_strain(particles, particle);
    let share = |law: &dyn ConstitutiveModel| {
        let history = particles.history(particle);
        law.utilisation(&law.elastic_stress(&eps_e, &history), &history)
    };
    particles.ask_law(particle, laws, share).ok()
}

/// The unit of a figure: SI values are divided by `divide_by`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scale {
    /// The divisor of values in SI units.
    pub divide_by: f64,
    /// The unit after division.
    pub unit: &'static str,
}

impl Scale {
    /// The unit that keeps the largest of the values (not counting those that are not finite)
    /// within about 1 and 1000: Pa, kPa or MPa for stresses, mm or m for displacements, mm/s or m/s for velocities; degrees
    /// for angles.
    pub fn of(dimension: Dimension, values: impl IntoIterator<Item = f64>) -> Self {
        let largest = values
            .into_iter()
            .filter(|value| value.is_finite())
            .fold(0.0_f64, |most, value| most.max(value.abs()));
        let (divide_by, unit) = match dimension {
            Dimension::Displacement if largest > 0.0 && largest < 0.1 => (1e-3, "mm"),
            Dimension::Displacement | Dimension::Position => (1.0, "m"),
            Dimension::Stress if largest >= 2e6 => (1e6, "MPa"),
            Dimension::Stress if largest >= 500.0 || largest == 0.0 => (1e3, "kPa"),
            Dimension::Stress => (1.0, "Pa"),
            Dimension::Strain | Dimension::Share => (1.0, "−"),
            Dimension::Angle => (1.0_f64.to_radians(), "°"),
            Dimension::Velocity if largest > 0.0 && largest < 0.1 => (1e-3, "mm/s"),
            Dimension::Velocity => (1.0, "m/s"),
            Dimension::Acceleration => (1.0, "m/s²"),
        };
        Self { divide_by, unit }
    }

    /// The values in this unit.
    pub fn apply(&self, values: &[f64]) -> Vec<f64> {
        values.iter().map(|value| value / self.divide_by).collect()
    }
}

/// The label of an axis or a colour bar, such as
/// "vertical stress −σ_{yy} \[kPa\], compression positive".
pub fn label(field: Field, scale: Scale) -> String {
    label_in(Axes::Plane, field, scale)
}

/// The same where the axes are called so.
pub fn label_in(axes: Axes, field: Field, scale: Scale) -> String {
    let sign = match field.sign() {
        Sign::Compression => ", compression positive",
        Sign::Own | Sign::Shear => "",
    };
    format!("{} [{}]{sign}", field.title_in(axes), scale.unit)
}

/// A text of figures without its marks for indices and powers, for prose.
pub fn plain(text: &str) -> String {
    let mut plain = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(start) = [rest.find("_{"), rest.find("^{")]
        .into_iter()
        .flatten()
        .min()
    {
        let Some(length) = rest[start..].find('}') else {
            break;
        };
        plain.push_str(&rest[..start]);
        plain.push_str(&rest[start + 2..start + length]);
        rest = &rest[start + length + 1..];
    }
    plain + rest
}

#[cfg(test)]
mod tests {
    use super::*;
    use igimp_assembly::{ParticleFields, ParticleSeed};
    use igimp_material::Ratios;
    use igimp_model::{Material, Profiles, Strength};

    fn law(strength: Strength) -> SharedLaw {
        let material = Material {
            name: "soil".into(),
            unit_weight: 20e3,
            young: 1e7,
            poisson: 0.3,
            strength,
            k0: None,
            profiles: Profiles::default(),
            permeability: None,
            void_law: None,
            softening: None,
            saturated: None,
            drainage: igimp_model::Drainage::Drained,
            given: None,
        };
        material.law().unwrap()
    }

    /// Two particles: one in compression and shear, one beyond the list of laws.
    fn particles(laws: &[SharedLaw]) -> Particles<2> {
        let seed = ParticleSeed {
            x: [1.0, 2.0],
            half_length: [0.5; 2],
            volume: 1.0,
            density: 2000.0,
            law: 0,
            centroid: [0.0; _],
        };
        let other = ParticleSeed {
            x: [2.0, 2.0],
            law: 7,
            ..seed
        };
        let start = Particles::new(&[seed, other]).unwrap();
        let mut fields: ParticleFields<2> = (*start).clone();
        let tau = [-60e3, -100e3, -40e3];
        let eps_e = laws[0].stiffness_bound().strain(&tau);
        for a in 0..3 {
            fields.b_e[0][a][a] = (2.0 * eps_e[a]).exp();
            fields.sigma[0][a][a] = tau[a];
        }
        fields.sigma[0][0][1] = 15e3;
        fields.sigma[0][1][0] = 15e3;
        fields.displacement[0] = [3.0, -4.0];
        fields.velocity[0] = [-5.0, 12.0];
        fields.acceleration[0] = [8.0, -15.0];
        fields.eps_p_eq[0] = 0.2;
        Particles::from_fields(fields).unwrap()
    }

    #[test]
    fn stress_is_printed_with_compression_positive() {
        let laws = [law(Strength::Tresca {
            undrained_strength: 40e3,
        })];
        let particles = particles(&laws);
        let first = |field| values(field, &particles, &laws)[0];
        let cases = [
            (Field::Displacement, 5.0),
            (Field::DisplacementX, 3.0),
            (Field::DisplacementY, -4.0),
            (Field::X, 1.0),
            (Field::Y, 2.0),
            (Field::SigmaXx, 60e3),
            (Field::SigmaYy, 100e3),
            (Field::SigmaZz, 40e3),
            (Field::TauXy, -15e3),
            (Field::P, 200e3 / 3.0),
            (Field::Q, (2800e6_f64 + 3.0 * 225e6).sqrt()),
            (Field::PlasticStrain, 0.2),
            (Field::Utilisation, 0.75),
            (Field::Strength, 40e3),
            (Field::Friction, 0.0),
            (Field::Young, 1e7),
            (Field::Speed, 13.0),
            (Field::VelocityX, -5.0),
            (Field::VelocityY, 12.0),
            (Field::Acceleration, 17.0),
            (Field::AccelerationX, 8.0),
            (Field::AccelerationY, -15.0),
        ];
        for (field, expected) in cases {
            let found = first(field);
            assert!(
                (found - expected).abs() <= 1e-9 * expected.abs(),
                "{field:?}: {found} for {expected}"
            );
        }
        assert!(values(Field::SigmaYy, &particles, &laws)[1].is_sign_positive());
    }

    /// GOAL: total and effective stress differ by the pore pressure, given and excess, in normal components alone.
    #[test]
    fn total_and_effective_stress_are_told_apart() {
        let laws = [law(Strength::Tresca {
            undrained_strength: 40e3,
        })];
        let dry = particles(&laws);
        let mut fields: ParticleFields<2> = (*dry).clone();
        fields.pore_pressure[0] = 30e3;
        fields.excess[0] = -10e3;
        let wet = Particles::from_fields(fields).unwrap();
        let pairs = [
            (Field::SigmaXx, Field::SigmaEffXx),
            (Field::SigmaYy, Field::SigmaEffYy),
            (Field::SigmaZz, Field::SigmaEffZz),
            (Field::P, Field::PEff),
        ];
        for (total, effective) in pairs {
            let of = |field, particles| value(field, particles, 0, &laws);
            assert_eq!(of(total, &dry).to_bits(), of(effective, &dry).to_bits());
            assert_eq!(of(effective, &wet).to_bits(), of(effective, &dry).to_bits());
            let by = of(total, &wet) - of(effective, &wet);
            assert!((by - 20e3).abs() < 1e-9, "{total:?}: {by}");
        }
        for field in [Field::TauXy, Field::Q, Field::Utilisation] {
            let of = |particles| value(field, particles, 0, &laws).to_bits();
            assert_eq!(of(&wet), of(&dry), "{field:?}");
        }
        let of = |field| value(field, &wet, 0, &laws).to_bits();
        assert_eq!(
            [of(Field::U), of(Field::UExcess)],
            [20e3_f64, -10e3].map(f64::to_bits)
        );
    }

    #[test]
    fn utilisation_follows_the_law_of_the_particle() {
        let expected = |strength| {
            let laws = [law(strength)];
            values(Field::Utilisation, &particles(&laws), &laws)
        };
        assert!(expected(Strength::Elastic)[0].abs() < 1e-15);
        let elastic = [law(Strength::Elastic)];
        assert!(values(Field::Strength, &particles(&elastic), &elastic)[0].is_nan());
        let share = expected(Strength::VonMises {
            undrained_strength: 60e3,
        });
        assert!((share[0] - (2800e6_f64 / 3.0).sqrt() / 60e3).abs() < 1e-9);
        assert!(share[1].is_nan(), "the second particle has no law");
        let friction = 0.5_f64;
        let share = expected(Strength::MohrCoulomb {
            cohesion: 5e3,
            friction_angle: friction,
            dilation_angle: 0.0,
            flow: igimp_model::Flow::Dilation,
            tension_cutoff: None,
        });
        let strength = 5e3 * friction.cos() + 70e3 * friction.sin();
        assert!((share[0] - 30e3 / strength).abs() < 1e-9);
    }

    /// GOAL: the strength that is shown is that of the law that acts, at the ratios of the particle.
    #[test]
    fn strength_is_that_which_a_particle_carries() {
        let laws = [law(Strength::MohrCoulomb {
            cohesion: 5e3,
            friction_angle: 0.5,
            dilation_angle: 0.0,
            flow: igimp_model::Flow::Dilation,
            tension_cutoff: None,
        })];
        let half = Ratios {
            strength: 0.5,
            friction: 0.5,
            stiffness: 0.25,
        };
        let particles = particles(&laws).with_ratios(vec![half; 2]).unwrap();
        let reduced = [laws[0].reduced(2.0).unwrap()];
        let first = |field, laws| values(field, &particles, laws)[0];
        assert!((first(Field::Strength, &laws) - 2.5e3).abs() < 1e-9);
        assert!((first(Field::Strength, &reduced) - 1.25e3).abs() < 1e-9);
        assert!((first(Field::Friction, &reduced).tan() - 0.25 * 0.5_f64.tan()).abs() < 1e-12);
        assert!((first(Field::Young, &laws) - 2.5e6).abs() < 1e-6);
    }

    #[test]
    fn units_suit_the_largest_value() {
        let unit = |dimension, value: f64| Scale::of(dimension, [f64::NAN, -value]).unit;
        let stress = [3.0, 499.0, 2e3, 1.9e6, 3e6, 0.0].map(|v| unit(Dimension::Stress, v));
        assert_eq!(stress, ["Pa", "Pa", "kPa", "kPa", "MPa", "kPa"]);
        assert_eq!(unit(Dimension::Displacement, 0.02), "mm");
        assert_eq!(unit(Dimension::Displacement, 0.2), "m");
        assert_eq!(unit(Dimension::Displacement, 0.0), "m");
        assert_eq!(unit(Dimension::Velocity, 0.02), "mm/s");
        assert_eq!(unit(Dimension::Velocity, 2.0), "m/s");
        let scale = Scale::of(Dimension::Stress, [25e3]);
        assert_eq!(scale.apply(&[25e3]), [25.0]);
        assert_eq!(
            label(Field::SigmaYy, scale),
            "vertical stress −σ_{yy} [kPa], compression positive"
        );
        assert_eq!(plain("−σ_{yy} m^{2} {a} _{b"), "−σyy m2 {a} _{b");
    }
}
