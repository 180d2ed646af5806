//! The data of a point and its step for a law, and the answer.

use super::history::History;
use crate::Elasticity;
use crate::spectral::principal::Principal;

/// The part of the yield surface that a stress was returned to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Regime {
    /// Inside the yield surface, or on it to within round-off: nothing was returned.
    Elastic,
    /// The smooth part: the von Mises cylinder, the Drucker–Prager cone, or the main plane of Tresca and Mohr–Coulomb.
    Smooth,
    /// The edge where the two larger principal stresses are equal.
    RightEdge,
    /// The edge where the two smaller principal stresses are equal.
    LeftEdge,
    /// The apex of the Mohr–Coulomb pyramid or the Drucker–Prager cone.
    Apex,
    /// The plane of the tension cut-off, largest principal stress = $`\sigma_t`$.
    Tension,
    /// The edge between the Mohr–Coulomb plane and the plane of the tension cut-off.
    TensionShear,
    /// The edge where the two larger principal stresses are $`\sigma_t`$.
    TensionEdge,
    /// An end of the edge between Mohr–Coulomb and cut-off, where two stresses are equal.
    TensionCorner,
    /// All three principal stresses are $`\sigma_t`$.
    TensionApex,
    /// The cap of soil that hardens in compression.
    Cap,
    /// The cap and the surface of shear together.
    CapShear,
}

impl Regime {
    /// Every regime at the place of its code.
    const BY_CODE: [Self; 12] = [
        Self::Elastic,
        Self::Smooth,
        Self::RightEdge,
        Self::LeftEdge,
        Self::Apex,
        Self::Tension,
        Self::TensionShear,
        Self::TensionEdge,
        Self::TensionCorner,
        Self::TensionApex,
        Self::Cap,
        Self::CapShear,
    ];

    /// The number of the regime, the same in every file and every version: 0 elastic, 1 smooth part, 2 right edge,
    /// 3 left edge, 4 apex, 5 tension plane, 6 tension–shear edge, 7 tension edge, 8 tension corner, 9 tension apex, 10 cap,
    /// 11 cap and shear.
    pub fn code(self) -> u8 {
        self as u8
    }

    /// The regime of a number, if there is one.
    pub fn from_code(code: u8) -> Option<Self> {
        Self::BY_CODE.get(usize::from(code)).copied()
    }

    /// Whether there was plastic flow.
    pub fn is_plastic(self) -> bool {
        self != Self::Elastic
    }
}

/// How the strength of a law sees plastic strain beside its own point: by the over-nonlocal measure
/// $`m \bar\kappa + (1 - m) \kappa`$ of an implicit gradient (theory, eqs. 110a and 110b).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nonlocal {
    /// Length l over which plastic strain is spread \[length\]. Positive.
    pub length: f64,
    /// Share m of the nonlocal strain \[-\]. Above 1 bands of shear have a width; with 1 they have none.
    pub over_nonlocal: f64,
}

/// Rates of plastic strain and nonlocal strain by each other at a point, at the end of a step.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct NonlocalRates {
    /// Plastic strain of the step Δκ, that of the soil as nonlocal strain is \[-\].
    pub plastic: f64,
    /// Its derivative by the principal trial strains \[-\].
    pub plastic_by_strain: Principal,
    /// Its derivative by the nonlocal strain \[-\].
    pub plastic_by_nonlocal: f64,
    /// The derivative of the principal stresses τ by the nonlocal strain \[stress\].
    pub stress_by_nonlocal: Principal,
}

impl NonlocalRates {
    /// Those of a strength that goes with nothing beside its point.
    pub const NONE: Self = Self {
        plastic: 0.0,
        plastic_by_strain: [0.0; 3],
        plastic_by_nonlocal: 0.0,
        stress_by_nonlocal: [0.0; 3],
    };
}

/// The data of a point and of its step for a law, beside strain and history.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointContext {
    /// Duration of the step \[time\], zero in statics: for strength that goes with the rate of strain.
    pub duration: f64,
    /// Rise of the nonlocal strain over the step \[-\]: for strength that goes with the plastic strain of the ground around.
    pub nonlocal_rise: f64,
    /// Strains that the law is asked at over those of the soil \[-\], e/s of soil that varies in space (theory, eq. 19b); 1 where it
    /// is as its material. Of a strength that goes with a stated plastic strain, κ is that of the soil.
    pub strain_ratio: f64,
}

impl PointContext {
    /// A point in statics, with nothing around it that flows.
    pub const STATIC: Self = Self {
        duration: 0.0,
        nonlocal_rise: 0.0,
        strain_ratio: 1.0,
    };

    /// A point in a step of a duration \[time\].
    pub const fn over(duration: f64) -> Self {
        Self {
            duration,
            ..Self::STATIC
        }
    }
}

/// The answer of a law to a trial strain, in the order of its principal values.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReturnMap {
    /// Principal Kirchhoff stress τ \[stress\], tension positive, admissible.
    pub tau: Principal,
    /// Consistent tangent $`D_{ab} = \partial\tau_a/\partial\varepsilon_b^{tr}`$ \[stress\],
    /// taken within the regime.
    pub tangent: [[f64; 3]; 3],
    /// Plastic strain increment $`\Delta\varepsilon_p = C^{-1}(\tau^{tr} - \tau)`$ \[-\], extension positive.
    pub delta_eps_p: Principal,
    /// History at the end of the increment.
    pub history: History,
    /// Where on the yield surface the stress is.
    pub regime: Regime,
    /// Rates of plastic and nonlocal strain by each other; zero where strength does not see the ground around.
    pub nonlocal: NonlocalRates,
}

impl ReturnMap {
    /// A stress that needed no return.
    pub(crate) fn elastic(elasticity: &Elasticity, tau: Principal, history: History) -> Self {
        Self {
            tau,
            tangent: elasticity.tangent(),
            delta_eps_p: [0.0; 3],
            history,
            regime: Regime::Elastic,
            nonlocal: NonlocalRates::NONE,
        }
    }
}
