//! Strength that goes with plastic strain: its parameters, its laws on cells of a size, and how they are printed.

use std::sync::Arc;

use igimp_assembly::SharedLaw;
use igimp_material::{
    Curve, Decay, Directions, Elasticity, FrictionalCurves, MaterialError, Nonlocal, RateEffect,
    Softening,
};

use super::strength::Strength;

/// Cells across which a band of shear spreads its slip, by the work of sheared layers \[-\] (theory, eq. 110).
pub const BAND_CELLS: f64 = 1.0;

/// How a parameter of strength goes with plastic strain.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Softens {
    /// Its residual: a share of the initial value \[-\] of c_u and c, an angle \[rad\] of φ and ψ.
    pub residual: f64,
    /// Plastic strain over which it goes \[-\].
    pub strain: f64,
    /// Shape of the curve.
    pub decay: Decay,
}

/// The parameters of a strength that go with plastic strain, and the effects on an undrained one.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct StrengthCurves {
    /// c_u or c.
    pub cohesive: Option<Softens>,
    /// φ.
    pub friction: Option<Softens>,
    /// ψ.
    pub dilation: Option<Softens>,
    /// Width of the bands of shear in which the strains of the curves were measured \[m\]; none: strains are those of the curves
    /// on any cells.
    pub band_width: Option<f64>,
    /// How strength sees the plastic strain of the ground around; none: it goes with that of the point.
    pub nonlocal: Option<Nonlocal>,
    /// How an undrained strength goes with the direction of stress.
    pub directions: Option<Directions>,
    /// How an undrained strength goes with the rate of strain.
    pub rate: Option<RateEffect>,
}

impl StrengthCurves {
    /// Whether strength goes with plastic strain or its rate.
    pub fn goes_with_strain(&self) -> bool {
        let curves = [self.cohesive, self.friction, self.dilation];
        curves.iter().any(Option::is_some) || self.rate.is_some()
    }

    /// Multiple of the strains of the curves on cells of a size \[m\]; 1 on none, and without a width.
    pub fn strain_ratio(&self, cell: f64) -> f64 {
        match self.band_width {
            Some(width) if cell > 0.0 => width / (BAND_CELLS * cell),
            _ => 1.0,
        }
    }

    /// The law of a strength along these curves, on cells of a size \[m\], with the least cohesion of soil with friction \[Pa\]. On none it
    /// is that of soil that is strained evenly, where the ground around has the plastic strain of the point.
    ///
    /// # Errors
    /// [`MaterialError::InvalidParameter`], also of a strength that has no curves.
    pub(super) fn law(
        &self,
        strength: &Strength,
        elasticity: Elasticity,
        (least_cohesion, cell): (f64, f64),
    ) -> Result<SharedLaw, MaterialError> {
        let ratio = self.strain_ratio(cell);
        let along = |initial: f64, goes: Option<Softens>, residual: &dyn Fn(f64) -> f64| {
            goes.map_or(Curve::constant(initial), |softens| Curve {
                initial,
                residual: residual(softens.residual),
                strain: softens.strain * ratio,
                decay: softens.decay,
            })
        };
        let undrained = |cu: f64| along(cu, self.cohesive, &|share| share * cu);
        let seeing = |law: Softening| match self.nonlocal {
            Some(nonlocal) if cell > 0.0 => law.with_nonlocal(nonlocal),
            _ => Ok(law),
        };
        let with_effects = |mut law: Softening| {
            if let Some(directions) = self.directions {
                law = law.with_directions(directions)?;
            }
            if let Some(rate) = self.rate {
                law = law.with_rate(rate)?;
            }
            seeing(law)
        };
        Ok(match *strength {
            Strength::VonMises { undrained_strength } => {
                let curve = undrained(undrained_strength);
                Arc::new(with_effects(Softening::von_mises(elasticity, curve)?)?)
            }
            Strength::Tresca { undrained_strength } => {
                let curve = undrained(undrained_strength);
                Arc::new(with_effects(Softening::tresca(elasticity, curve)?)?)
            }
            Strength::MohrCoulomb {
                cohesion,
                friction_angle,
                dilation_angle,
                tension_cutoff,
                ..
            } => {
                let counted = |c: f64| c.max(least_cohesion);
                let left = |share: f64| counted(share * cohesion);
                let curves = FrictionalCurves {
                    cohesion: along(counted(cohesion), self.cohesive, &left),
                    friction_angle: along(friction_angle, self.friction, &|angle| angle),
                    dilation_angle: along(dilation_angle, self.dilation, &|angle| angle),
                };
                let law = Softening::mohr_coulomb(elasticity, curves, tension_cutoff)?;
                Arc::new(seeing(law)?)
            }
            _ => strength.law(elasticity, least_cohesion)?,
        })
    }

    /// The curves in words, such as `c or c_u to 40 % on a line over a plastic strain of 0.05`, with angles as they are printed.
    pub fn in_words(&self, number: impl Fn(f64) -> String) -> Vec<String> {
        let share = |residual: f64| format!("{} %", number(100.0 * residual));
        let angle = |residual: f64| format!("{}°", number(residual.to_degrees()));
        let words = |symbol: &str, goes: Softens, residual: String| {
            let shape = match goes.decay {
                Decay::Linear => "on a line",
                Decay::Exponential => "exponentially",
            };
            format!(
                "{symbol} to {residual} {shape} over a plastic strain of {}",
                number(goes.strain)
            )
        };
        let mut all = Vec::new();
        all.extend((self.cohesive).map(|goes| words("c or c_u", goes, share(goes.residual))));
        all.extend((self.friction).map(|goes| words("φ", goes, angle(goes.residual))));
        all.extend((self.dilation).map(|goes| words("ψ", goes, angle(goes.residual))));
        all.extend((self.band_width).map(|width| format!("in bands of {} m", number(width))));
        all.extend(self.nonlocal.map(|nonlocal| {
            let (length, share) = (number(nonlocal.length), number(nonlocal.over_nonlocal));
            format!("spread over a length of {length} m, m = {share}")
        }));
        all.extend(self.directions.map(|directions| {
            let [shear, passive] = [directions.simple_shear, directions.passive].map(share);
            format!("c_u of active loading, {shear} of it in simple shear, {passive} passive")
        }));
        all.extend(self.rate.map(|rate| {
            let (growth, reference) = (share(rate.per_log_cycle), rate.reference);
            format!(
                "{growth} more a log cycle of rate above {} 1/s",
                number(reference)
            )
        }));
        all
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use igimp_material::{ConstitutiveModel, PointContext, Principal};

    /// GOAL: on cells of a size the law has its strains times the width of the band over that size (eq. 110), on none as they are stated;
    /// residual cohesion is no less than the least one. ORACLE: laws made by hand.
    #[test]
    fn strains_go_with_the_width_over_the_cell() {
        let elasticity = Elasticity::new(1e7, 0.3).unwrap();
        let curves = StrengthCurves {
            cohesive: Some(Softens {
                residual: 0.4,
                strain: 0.05,
                decay: Decay::Linear,
            }),
            band_width: Some(0.3),
            ..StrengthCurves::default()
        };
        let strength = Strength::Tresca {
            undrained_strength: 50e3,
        };
        for (cell, ratio) in [(0.0, 1.0), (0.6, 0.5), (0.1, 3.0)] {
            let made = Curve {
                initial: 50e3,
                residual: 20e3,
                strain: 0.05 * ratio,
                decay: Decay::Linear,
            };
            let made = Softening::tresca(elasticity, made).unwrap();
            let law = curves.law(&strength, elasticity, (0.0, cell)).unwrap();
            let strain: Principal = [0.02, 0.0, -0.02];
            let history = law.initial_history(&[0.0; 3]);
            let [one, other] = [
                law.return_map(&strain, &history, &PointContext::STATIC),
                made.return_map(&strain, &history, &PointContext::STATIC),
            ]
            .map(|answer| answer.unwrap().tau);
            for a in 0..3 {
                assert!((one[a] - other[a]).abs() < 1e-9 * 50e3, "{cell}");
            }
        }
        let nonlocal = Nonlocal {
            length: 0.2,
            over_nonlocal: 2.0,
        };
        let seeing = StrengthCurves {
            band_width: None,
            nonlocal: Some(nonlocal),
            ..curves
        };
        let on = |cell| seeing.law(&strength, elasticity, (0.0, cell)).unwrap();
        assert_eq!(
            (on(0.6).nonlocal(), on(0.0).nonlocal()),
            (Some(nonlocal), None)
        );
        let words = seeing.in_words(|number| number.to_string());
        assert_eq!(words[1], "spread over a length of 0.2 m, m = 2");
        let frictional = Strength::MohrCoulomb {
            cohesion: 5e3,
            friction_angle: 0.5,
            dilation_angle: 0.0,
            flow: crate::Flow::Dilation,
            tension_cutoff: None,
        };
        let law = curves.law(&frictional, elasticity, (3e3, 0.0)).unwrap();
        let mut far = law.initial_history(&[0.0; 3]);
        far.internal[0] = 1.0;
        let apex = 3e3 / 0.5_f64.tan();
        assert!(law.yield_function(&[apex; 3], &far).abs() < 1e-9 * apex);
        let words = curves.in_words(|number| number.to_string());
        let expected = "c or c_u to 40 % on a line over a plastic strain of 0.05";
        assert_eq!(words, [expected, "in bands of 0.3 m"]);
    }
}
