//! The return to the planes of shear hardening and failure, by one unknown: the share of the asymptote that is mobilised (theory,
//! eqs. 127 to 127b).
//!
//! Principal stresses are positive in compression here, in descending order.

use super::hyperbola::Hyperbola;
use crate::spectral::principal::Principal;

/// Most corrections of the share; a bisection to the last bit takes no more.
const MOST_CORRECTIONS: usize = 80;

/// Share of a strain between two planes by which an edge may be missed in round-off \[-\].
const ROUND_OFF: f64 = 1e-10;

/// A linear elasticity \[stress\].
#[derive(Clone, Copy, Debug)]
pub(super) struct Moduli {
    pub(super) bulk: f64,
    pub(super) shear: f64,
}

impl Moduli {
    /// Lamé's first constant.
    fn aside(&self) -> f64 {
        self.bulk - 2.0 / 3.0 * self.shear
    }

    pub(super) fn tangent(&self) -> [[f64; 3]; 3] {
        let mut tangent = [[self.aside(); 3]; 3];
        for a in 0..3 {
            tangent[a][a] += 2.0 * self.shear;
        }
        tangent
    }
}

/// The planes that yield.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Planes {
    /// That of the largest and the least stress.
    Main,
    /// Those of an edge on which the two lesser compressions are equal, as in triaxial compression.
    Compression,
    /// Those of an edge on which the two larger compressions are equal, as in triaxial extension.
    Extension,
    /// All: no stress but the attraction is left.
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
    pub(super) planes: Planes,
}

/// A return to one of the planes or to an edge: stress of the upper and the lower end of the circle,
/// $`U = U^{tr} - \Lambda (g_U - l_U y)`$ and $`W = W^{tr} + \Lambda (g_W + l_W y)`$ with y = sin ψ, of the flow of eq. 126c.
struct Path<'a> {
    hyperbola: &'a Hyperbola,
    trial: [f64; 2],
    constant: [f64; 2],
    dilating: [f64; 2],
    gamma_p: f64,
}

/// What a share of the asymptote gives.
struct Along {
    /// Λ and its derivative by the share \[-\].
    multiplier: [f64; 2],
    /// sin ψ and its derivative.
    dilatancy: [f64; 2],
    /// Strain of the hyperbola less that of the flow \[-\], and its derivative.
    residual: [f64; 2],
    /// s \[stress\].
    confinement: f64,
}

impl Path<'_> {
    fn new<'a>(
        hyperbola: &'a Hyperbola,
        moduli: &Moduli,
        trial: &Principal,
        gamma_p: f64,
        planes: Planes,
    ) -> Path<'a> {
        let (shear, aside) = (moduli.shear, moduli.aside());
        let single = [shear, shear + aside];
        let shared = [0.5 * shear, 0.5 * shear + aside];
        let [largest, middle, least] = *trial;
        let (trial, upper, lower) = match planes {
            Planes::Compression => ([largest, 0.5 * (middle + least)], single, shared),
            Planes::Extension => ([0.5 * (largest + middle), least], shared, single),
            Planes::Main | Planes::Apex => ([largest, least], single, single),
        };
        Path {
            hyperbola,
            trial,
            constant: [upper[0], lower[0]],
            dilating: [upper[1], lower[1]],
            gamma_p,
        }
    }

    /// The state whose circle mobilises this share (eq. 127a).
    fn at(&self, share: f64) -> Along {
        let k = self.hyperbola.asymptote;
        let dilatancy @ [y, y_by] = self.hyperbola.dilatancy(share);
        let [g_u, g_w] = self.paces(y);
        let [up, low] = self.trial;
        let from = self.hyperbola.confinement(low);
        let numerator = up - low - k * share * from;
        let denominator = g_u + g_w + k * share * g_w;
        let multiplier = numerator / denominator;
        let denominator_by =
            (self.dilating[1] * (1.0 + k * share) - self.dilating[0]) * y_by + k * g_w;
        let multiplier_by = -(k * from + multiplier * denominator_by) / denominator;
        let confinement = from + multiplier * g_w;
        let confinement_by = multiplier_by * g_w + multiplier * self.dilating[1] * y_by;
        let strain = self.hyperbola.strain(confinement, share);
        Along {
            multiplier: [multiplier, multiplier_by],
            dilatancy,
            residual: [
                strain.value - self.gamma_p - multiplier,
                strain.by_s * confinement_by + strain.by_share - multiplier_by,
            ],
            confinement,
        }
    }

    /// Decrease of U and increase of W over Λ \[stress\].
    fn paces(&self, y: f64) -> [f64; 2] {
        [
            self.constant[0] - self.dilating[0] * y,
            self.constant[1] + self.dilating[1] * y,
        ]
    }

    /// The share at which hyperbola and flow have the same strain; that at failure where flow goes on.
    fn share(&self) -> Option<f64> {
        let failure = self.hyperbola.failure_ratio;
        if self.gamma_p.is_infinite() || self.at(failure).residual[0] <= 0.0 {
            return Some(failure);
        }
        let (mut low, mut high) = (0.0, failure);
        let mut share = self
            .hyperbola
            .share(self.hyperbola.confinement(self.trial[1]), self.gamma_p);
        for _ in 0..MOST_CORRECTIONS {
            let own = self.at(share);
            let [residual, slope] = own.residual;
            if residual > 0.0 {
                high = share;
            } else {
                low = share;
            }
            if residual.abs() <= 4.0 * f64::EPSILON * (self.gamma_p + own.multiplier[0].abs()) {
                return Some(share);
            }
            let next = share - residual / slope;
            let next = if next > low && next < high {
                next
            } else {
                0.5 * (low + high)
            };
            if (next - share).abs() <= f64::EPSILON * share {
                return Some(next);
            }
            share = next;
        }
        (high - low <= 8.0 * f64::EPSILON).then_some(share)
    }

    /// ∂(Λ, x)/∂(U, W) of the trial stress, with x held at failure.
    fn derivatives(&self, share: f64, own: &Along) -> [[f64; 2]; 2] {
        let k = self.hyperbola.asymptote;
        let [y, y_by] = own.dilatancy;
        let [g_u, g_w] = self.paces(y);
        let denominator = g_u + g_w + k * share * g_w;
        let circle = [1.0, -(1.0 + k * share)];
        if share >= self.hyperbola.failure_ratio {
            return [circle.map(|by| by / denominator), [0.0; 2]];
        }
        let multiplier = own.multiplier[0];
        let strain = self.hyperbola.strain(own.confinement, share);
        // -denominator dΛ + a dx = -(dU - (1 + k x) dW) and b dΛ + c dx = -s' dW.
        let denominator_by =
            (self.dilating[1] * (1.0 + k * share) - self.dilating[0]) * y_by + k * g_w;
        let from = self.hyperbola.confinement(self.trial[1]);
        let a = -k * from - multiplier * denominator_by;
        let b = strain.by_s * g_w - 1.0;
        let c = strain.by_s * multiplier * self.dilating[1] * y_by + strain.by_share;
        let determinant = -denominator * c - a * b;
        let by = |index: usize| {
            let pressed = if index == 1 { strain.by_s } else { 0.0 };
            [
                (-circle[index] * c + a * pressed) / determinant,
                (denominator * pressed + b * circle[index]) / determinant,
            ]
        };
        let (up, low) = (by(0), by(1));
        [[up[0], low[0]], [up[1], low[1]]]
    }

    /// The derivative of the stress by the trial strain \[stress\].
    fn tangent(&self, moduli: &Moduli, share: f64, own: &Along, planes: Planes) -> [[f64; 3]; 3] {
        let ([multiplier, _], [y, y_by]) = (own.multiplier, own.dilatancy);
        let [g_u, g_w] = self.paces(y);
        let elastic = moduli.tangent();
        let mean = |a: usize, b: usize| -> Principal {
            std::array::from_fn(|c| 0.5 * (elastic[a][c] + elastic[b][c]))
        };
        let rows: [Principal; 2] = match planes {
            Planes::Main | Planes::Apex => [elastic[0], elastic[2]],
            Planes::Compression => [elastic[0], mean(1, 2)],
            Planes::Extension => [mean(0, 1), elastic[2]],
        };
        let [multiplier_by, share_by] = self.derivatives(share, own);
        let by = |[up, low]: [f64; 2]| -> Principal {
            std::array::from_fn(|c| up * rows[0][c] + low * rows[1][c])
        };
        let (flow, turn) = (by(multiplier_by), by(share_by));
        let moved = |row: &Principal, pace: f64, dilating: f64| -> Principal {
            let turned = multiplier * dilating * y_by;
            std::array::from_fn(|c| row[c] + pace * flow[c] + turned * turn[c])
        };
        let upper = moved(&rows[0], -g_u, self.dilating[0]);
        let lower = moved(&rows[1], g_w, self.dilating[1]);
        let aside = moduli.aside();
        match planes {
            Planes::Main | Planes::Apex => [upper, moved(&elastic[1], aside * y, aside), lower],
            Planes::Compression => [upper, lower, lower],
            Planes::Extension => [upper, upper, lower],
        }
    }
}

/// Returns a trial stress beyond what soil of this plastic shear strain bears; none where the share was not found.
pub(super) fn sheared(
    hyperbola: &Hyperbola,
    moduli: &Moduli,
    trial: &Principal,
    gamma_p: f64,
) -> Option<Sheared> {
    let to = |planes| on(hyperbola, moduli, trial, gamma_p, planes);
    let (main, valid) = to(Planes::Main)?;
    if valid {
        return Some(main);
    }
    let mut beyond = true;
    for planes in [Planes::Compression, Planes::Extension] {
        let (edge, valid) = to(planes)?;
        if valid {
            return Some(edge);
        }
        beyond &= hyperbola.confinement(edge.stress[2]) <= 0.0 || edge.delta_gamma < 0.0;
    }
    beyond.then_some(Sheared {
        stress: [-hyperbola.attraction; 3],
        tangent: [[0.0; 3]; 3],
        delta_gamma: 0.0,
        planes: Planes::Apex,
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
    let path = Path::new(hyperbola, moduli, trial, gamma_p, planes);
    let share = path.share()?;
    let own = path.at(share);
    let ([multiplier, _], [y, _]) = (own.multiplier, own.dilatancy);
    let [_, g_w] = path.paces(y);
    let low = path.trial[1] + multiplier * g_w;
    // By the circle, and not by the way from a trial stress that may be far larger: the stress is on the surface to the last bit.
    let up = low + hyperbola.asymptote * share * hyperbola.confinement(low);
    let middle = trial[1] + multiplier * moduli.aside() * y;
    let inside = own.confinement > 0.0 && multiplier >= 0.0;
    let slack = 1e-14 * (trial[0].abs() + trial[2].abs());
    let (stress, valid) = match planes {
        Planes::Main | Planes::Apex => (
            [up, middle, low],
            inside && middle <= up + slack && middle >= low - slack,
        ),
        Planes::Compression => {
            let apart = (trial[1] - trial[2]) / (moduli.shear * (1.0 + y));
            (
                [up, low, low],
                inside && multiplier >= (1.0 - ROUND_OFF) * apart,
            )
        }
        Planes::Extension => {
            let apart = (trial[0] - trial[1]) / (moduli.shear * (1.0 - y));
            (
                [up, up, low],
                inside && multiplier >= (1.0 - ROUND_OFF) * apart,
            )
        }
    };
    let sheared = Sheared {
        stress,
        tangent: if valid {
            path.tangent(moduli, share, &own, planes)
        } else {
            [[0.0; 3]; 3]
        },
        delta_gamma: multiplier,
        planes,
    };
    Some((sheared, valid))
}
