//! Return to a convex surface made of planes, exactly and without iteration.
//!
//! A plane is `` $`a\cdot\tau \le k`$ `` with the flow direction b. Where planes yield together
//! (Koiter 1953), plastic strain is `` $`\Delta\varepsilon_p = \sum\lambda_k b_k`$ `` with
//! multipliers that are not negative, and everything is linear in principal space. With the
//! excess `` $`F_k = a_k\cdot\tau^{tr} - k_k`$ `` (Clausen, Damkilde & Andersen 2006):
//!
//! ```math
//! \begin{aligned}
//! \text{face}&: & \lambda &= F/(a\cdot Db), &
//!   \tau &= \tau^{tr} - \lambda Db, & D_{alg} &= D - Db\,(Da)^T/(a\cdot Db)\\
//! \text{edge}&: & \lambda &= (A^TDB)^{-1}F, &
//!   \tau &= p + r\,\bigl(g\cdot C^{-1}(\tau^{tr}-p)\bigr)/(g\cdot C^{-1}r), &
//!   D_{alg} &= r\,g^T/(g\cdot C^{-1}r)\\
//! \text{vertex}&: & && \tau &= p, & D_{alg} &= 0
//! \end{aligned}
//! ```
//!
//! with p a point of the edge, `` $`r = a_1\times a_2`$ `` its direction and
//! `` $`g = b_1\times b_2`$ ``. Each is the target of one region of trial states, bounded by
//! planes; the signs of a few linear forms, here called gates, tell which region holds a state.
//!
//! States come with their principal values in descending order and leave so.

use crate::principal::{Principal, apply, cross, dot, largest};
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

/// A linear form of the trial stress \[stress\] that is not negative where its region lies.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Gate {
    normal: Principal,
    offset: f64,
}

impl Gate {
    /// The weighted sum of the excesses of some planes.
    fn weighing(terms: &[(Plane, f64)]) -> Self {
        let mut gate = Self {
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

    #[inline]
    fn value(&self, trial: &Principal) -> f64 {
        dot(&self.normal, trial) - self.offset
    }
}

/// A face: its plane, and `` $`Db`$ `` and `` $`a\cdot Db`$ ``.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Face {
    plane: Plane,
    softening: Principal,
    hardness: f64,
}

/// An edge: its planes, the multipliers by their excesses, and the line it lies on.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Edge {
    planes: [Plane; 2],
    /// `` $`(A^TDB)^{-1}`$ ``.
    multipliers: [[f64; 2]; 2],
    point: Principal,
    direction: Principal,
    /// `` $`C^{-1}g / (g\cdot C^{-1}r)`$ ``: its product with the way from `point` to the trial
    /// stress is the coordinate along the edge.
    coordinate: Principal,
}

impl Edge {
    /// The point of the edge that the trial stress returns to.
    #[inline]
    fn project(&self, trial: &Principal) -> Principal {
        let way = std::array::from_fn(|a| trial[a] - self.point[a]);
        let along = dot(&self.coordinate, &way);
        std::array::from_fn(|a| self.point[a] + along * self.direction[a])
    }
}

/// What a region is returned to.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Target {
    Face(Face),
    Edge(Edge),
    /// The point and its elastic strain.
    Vertex(Principal, Principal),
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

    /// The returned stress.
    #[inline]
    fn project(&self, trial: &Principal) -> Principal {
        match &self.target {
            Target::Face(Face {
                plane,
                softening,
                hardness,
            }) => {
                let mut tau = *trial;
                // The second pass removes the round-off of a first one from far outside.
                for _ in 0..2 {
                    let delta_lambda = plane.excess(&tau) / hardness;
                    for a in 0..3 {
                        tau[a] -= delta_lambda * softening[a];
                    }
                }
                tau
            }
            Target::Edge(edge) => edge.project(trial),
            Target::Vertex(point, _) => *point,
        }
    }

    /// The plastic strain increment, from the multipliers where there are such.
    #[inline]
    fn flow(&self, strain: &Principal, trial: &Principal) -> Principal {
        match &self.target {
            Target::Face(Face {
                plane, hardness, ..
            }) => {
                let delta_lambda = plane.excess(trial) / hardness;
                plane.flow.map(|component| delta_lambda * component)
            }
            Target::Edge(Edge {
                planes: [p, q],
                multipliers,
                ..
            }) => {
                let excess = [p.excess(trial), q.excess(trial)];
                let [first, second] =
                    multipliers.map(|row| row[0] * excess[0] + row[1] * excess[1]);
                std::array::from_fn(|a| first * p.flow[a] + second * q.flow[a])
            }
            Target::Vertex(_, elastic) => std::array::from_fn(|a| strain[a] - elastic[a]),
        }
    }
}

/// A stress returned to the surface.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Returned<'a> {
    pub(crate) tau: Principal,
    pub(crate) delta_eps_p: Principal,
    pub(crate) tangent: &'a [[f64; 3]; 3],
    pub(crate) regime: Regime,
}

/// A convex surface of planes with its faces, edges and vertices.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct PlanarSurface {
    elasticity: Elasticity,
    planes: Vec<Plane>,
    /// The greatest strength of a plane.
    strength: f64,
    regions: Vec<Region>,
}

impl PlanarSurface {
    /// A surface that has planes but no regions yet. List regions from the common to the rare;
    /// the last one must be admissible whatever the trial state.
    pub(crate) fn new(elasticity: Elasticity, planes: Vec<Plane>) -> Self {
        let strength = planes
            .iter()
            .fold(0.0, |most: f64, plane| most.max(plane.strength));
        Self {
            elasticity,
            planes,
            strength,
            regions: Vec::new(),
        }
    }

    /// Adds the face of plane `p`.
    pub(crate) fn face(mut self, regime: Regime, p: usize) -> Self {
        let plane = self.planes[p];
        let mut tangent = self.elasticity.tangent();
        let softening = apply(&tangent, &plane.flow);
        let stiffening = apply(&tangent, &plane.normal);
        let hardness = dot(&plane.normal, &softening);
        for a in 0..3 {
            for b in 0..3 {
                tangent[a][b] -= softening[a] * stiffening[b] / hardness;
            }
        }
        let target = Target::Face(Face {
            plane,
            softening,
            hardness,
        });
        let gates = vec![Gate::weighing(&[(plane, 1.0)])];
        self.regions.push(Region {
            regime,
            target,
            gates,
            tangent,
        });
        self
    }

    /// Adds the edge of two planes; its gates are the multipliers, scaled to a stress.
    pub(crate) fn edge(mut self, regime: Regime, planes: [usize; 2]) -> Self {
        let edge = self.line(planes);
        let gates = (0..2)
            .map(|k| {
                let [first, second] =
                    edge.multipliers[k].map(|entry| entry * self.hardness(&edge.planes[k]));
                Gate::weighing(&[(edge.planes[0], first), (edge.planes[1], second)])
            })
            .collect();
        // C⁻¹g scaled, and C of it: the row by which strain moves the stress along the edge.
        let row = self.elasticity.stress(&edge.coordinate);
        let tangent = edge
            .direction
            .map(|component| row.map(|entry| component * entry));
        self.regions.push(Region {
            regime,
            target: Target::Edge(edge),
            gates,
            tangent,
        });
        self
    }

    /// Adds the vertex at `point`. Every edge that ends there is given by its two planes and the
    /// plane that ends it: the vertex owns the trial states whose return to each of these edges
    /// would overshoot.
    pub(crate) fn vertex(
        mut self,
        regime: Regime,
        point: Principal,
        edges: &[([usize; 2], usize)],
    ) -> Self {
        let gates = edges
            .iter()
            .map(|&(planes, end)| {
                let (edge, end) = (self.line(planes), self.planes[end]);
                let pace = dot(&end.normal, &edge.direction);
                let normal = edge.coordinate.map(|component| pace * component);
                let offset = dot(&normal, &edge.point) - end.excess(&edge.point);
                Gate { normal, offset }
            })
            .collect();
        let target = Target::Vertex(point, self.elasticity.strain(&point));
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

    /// Returns an inadmissible trial state, strain and its elastic stress, to the surface.
    pub(crate) fn project(&self, strain: &Principal, trial: &Principal) -> Returned<'_> {
        let (region, tau) = self.region_of(trial);
        Returned {
            tau,
            delta_eps_p: region.flow(strain, trial),
            tangent: &region.tangent,
            regime: region.regime,
        }
    }

    /// The region that holds the trial stress, and the stress returned.
    fn region_of(&self, trial: &Principal) -> (&Region, Principal) {
        let mut best: Option<(f64, &Region, Principal)> = None;
        for region in &self.regions {
            let depth = region.depth(trial);
            // Round-off may put a state on the common wall of two regions outside both: then the
            // nearer one takes it.
            if best.is_some_and(|(deepest, ..)| depth <= deepest) {
                continue;
            }
            let tau = region.project(trial);
            if self.admits(&tau) {
                if depth >= 0.0 {
                    return (region, tau);
                }
                best = Some((depth, region, tau));
            }
        }
        let last = &self.regions[self.regions.len() - 1];
        best.map_or_else(
            || (last, last.project(trial)),
            |(_, region, tau)| (region, tau),
        )
    }

    /// Whether a returned stress is on the admissible side of all planes and still in order. Both
    /// are asked: with friction close to 90° the planes hardly notice a wrong order.
    #[inline]
    fn admits(&self, tau: &Principal) -> bool {
        let disorder = (tau[1] - tau[0]).max(tau[2] - tau[1]);
        self.yield_function(tau).max(disorder) <= ROUND_OFF * self.stress_scale(tau)
    }

    /// The elastic stiffness against flow on one plane, `` $`a\cdot Db`$ ``.
    fn hardness(&self, plane: &Plane) -> f64 {
        dot(&plane.normal, &self.elasticity.stress(&plane.flow))
    }

    /// The line that two planes share.
    fn line(&self, planes: [usize; 2]) -> Edge {
        let planes = planes.map(|position| self.planes[position]);
        let normals = planes.map(|plane| plane.normal);
        let multipliers = inverse(
            normals,
            planes.map(|plane| self.elasticity.stress(&plane.flow)),
        );
        // The point of the line that is nearest to zero stress.
        let weights = inverse(normals, normals)
            .map(|row| row[0] * planes[0].strength + row[1] * planes[1].strength);
        let point =
            std::array::from_fn(|a| weights[0] * normals[0][a] + weights[1] * normals[1][a]);
        let direction = cross(&normals[0], &normals[1]);
        let compliant = self
            .elasticity
            .strain(&cross(&planes[0].flow, &planes[1].flow));
        let scale = dot(&compliant, &direction);
        let coordinate = compliant.map(|component| component / scale);
        Edge {
            planes,
            multipliers,
            point,
            direction,
            coordinate,
        }
    }
}

/// The inverse of the 2×2 matrix of the products of `rows` and `columns`.
fn inverse(rows: [Principal; 2], columns: [Principal; 2]) -> [[f64; 2]; 2] {
    let m = rows.map(|row| columns.map(|column| dot(&row, &column)));
    let determinant = m[0][0] * m[1][1] - m[0][1] * m[1][0];
    [[m[1][1], -m[0][1]], [-m[1][0], m[0][0]]]
        .map(|row: [f64; 2]| row.map(|entry| entry / determinant))
}

#[cfg(test)]
impl PlanarSurface {
    /// The regimes of all regions that hold the trial stress and return it admissibly.
    pub(crate) fn claims(&self, trial: &Principal) -> Vec<Regime> {
        let holds =
            |region: &&Region| region.depth(trial) >= 0.0 && self.admits(&region.project(trial));
        self.regions
            .iter()
            .filter(holds)
            .map(|region| region.regime)
            .collect()
    }
}
