//! Water in the ground: conditions that stages move between, and the drainage of materials.

pub(crate) mod seepage;

use std::sync::Arc;

use igimp_assembly::PoreStiffness;
use igimp_geometry::region::Region;
use igimp_geometry::solid::Terrain;

use super::{Case, Raster, StageKind, in_space};
use seepage::SeepageCase;

impl<const D: usize> Case<D> {
    /// By body: whether it is there at the end of a stage, by index.
    pub fn bodies_after(&self, stage: usize) -> Vec<bool> {
        let stage = &self.stages[stage];
        let mut there = match stage.start_from {
            Some(from) => self.bodies_after(from),
            None => self.bodies.iter().map(|body| body.from_start).collect(),
        };
        if let StageKind::Construction(plan) = &stage.kind {
            for &body in &plan.place {
                there[body] = true;
            }
            for &body in &plan.remove {
                there[body] = false;
            }
        }
        there
    }

    /// By body: whether it is there, at the start and at the end of every stage.
    pub fn bodies_by_stage(&self) -> Vec<Vec<bool>> {
        let start = self.bodies.iter().map(|body| body.from_start).collect();
        let later = (0..self.stages.len()).map(|stage| self.bodies_after(stage));
        std::iter::once(start).chain(later).collect()
    }

    /// The material that a body consists of at the end of a stage, by index; `None`: before the first one. A body that was taken
    /// away keeps it for the time that it comes back.
    pub fn material_after(&self, stage: Option<usize>, body: usize) -> usize {
        let mut at = stage;
        while let Some(stage) = at {
            let stage = &self.stages[stage];
            if let StageKind::Construction(plan) = &stage.kind
                && let Some((_, material)) = plan.materials.iter().find(|(other, _)| *other == body)
            {
                return *material;
            }
            at = stage.start_from;
        }
        self.bodies[body].material
    }

    /// The condition of the water at the end of a stage, by index; none without water.
    pub fn water_after(&self, stage: usize) -> Option<usize> {
        let stage = &self.stages[stage];
        let before = match stage.start_from {
            Some(from) => self.water_after(from),
            None => (!self.water.is_empty()).then_some(0),
        };
        match &stage.kind {
            StageKind::Construction(plan) => plan.water.or(before),
            _ => before,
        }
    }

    /// Whether there is water in pores, given or held by undrained soil: only then do total and effective stress differ.
    pub fn has_pore_water(&self) -> bool {
        let holds = |drainage: Drainage| matches!(drainage, Drainage::Undrained { .. });
        !self.water.is_empty() || self.materials.iter().any(|soil| holds(soil.drainage))
    }
}

/// A condition of the water, under a name that stages call it by.
#[derive(Clone, Debug, PartialEq)]
pub struct WaterCondition {
    /// Name.
    pub name: String,
    /// Pressure in the pores of all bodies that say nothing else; above the ground that of free water on it.
    pub source: PoreSource,
    /// Bodies, by index, with a pressure of their own.
    pub bodies: Vec<(usize, PoreSource)>,
    /// Whether soil carries the pressure that it was seeded with along, rather than find that of the place where it is.
    pub carried: bool,
}

/// Where pore pressure comes from; u ≥ 0, compression positive.
#[derive(Clone, Debug, PartialEq)]
pub enum PoreSource {
    /// No pressure.
    Dry,
    /// A water table: its points from left to right \[m\], linear between them and level beyond; one point is a level.
    /// Pressure is the unit weight of water times the vertical depth below it. Soil is saturated beneath.
    Table(Vec<[f64; 2]>),
    /// A water table in space, by a surface; beyond its extent as at the nearest place of the box around it. As with
    /// [`PoreSource::Table`] pressure goes by the vertical depth below it.
    Surface(Arc<Terrain>),
    /// The water table of ground in space that was drained.
    Drained(Drained),
    /// Pressures by points in the plane \[Pa\], as a seepage analysis gives them; negative values count as zero. On the ground it is that
    /// of the free water there.
    Points(Raster),
    /// Seepage that is computed, steady or at a moment.
    Seepage(Arc<SeepageCase>),
    /// r_u: the pressure as a share of the weight of the ground above, as the bodies present from the start are
    /// drawn \[-\].
    Ratio(f64),
}

impl PoreSource {
    /// Elevation of the water table at a place \[m\]; none of a condition that is not a table.
    pub fn table<const D: usize>(&self, place: &[f64; D]) -> Option<f64> {
        match self {
            Self::Table(points) => Some(table_level(points, place[0])),
            Self::Surface(terrain) => {
                let [x, y, _] = in_space(place);
                let nearest = || {
                    let (lower, upper) = terrain.bounds();
                    [x.clamp(lower[0], upper[0]), y.clamp(lower[1], upper[1])]
                };
                let level = terrain.height_at([x, y]);
                let level = level.or_else(|| terrain.height_at(nearest()));
                Some(level.unwrap_or(f64::NEG_INFINITY))
            }
            Self::Drained(drained) => Some(drained.level(&in_space(place))),
            Self::Dry | Self::Points(_) | Self::Ratio(_) | Self::Seepage(_) => None,
        }
    }
}

/// A water table that is `inside` within higher ground, the surface of the ground where that lies between the two levels,
/// and `outside` above lower ground.
#[derive(Clone, Debug)]
pub struct Drained {
    inside: f64,
    outside: f64,
    ground: Vec<Arc<dyn Region<3>>>,
    /// Lower and upper corner of the box around the ground, hardly within it \[m\].
    within: [[f64; 3]; 2],
}

/// Places beyond the ground are seen this much within the box around it, as a share of its size \[-\]: domains of particles
/// reach beyond by round-off.
const WITHIN: f64 = 1e-9;

impl Drained {
    /// A table at `inside` within the ground that is made of regions, and at `outside`, not above it, over lower ground \[m\].
    pub fn new(inside: f64, outside: f64, ground: Vec<Arc<dyn Region<3>>>) -> Self {
        let mut within = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
        for (lower, upper) in ground.iter().map(|region| region.bounds()) {
            for axis in 0..3 {
                within[0][axis] = within[0][axis].min(lower[axis]);
                within[1][axis] = within[1][axis].max(upper[axis]);
            }
        }
        for axis in 0..3 {
            let by = WITHIN * (within[1][axis] - within[0][axis]);
            within[0][axis] += by;
            within[1][axis] -= by;
        }
        Self {
            inside,
            outside,
            ground,
            within,
        }
    }

    /// Level within the ground \[m\].
    pub fn inside(&self) -> f64 {
        self.inside
    }

    /// Level of the free water outside \[m\].
    pub fn outside(&self) -> f64 {
        self.outside
    }

    fn level(&self, place: &[f64; 3]) -> f64 {
        let [lower, upper] = &self.within;
        let place = std::array::from_fn(|axis| place[axis].max(lower[axis]).min(upper[axis]));
        let tops = self.ground.iter().filter_map(|region| region.top(&place));
        tops.fold(self.outside, f64::max).min(self.inside)
    }
}

impl PartialEq for Drained {
    fn eq(&self, other: &Self) -> bool {
        let levels = [[self.inside, other.inside], [self.outside, other.outside]];
        let mut grounds = std::iter::zip(&self.ground, &other.ground);
        levels.iter().all(|[a, b]| a.total_cmp(b).is_eq())
            && self.ground.len() == other.ground.len()
            && grounds.all(|(a, b)| Arc::ptr_eq(a, b))
    }
}

/// The level of a line at a place, level beyond its ends \[m\].
pub fn table_level(points: &[[f64; 2]], x: f64) -> f64 {
    let after = points.partition_point(|point| point[0] <= x);
    match (after.checked_sub(1).map(|k| points[k]), points.get(after)) {
        (Some(from), Some(to)) => from[1] + (to[1] - from[1]) * (x - from[0]) / (to[0] - from[0]),
        (Some(only), None) | (None, Some(&only)) => only[1],
        (None, None) => f64::NEG_INFINITY,
    }
}

/// Drainage of a material.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Drainage {
    /// Water comes and goes as it likes: pressure is given, and the law speaks of effective stress.
    #[default]
    Drained,
    /// No water leaves: pressure that changes of volume make comes on top of that given, and the law speaks of effective
    /// stress.
    Undrained {
        /// Bulk modulus of the water over the porosity, K_w/n \[Pa\].
        stiffness: PoreStiffness,
        /// Whether water leaves in stages with consolidation.
        flows: bool,
    },
    /// The law speaks of total stress: there is no pore pressure to speak of, and free water presses on the surface alone.
    Total,
}

/// The changes of a construction stage. Unbalanced forces that they leave are released over its steps.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Construction {
    /// Bodies that are placed, by index, undeformed and free of stress where the case draws them.
    pub place: Vec<usize>,
    /// Bodies that are taken away, by index.
    pub remove: Vec<usize>,
    /// Bodies and the materials that they consist of from now on, both by index.
    pub materials: Vec<(usize, usize)>,
    /// The condition of the water from now on, by index; none: as before.
    pub water: Option<usize>,
    /// Whether excess pore pressure goes: all soil drains in this stage, and none is left at its end.
    pub dissipate: bool,
}
