//! The memory of a law from step to step.

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

    /// This history of a law with the variables `of`, for soil that was of another law: each memory of the same name is as it was,
    /// the others stay.
    #[must_use]
    pub fn remembering(mut self, of: &[InternalVariable], before: &Remembered<'_>) -> Self {
        self.eps_p_eq = before.history.eps_p_eq;
        for (place, variable) in of.iter().enumerate() {
            if let Some(value) = before.value_of(variable) {
                self.internal[place] = value;
            }
        }
        self
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

/// The memory of soil as it comes to another law.
#[derive(Clone, Copy, Debug)]
pub struct Remembered<'a> {
    /// The variables of the law that it was of.
    pub variables: &'a [InternalVariable],
    /// Its history by that law.
    pub history: &'a History,
}

impl Remembered<'_> {
    /// The value that a variable of another law takes over; none: there is no memory of it.
    pub fn value_of(&self, variable: &InternalVariable) -> Option<f64> {
        let mut known = self.variables.iter();
        let place = known.position(|earlier| earlier.is_remembered_as(variable))?;
        Some(self.history.internal[place])
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
    /// Whether it is found anew from the stress after every step, and is no memory of earlier steps.
    pub follows_stress: bool,
}

impl InternalVariable {
    /// Whether soil that comes to another law keeps it: a memory of the same name and unit, whatever its law.
    pub fn is_remembered_as(&self, other: &Self) -> bool {
        let is_memory = !self.follows_stress && !other.follows_stress;
        is_memory && self.name == other.name && self.unit == other.unit
    }
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
