//! Strengths of materials: their parameters, their laws, and how they are printed.

use std::sync::Arc;

use igimp_assembly::SharedLaw;
use igimp_material::{
    CamClayParameters, Cone, DruckerPrager, Elasticity, HardeningSoil, HardeningSoilParameters,
    HenckyElastic, HoekBrown, HoekBrownParameters, InertialFriction, MaterialError,
    ModifiedCamClay, MohrCoulomb, ShearStiffness, Tresca, VonMises,
};

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
    /// The text before the value, such as `c_u = `.
    pub label: &'static str,
    /// The value.
    pub value: ParameterValue,
}

/// The value of a parameter, and what of a material may vary in its place.
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

fn parameter(label: &'static str, value: ParameterValue) -> Parameter {
    Parameter { label, value }
}

/// Cohesion \[Pa\], friction angle and angle of dilation \[rad\].
fn frictional(cohesion: f64, friction_angle: f64, dilation_angle: f64) -> [Parameter; 3] {
    [
        parameter("c = ", ParameterValue::Cohesive(cohesion)),
        parameter("φ = ", ParameterValue::Friction(friction_angle)),
        parameter("ψ = ", ParameterValue::Angle(dilation_angle)),
    ]
}

/// Friction of fast shear and what makes shear fast.
fn inertial(own: &InertialFriction) -> [Parameter; 4] {
    [
        parameter("φ₂ = ", ParameterValue::Angle(own.friction_angle)),
        parameter("I₀ = ", ParameterValue::Number(own.inertial_number)),
        parameter(
            "grains in mm: ",
            ParameterValue::Number(1e3 * own.grain_diameter),
        ),
        parameter(
            "grains in kg/m³: ",
            ParameterValue::Number(own.grain_density),
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

    /// The parameters in the order in which they are printed.
    pub fn parameters(&self) -> Vec<Parameter> {
        match *self {
            Self::Elastic => vec![parameter("no limit", ParameterValue::Note)],
            Self::VonMises { undrained_strength } | Self::Tresca { undrained_strength } => {
                vec![parameter(
                    "c_u = ",
                    ParameterValue::Cohesive(undrained_strength),
                )]
            }
            Self::MohrCoulomb {
                cohesion,
                friction_angle,
                dilation_angle,
                flow,
                tension_cutoff,
            } => {
                let mut parameters = frictional(cohesion, friction_angle, dilation_angle).to_vec();
                if flow == Flow::Davis {
                    parameters.push(parameter("flow by Davis", ParameterValue::Note));
                }
                let limit = |limit| parameter("tension up to ", ParameterValue::Stress(limit));
                parameters.extend(tension_cutoff.map(limit));
                parameters
            }
            Self::DruckerPrager {
                cohesion,
                friction_angle,
                dilation_angle,
                cone,
                rate,
            } => {
                let cone = match cone {
                    Cone::Compression => "cone of triaxial compression",
                    Cone::Extension => "cone of triaxial extension",
                    Cone::PlaneStrain => "cone of plane strain",
                };
                let mut parameters = frictional(cohesion, friction_angle, dilation_angle).to_vec();
                parameters.push(parameter(cone, ParameterValue::Note));
                parameters.extend(rate.iter().flat_map(inertial));
                parameters
            }
            Self::HoekBrown(own) => vec![
                parameter("σ_ci = ", ParameterValue::Modulus(own.intact_strength)),
                parameter("GSI = ", ParameterValue::Number(own.gsi)),
                parameter("m_i = ", ParameterValue::Number(own.intact_ratio)),
                parameter("D = ", ParameterValue::Number(own.disturbance)),
                parameter("ψ = ", ParameterValue::Angle(own.dilation_angle)),
            ],
            Self::HardeningSoil(own) => vec![
                parameter("c = ", ParameterValue::Cohesive(own.cohesion)),
                parameter("φ = ", ParameterValue::Friction(own.friction_angle)),
                parameter("ψ = ", ParameterValue::Angle(own.dilation_angle)),
                parameter("E_50 = ", ParameterValue::Modulus(own.secant)),
                parameter("E_ur = ", ParameterValue::Modulus(own.unloading)),
                parameter("E_oed = ", ParameterValue::Modulus(own.oedometer)),
                parameter("m = ", ParameterValue::Number(own.power)),
                parameter("OCR = ", ParameterValue::Number(own.overconsolidation)),
            ],
            Self::ModifiedCamClay(own) => vec![
                parameter("λ* = ", ParameterValue::Number(own.compression)),
                parameter("κ* = ", ParameterValue::Number(own.swelling)),
                parameter("M = ", ParameterValue::Number(own.critical_ratio)),
                match own.shear {
                    ShearStiffness::Poisson(own) => parameter("ν = ", ParameterValue::Number(own)),
                    ShearStiffness::Constant(own) => {
                        parameter("G = ", ParameterValue::Modulus(own))
                    }
                },
                parameter("OCR = ", ParameterValue::Number(own.overconsolidation)),
            ],
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
            Self::HoekBrown(own) => Some(own.dilation_angle),
            Self::HardeningSoil(own) => Some(own.dilation_angle),
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
            Self::HardeningSoil(own) => Arc::new(HardeningSoil::new(HardeningSoilParameters {
                cohesion: at_least(own.cohesion),
                ..own
            })?),
            Self::ModifiedCamClay(parameters) => Arc::new(ModifiedCamClay::new(parameters)?),
        })
    }
}
