//! The six-sided pyramid of Tresca and Mohr–Coulomb, with or without a cube that cuts its tip.
//!
//! With σ1 ≥ σ2 ≥ σ3 the shear planes are
//! $`(1+\sin\varphi)\,\sigma_i - (1-\sin\varphi)\,\sigma_j \le 2c\cos\varphi`$ for
//! (i, j) = (1,3), (1,2), (2,3), with the flow of the same form in the dilation angle ψ; the
//! tension planes are $`\sigma_i \le \sigma_t`$ with associated flow.

use crate::circle::{Circle, Flow, Planes, mirrored, turned};
use crate::elasticity::Moduli;
use crate::koiter::Plane;
use crate::law::{ON_SURFACE, mobilised, trial_stress};
use crate::spectral::principal::{Principal, descending, sorted, unsorted};
use crate::surface::{Outline, Part, PlanarSurface, Returned, excess, scale};
use crate::{Elasticity, History, MaterialError, NonlocalRates, Regime, ReturnMap};

const SHEAR_13: usize = 0;
const SHEAR_12: usize = 1;
const SHEAR_23: usize = 2;
const TENSION_1: usize = 3;
const TENSION_2: usize = 4;
const TENSION_3: usize = 5;

/// Strength in the terms of the planes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct PlaneStrength {
    /// sin φ, in \[0, 1).
    pub(crate) sin_friction: f64,
    /// sin ψ, in \[0, sin φ\].
    pub(crate) sin_dilation: f64,
    /// 2 c cos φ \[stress\].
    pub(crate) shear: f64,
    /// c cot φ \[stress\]; infinite without friction.
    pub(crate) apex: f64,
    /// Largest stress in tension \[stress\], less than `apex`.
    pub(crate) tension_cutoff: Option<f64>,
}

impl PlaneStrength {
    /// The planes of shear, those of the cut-off, and their parts.
    fn outlined<T>(&self, use_of: impl FnOnce(Outline<'_>) -> T) -> T {
        let shear = self.shear_planes();
        let Some(tension) = self.tension_cutoff else {
            let apex = Part::Vertex(Regime::Apex, [self.apex; 3], &ENDS_AT_APEX);
            let parts = [WHOLE[0], WHOLE[1], WHOLE[2], apex];
            let count = if self.apex.is_finite() { 4 } else { 3 };
            return use_of(Outline {
                planes: &shear,
                parts: &parts[..count],
            });
        };
        let cut = |axis: usize| {
            let mut normal = [0.0; 3];
            normal[axis] = 1.0;
            Plane {
                normal,
                flow: normal,
                strength: tension,
            }
        };
        let [first, second, third] = shear;
        let sine = self.sin_friction;
        let minor = ((1.0 + sine) * tension - self.shear) / (1.0 - sine);
        use_of(Outline {
            planes: &[first, second, third, cut(0), cut(1), cut(2)],
            parts: &truncated(tension, minor),
        })
    }

    fn shear_planes(&self) -> [Plane; 3] {
        [[0, 2], [0, 1], [1, 2]].map(|[major, minor]| {
            let direction = |sine: f64| {
                let mut direction = [0.0; 3];
                direction[major] = 1.0 + sine;
                direction[minor] = sine - 1.0;
                direction
            };
            Plane {
                normal: direction(self.sin_friction),
                flow: direction(self.sin_dilation),
                strength: self.shear,
            }
        })
    }

    /// The yield function \[stress\].
    pub(crate) fn yield_function(&self, tau: &Principal) -> f64 {
        let tau = sorted(tau, &descending(tau));
        self.outlined(|outline| excess(outline.planes, &tau))
    }

    /// Share of the shear strength that is mobilised \[-\].
    pub(crate) fn utilisation(&self, tau: &Principal) -> f64 {
        let [major, _, minor] = sorted(tau, &descending(tau));
        let strength = self.shear - (major + minor) * self.sin_friction;
        mobilised(major - minor, strength, scale(&self.shear_planes(), tau))
    }

    /// One return to the pyramid of this strength, for laws whose strength is found by iteration.
    pub(crate) fn return_map(
        &self,
        elasticity: &Elasticity,
        eps_e_trial: &Principal,
        history: History,
    ) -> Result<ReturnMap, MaterialError> {
        let bounds = |tau: &Principal| self.bounds(tau);
        let project = |strain: &_, trial: &_| {
            self.by_circle(&elasticity.moduli(), trial)
                .unwrap_or_else(|| {
                    self.outlined(|outline| outline.project(elasticity, strain, trial))
                })
        };
        return_to(elasticity, (bounds, project), eps_e_trial, history)
    }

    /// Excess and scale \[stress\] of a stress in descending order.
    fn bounds(&self, tau: &Principal) -> [f64; 2] {
        let planes = self.shear_planes();
        let cutoff = self.tension_cutoff.unwrap_or(f64::INFINITY);
        let excess = planes[SHEAR_13].excess(tau).max(tau[0] - cutoff);
        [excess, scale(&planes, tau)]
    }

    /// Whether a stress in descending order needs no return.
    pub(crate) fn holds(&self, tau: &Principal) -> bool {
        let [excess, scale] = self.bounds(tau);
        excess <= ON_SURFACE * scale
    }

    /// The return to the main plane of shear or to an edge beside it, of a trial stress in descending order; none where it does not go there.
    pub(crate) fn circle(&self, moduli: &Moduli, trial: &Principal) -> Option<OnCircle> {
        let pressure = mirrored(trial);
        let (sine, y) = (self.sin_friction, self.sin_dilation);
        let [upper, lower] = [1.0 - sine, 1.0 + sine];
        let cutoff = self.tension_cutoff.unwrap_or(f64::INFINITY);
        Planes::ALL.into_iter().find_map(|planes| {
            let circle = Circle::new(moduli, &pressure, planes);
            let ([up, low], [g_u, g_w]) = (circle.ends, circle.paces(y));
            let hardness = upper * g_u + lower * g_w;
            let multiplier = (upper * up - lower * low - self.shear) / hardness;
            let low = low + multiplier * g_w;
            // By the strength, and not by the way from a trial stress that may be far larger.
            let up = (lower * low + self.shear) / upper;
            let stress = circle.stress([up, low], multiplier, y);
            let is_there = circle.holds(&stress, multiplier, y) && -low <= cutoff;
            is_there.then_some(OnCircle {
                circle,
                ends: [up, low],
                stress,
                multiplier,
                multiplier_by: [upper / hardness, -lower / hardness],
            })
        })
    }

    /// The same, with the tangent.
    fn by_circle(&self, moduli: &Moduli, trial: &Principal) -> Option<Returned> {
        let state = self.circle(moduli, trial)?;
        let y = self.sin_dilation;
        let tangent = state.circle.tangent(&Flow {
            multiplier: state.multiplier,
            multiplier_by: state.multiplier_by,
            dilatancy: [y, 0.0],
            unknown_by: [0.0; 2],
        });
        Some(Returned {
            tau: mirrored(&state.stress),
            delta_eps_p: mirrored(&state.circle.plastic_strain(state.multiplier, y)),
            tangent: turned(&tangent),
            regime: state.circle.planes.regime(),
        })
    }
}

/// A return to the main plane of shear or to an edge beside it; stresses are positive in compression.
pub(crate) struct OnCircle {
    pub(crate) circle: Circle,
    /// The ends of the circle \[stress\].
    pub(crate) ends: [f64; 2],
    stress: Principal,
    /// Λ \[-\], and its derivatives by the ends of the circle of the trial stress.
    pub(crate) multiplier: f64,
    pub(crate) multiplier_by: [f64; 2],
}

/// Returns a trial strain to a surface that says excess and scale of a stress, and projects.
#[inline]
fn return_to(
    elasticity: &Elasticity,
    (bounds, project): (
        impl Fn(&Principal) -> [f64; 2],
        impl FnOnce(&Principal, &Principal) -> Returned,
    ),
    eps_e_trial: &Principal,
    history: History,
) -> Result<ReturnMap, MaterialError> {
    let order = descending(eps_e_trial);
    let strain = sorted(eps_e_trial, &order);
    let trial = trial_stress(elasticity, &strain)?;
    let [excess, scale] = bounds(&trial);
    if excess <= ON_SURFACE * scale {
        let tau = unsorted(&trial, &order);
        return Ok(ReturnMap::elastic(elasticity, tau, history));
    }
    let returned = project(&strain, &trial);
    let delta_eps_p = unsorted(&returned.delta_eps_p, &order);
    let mut tangent = [[0.0; 3]; 3];
    for a in 0..3 {
        tangent[order[a]] = unsorted(&returned.tangent[a], &order);
    }
    Ok(ReturnMap {
        tau: unsorted(&returned.tau, &order),
        tangent,
        delta_eps_p,
        history: history.after(&delta_eps_p),
        regime: returned.regime,
        nonlocal: NonlocalRates::NONE,
    })
}

/// An elastic, perfectly plastic body with a [`PlaneStrength`].
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Pyramid {
    elasticity: Elasticity,
    strength: PlaneStrength,
    /// Its parts, of a body that is asked often.
    surface: Option<PlanarSurface>,
}

impl Pyramid {
    /// For many returns.
    pub(crate) fn new(elasticity: Elasticity, strength: &PlaneStrength) -> Self {
        let surface = strength.outlined(|outline| PlanarSurface::new(&elasticity, outline));
        Self {
            surface: Some(surface),
            ..Self::once(elasticity, strength)
        }
    }

    /// For one return or few.
    pub(crate) fn once(elasticity: Elasticity, strength: &PlaneStrength) -> Self {
        Self {
            elasticity,
            strength: *strength,
            surface: None,
        }
    }

    pub(crate) fn stiffness_bound(&self) -> &Elasticity {
        &self.elasticity
    }

    pub(crate) fn yield_function(&self, tau: &Principal) -> f64 {
        self.strength.yield_function(tau)
    }

    pub(crate) fn stress_scale(&self, tau: &Principal) -> f64 {
        scale(&self.strength.shear_planes(), tau)
    }

    /// Share of the shear strength that is mobilised \[-\].
    pub(crate) fn utilisation(&self, tau: &Principal) -> f64 {
        self.strength.utilisation(tau)
    }

    pub(crate) fn return_map(
        &self,
        eps_e_trial: &Principal,
        history: History,
    ) -> Result<ReturnMap, MaterialError> {
        let Some(surface) = &self.surface else {
            return (self.strength).return_map(&self.elasticity, eps_e_trial, history);
        };
        let bounds = |tau: &Principal| [surface.yield_function(tau), surface.stress_scale(tau)];
        let project = |strain: &_, trial: &_| surface.project(strain, trial);
        return_to(&self.elasticity, (bounds, project), eps_e_trial, history)
    }
}

/// The parts of a pyramid before its apex, or of a prism.
const WHOLE: [Part; 3] = [
    Part::Face(Regime::Smooth, SHEAR_13),
    Part::Edge(Regime::RightEdge, [SHEAR_13, SHEAR_23]),
    Part::Edge(Regime::LeftEdge, [SHEAR_13, SHEAR_12]),
];

/// The edges that end at the apex, and the planes that end them.
const ENDS_AT_APEX: [([usize; 2], usize); 2] = [
    ([SHEAR_13, SHEAR_23], SHEAR_12),
    ([SHEAR_13, SHEAR_12], SHEAR_23),
];

/// The parts of a pyramid or prism cut at `tension`, where the shear plane has the least stress `minor`.
fn truncated(tension: f64, minor: f64) -> [Part; 9] {
    [
        Part::Face(Regime::Smooth, SHEAR_13),
        Part::Face(Regime::Tension, TENSION_1),
        Part::Edge(Regime::TensionShear, [SHEAR_13, TENSION_1]),
        Part::Edge(Regime::RightEdge, [SHEAR_13, SHEAR_23]),
        Part::Edge(Regime::LeftEdge, [SHEAR_13, SHEAR_12]),
        Part::Edge(Regime::TensionEdge, [TENSION_1, TENSION_2]),
        Part::Vertex(
            Regime::TensionCorner,
            [tension, minor, minor],
            &[
                ([SHEAR_13, SHEAR_12], TENSION_1),
                ([SHEAR_13, TENSION_1], SHEAR_12),
            ],
        ),
        Part::Vertex(
            Regime::TensionCorner,
            [tension, tension, minor],
            &[
                ([SHEAR_13, TENSION_1], TENSION_2),
                ([SHEAR_13, SHEAR_23], TENSION_1),
                ([TENSION_1, TENSION_2], SHEAR_13),
            ],
        ),
        Part::Vertex(
            Regime::TensionApex,
            [tension; 3],
            &[([TENSION_1, TENSION_2], TENSION_3)],
        ),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `SplitMix64`, uniform in (-1, 1).
    fn symmetric(state: &mut u64) -> f64 {
        *state = state.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = *state;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    /// Strengths with cohesion 1 for pairs of angles in degrees and cut-offs as shares of the
    /// apex, or of the cohesion where there is none.
    fn strengths() -> Vec<PlaneStrength> {
        let mut strengths = Vec::new();
        for (friction, dilation) in [
            (0.0, 0.0),
            (1e-6, 0.0),
            (5.0, 2.0),
            (20.0, 0.0),
            (20.0, 20.0),
            (45.0, 0.1),
            (70.0, 5.0),
        ] {
            let friction = f64::to_radians(friction);
            let apex = if friction > 0.0 {
                1.0 / friction.tan()
            } else {
                f64::INFINITY
            };
            for cutoff in [None, Some(0.0), Some(0.3), Some(0.99)] {
                strengths.push(PlaneStrength {
                    sin_friction: friction.sin(),
                    sin_dilation: f64::to_radians(dilation).sin(),
                    shear: 2.0 * friction.cos(),
                    apex,
                    tension_cutoff: cutoff.map(|share| share * if apex < 1e3 { apex } else { 1.0 }),
                });
            }
        }
        strengths
    }

    /// GOAL: the regions tile the space of trial states, without gap and without overlap, also
    /// where flow is not associated. With that the return is unique.
    #[test]
    fn every_trial_state_lies_in_exactly_one_region() {
        let mut state = 7;
        for poisson in [-0.5, 0.0, 0.3, 0.4999] {
            let elasticity = Elasticity::new(100.0, poisson).unwrap();
            for strength in strengths() {
                let pyramid = Pyramid::new(elasticity, &strength);
                let surface = pyramid.surface.unwrap();
                let mut seen = std::collections::BTreeSet::new();
                for _ in 0..5_000 {
                    let size = 10_f64.powf(2.5 * symmetric(&mut state));
                    let middle = 2.0 * size * symmetric(&mut state);
                    let tau = [0; 3].map(|_| middle + size * symmetric(&mut state));
                    let trial = sorted(&tau, &descending(&tau));
                    if surface.yield_function(&trial) > 1e-9 * surface.stress_scale(&trial) {
                        let claims = surface.claims(&trial);
                        assert_eq!(
                            claims.len(),
                            1,
                            "{poisson} {strength:?} {trial:?} {claims:?}"
                        );
                        assert_eq!(
                            claims[0],
                            surface.project(&elasticity.strain(&trial), &trial).regime
                        );
                        seen.insert(format!("{:?}", claims[0]));
                    }
                }
                assert!(seen.len() >= 3, "{strength:?}: only {seen:?}");
            }
        }
    }
}
