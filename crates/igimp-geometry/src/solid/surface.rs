//! Closed surfaces of triangles.

use std::collections::{BTreeMap, HashMap};

use thiserror::Error;

use super::facets::{Facets, Moments};
use super::standing::Standing;
use crate::region::{Column, Cover, Crossing, Part, Region};

/// Corners closer than this share of the largest coordinate are one: the last bits of single precision \[-\].
const SAME: f64 = 2.4e-7;
/// A triangle less high than this share of its longest side has no area \[-\].
const FLAT: f64 = 1e-7;

/// Why triangles enclose no body.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum ClosedSurfaceError {
    /// Fewer than four triangles.
    #[error("it has {0} triangles, and a body has four or more")]
    TooFew(usize),
    /// A coordinate that is no number.
    #[error("a corner of triangle {triangle} is not finite")]
    NotFinite {
        /// The triangle, from 1.
        triangle: usize,
    },
    /// A triangle without area.
    #[error(
        "{count} of its triangles have no area, the first with corners at {}, {} and {}",
        place(&corners[0]), place(&corners[1]), place(&corners[2])
    )]
    Flat {
        /// Corners of the first \[length\].
        corners: [[f64; 3]; 3],
        /// How many there are.
        count: usize,
    },
    /// An edge with a triangle on one side only.
    #[error(
        "it has a hole: {count} edges have a triangle on one side only, the first from {} to {}",
        place(&edge[0]), place(&edge[1])
    )]
    Open {
        /// Ends of the first \[length\].
        edge: [[f64; 3]; 2],
        /// How many there are.
        count: usize,
    },
    /// An edge that two triangles pass the same way.
    #[error(
        "{count} edges have triangles that face opposite ways, the first from {} to {}",
        place(&edge[0]), place(&edge[1])
    )]
    Twisted {
        /// Ends of the first \[length\].
        edge: [[f64; 3]; 2],
        /// How many there are.
        count: usize,
    },
    /// An edge with more than two triangles.
    #[error(
        "{count} edges have more than two triangles, the first from {} to {}",
        place(&edge[0]), place(&edge[1])
    )]
    Branched {
        /// Ends of the first \[length\].
        edge: [[f64; 3]; 2],
        /// How many there are.
        count: usize,
    },
    /// All triangles face into the body.
    #[error("its triangles face inwards: the enclosed volume is {volume} m³")]
    Inverted {
        /// The volume \[length³\].
        volume: f64,
    },
}

fn place([x, y, z]: &[f64; 3]) -> String {
    format!("({x}, {y}, {z}) m")
}

/// A closed surface of triangles that face out of a body; it may have several pieces, and hollows.
#[derive(Clone, Debug, PartialEq)]
pub struct ClosedSurface {
    pub(super) facets: Facets,
}

impl ClosedSurface {
    /// Of triangles by their corners, which turn counter-clockwise as seen from outside \[length\].
    ///
    /// Corners that differ in the last bits of single precision are one.
    ///
    /// # Errors
    /// [`ClosedSurfaceError`] for triangles that do not enclose a body, and where.
    pub fn new(triangles: &[[[f64; 3]; 3]]) -> Result<Self, ClosedSurfaceError> {
        let finite = |triangle: &[[f64; 3]; 3]| triangle.iter().flatten().all(|x| x.is_finite());
        if let Some(wrong) = triangles.iter().position(|triangle| !finite(triangle)) {
            return Err(ClosedSurfaceError::NotFinite {
                triangle: wrong + 1,
            });
        }
        if triangles.len() < 4 {
            return Err(ClosedSurfaceError::TooFew(triangles.len()));
        }
        let (points, faces) = welded(triangles);
        check_areas(&points, &faces)?;
        check_edges(&points, &faces)?;
        let surface = Self {
            facets: Facets::new(points, faces),
        };
        let volume = surface.volume();
        if volume > 0.0 {
            Ok(surface)
        } else {
            Err(ClosedSurfaceError::Inverted { volume })
        }
    }

    /// The enclosed volume \[length³\].
    pub fn volume(&self) -> f64 {
        let (lower, upper) = self.facets.bounds();
        let size: [f64; 3] = std::array::from_fn(|axis| upper[axis] - lower[axis]);
        let mut moments = Moments::default();
        self.facets.each_within(lower, [size[0], size[1]], |face| {
            moments.add_under(face, size[2], 1.0);
        });
        moments.volume
    }

    /// Its corners \[length\].
    pub fn points(&self) -> &[[f64; 3]] {
        &self.facets.points
    }

    /// The numbers of the corners of its triangles, anticlockwise as seen from outside.
    pub fn faces(&self) -> Vec<[usize; 3]> {
        let faces = self.facets.triangles.iter();
        faces
            .map(|face| face.map(|corner| corner as usize))
            .collect()
    }

    /// How many triangles it has.
    pub fn triangle_count(&self) -> usize {
        self.facets.triangles.len()
    }

    /// Its triangles, whose corners turn counter-clockwise as seen from outside \[length\].
    pub fn triangles(&self) -> impl Iterator<Item = [[f64; 3]; 3]> {
        (0..self.triangle_count()).map(|triangle| self.facets.corners_of(triangle))
    }

    /// Where the upright line at (x, y) passes its triangles: level, and 1 where it faces up, −1 where down.
    fn passed(&self, x: f64, y: f64) -> Vec<(f64, i32)> {
        let mut passed = Vec::new();
        self.facets.each([x, y], [x, y], |triangle| {
            let corners = self.facets.corners_of(triangle);
            let mut turns = 0;
            for k in 0..3 {
                let (p, q) = (corners[k], corners[(k + 1) % 3]);
                let (a, b) = if p[1] < q[1] { (p, q) } else { (q, p) };
                let crosses = (a[1] <= y) && (y < b[1]);
                if crosses && x < a[0] + (y - a[1]) / (b[1] - a[1]) * (b[0] - a[0]) {
                    turns += if p[1] < q[1] { 1 } else { -1 };
                }
            }
            if turns != 0 {
                passed.push((self.facets.plane_at(triangle, [x, y]), turns));
            }
        });
        passed
    }

    /// Its part above a rectangle in plan.
    fn standing(&self, lower: [f64; 3], upper: [f64; 3]) -> Standing {
        let size = [upper[0] - lower[0], upper[1] - lower[1]];
        Standing::new(lower, size, |call| {
            self.facets.each_within(lower, size, |face| call(face, 1.0));
        })
    }
}

/// The corners, each once, and the triangles by them.
fn welded(triangles: &[[[f64; 3]; 3]]) -> (Vec<[f64; 3]>, Vec<[u32; 3]>) {
    let all = triangles.iter().flatten().flatten();
    let reach = SAME * all.fold(0.0, |most: f64, x| most.max(x.abs()));
    let mut points: Vec<[f64; 3]> = Vec::new();
    let mut cells: HashMap<[i64; 3], Vec<u32>> = HashMap::new();
    let mut number = |point: [f64; 3]| {
        let cell = point.map(|x| (x / (2.0 * reach)).floor() as i64);
        for neighbour in 0..27 {
            let shift = [neighbour % 3, neighbour / 3 % 3, neighbour / 9].map(|shift| shift - 1);
            let beside = std::array::from_fn(|axis| cell[axis].saturating_add(shift[axis]));
            let near = |&&corner: &&u32| {
                let at = points[corner as usize];
                (0..3).all(|axis| (at[axis] - point[axis]).abs() <= reach)
            };
            if let Some(&corner) = cells.get(&beside).and_then(|list| list.iter().find(near)) {
                return corner;
            }
        }
        let corner = points.len() as u32;
        points.push(point);
        cells.entry(cell).or_default().push(corner);
        corner
    };
    let faces = triangles.iter().map(|triangle| triangle.map(&mut number));
    let faces = faces.collect();
    (points, faces)
}

fn check_areas(points: &[[f64; 3]], faces: &[[u32; 3]]) -> Result<(), ClosedSurfaceError> {
    let corners = |face: &[u32; 3]| face.map(|corner| points[corner as usize]);
    let is_flat = |face: &&[u32; 3]| {
        let [a, b, c] = corners(face);
        let side = |p: [f64; 3], q: [f64; 3]| -> [f64; 3] { std::array::from_fn(|k| q[k] - p[k]) };
        let length = |v: [f64; 3]| v[0].hypot(v[1]).hypot(v[2]);
        let (u, v) = (side(a, b), side(a, c));
        let normal = [
            u[1] * v[2] - u[2] * v[1],
            u[2] * v[0] - u[0] * v[2],
            u[0] * v[1] - u[1] * v[0],
        ];
        let longest = length(u).max(length(v)).max(length(side(b, c)));
        length(normal) <= FLAT * longest * longest
    };
    let mut flat = faces.iter().filter(is_flat);
    match flat.next() {
        None => Ok(()),
        Some(first) => Err(ClosedSurfaceError::Flat {
            corners: corners(first),
            count: 1 + flat.count(),
        }),
    }
}

/// Every edge is passed once each way.
fn check_edges(points: &[[f64; 3]], faces: &[[u32; 3]]) -> Result<(), ClosedSurfaceError> {
    // By edge: how often it is passed upwards and downwards in the numbers of its ends.
    let mut passed: BTreeMap<[u32; 2], [u32; 2]> = BTreeMap::new();
    for face in faces {
        for k in 0..3 {
            let (from, to) = (face[k], face[(k + 1) % 3]);
            let ways = passed.entry([from.min(to), from.max(to)]).or_default();
            ways[usize::from(from > to)] += 1;
        }
    }
    let wrong = |is_wrong: fn([u32; 2]) -> bool| {
        let mut wrong = passed.iter().filter(move |(_, ways)| is_wrong(**ways));
        let first = wrong.next().map(|(edge, _)| *edge);
        first.map(|edge| (edge.map(|end| points[end as usize]), 1 + wrong.count()))
    };
    if let Some((edge, count)) = wrong(|[up, down]| up + down == 1) {
        return Err(ClosedSurfaceError::Open { edge, count });
    }
    if let Some((edge, count)) = wrong(|[up, down]| up + down > 2) {
        return Err(ClosedSurfaceError::Branched { edge, count });
    }
    if let Some((edge, count)) = wrong(|[up, down]| up != down) {
        return Err(ClosedSurfaceError::Twisted { edge, count });
    }
    Ok(())
}

impl Region<3> for ClosedSurface {
    fn bounds(&self) -> ([f64; 3], [f64; 3]) {
        self.facets.bounds()
    }

    fn within(&self, lower: [f64; 3], upper: [f64; 3]) -> Part<3> {
        self.standing(lower, upper).within([lower[2], upper[2]])
    }

    fn cover(&self, lower: [f64; 3], upper: [f64; 3]) -> Cover {
        if self.facets.run_into(lower, upper) {
            Cover::Cut
        } else if self.encloses(Part::whole(lower, upper).centroid) {
            Cover::Whole
        } else {
            Cover::Nothing
        }
    }

    fn column(&self, lower: [f64; 3], upper: [f64; 3]) -> Option<Box<dyn Column<3>>> {
        Some(Box::new(self.standing(lower, upper)))
    }

    /// Counts the triangles above the point, those that face down negative.
    fn encloses(&self, point: [f64; 3]) -> bool {
        let above = self.passed(point[0], point[1]).into_iter();
        let above = above.filter(|(level, _)| *level > point[2]);
        above.map(|(_, turns)| turns).sum::<i32>() > 0
    }

    fn crossings(&self, place: &[f64; 3]) -> Vec<Crossing> {
        let passed = self.passed(place[0], place[1]).into_iter();
        passed
            .map(|(level, turns)| Crossing {
                level,
                sense: turns > 0,
            })
            .collect()
    }

    fn corners(&self) -> Vec<[f64; 3]> {
        self.facets.points.clone()
    }

    fn words(&self) -> String {
        format!("closed surface of {} triangles", self.triangle_count())
    }

    fn beyond(&self, lower: [f64; 3], upper: [f64; 3]) -> Option<[f64; 3]> {
        let points = self.facets.points.iter();
        let mut off = points.filter(|point| crate::region::is_off(point, &lower, &upper));
        off.next().copied()
    }
}
