//! The hyperbola of shear hardening, its dilatancy and the stiffness that grows with the least compression (theory, eqs. 126 to
//! 126d).

/// Parameters of shear hardening. Pressures are positive in compression; s is the least of them plus c cot φ.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Hyperbola {
    /// c cot φ \[stress\].
    pub(super) attraction: f64,
    /// s at which stiffness is as stated \[stress\].
    pub(super) reference: f64,
    /// m \[-\].
    pub(super) power: f64,
    /// $`q_a/s`$, with the asymptote $`q_a`$ of the hyperbola \[-\].
    pub(super) asymptote: f64,
    /// $`R_f = q_f/q_a`$ \[-\].
    pub(super) failure_ratio: f64,
    /// $`2 q_a/E_i`$ at the reference \[-\].
    pub(super) initial: f64,
    /// $`2 q_a/E_{ur}`$ at the reference \[-\].
    pub(super) unloading: f64,
    /// sin φ at constant volume \[-\].
    pub(super) sin_critical: f64,
}

/// Plastic shear strain of a share x of the asymptote under s, with its derivatives.
pub(super) struct ShearStrain {
    pub(super) value: f64,
    pub(super) by_s: f64,
    pub(super) by_share: f64,
}

impl Hyperbola {
    /// s of the least compression \[stress\].
    pub(super) fn confinement(&self, least: f64) -> f64 {
        least + self.attraction
    }

    /// $`(s/s_{ref})^m`$: stiffness under s over that at the reference \[-\]; s is positive.
    pub(super) fn stiffness_ratio(&self, s: f64) -> f64 {
        (s / self.reference).powf(self.power)
    }

    /// $`\gamma_p`$ of a mobilised share (eq. 126a) \[-\]; none where s is not positive.
    pub(super) fn strain(&self, s: f64, share: f64) -> ShearStrain {
        if s <= 0.0 {
            return ShearStrain {
                value: 0.0,
                by_s: 0.0,
                by_share: 0.0,
            };
        }
        let scale = (s / self.reference).powf(1.0 - self.power);
        let open = (1.0 - share).recip();
        let way = self.initial * share * open - self.unloading * share;
        ShearStrain {
            value: scale * way,
            by_s: (1.0 - self.power) * scale * way / s,
            by_share: scale * (self.initial * open * open - self.unloading),
        }
    }

    /// The share x of the asymptote that soil of this plastic shear strain bears under s, at most that at failure \[-\].
    pub(super) fn share(&self, s: f64, gamma_p: f64) -> f64 {
        if s <= 0.0 {
            return self.failure_ratio;
        }
        let strain = gamma_p * (s / self.reference).powf(self.power - 1.0);
        let sum = self.initial - self.unloading + strain;
        let root = (sum * sum + 4.0 * self.unloading * strain).sqrt();
        let share = 2.0 * strain / (sum + root);
        // Strain beyond all numbers has failed.
        if share < self.failure_ratio {
            share
        } else {
            self.failure_ratio
        }
    }

    /// The excess of $`\sigma_1 - \sigma_3`$ over the strength of soil at this plastic shear strain \[stress\].
    pub(super) fn excess(&self, most: f64, least: f64, gamma_p: f64) -> f64 {
        let s = self.confinement(least);
        most - least - self.asymptote * s * self.share(s, gamma_p)
    }

    /// sin ψ mobilised by a share (eq. 126d), and its derivative by the share \[-\].
    pub(super) fn dilatancy(&self, share: f64) -> [f64; 2] {
        let ratio = self.asymptote * share;
        let whole = (ratio + 2.0).recip();
        let sin_mobilised = ratio * whole;
        if sin_mobilised <= self.sin_critical {
            return [0.0; 2];
        }
        let open = (1.0 - sin_mobilised * self.sin_critical).recip();
        let by_sin = (1.0 - self.sin_critical * self.sin_critical) * open * open;
        let by_share = 2.0 * self.asymptote * whole * whole;
        [
            (sin_mobilised - self.sin_critical) * open,
            by_sin * by_share,
        ]
    }
}
