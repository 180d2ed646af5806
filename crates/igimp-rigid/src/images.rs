//! Knots beyond a side of the grid, and their images within it (theory, eq. 45h).

use igimp_shape::Grid;
use igimp_surface::vectors::{minus, norm};

use crate::RigidBody;

/// Knots that are closer than this share of a facet are one \[-\].
const ONE_PLACE: f64 = 1e-6;

/// For each knot the one that its soil is summed at. The soil within the grid is half of what a plane of symmetry has on both
/// sides: what it does around a knot beyond the plane, the soil that is not there does around the image of the knot.
pub struct Images<const D: usize> {
    of: Vec<Image<D>>,
}

/// Where the soil around a knot is summed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Image<const D: usize> {
    /// The knot.
    pub knot: usize,
    /// By axis, whether the image lies across a side of the grid.
    pub across: [bool; D],
}

impl<const D: usize> Image<D> {
    /// A knot by itself.
    pub const fn alone(knot: usize) -> Self {
        Self {
            knot,
            across: [false; D],
        }
    }

    /// The mirror image of a direction.
    pub fn mirrored(&self, direction: &[f64; D]) -> [f64; D] {
        std::array::from_fn(|axis| {
            let sign = if self.across[axis] { -1.0 } else { 1.0 };
            sign * direction[axis]
        })
    }
}

impl<const D: usize> Images<D> {
    /// The images of all knots of a body; a knot that has none is its own.
    pub fn of(body: &RigidBody<D>, grid: &Grid<D>) -> Self {
        let (surface, places) = (&*body.surface, body.knots());
        let spacing = surface.longest_facet();
        let image = |knot: usize| {
            let itself = Image::alone(knot);
            let (mut place, mut across, mut way) = (places[knot], [false; D], 0.0_f64);
            for axis in 0..D {
                let (start, end) = (grid.axes[axis].start(), grid.axes[axis].end());
                let side = place[axis].clamp(start, end);
                let beyond = (place[axis] - side).abs();
                if beyond > ONE_PLACE * spacing {
                    place[axis] = 2.0 * side - place[axis];
                    across[axis] = true;
                    way = way.max(beyond);
                }
            }
            // Soil within the grid is further from all other knots than a facet is long.
            if way == 0.0 || way > spacing {
                return itself;
            }
            let is_there = |&other: &usize| {
                surface.side_of(other) == surface.side_of(knot)
                    && norm(&minus(&places[other], &place)) <= ONE_PLACE * spacing
            };
            (0..places.len())
                .find(is_there)
                .map_or(itself, |knot| Image { knot, across })
        };
        Self {
            of: (0..places.len()).map(image).collect(),
        }
    }

    /// That of a knot.
    pub fn at(&self, knot: usize) -> Image<D> {
        self.of[knot]
    }

    /// The shares of the knots, those beyond a side added to their images.
    pub fn folded(&self, values: &[f64]) -> Vec<f64> {
        let mut folded = vec![0.0; values.len()];
        for (image, value) in std::iter::zip(&self.of, values) {
            folded[image.knot] += value;
        }
        folded
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Interface, RigidBody};
    use igimp_shape::Axis;
    use igimp_surface::Surface;

    // GOAL: half of a body sums its soil where the whole does.
    // CASE: a square of half-width 1 whose sides have knots at ±1/3 and ±1, on a grid that ends at its middle, at one of its knots, and
    // a quarter of the way between two.
    // ORACLE: by hand: the image of x across a side at s is 2s − x, where a knot of the same side of the square stands there.
    #[test]
    fn knots_beyond_a_side_have_their_images_within() {
        let square = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
        let surface = Surface::polygon(&square, 0.0, 2.0 / 3.0).unwrap();
        let body = RigidBody::new(surface, vec![Interface::smooth(); 4], [5.0, 0.0]);
        let knots = body.knots();
        let base = |x: f64| {
            let is_it = |knot: &[f64; 2]| norm(&minus(knot, &[5.0 + x, -1.0])) < 1e-12;
            (0..knots.len())
                .find(|&k| is_it(&knots[k]) && body.surface.side_of(k) == 0)
                .unwrap()
        };
        let third = 1.0 / 3.0;
        for (end, pairs) in [
            (0.0, vec![(-third, third)]),
            (third, vec![(-third, 1.0)]),
            (0.5 * third, vec![]),
        ] {
            let axis = |start: f64, end: f64| Axis::uniform(start, (end - start) / 8.0, 8).unwrap();
            let grid = Grid::new([axis(5.0 + end, 9.0), axis(-4.0, 4.0)]);
            let images = Images::of(&body, &grid);
            for x in [-1.0, -third, third, 1.0] {
                let found = images.at(base(x));
                match pairs.iter().find(|(from, _)| (from - x).abs() < 1e-9) {
                    Some(&(_, to)) => {
                        assert_eq!(found.knot, base(to), "{end} {x}");
                        assert_eq!(found.across, [true, false]);
                    }
                    None => assert_eq!(found, Image::alone(base(x)), "{end} {x}"),
                }
            }
        }
    }
}
