//! A convex yield surface made of planes, and the choice of the part that a trial state returns to.
//!
//! States come with their principal values in descending order and leave so: only the faces,
//! edges and vertices around that sector of principal space are listed.

use crate::koiter::{Plane, Region};
use crate::spectral::principal::{Principal, largest};
use crate::{Elasticity, Regime};

/// Share of the stress scale by which a returned stress may exceed a plane: round-off, and less
/// than what counts as on the surface before a return.
const ROUND_OFF: f64 = 1e-13;

/// Planes with their faces, edges and vertices.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct PlanarSurface {
    elasticity: Elasticity,
    planes: Vec<Plane>,
    /// The strength of the first plane.
    strength: f64,
    regions: Vec<Region>,
}

/// A stress returned to the surface.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Returned<'a> {
    pub(crate) tau: Principal,
    pub(crate) delta_eps_p: Principal,
    pub(crate) tangent: &'a [[f64; 3]; 3],
    pub(crate) regime: Regime,
}

impl PlanarSurface {
    /// A surface that has planes but no regions yet. List planes and regions from the common to the
    /// rare; the last region must be admissible whatever the trial state.
    pub(crate) fn new(elasticity: Elasticity, planes: Vec<Plane>) -> Self {
        Self {
            elasticity,
            strength: planes[0].strength,
            planes,
            regions: Vec::new(),
        }
    }

    /// Adds the face of a plane.
    pub(crate) fn face(mut self, regime: Regime, plane: usize) -> Self {
        self.regions
            .push(Region::face(&self.elasticity, regime, self.planes[plane]));
        self
    }

    /// Adds the edge of two planes.
    pub(crate) fn edge(mut self, regime: Regime, planes: [usize; 2]) -> Self {
        let planes = planes.map(|plane| self.planes[plane]);
        self.regions
            .push(Region::edge(&self.elasticity, regime, planes));
        self
    }

    /// Adds the vertex at `point`, with the two planes of every edge that ends there and the
    /// plane that ends it.
    pub(crate) fn vertex(
        mut self,
        regime: Regime,
        point: Principal,
        edges: &[([usize; 2], usize)],
    ) -> Self {
        let plane = |position: usize| self.planes[position];
        let edges = edges
            .iter()
            .map(|&(planes, end)| (planes.map(plane), plane(end)));
        let region = Region::vertex(&self.elasticity, regime, point, edges);
        self.regions.push(region);
        self
    }

    /// The largest excess over any plane \[stress\]: the yield function.
    #[inline]
    pub(crate) fn yield_function(&self, tau: &Principal) -> f64 {
        self.planes
            .iter()
            .fold(f64::NEG_INFINITY, |most, plane| most.max(plane.excess(tau)))
    }

    /// The scale of round-off in [`Self::yield_function`] \[stress\]: the strength of the
    /// first plane plus twice the largest stress, as no plane weighs its stresses by more than two
    /// in all. The strength of another plane plays no part: close to that plane it is no more than
    /// twice the largest stress, and far from it, however strong, it must not blunt the others.
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
