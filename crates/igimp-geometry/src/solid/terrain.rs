//! Surfaces of the ground from surveys: heights at points, and flat triangles between them.

use std::sync::Arc;

use spade::{DelaunayTriangulation, HasPosition, Point2, Triangulation};
use thiserror::Error;

use super::facets::Facets;

/// Why points make no surface.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum TerrainError {
    /// A number that is not finite, or too large or small to be worked with.
    #[error("the point ({}, {}, {}) m cannot be used", .0[0], .0[1], .0[2])]
    Number([f64; 3]),
    /// Two heights at one place.
    #[error("({}, {}) m has two heights, {} m and {} m", at[0], at[1], heights[0], heights[1])]
    TwoHeights {
        /// The place \[length\].
        at: [f64; 2],
        /// The heights \[length\].
        heights: [f64; 2],
    },
    /// Fewer than three points, or points on one line.
    #[error("its points span no triangle")]
    Flat,
}

/// A surface of the ground: flat triangles between points of known height.
#[derive(Clone, Debug, PartialEq)]
pub struct Terrain {
    pub(super) facets: Facets,
}

/// The top or the bottom of a layer.
#[derive(Clone, Debug, PartialEq)]
pub enum Height {
    /// Everywhere this level \[length\].
    Level(f64),
    /// A surface.
    Terrain(Arc<Terrain>),
}

/// A point of a survey.
#[derive(Clone, Copy, Debug)]
struct Surveyed {
    at: Point2<f64>,
    number: u32,
}

impl HasPosition for Surveyed {
    type Scalar = f64;

    fn position(&self) -> Point2<f64> {
        self.at
    }
}

impl Terrain {
    /// Heights at the crossings of lines: x and y ascend, rows by y, then x; where there is none, the surface has a
    /// hole \[length\].
    ///
    /// A square of four points is cut along the diagonal whose ends differ less in height, and a corner
    /// without height leaves one triangle.
    ///
    /// # Errors
    /// [`TerrainError`] for fewer heights than make a triangle, and numbers that are not finite.
    pub fn on_lines(x: &[f64], y: &[f64], rows: &[Vec<Option<f64>>]) -> Result<Self, TerrainError> {
        let mut points = Vec::new();
        let mut numbers = Vec::new();
        for (&y, row) in std::iter::zip(y, rows) {
            let entries = std::iter::zip(x, row).map(|(&x, height)| {
                let number = points.len() as u32;
                height.map(|height| {
                    points.push([x, y, height]);
                    number
                })
            });
            numbers.push(entries.collect::<Vec<_>>());
        }
        check(&points)?;
        let mut triangles = Vec::new();
        for pair in numbers.windows(2) {
            for (low, high) in std::iter::zip(pair[0].windows(2), pair[1].windows(2)) {
                let apart = |a: u32, b: u32| (points[a as usize][2] - points[b as usize][2]).abs();
                match (low[0], low[1], high[1], high[0]) {
                    (Some(a), Some(b), Some(c), Some(d)) if apart(a, c) <= apart(b, d) => {
                        triangles.extend([[a, b, c], [a, c, d]]);
                    }
                    (Some(a), Some(b), Some(c), Some(d)) => {
                        triangles.extend([[a, b, d], [b, c, d]]);
                    }
                    corners => {
                        let all = [corners.0, corners.1, corners.2, corners.3];
                        let there: Vec<u32> = all.into_iter().flatten().collect();
                        triangles.extend(<[u32; 3]>::try_from(there).ok());
                    }
                }
            }
        }
        Self::of(points, triangles)
    }

    /// Scattered points in any order, joined by Delaunay's triangles in plan \[length\].
    ///
    /// # Errors
    /// [`TerrainError`] for points that span no triangle, two heights at one place, and numbers that are not finite.
    pub fn scattered(points: &[[f64; 3]]) -> Result<Self, TerrainError> {
        check(points)?;
        let surveyed = std::iter::zip(points, 0..).map(|([x, y, _], number)| Surveyed {
            at: Point2::new(*x, *y),
            number,
        });
        let unusable = || TerrainError::Number(points.first().copied().unwrap_or_default());
        let delaunay = DelaunayTriangulation::<Surveyed>::bulk_load(surveyed.collect())
            .map_err(|_| unusable())?;
        if delaunay.num_vertices() < points.len() {
            check_places(points)?;
        }
        let faces = delaunay.inner_faces();
        let triangles = faces.map(|face| face.vertices().map(|vertex| vertex.data().number));
        let mut triangles: Vec<[u32; 3]> = triangles.collect();
        triangles.sort_unstable();
        Self::of(points.to_vec(), triangles)
    }

    /// Points in any order: on lines if every x goes with every y, else scattered \[length\].
    ///
    /// # Errors
    /// As [`Terrain::scattered`].
    pub fn through(points: &[[f64; 3]]) -> Result<Self, TerrainError> {
        check(points)?;
        let lines = [0, 1].map(|axis| {
            let mut lines: Vec<f64> = points.iter().map(|point| point[axis]).collect();
            lines.sort_by(f64::total_cmp);
            lines.dedup_by(|a, b| a.total_cmp(b).is_eq());
            lines
        });
        let [x, y] = &lines;
        if x.len() < 2 || y.len() < 2 || x.len() * y.len() != points.len() {
            return Self::scattered(points);
        }
        let mut rows = vec![vec![None; x.len()]; y.len()];
        for point in points {
            let place = |axis: usize| lines[axis].partition_point(|line| *line < point[axis]);
            rows[place(1)][place(0)] = Some(point[2]);
        }
        if rows.iter().flatten().all(Option::is_some) {
            Self::on_lines(x, y, &rows)
        } else {
            Self::scattered(points)
        }
    }

    fn of(points: Vec<[f64; 3]>, triangles: Vec<[u32; 3]>) -> Result<Self, TerrainError> {
        if triangles.is_empty() {
            return Err(TerrainError::Flat);
        }
        let facets = Facets::new(points, triangles);
        Ok(Self { facets })
    }

    /// The height over a place in plan, if the surface reaches there \[length\].
    pub fn height_at(&self, at: [f64; 2]) -> Option<f64> {
        self.facets.height_at(at)
    }

    /// Lower and upper corner of the box around it \[length\].
    pub fn bounds(&self) -> ([f64; 3], [f64; 3]) {
        self.facets.bounds()
    }
}

fn check(points: &[[f64; 3]]) -> Result<(), TerrainError> {
    // Spade's own limits are far beyond these.
    let is_usable = |x: &f64| x.is_finite() && x.abs() < 1e15;
    let wrong = points.iter().find(|point| !point.iter().all(is_usable));
    wrong.map_or(Ok(()), |point| Err(TerrainError::Number(*point)))
}

/// No two heights at one place; the same point twice is one.
fn check_places(points: &[[f64; 3]]) -> Result<(), TerrainError> {
    let mut sorted = points.to_vec();
    sorted.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    for pair in sorted.windows(2) {
        let [a, b] = [pair[0], pair[1]];
        if a[..2] == b[..2] && (a[2] < b[2] || b[2] < a[2]) {
            return Err(TerrainError::TwoHeights {
                at: [a[0], a[1]],
                heights: [a[2], b[2]],
            });
        }
    }
    Ok(())
}

impl Height {
    /// The height over a place in plan \[length\].
    pub fn at(&self, at: [f64; 2]) -> Option<f64> {
        match self {
            Self::Level(level) => Some(*level),
            Self::Terrain(terrain) => terrain.height_at(at),
        }
    }
}
