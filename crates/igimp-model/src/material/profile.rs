//! Properties of a material that vary with the level, with the depth below the surface, with the stress there, or by
//! points in the plane.

use std::borrow::Cow;

use igimp_material::Ratios;

use crate::{Ground, Material, Raster, Strength, front};

/// The least strength of a profile over its greatest \[-\]: soil without any would be no soil.
pub const LEAST_STRENGTH: f64 = 1e-6;

/// A property that varies from place to place, in SI units.
#[derive(Clone, Debug, PartialEq)]
pub enum Profile {
    /// With the level y.
    Level(Variation),
    /// With the depth below the surface, straight down: the level is then minus the depth.
    Depth(Variation),
    /// An undrained strength that is a share of the vertical effective stress.
    StressShare(Box<StressShare>),
    /// By points in the plane.
    Raster(Raster),
}

/// An undrained strength s_u = S σ′_v0 OCR^m (theory, eq. 36b).
#[derive(Clone, Debug, PartialEq)]
pub struct StressShare {
    /// S \[-\].
    pub ratio: f64,
    /// The ratio of overconsolidation; where it varies its greatest in the soil \[-\].
    pub ocr: f64,
    /// How it varies, if it does.
    pub ocr_profile: Option<Profile>,
    /// m \[-\].
    pub exponent: f64,
    /// Strength is no less \[Pa\].
    pub at_least: f64,
    /// Level of the water that stood in the ground as it consolidated \[m\], if any did.
    pub water_level: Option<f64>,
}

impl StressShare {
    /// The strength at a place \[Pa\].
    fn at<const D: usize>(&self, place: &[f64; D], ground: &Ground<D>) -> f64 {
        let ocr = (self.ocr_profile.as_ref()).map_or(self.ocr, |profile| profile.at(place, ground));
        self.of(ground.effective_stress(place, self.water_level), ocr)
    }

    /// The strength under a vertical effective stress \[Pa\] (theory, eq. 36b).
    fn of(&self, stress: f64, ocr: f64) -> f64 {
        (self.ratio * stress * ocr.powf(self.exponent)).max(self.at_least)
    }
}

impl Profile {
    /// The value at a place.
    pub fn at<const D: usize>(&self, place: &[f64; D], ground: &Ground<D>) -> f64 {
        match self {
            Self::Level(variation) => variation.at(place[D - 1]),
            Self::Depth(variation) => variation.at(-ground.depth(place)),
            Self::StressShare(share) => share.at(place, ground),
            Self::Raster(raster) => raster.at(front(place)),
        }
    }

    /// The least of the values that a table of levels or depths states; none of other profiles.
    pub fn least(&self) -> Option<f64> {
        match self {
            Self::Level(Variation::Table(rows)) | Self::Depth(Variation::Table(rows)) => {
                rows.iter().map(|row| row[1]).reduce(f64::min)
            }
            _ => None,
        }
    }

    /// The same with a linear function of all values, which is zero at zero; a share of the stress stays.
    #[must_use]
    pub fn scaled(mut self, by: impl Fn(f64) -> f64) -> Self {
        let put = |value: &mut f64| *value = by(*value);
        match &mut self {
            Self::Level(variation) | Self::Depth(variation) => match variation {
                Variation::Gradient {
                    at_top, gradient, ..
                } => [at_top, gradient].into_iter().for_each(put),
                Variation::Table(rows) => rows.iter_mut().for_each(|row| put(&mut row[1])),
            },
            Self::Raster(raster) => raster.values.iter_mut().flatten().for_each(put),
            Self::StressShare(_) => {}
        }
        self
    }

    /// The integral from a place up to a level; of a share of the stress, none is asked for, that of its value at the
    /// place.
    pub(crate) fn integral<const D: usize>(
        &self,
        place: &[f64; D],
        level: f64,
        ground: &Ground<D>,
    ) -> f64 {
        let y = place[D - 1];
        match self {
            Self::Level(variation) => variation.integral(y, level),
            Self::Depth(variation) => {
                let surface = ground.surface(place).unwrap_or(y);
                variation.integral(y - surface, level - surface)
            }
            Self::StressShare(share) => share.at(place, ground) * (level - y),
            Self::Raster(raster) => raster.integral(front(place), level),
        }
    }
}

/// A property over the level y, in SI units.
#[derive(Clone, Debug, PartialEq)]
pub enum Variation {
    /// Constant down to a level, linear in depth below it.
    Gradient {
        /// Level where it begins to change \[m\].
        from: f64,
        /// Value there and above.
        at_top: f64,
        /// Growth per metre of depth.
        gradient: f64,
    },
    /// Level \[m\] and value, from the lowest level up; linear between them and constant beyond.
    Table(Vec<[f64; 2]>),
}

impl Variation {
    /// The value at a level.
    pub fn at(&self, level: f64) -> f64 {
        match self {
            Self::Gradient {
                from,
                at_top,
                gradient,
            } => at_top + gradient * (from - level).max(0.0),
            Self::Table(rows) => {
                let above = rows.partition_point(|row| row[0] <= level);
                match (above.checked_sub(1).map(|k| rows[k]), rows.get(above)) {
                    (Some([low, value]), Some(&[high, next])) => {
                        value + (next - value) * (level - low) / (high - low)
                    }
                    (Some([_, value]), None) | (None, Some(&[_, value])) => value,
                    (None, None) => f64::NAN,
                }
            }
        }
    }

    /// Levels between which it is linear \[m\].
    fn kinks(&self) -> Vec<f64> {
        match self {
            Self::Gradient { from, .. } => vec![*from],
            Self::Table(rows) => rows.iter().map(|row| row[0]).collect(),
        }
    }

    /// The levels of the least and of the greatest value between two levels \[m\].
    pub fn extremes(&self, lower: f64, upper: f64) -> [f64; 2] {
        let kinks = self.kinks().into_iter();
        let within = kinks.filter(|level| (lower..=upper).contains(level));
        let levels = || within.clone().chain([lower, upper]);
        let by_value = |a: &f64, b: &f64| self.at(*a).total_cmp(&self.at(*b));
        [
            levels().min_by(by_value).unwrap_or(lower),
            levels().max_by(by_value).unwrap_or(upper),
        ]
    }

    /// The integral from one level up to another.
    pub fn integral(&self, lower: f64, upper: f64) -> f64 {
        if upper < lower {
            return -self.integral(upper, lower);
        }
        let mut ends: Vec<f64> = self.kinks();
        ends.retain(|level| lower < *level && *level < upper);
        ends.sort_by(f64::total_cmp);
        ends.insert(0, lower);
        ends.push(upper);
        ends.windows(2)
            .map(|pair| (pair[1] - pair[0]) * 0.5 * (self.at(pair[0]) + self.at(pair[1])))
            .sum()
    }
}

/// The parameters of a material that vary; all others are its constants.
///
/// Where something varies, the constant of the material is the greatest value in its soil.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Profiles {
    /// Undrained strength or cohesion \[Pa\].
    pub strength: Option<Profile>,
    /// tan φ \[-\].
    pub friction: Option<Profile>,
    /// Young's modulus \[Pa\].
    pub young: Option<Profile>,
    /// Unit weight \[N/m³\].
    pub unit_weight: Option<Profile>,
    /// Permeability along the bedding \[m/s\].
    pub permeability: Option<Profile>,
    /// All other parameters of the law that vary, by their keys in case files: soil has a law of its own there.
    pub parameters: Vec<(&'static str, Profile)>,
}

impl Profiles {
    /// How a parameter varies that asks for a law of its own at every place, by its key.
    pub fn of_parameter(&self, key: &str) -> Option<&Profile> {
        let mut varied = self.parameters.iter().filter(|entry| entry.0 == key);
        varied.next().map(|entry| &entry.1)
    }
}

impl Material {
    /// Whether a parameter varies that asks for a law of its own at every place.
    pub fn has_laws_by_place(&self) -> bool {
        !self.profiles.parameters.is_empty()
    }

    /// The keys of the parameters that ask for a law of their own at every place, with their values at one.
    pub fn values_at<const D: usize>(
        &self,
        place: &[f64; D],
        ground: &Ground<D>,
    ) -> impl Iterator<Item = (&'static str, f64)> {
        let parameters = self.profiles.parameters.iter();
        parameters.map(|(key, profile)| (*key, profile.at(place, ground)))
    }

    /// The material with the parameters that its law has at a place, as soil that starts there carries them, and without profiles; ratios
    /// are apart ([`Self::ratios_at`]).
    pub fn at<const D: usize>(&self, place: &[f64; D], ground: &Ground<D>) -> Cow<'_, Self> {
        if !self.has_laws_by_place() {
            return Cow::Borrowed(self);
        }
        let mut soil = Self {
            name: self.name.clone(),
            profiles: Profiles::default(),
            given: self.given.clone(),
            ..*self
        };
        for (key, value) in self.values_at(place, ground) {
            if !soil.strength.set(key, value) {
                soil.poisson = value;
            }
        }
        if let Some(stiffness) = soil.strength.stiffness() {
            [soil.young, soil.poisson] = stiffness;
        }
        Cow::Owned(soil)
    }

    /// Undrained strength or cohesion \[Pa\]; zero for a material that has neither. The greatest where it varies.
    pub fn cohesive(&self) -> f64 {
        self.strength.cohesive().unwrap_or(0.0)
    }

    /// The material as soil under a vertical effective stress \[Pa\] has it, where its undrained strength is a share of that;
    /// with the greatest ratio of overconsolidation. None else.
    pub fn under(&self, stress: f64) -> Option<Self> {
        let Some(Profile::StressShare(share)) = &self.profiles.strength else {
            return None;
        };
        let mut soil = self.clone();
        soil.profiles.strength = None;
        if let Strength::VonMises { undrained_strength } | Strength::Tresca { undrained_strength } =
            &mut soil.strength
        {
            *undrained_strength = share.of(stress.max(0.0), share.ocr);
        }
        Some(soil)
    }

    /// Whether anything varies that stress depends on.
    pub fn varies(&self) -> bool {
        let of_stress = Profiles {
            permeability: None,
            ..self.profiles.clone()
        };
        of_stress != Profiles::default()
    }

    /// Strength, friction and stiffness at a place over the constants of the material \[-\].
    pub fn ratios_at<const D: usize>(&self, place: &[f64; D], ground: &Ground<D>) -> Ratios {
        let Profiles {
            strength,
            friction,
            young,
            unit_weight: _,
            permeability: _,
            parameters: _,
        } = &self.profiles;
        let over = |profile: &Option<Profile>, greatest: f64, least: f64| {
            let ratio = |varied: &Profile| (varied.at(place, ground) / greatest).max(least);
            profile.as_ref().map_or(1.0, ratio)
        };
        let tan_friction = self.strength.friction_angle().map_or(1.0, f64::tan);
        Ratios {
            strength: over(strength, self.cohesive(), LEAST_STRENGTH),
            friction: over(friction, tan_friction, 0.0),
            stiffness: over(young, self.young, 0.0),
        }
    }

    /// Young's modulus at a place \[Pa\].
    pub fn young_at<const D: usize>(&self, place: &[f64; D], ground: &Ground<D>) -> f64 {
        (self.profiles.young.as_ref()).map_or(self.young, |profile| profile.at(place, ground))
    }

    /// Permeability at a place over the greatest in its soil \[-\]; one where it does not vary.
    pub fn permeability_ratio_at<const D: usize>(
        &self,
        place: &[f64; D],
        ground: &Ground<D>,
    ) -> f64 {
        let varied = self.profiles.permeability.as_ref();
        match (varied, self.permeability) {
            (Some(profile), Some(soil)) => profile.at(place, ground) / soil.along,
            _ => 1.0,
        }
    }

    /// Unit weight at a place \[N/m³\].
    pub fn unit_weight_at<const D: usize>(&self, place: &[f64; D], ground: &Ground<D>) -> f64 {
        (self.profiles.unit_weight.as_ref()).map_or(self.unit_weight, |p| p.at(place, ground))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn profiles_are_linear_between_their_levels_and_constant_beyond() {
        let growing = Variation::Gradient {
            from: 5.0,
            at_top: 10.0,
            gradient: 2.0,
        };
        let table = Variation::Table(vec![[0.0, 20.0], [3.0, 14.0], [5.0, 10.0]]);
        for level in [-1.0, 0.0, 1.3, 3.0, 4.5, 5.0, 7.0] {
            assert!((growing.at(level) - 10.0 - 2.0 * (5.0 - level).max(0.0)).abs() < 1e-14);
            let clamped = f64::clamp(level, 0.0, 5.0);
            assert!(
                (table.at(level) - growing.at(clamped)).abs() < 1e-14,
                "{level}"
            );
        }
        assert!((growing.integral(1.0, 6.0) - (10.0 + 4.0 * 14.0)).abs() < 1e-12);
        assert!((growing.integral(6.0, 1.0) + 66.0).abs() < 1e-12);
        assert!((table.integral(-1.0, 6.0) - (20.0 + 75.0 + 10.0)).abs() < 1e-12);
        let [least, greatest] = growing.extremes(1.0, 6.0);
        assert!(least >= 5.0 && (greatest - 1.0).abs() < 1e-15);
        let bulge = Variation::Table(vec![[0.0, 1.0], [1.0, 5.0], [2.0, 0.5]]);
        let [least, greatest] = bulge.extremes(0.2, 1.5);
        assert!((least - 0.2).abs() < 1e-15 && (greatest - 1.0).abs() < 1e-15);
    }
}
