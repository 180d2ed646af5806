//! The return where cap and shear yield together, by both unknowns at once: the share x of the asymptote and the flow μ of the cap
//! (theory, eqs. 127b and 128c).

use super::cap::{Cap, Hardening};
use super::returned::{Returned, Start, closed};
use super::shear::Path;
use crate::circle::{Circle, Planes};
use crate::elasticity::Moduli;
use crate::spectral::principal::{Principal, deviator, dot, mean};

/// Most corrections; a return that takes more is left to brackets.
const MOST_CORRECTIONS: usize = 12;

/// Correction of the unknowns below which that is the last \[-\].
const CLOSE: f64 = 1e-8;

/// A cap and the planes that may yield with it.
struct Both<'a> {
    start: &'a Start<'a>,
    cap: &'a Cap,
    hardening: Hardening,
    trial: Principal,
    planes: Planes,
}

/// Residuals of a pair of unknowns.
struct Residuals {
    /// Strain of the hyperbola less that of the flow \[-\], and the excess over the cap \[stress\].
    values: [f64; 2],
    /// Their derivatives by x and by μ.
    slopes: [[f64; 2]; 2],
}

impl Start<'_> {
    /// The return to the cap and to planes of shear of a trial stress beyond both; none where they do not yield together, and where
    /// Newton's method did not find it.
    pub(super) fn both(&self, cap: &Cap, trial: &Principal) -> Option<Returned> {
        if cap.equivalent(trial) <= self.preconsolidation || mean(trial) <= 0.0 {
            return None;
        }
        let s = self.hyperbola.confinement(trial[2]);
        let share = self.hyperbola.share(s, self.gamma_p);
        if trial[0] - trial[2] <= self.hyperbola.asymptote * s * share {
            return None;
        }
        Planes::ALL.into_iter().find_map(|planes| {
            let both = Both {
                start: self,
                cap,
                hardening: cap.hardening(self.preconsolidation),
                trial: *trial,
                planes,
            };
            both.returned(share)
        })
    }
}

impl<'a> Both<'a> {
    /// The return to shear after flow of the cap by μ, with the elasticity that is left.
    fn path(&self, mu: f64) -> (Path<'a>, Moduli) {
        let (softened, trial) = (self.cap).softened(&self.start.moduli, &self.trial, mu);
        let path = Path {
            hyperbola: self.start.hyperbola,
            circle: Circle::new(&softened, &trial, self.planes),
            gamma_p: self.start.gamma_p,
        };
        (path, softened)
    }

    /// The residuals of shear and cap, with their derivatives.
    fn at(&self, share: f64, mu: f64) -> Residuals {
        let Start {
            hyperbola, moduli, ..
        } = *self.start;
        let (path, softened) = self.path(mu);
        let (circle, along) = (&path.circle, path.at(share));
        // All of the circle is linear in moduli and trial stress: so are its rates by μ.
        let volume = softened.bulk / moduli.bulk;
        let shear = softened.shear / moduli.shear;
        let rates = [
            -volume * volume,
            -self.cap.shear_share(&moduli) * shear * shear,
        ];
        let by_mu = Moduli {
            bulk: rates[0] * moduli.bulk,
            shear: rates[1] * moduli.shear,
        };
        let p = mean(&self.trial);
        let trial_by_mu = deviator(&self.trial).map(|value| rates[0] * p + rates[1] * value);
        let moving = Circle::new(&by_mu, &trial_by_mu, self.planes);
        let steep = 1.0 + hyperbola.asymptote * share;
        let ([multiplier, multiplier_by], [y, y_by]) = (along.multiplier, along.dilatancy);
        let ([_, g_w], [g_u_mu, g_w_mu]) = (circle.paces(y), moving.paces(y));
        let [up_mu, low_mu] = moving.ends;
        let multiplier_mu =
            (up_mu - steep * low_mu - multiplier * (g_u_mu + steep * g_w_mu)) * along.compliance;
        let s_mu = low_mu + multiplier_mu * g_w + multiplier * g_w_mu;
        let [s, s_by] = along.confinement;
        let low = s - hyperbola.attraction;
        let up = low + hyperbola.asymptote * share * s;
        let stress = circle.stress([up, low], multiplier, y);
        // Rates of the stress by x and by μ: of its ends, and between them.
        let aside = softened.aside();
        let between = [
            aside * (multiplier_by * y + multiplier * y_by),
            trial_by_mu[1] + y * (multiplier_mu * aside + multiplier * by_mu.aside()),
        ];
        let rate = |end: [f64; 2], between: f64| match self.planes {
            Planes::Main => [end[0], between, end[1]],
            Planes::Compression => [end[0], end[1], end[1]],
            Planes::Extension => [end[0], end[0], end[1]],
        };
        let stress_by = rate([steep * s_by + hyperbola.asymptote * s, s_by], between[0]);
        let stress_mu = rate([steep * s_mu, s_mu], between[1]);
        let p = mean(&stress);
        let [tip, slope] = self.hardening.grown(mu * p / moduli.bulk);
        let equivalent = self.cap.equivalent(&stress);
        let normal = self.cap.normal(&stress, p > 0.0);
        let (per_volume, scale) = (slope / moduli.bulk, 0.5 / equivalent);
        let outwards = |rate: &Principal| scale * dot(&normal, rate) - per_volume * mu * mean(rate);
        let [residual, residual_by] = along.residual;
        Residuals {
            values: [residual, equivalent - tip],
            slopes: [
                [residual_by, along.strain_by[0] * s_mu - multiplier_mu],
                [outwards(&stress_by), outwards(&stress_mu) - per_volume * p],
            ],
        }
    }

    /// By Newton's method from a share on; soil that fails keeps that of failure.
    fn returned(&self, mut share: f64) -> Option<Returned> {
        let failure = self.start.hyperbola.failure_ratio;
        let mut mu = 0.0;
        for _ in 0..MOST_CORRECTIONS {
            let residuals = self.at(share, mu);
            let ([first, second], [[a, b], [c, d]]) = (residuals.values, residuals.slopes);
            let [more, flow] = if share >= failure && first <= 0.0 {
                [0.0, -second / d]
            } else {
                let determinant = a * d - b * c;
                [
                    (b * second - d * first) / determinant,
                    (c * first - a * second) / determinant,
                ]
            };
            let next = (share + more).min(failure);
            let is_close = (next - share).abs() <= CLOSE * share && flow.abs() <= CLOSE * mu.abs();
            share = next;
            mu += flow;
            if !(share > 0.0 && mu.is_finite()) {
                return None;
            }
            if is_close {
                return self.accepted(share, mu);
            }
        }
        None
    }

    /// The answer, if cap and planes yield.
    fn accepted(&self, share: f64, mu: f64) -> Option<Returned> {
        let (path, _) = self.path(mu);
        let along = path.at(share);
        let (sheared, is_there) = path.sheared(share, &along);
        let is_consistent = share < self.start.hyperbola.failure_ratio || along.residual[0] <= 0.0;
        if !(is_there && is_consistent && mu > 0.0) {
            return None;
        }
        let answer = self.start.sheared(&sheared);
        let capped = (self.start).capped(self.cap, &self.hardening, answer, (true, mu));
        Some(closed(&capped))
    }
}
