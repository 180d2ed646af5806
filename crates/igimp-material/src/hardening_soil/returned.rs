//! The return where shear, the cap or both yield: the flow of the cap is sought about the return to shear (theory, eq. 128c).

use super::cap::{Cap, Hardening};
use super::hyperbola::Hyperbola;
use super::shear::{Shear, Sheared, sheared};
use crate::elasticity::Moduli;
use crate::law::ON_SURFACE;
use crate::spectral::principal::{Principal, apply, dot, largest, mean};

/// Most corrections of the flow of the cap; a bisection to the last bit takes no more.
const MOST_CORRECTIONS: usize = 100;

/// The soil at the start of a step.
#[derive(Clone, Copy, Debug)]
pub(super) struct Start<'a> {
    pub(super) hyperbola: &'a Hyperbola,
    /// None: soil whose hardening is over.
    pub(super) cap: Option<&'a Cap>,
    pub(super) moduli: Moduli,
    pub(super) gamma_p: f64,
    pub(super) preconsolidation: f64,
}

/// A stress, positive in compression and in descending order, that soil bears.
#[derive(Clone, Copy, Debug)]
pub(super) struct Returned {
    pub(super) stress: Principal,
    /// Derivative by the trial strain \[stress\].
    pub(super) tangent: [[f64; 3]; 3],
    /// Growth of the plastic shear strain \[-\]; zero at the apex.
    pub(super) delta_gamma: f64,
    pub(super) preconsolidation: f64,
    pub(super) shear: Shear,
    /// Whether the cap yields.
    pub(super) is_capped: bool,
}

impl Returned {
    /// Whether all of it are numbers, as they are not where hardening goes beyond them.
    pub(super) fn is_finite(&self) -> bool {
        // The preconsolidation of soil whose hardening is over is beyond all numbers, and has no cap.
        let memory = !self.is_capped || self.preconsolidation.is_finite();
        let values = self.tangent.as_flattened().iter().chain(&self.stress);
        memory && self.delta_gamma.is_finite() && values.into_iter().all(|v| v.is_finite())
    }
}

/// The cap at some flow.
pub(super) struct Capped {
    pub(super) answer: Returned,
    /// By how much the stress is outside \[stress\], and its derivative by μ.
    pub(super) excess: [f64; 2],
    /// ∂σ/∂μ and ∂(excess)/∂ε.
    columns: [Principal; 2],
}

impl Start<'_> {
    /// The stress that a trial stress is returned to; none where it was not found.
    pub(super) fn returned(&self, trial: &Principal) -> Option<Returned> {
        let Some(cap) = self.cap else {
            return self.without_cap(&self.moduli, trial);
        };
        if let Some(both) = self.both(cap, trial) {
            return Some(both);
        }
        let first = self.without_cap(&self.moduli, trial)?;
        let outside = cap.equivalent(&first.stress) - self.preconsolidation;
        if outside <= ON_SURFACE * self.preconsolidation {
            return Some(first);
        }
        self.with_cap(cap, trial)
    }

    /// The return to the planes of shear alone.
    fn without_cap(&self, moduli: &Moduli, trial: &Principal) -> Option<Returned> {
        let excess = self.hyperbola.excess(trial[0], trial[2], self.gamma_p);
        let round_off = ON_SURFACE * (largest(trial) + self.hyperbola.attraction);
        let sheared = if excess <= round_off {
            Sheared {
                stress: *trial,
                tangent: moduli.tangent(),
                delta_gamma: 0.0,
                shear: Shear::Inside,
            }
        } else {
            sheared(self.hyperbola, moduli, trial, self.gamma_p)?
        };
        Some(self.sheared(&sheared))
    }

    /// The answer of shear alone.
    pub(super) fn sheared(&self, sheared: &Sheared) -> Returned {
        Returned {
            stress: sheared.stress,
            tangent: sheared.tangent,
            delta_gamma: sheared.delta_gamma,
            preconsolidation: self.preconsolidation,
            shear: sheared.shear,
            is_capped: false,
        }
    }

    /// The state after flow of the cap by μ.
    fn at(&self, cap: &Cap, hardening: &Hardening, trial: &Principal, mu: f64) -> Option<Capped> {
        let (moduli, softened) = cap.softened(&self.moduli, trial, mu);
        let answer = self.without_cap(&moduli, &softened)?;
        Some(self.capped(cap, hardening, answer, (mean(trial) > 0.0, mu)))
    }

    /// The answer of shear after flow of the cap by μ, where that has a pressure or not, with the cap's excess and its rates.
    pub(super) fn capped(
        &self,
        cap: &Cap,
        hardening: &Hardening,
        mut answer: Returned,
        (is_pressed, mu): (bool, f64),
    ) -> Capped {
        let pressure = mean(&answer.stress);
        let p = if is_pressed { pressure } else { 0.0 };
        let [tip, slope] = hardening.grown(mu * p / self.moduli.bulk);
        let equivalent = cap.equivalent(&answer.stress);
        let normal = cap.normal(&answer.stress, is_pressed);
        let per_volume = slope / self.moduli.bulk;
        let gradient = cap.normal(&answer.stress, pressure > 0.0);
        let third = if is_pressed {
            per_volume * mu / 3.0
        } else {
            0.0
        };
        let row: Principal = gradient.map(|by| 0.5 * by / equivalent - third);
        let column = apply(&answer.tangent, &normal).map(|by| 0.5 * by / self.moduli.bulk);
        let across: Principal =
            std::array::from_fn(|b| (0..3).map(|a| row[a] * answer.tangent[a][b]).sum());
        answer.preconsolidation = tip;
        answer.is_capped = true;
        Capped {
            answer,
            excess: [equivalent - tip, -dot(&row, &column) - per_volume * p],
            columns: [column, across],
        }
    }

    /// The return with flow of the cap: of bracketed corrections, whose first ones double it until the stress is inside.
    fn with_cap(&self, cap: &Cap, trial: &Principal) -> Option<Returned> {
        let hardening = cap.hardening(self.preconsolidation);
        let (mut low, mut high) = (0.0, f64::INFINITY);
        let mut mu = 0.0;
        for _ in 0..MOST_CORRECTIONS {
            let capped = self.at(cap, &hardening, trial, mu)?;
            let [excess, slope] = capped.excess;
            let next = mu - excess / slope;
            let is_found = excess.abs() <= 8.0 * f64::EPSILON * capped.answer.preconsolidation
                || (next - mu).abs() <= 2.0 * f64::EPSILON * mu
                || high.is_finite() && high - low <= 2.0 * f64::EPSILON * high;
            if is_found {
                return Some(closed(&capped));
            }
            if excess > 0.0 {
                low = mu;
            } else {
                high = mu;
            }
            mu = if next > low && next < high {
                next
            } else if high.is_infinite() {
                2.0 * low + 1e-3
            } else {
                0.5 * (low + high)
            };
        }
        None
    }
}

/// The answer with the tangent along which the stress stays on the cap.
pub(super) fn closed(capped: &Capped) -> Returned {
    let [column, across] = capped.columns;
    let hardness = -capped.excess[1];
    let mut answer = capped.answer;
    for a in 0..3 {
        for b in 0..3 {
            answer.tangent[a][b] -= column[a] * across[b] / hardness;
        }
    }
    answer
}
