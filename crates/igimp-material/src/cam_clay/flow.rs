//! The return to the surface of modified Cam-clay: volume, shear and the multiplier of flow by Newton's method (theory, eqs. 90
//! and 91).

use super::elastic::{Invariants, PressureElasticity, Relative, Stress};
use crate::MaterialError;
use crate::spectral::principal::Principal;

/// Most iterations of a return.
const MOST: usize = 40;

/// Size of the residual, in strain, of a return that is found: few digits above round-off.
const TOLERANCE: f64 = 2e-15;

/// Parameters of plastic flow.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Flow {
    /// M \[-\].
    pub(super) critical_ratio: f64,
    /// 1/(λ* - κ*) \[-\].
    pub(super) hardening: f64,
}

/// A stress on the surface.
#[derive(Clone, Copy, Debug)]
pub(super) struct Returned {
    pub(super) stress: Stress,
    /// ∂(p, q)/∂(ε_v, ε_s) of the trial strain \[stress\].
    pub(super) tangent: [[f64; 2]; 2],
    /// Stiffness of a turn of the deviator \[stress\].
    pub(super) turning: f64,
    pub(super) preconsolidation: f64,
    volume: f64,
    /// Elastic shear over that of the trial strain \[-\].
    shear_ratio: f64,
}

impl Returned {
    /// The plastic strain, extension positive.
    pub(super) fn delta_eps_p(&self, trial: &Invariants) -> Principal {
        let volume = trial.volume - self.volume;
        let shear = trial.shear * (1.0 - self.shear_ratio);
        trial
            .direction
            .map(|n| 1.5_f64.sqrt() * shear * n - volume / 3.0)
    }
}

/// The elastic strain, and the multiplier of flow \[-\].
type Unknowns = [f64; 3];

/// Residuals and their derivatives.
struct System {
    residual: [f64; 3],
    derivative: [[f64; 3]; 3],
}

impl Flow {
    /// Returns a trial strain beyond the surface of `p_c`.
    pub(super) fn return_to(
        &self,
        elastic: &PressureElasticity,
        trial: &Invariants,
        p_c: f64,
    ) -> Result<Returned, MaterialError> {
        let log_p_c = p_c.ln();
        let at = |x: &Unknowns| self.system(elastic, trial, log_p_c, x);
        let first = [trial.volume, trial.shear, 0.0];
        // Roots of a multiplier below zero would flow against the stress.
        let flows = |(x, _): &(Unknowns, System)| x[2] >= 0.0;
        let found = newton(trial, at, first).filter(flows).or_else(|| {
            // Far from the surface: the root is enclosed, and Newton's method begins beside it.
            newton(trial, at, self.enclosed(elastic, trial, log_p_c)?).filter(flows)
        });
        found
            .and_then(|(x, system)| self.returned(elastic, trial, p_c, &x, &system))
            .ok_or(MaterialError::NotConverged {
                law: "modified Cam-clay",
            })
    }

    /// Unknowns close to the root, by the share t of the elastic shear in the trial one: f is positive at t = 1, and negative for
    /// small t, where the multiplier is large.
    fn enclosed(
        &self,
        elastic: &PressureElasticity,
        trial: &Invariants,
        log_p_c: f64,
    ) -> Option<Unknowns> {
        let at = |log_share: f64| -> Option<(Unknowns, f64)> {
            let x = self.of_share(elastic, trial, log_share.exp())?;
            let outside = self.system(elastic, trial, log_p_c, &x).residual[2];
            (!outside.is_nan()).then_some((x, outside))
        };
        let (mut low, mut high) = (-1e-3, 0.0);
        while at(low)?.1 > 0.0 {
            high = low;
            low *= 2.0;
            if low < -600.0 {
                return None;
            }
        }
        for _ in 0..50 {
            let middle = 0.5 * (low + high);
            if at(middle)?.1 > 0.0 {
                high = middle;
            } else {
                low = middle;
            }
        }
        Some(at(0.5 * (low + high))?.0)
    }

    /// The strains and the multiplier of a share of the elastic shear: flow in volume follows from flow in shear.
    fn of_share(
        &self,
        elastic: &PressureElasticity,
        trial: &Invariants,
        share: f64,
    ) -> Option<Unknowns> {
        let shear = share * trial.shear;
        let square = self.critical_ratio * self.critical_ratio;
        let over = (1.0 - share) / share / 6.0;
        // By how much the volume is too large: it grows with the volume.
        let ratio = |volume: f64| elastic.relative(volume, shear).shear;
        let too_large = |volume: f64| {
            let ratio = ratio(volume);
            volume - trial.volume + over * (square / ratio - (3.0 * shear).powi(2) * ratio)
        };
        let start = too_large(trial.volume);
        let mut reach = elastic.swelling;
        let beyond = |reach: f64| trial.volume - reach * start.signum();
        while too_large(beyond(reach)) * start > 0.0 {
            reach *= 2.0;
            if reach > 1e4 {
                return None;
            }
        }
        let (mut near, mut far) = (trial.volume, beyond(reach));
        for _ in 0..60 {
            let middle = 0.5 * (near + far);
            if too_large(middle) * start > 0.0 {
                near = middle;
            } else {
                far = middle;
            }
        }
        let ratio = ratio(near);
        let eta = 3.0 * shear * ratio;
        Some([near, shear, over * (square + eta * eta) / ratio])
    }

    /// Flow in volume and in shear over the multiplier, and their derivatives by η = q/p.
    fn direction(&self, eta: f64) -> ([f64; 2], [f64; 2]) {
        let square = self.critical_ratio * self.critical_ratio;
        let sum = square + eta * eta;
        let volume = (square - eta * eta) / sum;
        let shear = 2.0 * eta / sum;
        let by_eta = [
            -4.0 * eta * square / (sum * sum),
            2.0 * (square - eta * eta) / (sum * sum),
        ];
        ([volume, shear], by_eta)
    }

    /// The three equations at an elastic strain and a multiplier.
    fn system(
        &self,
        elastic: &PressureElasticity,
        trial: &Invariants,
        log_p_c: f64,
        &[volume, shear, multiplier]: &Unknowns,
    ) -> System {
        let relative = elastic.relative(volume, shear);
        let Relative {
            eta,
            log_p_by,
            eta_by,
            ..
        } = relative;
        let square = self.critical_ratio * self.critical_ratio;
        let ([flow_v, flow_s], [v_eta, s_eta]) = self.direction(eta);
        let kappa = elastic.swelling;
        let bow = 2.0 * eta / (square + eta * eta);
        let outside =
            self.log_equivalent(&relative) - log_p_c - self.hardening * (trial.volume - volume);
        System {
            residual: [
                volume + multiplier * flow_v - trial.volume,
                shear + multiplier * flow_s - trial.shear,
                kappa * outside,
            ],
            derivative: [
                [
                    1.0 + multiplier * v_eta * eta_by[0],
                    multiplier * v_eta * eta_by[1],
                    flow_v,
                ],
                [
                    multiplier * s_eta * eta_by[0],
                    1.0 + multiplier * s_eta * eta_by[1],
                    flow_s,
                ],
                [
                    kappa * (log_p_by[0] + bow * eta_by[0] + self.hardening),
                    kappa * (log_p_by[1] + bow * eta_by[1]),
                    0.0,
                ],
            ],
        }
    }

    /// The logarithm of the pressure on the hydrostatic axis of the surface through a state.
    pub(super) fn log_equivalent(&self, relative: &Relative) -> f64 {
        relative.log_p + (relative.eta / self.critical_ratio).powi(2).ln_1p()
    }

    fn returned(
        &self,
        elastic: &PressureElasticity,
        trial: &Invariants,
        p_c: f64,
        x: &Unknowns,
        system: &System,
    ) -> Option<Returned> {
        let by_volume = solved(
            &system.derivative,
            &[1.0, 0.0, elastic.swelling * self.hardening],
        )?;
        let by_shear = solved(&system.derivative, &[0.0, 1.0, 0.0])?;
        let of = |row: &[f64; 2], by: &[f64; 3]| row[0] * by[0] + row[1] * by[1];
        let stress = elastic.stress(x[0], x[1]);
        let [p_row, q_row @ [_, qs]] = &stress.stiffness;
        let Relative { eta, shear, .. } = elastic.relative(x[0], x[1]);
        let square = self.critical_ratio * self.critical_ratio;
        // 2 η/(M² + η²) over the elastic shear strain, which may vanish.
        let shear_ratio = 1.0 / (1.0 + x[2] * 6.0 * shear / (square + eta * eta));
        let preconsolidation = p_c * (self.hardening * (trial.volume - x[0])).exp();
        let is_finite = [stress.p, stress.q, *qs, preconsolidation];
        let is_finite = is_finite.iter().all(|value| value.is_finite());
        is_finite.then_some(Returned {
            stress,
            tangent: [
                [of(p_row, &by_volume), of(p_row, &by_shear)],
                [of(q_row, &by_volume), of(q_row, &by_shear)],
            ],
            turning: 2.0 * elastic.shear(stress.p) * shear_ratio,
            preconsolidation,
            volume: x[0],
            shear_ratio,
        })
    }
}

/// Newton's method from some unknowns, with corrections that are halved until they help; none where that ends before the root.
fn newton(
    trial: &Invariants,
    at: impl Fn(&Unknowns) -> System,
    mut x: Unknowns,
) -> Option<(Unknowns, System)> {
    let tolerance = TOLERANCE * (1.0 + trial.volume.abs() + trial.shear);
    let size = |system: &System| {
        let [r, s, t] = system.residual;
        r.abs().max(s.abs()).max(t.abs())
    };
    let mut system = at(&x);
    for _ in 0..MOST {
        let before = size(&system);
        if before <= tolerance {
            return Some((x, system));
        }
        let step = solved(&system.derivative, &system.residual)?;
        let shortened = (0..8).find_map(|halvings| {
            let share = 0.5_f64.powi(halvings);
            let next: Unknowns = std::array::from_fn(|k| x[k] - share * step[k]);
            let system = at(&next);
            (next[1] >= 0.0 && size(&system) < before).then_some((next, system))
        });
        let Some((next, next_system)) = shortened else {
            // Round-off is all that is left, or nothing helps.
            return (before <= 20.0 * tolerance).then_some((x, system));
        };
        (x, system) = (next, next_system);
    }
    None
}

/// The solution of three linear equations by Cramer's rule; none of singular ones.
fn solved(matrix: &[[f64; 3]; 3], rhs: &[f64; 3]) -> Option<[f64; 3]> {
    let [a, b, c] = matrix;
    let minors = |b: &[f64; 3], c: &[f64; 3]| {
        [
            b[1] * c[2] - b[2] * c[1],
            b[2] * c[0] - b[0] * c[2],
            b[0] * c[1] - b[1] * c[0],
        ]
    };
    let rows = [minors(b, c), minors(c, a), minors(a, b)];
    let determinant = a[0] * rows[0][0] + a[1] * rows[0][1] + a[2] * rows[0][2];
    let solution: [f64; 3] = std::array::from_fn(|k| {
        (rows[0][k] * rhs[0] + rows[1][k] * rhs[1] + rows[2][k] * rhs[2]) / determinant
    });
    solution
        .iter()
        .all(|value| value.is_finite())
        .then_some(solution)
}
