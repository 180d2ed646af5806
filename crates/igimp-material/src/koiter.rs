//! Return to a convex surface made of planes, exactly and without iteration (theory, eq. 22).
//!
//! A plane is $`a\cdot\tau \le k`$ with the flow direction b. Where planes yield together
//! (Koiter 1953), plastic strain is $`\Delta\varepsilon_p = \sum\lambda_k b_k`$ with
//! multipliers that are not negative, and everything is linear in principal space. With the
//! excess $`F_k = a_k\cdot\tau^{tr} - k_k`$ (Clausen, Damkilde & Andersen 2006):
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
//! with p a point of the edge, $`r = a_1\times a_2`$ its direction and
//! $`g = b_1\times b_2`$. Each is the target of one region of trial states, bounded by
//! planes; the signs of a few linear forms, here called gates, tell which region holds a state.

use crate::spectral::principal::{Principal, apply, cross, dot};
use crate::{Elasticity, Regime};

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
    pub(crate) fn excess(&self, tau: &Principal) -> f64 {
        dot(&self.normal, tau) - self.strength
    }
}

/// Most gates of a region: the edges that end at a vertex.
const MOST_GATES: usize = 3;

/// A linear form of the trial stress \[stress\] that is not negative where its region lies.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Gate {
    normal: Principal,
    offset: f64,
}

impl Gate {
    /// Never in the way.
    const OPEN: Self = Self {
        normal: [0.0; 3],
        offset: f64::NEG_INFINITY,
    };

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

/// A face: its plane, and $`Db`$ and $`a\cdot Db`$.
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
    /// $`(A^TDB)^{-1}`$.
    multipliers: [[f64; 2]; 2],
    point: Principal,
    direction: Principal,
    /// $`C^{-1}g / (g\cdot C^{-1}r)`$: its product with the way from `point` to the trial
    /// stress is the coordinate along the edge.
    coordinate: Principal,
}

impl Edge {
    /// The line that two planes share.
    fn new(elasticity: &Elasticity, planes: [Plane; 2]) -> Self {
        let [a, b] = planes.map(|plane| plane.normal);
        let flows = planes.map(|plane| plane.flow);
        let direction = cross(&a, &b);
        // The point of the line that is nearest to zero stress. Steep planes are nearly parallel:
        // products of their normals would lose the digits that tell them apart.
        let (along_a, along_b) = (cross(&b, &direction), cross(&direction, &a));
        let square = dot(&direction, &direction);
        let point = std::array::from_fn(|i| {
            (planes[0].strength * along_a[i] + planes[1].strength * along_b[i]) / square
        });
        let compliant = elasticity.strain(&cross(&flows[0], &flows[1]));
        let scale = dot(&compliant, &direction);
        Self {
            planes,
            multipliers: inverse([a, b], flows.map(|flow| elasticity.stress(&flow))),
            point,
            direction,
            coordinate: compliant.map(|component| component / scale),
        }
    }

    /// The point of the edge that the trial stress returns to.
    #[inline]
    fn project(&self, trial: &Principal) -> Principal {
        let way = std::array::from_fn(|a| trial[a] - self.point[a]);
        let along = dot(&self.coordinate, &way);
        std::array::from_fn(|a| self.point[a] + along * self.direction[a])
    }
}

/// The target of a return from a region.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Target {
    Face(Face),
    Edge(Edge),
    /// The point and its elastic strain.
    Vertex(Principal, Principal),
}

/// A part of the surface and the trial states that return to it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Region {
    pub(crate) regime: Regime,
    pub(crate) tangent: [[f64; 3]; 3],
    target: Target,
    gates: [Gate; MOST_GATES],
}

impl Region {
    /// The face of a plane.
    pub(crate) fn face(elasticity: &Elasticity, regime: Regime, plane: Plane) -> Self {
        let mut tangent = elasticity.tangent();
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
        let mut gates = [Gate::OPEN; MOST_GATES];
        gates[0] = Gate::weighing(&[(plane, 1.0)]);
        Self {
            regime,
            tangent,
            target,
            gates,
        }
    }

    /// The edge of two planes; its gates are the multipliers, scaled to a stress.
    pub(crate) fn edge(elasticity: &Elasticity, regime: Regime, planes: [Plane; 2]) -> Self {
        let edge = Edge::new(elasticity, planes);
        let mut gates = [Gate::OPEN; MOST_GATES];
        for (k, gate) in gates.iter_mut().enumerate().take(2) {
            let hardness = dot(&planes[k].normal, &elasticity.stress(&planes[k].flow));
            let [first, second] = edge.multipliers[k].map(|entry| entry * hardness);
            *gate = Gate::weighing(&[(planes[0], first), (planes[1], second)]);
        }
        let row = elasticity.stress(&edge.coordinate);
        let tangent = edge
            .direction
            .map(|component| row.map(|entry| component * entry));
        Self {
            regime,
            tangent,
            target: Target::Edge(edge),
            gates,
        }
    }

    /// The vertex at `point`. Every edge that ends there is given by its two planes and the plane
    /// that ends it: the vertex owns the trial states whose return to each of these edges would
    /// overshoot.
    pub(crate) fn vertex(
        elasticity: &Elasticity,
        regime: Regime,
        point: Principal,
        edges: impl Iterator<Item = ([Plane; 2], Plane)>,
    ) -> Self {
        let mut gates = [Gate::OPEN; MOST_GATES];
        for (gate, (planes, end)) in gates.iter_mut().zip(edges) {
            let edge = Edge::new(elasticity, planes);
            let pace = dot(&end.normal, &edge.direction);
            let normal = edge.coordinate.map(|component| pace * component);
            let offset = dot(&normal, &edge.point) - end.excess(&edge.point);
            *gate = Gate { normal, offset };
        }
        let target = Target::Vertex(point, elasticity.strain(&point));
        Self {
            regime,
            tangent: [[0.0; 3]; 3],
            target,
            gates,
        }
    }

    /// How far inside the region the trial stress is; negative outside.
    #[inline]
    pub(crate) fn depth(&self, trial: &Principal) -> f64 {
        self.gates
            .iter()
            .fold(f64::INFINITY, |least, gate| least.min(gate.value(trial)))
    }

    /// The returned stress.
    #[inline]
    pub(crate) fn project(&self, trial: &Principal) -> Principal {
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

    /// The plastic strain increment of the trial state, strain and its elastic stress.
    #[inline]
    pub(crate) fn flow(&self, strain: &Principal, trial: &Principal) -> Principal {
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

/// The inverse of the 2×2 matrix of the products of `rows` and `columns`.
fn inverse(rows: [Principal; 2], columns: [Principal; 2]) -> [[f64; 2]; 2] {
    let m = rows.map(|row| columns.map(|column| dot(&row, &column)));
    let determinant = m[0][0] * m[1][1] - m[0][1] * m[1][0];
    [[m[1][1], -m[0][1]], [-m[1][0], m[0][0]]]
        .map(|row: [f64; 2]| row.map(|entry| entry / determinant))
}
