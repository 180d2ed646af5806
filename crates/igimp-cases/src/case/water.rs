//! Water in the ground: conditions that stages move between, and what materials do with it.

use super::Raster;

use super::{Case, StageKind};

impl<const D: usize> Case<D> {
    /// By body: whether it is there at the end of a stage, by index.
    pub fn bodies_after(&self, stage: usize) -> Vec<bool> {
        let stage = &self.stages[stage];
        let mut there = match stage.start_from {
            Some(from) => self.bodies_after(from),
            None => self.bodies.iter().map(|body| body.from_start).collect(),
        };
        if let StageKind::Construction(own) = &stage.kind {
            for &body in &own.place {
                there[body] = true;
            }
            for &body in &own.remove {
                there[body] = false;
            }
        }
        there
    }

    /// Whether there is water in pores, given or held by undrained soil: only then do total and effective stress differ.
    pub fn has_pore_water(&self) -> bool {
        let holds = |drainage: Drainage| matches!(drainage, Drainage::Undrained { .. });
        !self.water.is_empty() || self.materials.iter().any(|own| holds(own.drainage))
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
    /// Pressures by points in the plane \[Pa\], as a seepage analysis gives them; less than none is none. On the ground it is that
    /// of the free water there.
    Points(Raster),
    /// r_u: the pressure as a share of the weight of the ground above, as the bodies present from the start are
    /// drawn \[-\].
    Ratio(f64),
}

/// The level of a line at a place, level beyond its ends \[m\].
pub(crate) fn table_level(points: &[[f64; 2]], x: f64) -> f64 {
    let after = points.partition_point(|point| point[0] <= x);
    match (after.checked_sub(1).map(|k| points[k]), points.get(after)) {
        (Some(from), Some(to)) => from[1] + (to[1] - from[1]) * (x - from[0]) / (to[0] - from[0]),
        (Some(only), None) | (None, Some(&only)) => only[1],
        (None, None) => f64::NEG_INFINITY,
    }
}

/// What a material does with the water in its pores.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Drainage {
    /// Water comes and goes as it likes: pressure is given, and the law speaks of effective stress.
    #[default]
    Drained,
    /// No water leaves: pressure that changes of volume make comes on top of that given, and the law speaks of effective
    /// stress.
    Undrained {
        /// Bulk modulus of the water over the porosity, K_w/n \[Pa\].
        stiffness: f64,
    },
    /// The law speaks of total stress: there is no pore pressure to speak of, and free water presses on the surface alone.
    Total,
}

/// What a construction stage changes. Where it leaves the ground out of balance, that is let go over its steps.
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
