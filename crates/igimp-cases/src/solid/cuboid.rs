//! Boxes with their sides along the axes.

use super::{Corners, Point, Shape, common, ends};
use crate::case::{Cover, Crossing, Within, is_off};

/// A box.
#[derive(Clone, Debug)]
pub(super) struct Cuboid {
    pub(super) lower: Point,
    pub(super) upper: Point,
}

impl Shape for Cuboid {
    fn bounds(&self) -> Corners {
        (self.lower, self.upper)
    }

    fn within(&self, lower: Point, upper: Point) -> Within<3> {
        match common(self.bounds(), (lower, upper)) {
            Some((from, to)) => Within::whole(from, to),
            None => Within::NOTHING,
        }
    }

    fn cover(&self, lower: Point, upper: Point) -> Cover {
        if common(self.bounds(), (lower, upper)).is_none() {
            Cover::Nothing
        } else if (0..3)
            .all(|axis| self.lower[axis] <= lower[axis] && upper[axis] <= self.upper[axis])
        {
            Cover::Whole
        } else {
            Cover::Cut
        }
    }

    fn contains(&self, point: &Point) -> bool {
        !is_off(point, &self.lower, &self.upper)
    }

    fn crossings(&self, [x, y]: [f64; 2]) -> Vec<Crossing> {
        let is_met = self.contains(&[x, y, self.lower[2]]);
        ends(is_met.then_some([self.lower[2], self.upper[2]]))
    }

    fn corners(&self) -> Vec<Point> {
        let end = |corner: usize, axis: usize| {
            if corner >> axis & 1 == 0 {
                self.lower[axis]
            } else {
                self.upper[axis]
            }
        };
        let corner = |corner| std::array::from_fn(|axis| end(corner, axis));
        (0..8).map(corner).collect()
    }

    fn words(&self) -> String {
        "box".to_owned()
    }

    fn as_cuboid(&self) -> Option<Corners> {
        Some(self.bounds())
    }
}
