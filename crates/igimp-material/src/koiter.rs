//! Return to a convex surface made of planes, exactly and without iteration.
//!
//! In principal space a plane is `` $`a\cdot\tau \le k`$ `` with the flow direction b. Where the
//! planes A of one face or edge yield together (Koiter 1953), the return is linear,
//!
//! ```math
//! \tau = \tau^{tr} - DB\,(A^T DB)^{-1} F,\qquad F = A^T\tau^{tr} - k,\qquad
//! D_{alg} = D - DB\,(A^T DB)^{-1} A^T D
//! ```
//!
//! with the multipliers `` $`\lambda = (A^T DB)^{-1}F`$ ``, and a vertex is a point with
//! `` $`D_{alg} = 0`$ ``. Every face, edge and vertex is the target of one region of trial
//! states, bounded by planes (Clausen, Damkilde & Andersen 2006); which region holds a state is
//! decided by the signs of a few linear forms, here called gates.
//!
//! States come with their principal values in descending order and leave so.

use crate::principal::{Principal, apply, dot, largest};
use crate::{Elasticity, Regime};

/// Share of the stress scale by which a returned stress may exceed a plane: round-off, and less
/// than what counts as on the surface before a return.
const ROUND_OFF: f64 = 1e-13;

/// A yield plane `normal` · τ ≤ `strength`, with the direction of plastic flow.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Plane {
    pub(crate) normal: Principal,
    pub(crate) flow: Principal,
    pub(crate) strength: f64,
}

impl Plane {
    /// By how much a stress exceeds the plane.
    #[inline]
    fn excess(&self, tau: &Principal) -> f64 {
        dot(&self.normal, tau) - self.strength
    }
}

/// A linear form of the trial stress that is not negative where its region lies.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Gate {
    normal: Principal,
    offset: f64,
}

impl Gate {
    #[inline]
    fn value(&self, trial: &Principal) -> f64 {
        dot(&self.normal, trial) - self.offset
    }
}

/// Planes that yield together, each with its column of `` $`DB\,(A^T DB)^{-1}`$ ``.
type Flat = Vec<(Plane, Principal)>;

/// What a region is returned to.
#[derive(Debug, Clone, PartialEq)]
enum Target {
    Flat(Flat),
    Vertex(Principal),
}

/// A part of the surface and the trial states that return to it.
#[derive(Debug, Clone, PartialEq)]
struct Region {
    regime: Regime,
    target: Target,
    gates: Vec<Gate>,
    tangent: [[f64; 3]; 3],
}

impl Region {
    /// How far inside the region the trial stress is; negative outside.
    #[inline]
    fn depth(&self, trial: &Principal) -> f64 {
        self.gates
            .iter()
            .fold(f64::INFINITY, |least, gate| least.min(gate.value(trial)))
    }

    /// The trial stress taken to the target.
    #[inline]
    fn project(&self, trial: &Principal) -> Returned<'_> {
        let (mut tau, mut taken) = (*trial, [0.0; 3]);
        match &self.target {
            Target::Vertex(point) => {
                tau = *point;
                taken = std::array::from_fn(|a| trial[a] - point[a]);
            }
            Target::Flat(flat) => {
                // The second pass removes the round-off of a first one from far outside.
                for _ in 0..2 {
                    let mut correction = [0.0; 3];
                    for (plane, column) in flat {
                        let excess = plane.excess(&tau);
                        for a in 0..3 {
                            correction[a] += excess * column[a];
                        }
                    }
                    for a in 0..3 {
                        tau[a] -= correction[a];
                        taken[a] += correction[a];
                    }
                }
            }
        }
        Returned {
            tau,
            taken,
            tangent: &self.tangent,
            regime: self.regime,
        }
    }
}

/// A stress returned to the surface.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Returned<'a> {
    pub(crate) tau: Principal,
    /// Trial stress less returned stress.
    pub(crate) taken: Principal,
    pub(crate) tangent: &'a [[f64; 3]; 3],
    pub(crate) regime: Regime,
}

/// A convex surface of planes with its faces, edges and vertices.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct PlanarSurface {
    stiffness: [[f64; 3]; 3],
    planes: Vec<Plane>,
    /// The greatest strength of a plane.
    strength: f64,
    regions: Vec<Region>,
}

impl PlanarSurface {
    /// A surface that has planes but no regions yet. List regions from the common to the rare;
    /// the last one must be admissible whatever the trial state.
    pub(crate) fn new(elasticity: &Elasticity, planes: Vec<Plane>) -> Self {
        let strength = planes
            .iter()
            .fold(0.0, |most: f64, plane| most.max(plane.strength));
        Self {
            stiffness: elasticity.tangent(),
            planes,
            strength,
            regions: Vec::new(),
        }
    }

    /// Adds the face of plane `p`.
    pub(crate) fn face(mut self, regime: Regime, p: usize) -> Self {
        let plane = self.planes[p];
        let flow = apply(&self.stiffness, &plane.flow);
        let hardness = dot(&plane.normal, &flow);
        let flat = vec![(plane, flow.map(|component| component / hardness))];
        let gates = vec![Gate {
            normal: plane.normal,
            offset: plane.strength,
        }];
        self.push_flat(regime, flat, gates);
        self
    }

    /// Adds the edge of planes `p` and `q`; its gates are the two multipliers.
    pub(crate) fn edge(mut self, regime: Regime, [p, q]: [usize; 2]) -> Self {
        let planes = [self.planes[p], self.planes[q]];
        let (inverse, flat) = self.joint(planes);
        let gates = (0..2)
            .map(|k| {
                let weight = inverse[k].map(|entry| entry * self.hardness(&planes[k]));
                combination(&[(planes[0], weight[0]), (planes[1], weight[1])])
            })
            .collect();
        self.push_flat(regime, flat, gates);
        self
    }

    /// Adds the vertex at `point`. Every edge that ends there is given by its two planes and the
    /// plane that ends it: the vertex owns the trial states whose return to any of these edges
    /// would overshoot.
    pub(crate) fn vertex(
        mut self,
        regime: Regime,
        point: Principal,
        edges: &[([usize; 2], usize)],
    ) -> Self {
        let gates = edges
            .iter()
            .map(|&([p, q], end)| {
                let end = self.planes[end];
                let (_, flat) = self.joint([self.planes[p], self.planes[q]]);
                let weight = |k: usize| -dot(&end.normal, &flat[k].1);
                combination(&[(end, 1.0), (flat[0].0, weight(0)), (flat[1].0, weight(1))])
            })
            .collect();
        let target = Target::Vertex(point);
        self.regions.push(Region {
            regime,
            target,
            gates,
            tangent: [[0.0; 3]; 3],
        });
        self
    }

    /// The largest excess over any plane \[stress\]: the yield function.
    #[inline]
    pub(crate) fn yield_function(&self, tau: &Principal) -> f64 {
        self.planes
            .iter()
            .fold(f64::NEG_INFINITY, |most, plane| most.max(plane.excess(tau)))
    }

    /// What round-off in [`Self::yield_function`] is relative to \[stress\]: the greatest strength
    /// plus twice the largest stress, as no plane weighs its stresses by more than two in all.
    #[inline]
    pub(crate) fn stress_scale(&self, tau: &Principal) -> f64 {
        self.strength + 2.0 * largest(tau)
    }

    /// Returns an inadmissible trial stress to the surface.
    pub(crate) fn project(&self, trial: &Principal) -> Returned<'_> {
        let mut best: Option<(f64, Returned<'_>)> = None;
        for region in &self.regions {
            let depth = region.depth(trial);
            // Round-off may put a state on the common wall of two regions outside both: then the
            // nearer one takes it.
            if best.is_some_and(|(deepest, _)| depth <= deepest) {
                continue;
            }
            let returned = region.project(trial);
            if self.admits(&returned.tau) {
                if depth >= 0.0 {
                    return returned;
                }
                best = Some((depth, returned));
            }
        }
        let last = &self.regions[self.regions.len() - 1];
        best.map_or_else(|| last.project(trial), |(_, returned)| returned)
    }

    #[inline]
    fn admits(&self, tau: &Principal) -> bool {
        self.yield_function(tau) <= ROUND_OFF * self.stress_scale(tau)
    }

    /// The elastic stiffness against flow on one plane, `` $`a\cdot D b`$ ``.
    fn hardness(&self, plane: &Plane) -> f64 {
        dot(&plane.normal, &apply(&self.stiffness, &plane.flow))
    }

    /// `` $`(A^T DB)^{-1}`$ `` of two planes, and the planes with their columns.
    fn joint(&self, planes: [Plane; 2]) -> ([[f64; 2]; 2], Flat) {
        let flows = planes.map(|plane| apply(&self.stiffness, &plane.flow));
        let m = planes.map(|plane| flows.map(|flow| dot(&plane.normal, &flow)));
        let determinant = m[0][0] * m[1][1] - m[0][1] * m[1][0];
        let inverse = [[m[1][1], -m[0][1]], [-m[1][0], m[0][0]]]
            .map(|row: [f64; 2]| row.map(|entry| entry / determinant));
        let column = |k: usize| {
            std::array::from_fn(|a| flows[0][a] * inverse[0][k] + flows[1][a] * inverse[1][k])
        };
        (
            inverse,
            vec![(planes[0], column(0)), (planes[1], column(1))],
        )
    }

    fn push_flat(&mut self, regime: Regime, flat: Flat, gates: Vec<Gate>) {
        let mut tangent = self.stiffness;
        for (plane, column) in &flat {
            let row = apply(&self.stiffness, &plane.normal);
            for a in 0..3 {
                for b in 0..3 {
                    tangent[a][b] -= column[a] * row[b];
                }
            }
        }
        self.regions.push(Region {
            regime,
            target: Target::Flat(flat),
            gates,
            tangent,
        });
    }
}

/// The gate Σ weight · excess.
fn combination(terms: &[(Plane, f64)]) -> Gate {
    let mut gate = Gate {
        normal: [0.0; 3],
        offset: 0.0,
    };
    for (plane, weight) in terms {
        for a in 0..3 {
            gate.normal[a] += weight * plane.normal[a];
        }
        gate.offset += weight * plane.strength;
    }
    gate
}

#[cfg(test)]
impl PlanarSurface {
    /// The regimes of all regions that hold the trial stress and return it admissibly.
    pub(crate) fn claims(&self, trial: &Principal) -> Vec<Regime> {
        let holds = |region: &&Region| {
            region.depth(trial) >= 0.0 && self.admits(&region.project(trial).tau)
        };
        self.regions
            .iter()
            .filter(holds)
            .map(|region| region.regime)
            .collect()
    }
}
