//! How the stress on a pyramid moves with its strength, the trial strain being kept (theory, eq. 107).

use crate::elasticity::Moduli;
use crate::pyramid::PlaneStrength;
use crate::spectral::principal::{Principal, dot};
use crate::{Elasticity, Regime};

/// A yield plane and its change.
struct Moving {
    normal: Principal,
    flow: Principal,
    normal_rate: Principal,
    flow_rate: Principal,
    strength: f64,
    strength_rate: f64,
}

/// A strength, and its derivative by plastic strain.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Changing {
    pub(crate) strength: PlaneStrength,
    pub(crate) rate: PlaneStrength,
}

impl Changing {
    /// The plane of shear between two principal stresses, major first.
    fn shear(&self, major: usize, minor: usize) -> Moving {
        let direction = |sine: f64, one: f64| {
            let mut direction = [0.0; 3];
            direction[major] = one + sine;
            direction[minor] = sine - one;
            direction
        };
        let Self { strength, rate } = self;
        Moving {
            normal: direction(strength.sin_friction, 1.0),
            flow: direction(strength.sin_dilation, 1.0),
            normal_rate: direction(rate.sin_friction, 0.0),
            flow_rate: direction(rate.sin_dilation, 0.0),
            strength: strength.shear,
            strength_rate: rate.shear,
        }
    }

    /// The plane that limits a principal stress in tension.
    fn tension(&self, axis: usize) -> Moving {
        let mut normal = [0.0; 3];
        normal[axis] = 1.0;
        Moving {
            normal,
            flow: normal,
            normal_rate: [0.0; 3],
            flow_rate: [0.0; 3],
            strength: self.strength.tension_cutoff.unwrap_or(f64::INFINITY),
            strength_rate: self.rate.tension_cutoff.unwrap_or(0.0),
        }
    }

    /// Plastic strain of a return, and its derivative by κ \[-\], where the trial stress, in descending order, goes to the main plane of
    /// shear or to an edge beside it; else none.
    pub(crate) fn strain(&self, moduli: &Moduli, trial: &Principal) -> Option<[f64; 2]> {
        let Self { strength, rate } = self;
        let state = strength.circle(moduli, trial)?;
        let (sine, y, y_rate) = (
            strength.sin_friction,
            strength.sin_dilation,
            rate.sin_dilation,
        );
        let ([up, low], [l_u, l_w]) = (state.ends, state.circle.dilating);
        let [g_u, g_w] = state.circle.paces(y);
        let [upper, lower] = [1.0 - sine, 1.0 + sine];
        let turned = state.multiplier * y_rate * (upper * l_u - lower * l_w);
        let multiplier_rate =
            (turned - rate.sin_friction * (up + low) - rate.shear) / (upper * g_u + lower * g_w);
        let [kappa, by_multiplier, by_y] = state.circle.equivalent(state.multiplier, y);
        Some([kappa, by_multiplier * multiplier_rate + by_y * y_rate])
    }

    /// ∂τ/∂κ at a stress that a trial stress was returned to, both in descending order \[stress\].
    pub(crate) fn stress_rate(
        &self,
        elasticity: &Elasticity,
        regime: Regime,
        trial: &Principal,
        tau: &Principal,
    ) -> Principal {
        let planes = match regime {
            Regime::Elastic => return [0.0; 3],
            Regime::Apex => return [self.rate.apex; 3],
            Regime::TensionApex => return [self.rate.tension_cutoff.unwrap_or(0.0); 3],
            Regime::TensionCorner => return self.corner_rate(tau),
            Regime::Smooth => (self.shear(0, 2), None),
            Regime::RightEdge => (self.shear(0, 2), Some(self.shear(1, 2))),
            Regime::LeftEdge => (self.shear(0, 2), Some(self.shear(0, 1))),
            Regime::Tension => (self.tension(0), None),
            Regime::TensionShear => (self.shear(0, 2), Some(self.tension(0))),
            Regime::TensionEdge => (self.tension(0), Some(self.tension(1))),
            Regime::Cap | Regime::CapShear => unreachable!("a law of planes has no cap"),
        };
        on_planes(elasticity, (&planes.0, planes.1.as_ref()), trial, tau)
    }

    /// The rate of an end of the edge between shear and tension, where two stresses are equal.
    fn corner_rate(&self, tau: &Principal) -> Principal {
        let Self { strength, rate } = self;
        let (tension, tension_rate) = (
            strength.tension_cutoff.unwrap_or(0.0),
            rate.tension_cutoff.unwrap_or(0.0),
        );
        let minor = tau[2];
        let minor_rate = ((1.0 + strength.sin_friction) * tension_rate
            + (tension + minor) * rate.sin_friction
            - rate.shear)
            / (1.0 - strength.sin_friction);
        let middle = if tension - tau[1] < tau[1] - minor {
            tension_rate
        } else {
            minor_rate
        };
        [tension_rate, middle, minor_rate]
    }
}

/// The rate of a stress on one or two planes.
///
/// The planes keep the stress, $`A'\tau + A\tau' = k'`$, and $`\tau = \tau^{tr} - C B \lambda`$ with the trial stress as it is.
fn on_planes(
    elasticity: &Elasticity,
    (first, second): (&Moving, Option<&Moving>),
    trial: &Principal,
    tau: &Principal,
) -> Principal {
    // A second plane that is the first leaves the system as it is with one.
    let pair = [first, second.unwrap_or(first)];
    let stiff = pair.map(|plane| elasticity.stress(&plane.flow));
    let solve = |right: [f64; 2]| -> [f64; 2] {
        let m = pair.map(|row| [dot(&row.normal, &stiff[0]), dot(&row.normal, &stiff[1])]);
        if second.is_none() {
            return [right[0] / m[0][0], 0.0];
        }
        let determinant = m[0][0] * m[1][1] - m[0][1] * m[1][0];
        [
            (m[1][1] * right[0] - m[0][1] * right[1]) / determinant,
            (m[0][0] * right[1] - m[1][0] * right[0]) / determinant,
        ]
    };
    let lambda = solve(pair.map(|plane| dot(&plane.normal, trial) - plane.strength));
    let turned: Principal = std::array::from_fn(|a| {
        lambda[0] * pair[0].flow_rate[a] + lambda[1] * pair[1].flow_rate[a]
    });
    let turned = elasticity.stress(&turned);
    let lambda_rate = solve(pair.map(|plane| {
        dot(&plane.normal_rate, tau) - plane.strength_rate - dot(&plane.normal, &turned)
    }));
    std::array::from_fn(|a| {
        -turned[a] - lambda_rate[0] * stiff[0][a] - lambda_rate[1] * stiff[1][a]
    })
}
