//! What a body fills: a region of the plane or of space.

use std::fmt::Debug;
use std::sync::Arc;

use crate::input::contains;
use crate::polygon::{Polygon, area_and_centroid, bounding_box, clip_to_box, clip_to_strip};

/// A place as it is seen from the front: its first coordinate and its level \[m\]. In the plane, the place itself.
pub(crate) fn front<const D: usize>(place: &[f64; D]) -> [f64; 2] {
    [place[0], place[D - 1]]
}

/// A point with zeros for the coordinates that it does not have \[m\].
pub(crate) fn in_space<const D: usize>(point: &[f64; D]) -> [f64; 3] {
    std::array::from_fn(|axis| point.get(axis).copied().unwrap_or(0.0))
}

/// A point of a drawing from the front in the plane or in space, there in the plane y = 0 \[m\].
pub(crate) fn from_front<const D: usize>([x, level]: [f64; 2]) -> [f64; D] {
    let mut point = [0.0; D];
    point[0] = x;
    point[D - 1] = level;
    point
}

/// The part of a region within a box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Within<const D: usize> {
    /// Its area \[m²\], in space its volume \[m³\].
    pub volume: f64,
    /// Its centroid \[m\].
    pub centroid: [f64; D],
}

impl<const D: usize> Within<D> {
    /// Nothing at all.
    pub(crate) const NOTHING: Self = Self {
        volume: 0.0,
        centroid: [0.0; D],
    };

    /// A whole box.
    pub fn whole(lower: [f64; D], upper: [f64; D]) -> Self {
        Self {
            volume: (0..D).map(|axis| upper[axis] - lower[axis]).product(),
            centroid: std::array::from_fn(|axis| 0.5 * (lower[axis] + upper[axis])),
        }
    }
}

/// How much of a box belongs to a region.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cover {
    /// Nothing.
    Nothing,
    /// All of it.
    Whole,
    /// A part, or it is not known.
    Cut,
}

/// Whether a point does not lie in a box, or is not a number.
pub(crate) fn is_off<const D: usize>(point: &[f64; D], lower: &[f64; D], upper: &[f64; D]) -> bool {
    (0..D).any(|axis| !(lower[axis] <= point[axis] && point[axis] <= upper[axis]))
}

/// Where an upright line passes the boundary of a region.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crossing {
    /// Level \[m\].
    pub level: f64,
    /// Whether the region lies on one side of the boundary as seen along it, rather than on the other: along an upright
    /// line the crossings with `true` and those with `false` are the tops and the bottoms, or the bottoms and the tops.
    pub sense: bool,
}

/// A region that a body fills with particles. Its last axis points up.
pub trait Region<const D: usize>: Debug + Send + Sync {
    /// Corners of the lowest and of the highest coordinates of the box around it \[m\].
    fn bounds(&self) -> ([f64; D], [f64; D]);

    /// Its area \[m²\], in space its volume \[m³\].
    fn volume(&self) -> f64;

    /// Its part within a box, given by the corners of its lowest and of its highest coordinates \[m\].
    fn within(&self, lower: [f64; D], upper: [f64; D]) -> Within<D>;

    /// How much of a box belongs to it, if that is known without cutting it.
    fn cover(&self, _lower: [f64; D], _upper: [f64; D]) -> Cover {
        Cover::Cut
    }

    /// What of it lies between two places on the first axis, if boxes are cut from that sooner than from all of it: its
    /// part within such a box is the same to the bit.
    fn strip(&self, _lower: f64, _upper: f64) -> Option<Arc<dyn Region<D>>> {
        None
    }

    /// A point of it, or of the box around it, that does not lie in a box.
    fn beyond(&self, lower: [f64; D], upper: [f64; D]) -> Option<[f64; D]> {
        let (from, to) = self.bounds();
        let mut corners = [from, to].into_iter();
        corners.find(|corner| is_off(corner, &lower, &upper))
    }

    /// Whether a point lies in it; on its boundary either may be said.
    fn contains(&self, point: &[f64; D]) -> bool;

    /// Where the upright line through a place passes its boundary; of edges that the line runs along, nothing.
    fn crossings(&self, place: &[f64; D]) -> Vec<Crossing>;

    /// The level of its highest point on the upright line through a place \[m\], if the line meets it.
    fn top(&self, place: &[f64; D]) -> Option<f64> {
        let levels = self.crossings(place).into_iter().map(|own| own.level);
        levels.reduce(f64::max)
    }

    /// Corners between which its boundary is straight \[m\]; of a polygon in order.
    fn corners(&self) -> &[[f64; D]];

    /// What it is, in words.
    fn words(&self) -> String;
}

/// The level of the straight edge from `p` to `q` at x.
fn level_at([p, q]: [[f64; 2]; 2], x: f64) -> f64 {
    let t = (x - p[0]) / (q[0] - p[0]);
    p[1] + t * (q[1] - p[1])
}

fn edges(polygon: &[[f64; 2]]) -> impl Iterator<Item = [[f64; 2]; 2]> + '_ {
    (0..polygon.len()).map(|k| [polygon[k], polygon[(k + 1) % polygon.len()]])
}

/// Where the upright line at x crosses the edges of a polygon.
pub(crate) fn crossings(polygon: &[[f64; 2]], x: f64) -> impl Iterator<Item = Crossing> + '_ {
    edges(polygon)
        .filter(move |[p, q]| (p[0] <= x) != (q[0] <= x))
        .map(move |edge| Crossing {
            level: level_at(edge, x),
            sense: edge[1][0] < edge[0][0],
        })
}

impl Region<2> for Polygon {
    fn bounds(&self) -> ([f64; 2], [f64; 2]) {
        bounding_box(self)
    }

    fn volume(&self) -> f64 {
        area_and_centroid(self).0.abs()
    }

    fn within(&self, lower: [f64; 2], upper: [f64; 2]) -> Within<2> {
        let (signed, centroid) = area_and_centroid(&clip_to_box(self, lower, upper));
        Within {
            volume: signed.abs(),
            centroid,
        }
    }

    fn strip(&self, lower: f64, upper: f64) -> Option<Arc<dyn Region<2>>> {
        Some(Arc::new(clip_to_strip(self, 0, lower, upper)))
    }

    fn beyond(&self, lower: [f64; 2], upper: [f64; 2]) -> Option<[f64; 2]> {
        let mut corners = self.iter().copied();
        corners.find(|corner| is_off(corner, &lower, &upper))
    }

    fn contains(&self, point: &[f64; 2]) -> bool {
        contains(self, *point)
    }

    fn crossings(&self, place: &[f64; 2]) -> Vec<Crossing> {
        crossings(self, place[0]).collect()
    }

    fn top(&self, place: &[f64; 2]) -> Option<f64> {
        let x = place[0];
        let tops = edges(self).filter_map(|[p, q]| {
            let [left, right] = [p[0].min(q[0]), p[0].max(q[0])];
            if x < left || x > right {
                return None;
            }
            Some(if right > left {
                level_at([p, q], x)
            } else {
                p[1].max(q[1])
            })
        });
        tops.reduce(f64::max)
    }

    fn corners(&self) -> &[[f64; 2]] {
        self
    }

    fn words(&self) -> String {
        format!("polygon of {} corners", self.len())
    }
}
