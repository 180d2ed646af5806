//! Materials: stiffness, strength and weight.

pub(crate) mod profile;
pub(crate) mod raster;

use std::sync::Arc;

use igimp_assembly::SharedLaw;
use igimp_material::{Elasticity, HenckyElastic, MaterialError, MohrCoulomb, Tresca, VonMises};

use super::{Drainage, Profiles};

/// A material. Where a property varies, its constant is the greatest value in the soil.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// Name.
    pub name: String,
    /// Unit weight γ \[N/m³\].
    pub unit_weight: f64,
    /// Young's modulus \[Pa\].
    pub young: f64,
    /// Poisson's ratio \[-\].
    pub poisson: f64,
    /// Strength.
    pub strength: Strength,
    /// Coefficient of earth pressure at rest K₀ \[-\], if the material states one.
    pub k0: Option<f64>,
    /// What varies from place to place.
    pub profiles: Profiles,
    /// Unit weight below the water table \[N/m³\]; none: that above.
    pub saturated: Option<f64>,
    /// What it does with water.
    pub drainage: Drainage,
    /// A law that takes the place of the one that `strength` names; case files know none.
    pub given: Option<GivenLaw>,
}

/// A law of a program's own. It is known by what its `Debug` prints: a run is taken up again only with a law
/// that prints the same.
#[derive(Clone, Debug)]
pub struct GivenLaw(pub SharedLaw);

impl PartialEq for GivenLaw {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
}

/// Least cohesion of soil with friction, over γh \[-\].
const LEAST_COHESION: f64 = 1.0 / 400.0;

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
}

impl Material {
    /// The constitutive law; where strength, friction or stiffness vary, that of the greatest, of which particles have multiples.
    ///
    /// # Errors
    /// [`MaterialError::InvalidParameter`].
    pub fn law(&self) -> Result<SharedLaw, MaterialError> {
        self.law_on(0.0)
    }

    /// The cohesion that soil with friction and with less counts with on cells of a height \[m\], γh/400 \[Pa\] (theory,
    /// eq. 8g); none for other soil.
    pub fn least_cohesion(&self, cell: f64) -> Option<f64> {
        let least = LEAST_COHESION * self.unit_weight * cell;
        match self.strength {
            Strength::MohrCoulomb { cohesion, .. } if cohesion < least => Some(least),
            _ => None,
        }
    }

    /// The constitutive law on cells of a height \[m\], with the least cohesion that they need.
    ///
    /// # Errors
    /// [`MaterialError::InvalidParameter`].
    pub fn law_on(&self, cell: f64) -> Result<SharedLaw, MaterialError> {
        if let Some(GivenLaw(law)) = &self.given {
            return Ok(Arc::clone(law));
        }
        let elasticity = Elasticity::new(self.young, self.poisson)?;
        Ok(match self.strength {
            Strength::Elastic => Arc::new(HenckyElastic::new(elasticity)),
            Strength::VonMises { undrained_strength } => Arc::new(
                VonMises::from_undrained_strength(elasticity, undrained_strength)?,
            ),
            Strength::Tresca { undrained_strength } => {
                Arc::new(Tresca::new(elasticity, undrained_strength)?)
            }
            Strength::MohrCoulomb {
                cohesion,
                friction_angle,
                dilation_angle,
                flow,
                tension_cutoff,
            } => {
                let cohesion = self.least_cohesion(cell).unwrap_or(cohesion);
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
        })
    }
}
