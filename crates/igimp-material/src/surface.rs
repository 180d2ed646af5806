//! A convex yield surface made of planes, and the choice of the part that a trial state returns to.
//!
//! States come with their principal values in descending order and leave so: only the faces,
//! edges and vertices around that sector of principal space are listed.

use std::borrow::Borrow;

use crate::koiter::{Plane, Region};
use crate::spectral::principal::{Principal, largest};
use crate::{Elasticity, Regime};

/// Share of the stress scale by which a returned stress may exceed a plane: round-off, and less
/// than the share that counts as on the surface before a return.
const ROUND_OFF: f64 = 1e-13;

/// A part of a surface, by its planes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Part {
    Face(Regime, usize),
    Edge(Regime, [usize; 2]),
    /// A point, with the two planes of every edge that ends there and the plane that ends it.
    Vertex(Regime, Principal, &'static [([usize; 2], usize)]),
}

impl Part {
    /// The part with the data of a return to it.
    fn region(self, elasticity: &Elasticity, planes: &[Plane]) -> Region {
        let pair = |of: [usize; 2]| of.map(|plane| planes[plane]);
        match self {
            Self::Face(regime, plane) => Region::face(elasticity, regime, planes[plane]),
            Self::Edge(regime, of) => Region::edge(elasticity, regime, pair(of)),
            Self::Vertex(regime, point, edges) => {
                let edges = edges.iter().map(|&(of, end)| (pair(of), planes[end]));
                Region::vertex(elasticity, regime, point, edges)
            }
        }
    }
}

/// Planes, and the parts that they have, from the common to the rare; the last part must be admissible whatever the
/// trial state.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Outline<'a> {
    pub(crate) planes: &'a [Plane],
    pub(crate) parts: &'a [Part],
}

/// A surface with the data of returns to its parts: for many of them.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct PlanarSurface {
    planes: Vec<Plane>,
    regions: Vec<Region>,
}

/// A stress returned to a surface.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Returned {
    pub(crate) tau: Principal,
    pub(crate) delta_eps_p: Principal,
    pub(crate) tangent: [[f64; 3]; 3],
    pub(crate) regime: Regime,
}

impl PlanarSurface {
    pub(crate) fn new(elasticity: &Elasticity, outline: Outline<'_>) -> Self {
        let parts = outline.parts.iter();
        Self {
            planes: outline.planes.to_vec(),
            regions: parts
                .map(|part| part.region(elasticity, outline.planes))
                .collect(),
        }
    }

    /// The largest excess over any plane \[stress\]: the yield function.
    #[inline]
    pub(crate) fn yield_function(&self, tau: &Principal) -> f64 {
        excess(&self.planes, tau)
    }

    /// The scale of round-off in [`Self::yield_function`] \[stress\].
    #[inline]
    pub(crate) fn stress_scale(&self, tau: &Principal) -> f64 {
        scale(&self.planes, tau)
    }

    /// Returns an inadmissible trial state, strain and its elastic stress, to the surface.
    pub(crate) fn project(&self, strain: &Principal, trial: &Principal) -> Returned {
        returned(&self.planes, self.regions.iter(), strain, trial)
    }
}

impl Outline<'_> {
    /// Returns an inadmissible trial state, strain and its elastic stress, to the surface: once, with no more of it than
    /// that takes.
    pub(crate) fn project(
        &self,
        elasticity: &Elasticity,
        strain: &Principal,
        trial: &Principal,
    ) -> Returned {
        let regions = self
            .parts
            .iter()
            .map(|part| part.region(elasticity, self.planes));
        returned(self.planes, regions, strain, trial)
    }
}

/// The largest excess over any plane \[stress\].
#[inline]
pub(crate) fn excess(planes: &[Plane], tau: &Principal) -> f64 {
    planes
        .iter()
        .fold(f64::NEG_INFINITY, |most, plane| most.max(plane.excess(tau)))
}

/// The scale of round-off in the excess \[stress\]: the strength of the
/// first plane plus twice the largest stress, as no plane weighs its stresses by more than two
/// in all. The strength of another plane plays no part: close to that plane it is no more than
/// twice the largest stress, and far from it, however strong, it must not blunt the others.
#[inline]
pub(crate) fn scale(planes: &[Plane], tau: &Principal) -> f64 {
    planes[0].strength + 2.0 * largest(tau)
}

/// Returns an inadmissible trial state to the first region that holds it.
fn returned<R: Borrow<Region>>(
    planes: &[Plane],
    regions: impl Iterator<Item = R>,
    strain: &Principal,
    trial: &Principal,
) -> Returned {
    let (region, tau) = region_of(planes, regions, trial);
    let region = region.borrow();
    Returned {
        tau,
        delta_eps_p: region.flow(strain, trial),
        tangent: region.tangent,
        regime: region.regime,
    }
}

/// The region that holds the trial stress, and the stress returned.
///
/// # Panics
/// If there is no region.
fn region_of<R: Borrow<Region>>(
    planes: &[Plane],
    regions: impl Iterator<Item = R>,
    trial: &Principal,
) -> (R, Principal) {
    let mut best: Option<(f64, R, Principal)> = None;
    let mut last = None;
    for candidate in regions {
        let region = candidate.borrow();
        let depth = region.depth(trial);
        let tau = region.project(trial);
        // Round-off may put a state on the common wall of two regions outside both: then the
        // nearer one takes it.
        let is_nearer = best.as_ref().is_none_or(|(deepest, ..)| depth > *deepest);
        if is_nearer && admits(planes, &tau) {
            if depth >= 0.0 {
                return (candidate, tau);
            }
            best = Some((depth, candidate, tau));
        } else {
            last = Some((candidate, tau));
        }
    }
    best.map(|(_, region, tau)| (region, tau))
        .or(last)
        .expect("a surface has parts")
}

/// Whether a returned stress is on the admissible side of all planes and still in order. Both
/// are asked: with friction close to 90° the planes hardly notice a wrong order.
#[inline]
fn admits(planes: &[Plane], tau: &Principal) -> bool {
    let disorder = (tau[1] - tau[0]).max(tau[2] - tau[1]);
    excess(planes, tau).max(disorder) <= ROUND_OFF * scale(planes, tau)
}

#[cfg(test)]
impl PlanarSurface {
    /// The regimes of all regions that hold the trial stress and return it admissibly.
    pub(crate) fn claims(&self, trial: &Principal) -> Vec<Regime> {
        let holds = |region: &&Region| {
            region.depth(trial) >= 0.0 && admits(&self.planes, &region.project(trial))
        };
        self.regions
            .iter()
            .filter(holds)
            .map(|region| region.regime)
            .collect()
    }
}
