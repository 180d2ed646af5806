//! Materials: stiffness, strength and weight.

pub(crate) mod point_laws;
pub(crate) mod profile;
pub(crate) mod raster;
pub(crate) mod softening;
pub(crate) mod strength;

use std::sync::Arc;

use igimp_assembly::{SharedLaw, VoidLaw};
use igimp_material::{Elasticity, MaterialError};
use igimp_schema::text::number;
use igimp_seepage::Soil;

use super::{Drainage, Profile, Profiles};
use softening::StrengthCurves;
use strength::Strength;

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
    /// How it goes with plastic strain, if it does.
    pub softening: Option<StrengthCurves>,
    /// Coefficient of earth pressure at rest K₀ \[-\], if the material states one.
    pub k0: Option<f64>,
    /// The parameters that vary from place to place.
    pub profiles: Profiles,
    /// Unit weight below the water table \[N/m³\]; none: that above.
    pub saturated: Option<f64>,
    /// Its drainage.
    pub drainage: Drainage,
    /// Its permeability, where seepage is computed or water flows out of it.
    pub permeability: Option<Soil>,
    /// How its permeability follows the void ratio as water flows out of it; none: it stays.
    pub void_law: Option<VoidLaw>,
    /// A law that takes the place of the one that `strength` names; case files know none.
    pub given: Option<GivenLaw>,
}

/// A law of a program's own. It is known by the text of its `Debug`: a run is taken up again only with a law
/// that prints the same.
#[derive(Clone, Debug)]
pub struct GivenLaw(pub SharedLaw);

impl PartialEq for GivenLaw {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
}

/// Parts between the least and the greatest friction at whose ends a law is looked at.
const PARTS: u32 = 16;

/// Least cohesion of soil with friction, over γh \[-\].
const LEAST_COHESION: f64 = 1.0 / 400.0;

impl Material {
    /// Whether it is the same in all but its name.
    pub fn is_same_soil(&self, other: &Self) -> bool {
        let renamed = Self {
            name: other.name.clone(),
            ..self.clone()
        };
        renamed == *other
    }

    /// Angle by which its plastic flow gains volume \[rad\], 0 of soil that keeps its volume; none of a law of its own, and as
    /// [`Strength::dilation`].
    pub fn dilation(&self) -> Option<f64> {
        match self.given {
            Some(_) => None,
            None => self.strength.dilation(),
        }
    }

    /// The same with an angle of dilation up to a largest one \[rad\].
    fn dilating_up_to(mut self, most: f64) -> Self {
        self.strength = self.strength.dilating_up_to(most);
        if let Some(curves) = &mut self.softening {
            curves.dilation = curves.dilation.filter(|goes| goes.residual < most);
        }
        self
    }

    /// Constrained modulus, 1/m_v \[Pa\].
    pub fn constrained_modulus(&self) -> f64 {
        let (young, poisson) = (self.young, self.poisson);
        young * (1.0 - poisson) / ((1.0 + poisson) * (1.0 - 2.0 * poisson))
    }

    /// Speed of a compression wave under a gravity \[m/s²\] \[m/s\]; none where there is no weight.
    pub fn wave_speed(&self, gravity: f64) -> f64 {
        if self.unit_weight > 0.0 {
            (self.constrained_modulus() * gravity / self.unit_weight).sqrt()
        } else {
            0.0
        }
    }

    /// Whether its strength goes with the rate of strain, in stages that take time.
    pub fn goes_with_rate(&self) -> bool {
        let cone_does = matches!(self.strength, Strength::DruckerPrager { rate: Some(_), .. });
        cone_does || self.softening.is_some_and(|curves| curves.rate.is_some())
    }

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
        self.strength.friction_angle()?;
        (self.cohesive() < least).then_some(least)
    }

    /// Why it has no law on cells of a height \[m\], as the end of a sentence; where friction varies it has to have one from the least of it to
    /// the greatest: stress snaps back first where φ is near 20°.
    ///
    /// # Errors
    /// The words.
    pub fn possible(&self, cell: f64) -> Result<(), String> {
        let law = (self.law_on(cell)).map_err(|error| format!(": {error}"))?;
        let (Some(least), Some(greatest)) = (
            self.profiles.friction.as_ref().and_then(Profile::least),
            (self.strength.friction_angle()).filter(|angle| *angle > 0.0),
        ) else {
            return Ok(());
        };
        for part in 0..PARTS {
            let share = f64::from(part) / f64::from(PARTS);
            let friction = least + share * (greatest.tan() - least);
            // A law that is made anew, as one that is reduced is, looks at its curves.
            (law.at_friction(friction / greatest.tan()))
                .and_then(|law| law.map(|law| law.reduced(1.0)).transpose())
                .map_err(|error| {
                    let degrees = number(friction.atan().to_degrees());
                    format!(" where its friction is {degrees} deg: {error}")
                })?;
        }
        Ok(())
    }

    /// The constitutive law on cells of a height \[m\], with the least cohesion that they need.
    ///
    /// # Errors
    /// [`MaterialError::InvalidParameter`].
    pub fn law_on(&self, cell: f64) -> Result<SharedLaw, MaterialError> {
        if let Some(GivenLaw(law)) = &self.given {
            return Ok(Arc::clone(law));
        }
        let least_cohesion = LEAST_COHESION * self.unit_weight * cell;
        let elasticity = Elasticity::new(self.young, self.poisson)?;
        match &self.softening {
            Some(curves) => curves.law(&self.strength, elasticity, (least_cohesion, cell)),
            None => self.strength.law(elasticity, least_cohesion),
        }
    }
}
