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
    ConstitutiveModel, History, Lifted, MaterialError, TangentKind, Tensor, lift_finite,
    lift_small, logarithmic_strain,
};
use igimp_shape::Support;

use crate::error::AssemblyError;
use crate::method::Kinematics;
use crate::small::{congruence, determinant, identity, inverse};

/// A particle at a trial displacement: never committed by itself.
#[derive(Clone, Debug)]
pub struct ParticleTrial<const D: usize> {
    /// ΔF, the deformation gradient of the step.
    pub delta_def_grad: [[f64; D]; D],
    /// ΔF⁻¹; the identity in small strain, where gradients are not pushed forward.
    pub(crate) push: [[f64; D]; D],
    /// ΔF_c⁻¹ of the cell-averaged gradient; the identity in small strain.
    pub(crate) push_bar: [[f64; D]; D],
    /// Stress (Kirchhoff in finite strain, Cauchy in small), tangent and elastic strain.
    pub lifted: Lifted<D>,
}

/// Evaluates one particle at nodal step displacements `u`.
pub(crate) fn evaluate<const D: usize>(
    particle: usize,
    supports: &[Support<D>],
    u: &[[f64; D]],
    (b_e, history): (&Tensor, &History),
    law: &dyn ConstitutiveModel,
    kinematics: Kinematics,
    kind: TangentKind,
) -> Result<ParticleTrial<D>, AssemblyError> {
    let mut gradient = [[0.0; D]; D];
    let mut gradient_bar = [[0.0; D]; D];
    for support in supports {
        let displacement = &u[support.node];
        for a in 0..D {
            for b in 0..D {
                gradient[a][b] += displacement[a] * support.grad[b];
                gradient_bar[a][b] += displacement[a] * support.grad_bar[b];
            }
        }
    }
    let mut delta_def_grad = gradient;
    let mut delta_bar = gradient_bar;
    for a in 0..D {
        delta_def_grad[a][a] += 1.0;
        delta_bar[a][a] += 1.0;
    }
    let det = positive(particle, determinant(&delta_def_grad))?;
    let material = |source| AssemblyError::Material { particle, source };
    match kinematics {
        Kinematics::FiniteStrain => {
            let det_bar = positive(particle, determinant(&delta_bar))?;
            let lambda2 = (det_bar / det).cbrt().powi(2);
            let trial = pushed_forward(b_e, &delta_def_grad, lambda2);
            let lifted = lift_finite(law, &trial, history, kind).map_err(material)?;
            finite(&lifted).map_err(material)?;
            Ok(ParticleTrial {
                push: inverse(&delta_def_grad, det),
                push_bar: inverse(&delta_bar, det_bar),
                lifted,
                delta_def_grad,
            })
        }
        Kinematics::SmallStrain => {
            let mut trial = logarithmic_strain(b_e).map_err(material)?;
            let mut difference = 0.0;
            for a in 0..D {
                difference += gradient_bar[a][a] - gradient[a][a];
                for b in 0..D {
                    trial[a][b] += 0.5 * (gradient[a][b] + gradient[b][a]);
                }
            }
            for a in 0..3 {
                trial[a][a] += difference / 3.0;
            }
            let lifted = lift_small(law, &trial, history, kind).map_err(material)?;
            finite(&lifted).map_err(material)?;
            Ok(ParticleTrial {
                push: identity(),
                push_bar: identity(),
                lifted,
                delta_def_grad,
            })
        }
    }
}

/// The trial tensor λ² ΔF b ΔFᵀ, with λ² b_zz out of plane.
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

/// What a law answers is checked here, whatever law it is, so that the particle can be named.
fn finite<const D: usize>(lifted: &Lifted<D>) -> Result<(), MaterialError> {
    if lifted.tau.iter().flatten().all(|tau| tau.is_finite()) {
        Ok(())
    } else {
        Err(MaterialError::NonFinite { quantity: "stress" })
    }
}

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
