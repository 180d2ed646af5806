//! The switches of the method: basis, B-bar, kinematics, domain update, small cuts.

use std::sync::Arc;

use igimp_shape::{Basis, Gimp, Linear};

/// How strain is measured over a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kinematics {
    /// Hencky strain from b_e, Kirchhoff stress, exact under rotation (theory, eq. 12–18).
    FiniteStrain,
    /// The small-strain B̄ matrix over a step; stress is rotated when the step is committed (theory,
    /// eqs. 9 to 11 and 11a).
    SmallStrain,
}

/// How a particle's domain follows the deformation gradient F = R U (theory, eq. 29).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DomainUpdate {
    /// The half-lengths stay as seeded.
    Fixed,
    /// `l_d = F_dd l_d0`.
    DiagonalF,
    /// `l_d = U_dd l_d0`: free of rotation (the default).
    DiagonalU,
    /// `l_d = (det F)^(1/D) l_d0`.
    RootJ,
}

/// What is done about nodes that a body only touches at a corner (theory, "small cuts").
///
/// A node is a small cut when Σ S V is below a fraction of its cell's volume. Left alone, such
/// nodes make the system singular to working precision.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SmallCuts {
    /// Fraction of a cell's volume below which a node is a small cut \[-\]; 0 switches off.
    pub below: f64,
    /// What happens to a small cut.
    pub remedy: Remedy,
    /// Ghost penalty γ on faces of boundary cells \[-\]; 0 switches it off.
    pub ghost_penalty: f64,
}

/// What happens to a node that is a small cut.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Remedy {
    /// It moves with the nearest node that carries enough soil: a rigid translation causes no
    /// strain, whatever its size (the default).
    Tie,
    /// Its displacement is zero. In stiff soil that moves far in a step, the sliver of soil
    /// beyond resists.
    Drop,
}

impl Default for SmallCuts {
    fn default() -> Self {
        Self {
            below: 1e-4,
            remedy: Remedy::Tie,
            ghost_penalty: 0.0,
        }
    }
}

/// The method: which of the paper's variants is computed, and how.
#[derive(Clone, Debug)]
pub struct Method {
    /// Grid basis as a particle sees it: [`Linear`] is the plain material point method (iMPM),
    /// [`Gimp`] the generalised interpolation one (iGIMP).
    pub basis: Arc<dyn Basis>,
    /// Volumetric-locking control: dilatation from the cell-averaged centre gradient.
    pub bbar: bool,
    /// Strain measure.
    pub kinematics: Kinematics,
    /// Update of the particle domains.
    pub domain_update: DomainUpdate,
    /// Treatment of small cuts.
    pub small_cuts: SmallCuts,
}

impl Method {
    fn with(basis: Arc<dyn Basis>, bbar: bool) -> Self {
        Self {
            basis,
            bbar,
            kinematics: Kinematics::FiniteStrain,
            domain_update: DomainUpdate::DiagonalU,
            small_cuts: SmallCuts::default(),
        }
    }

    /// Plain implicit material point method.
    pub fn impm() -> Self {
        Self::with(Arc::new(Linear), false)
    }

    /// Implicit material point method with B-bar.
    pub fn impm_bbar() -> Self {
        Self::with(Arc::new(Linear), true)
    }

    /// Implicit generalised interpolation material point method.
    pub fn igimp() -> Self {
        Self::with(Arc::new(Gimp), false)
    }

    /// Implicit generalised interpolation material point method with B-bar (the default).
    pub fn igimp_bbar() -> Self {
        Self::with(Arc::new(Gimp), true)
    }

    /// The variant's name as the paper writes it, such as `iGIMP + B-bar`.
    pub fn label(&self) -> String {
        let basis = if self.basis.name() == "linear" {
            "iMPM"
        } else {
            "iGIMP"
        };
        if self.bbar {
            format!("{basis} + B-bar")
        } else {
            basis.to_owned()
        }
    }
}

impl Default for Method {
    fn default() -> Self {
        Self::igimp_bbar()
    }
}
