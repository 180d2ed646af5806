//! Markers of points.

use crate::drawing::Contour;
use crate::geometry::Point;

/// Shape of a marker.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Marker {
    Circle,
    Square,
    Triangle,
    Diamond,
}

impl Marker {
    /// The shape for the `index`-th series of a plot.
    pub(crate) fn of_cycle(index: usize) -> Self {
        [Self::Circle, Self::Square, Self::Triangle, Self::Diamond][index % 4]
    }

    /// The outline about a centre; all shapes look equally large at the same radius \[pt\].
    pub(crate) fn contour(self, centre: Point, radius: f64) -> Contour {
        let star = |reach: f64, directions: &[Point]| {
            let corner = |d: &Point| [centre[0] + reach * d[0], centre[1] + reach * d[1]];
            Contour::Closed(directions.iter().map(corner).collect())
        };
        match self {
            Self::Circle => Contour::Circle { centre, radius },
            Self::Square => star(
                0.89 * radius,
                &[[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]],
            ),
            Self::Triangle => star(1.25 * radius, &[[0.0, -1.0], [0.95, 0.65], [-0.95, 0.65]]),
            Self::Diamond => star(
                1.25 * radius,
                &[[0.0, -1.0], [1.0, 0.0], [0.0, 1.0], [-1.0, 0.0]],
            ),
        }
    }
}
