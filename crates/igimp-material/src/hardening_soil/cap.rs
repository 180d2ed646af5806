//! The cap: an ellipse in p and q that grows with its own plastic volume (theory, eqs. 128 to 128b).
//!
//! Pressures and volumes are positive in compression here.

use super::hyperbola::Hyperbola;
use crate::elasticity::Moduli;
use crate::spectral::principal::{Principal, deviator, dot, mean};

/// The shape of the cap, and how it hardens.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Cap {
    /// M, and $`1/M^2`$ \[-\].
    pub(super) steepness: f64,
    flatness: f64,
    /// H at the reference pressure \[stress\].
    pub(super) hardening: f64,
    /// The reference pressure plus c cot φ \[stress\].
    reference: f64,
    attraction: f64,
    power: f64,
}

/// Moduli of one-dimensional compression that a cap has to follow.
#[derive(Clone, Copy, Debug)]
pub(super) struct Oedometer {
    /// $`E_{oed}`$ at the reference pressure \[stress\].
    pub(super) stiffness: f64,
    /// $`K_0^{nc}`$ \[-\].
    pub(super) k0: f64,
    /// $`p_{ref}`$, the axial stress \[stress\].
    pub(super) pressure: f64,
    /// Young's modulus and Poisson's ratio of unloading there.
    pub(super) elastic: [f64; 2],
}

/// How a cap hardens over a step.
#[derive(Clone, Copy, Debug)]
pub(super) struct Hardening {
    attraction: f64,
    /// Preconsolidation plus c cot φ at its start, and the modulus there \[stress\].
    base: f64,
    modulus: f64,
    /// 1 − m \[-\].
    open: f64,
}

impl Hardening {
    /// The preconsolidation after plastic volume of the cap (eq. 128a), and its derivative by the volume \[stress\].
    pub(super) fn grown(&self, volume: f64) -> [f64; 2] {
        let growth = self.modulus * volume / self.base;
        let (ratio, rest) = if self.open.abs() < 1e-9 {
            (growth.exp(), 1.0)
        } else {
            let rest = self.open * growth;
            ((rest.ln_1p() / self.open).exp(), 1.0 + rest)
        };
        [
            self.base * ratio - self.attraction,
            self.modulus * ratio / rest,
        ]
    }
}

impl Cap {
    /// The cap with which soil that is compressed without strain aside has this stiffness at this ratio of stresses (eq. 128b);
    /// none where no cap does.
    pub(super) fn of(hyperbola: &Hyperbola, test: &Oedometer) -> Option<Self> {
        let [axial, side] = [test.pressure, test.k0 * test.pressure];
        let [axial_rate, side_rate] = [test.stiffness, test.k0 * test.stiffness];
        let s = hyperbola.confinement(side);
        let (p, q) = ((axial + 2.0 * side) / 3.0, axial - side);
        let (p_rate, q_rate) = ((axial_rate + 2.0 * side_rate) / 3.0, axial_rate - side_rate);
        let k = hyperbola.asymptote;
        let share = q / (k * s);
        if share >= hyperbola.failure_ratio {
            return None;
        }
        let share_rate = (q_rate / k - side_rate * share) / s;
        let strain = hyperbola.strain(s, share);
        let shear = (strain.by_s * side_rate + strain.by_share * share_rate).max(0.0);
        let [y, _] = hyperbola.dilatancy(share);
        let [young, poisson] = test.elastic;
        // The rest of a unit rate of axial strain beside elasticity and shear.
        let axial_left =
            1.0 - (axial_rate - 2.0 * poisson * side_rate) / young - 0.5 * shear * (1.0 - y);
        let side_left =
            -(side_rate - poisson * (axial_rate + side_rate)) / young + 0.25 * shear * (1.0 + y);
        let volume = axial_left + 2.0 * side_left;
        let deviatoric = 2.0 / 3.0 * (axial_left - side_left);
        if !(volume > 0.0 && deviatoric > 0.0) {
            return None;
        }
        let square = q / p * volume / deviatoric;
        let tip = (q * q / square + p * p).sqrt();
        let tip_rate = (q * q_rate / square + p * p_rate) / tip;
        let (attraction, power) = (hyperbola.attraction, hyperbola.power);
        let reference = test.pressure + attraction;
        Some(Self {
            steepness: square.sqrt(),
            flatness: square.recip(),
            hardening: tip_rate / volume / ((tip + attraction) / reference).powf(power),
            reference,
            attraction,
            power,
        })
    }

    /// $`\sqrt{q^2/M^2 + p^2}`$, p no less than zero \[stress\].
    pub(super) fn equivalent(&self, stress: &Principal) -> f64 {
        let s = deviator(stress);
        let p = mean(stress).max(0.0);
        (1.5 * self.flatness * dot(&s, &s) + p * p).sqrt()
    }

    /// How the cap hardens from a preconsolidation \[stress\] on.
    pub(super) fn hardening(&self, preconsolidation: f64) -> Hardening {
        let base = preconsolidation + self.attraction;
        let modulus = self.hardening * (base / self.reference).powf(self.power);
        Hardening {
            attraction: self.attraction,
            base,
            modulus,
            open: 1.0 - self.power,
        }
    }

    /// Elasticity and trial stress after flow of the cap by $`\mu = 2 K \lambda_c`$ \[-\] (eq. 128): both stay linear.
    pub(super) fn softened(
        &self,
        moduli: &Moduli,
        trial: &Principal,
        mu: f64,
    ) -> (Moduli, Principal) {
        let p = mean(trial);
        let volume = if p > 0.0 { 1.0 / (1.0 + mu) } else { 1.0 };
        let shear = 1.0 / (1.0 + self.shear_share(moduli) * mu);
        let softened = Moduli {
            bulk: volume * moduli.bulk,
            shear: shear * moduli.shear,
        };
        let stress = deviator(trial).map(|s| volume * p + shear * s);
        (softened, stress)
    }

    /// $`3 G/(K M^2)`$: by how much more of shear than of pressure flow takes \[-\].
    pub(super) fn shear_share(&self, moduli: &Moduli) -> f64 {
        3.0 * moduli.shear / moduli.bulk * self.flatness
    }

    /// ∂f/∂σ of $`f = q^2/M^2 + p^2`$, without p where the trial stress has none \[stress\].
    pub(super) fn normal(&self, stress: &Principal, is_pressed: bool) -> Principal {
        let p = if is_pressed { mean(stress) } else { 0.0 };
        deviator(stress).map(|s| 3.0 * self.flatness * s + 2.0 / 3.0 * p)
    }
}
