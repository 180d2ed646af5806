//! Bodies in space: boxes, prisms, cylinders, spheres, closed surfaces, layers of ground, and what is
//! left of one when others are taken out.
//!
//! The axes are x, y and z, z up. The part of a solid within a box is exact but for round-off where its
//! faces are flat (theory, eq. 44a and 44b), for a cylinder too; [`Sphere`] and [`Difference`] say how right they are.

mod difference;
mod edges;
mod facets;
mod layer;
mod prism;
mod round;
mod standing;
mod surface;
mod terrain;

use std::sync::Arc;

use igimp_text::short;

use crate::region::{Column, Cover, Crossing, Part, Region};

pub use difference::Difference;
pub use layer::{Layer, LayerError};
pub use prism::Prism;
pub use round::{Cylinder, Sphere};
pub use surface::{ClosedSurface, ClosedSurfaceError};
pub use terrain::{Height, Terrain, TerrainError};

/// A body in space.
#[derive(Clone, Debug, PartialEq)]
pub enum Solid {
    /// A box with its sides along the axes, by its lower and upper corner \[length\].
    Cuboid([f64; 3], [f64; 3]),
    /// A polygon moved along an axis.
    Prism(Prism),
    /// A circular cylinder along an axis.
    Cylinder(Cylinder),
    /// A sphere.
    Sphere(Sphere),
    /// The inside of a closed surface of triangles.
    Surface(Arc<ClosedSurface>),
    /// The ground between two surfaces.
    Layer(Arc<Layer>),
    /// A solid with others cut out.
    Difference(Difference),
}

impl Solid {
    /// A slice of a plane case: its polygon in x and y, which point right and up, stands in x and z between
    /// two places on the axis y across it.
    pub fn slice(polygon: &[[f64; 2]], across: [f64; 2]) -> Self {
        Self::Prism(Prism::new(polygon.to_vec(), 1, across))
    }

    fn region(&self) -> &dyn Region<3> {
        match self {
            Self::Cuboid(..) => self,
            Self::Prism(prism) => prism,
            Self::Cylinder(cylinder) => cylinder,
            Self::Sphere(sphere) => sphere,
            Self::Surface(surface) => &**surface,
            Self::Layer(layer) => &**layer,
            Self::Difference(difference) => difference,
        }
    }
}

impl Region<3> for Solid {
    fn bounds(&self) -> ([f64; 3], [f64; 3]) {
        match self {
            Self::Cuboid(lower, upper) => (*lower, *upper),
            other => other.region().bounds(),
        }
    }

    fn within(&self, lower: [f64; 3], upper: [f64; 3]) -> Part<3> {
        match self {
            Self::Cuboid(from, to) => match common((*from, *to), (lower, upper)) {
                Some((from, to)) => Part::whole(from, to),
                None => Part::NOTHING,
            },
            other => other.region().within(lower, upper),
        }
    }

    fn cover(&self, lower: [f64; 3], upper: [f64; 3]) -> Cover {
        match self {
            Self::Cuboid(from, to) => {
                if common((*from, *to), (lower, upper)).is_none() {
                    Cover::Nothing
                } else if (0..3).all(|axis| from[axis] <= lower[axis] && upper[axis] <= to[axis]) {
                    Cover::Whole
                } else {
                    Cover::Cut
                }
            }
            other => other.region().cover(lower, upper),
        }
    }

    fn strip(&self, lower: f64, upper: f64) -> Option<Box<dyn Region<3>>> {
        match self {
            Self::Cuboid(..) => None,
            other => other.region().strip(lower, upper),
        }
    }

    fn column(&self, lower: [f64; 3], upper: [f64; 3]) -> Option<Box<dyn Column<3>>> {
        match self {
            Self::Cuboid(..) => None,
            other => other.region().column(lower, upper),
        }
    }

    fn encloses(&self, point: [f64; 3]) -> bool {
        match self {
            Self::Cuboid(lower, upper) => !crate::region::is_off(&point, lower, upper),
            other => other.region().encloses(point),
        }
    }

    fn volume(&self) -> f64 {
        match self {
            Self::Cuboid(lower, upper) => Part::whole(*lower, *upper).volume,
            other => other.region().volume(),
        }
    }

    fn beyond(&self, lower: [f64; 3], upper: [f64; 3]) -> Option<[f64; 3]> {
        match self {
            Self::Cuboid(from, to) => {
                let corners = [*from, *to];
                let is_off = |corner: &[f64; 3]| crate::region::is_off(corner, &lower, &upper);
                corners.into_iter().find(is_off)
            }
            other => other.region().beyond(lower, upper),
        }
    }

    fn crossings(&self, place: &[f64; 3]) -> Vec<Crossing> {
        match self {
            Self::Cuboid(lower, upper) => {
                let is_met =
                    (0..2).all(|axis| lower[axis] <= place[axis] && place[axis] < upper[axis]);
                let stretch = is_met.then_some([lower[2], upper[2]]);
                stretch.into_iter().flat_map(Crossing::ends).collect()
            }
            other => other.region().crossings(place),
        }
    }

    fn corners(&self) -> Vec<[f64; 3]> {
        match self {
            Self::Cuboid(lower, upper) => vec![*lower, *upper],
            other => other.region().corners(),
        }
    }

    fn edges(&self) -> Vec<Vec<[f64; 3]>> {
        edges::of(self)
    }

    fn words(&self) -> String {
        match self {
            Self::Cuboid(lower, upper) => format!("box from {} to {}", place(lower), place(upper)),
            other => other.region().words(),
        }
    }
}

/// Coordinates in words.
fn place<const D: usize>(point: &[f64; D]) -> String {
    format!("({})", point.map(short).join(", "))
}

type Corners = ([f64; 3], [f64; 3]);

/// The intersection of two boxes, if it has volume.
fn common(a: Corners, b: Corners) -> Option<Corners> {
    let lower: [f64; 3] = std::array::from_fn(|axis| a.0[axis].max(b.0[axis]));
    let upper: [f64; 3] = std::array::from_fn(|axis| a.1[axis].min(b.1[axis]));
    (0..3)
        .all(|axis| lower[axis] < upper[axis])
        .then_some((lower, upper))
}
