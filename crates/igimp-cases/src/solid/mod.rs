//! Bodies in space: boxes, prisms, cylinders, spheres, closed surfaces, layers of ground, and what is
//! left of one when others are taken out.
//!
//! The axes are x, y and z, z up. What lies of a solid within a box is exact but for round-off where its
//! faces are flat (theory, eq. 44a), and for a cylinder; [`Sphere`] and [`Solid::without`] say how right they are.

mod cuboid;
mod difference;
mod facets;
mod layer;
mod prism;
mod round;
mod surface;
mod terrain;

use std::fmt::Debug;
use std::sync::Arc;

use crate::case::{Cover, Crossing, Region, Within, is_off};
use cuboid::Cuboid;
use difference::Difference;
use prism::Prism;

pub use layer::{Layer, LayerError};
pub use round::{Cylinder, Sphere};
pub use surface::{ClosedSurface, ClosedSurfaceError};
pub use terrain::{Height, Terrain, TerrainError};

type Point = [f64; 3];
type Corners = (Point, Point);

/// A body in space.
#[derive(Clone, Debug)]
pub struct Solid {
    shape: Arc<dyn Shape>,
    corners: Vec<Point>,
}

/// What a solid knows of itself; see [`Region`].
trait Shape: Debug + Send + Sync {
    fn bounds(&self) -> Corners;

    fn volume(&self) -> f64 {
        let (lower, upper) = self.bounds();
        self.within(lower, upper).volume
    }

    fn within(&self, lower: Point, upper: Point) -> Within<3>;

    fn cover(&self, lower: Point, upper: Point) -> Cover;

    fn beyond(&self, lower: Point, upper: Point) -> Option<Point> {
        let (from, to) = self.bounds();
        let mut corners = [from, to].into_iter();
        corners.find(|corner| is_off(corner, &lower, &upper))
    }

    fn contains(&self, point: &Point) -> bool;

    /// Along the upright line at a place in plan; tops have the sense `true`.
    fn crossings(&self, at: [f64; 2]) -> Vec<Crossing>;

    fn corners(&self) -> Vec<Point>;

    fn words(&self) -> String;

    /// The corners of a box with its sides along the axes.
    fn as_cuboid(&self) -> Option<Corners> {
        None
    }
}

impl Solid {
    fn of(shape: impl Shape + 'static) -> Self {
        let corners = shape.corners();
        Self {
            shape: Arc::new(shape),
            corners,
        }
    }

    /// A box with its sides along the axes, by its lower and upper corner \[length\].
    pub fn cuboid(lower: Point, upper: Point) -> Self {
        Self::of(Cuboid { lower, upper })
    }

    /// A polygon, either way round, in the plane of the axes other than this one (0, 1 or 2), in their order; moved along
    /// it from a place to another \[length\].
    pub fn prism(polygon: Vec<[f64; 2]>, axis: usize, between: [f64; 2]) -> Self {
        Self::of(Prism {
            polygon,
            axis,
            between,
        })
    }

    /// A slice of a plane case: its polygon in x and y, which point right and up, stands in x and z between
    /// two places on the axis y across it.
    pub fn slice(polygon: &[[f64; 2]], across: [f64; 2]) -> Self {
        Self::prism(polygon.to_vec(), 1, across)
    }

    /// What is left when others are taken out.
    ///
    /// What is left within a box is exact where one boundary runs through the box, and where all but one are those of
    /// boxes along the axes. Elsewhere the box is cut into 16³, and the solids are taken to be spread evenly in those of
    /// them that several boundaries still cross: the error is below a thousandth of the box.
    #[must_use]
    pub fn without(self, others: Vec<Self>) -> Self {
        if others.is_empty() {
            return self;
        }
        Self::of(Difference {
            of: self,
            minus: others,
        })
    }
}

impl From<Cylinder> for Solid {
    fn from(cylinder: Cylinder) -> Self {
        Self::of(cylinder)
    }
}

impl From<Sphere> for Solid {
    fn from(sphere: Sphere) -> Self {
        Self::of(sphere)
    }
}

impl From<ClosedSurface> for Solid {
    fn from(surface: ClosedSurface) -> Self {
        Self::of(surface)
    }
}

impl From<Layer> for Solid {
    fn from(layer: Layer) -> Self {
        Self::of(layer)
    }
}

impl Region<3> for Solid {
    fn bounds(&self) -> Corners {
        self.shape.bounds()
    }

    fn volume(&self) -> f64 {
        self.shape.volume()
    }

    fn within(&self, lower: Point, upper: Point) -> Within<3> {
        self.shape.within(lower, upper)
    }

    fn cover(&self, lower: Point, upper: Point) -> Cover {
        self.shape.cover(lower, upper)
    }

    fn beyond(&self, lower: Point, upper: Point) -> Option<Point> {
        self.shape.beyond(lower, upper)
    }

    fn contains(&self, point: &Point) -> bool {
        self.shape.contains(point)
    }

    fn crossings(&self, place: &Point) -> Vec<Crossing> {
        self.shape.crossings([place[0], place[1]])
    }

    fn corners(&self) -> &[Point] {
        &self.corners
    }

    fn words(&self) -> String {
        self.shape.words()
    }
}

/// The crossings of a line with a convex body, if it meets it.
fn ends(levels: Option<[f64; 2]>) -> Vec<Crossing> {
    let crossing = |(level, sense)| Crossing { level, sense };
    let ends = |[bottom, top]: [f64; 2]| [(bottom, false), (top, true)].map(crossing);
    levels.map(ends).into_iter().flatten().collect()
}

/// What two boxes have in common, if that has volume.
fn common(a: Corners, b: Corners) -> Option<Corners> {
    let lower: Point = std::array::from_fn(|axis| a.0[axis].max(b.0[axis]));
    let upper: Point = std::array::from_fn(|axis| a.1[axis].min(b.1[axis]));
    (0..3)
        .all(|axis| lower[axis] < upper[axis])
        .then_some((lower, upper))
}
