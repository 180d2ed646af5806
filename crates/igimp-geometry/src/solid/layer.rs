//! The ground between two surfaces, within a polygon in plan.

use igimp_text::short;
use thiserror::Error;

use super::facets::{Face, Facets, over};
use super::prism::cover;
use super::standing::Standing;
use super::terrain::Height;
use crate::polygon::{Polygon, area_and_centroid, bounding_box, clip_to_box};
use crate::region::{Column, Cover, Crossing, Part, Region, is_off};

/// Surfaces that cross by less than this share of the size of the layer touch \[-\].
const TOUCH: f64 = 1e-9;
/// A share of the polygon in plan without surface above it that is round-off \[-\].
const COVERED: f64 = 1e-9;
/// The place that a surface does not cover is sought by halving the plan so many times.
const HALVES: usize = 40;

/// Why there is no ground between two surfaces.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum LayerError {
    /// The polygon has no area.
    #[error("its polygon in plan has no area")]
    NoArea,
    /// A surface does not reach everywhere.
    #[error(
        "the {which} does not cover {:.3} % of its polygon in plan, near ({}, {}) m",
        100.0 * share, at[0], at[1]
    )]
    NotCovered {
        /// `top` or `bottom`.
        which: &'static str,
        /// A place that is not covered \[length\].
        at: [f64; 2],
        /// The share of the area that is not covered \[-\].
        share: f64,
    },
    /// The bottom is above the top.
    #[error("at ({}, {}) m the bottom is {by} m above the top", at[0], at[1])]
    Crossing {
        /// The place where it is furthest above, among the corners of the surfaces \[length\].
        at: [f64; 2],
        /// By how much \[length\].
        by: f64,
    },
    /// There is nothing between the surfaces.
    #[error("there is nothing between its bottom and its top")]
    Empty,
}

/// The ground between a bottom and a top, within a polygon in plan.
///
/// Where the two meet the layer ends.
#[derive(Clone, Debug, PartialEq)]
pub struct Layer {
    plan: Polygon,
    pub(super) bottom: Height,
    pub(super) top: Height,
    lower: [f64; 3],
    upper: [f64; 3],
}

impl Layer {
    /// The ground above the bottom and below the top, within a polygon in x and y, either way round \[length\].
    ///
    /// # Errors
    /// [`LayerError`] for surfaces that do not cover the polygon, or cross, and where.
    pub fn new(plan: &[[f64; 2]], bottom: Height, top: Height) -> Result<Self, LayerError> {
        let mut plan = plan.to_vec();
        let area = area_and_centroid(&plan).0;
        if area == 0.0 || area.is_nan() {
            return Err(LayerError::NoArea);
        }
        if area < 0.0 {
            plan.reverse();
        }
        for (height, which) in [(&bottom, "bottom"), (&top, "top")] {
            if let Height::Terrain(terrain) = height {
                check_cover(&plan, &terrain.facets, which)?;
            }
        }
        let (from, to) = bounding_box(&plan);
        let below = corners_over(&plan, &bottom);
        let above = corners_over(&plan, &top);
        let extent = |points: &[[f64; 3]]| {
            let heights = points.iter().map(|point| point[2]);
            heights.fold([f64::INFINITY, f64::NEG_INFINITY], |[least, most], z| {
                [least.min(z), most.max(z)]
            })
        };
        let ([lowest, _], [_, highest]) = (extent(&below), extent(&above));
        let size = (to[0] - from[0]).max(to[1] - from[1]).max(highest - lowest);
        // How far the top is above the bottom, and where, at the corners of both.
        let under = below
            .iter()
            .filter_map(|&[x, y, z]| Some((top.at([x, y])? - z, [x, y])));
        let over = above
            .iter()
            .filter_map(|&[x, y, z]| Some((z - bottom.at([x, y])?, [x, y])));
        let gaps: Vec<(f64, [f64; 2])> = under.chain(over).collect();
        let least = gaps.iter().min_by(|a, b| a.0.total_cmp(&b.0));
        if let Some(&(gap, at)) = least.filter(|(gap, _)| *gap < -TOUCH * size) {
            return Err(LayerError::Crossing { at, by: -gap });
        }
        if gaps.iter().all(|(gap, _)| *gap <= TOUCH * size) {
            return Err(LayerError::Empty);
        }
        Ok(Self {
            plan,
            bottom,
            top,
            lower: [from[0], from[1], lowest],
            upper: [to[0], to[1], highest],
        })
    }

    /// Volume \[length³\].
    pub fn volume(&self) -> f64 {
        self.within(self.lower, self.upper).volume
    }

    /// Its part above a rectangle in plan.
    fn standing(&self, lower: [f64; 3], upper: [f64; 3]) -> Standing {
        let [from, to] = [lower, upper].map(|[x, y, _]| [x, y]);
        let plan = plan_within(&self.plan, from, to);
        let size = [to[0] - from[0], to[1] - from[1]];
        Standing::new(lower, size, |call| {
            for (height, sense) in [(&self.top, 1.0), (&self.bottom, -1.0)] {
                each_over(height, lower, size, plan.as_ref(), |face, sign| {
                    call(face, sense * sign);
                });
            }
        })
    }

    /// The polygon in plan, counter-clockwise \[length\].
    pub fn plan(&self) -> &[[f64; 2]] {
        &self.plan
    }
}

/// The part of a polygon in a rectangle, relative to its lower corner; `None` if it covers all of it.
fn plan_within(plan: &[[f64; 2]], lower: [f64; 2], upper: [f64; 2]) -> Option<Polygon> {
    let is_cut = cover(plan, lower, upper) != Cover::Whole;
    is_cut.then(|| {
        let clipped = clip_to_box(plan, lower, upper).into_iter();
        clipped.map(|[x, y]| [x - lower[0], y - lower[1]]).collect()
    })
}

/// Calls with the faces of a surface over a rectangle, over a polygon in plan if that does not cover it, as seen from a
/// corner, and with their sense.
fn each_over(
    height: &Height,
    origin: [f64; 3],
    size: [f64; 2],
    plan: Option<&Polygon>,
    mut call: impl FnMut(&Face, f64),
) {
    let mut each = |face: &Face| match plan {
        None => call(face, 1.0),
        Some(plan) => over(face, plan, &mut call),
    };
    match height {
        Height::Level(level) => {
            let z = level - origin[2];
            let corners = [
                [0.0, 0.0, z],
                [size[0], 0.0, z],
                [size[0], size[1], z],
                [0.0, size[1], z],
            ];
            each(&Face::new(&corners));
        }
        Height::Terrain(terrain) => terrain.facets.each_within(origin, size, each),
    }
}

/// The area of a polygon within a rectangle, and how much of it triangles cover.
fn covered(plan: &[[f64; 2]], facets: &Facets, lower: [f64; 2], upper: [f64; 2]) -> [f64; 2] {
    let within = clip_to_box(plan, lower, upper);
    let area = area_and_centroid(&within).0;
    let within = within
        .into_iter()
        .map(|[x, y]| [x - lower[0], y - lower[1]])
        .collect();
    let mut covered = 0.0;
    let size = [upper[0] - lower[0], upper[1] - lower[1]];
    facets.each_within([lower[0], lower[1], 0.0], size, |face| {
        over(face, &within, |face, sign| {
            covered += sign * face.area_in_plan();
        });
    });
    [area, covered]
}

fn check_cover(plan: &[[f64; 2]], facets: &Facets, which: &'static str) -> Result<(), LayerError> {
    let (mut lower, mut upper) = bounding_box(plan);
    let [area, matched] = covered(plan, facets, lower, upper);
    let share = (area - matched) / area;
    if share <= COVERED {
        return Ok(());
    }
    // Into the half that misses more.
    for _ in 0..HALVES {
        let size = [upper[0] - lower[0], upper[1] - lower[1]];
        let axis = usize::from(size[1] > size[0]);
        let middle = 0.5 * (lower[axis] + upper[axis]);
        let (mut first, mut second) = (upper, lower);
        (first[axis], second[axis]) = (middle, middle);
        let missing = |lower, upper| {
            let [area, matched] = covered(plan, facets, lower, upper);
            area - matched
        };
        if missing(lower, first) >= missing(second, upper) {
            upper = first;
        } else {
            lower = second;
        }
    }
    Err(LayerError::NotCovered {
        which,
        at: lower,
        share,
    })
}

/// The corners of a surface over a polygon in plan: points of the surface inside it, those over its corners, and where
/// its sides run over edges of the surface.
fn corners_over(plan: &[[f64; 2]], height: &Height) -> Vec<[f64; 3]> {
    let over_corners = plan
        .iter()
        .filter_map(|&at| Some([at[0], at[1], height.at(at)?]));
    let mut corners: Vec<[f64; 3]> = over_corners.collect();
    let Height::Terrain(terrain) = height else {
        return corners;
    };
    let facets = &terrain.facets;
    let inside = facets.points.iter();
    corners.extend(inside.filter(|point| plan.encloses([point[0], point[1]])));
    let next = plan.iter().cycle().skip(1);
    for (p, q) in std::iter::zip(plan, next) {
        let lower = [p[0].min(q[0]), p[1].min(q[1])];
        let upper = [p[0].max(q[0]), p[1].max(q[1])];
        let side = |x: &[f64; 3]| (q[0] - p[0]) * (x[1] - p[1]) - (q[1] - p[1]) * (x[0] - p[0]);
        facets.each(lower, upper, |triangle| {
            let ends = facets.corners_of(triangle);
            for k in 0..3 {
                let (a, b) = (ends[k], ends[(k + 1) % 3]);
                let (at_a, at_b) = (side(&a), side(&b));
                if (at_a > 0.0) != (at_b > 0.0) {
                    let t = at_a / (at_a - at_b);
                    let at: [f64; 3] =
                        std::array::from_fn(|axis| a[axis] + t * (b[axis] - a[axis]));
                    if !is_off(&[at[0], at[1]], &lower, &upper) {
                        corners.push(at);
                    }
                }
            }
        });
    }
    corners
}

impl Region<3> for Layer {
    fn bounds(&self) -> ([f64; 3], [f64; 3]) {
        (self.lower, self.upper)
    }

    fn within(&self, lower: [f64; 3], upper: [f64; 3]) -> Part<3> {
        self.standing(lower, upper).within([lower[2], upper[2]])
    }

    fn column(&self, lower: [f64; 3], upper: [f64; 3]) -> Option<Box<dyn Column<3>>> {
        Some(Box::new(self.standing(lower, upper)))
    }

    fn cover(&self, lower: [f64; 3], upper: [f64; 3]) -> Cover {
        let is_beside =
            (0..3).any(|axis| upper[axis] <= self.lower[axis] || self.upper[axis] <= lower[axis]);
        if is_beside {
            return Cover::Nothing;
        }
        let [from, to] = [lower, upper].map(|[x, y, _]| [x, y]);
        let plan = cover(&self.plan, from, to);
        let runs_into = |height: &Height| match height {
            Height::Level(level) => lower[2] < *level && *level < upper[2],
            Height::Terrain(terrain) => terrain.facets.run_into(lower, upper),
        };
        if plan == Cover::Nothing {
            return plan;
        }
        if plan == Cover::Cut || runs_into(&self.bottom) || runs_into(&self.top) {
            return Cover::Cut;
        }
        let middle = [0, 1].map(|axis| 0.5 * (from[axis] + to[axis]));
        let z = 0.5 * (lower[2] + upper[2]);
        match (self.bottom.at(middle), self.top.at(middle)) {
            (Some(bottom), Some(top)) if bottom < z && z < top => Cover::Whole,
            (Some(_), Some(_)) => Cover::Nothing,
            _ => Cover::Cut,
        }
    }

    fn encloses(&self, [x, y, z]: [f64; 3]) -> bool {
        let is_between = match (self.bottom.at([x, y]), self.top.at([x, y])) {
            (Some(bottom), Some(top)) => bottom <= z && z <= top,
            _ => false,
        };
        is_between && self.plan.encloses([x, y])
    }

    fn crossings(&self, place: &[f64; 3]) -> Vec<Crossing> {
        let at = [place[0], place[1]];
        if !self.plan.encloses(at) {
            return Vec::new();
        }
        let stretch = self.bottom.at(at).zip(self.top.at(at));
        let stretch = stretch.filter(|(bottom, top)| bottom < top);
        let ends = stretch.into_iter();
        ends.flat_map(|(bottom, top)| Crossing::ends([bottom, top]))
            .collect()
    }

    fn corners(&self) -> Vec<[f64; 3]> {
        let mut corners = corners_over(&self.plan, &self.bottom);
        corners.extend(corners_over(&self.plan, &self.top));
        corners
    }

    fn words(&self) -> String {
        let height = |of: &Height| match of {
            Height::Level(level) => format!("z = {}", short(*level)),
            Height::Terrain(_) => "a surface".to_owned(),
        };
        format!(
            "ground from {} to {} over {} corners in plan",
            height(&self.bottom),
            height(&self.top),
            self.plan.len()
        )
    }
}
