//! Water that flows out of soil while a step takes time (theory, eqs. 97 to 104).

use crate::conditions::water::PoreStiffness;
use crate::error::AssemblyError;

/// Flow of the water in a soil during a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PoreFlow<const D: usize> {
    /// It comes and goes at once: there is no excess pore pressure.
    Drained,
    /// It stays.
    Sealed,
    /// It flows.
    Flows(Permeable<D>),
}

/// Soil that water flows through.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Permeable<const D: usize> {
    /// Permeability over the unit weight of water, k/γ_w \[length⁴/(force·time)\].
    pub mobility: [[f64; D]; D],
    /// Bulk modulus of the water over the porosity, K_w/n; infinite where water does not give way.
    pub stiffness: PoreStiffness,
    /// How permeability follows the volume of the pores; none: it stays.
    pub follows: Option<VoidLaw>,
}

/// How permeability follows the void ratio e = (1 + e₀) J − 1 (theory, eq. 103).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VoidLaw {
    /// Void ratio e₀ at the start \[-\].
    pub initial: f64,
    /// C_k of log₁₀(k/k₀) = (e − e₀)/C_k \[-\]; none: Kozeny and Carman, k ~ e³/(1 + e).
    pub index: Option<f64>,
}

/// A void ratio below this is none \[-\].
const LEAST_VOID_RATIO: f64 = 1e-3;

impl VoidLaw {
    /// The permeability over that at the start, where the volume is `stretch` times that at the start \[-\].
    pub fn share(&self, stretch: f64) -> f64 {
        let void = ((1.0 + self.initial) * stretch - 1.0).max(LEAST_VOID_RATIO);
        if let Some(index) = self.index {
            return 10_f64.powf((void - self.initial) / index);
        }
        let carman = |e: f64| e.powi(3) / (1.0 + e);
        carman(void) / carman(self.initial)
    }
}

/// The flow of water during a step.
#[derive(Clone, Debug, PartialEq)]
pub struct Consolidating<const D: usize> {
    /// Duration Δt \[time\].
    pub duration: f64,
    /// Duration of the step before, whose rate enters; zero where there is none or the load has jumped since \[time\].
    pub before: f64,
    /// Whether the step is refused where pressures change by more than it resolves.
    pub must_resolve: bool,
    /// Flow of water, by law.
    pub soils: Vec<PoreFlow<D>>,
    /// Sides of the grid where water leaves, by axis and whether it is the upper end. All others are sealed.
    pub open_sides: Vec<(usize, bool)>,
    /// Whether water leaves at the free faces of soil.
    pub open_faces: bool,
    /// Boxes within which water leaves: wells and drains, lower and upper corner \[length\].
    pub drains: Vec<[[f64; D]; 2]>,
}

impl<const D: usize> Consolidating<D> {
    /// Refuses numbers that are not finite and soil that water cannot flow through.
    pub(crate) fn are_sound(&self) -> Result<(), AssemblyError> {
        let refused = |quantity, index| Err(AssemblyError::NonFinite { quantity, index });
        let is_sound = self.duration > 0.0 && self.before >= 0.0;
        if !(is_sound && self.duration.is_finite() && self.before.is_finite()) {
            return refused("duration of a step", 0);
        }
        let bad = |soil: &PoreFlow<D>| match soil {
            PoreFlow::Drained | PoreFlow::Sealed => false,
            PoreFlow::Flows(soil) => {
                let flows = (0..D).all(|axis| soil.mobility[axis][axis] > 0.0);
                let is_finite = soil.mobility.as_flattened().iter().all(|k| k.is_finite());
                let follows = soil.follows.is_none_or(|law| {
                    law.initial > LEAST_VOID_RATIO && law.index.is_none_or(|index| index > 0.0)
                });
                !(flows && is_finite && follows && soil.stiffness.modulus > 0.0)
            }
        };
        match self.soils.iter().position(bad) {
            Some(index) => refused("permeability of law", index),
            None => Ok(()),
        }
    }

    /// Weights of flow and of the rate of the step before over the change of water in this step (theory, eq. 101): 1 and 0 by backward
    /// Euler \[-\].
    pub(crate) fn weights(&self) -> [f64; 2] {
        if self.before == 0.0 {
            return [1.0, 0.0];
        }
        let ratio = self.duration / self.before;
        [1.0 + ratio, ratio].map(|weight| weight / (1.0 + 2.0 * ratio))
    }

    /// The soil of a law that water flows through.
    #[inline]
    pub(crate) fn permeable(&self, law: usize) -> Option<&Permeable<D>> {
        match self.soils.get(law) {
            Some(PoreFlow::Flows(soil)) => Some(soil),
            _ => None,
        }
    }
}
