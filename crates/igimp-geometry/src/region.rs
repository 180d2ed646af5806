//! Regions of the plane or of space that are filled with particles.

use std::fmt::Debug;

use crate::polygon::{
    Polygon, area_and_centroid, bounding_box, clip_to_box, clip_to_strip, contains,
};

/// The part of a region within a box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Part<const D: usize> {
    /// Its volume \[length^D\]; 0 for nothing.
    pub volume: f64,
    /// Its centroid \[length\]; any point where there is no volume.
    pub centroid: [f64; D],
}

impl<const D: usize> Part<D> {
    /// Nothing at all.
    pub const NOTHING: Self = Self {
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

/// Where an upright line passes the boundary of a region.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crossing {
    /// Level \[length\].
    pub level: f64,
    /// Along an upright line the crossings with `true` and those with `false` are the tops and the bottoms, or the
    /// bottoms and the tops.
    pub sense: bool,
}

impl Crossing {
    /// The ends of a stretch of an upright line.
    pub(crate) fn ends([bottom, top]: [f64; 2]) -> [Self; 2] {
        [(bottom, false), (top, true)].map(|(level, sense)| Self { level, sense })
    }
}

/// The part of a region above one box in plan, without end along the last axis.
pub trait Column<const D: usize> {
    /// The part between two levels.
    fn within(&self, ends: [f64; 2]) -> Part<D>;

    /// How much of what lies between two levels belongs to it.
    fn cover(&self, ends: [f64; 2]) -> Cover;
}

/// A region of the plane or of space, its boundary included. Its last axis points up.
pub trait Region<const D: usize>: Debug + Send + Sync {
    /// Lower and upper corner of the smallest box around it \[length\].
    fn bounds(&self) -> ([f64; D], [f64; D]);

    /// The part of it within a box.
    fn within(&self, lower: [f64; D], upper: [f64; D]) -> Part<D>;

    /// How much of a box belongs to it.
    fn cover(&self, lower: [f64; D], upper: [f64; D]) -> Cover;

    /// Its part between two places on the first axis, if boxes are sooner cut from that than from all of it: its
    /// part within such a box is the same to the bit.
    fn strip(&self, _lower: f64, _upper: f64) -> Option<Box<dyn Region<D>>> {
        None
    }

    /// Its parts above and below a box along the last axis, if boxes one above the other are sooner cut from that:
    /// their parts are the same but for round-off.
    fn column(&self, _lower: [f64; D], _upper: [f64; D]) -> Option<Box<dyn Column<D>>> {
        None
    }

    /// Whether a point lies in it; on its boundary either may be said.
    fn encloses(&self, point: [f64; D]) -> bool;

    /// Where the upright line through a place passes its boundary; of edges that the line runs along, nothing.
    fn crossings(&self, place: &[f64; D]) -> Vec<Crossing>;

    /// The level of its highest point on the upright line through a place \[length\], if the line meets it.
    fn top(&self, place: &[f64; D]) -> Option<f64> {
        let levels = self.crossings(place).into_iter().map(|hit| hit.level);
        levels.reduce(f64::max)
    }

    /// Corners between which its boundary is straight, or nearly so \[length\]; of a polygon in order.
    fn corners(&self) -> Vec<[f64; D]>;

    /// The edges of its boundary that a drawing shows, as lines by their corners \[length\]; a closed line ends where it begins.
    /// Faces that meet in a blunt angle have no edge between them, nor has a round face. None of a region of the plane, which
    /// has its polygon.
    fn edges(&self) -> Vec<Vec<[f64; D]>> {
        Vec::new()
    }

    /// Corners in order, of a polygon in the plane; of another region none.
    fn polygon(&self) -> &[[f64; D]] {
        &[]
    }

    /// Its description in words.
    fn words(&self) -> String;

    /// Its volume \[length^D\].
    fn volume(&self) -> f64 {
        let (lower, upper) = self.bounds();
        self.within(lower, upper).volume
    }

    /// A point of it, or of the box around it, that does not lie in a box.
    fn beyond(&self, lower: [f64; D], upper: [f64; D]) -> Option<[f64; D]> {
        let (from, to) = self.bounds();
        [from, to]
            .into_iter()
            .find(|corner| is_off(corner, &lower, &upper))
    }
}

/// Whether a point does not lie in a box, or is not a number.
pub(crate) fn is_off<const D: usize>(point: &[f64; D], lower: &[f64; D], upper: &[f64; D]) -> bool {
    (0..D).any(|axis| !(lower[axis] <= point[axis] && point[axis] <= upper[axis]))
}

/// A polygon by its corners, in order, either way round.
impl Region<2> for [[f64; 2]] {
    fn bounds(&self) -> ([f64; 2], [f64; 2]) {
        bounding_box(self)
    }

    fn within(&self, lower: [f64; 2], upper: [f64; 2]) -> Part<2> {
        let (area, centroid) = area_and_centroid(&clip_to_box(self, lower, upper));
        Part {
            volume: area.abs(),
            centroid,
        }
    }

    fn cover(&self, _lower: [f64; 2], _upper: [f64; 2]) -> Cover {
        Cover::Cut
    }

    fn strip(&self, lower: f64, upper: f64) -> Option<Box<dyn Region<2>>> {
        Some(Box::new(clip_to_strip(self, 0, lower, upper)))
    }

    fn encloses(&self, point: [f64; 2]) -> bool {
        contains(self, point)
    }

    fn beyond(&self, lower: [f64; 2], upper: [f64; 2]) -> Option<[f64; 2]> {
        let is_off = |corner: &&[f64; 2]| is_off(corner, &lower, &upper);
        self.iter().find(is_off).copied()
    }

    fn crossings(&self, place: &[f64; 2]) -> Vec<Crossing> {
        let x = place[0];
        edges(self)
            .filter(|[p, q]| (p[0] <= x) != (q[0] <= x))
            .map(|edge| Crossing {
                level: level_at(edge, x),
                sense: edge[1][0] < edge[0][0],
            })
            .collect()
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

    fn corners(&self) -> Vec<[f64; 2]> {
        self.to_vec()
    }

    fn polygon(&self) -> &[[f64; 2]] {
        self
    }

    fn words(&self) -> String {
        format!("polygon of {} corners", self.len())
    }

    fn volume(&self) -> f64 {
        area_and_centroid(self).0.abs()
    }
}

/// The level of the straight edge from `p` to `q` at x.
fn level_at([p, q]: [[f64; 2]; 2], x: f64) -> f64 {
    let t = (x - p[0]) / (q[0] - p[0]);
    p[1] + t * (q[1] - p[1])
}

fn edges(polygon: &[[f64; 2]]) -> impl Iterator<Item = [[f64; 2]; 2]> + '_ {
    (0..polygon.len()).map(|k| [polygon[k], polygon[(k + 1) % polygon.len()]])
}

/// As its corners.
impl Region<2> for Polygon {
    fn bounds(&self) -> ([f64; 2], [f64; 2]) {
        self.as_slice().bounds()
    }

    fn within(&self, lower: [f64; 2], upper: [f64; 2]) -> Part<2> {
        self.as_slice().within(lower, upper)
    }

    fn cover(&self, lower: [f64; 2], upper: [f64; 2]) -> Cover {
        self.as_slice().cover(lower, upper)
    }

    fn strip(&self, lower: f64, upper: f64) -> Option<Box<dyn Region<2>>> {
        self.as_slice().strip(lower, upper)
    }

    fn encloses(&self, point: [f64; 2]) -> bool {
        self.as_slice().encloses(point)
    }

    fn beyond(&self, lower: [f64; 2], upper: [f64; 2]) -> Option<[f64; 2]> {
        self.as_slice().beyond(lower, upper)
    }

    fn crossings(&self, place: &[f64; 2]) -> Vec<Crossing> {
        self.as_slice().crossings(place)
    }

    fn top(&self, place: &[f64; 2]) -> Option<f64> {
        self.as_slice().top(place)
    }

    fn corners(&self) -> Vec<[f64; 2]> {
        self.clone()
    }

    fn polygon(&self) -> &[[f64; 2]] {
        self
    }

    fn words(&self) -> String {
        self.as_slice().words()
    }

    fn volume(&self) -> f64 {
        self.as_slice().volume()
    }
}
