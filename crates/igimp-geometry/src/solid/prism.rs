//! A polygon moved along an axis: slices of plane cases, and polygons in plan between two levels.

use igimp_text::short;

use crate::polygon::{area_and_centroid, bounding_box, clip_to_box, clip_to_strip};
use crate::region::{Cover, Crossing, Part, Region};

/// A polygon in the plane of two axes, moved along the third.
#[derive(Clone, Debug, PartialEq)]
pub struct Prism {
    /// Corners in order, either way round, by the two other axes in their order \[length\].
    pub polygon: Vec<[f64; 2]>,
    /// The axis along which it is moved: 0, 1 or 2.
    pub axis: usize,
    /// From where to where on that axis \[length\].
    pub between: [f64; 2],
}

/// The two axes across an axis, in their order.
pub(super) fn across(axis: usize) -> [usize; 2] {
    match axis {
        0 => [1, 2],
        1 => [0, 2],
        _ => [0, 1],
    }
}

/// A point seen along an axis.
pub(super) fn seen(point: [f64; 3], axis: usize) -> [f64; 2] {
    across(axis).map(|other| point[other])
}

/// A point that is seen along an axis at a place, so far along that axis.
pub(super) fn placed(at: [f64; 2], axis: usize, along: f64) -> [f64; 3] {
    let mut point = [along; 3];
    for (other, at) in std::iter::zip(across(axis), at) {
        point[other] = at;
    }
    point
}

/// The overlap of two intervals, if it has length.
pub(super) fn overlap(a: [f64; 2], b: [f64; 2]) -> Option<[f64; 2]> {
    let common = [a[0].max(b[0]), a[1].min(b[1])];
    (common[0] < common[1]).then_some(common)
}

/// Overlap of an interval of an axis, and of the area seen along it, with a solid between two places.
pub(super) fn both(
    along: Option<[f64; 2]>,
    stretch: [f64; 2],
    seen: impl FnOnce() -> Cover,
) -> Cover {
    match along.map(|span| (span[0] <= stretch[0] && stretch[1] <= span[1], seen())) {
        None | Some((_, Cover::Nothing)) => Cover::Nothing,
        Some((true, Cover::Whole)) => Cover::Whole,
        Some(_) => Cover::Cut,
    }
}

/// How much of a rectangle belongs to a polygon.
pub(super) fn cover(polygon: &[[f64; 2]], lower: [f64; 2], upper: [f64; 2]) -> Cover {
    let next = polygon.iter().cycle().skip(1);
    let mut edges = std::iter::zip(polygon, next);
    if edges.any(|(p, q)| runs_into([*p, *q], lower, upper)) {
        return Cover::Cut;
    }
    let middle = [0, 1].map(|axis| 0.5 * (lower[axis] + upper[axis]));
    if polygon.encloses(middle) {
        Cover::Whole
    } else {
        Cover::Nothing
    }
}

/// Whether a segment may run through the inside of a rectangle.
fn runs_into([p, q]: [[f64; 2]; 2], lower: [f64; 2], upper: [f64; 2]) -> bool {
    let beside = (0..2)
        .any(|axis| p[axis].max(q[axis]) <= lower[axis] || p[axis].min(q[axis]) >= upper[axis]);
    if beside {
        return false;
    }
    let side = |x: f64, y: f64| (q[0] - p[0]) * (y - p[1]) - (q[1] - p[1]) * (x - p[0]);
    let corners = [
        side(lower[0], lower[1]),
        side(upper[0], lower[1]),
        side(lower[0], upper[1]),
        side(upper[0], upper[1]),
    ];
    !(corners.iter().all(|&side| side > 0.0) || corners.iter().all(|&side| side < 0.0))
}

impl Prism {
    /// A polygon by the axes other than this one, moved along it.
    pub fn new(polygon: Vec<[f64; 2]>, axis: usize, between: [f64; 2]) -> Self {
        Self {
            polygon,
            axis,
            between,
        }
    }

    fn along(&self, lower: [f64; 3], upper: [f64; 3]) -> Option<[f64; 2]> {
        overlap(self.between, [lower[self.axis], upper[self.axis]])
    }
}

impl Region<3> for Prism {
    fn bounds(&self) -> ([f64; 3], [f64; 3]) {
        let (lower, upper) = bounding_box(&self.polygon);
        let [from, to] = self.between;
        (placed(lower, self.axis, from), placed(upper, self.axis, to))
    }

    fn within(&self, lower: [f64; 3], upper: [f64; 3]) -> Part<3> {
        let Some([from, to]) = self.along(lower, upper) else {
            return Part::NOTHING;
        };
        let clipped = clip_to_box(
            &self.polygon,
            seen(lower, self.axis),
            seen(upper, self.axis),
        );
        let (area, centroid) = area_and_centroid(&clipped);
        Part {
            volume: area.abs() * (to - from),
            centroid: placed(centroid, self.axis, 0.5 * (from + to)),
        }
    }

    fn cover(&self, lower: [f64; 3], upper: [f64; 3]) -> Cover {
        let stretch = [lower[self.axis], upper[self.axis]];
        let (from, to) = (seen(lower, self.axis), seen(upper, self.axis));
        both(self.along(lower, upper), stretch, || {
            cover(&self.polygon, from, to)
        })
    }

    fn strip(&self, lower: f64, upper: f64) -> Option<Box<dyn Region<3>>> {
        let is_across = self.axis != 0;
        is_across.then(|| -> Box<dyn Region<3>> {
            let polygon = clip_to_strip(&self.polygon, 0, lower, upper);
            Box::new(Self::new(polygon, self.axis, self.between))
        })
    }

    fn encloses(&self, point: [f64; 3]) -> bool {
        let [from, to] = self.between;
        (from..=to).contains(&point[self.axis]) && self.polygon.encloses(seen(point, self.axis))
    }

    fn crossings(&self, place: &[f64; 3]) -> Vec<Crossing> {
        let [from, to] = self.between;
        if self.axis == 2 {
            let stretch = self
                .polygon
                .encloses([place[0], place[1]])
                .then_some([from, to]);
            return stretch.into_iter().flat_map(Crossing::ends).collect();
        }
        if !(from..to).contains(&place[self.axis]) {
            return Vec::new();
        }
        self.polygon.crossings(&seen(*place, self.axis))
    }

    fn corners(&self) -> Vec<[f64; 3]> {
        let ends = self.between.into_iter();
        ends.flat_map(|along| {
            self.polygon
                .iter()
                .map(move |&at| placed(at, self.axis, along))
        })
        .collect()
    }

    fn words(&self) -> String {
        let name = ["x", "y", "z"][self.axis];
        let [from, to] = self.between.map(short);
        format!(
            "polygon of {} corners from {name} = {from} to {to}",
            self.polygon.len()
        )
    }
}
