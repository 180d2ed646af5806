//! The spectral lift: a law in principal space becomes a law for tensors, written once.
//!
//! For an isotropic law stress and trial strain share their principal axes, so the stress is the
//! return map of the principal strains set into these axes, and the spatial tangent follows from
//! the principal tangent D and the secants of shear (Ogden 1984; de Souza Neto, Perić & Owen
//! 2008, appendix A; theory, eq. 23): with the principal values b of the trial elastic left Cauchy–Green tensor
//!
//! ```math
//! A_{aabb} = D_{ab},\qquad
//! A_{abab} = \frac{(\tau_a-\tau_b)\,b_b}{b_a-b_b},\qquad
//! A_{abba} = \frac{(\tau_a-\tau_b)\,b_a}{b_a-b_b}
//! ```
//!
//! In terms of $`x = \ln b_a - \ln b_b = 2(\varepsilon_a - \varepsilon_b)`$ and the secant
//! modulus $`k = (\tau_a-\tau_b)/x`$ the shear parts are $`k\,x/(e^x-1)`$ and
//! $`k\,x/(1-e^{-x})`$: all that is delicate for equal eigenvalues is k, and there
//! $`k = (D_{aa}-D_{ab}-D_{ba}+D_{bb})/4`$. With small strain both are k.

use crate::spectral::eigen::{compose, principal_axes};
use crate::spectral::principal::{Principal, Tensor};
use crate::{
    ConstitutiveModel, Elasticity, History, MaterialError, PointContext, Regime, ReturnMap,
    SpatialTangent,
};

/// Which tangent a lift answers; the stress is that of the return map either way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TangentKind {
    /// That of the elastic part of the law at the trial state, turned with the returned stress where
    /// there was a return (theory, eq. 23a): symmetric with the stress and regular, also at the
    /// apex. For the first correction of a load step.
    Elastic,
    /// That of the return map, for the quadratic convergence of Newton's method.
    Consistent,
    /// That of the return map with a share of the elastic one wherever there was a return (theory, eq. 25e): stiff
    /// where flow without a potential leaves hardly any stiffness.
    Regularised {
        /// The share ω of the elastic tangent, 0 to 1 \[-\].
        elastic: f64,
    },
}

impl TangentKind {
    /// The share of the elastic tangent in that of a particle with a return \[-\].
    fn elastic_share(self) -> f64 {
        match self {
            Self::Regularised { elastic } => elastic,
            Self::Elastic | Self::Consistent => 0.0,
        }
    }
}

/// The answer of a law to a trial tensor, in spatial axes.
#[derive(Clone, Debug, PartialEq)]
pub struct Lifted<const D: usize> {
    /// Kirchhoff stress τ (Cauchy stress with small strain) \[stress\], tension positive.
    pub tau: Tensor,
    /// Principal elastic Hencky strain after the return, C⁻¹ τ \[-\].
    pub eps_e: Principal,
    /// Principal axes: `frame[a]` is the unit vector of principal value `a` \[-\]. In plane strain
    /// the last one is z.
    pub frame: [[f64; 3]; 3],
    /// Principal plastic strain increment of the step, in the same axes \[-\].
    pub delta_eps_p: Principal,
    /// History at the end of the step.
    pub history: History,
    /// Where on the yield surface the stress is.
    pub regime: Regime,
    /// The components $`A_{aabb}`$ of the tangent in principal axes \[stress\].
    normal: [[f64; 3]; 3],
    /// The components $`A_{abab}`$ of the tangent off the diagonal \[stress\].
    shear: [[f64; 3]; 3],
}

impl<const D: usize> Lifted<D> {
    /// The derivative of stress by the velocity gradient, in spatial axes.
    #[allow(
        clippy::inline_always,
        reason = "compiled for the instructions of the caller"
    )]
    #[inline(always)]
    pub fn tangent(&self) -> SpatialTangent<D> {
        SpatialTangent::from_principal(&self.frame, &self.normal, &self.shear)
    }

    /// Adds a mean stress that grows with the logarithm of the volume by `stiffness`: that of water in the pores
    /// \[stress\].
    #[inline]
    pub fn add_mean(&mut self, mean: f64, stiffness: f64) {
        for a in 0..3 {
            self.tau[a][a] += mean;
            for b in 0..3 {
                self.normal[a][b] += stiffness;
            }
        }
    }

    /// The elastic left Cauchy–Green tensor $`b_e = \exp(2\varepsilon_e)`$ to carry to the
    /// next step.
    pub fn b_e(&self) -> Tensor {
        elastic_left_cauchy_green::<D>(&self.eps_e, &self.frame)
    }
}

/// A trial elastic strain in its principal axes: the input of a law.
#[derive(Clone, Debug)]
pub struct TrialStrain {
    strain: Principal,
    frame: Tensor,
    is_finite: bool,
    axes: AxesLookedAt,
}

/// The principal axes that the direction of stress is read off, for laws whose strength goes by it (theory, eq. 120).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct AxesLookedAt {
    /// How many of the axes are looked at, the first ones: the last one of two dimensions is that across the plane.
    count: usize,
    /// The component of an axis that points upwards.
    vertical: usize,
}

impl AxesLookedAt {
    /// Those of a dimension, whose last component points upwards: in the plane the two axes in it, as in plane strain.
    pub const fn of_dimension<const D: usize>() -> Self {
        Self {
            count: if D == 2 { 2 } else { 3 },
            vertical: D - 1,
        }
    }

    /// Those of a body of revolution, whose axis around it counts as a level one; in space those of
    /// [`of_dimension`](Self::of_dimension).
    pub const fn with_hoop<const D: usize>() -> Self {
        Self {
            count: 3,
            vertical: D - 1,
        }
    }

    /// The history with the direction of principal stresses τ in their axes.
    #[inline]
    fn direct(
        self,
        law: &dyn ConstitutiveModel,
        history: History,
        (tau, frame): (&Principal, &Tensor),
    ) -> History {
        law.directed(history, tau, frame, (self.count, self.vertical))
    }
}

impl TrialStrain {
    /// $`\tfrac12\ln b`$ of a trial elastic left Cauchy–Green tensor, as [`lift_finite`] reads it.
    ///
    /// # Errors
    /// [`MaterialError::NonFinite`] or [`MaterialError::NotPositiveDefinite`] for a tensor that is no stretch.
    #[inline]
    pub fn finite<const D: usize>(b_e_trial: &Tensor) -> Result<Self, MaterialError> {
        let (strain, frame) = logarithmic::<D>(b_e_trial)?;
        Ok(Self {
            strain,
            frame,
            is_finite: true,
            axes: AxesLookedAt::of_dimension::<D>(),
        })
    }

    /// A small trial elastic strain tensor, as [`lift_small`] reads it.
    ///
    /// # Errors
    /// [`MaterialError::NonFinite`] for a strain that is not finite.
    #[inline]
    pub fn small<const D: usize>(eps_e_trial: &Tensor) -> Result<Self, MaterialError> {
        let (strain, frame) = principal_axes::<D>(eps_e_trial);
        if !strain.iter().all(|value| value.is_finite()) {
            return Err(MaterialError::NonFinite {
                quantity: "trial elastic strain",
            });
        }
        Ok(Self {
            strain,
            frame,
            is_finite: false,
            axes: AxesLookedAt::of_dimension::<D>(),
        })
    }

    /// The same in space that has another axis than the last one upwards.
    #[must_use]
    pub fn with_vertical(self, axis: usize) -> Self {
        let axes = AxesLookedAt {
            vertical: axis,
            ..self.axes
        };
        Self { axes, ..self }
    }

    /// The same with other axes to read the direction of stress off.
    #[inline]
    #[must_use]
    pub fn looked_at(self, axes: AxesLookedAt) -> Self {
        Self { axes, ..self }
    }

    /// The principal strains \[-\].
    #[inline]
    pub fn strain(&self) -> &Principal {
        &self.strain
    }

    /// The answer of a law at this strain, set into the axes.
    ///
    /// # Errors
    /// As [`ConstitutiveModel::elastic_strain`].
    #[inline]
    pub fn lift<const D: usize>(
        self,
        law: &dyn ConstitutiveModel,
        answer: &ReturnMap,
        kind: TangentKind,
    ) -> Result<Lifted<D>, MaterialError> {
        let axes = self.axes;
        let mut lifted = if self.is_finite {
            lift(law, answer, &self.strain, self.frame, kind, |x| {
                let share = if x == 0.0 { 1.0 } else { x / x.exp_m1() };
                [share, share + x]
            })
        } else {
            lift(law, answer, &self.strain, self.frame, kind, |_| [1.0; 2])
        }?;
        lifted.history = axes.direct(law, lifted.history, (&answer.tau, &lifted.frame));
        Ok(lifted)
    }
}

/// Finite strain: the law at the trial elastic left Cauchy–Green tensor `b_e_trial`.
///
/// `D = 1` is uniaxial strain and reads xx, yy and zz; `D = 2` is plane strain and reads xy too;
/// `D = 3` reads the upper triangle.
/// Strains are $`\tfrac12\ln b`$, accurate to the digits that b holds also near b = I.
///
/// # Errors
/// [`MaterialError::NonFinite`] or [`MaterialError::NotPositiveDefinite`] for a tensor that is no
/// stretch; whatever the law's return map reports.
pub fn lift_finite<const D: usize>(
    law: &dyn ConstitutiveModel,
    b_e_trial: &Tensor,
    history: &History,
    kind: TangentKind,
) -> Result<Lifted<D>, MaterialError> {
    let trial = TrialStrain::finite::<D>(b_e_trial)?;
    let answer = law.return_map(trial.strain(), history, &PointContext::STATIC)?;
    trial.lift(law, &answer, kind)
}

/// Small strain: the law at the trial elastic strain tensor `eps_e_trial`.
///
/// The tangent has the minor symmetries, so that only the symmetric part of the velocity gradient
/// counts. Components are read as in [`lift_finite`].
///
/// # Errors
/// [`MaterialError::NonFinite`] for a strain that is not finite; whatever the law's return map
/// reports.
pub fn lift_small<const D: usize>(
    law: &dyn ConstitutiveModel,
    eps_e_trial: &Tensor,
    history: &History,
    kind: TangentKind,
) -> Result<Lifted<D>, MaterialError> {
    let trial = TrialStrain::small::<D>(eps_e_trial)?;
    let answer = law.return_map(trial.strain(), history, &PointContext::STATIC)?;
    trial.lift(law, &answer, kind)
}

/// The elastic left Cauchy–Green tensor $`b_e = \exp(2\varepsilon_e)`$ with principal elastic
/// Hencky strains `eps_e` in the axes `frame`.
pub fn elastic_left_cauchy_green<const D: usize>(eps_e: &Principal, frame: &Tensor) -> Tensor {
    compose::<D>(&eps_e.map(|strain| (2.0 * strain).exp()), frame)
}

/// The elastic left Cauchy–Green tensor at which a law answers a stress τ \[stress\] without flow.
///
/// # Errors
/// As [`ConstitutiveModel::elastic_strain`].
pub fn elastic_left_cauchy_green_of<const D: usize>(
    law: &dyn ConstitutiveModel,
    tau: &Tensor,
    history: &History,
) -> Result<Tensor, MaterialError> {
    let (principal, frame) = principal_axes::<D>(tau);
    let strain = law.elastic_strain(&principal, history)?;
    Ok(elastic_left_cauchy_green::<D>(&strain, &frame))
}

/// The history of a law with the direction that a stress τ \[stress\] leaves for the next step ([`ConstitutiveModel::directed`]),
/// read off the `axes`.
pub fn directed_history<const D: usize>(
    law: &dyn ConstitutiveModel,
    tau: &Tensor,
    history: History,
    axes: AxesLookedAt,
) -> History {
    let (principal, frame) = principal_axes::<D>(tau);
    axes.direct(law, history, (&principal, &frame))
}

/// The Hencky strain $`\tfrac12\ln b`$ of a left Cauchy–Green tensor `b` (upper triangle).
///
/// # Errors
/// [`MaterialError::NonFinite`] or [`MaterialError::NotPositiveDefinite`].
pub fn logarithmic_strain(b: &Tensor) -> Result<Tensor, MaterialError> {
    let (strain, frame) = logarithmic::<3>(b)?;
    Ok(compose::<3>(&strain, &frame))
}

/// Principal values and axes of $`\tfrac12\ln b`$.
#[inline]
fn logarithmic<const D: usize>(b: &Tensor) -> Result<(Principal, Tensor), MaterialError> {
    let mut stretch = *b;
    for a in 0..3 {
        stretch[a][a] -= 1.0;
    }
    // Close to I the difference is exact and holds more digits than b itself.
    let close = stretch[..D]
        .iter()
        .all(|row| row[..D].iter().all(|entry| entry.abs() < 0.25))
        && stretch[2][2].abs() < 0.25;
    let (values, frame) = principal_axes::<D>(if close { &stretch } else { b });
    let strain = if close {
        values.map(f64::ln_1p)
    } else {
        values.map(f64::ln)
    };
    if strain.iter().all(|value| value.is_finite()) {
        return Ok((strain.map(|value| 0.5 * value), frame));
    }
    let eigenvalue = values.iter().copied().fold(f64::INFINITY, f64::min);
    if values.iter().all(|value| value.is_finite()) {
        Err(MaterialError::NotPositiveDefinite { eigenvalue })
    } else {
        Err(MaterialError::NonFinite {
            quantity: "trial elastic left Cauchy-Green tensor",
        })
    }
}

/// The law at the principal trial strains, set into their axes. `shares(x)` are the parts of the
/// secant modulus that answer to $`l_{ab}`$ and $`l_{ba}`$, where
/// $`x = 2(\varepsilon_a - \varepsilon_b)`$.
#[inline]
fn lift<const D: usize>(
    law: &dyn ConstitutiveModel,
    answer: &ReturnMap,
    strain: &Principal,
    frame: Tensor,
    kind: TangentKind,
    shares: impl Fn(f64) -> [f64; 2],
) -> Result<Lifted<D>, MaterialError> {
    let elastic = || law.elastic_stiffness(strain, &answer.history);
    let share = if answer.regime.is_plastic() {
        kind.elastic_share()
    } else {
        0.0
    };
    let normal = match kind {
        TangentKind::Elastic => elastic().tangent,
        TangentKind::Regularised { .. } if share > 0.0 => {
            let elastic = elastic().tangent;
            std::array::from_fn(|a| {
                std::array::from_fn(|b| {
                    (1.0 - share) * answer.tangent[a][b] + share * elastic[a][b]
                })
            })
        }
        TangentKind::Consistent | TangentKind::Regularised { .. } => answer.tangent,
    };
    let noise = stress_noise(law.stiffness_bound(), strain);
    let mut shear = [[0.0; 3]; 3];
    for a in 0..D {
        for b in 0..a {
            let x = 2.0 * (strain[a] - strain[b]);
            let [ab, ba] = shares(x);
            let consistent = secant(answer, [a, b], x, noise);
            (shear[a][b], shear[b][a]) = match kind {
                TangentKind::Consistent => (consistent * ab, consistent * ba),
                TangentKind::Regularised { .. } => {
                    let between = (1.0 - share) * consistent + share * elastic().shear;
                    (between * ab, between * ba)
                }
                TangentKind::Elastic => {
                    let elastic = elastic().shear;
                    let excess = if answer.regime.is_plastic() {
                        0.5 * (elastic - consistent) * (ba - ab)
                    } else {
                        0.0
                    };
                    (elastic * ab + excess, elastic * ba - excess)
                }
            };
        }
    }
    let eps_e = if answer.regime.is_plastic() || law.elasticity_follows_history() {
        law.elastic_strain(&answer.tau, &answer.history)?
    } else {
        *strain
    };
    Ok(Lifted {
        tau: compose::<D>(&answer.tau, &frame),
        eps_e,
        frame,
        delta_eps_p: answer.delta_eps_p,
        history: answer.history,
        regime: answer.regime,
        normal,
        shear,
    })
}

/// Secant modulus of shear $`(\tau_a - \tau_b)/x`$, or its limit for x → 0.
///
/// Where the two cannot be told apart by stresses that carry round-off `noise`, the limit is the
/// better one; where they can, however small x is, there is a kink of the yield surface between
/// the two principal values and the secant is right.
#[inline]
fn secant(answer: &ReturnMap, [a, b]: [usize; 2], x: f64, noise: f64) -> f64 {
    let (tau, d) = (&answer.tau, &answer.tangent);
    let delta_tau = tau[a] - tau[b];
    let limit = (d[a][a] - d[a][b] - d[b][a] + d[b][b]) / 4.0;
    if x == 0.0 || (delta_tau - limit * x).abs() <= noise {
        limit
    } else {
        delta_tau / x
    }
}

/// Round-off in a principal stress \[stress\].
#[inline]
fn stress_noise(elasticity: &Elasticity, strain: &Principal) -> f64 {
    let size = strain[0].abs() + strain[1].abs() + strain[2].abs();
    16.0 * f64::EPSILON * (elasticity.bulk() + 2.0 * elasticity.shear()) * size
}
