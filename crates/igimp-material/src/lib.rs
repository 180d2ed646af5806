//! Constitutive laws in principal space, and the spectral lift that makes tensor laws of them.
//!
//! A law is a pure function from principal trial strain to stress, tangent and plastic strain:
//! [`ConstitutiveModel`]. [`lift_finite`] and [`lift_small`] set it into spatial axes.
//! The crate knows nothing of grids, particles, load steps or files.
//!
//! | module story | types |
//! |---|---|
//! | linear Hencky elasticity | [`Elasticity`] |
//! | the seam | [`ConstitutiveModel`], [`ReturnMap`], [`History`], [`Regime`] |
//! | laws | [`HenckyElastic`], [`VonMises`], [`Tresca`], [`MohrCoulomb`] |
//! | from principal space to tensors | [`lift_finite`], [`lift_small`], [`Lifted`], [`SpatialTangent`] |
//! | what can go wrong | [`MaterialError`] |
//!
//! Tension and extension are positive. Stress is Kirchhoff stress τ and strain the elastic Hencky
//! strain; with small strain read Cauchy stress and linear strain.

mod eigen;
mod elasticity;
mod error;
mod hencky;
mod koiter;
mod law;
mod lift;
mod mohr_coulomb;
mod principal;
mod pyramid;
mod spatial;
mod tresca;
mod von_mises;

pub use elasticity::Elasticity;
pub use error::MaterialError;
pub use hencky::HenckyElastic;
pub use law::{ConstitutiveModel, History, Regime, ReturnMap};
pub use lift::{Lifted, TangentKind, lift_finite, lift_small, logarithmic_strain};
pub use mohr_coulomb::MohrCoulomb;
pub use principal::{Principal, Tensor};
pub use spatial::SpatialTangent;
pub use tresca::Tresca;
pub use von_mises::VonMises;
