//! Properties of a material that vary with the level, or from place to place.

use igimp_material::Ratios;

use super::{Material, Raster, Strength};
use crate::polygon::bounding_box;

/// The least strength of a profile over its greatest \[-\]: soil without any would be no soil.
pub const LEAST_STRENGTH: f64 = 1e-6;

/// A property that varies, in SI units.
#[derive(Clone, Debug, PartialEq)]
pub enum Profile {
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
    /// By points in the plane.
    Raster(Raster),
}

impl Profile {
    /// The value at a place.
    pub fn at(&self, place: [f64; 2]) -> f64 {
        let level = place[1];
        match self {
            Self::Raster(raster) => raster.at(place),
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
            Self::Raster(raster) => raster.y.clone(),
        }
    }

    /// The places of the least and of the greatest value within polygons; none without polygons.
    pub fn extremes(&self, polygons: &[&[[f64; 2]]]) -> Option<[[f64; 2]; 2]> {
        let places = polygons.iter().flat_map(|polygon| {
            if let Self::Raster(raster) = self {
                return raster.places_in(polygon);
            }
            let (lower, upper) = bounding_box(polygon);
            let kinks = self.kinks().into_iter().map(|level| [lower[0], level]);
            let within = kinks.filter(|at| lower[1] <= at[1] && at[1] <= upper[1]);
            within.chain([lower, upper]).collect()
        });
        let places: Vec<[f64; 2]> = places.collect();
        let by_value = |a: &[f64; 2], b: &[f64; 2]| self.at(*a).total_cmp(&self.at(*b));
        Some([
            places.iter().copied().min_by(by_value)?,
            places.iter().copied().max_by(by_value)?,
        ])
    }

    /// The integral from a place straight up to a level.
    pub fn integral(&self, [x, lower]: [f64; 2], upper: f64) -> f64 {
        if upper < lower {
            return -self.integral([x, upper], lower);
        }
        let mut ends: Vec<f64> = self.kinks();
        ends.retain(|level| lower < *level && *level < upper);
        ends.sort_by(f64::total_cmp);
        ends.insert(0, lower);
        ends.push(upper);
        ends.windows(2)
            .map(|pair| (pair[1] - pair[0]) * 0.5 * (self.at([x, pair[0]]) + self.at([x, pair[1]])))
            .sum()
    }
}

/// What of a material varies; what does not is the constant of the material.
///
/// Where something varies, the constant of the material is the greatest value in its soil.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Profiles {
    /// Undrained strength or cohesion \[Pa\].
    pub strength: Option<Profile>,
    /// Young's modulus \[Pa\].
    pub young: Option<Profile>,
    /// Unit weight \[N/m³\].
    pub unit_weight: Option<Profile>,
}

impl Material {
    /// Undrained strength or cohesion \[Pa\]; zero for a material that has neither. The greatest where it varies.
    pub fn cohesive(&self) -> f64 {
        match self.strength {
            Strength::VonMises { undrained_strength } | Strength::Tresca { undrained_strength } => {
                undrained_strength
            }
            Strength::MohrCoulomb { cohesion, .. } => cohesion,
            Strength::Elastic => 0.0,
        }
    }

    /// Whether anything varies.
    pub fn varies(&self) -> bool {
        self.profiles != Profiles::default()
    }

    /// Strength and stiffness at a place over the constants of the material \[-\].
    pub fn ratios_at(&self, place: [f64; 2]) -> Ratios {
        let over = |profile: &Option<Profile>, greatest: f64, least: f64| {
            let ratio = |own: &Profile| (own.at(place) / greatest).max(least);
            profile.as_ref().map_or(1.0, ratio)
        };
        Ratios {
            strength: over(&self.profiles.strength, self.cohesive(), LEAST_STRENGTH),
            stiffness: over(&self.profiles.young, self.young, 0.0),
        }
    }

    /// Young's modulus at a place \[Pa\].
    pub fn young_at(&self, place: [f64; 2]) -> f64 {
        (self.profiles.young.as_ref()).map_or(self.young, |own| own.at(place))
    }

    /// By how much it is heavier below the water table \[N/m³\].
    pub fn added_by_water(&self) -> f64 {
        self.saturated
            .map_or(0.0, |saturated| saturated - self.unit_weight)
    }

    /// Unit weight at a place \[N/m³\].
    pub fn unit_weight_at(&self, place: [f64; 2]) -> f64 {
        (self.profiles.unit_weight.as_ref()).map_or(self.unit_weight, |own| own.at(place))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn profiles_are_linear_between_their_levels_and_constant_beyond() {
        let growing = Profile::Gradient {
            from: 5.0,
            at_top: 10.0,
            gradient: 2.0,
        };
        let table = Profile::Table(vec![[0.0, 20.0], [3.0, 14.0], [5.0, 10.0]]);
        for level in [-1.0, 0.0, 1.3, 3.0, 4.5, 5.0, 7.0] {
            assert!((growing.at([7.0, level]) - 10.0 - 2.0 * (5.0 - level).max(0.0)).abs() < 1e-14);
            let clamped = f64::clamp(level, 0.0, 5.0);
            assert!(
                (table.at([7.0, level]) - growing.at([7.0, clamped])).abs() < 1e-14,
                "{level}"
            );
        }
        assert!((growing.integral([0.0, 1.0], 6.0) - (10.0 + 4.0 * 14.0)).abs() < 1e-12);
        assert!((growing.integral([0.0, 6.0], 1.0) + 66.0).abs() < 1e-12);
        assert!((table.integral([0.0, -1.0], 6.0) - (20.0 + 75.0 + 10.0)).abs() < 1e-12);
        let between = |a: f64, b: f64| [[0.0, a], [1.0, a], [1.0, b], [0.0, b]];
        let levels = |of: &Profile, a, b| of.extremes(&[&between(a, b)]).unwrap().map(|at| at[1]);
        let [least, greatest] = levels(&growing, 1.0, 6.0);
        assert!(least >= 5.0 && (greatest - 1.0).abs() < 1e-15);
        let bulge = Profile::Table(vec![[0.0, 1.0], [1.0, 5.0], [2.0, 0.5]]);
        let [least, greatest] = levels(&bulge, 0.2, 1.5);
        assert!((least - 0.2).abs() < 1e-15 && (greatest - 1.0).abs() < 1e-15);
    }
}
