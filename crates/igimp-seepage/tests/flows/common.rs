//! Ground and conditions that several tests share.

use igimp_geometry::region::Region;
use igimp_seepage::{
    Conditions, Extent, Named, OnFaces, Seepage, SeepageBody, SeepageError, Soil, solve,
};
use igimp_shape::{Axis, Grid};

/// A grid of square cells from a corner on.
pub(crate) fn grid(from: [f64; 2], cell: f64, cells: [usize; 2]) -> Grid<2> {
    let axis = |k: usize| Axis::uniform(from[k], cell, cells[k]).unwrap();
    Grid::new([axis(0), axis(1)])
}

/// A box of faces under a name.
pub(crate) fn faces(
    name: &str,
    lower: [f64; 2],
    upper: [f64; 2],
    condition: OnFaces,
) -> Named<2, OnFaces> {
    Named {
        name: name.to_owned(),
        within: Extent { lower, upper },
        condition,
    }
}

/// The corners of a rectangle.
pub(crate) fn rectangle([x0, y0]: [f64; 2], [x1, y1]: [f64; 2]) -> Vec<[f64; 2]> {
    vec![[x0, y0], [x1, y0], [x1, y1], [x0, y1]]
}

/// Solves for polygons with a soil each, in their order, without free water.
pub(crate) fn flow(
    grid: &Grid<2>,
    polygons: &[Vec<[f64; 2]>],
    conditions: &Conditions<2>,
) -> Result<Seepage<2>, SeepageError> {
    flow_below(grid, polygons, conditions, None)
}

/// The same below free water at a level, if there is any.
pub(crate) fn flow_below(
    grid: &Grid<2>,
    polygons: &[Vec<[f64; 2]>],
    conditions: &Conditions<2>,
    level: Option<f64>,
) -> Result<Seepage<2>, SeepageError> {
    let bodies: Vec<SeepageBody<'_, 2>> = (polygons.iter().enumerate())
        .map(|(soil, region)| SeepageBody {
            region: region as &dyn Region<2>,
            soil,
            scale: None,
        })
        .collect();
    solve(grid, &bodies, conditions, &|_| level)
}

/// A dam with vertical faces at x = 0 and `length` on an impervious base, water at `high` and `low`, the grid laid so that
/// its lines lie `shift` cells to the left of the faces.
pub(crate) fn dam(length: f64, high: f64, low: f64, cell: f64, shift: f64) -> Seepage<2> {
    let count = |size: f64| (size / cell).round() as usize;
    let extra = usize::from(shift > 0.0);
    let grid = grid(
        [-shift * cell, 0.0],
        cell,
        [count(length) + extra, count(high)],
    );
    let mut conditions = Conditions::of(vec![Soil::isotropic(1.0)]);
    conditions.faces = vec![
        faces("upstream", [0.0, 0.0], [0.0, high], OnFaces::Head(high)),
        faces("face", [length, 0.0], [length, high], OnFaces::Open),
    ];
    if low > 0.0 {
        conditions.faces.push(faces(
            "downstream",
            [length, 0.0],
            [length, low],
            OnFaces::Head(low),
        ));
    }
    flow(&grid, &[rectangle([0.0, 0.0], [length, high])], &conditions).unwrap()
}
