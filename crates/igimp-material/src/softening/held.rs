//! A law with its strength held at a plastic strain: its return, and how that changes with the plastic strain (theory, eqs. 107 and
//! 108).

use super::curve::Curve;
use super::rates::Changing;
use super::undrained::Moment;
use crate::pyramid::PlaneStrength;
use crate::spectral::principal::{descending, deviator, dot, sorted, unsorted};
use crate::{
    ConstitutiveModel, Elasticity, History, MaterialError, PointContext, Principal, ReturnMap,
    VonMises,
};

/// The curves of a law; angles by their tangents.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Kind {
    /// By the yield stress.
    VonMises(Curve),
    /// By the undrained strength.
    Tresca(Curve),
    MohrCoulomb {
        cohesion: Curve,
        friction: Curve,
        dilation: Curve,
        tension_cutoff: Option<f64>,
    },
}

/// A law with its strength held at a plastic strain.
pub(super) enum Held {
    /// The cylinder, and the derivative of its yield stress.
    Cylinder(VonMises, f64),
    Pyramid(Changing),
}

/// A return at a held strength, with its plastic strain.
pub(super) struct Answer {
    pub(super) map: ReturnMap,
    /// Plastic strain of the step \[-\].
    pub(super) strain: f64,
    /// Its derivative by the trial strain.
    pub(super) by_trial: Principal,
    /// ∂τ/∂κ.
    pub(super) stress_rate: Principal,
    /// Its derivative by κ.
    pub(super) by_kappa: f64,
}

/// Plastic strain of a return at a held strength.
pub(super) struct Strained {
    /// Plastic strain of the step \[-\].
    pub(super) strain: f64,
    /// Its derivative by κ.
    pub(super) by_kappa: f64,
    pub(super) is_plastic: bool,
}

impl Answer {
    /// The same with κ of the soil, in whose strains those of the law are `ratio` times as great (theory, eq. 110f).
    pub(super) fn of_soil(self, ratio: f64) -> Self {
        Self {
            strain: self.strain / ratio,
            by_trial: self.by_trial.map(|by| by / ratio),
            by_kappa: self.by_kappa / ratio,
            ..self
        }
    }
}

impl Strained {
    /// As [`Answer::of_soil`].
    pub(super) fn of_soil(self, ratio: f64) -> Self {
        Self {
            strain: self.strain / ratio,
            by_kappa: self.by_kappa / ratio,
            ..self
        }
    }
}

impl Held {
    /// The plastic strain alone, of a trial strain whose stress is `stress`, in descending order.
    pub(super) fn strained(
        &self,
        elasticity: &Elasticity,
        (trial, stress): (&Principal, &Principal),
    ) -> Result<Strained, MaterialError> {
        if let Self::Pyramid(changing) = self {
            if changing.strength.holds(stress) {
                return Ok(Strained {
                    strain: 0.0,
                    by_kappa: 0.0,
                    is_plastic: false,
                });
            }
            if let Some([strain, by_kappa]) = changing.strain(&elasticity.moduli(), stress) {
                return Ok(Strained {
                    strain,
                    by_kappa,
                    is_plastic: true,
                });
            }
        }
        let answer = self.answer(elasticity, trial, &History::default())?;
        Ok(Strained {
            strain: answer.strain,
            by_kappa: answer.by_kappa,
            is_plastic: answer.map.regime.is_plastic(),
        })
    }

    pub(super) fn return_map(
        &self,
        elasticity: &Elasticity,
        trial: &Principal,
        history: &History,
    ) -> Result<ReturnMap, MaterialError> {
        match self {
            Self::Cylinder(law, _) => law.return_map(trial, history, &PointContext::STATIC),
            Self::Pyramid(changing) => changing.strength.return_map(elasticity, trial, *history),
        }
    }

    /// The return with its derivatives.
    pub(super) fn answer(
        &self,
        elasticity: &Elasticity,
        trial: &Principal,
        history: &History,
    ) -> Result<Answer, MaterialError> {
        let map = self.return_map(elasticity, trial, history)?;
        let e_p = deviator(&map.delta_eps_p);
        let strain = (2.0 / 3.0 * dot(&e_p, &e_p)).sqrt();
        // ∂κ/∂Δε_p; at rest, and where volume alone changes, none.
        let along = if strain > 0.0 {
            e_p.map(|component| 2.0 / 3.0 * component / strain)
        } else {
            [0.0; 3]
        };
        let stress_rate = match self {
            Self::Cylinder(_, rate) => along.map(|component| component * rate),
            Self::Pyramid(changing) => {
                let order = descending(trial);
                let tau = sorted(&map.tau, &order);
                let stress = sorted(&elasticity.stress(trial), &order);
                let rate = changing.stress_rate(elasticity, map.regime, &stress, &tau);
                unsorted(&rate, &order)
            }
        };
        let compliant = elasticity.strain(&along);
        let by_trial = std::array::from_fn(|b| {
            let kept: f64 = (0..3).map(|a| compliant[a] * map.tangent[a][b]).sum();
            along[b] - kept
        });
        let by_kappa = 0.0 - dot(&compliant, &stress_rate);
        Ok(Answer {
            map,
            strain,
            by_trial,
            stress_rate,
            by_kappa,
        })
    }
}

impl Kind {
    /// The curves of soil by undrained strength, each put to something that goes with it; others stay.
    pub(super) fn map(self, put: impl Fn(Curve) -> Curve) -> Self {
        match self {
            Self::VonMises(curve) => Self::VonMises(put(curve)),
            Self::Tresca(curve) => Self::Tresca(put(curve)),
            Self::MohrCoulomb { .. } => self,
        }
    }

    /// The law at a plastic strain, of which the moment says how much is of the step.
    pub(super) fn held(
        &self,
        elasticity: Elasticity,
        kappa: f64,
        moment: &Moment,
    ) -> Result<Held, MaterialError> {
        Ok(match self {
            Self::VonMises(curve) => {
                let [yield_stress, rate] = moment.of(curve.at(kappa));
                Held::Cylinder(VonMises::from_yield_stress(elasticity, yield_stress)?, rate)
            }
            Self::Tresca(curve) => {
                let [shear, rate] = moment.of(curve.at(kappa)).map(|value| 2.0 * value);
                let prism = |shear, apex| PlaneStrength {
                    sin_friction: 0.0,
                    sin_dilation: 0.0,
                    shear,
                    apex,
                    tension_cutoff: None,
                };
                Held::Pyramid(Changing {
                    strength: prism(shear, f64::INFINITY),
                    rate: prism(rate, 0.0),
                })
            }
            Self::MohrCoulomb {
                cohesion,
                friction,
                dilation,
                tension_cutoff,
            } => {
                let (c, tangent) = (cohesion.at(kappa), friction.at(kappa));
                let dilation = dilation.at(kappa);
                let dilation = if dilation[0] < tangent[0] {
                    dilation
                } else {
                    tangent
                };
                // A cut-off goes with the cohesion that is left.
                let cutoff = tension_cutoff.map(|cutoff| {
                    if cohesion.initial > 0.0 {
                        c.map(|value| cutoff * value / cohesion.initial)
                    } else {
                        [cutoff, 0.0]
                    }
                });
                Held::Pyramid(frictional(c, tangent, dilation, cutoff))
            }
        })
    }
}

/// The pyramid of c, tan φ, tan ψ and a cut-off, each with its derivative.
fn frictional(
    [c, c_rate]: [f64; 2],
    [tangent, tangent_rate]: [f64; 2],
    [dilation, dilation_rate]: [f64; 2],
    cutoff: Option<[f64; 2]>,
) -> Changing {
    let cosine = |tangent: f64| tangent.mul_add(tangent, 1.0).sqrt().recip();
    let (cos, cos_dilation) = (cosine(tangent), cosine(dilation));
    let (apex, apex_rate) = if tangent > 0.0 {
        (c / tangent, (c_rate - c * tangent_rate / tangent) / tangent)
    } else {
        (f64::INFINITY, 0.0)
    };
    let cutoff = cutoff.filter(|[cutoff, _]| *cutoff < apex);
    Changing {
        strength: PlaneStrength {
            sin_friction: tangent * cos,
            sin_dilation: dilation * cos_dilation,
            shear: 2.0 * c * cos,
            apex,
            tension_cutoff: cutoff.map(|[cutoff, _]| cutoff),
        },
        rate: PlaneStrength {
            sin_friction: tangent_rate * cos.powi(3),
            sin_dilation: dilation_rate * cos_dilation.powi(3),
            shear: 2.0 * cos * (c_rate - c * tangent * tangent_rate * cos * cos),
            apex: apex_rate,
            tension_cutoff: cutoff.map(|[_, rate]| rate),
        },
    }
}
