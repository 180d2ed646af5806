//! What a law remembers from step to step.

use crate::spectral::principal::{Principal, deviator, dot};

/// Most internal variables of a law.
pub const INTERNAL_VARIABLES: usize = 4;

/// The internal variables of a law.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct History {
    /// Accumulated plastic strain invariant $`\sum\sqrt{\tfrac23\,\Delta e_p:\Delta e_p}`$,
    /// with $`\Delta e_p`$ the deviatoric part of a step's plastic strain \[-\]. Never negative. Every law keeps it, for
    /// the record.
    pub eps_p_eq: f64,
    /// Internal variables of the law, in the order of [`ConstitutiveModel::internal_variables`](super::ConstitutiveModel::internal_variables); zero beyond.
    pub internal: [f64; INTERNAL_VARIABLES],
}

impl History {
    /// The history of soil with this plastic strain \[-\], and internal variables of zero.
    pub const fn of_plastic_strain(eps_p_eq: f64) -> Self {
        Self {
            eps_p_eq,
            internal: [0.0; INTERNAL_VARIABLES],
        }
    }

    /// The history after a further plastic strain increment; internal variables stay.
    #[must_use]
    pub fn after(&self, delta_eps_p: &Principal) -> Self {
        let deviatoric = deviator(delta_eps_p);
        Self {
            eps_p_eq: self.eps_p_eq + (2.0 / 3.0 * dot(&deviatoric, &deviatoric)).sqrt(),
            internal: self.internal,
        }
    }
}

/// An internal variable of a law.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct InternalVariable {
    /// Name, as results print it.
    pub name: &'static str,
    /// Unit, as results print it.
    pub unit: &'static str,
    /// How it goes with the ratios of soil that varies in space.
    pub scaling: Scaling,
}

/// How a number of a law goes with the ratios of strength s and of stiffness e of a piece of soil ([`Ratios`](crate::Ratios)).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scaling {
    /// Not at all: an angle, a void ratio, a plastic strain that curves are stated over.
    Constant,
    /// With s: a stress, such as a preconsolidation pressure.
    Stress,
    /// With s/e: a strain.
    Strain,
}
