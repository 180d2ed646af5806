//! From nodal step displacements to stress at one particle: the two kinematics, each with the
//! cell-averaged dilatation of B-bar.
//!
//! Finite strain (theory, eq. 12–15):
//!
//! ```math
//! \Delta F = I + \sum_i u_i \otimes \nabla S_i,\quad
//! \Delta F_c = I + \sum_i u_i \otimes \nabla \bar S_i,\quad
//! \lambda = (\det\Delta F_c / \det\Delta F)^{1/3},\quad
//! b_e^{tr} = \lambda^2\, \Delta F\, b_e\, \Delta F^T
//! ```
//!
//! with the power 1/3 and the factor λ in zz also in plane strain. Small strain (theory, eq. 9):
//! the symmetric gradient plus a third of the difference of the two divergences on xx, yy and zz.

use igimp_material::{
    ConstitutiveModel, History, Lifted, MaterialError, Principal, Regime, ReturnMap, TangentKind,
    Tensor, TrialStrain, elastic_left_cauchy_green, logarithmic_strain,
};
use igimp_shape::Support;

use crate::contributions::nonlocal::SpatialRates;
use crate::contributions::pore_water::PoreResponse;
use crate::error::AssemblyError;
use crate::method::{Geometry, Kinematics, Method};
use crate::step::hoops::Hoop;
use igimp_shape::matrices::{congruence, determinant, identity, inverse};

/// An elastic Hencky strain beyond this makes b_e = exp(2 ε_e) leave the floating-point numbers \[-\].
const LARGEST_STRAIN: f64 = 300.0;

/// A particle at a trial displacement: never committed by itself.
#[derive(Clone, Debug, PartialEq)]
pub struct ParticleTrial<const D: usize> {
    /// ΔF, the deformation gradient of the step \[-\].
    pub delta_def_grad: [[f64; D]; D],
    /// Kirchhoff stress τ (Cauchy stress in small strain) that the law answers \[force/length²\], tension positive.
    pub tau: Tensor,
    /// Principal elastic Hencky strain after the return \[-\], extension positive.
    pub eps_e: Principal,
    /// Principal axes: `frame[a]` is the unit vector of principal value `a`.
    pub frame: Tensor,
    /// Principal plastic strain increment of the step, in the same axes \[-\], extension positive.
    pub delta_eps_p: Principal,
    /// History of the law.
    pub history: History,
    /// Where on the yield surface the stress is.
    pub regime: Regime,
    /// Excess pore pressure, in the stress that τ is in; compression positive \[force/length²\].
    pub excess: f64,
}

impl<const D: usize> ParticleTrial<D> {
    /// A particle at rest without stress: its state before the first evaluation.
    pub(crate) fn at_rest() -> Self {
        Self {
            delta_def_grad: identity(),
            tau: [[0.0; 3]; 3],
            eps_e: [0.0; 3],
            frame: identity(),
            delta_eps_p: [0.0; 3],
            history: History::default(),
            regime: Regime::Elastic,
            excess: 0.0,
        }
    }

    /// The elastic left Cauchy–Green tensor to carry to the next step.
    pub fn b_e(&self) -> Tensor {
        elastic_left_cauchy_green::<D>(&self.eps_e, &self.frame)
    }
}

/// Data for the linearisation of a particle beside its stress.
#[derive(Clone, Debug)]
pub(crate) struct Linearisation<const D: usize> {
    /// ΔF⁻¹; the identity in small strain, where gradients are not pushed forward.
    pub(crate) push: [[f64; D]; D],
    /// ΔF_c⁻¹ of the cell-averaged gradient; the identity in small strain.
    pub(crate) push_bar: [[f64; D]; D],
    /// Stress and tangent in spatial axes, those of the water in the pores included.
    pub(crate) lifted: Lifted<D>,
    /// Its plastic strain and the rates of that, where strength sees that.
    pub(crate) nonlocal: Option<SpatialRates<D>>,
}

/// The state of a particle at the start of a step.
#[derive(Clone, Copy)]
pub(crate) struct ParticleState<'a> {
    pub(crate) particle: usize,
    pub(crate) b_e: &'a Tensor,
    pub(crate) pores: PoreResponse,
}

/// How a particle is strained at nodal step displacements: the strain for its law, and data for its linearisation.
pub(crate) struct Straining<const D: usize> {
    delta_def_grad: [[f64; D]; D],
    /// As [`Linearisation::push`] and [`Linearisation::push_bar`].
    push: [[f64; D]; D],
    push_bar: [[f64; D]; D],
    /// Logarithm of the ratio of volumes, where pore water asks for it.
    ln_volume: f64,
    strain: TrialStrain,
}

impl<const D: usize> Straining<D> {
    /// The principal trial strains \[-\].
    pub(crate) fn principal(&self) -> &Principal {
        self.strain.strain()
    }
}

/// Strains one particle by nodal step displacements `u`.
#[inline]
pub(crate) fn strained<const D: usize>(
    state: ParticleState<'_>,
    (supports, hoops): (&[Support<D>], &[Hoop]),
    u: &[[f64; D]],
    method: &Method,
) -> Result<Straining<D>, AssemblyError> {
    let particle = state.particle;
    let gradients = Gradients::of((supports, hoops), u);
    let mut delta_def_grad = gradients.grad;
    let mut delta_bar = gradients.bar;
    let around = gradients.hoop.map(|hoop| Hoop::UNSTRETCHED.plus(1.0, hoop));
    for a in 0..D {
        delta_def_grad[a][a] += 1.0;
        delta_bar[a][a] += 1.0;
    }
    let material = |source| AssemblyError::Material { particle, source };
    if method.geometry == Geometry::Moving {
        positive(particle, determinant(&delta_def_grad))?;
        if let Some(hoop) = around {
            positive(particle, hoop.value)?;
        }
    }
    let axes = method.section.axes_looked_at::<D>();
    let mut ln_volume = 0.0;
    Ok(match method.kinematics_of_step() {
        Kinematics::FiniteStrain => {
            let det = determinant(&delta_def_grad);
            let det_bar = positive(particle, determinant(&delta_bar))?;
            let (mut ratio, mut ratio_bar) = (det, det_bar);
            if let Some(hoop) = around {
                ratio_bar *= positive(particle, hoop.bar)?;
                ratio *= hoop.value;
            }
            let lambda = (ratio_bar / ratio).cbrt();
            if state.pores.asks_for_volume() {
                ln_volume = ratio_bar.ln();
            }
            let mut b_trial = pushed_forward(state.b_e, &delta_def_grad, lambda * lambda);
            if let Some(hoop) = around {
                b_trial[2][2] *= hoop.value * hoop.value;
            }
            Straining {
                delta_def_grad,
                push: inverse(&delta_def_grad, det),
                push_bar: inverse(&delta_bar, det_bar),
                ln_volume,
                strain: (TrialStrain::finite::<D>(&b_trial).map_err(material)?).looked_at(axes),
            }
        }
        Kinematics::SmallStrain => {
            let mut strain = logarithmic_strain(state.b_e).map_err(material)?;
            gradients.add_small_strain(&mut strain);
            ln_volume = gradients.dilation();
            Straining {
                delta_def_grad,
                push: identity(),
                push_bar: identity(),
                ln_volume,
                strain: (TrialStrain::small::<D>(&strain).map_err(material)?).looked_at(axes),
            }
        }
    })
}

/// The answer of the law of a particle at its strain, with its linearisation; writes its `trial`.
#[inline]
pub(crate) fn answered<const D: usize>(
    state: ParticleState<'_>,
    straining: Straining<D>,
    law: &dyn ConstitutiveModel,
    answer: &ReturnMap,
    (kind, kinematics): (TangentKind, Kinematics),
    trial: &mut ParticleTrial<D>,
) -> Result<Linearisation<D>, AssemblyError> {
    let particle = state.particle;
    let material = |source| AssemblyError::Material { particle, source };
    let (excess, stiffness) = state.pores.excess_after(straining.ln_volume, kinematics);
    let lifted = straining.strain.lift(law, answer, kind).map_err(material)?;
    finite(&lifted).map_err(material)?;
    if let Some(&strain) = lifted.eps_e.iter().find(|eps| eps.abs() >= LARGEST_STRAIN) {
        return Err(AssemblyError::Overstrained { particle, strain });
    }
    *trial = ParticleTrial {
        delta_def_grad: straining.delta_def_grad,
        tau: lifted.tau,
        eps_e: lifted.eps_e,
        frame: lifted.frame,
        delta_eps_p: lifted.delta_eps_p,
        history: lifted.history,
        regime: lifted.regime,
        excess,
    };
    let mut linearisation = Linearisation {
        push: straining.push,
        push_bar: straining.push_bar,
        lifted,
        nonlocal: None,
    };
    if !state.pores.is_none() {
        let mean = state.pores.given - trial.excess;
        linearisation.lifted.add_mean(mean, stiffness);
    }
    Ok(linearisation)
}

/// Gradients of nodal step displacements at a particle \[-\].
pub(crate) struct Gradients<const D: usize> {
    /// Its own.
    pub(crate) grad: [[f64; D]; D],
    /// The cell-averaged one.
    pub(crate) bar: [[f64; D]; D],
    /// Strain around the axis u_r/r, both of them; none unless the section is axisymmetric.
    pub(crate) hoop: Option<Hoop>,
}

impl<const D: usize> Gradients<D> {
    /// Those of displacements `u` \[length\].
    #[inline]
    pub(crate) fn of((supports, hoops): (&[Support<D>], &[Hoop]), u: &[[f64; D]]) -> Self {
        let mut grad = [[0.0; D]; D];
        let mut bar = [[0.0; D]; D];
        for support in supports {
            let displacement = &u[support.node];
            for a in 0..D {
                for b in 0..D {
                    grad[a][b] += displacement[a] * support.grad[b];
                    bar[a][b] += displacement[a] * support.grad_bar[b];
                }
            }
        }
        let hoop = (!hoops.is_empty()).then(|| Hoop::strain(supports, hoops, u));
        Self { grad, bar, hoop }
    }

    /// The cell-averaged dilatation, in small strain.
    #[inline]
    pub(crate) fn dilation(&self) -> f64 {
        let in_plane = (0..D).fold(0.0, |sum, a| sum + self.bar[a][a]);
        self.hoop.map_or(in_plane, |hoop| in_plane + hoop.bar)
    }

    /// Adds the small strain of the step, with the cell-averaged dilatation (theory, eqs. 9 and 130c) \[-\].
    #[inline]
    pub(crate) fn add_small_strain(&self, strain: &mut Tensor) {
        let Self { grad, bar, hoop } = self;
        let mut difference = 0.0;
        for a in 0..D {
            difference += bar[a][a] - grad[a][a];
            for b in 0..D {
                strain[a][b] += 0.5 * (grad[a][b] + grad[b][a]);
            }
        }
        if let Some(hoop) = hoop {
            strain[2][2] += hoop.value;
            difference += hoop.bar - hoop.value;
        }
        for a in 0..3 {
            strain[a][a] += difference / 3.0;
        }
    }
}

/// The trial tensor λ² ΔF b ΔFᵀ, with λ² b_zz out of plane.
#[inline]
fn pushed_forward<const D: usize>(
    b: &Tensor,
    delta_def_grad: &[[f64; D]; D],
    lambda2: f64,
) -> Tensor {
    let mut in_plane = [[0.0; D]; D];
    for a in 0..D {
        in_plane[a].copy_from_slice(&b[a][..D]);
    }
    let pushed = congruence(delta_def_grad, &in_plane);
    let mut out = [[0.0; 3]; 3];
    for a in 0..3 {
        for c in 0..3 {
            out[a][c] = lambda2
                * if a < D && c < D {
                    pushed[a][c]
                } else {
                    b[a][c]
                };
        }
    }
    out
}

/// Answers of laws are checked here, for any law, so that the particle can be named.
#[inline]
fn finite<const D: usize>(lifted: &Lifted<D>) -> Result<(), MaterialError> {
    let quantity = if !lifted.tau.iter().flatten().all(|tau| tau.is_finite()) {
        "stress"
    } else if !lifted.eps_e.iter().all(|eps| eps.is_finite()) {
        "elastic strain"
    } else if !lifted.history.eps_p_eq.is_finite() {
        "accumulated plastic strain"
    } else {
        return Ok(());
    };
    Err(MaterialError::NonFinite { quantity })
}

#[inline]
fn positive(particle: usize, determinant: f64) -> Result<f64, AssemblyError> {
    if determinant > 0.0 && determinant.is_finite() {
        Ok(determinant)
    } else {
        Err(AssemblyError::Inverted {
            particle,
            determinant,
        })
    }
}
