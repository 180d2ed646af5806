//! Surfaces in space: closed ones of triangles, and those of the ground.

use std::fmt::{self, Display, Formatter};
use std::sync::Arc;

use igimp_geometry::solid::{
    ClosedSurface, ClosedSurfaceError, Height, Layer, LayerError, Prism, Solid, Terrain as Ground,
    TerrainError,
};
use igimp_schema::diagnostic::Problems;
use igimp_schema::schema::solids::{Surface, Terrain};
use igimp_schema::source::Place;
use igimp_schema::text::number;
use igimp_schema::tree::read::{At, Either, Found};

use crate::build::bodies::{Polygon, corners};

/// The closed surface of a table.
pub(crate) fn closed_surface(
    table: &At<Surface>,
    label: &dyn Display,
    problems: &mut Problems,
) -> Option<Arc<ClosedSurface>> {
    let (Some(vertices), Some(triangles)) = (&table.vertices, &table.triangles) else {
        problems
            .error(table.place, format!("the surface of {label} is not stated"))
            .help("write surface = { file = \"block.stl\", unit = \"m\" }, or its vertices and triangles");
        return None;
    };
    let mut faces = Vec::with_capacity(triangles.len());
    for triangle in triangles.iter() {
        if let Some(wrong) = triangle.iter().find(|number| **number >= vertices.len()) {
            problems
                .error(triangle.place, format!("there is no vertex {wrong}"))
                .help(format!(
                    "vertices are numbered from 0 to {}",
                    vertices.len() - 1
                ));
            return None;
        }
        faces.push(triangle.map(|number| *vertices[number]));
    }
    match ClosedSurface::new(&faces) {
        Ok(surface) => Some(Arc::new(surface)),
        Err(error) => {
            let help = match error {
                ClosedSurfaceError::Open { .. } => {
                    "close it in the program that made it; a body has a triangle on both sides of every edge"
                }
                ClosedSurfaceError::Twisted { .. } | ClosedSurfaceError::Inverted { .. } => {
                    "turn the triangles so that all face outwards: in most programs, recalculate normals"
                }
                ClosedSurfaceError::Branched { .. } => {
                    "parts that touch along an edge, or inner walls, are to be joined or parted"
                }
                ClosedSurfaceError::Flat { .. } => "merge double vertices, and export it once more",
                ClosedSurfaceError::TooFew(_) | ClosedSurfaceError::NotFinite { .. } => {
                    "export it once more"
                }
            };
            let message = format!("the surface of {label} encloses no body: {error}");
            problems.error(table.place, message).help(help);
            None
        }
    }
}

/// A polygon in plan between two heights.
pub(crate) fn ground(
    plan: &At<Polygon>,
    between: &At<[Found<Either<f64, Terrain>>; 2]>,
    label: &Label<'_>,
    problems: &mut Problems,
) -> Option<Solid> {
    let polygon = corners(plan, label.name, problems);
    let [bottom, top] = (between.each_ref()).map(|end| height(end.as_ref().ok()?, label, problems));
    let (bottom, top) = (bottom?, top?);
    let polygon = polygon?;
    if let (Height::Level(from), Height::Level(to)) = (&bottom, &top) {
        let (from, to) = (*from, *to);
        if from >= to {
            problems
                .error(
                    between.place,
                    format!(
                        "{label} reaches from {} m up to {} m",
                        number(from),
                        number(to)
                    ),
                )
                .help("the first is the bottom");
            return None;
        }
        return Some(Solid::Prism(Prism::new(polygon, 2, [from, to])));
    }
    match Layer::new(&polygon, bottom, top) {
        Ok(layer) => Some(Solid::Layer(Arc::new(layer))),
        Err(error) => {
            let help = match error {
                LayerError::NotCovered { .. } => {
                    "make the plan smaller, or take a survey that reaches further and has no holes there"
                }
                LayerError::Crossing { .. } => {
                    "surfaces may touch, where a layer ends, and not cross: raise the top or lower the bottom there"
                }
                LayerError::Empty => "the top is above the bottom",
                LayerError::NoArea => "its corners lie on one line",
            };
            problems
                .error(between.place, format!("{label} cannot be made: {error}"))
                .help(help);
            None
        }
    }
}

fn height(
    stated: &At<Either<f64, Terrain>>,
    label: &dyn Display,
    problems: &mut Problems,
) -> Option<Height> {
    match &**stated {
        Either::First(level) => Some(Height::Level(*level)),
        Either::Second(table) => terrain(table, stated.place, label, problems).map(Height::Terrain),
    }
}

/// A surface of the ground, or of water in it, that is stated at a place.
pub(crate) fn terrain(
    table: &Terrain,
    place: Place,
    label: &dyn Display,
    problems: &mut Problems,
) -> Option<Arc<Ground>> {
    let mut refuse = |error: &dyn Display, help: &str| {
        let message = format!("a surface of {label} cannot be used: {error}");
        problems.error(place, message).help(help);
    };
    let terrain = match (&table.points, &table.x, &table.y, &table.rows) {
        (Some(points), None, None, None) => {
            let Either::Second(points) = &**points else {
                return None;
            };
            let points: Vec<[f64; 3]> = points.iter().map(|point| **point).collect();
            Ground::through(&points)
        }
        (None, Some(x), Some(y), Some(rows)) => {
            let (x, y) = (plain(x), plain(y));
            let rows: Vec<Vec<f64>> = rows.iter().map(|row| plain(row)).collect();
            let rises = |lines: &[f64]| lines.windows(2).all(|pair| pair[0] < pair[1]);
            if rows.len() != y.len()
                || rows.iter().any(|row| row.len() != x.len())
                || !(rises(&x) && rises(&y))
            {
                let wrong = format!("{} x and {} y do not go with its rows", x.len(), y.len());
                refuse(
                    &wrong,
                    "x and y ascend; there is a row for every y, with a height for every x",
                );
                return None;
            }
            let mut rows: Vec<Vec<Option<f64>>> = rows
                .into_iter()
                .map(|row| row.into_iter().map(Some).collect())
                .collect();
            // A table from a file of points has no such key.
            let holes = table.holes.iter().flat_map(|holes| holes.iter());
            for hole in holes {
                let [i, j] = **hole;
                let Some(height) = rows.get_mut(j).and_then(|row| row.get_mut(i)) else {
                    let wrong = format!("it has no column {i} and row {j}");
                    refuse(&wrong, "they are counted from 0");
                    return None;
                };
                *height = None;
            }
            Ground::on_lines(&x, &y, &rows)
        }
        _ => {
            refuse(
                &"it is not stated",
                "write { raster = \"ground.asc\", unit = \"m\" }, { points = \"ground.csv\", unit = \"m\" }, or x, y and rows",
            );
            return None;
        }
    };
    match terrain {
        Ok(terrain) => Some(Arc::new(terrain)),
        Err(error) => {
            let help = match error {
                TerrainError::TwoHeights { .. } => "keep one of them",
                TerrainError::Flat => "three points or more that do not lie on one line in plan",
                TerrainError::Number(_) => "every coordinate is a number of a usual size",
            };
            refuse(&error, help);
            None
        }
    }
}

/// The numbers of a list.
pub(crate) fn plain(list: &[At<f64>]) -> Vec<f64> {
    list.iter().map(|value| **value).collect()
}

/// The printed name of a shape.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Label<'a> {
    /// Name of the body.
    pub name: &'a str,
    /// The number of what is taken out of it, from 1.
    pub(crate) taken: Option<usize>,
}

impl Display for Label<'_> {
    fn fmt(&self, to: &mut Formatter<'_>) -> fmt::Result {
        match self.taken {
            None => write!(to, "body `{}`", self.name),
            Some(number) => write!(to, "no. {number} of `minus` of body `{}`", self.name),
        }
    }
}
