//! Constitutive laws in principal space, and the spectral lift that makes tensor laws of them.
//!
//! A law is a pure function from principal trial strain to stress, tangent and plastic strain:
//! [`ConstitutiveModel`]. [`lift_finite`] and [`lift_small`] set it into spatial axes.
//! The crate knows nothing of grids, particles, load steps or files.
//!
//! | module story | types |
//! |---|---|
//! | linear Hencky elasticity | [`Elasticity`] |
//! | the seam | [`ConstitutiveModel`], [`PointContext`], [`ReturnMap`], [`History`], [`Remembered`], [`Regime`] |
//! | strength and its reduction | [`Strength`], [`ShearStrength`], [`Dissipation`] |
//! | laws | [`HenckyElastic`], [`VonMises`], [`Tresca`], [`MohrCoulomb`], [`DruckerPrager`], [`HoekBrown`], [`ModifiedCamClay`], [`HardeningSoil`] |
//! | laws whose strength goes with plastic strain, the direction of stress, the rate of strain | [`Softening`], [`Curve`], [`Directions`], [`RateEffect`]; [`InertialFriction`] |
//! | soil whose strength and stiffness vary | [`Ratios`], [`ScaledLaw`] |
//! | from principal space to tensors | [`lift_finite`], [`lift_small`], [`Lifted`], [`SpatialTangent`] |
//! | errors | [`MaterialError`] |
//!
//! Tension and extension are positive. Stress is Kirchhoff stress τ and strain the elastic Hencky
//! strain; with small strain read Cauchy stress and linear strain. Angles are in radians.
//!
//! # Example
//!
//! Simple shear in plane strain, far beyond yield: von Mises flows at the shear stress $`c_u`$.
//!
//! ```
//! use igimp_material::{Elasticity, History, TangentKind, VonMises, lift_finite};
//!
//! let law = VonMises::from_undrained_strength(Elasticity::new(100.0, 0.3)?, 1.0)?;
//! let gamma = 0.2;
//! let b_e_trial = [[1.0 + gamma * gamma, gamma, 0.0], [gamma, 1.0, 0.0], [0.0, 0.0, 1.0]];
//! let lifted =
//!     lift_finite::<2>(&law, &b_e_trial, &History::default(), TangentKind::Consistent)?;
//!
//! let [[xx, xy, _], [_, yy, _], _] = lifted.tau;
//! let largest_shear = (0.25 * (xx - yy).powi(2) + xy * xy).sqrt();
//! assert!((largest_shear - 1.0).abs() < 1e-12);
//! assert!(lifted.regime.is_plastic() && lifted.history.eps_p_eq > 0.0);
//! let b_e = lifted.b_e(); // the start of the next step
//! assert!((b_e[2][2] - 1.0).abs() < 1e-12);
//! # Ok::<(), igimp_material::MaterialError>(())
//! ```
//!
//! # A new law
//!
//! One file with an implementation of [`ConstitutiveModel`] and [`Strength`], and its lines in the catalogue of
//! `tests/contract`, which tries every law on a million trial states.
//!
//! # Sources
//!
//! - E. A. de Souza Neto, D. Perić, D. R. J. Owen (2008), *Computational Methods for Plasticity*,
//!   Wiley: return maps, Hencky elasticity, isotropic tensor functions.
//! - J. Clausen, L. Damkilde, L. Andersen (2006), *Efficient return algorithms for associated
//!   plasticity with multiple yield planes*, Int. J. Numer. Meth. Engng 66, 1036–1059: planes,
//!   edges and vertices in principal space.
//! - W. T. Koiter (1953), *Stress–strain relations, uniqueness and variational theorems for
//!   elastic-plastic materials with a singular yield surface*, Q. Appl. Math. 11, 350–354.

mod cam_clay;
mod circle;
mod drucker_prager;
mod elasticity;
mod error;
mod hardening_soil;
mod hencky;
mod hoek_brown;
mod inertial_friction;
mod koiter;
mod law;
mod mohr_coulomb;
mod pyramid;
mod scaled;
mod softening;
mod spectral;
mod surface;
mod tresca;
mod von_mises;

pub use cam_clay::{CamClayParameters, ModifiedCamClay, ShearStiffness};
pub use drucker_prager::{Cone, DruckerPrager};
pub use elasticity::Elasticity;
pub use error::MaterialError;
pub use hardening_soil::{HardeningSoil, HardeningSoilParameters};
pub use hencky::HenckyElastic;
pub use hoek_brown::{HoekBrown, HoekBrownParameters};
pub use inertial_friction::InertialFriction;
pub use law::{
    Batches, ConstitutiveModel, Dissipation, ElasticStiffness, History, INTERNAL_VARIABLES,
    InternalVariable, Nonlocal, NonlocalRates, PointContext, Regime, Remembered, ReturnMap,
    Scaling, ShearStrength, Strength,
};
pub use mohr_coulomb::MohrCoulomb;
pub use scaled::{Ratios, ScaledLaw};
pub use softening::{Curve, Decay, Directions, FrictionalCurves, RateEffect, Softening};
pub use spectral::eigen::principal_values;
pub use spectral::lift::{
    AxesLookedAt, Lifted, TangentKind, TrialStrain, directed_history, elastic_left_cauchy_green,
    elastic_left_cauchy_green_of, lift_finite, lift_small, logarithmic_strain,
};
pub use spectral::principal::{Principal, Tensor};
pub use spectral::spatial::SpatialTangent;
pub use tresca::Tresca;
pub use von_mises::VonMises;
