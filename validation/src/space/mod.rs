//! Three dimensions: columns, slices, slopes between walls, spheres and bars, by case files in space where those can
//! say it.

pub(crate) mod column;
pub(crate) mod cryer;
pub(crate) mod safety;
pub(crate) mod slice;
pub(crate) mod sphere;
pub(crate) mod torsion;
pub(crate) mod walls;

use igimp_geometry::region::{Cover, Crossing, Part, Region};
use igimp_geometry::solid::Solid;

/// The part of a solid around the origin at positive coordinates, which symmetry leaves.
#[derive(Debug)]
struct Octant(Solid);

impl Region<3> for Octant {
    fn bounds(&self) -> ([f64; 3], [f64; 3]) {
        let (lower, upper) = self.0.bounds();
        (lower.map(|x| x.max(0.0)), upper)
    }

    fn within(&self, lower: [f64; 3], upper: [f64; 3]) -> Part<3> {
        self.0.within(lower.map(|x| x.max(0.0)), upper)
    }

    fn cover(&self, lower: [f64; 3], upper: [f64; 3]) -> Cover {
        self.0.cover(lower, upper)
    }

    fn encloses(&self, point: [f64; 3]) -> bool {
        point.iter().all(|&x| x >= 0.0) && self.0.encloses(point)
    }

    fn crossings(&self, place: &[f64; 3]) -> Vec<Crossing> {
        self.0.crossings(place)
    }

    fn corners(&self) -> Vec<[f64; 3]> {
        self.0.corners()
    }

    fn words(&self) -> String {
        self.0.words()
    }
}
