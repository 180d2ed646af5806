//! Strengths of materials: their parameters, their laws, and how they are printed.

use std::sync::Arc;

use igimp_assembly::SharedLaw;
use igimp_material::{
    CamClayParameters, Cone, ConstitutiveModel as _, DruckerPrager, Elasticity, HardeningSoil,
    HardeningSoilParameters, HenckyElastic, HoekBrown, HoekBrownParameters, InertialFriction,
    MaterialError, ModifiedCamClay, MohrCoulomb, ShearStiffness, Tresca, VonMises,
};

/// M of a friction angle at the critical state, in triaxial compression \[-\].
pub fn critical_ratio_of(friction_angle: f64) -> f64 {
    6.0 * friction_angle.sin() / (3.0 - friction_angle.sin())
}

/// K₀ of friction by Jaky \[-\].
pub fn jaky(friction_angle: f64) -> f64 {
    1.0 - friction_angle.sin()
}

/// How plastic flow of frictional soil follows from its angle of dilation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Flow {
    /// By a plastic potential with ψ in place of φ (theory, eq. 21).
    #[default]
    Dilation,
    /// Associated, on the strengths that soil of this ψ mobilises along lines of no extension (theory, eq. 21a).
    Davis,
}

/// The strength of a material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Strength {
    /// No limit.
    Elastic,
    /// von Mises with undrained strength c_u in plane strain \[Pa\].
    VonMises {
        /// c_u \[Pa\].
        undrained_strength: f64,
    },
    /// Tresca.
    Tresca {
        /// c_u \[Pa\].
        undrained_strength: f64,
    },
    /// Mohr–Coulomb.
    MohrCoulomb {
        /// c \[Pa\].
        cohesion: f64,
        /// φ \[rad\].
        friction_angle: f64,
        /// ψ \[rad\].
        dilation_angle: f64,
        /// How plastic flow follows from ψ.
        flow: Flow,
        /// Largest tensile stress \[Pa\]; none: the apex of the cone.
        tension_cutoff: Option<f64>,
    },
    /// Drucker–Prager.
    DruckerPrager {
        /// c \[Pa\].
        cohesion: f64,
        /// φ \[rad\].
        friction_angle: f64,
        /// ψ \[rad\].
        dilation_angle: f64,
        /// Where it agrees with Mohr–Coulomb of these parameters.
        cone: Cone,
        /// How friction grows with the speed of shear, if it does.
        rate: Option<InertialFriction>,
    },
    /// Modified Cam-clay; its elasticity is of its own.
    ModifiedCamClay(CamClayParameters),
    /// Hoek–Brown of 2002.
    HoekBrown(HoekBrownParameters),
    /// Hardening Soil; its elasticity is of its own.
    HardeningSoil(HardeningSoilParameters),
}

/// A parameter of a strength as it is printed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parameter {
    /// Its key in case files; empty where it has none of its own.
    pub key: &'static str,
    /// The text before the value, such as `c_u = `.
    pub label: &'static str,
    /// The value.
    pub value: ParameterValue,
}

/// A parameter where a strength stores it.
struct Slot<'a> {
    key: &'static str,
    /// The text before the value; none: it is not printed.
    label: Option<&'static str>,
    value: fn(f64) -> ParameterValue,
    /// None: the label says it all.
    number: Option<&'a mut f64>,
}

/// A parameter that is printed behind a label.
fn slot<'a>(
    (key, label): (&'static str, &'static str),
    value: fn(f64) -> ParameterValue,
    number: &'a mut f64,
) -> Slot<'a> {
    Slot {
        key,
        label: Some(label),
        value,
        number: Some(number),
    }
}

/// A parameter that is not printed.
fn unprinted<'a>(key: &'static str, number: &'a mut f64) -> Slot<'a> {
    Slot {
        label: None,
        ..slot((key, ""), ParameterValue::Number, number)
    }
}

/// Words among the parameters.
fn note<'a>(label: &'static str) -> Slot<'a> {
    Slot {
        key: "",
        label: Some(label),
        value: |_| ParameterValue::Note,
        number: None,
    }
}

/// The value of a parameter, and the quantity of a material that may vary in its place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ParameterValue {
    /// A strength that varies with the profile of strength \[Pa\].
    Cohesive(f64),
    /// An angle that varies with the profile of friction \[rad\].
    Friction(f64),
    /// A stress \[Pa\].
    Stress(f64),
    /// A stiffness, or the strength of rock \[Pa\].
    Modulus(f64),
    /// An angle \[rad\].
    Angle(f64),
    /// A number \[-\].
    Number(f64),
    /// None: the label says it all.
    Note,
}

/// Cohesion \[Pa\], friction angle and angle of dilation \[rad\].
fn frictional<'a>(
    cohesion: &'a mut f64,
    friction_angle: &'a mut f64,
    dilation_angle: &'a mut f64,
) -> Vec<Slot<'a>> {
    vec![
        slot(("cohesion", "c = "), ParameterValue::Cohesive, cohesion),
        slot(
            ("friction", "φ = "),
            ParameterValue::Friction,
            friction_angle,
        ),
        slot(("dilation", "ψ = "), ParameterValue::Angle, dilation_angle),
    ]
}

/// Friction of fast shear, and the numbers that make shear fast.
fn inertial(rate: &InertialFriction) -> [Parameter; 4] {
    let parameter = |label, value| Parameter {
        key: "",
        label,
        value,
    };
    [
        parameter("φ₂ = ", ParameterValue::Angle(rate.friction_angle)),
        parameter("I₀ = ", ParameterValue::Number(rate.inertial_number)),
        parameter(
            "grains in mm: ",
            ParameterValue::Number(1e3 * rate.grain_diameter),
        ),
        parameter(
            "grains in kg/m³: ",
            ParameterValue::Number(rate.grain_density),
        ),
    ]
}

impl Strength {
    /// Name of the law, in print.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Elastic => "elastic",
            Self::VonMises { .. } => "von Mises",
            Self::Tresca { .. } => "Tresca",
            Self::MohrCoulomb { .. } => "Mohr–Coulomb",
            Self::DruckerPrager { .. } => "Drucker–Prager",
            Self::ModifiedCamClay(_) => "modified Cam-clay",
            Self::HoekBrown(_) => "Hoek–Brown",
            Self::HardeningSoil(_) => "Hardening Soil",
        }
    }

    /// The parameters of the law where they are stored, in the order in which they are printed: the one list of them.
    fn slots(&mut self) -> Vec<Slot<'_>> {
        use ParameterValue::{Angle, Cohesive, Modulus, Number, Stress};
        match self {
            Self::Elastic => vec![note("no limit")],
            Self::VonMises { undrained_strength } | Self::Tresca { undrained_strength } => {
                vec![slot(("cu", "c_u = "), Cohesive, undrained_strength)]
            }
            Self::MohrCoulomb {
                cohesion,
                friction_angle,
                dilation_angle,
                flow,
                tension_cutoff,
            } => {
                let mut slots = frictional(cohesion, friction_angle, dilation_angle);
                if *flow == Flow::Davis {
                    slots.push(note("flow by Davis"));
                }
                let name = ("tension_cutoff", "tension up to ");
                slots.extend(tension_cutoff.as_mut().map(|most| slot(name, Stress, most)));
                slots
            }
            Self::DruckerPrager {
                cohesion,
                friction_angle,
                dilation_angle,
                cone,
                rate: _,
            } => {
                let mut slots = frictional(cohesion, friction_angle, dilation_angle);
                slots.push(note(match cone {
                    Cone::Compression => "cone of triaxial compression",
                    Cone::Extension => "cone of triaxial extension",
                    Cone::PlaneStrain => "cone of plane strain",
                }));
                slots
            }
            Self::HoekBrown(rock) => vec![
                slot(("sci", "σ_ci = "), Modulus, &mut rock.intact_strength),
                slot(("gsi", "GSI = "), Number, &mut rock.gsi),
                slot(("mi", "m_i = "), Number, &mut rock.intact_ratio),
                slot(("disturbance", "D = "), Number, &mut rock.disturbance),
                slot(("dilation", "ψ = "), Angle, &mut rock.dilation_angle),
            ],
            Self::HardeningSoil(soil) => {
                let angles = (&mut soil.friction_angle, &mut soil.dilation_angle);
                let mut slots = frictional(&mut soil.cohesion, angles.0, angles.1);
                slots.extend([
                    slot(("e50", "E_50 = "), Modulus, &mut soil.secant),
                    slot(("eur", "E_ur = "), Modulus, &mut soil.unloading),
                    slot(("eoed", "E_oed = "), Modulus, &mut soil.oedometer),
                    slot(("power", "m = "), Number, &mut soil.power),
                    slot(("ocr", "OCR = "), Number, &mut soil.overconsolidation),
                    unprinted("poisson", &mut soil.poisson),
                    unprinted("failure_ratio", &mut soil.failure_ratio),
                    unprinted("k0_normal", &mut soil.k0_normal),
                ]);
                slots
            }
            Self::ModifiedCamClay(clay) => vec![
                slot(("lambda", "λ* = "), Number, &mut clay.compression),
                slot(("kappa", "κ* = "), Number, &mut clay.swelling),
                slot(("critical_ratio", "M = "), Number, &mut clay.critical_ratio),
                match &mut clay.shear {
                    ShearStiffness::Poisson(value) => slot(("poisson", "ν = "), Number, value),
                    ShearStiffness::Constant(value) => slot(("shear", "G = "), Modulus, value),
                },
                slot(("ocr", "OCR = "), Number, &mut clay.overconsolidation),
            ],
        }
    }

    /// The parameters in the order in which they are printed.
    pub fn parameters(&self) -> Vec<Parameter> {
        let mut strength = *self;
        let printed = strength.slots().into_iter().filter_map(|slot| {
            Some(Parameter {
                key: slot.key,
                label: slot.label?,
                value: (slot.value)(slot.number.map_or(0.0, |number| *number)),
            })
        });
        let mut parameters: Vec<Parameter> = printed.collect();
        if let Self::DruckerPrager {
            rate: Some(rate), ..
        } = self
        {
            parameters.extend(inertial(rate));
        }
        parameters
    }

    /// Gives a parameter of the law another value, by its key; whether the law has it. Friction of Cam-clay is that at the critical state; in
    /// Hardening Soil a ratio of stresses that is that of Jaky for the friction follows it.
    pub(super) fn set(&mut self, key: &str, value: f64) -> bool {
        match self {
            Self::ModifiedCamClay(clay) if key == "friction" => {
                clay.critical_ratio = critical_ratio_of(value);
                return true;
            }
            Self::HardeningSoil(soil)
                if key == "friction"
                    && soil.k0_normal.total_cmp(&jaky(soil.friction_angle)).is_eq() =>
            {
                soil.k0_normal = jaky(value);
            }
            _ => {}
        }
        let mut slots = self.slots().into_iter().filter(|slot| slot.key == key);
        let number = slots.find_map(|slot| slot.number);
        number.map(|place| *place = value).is_some()
    }

    /// Young's modulus \[Pa\] and Poisson's ratio of a law with an elasticity of its own, at its reference pressure; none of others.
    pub fn stiffness(&self) -> Option<[f64; 2]> {
        match *self {
            Self::ModifiedCamClay(clay) => {
                let law = ModifiedCamClay::new(clay).ok()?;
                let bound = law.stiffness_bound();
                Some([bound.young(), bound.poisson()])
            }
            Self::HardeningSoil(soil) => Some([soil.unloading, soil.poisson]),
            _ => None,
        }
    }

    /// Why no stage reduces it by a factor; none where one may.
    pub fn not_reduced(&self) -> Option<&'static str> {
        match self {
            Self::Elastic => Some("is elastic: it has no strength to reduce"),
            Self::ModifiedCamClay(_) => Some(
                "is modified Cam-clay: its strength is a result of the path, and no parameter to reduce",
            ),
            Self::VonMises { .. }
            | Self::Tresca { .. }
            | Self::MohrCoulomb { .. }
            | Self::DruckerPrager { .. }
            | Self::HoekBrown(_)
            | Self::HardeningSoil(_) => None,
        }
    }

    /// Dilation angle ψ of flow that is not associated where it is below φ \[rad\]; none of a strength without one.
    pub fn flows_by(&self) -> Option<f64> {
        match *self {
            Self::MohrCoulomb {
                dilation_angle,
                flow: Flow::Dilation,
                ..
            }
            | Self::DruckerPrager { dilation_angle, .. } => Some(dilation_angle),
            Self::HoekBrown(rock) => Some(rock.dilation_angle),
            Self::HardeningSoil(soil) => Some(soil.dilation_angle),
            _ => None,
        }
    }

    /// Angle by which plastic flow gains volume \[rad\], 0 where it keeps it. None of soil that comes to keep its volume by itself, as
    /// Cam-clay, and of flow by Davis.
    pub fn dilation(&self) -> Option<f64> {
        match self {
            Self::Elastic | Self::VonMises { .. } | Self::Tresca { .. } => Some(0.0),
            _ => self.flows_by(),
        }
    }

    /// The same with an angle of dilation up to a largest one \[rad\]; flow by Davis stays.
    pub(super) fn dilating_up_to(mut self, most: f64) -> Self {
        if let Self::MohrCoulomb {
            dilation_angle,
            flow: Flow::Dilation,
            ..
        }
        | Self::DruckerPrager { dilation_angle, .. }
        | Self::HoekBrown(HoekBrownParameters { dilation_angle, .. })
        | Self::HardeningSoil(HardeningSoilParameters { dilation_angle, .. }) = &mut self
        {
            *dilation_angle = dilation_angle.min(most);
        }
        self
    }

    /// Undrained strength or cohesion \[Pa\]; none of a strength that has neither.
    pub fn cohesive(&self) -> Option<f64> {
        let mut parameters = self.parameters().into_iter();
        parameters.find_map(|parameter| match parameter.value {
            ParameterValue::Cohesive(value) => Some(value),
            _ => None,
        })
    }

    /// Friction angle φ \[rad\]; none of a strength without friction.
    pub fn friction_angle(&self) -> Option<f64> {
        let mut parameters = self.parameters().into_iter();
        parameters.find_map(|parameter| match parameter.value {
            ParameterValue::Friction(value) => Some(value),
            _ => None,
        })
    }

    /// Its law with an elasticity; one with friction has at least this cohesion \[Pa\].
    ///
    /// # Errors
    /// [`MaterialError::InvalidParameter`].
    pub fn law(
        &self,
        elasticity: Elasticity,
        least_cohesion: f64,
    ) -> Result<SharedLaw, MaterialError> {
        let at_least = |cohesion: f64| {
            if cohesion < least_cohesion {
                least_cohesion
            } else {
                cohesion
            }
        };
        Ok(match *self {
            Self::Elastic => Arc::new(HenckyElastic::new(elasticity)),
            Self::VonMises { undrained_strength } => Arc::new(VonMises::from_undrained_strength(
                elasticity,
                undrained_strength,
            )?),
            Self::Tresca { undrained_strength } => {
                Arc::new(Tresca::new(elasticity, undrained_strength)?)
            }
            Self::MohrCoulomb {
                cohesion,
                friction_angle,
                dilation_angle,
                flow,
                tension_cutoff,
            } => {
                let cohesion = at_least(cohesion);
                let mut law =
                    MohrCoulomb::new(elasticity, cohesion, friction_angle, dilation_angle)?;
                if flow == Flow::Davis {
                    law = law.with_davis_flow()?;
                }
                if let Some(limit) = tension_cutoff {
                    law = law.with_tension_cutoff(limit)?;
                }
                Arc::new(law)
            }
            Self::DruckerPrager {
                cohesion,
                friction_angle,
                dilation_angle,
                cone,
                rate,
            } => {
                let cohesion = at_least(cohesion);
                let law =
                    DruckerPrager::new(elasticity, cohesion, friction_angle, dilation_angle, cone)?;
                Arc::new(match rate {
                    Some(rate) => law.with_rate(rate)?,
                    None => law,
                })
            }
            Self::HoekBrown(parameters) => Arc::new(HoekBrown::new(elasticity, parameters)?),
            Self::HardeningSoil(soil) => Arc::new(HardeningSoil::new(HardeningSoilParameters {
                cohesion: at_least(soil.cohesion),
                ..soil
            })?),
            Self::ModifiedCamClay(parameters) => Arc::new(ModifiedCamClay::new(parameters)?),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// GOAL: a parameter that is set by its key is that one, and no other of the list moves; friction of Cam-clay is M, and K₀ of first
    /// compression follows friction where it is that of Jaky.
    #[test]
    fn a_parameter_is_set_by_its_key() {
        let soil = HardeningSoilParameters {
            cohesion: 1e3,
            friction_angle: 0.6,
            dilation_angle: 0.1,
            secant: 2e7,
            unloading: 6e7,
            oedometer: 2e7,
            poisson: 0.2,
            power: 0.5,
            reference_pressure: 1e5,
            failure_ratio: 0.9,
            k0_normal: jaky(0.6),
            overconsolidation: 1.5,
        };
        let clay = CamClayParameters {
            compression: 0.1,
            swelling: 0.02,
            critical_ratio: 1.0,
            shear: ShearStiffness::Poisson(0.3),
            overconsolidation: 2.0,
            reference_pressure: 1e5,
        };
        let sand = Strength::MohrCoulomb {
            cohesion: 1e3,
            friction_angle: 0.6,
            dilation_angle: 0.1,
            flow: Flow::Davis,
            tension_cutoff: Some(500.0),
        };
        let all = [
            sand,
            Strength::ModifiedCamClay(clay),
            Strength::HardeningSoil(soil),
        ];
        for strength in all {
            let numbers = |of: &Strength| {
                let mut of = *of;
                let slots = of.slots().into_iter();
                let numbers = slots.filter_map(|slot| Some((slot.key, *slot.number?)));
                numbers.collect::<Vec<_>>()
            };
            let before = numbers(&strength);
            for (at, (key, value)) in before.iter().enumerate() {
                let mut other = strength;
                assert!(other.set(key, 1.01 * value));
                for (k, (a, b)) in std::iter::zip(&before, numbers(&other)).enumerate() {
                    let follows = *key == "friction" && a.0 == "k0_normal";
                    let expected = if k == at { 1.01 * a.1 } else { a.1 };
                    let expected = if follows {
                        jaky(1.01 * value)
                    } else {
                        expected
                    };
                    assert!(expected.total_cmp(&b.1).is_eq(), "{key}: {}", a.0);
                }
            }
            assert!(!{ strength }.set("gsi", 1.0));
        }
        let mut other = Strength::ModifiedCamClay(clay);
        assert!(other.set("friction", 0.5));
        let expected = CamClayParameters {
            critical_ratio: critical_ratio_of(0.5),
            ..clay
        };
        assert_eq!(other, Strength::ModifiedCamClay(expected));
    }
}
