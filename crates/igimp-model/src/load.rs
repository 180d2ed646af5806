//! Loads.

use igimp_geometry::polygon::{area_and_centroid, bounding_box};
use igimp_geometry::region::{Part, Region as _};
use igimp_geometry::solid::{Cylinder, Prism};
use igimp_text::short;

/// A load that stages apply.
#[derive(Clone, Debug, PartialEq)]
pub struct Load<const D: usize> {
    /// Name.
    pub name: String,
    /// Kind.
    pub kind: LoadKind<D>,
}

/// Kinds of loads.
#[derive(Clone, Debug, PartialEq)]
pub enum LoadKind<const D: usize> {
    /// A level rigid footing on the surface, pushed down by displacement stages; in plane strain only. The grid
    /// follows.
    RigidFooting {
        /// Left end of the base \[m\].
        from: [f64; 2],
        /// Right end of the base, at the same level \[m\].
        to: [f64; 2],
        /// Whether the soil sticks to base and shaft.
        rough: bool,
        /// Factor on the reported reaction, 2 for half a footing \[-\].
        reaction_factor: f64,
    },
    /// A dead pressure on a segment of the surface, or in space on a rectangle, raised by load stages.
    Pressure {
        /// One end, or corner \[m\].
        from: [f64; D],
        /// The other end, or the corner across \[m\].
        to: [f64; D],
        /// Traction at factor 1 \[Pa\], its components.
        traction: [f64; D],
    },
    /// A dead pressure on a level circle or polygon in space, raised by load stages. Its part beyond the grid, as behind a
    /// plane of symmetry, is left out.
    Patch {
        /// Its area in plan.
        plan: Plan,
        /// Its level \[m\].
        level: f64,
        /// Traction at factor 1 \[Pa\], its components.
        traction: [f64; D],
    },
    /// A dead force at a point, raised by load stages.
    Point {
        /// Where \[m\].
        at: [f64; D],
        /// Force at factor 1 \[N/m\], in space \[N\].
        force: [f64; D],
    },
}

/// The area of a load in plan.
#[derive(Clone, Debug, PartialEq)]
pub enum Plan {
    /// A circle.
    Circle {
        /// Centre, x and y \[m\].
        centre: [f64; 2],
        /// Radius \[m\].
        radius: f64,
    },
    /// A polygon: corners in order, either way round, x and y \[m\].
    Polygon(Vec<[f64; 2]>),
}

impl Plan {
    /// Lower and upper corner of the rectangle around its part in a box given by two corners, of which only x and
    /// y count \[m\].
    pub fn bounds<const D: usize>(
        &self,
        (lower, upper): (&[f64; D], &[f64; D]),
    ) -> ([f64; 2], [f64; 2]) {
        let (from, to) = match self {
            Self::Circle { centre, radius } => {
                (centre.map(|x| x - radius), centre.map(|x| x + radius))
            }
            Self::Polygon(corners) => bounding_box(corners),
        };
        (
            [0, 1].map(|axis| from[axis].max(lower[axis])),
            [0, 1].map(|axis| to[axis].min(upper[axis])),
        )
    }

    /// Its area \[m²\].
    pub fn area(&self) -> f64 {
        match self {
            Self::Circle { radius, .. } => std::f64::consts::PI * radius * radius,
            Self::Polygon(corners) => area_and_centroid(corners).0.abs(),
        }
    }

    /// Its parts in a grid of rectangles, so many along either side of a rectangle: area \[m²\] and centroid \[m\] of each
    /// that has any.
    pub fn parts(
        &self,
        (lower, upper): ([f64; 2], [f64; 2]),
        counts: [usize; 2],
    ) -> Vec<(f64, [f64; 2])> {
        let place = |axis: usize, k: usize| {
            lower[axis] + k as f64 / counts[axis] as f64 * (upper[axis] - lower[axis])
        };
        let all = (0..counts[0] * counts[1]).map(|k| [k % counts[0], k / counts[0]]);
        let parts = all.map(|[i, j]| {
            let from = [place(0, i), place(1, j), 0.0];
            let to = [place(0, i + 1), place(1, j + 1), 1.0];
            self.within(from, to)
        });
        let parts = parts.map(|part| (part.volume, [part.centroid[0], part.centroid[1]]));
        parts.filter(|(area, _)| *area > 0.0).collect()
    }

    /// Its part in a box, as a solid between the levels 0 and 1.
    fn within(&self, lower: [f64; 3], upper: [f64; 3]) -> Part<3> {
        let between = [0.0, 1.0];
        match self {
            Self::Circle { centre, radius } => Cylinder {
                axis: 2,
                centre: *centre,
                radius: *radius,
                between,
            }
            .within(lower, upper),
            Self::Polygon(corners) => Prism::new(corners.clone(), 2, between).within(lower, upper),
        }
    }

    /// Its kind and place, in words.
    pub fn words(&self) -> String {
        let point = |[x, y]: &[f64; 2]| format!("({}, {})", short(*x), short(*y));
        match self {
            Self::Circle { centre, radius } => {
                format!("circle about {}, radius {}", point(centre), short(*radius))
            }
            Self::Polygon(corners) => {
                let corners: Vec<String> = corners.iter().map(point).collect();
                corners.join(" ")
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// GOAL: parts of a patch have its area and its centroid, whatever they are cut into.
    #[test]
    fn parts_make_up_the_whole() {
        let circle = Plan::Circle {
            centre: [1.0, -2.0],
            radius: 0.7,
        };
        let triangle = Plan::Polygon(vec![[0.0, 0.0], [3.0, 0.0], [0.0, 1.5]]);
        for (plan, centroid) in [(circle, [1.0, -2.0]), (triangle, [1.0, 0.5])] {
            let around = plan.bounds((&[-9.0; 3], &[9.0; 3]));
            let parts = plan.parts(around, [7, 4]);
            let area: f64 = parts.iter().map(|(area, _)| area).sum();
            assert!((area - plan.area()).abs() < 1e-13, "{area}");
            for axis in 0..2 {
                let moment: f64 = parts.iter().map(|(area, at)| area * at[axis]).sum();
                assert!((moment / area - centroid[axis]).abs() < 1e-13, "{moment}");
            }
        }
    }
}
