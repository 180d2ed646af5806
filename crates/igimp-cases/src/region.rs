//! What is filled with particles: a region of the plane or of space, and what filling asks of it.

use crate::input::contains;
use crate::polygon::{area_and_centroid, bounding_box, clip_to_box};

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

/// A region of the plane or of space, its boundary included.
pub trait Region<const D: usize> {
    /// Lower and upper corner of the smallest box around it \[length\].
    fn bounds(&self) -> ([f64; D], [f64; D]);

    /// The part of it within a box.
    fn within(&self, lower: [f64; D], upper: [f64; D]) -> Part<D>;

    /// How much of a box belongs to it.
    fn cover(&self, lower: [f64; D], upper: [f64; D]) -> Cover;

    /// Whether a point lies in it; on its boundary either may be said.
    fn encloses(&self, point: [f64; D]) -> bool;

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

    fn cover(&self, lower: [f64; 2], upper: [f64; 2]) -> Cover {
        let (from, to) = self.bounds();
        if (0..2).any(|axis| upper[axis] <= from[axis] || to[axis] <= lower[axis]) {
            Cover::Nothing
        } else {
            Cover::Cut
        }
    }

    fn encloses(&self, point: [f64; 2]) -> bool {
        contains(self, point)
    }

    fn beyond(&self, lower: [f64; 2], upper: [f64; 2]) -> Option<[f64; 2]> {
        let is_off = |corner: &&[f64; 2]| is_off(corner, &lower, &upper);
        self.iter().find(is_off).copied()
    }
}
