//! The return to the planes of shear hardening and failure, by one unknown: the share of the asymptote that is mobilised (theory,
//! eqs. 127 to 127b).
//!
//! Principal stresses are positive in compression here, in descending order.

use super::hyperbola::Hyperbola;
use crate::circle::{Circle, Flow, Planes};
use crate::elasticity::Moduli;
use crate::spectral::principal::Principal;

/// Most corrections of the share; a bisection to the last bit takes no more.
const MOST_CORRECTIONS: usize = 80;

/// Share of the share below which a correction of Newton's method is the last \[-\].
const CLOSE: f64 = 1e-9;

/// Where on the surface of shear a stress is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Shear {
    Inside,
    On(Planes),
    /// No stress but the attraction is left.
    Apex,
}

/// A stress on the planes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sheared {
    pub(super) stress: Principal,
    /// Derivative by the trial strain \[stress\].
    pub(super) tangent: [[f64; 3]; 3],
    /// Growth of the plastic shear strain \[-\]; zero at the apex, where strain says it.
    pub(super) delta_gamma: f64,
    pub(super) shear: Shear,
}

/// A return to one of the planes or to an edge, of the flow of eq. 126c.
pub(super) struct Path<'a> {
    pub(super) hyperbola: &'a Hyperbola,
    pub(super) circle: Circle,
    pub(super) gamma_p: f64,
}

/// Quantities at a share of the asymptote.
pub(super) struct Along {
    /// Λ and its derivative by the share \[-\].
    pub(super) multiplier: [f64; 2],
    /// sin ψ and its derivative.
    pub(super) dilatancy: [f64; 2],
    /// Strain of the hyperbola less that of the flow \[-\], and its derivative.
    pub(super) residual: [f64; 2],
    /// Λ over the stress that it takes from U less the strength of W \[1/stress\].
    pub(super) compliance: f64,
    /// s \[stress\], and its derivative by the share.
    pub(super) confinement: [f64; 2],
    /// The derivatives of the strain of the hyperbola by s and by the share.
    pub(super) strain_by: [f64; 2],
}

impl Path<'_> {
    /// The state whose circle mobilises this share (eq. 127a).
    pub(super) fn at(&self, share: f64) -> Along {
        let k = self.hyperbola.asymptote;
        let dilatancy @ [y, y_by] = self.hyperbola.dilatancy(share);
        let [g_u, g_w] = self.circle.paces(y);
        let ([up, low], dilating) = (self.circle.ends, self.circle.dilating);
        let from = self.hyperbola.confinement(low);
        let numerator = up - low - k * share * from;
        let compliance = (g_u + g_w + k * share * g_w).recip();
        let multiplier = numerator * compliance;
        let denominator_by = (dilating[1] * (1.0 + k * share) - dilating[0]) * y_by + k * g_w;
        let multiplier_by = -(k * from + multiplier * denominator_by) * compliance;
        let confinement = from + multiplier * g_w;
        let confinement_by = multiplier_by * g_w + multiplier * dilating[1] * y_by;
        let strain = self.hyperbola.strain(confinement, share);
        Along {
            multiplier: [multiplier, multiplier_by],
            dilatancy,
            residual: [
                strain.value - self.gamma_p - multiplier,
                strain.by_s * confinement_by + strain.by_share - multiplier_by,
            ],
            compliance,
            confinement: [confinement, confinement_by],
            strain_by: [strain.by_s, strain.by_share],
        }
    }

    /// The share at which hyperbola and flow have the same strain; that at failure where flow goes on.
    fn share(&self) -> Option<f64> {
        let failure = self.hyperbola.failure_ratio;
        if self.gamma_p.is_infinite() {
            return Some(failure);
        }
        let (mut low, mut high) = (0.0, failure);
        let mut is_bounded = false;
        let mut share = self.hyperbola.share(
            self.hyperbola.confinement(self.circle.ends[1]),
            self.gamma_p,
        );
        for _ in 0..MOST_CORRECTIONS {
            let along = self.at(share);
            let [residual, slope] = along.residual;
            if residual.is_nan() {
                return None;
            }
            if residual > 0.0 {
                (high, is_bounded) = (share, true);
            } else if share >= failure {
                return Some(failure);
            } else {
                low = share;
            }
            if residual.abs() <= 4.0 * f64::EPSILON * (self.gamma_p + along.multiplier[0].abs()) {
                return Some(share);
            }
            let newton = share - residual / slope;
            let is_newton = newton > low && newton < high;
            let next = if is_newton {
                newton
            } else if is_bounded {
                0.5 * (low + high)
            } else {
                failure
            };
            // An error of the share is one of its square on the next.
            let close = if is_newton { CLOSE } else { f64::EPSILON };
            if (next - share).abs() <= close * share {
                return Some(next);
            }
            share = next;
        }
        (high - low <= 8.0 * f64::EPSILON).then_some(share)
    }

    /// ∂(Λ, x)/∂(U, W) of the trial stress, with x held at failure.
    fn derivatives(&self, share: f64, along: &Along) -> [[f64; 2]; 2] {
        let k = self.hyperbola.asymptote;
        let ([y, y_by], dilating) = (along.dilatancy, self.circle.dilating);
        let [g_u, g_w] = self.circle.paces(y);
        let denominator = g_u + g_w + k * share * g_w;
        let circle = [1.0, -(1.0 + k * share)];
        if share >= self.hyperbola.failure_ratio {
            return [circle.map(|by| by / denominator), [0.0; 2]];
        }
        let multiplier = along.multiplier[0];
        // -denominator dΛ + a dx = -(dU - (1 + k x) dW) and b dΛ + c dx = -s' dW.
        let denominator_by = (dilating[1] * (1.0 + k * share) - dilating[0]) * y_by + k * g_w;
        let from = self.hyperbola.confinement(self.circle.ends[1]);
        let a = -k * from - multiplier * denominator_by;
        let by_s = along.strain_by[0];
        let b = by_s * g_w - 1.0;
        let c = by_s * multiplier * dilating[1] * y_by + along.strain_by[1];
        let determinant = -denominator * c - a * b;
        let by = |index: usize| {
            let pressed = if index == 1 { by_s } else { 0.0 };
            [
                (-circle[index] * c + a * pressed) / determinant,
                (denominator * pressed + b * circle[index]) / determinant,
            ]
        };
        let (up, low) = (by(0), by(1));
        [[up[0], low[0]], [up[1], low[1]]]
    }

    /// The stress of a share, and whether it is within the part of the surface of its planes with multipliers that are not negative.
    pub(super) fn sheared(&self, share: f64, along: &Along) -> (Sheared, bool) {
        let ([multiplier, _], [y, _]) = (along.multiplier, along.dilatancy);
        let [_, g_w] = self.circle.paces(y);
        let low = self.circle.ends[1] + multiplier * g_w;
        // By the circle, and not by the way from a trial stress that may be far larger: the stress is on the surface to the last bit.
        let up = low + self.hyperbola.asymptote * share * self.hyperbola.confinement(low);
        let stress = self.circle.stress([up, low], multiplier, y);
        let is_positive = along.confinement[0] > 0.0 && multiplier >= 0.0;
        let valid = is_positive && self.circle.holds(&stress, multiplier, y);
        let sheared = Sheared {
            stress,
            tangent: if valid {
                self.circle.tangent(&self.flow(share, along))
            } else {
                [[0.0; 3]; 3]
            },
            delta_gamma: multiplier,
            shear: Shear::On(self.circle.planes),
        };
        (sheared, valid)
    }

    /// The flow for the tangent.
    fn flow(&self, share: f64, along: &Along) -> Flow {
        let [multiplier_by, unknown_by] = self.derivatives(share, along);
        Flow {
            multiplier: along.multiplier[0],
            multiplier_by,
            dilatancy: along.dilatancy,
            unknown_by,
        }
    }
}

/// Returns a trial stress beyond the strength of soil at this plastic shear strain; none where the share was not found.
pub(super) fn sheared(
    hyperbola: &Hyperbola,
    moduli: &Moduli,
    trial: &Principal,
    gamma_p: f64,
) -> Option<Sheared> {
    let mut beyond = true;
    for planes in Planes::ALL {
        let (state, valid) = on(hyperbola, moduli, trial, gamma_p, planes)?;
        if valid {
            return Some(state);
        }
        let is_beyond = hyperbola.confinement(state.stress[2]) <= 0.0 || state.delta_gamma < 0.0;
        beyond &= is_beyond || planes == Planes::Main;
    }
    beyond.then_some(Sheared {
        stress: [-hyperbola.attraction; 3],
        tangent: [[0.0; 3]; 3],
        delta_gamma: 0.0,
        shear: Shear::Apex,
    })
}

/// The return to some planes, and whether it ends within their part of the surface with multipliers that are not negative.
fn on(
    hyperbola: &Hyperbola,
    moduli: &Moduli,
    trial: &Principal,
    gamma_p: f64,
    planes: Planes,
) -> Option<(Sheared, bool)> {
    let path = Path {
        hyperbola,
        circle: Circle::new(moduli, trial, planes),
        gamma_p,
    };
    let share = path.share()?;
    Some(path.sheared(share, &path.at(share)))
}
