//! Returns that move the circle of the greatest and the least stress: to the main plane of a six-sided pyramid and to the edges beside
//! it, whatever strength goes by (theory, eq. 127).
//!
//! Principal stresses are positive in compression here, in descending order; so are strains.

use crate::Regime;
use crate::elasticity::Moduli;
use crate::spectral::principal::Principal;

/// Share of a strain between two planes by which an edge may be missed in round-off \[-\].
const ROUND_OFF: f64 = 1e-10;

/// The planes that yield.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Planes {
    /// That of the largest and the least stress.
    Main,
    /// Those of the edge on which the two lesser compressions are equal, as in triaxial compression.
    Compression,
    /// Those of the edge on which the two larger compressions are equal, as in triaxial extension.
    Extension,
}

impl Planes {
    /// From the common to the rare.
    pub(crate) const ALL: [Self; 3] = [Self::Main, Self::Compression, Self::Extension];

    pub(crate) fn regime(self) -> Regime {
        match self {
            Self::Main => Regime::Smooth,
            Self::Compression => Regime::RightEdge,
            Self::Extension => Regime::LeftEdge,
        }
    }
}

/// The way from a trial stress to some planes: of the upper and the lower end of the circle,
/// $`U = U^{tr} - \Lambda (g_U - l_U y)`$ and $`W = W^{tr} + \Lambda (g_W + l_W y)`$ with y = sin ψ.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Circle {
    pub(crate) planes: Planes,
    moduli: Moduli,
    trial: Principal,
    /// U and W of the trial stress \[stress\].
    pub(crate) ends: [f64; 2],
    /// g of U and W \[stress\].
    constant: [f64; 2],
    /// l of U and W \[stress\].
    pub(crate) dilating: [f64; 2],
}

/// The values with the other sign, in descending order where these are.
#[inline]
pub(crate) fn mirrored(values: &Principal) -> Principal {
    let [first, middle, last] = *values;
    [-last, -middle, -first]
}

/// The tangent of values that are mirrored.
#[inline]
pub(crate) fn turned(tangent: &[[f64; 3]; 3]) -> [[f64; 3]; 3] {
    let [first, middle, last] = tangent.map(|[a, b, c]| [c, b, a]);
    [last, middle, first]
}

/// The flow of a return: the multiplier Λ and sin ψ, as functions of an unknown x of the law.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Flow {
    /// Λ \[-\].
    pub(crate) multiplier: f64,
    /// Its derivatives by U and W of the trial stress.
    pub(crate) multiplier_by: [f64; 2],
    /// sin ψ, and its derivative by x.
    pub(crate) dilatancy: [f64; 2],
    /// The derivatives of x by U and W.
    pub(crate) unknown_by: [f64; 2],
}

impl Circle {
    #[inline]
    pub(crate) fn new(moduli: &Moduli, trial: &Principal, planes: Planes) -> Self {
        let (shear, aside) = (moduli.shear, moduli.aside());
        let single = [shear, shear + aside];
        let shared = [0.5 * shear, 0.5 * shear + aside];
        let [largest, middle, least] = *trial;
        let (ends, upper, lower) = match planes {
            Planes::Main => ([largest, least], single, single),
            Planes::Compression => ([largest, 0.5 * (middle + least)], single, shared),
            Planes::Extension => ([0.5 * (largest + middle), least], shared, single),
        };
        Self {
            planes,
            moduli: *moduli,
            trial: *trial,
            ends,
            constant: [upper[0], lower[0]],
            dilating: [upper[1], lower[1]],
        }
    }

    /// Decrease of U and increase of W over Λ \[stress\].
    #[inline]
    pub(crate) fn paces(&self, y: f64) -> [f64; 2] {
        [
            self.constant[0] - self.dilating[0] * y,
            self.constant[1] + self.dilating[1] * y,
        ]
    }

    /// The stress whose circle has these ends, after flow by Λ.
    #[inline]
    pub(crate) fn stress(&self, [up, low]: [f64; 2], multiplier: f64, y: f64) -> Principal {
        match self.planes {
            Planes::Main => [
                up,
                self.trial[1] + multiplier * self.moduli.aside() * y,
                low,
            ],
            Planes::Compression => [up, low, low],
            Planes::Extension => [up, up, low],
        }
    }

    /// Whether a stress after flow by Λ is on its part of the pyramid, with multipliers that are not negative.
    #[inline]
    pub(crate) fn holds(&self, stress: &Principal, multiplier: f64, y: f64) -> bool {
        let [largest, middle, least] = self.trial;
        let [up, between, low] = *stress;
        let apart = match self.planes {
            Planes::Main => {
                let slack = 1e-14 * (largest.abs() + least.abs());
                let is_between = between <= up + slack && between >= low - slack;
                return multiplier >= 0.0 && is_between;
            }
            Planes::Compression => (middle - least) / (self.moduli.shear * (1.0 + y)),
            Planes::Extension => (largest - middle) / (self.moduli.shear * (1.0 - y)),
        };
        multiplier >= (1.0 - ROUND_OFF) * apart && up >= low
    }

    /// The plastic strain of flow by Λ \[-\].
    #[inline]
    pub(crate) fn plastic_strain(&self, multiplier: f64, y: f64) -> Principal {
        let (up, low) = (0.5 * multiplier * (1.0 - y), -0.5 * multiplier * (1.0 + y));
        let [largest, middle, least] = self.trial;
        match self.planes {
            Planes::Main => [up, 0.0, low],
            Planes::Compression => {
                let apart = 0.25 * (middle - least) / self.moduli.shear;
                [up, 0.5 * low + apart, 0.5 * low - apart]
            }
            Planes::Extension => {
                let apart = 0.25 * (largest - middle) / self.moduli.shear;
                [0.5 * up + apart, 0.5 * up - apart, low]
            }
        }
    }

    /// The invariant κ of the plastic strain \[-\] (theory, eq. 107a), and its derivatives by Λ and sin ψ.
    #[inline]
    pub(crate) fn equivalent(&self, multiplier: f64, y: f64) -> [f64; 3] {
        let [largest, middle, least] = self.trial;
        // κ² = A Λ² + B, with A and its derivative by sin ψ.
        let ([a, a_by], apart) = match self.planes {
            Planes::Main => ([1.0 / 3.0 + y * y / 9.0, 2.0 / 9.0 * y], 0.0),
            Planes::Compression => {
                let share = 0.5 - y / 6.0;
                ([share * share, -share / 3.0], middle - least)
            }
            Planes::Extension => {
                let share = 0.5 + y / 6.0;
                ([share * share, share / 3.0], largest - middle)
            }
        };
        let b = apart * apart / (12.0 * self.moduli.shear * self.moduli.shear);
        let square = multiplier * multiplier;
        let kappa = (a * square + b).sqrt();
        let scale = if kappa > 0.0 { kappa.recip() } else { 0.0 };
        [kappa, a * multiplier * scale, 0.5 * a_by * square * scale]
    }

    /// The derivative of the stress by the trial strain \[stress\].
    pub(crate) fn tangent(&self, flow: &Flow) -> [[f64; 3]; 3] {
        let [y, y_by] = flow.dilatancy;
        let [g_u, g_w] = self.paces(y);
        let elastic = self.moduli.tangent();
        let mean = |a: usize, b: usize| -> Principal {
            std::array::from_fn(|c| 0.5 * (elastic[a][c] + elastic[b][c]))
        };
        let rows: [Principal; 2] = match self.planes {
            Planes::Main => [elastic[0], elastic[2]],
            Planes::Compression => [elastic[0], mean(1, 2)],
            Planes::Extension => [mean(0, 1), elastic[2]],
        };
        let by = |[up, low]: [f64; 2]| -> Principal {
            std::array::from_fn(|c| up * rows[0][c] + low * rows[1][c])
        };
        let (multiplied, turned) = (by(flow.multiplier_by), by(flow.unknown_by));
        let moved = |row: &Principal, pace: f64, dilating: f64| -> Principal {
            let turn = flow.multiplier * dilating * y_by;
            std::array::from_fn(|c| row[c] + pace * multiplied[c] + turn * turned[c])
        };
        let upper = moved(&rows[0], -g_u, self.dilating[0]);
        let lower = moved(&rows[1], g_w, self.dilating[1]);
        let aside = self.moduli.aside();
        match self.planes {
            Planes::Main => [upper, moved(&elastic[1], aside * y, aside), lower],
            Planes::Compression => [upper, lower, lower],
            Planes::Extension => [upper, upper, lower],
        }
    }
}
