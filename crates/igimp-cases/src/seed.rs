//! Particles from polygons: every cell is cut into equal parts, and a part that the polygon's edge
//! crosses becomes a box of the clipped area around the clipped centroid. Volume and first moment
//! of the body are exact, and a sloping surface is no staircase.

use igimp_assembly::ParticleSeed;
use igimp_shape::Grid;

use crate::error::CaseError;
use crate::polygon::{area_and_centroid, bounding_box, clip_to_box};

/// Clipped parts smaller than this share of a whole part join the body's nearest particle \[-\].
const SLIVER: f64 = 0.02;

/// Fills a polygon with `per_direction`² particles per grid cell.
///
/// # Errors
/// [`CaseError::OutsideGrid`] when a corner of the polygon lies off the grid, and
/// [`CaseError::EmptyBody`] when the polygon has no area.
pub fn fill_polygon(
    grid: &Grid<2>,
    polygon: &[[f64; 2]],
    per_direction: usize,
    density: f64,
    law: usize,
) -> Result<Vec<ParticleSeed<2>>, CaseError> {
    if let Some(&corner) = polygon.iter().find(|corner| !grid.contains(corner)) {
        return Err(CaseError::OutsideGrid { corner });
    }
    let mut seeds: Vec<ParticleSeed<2>> = Vec::new();
    let mut slivers = Vec::new();
    for cell in 0..grid.cell_count() {
        let place = grid.cell_place(cell);
        let lower = grid.node_position(grid.node_index(place));
        let size = grid.cell_size(place).map(|size| size / per_direction as f64);
        for part in 0..per_direction * per_direction {
            let step = [part % per_direction, part / per_direction];
            let from: [f64; 2] =
                std::array::from_fn(|axis| lower[axis] + step[axis] as f64 * size[axis]);
            let to: [f64; 2] = std::array::from_fn(|axis| from[axis] + size[axis]);
            let clipped = clip_to_box(polygon, from, to);
            let (signed, centroid) = area_and_centroid(&clipped);
            let (area, whole) = (signed.abs(), size[0] * size[1]);
            if area < SLIVER * whole {
                slivers.push((area, centroid));
            } else if area > (1.0 - 1e-9) * whole {
                let centre = std::array::from_fn(|axis| 0.5 * (from[axis] + to[axis]));
                seeds.push(seed(centre, size.map(|size| 0.5 * size), whole, density, law));
            } else {
                let (low, high) = bounding_box(&clipped);
                let extent: [f64; 2] = std::array::from_fn(|axis| high[axis] - low[axis]);
                let shrink = (area / (extent[0] * extent[1])).sqrt();
                let half_length = extent.map(|extent| 0.5 * shrink * extent);
                seeds.push(seed(centroid, half_length, area, density, law));
            }
        }
    }
    if seeds.is_empty() {
        return Err(CaseError::EmptyBody);
    }
    for (area, centroid) in slivers.into_iter().filter(|(area, _)| *area > 0.0) {
        let distance = |seed: &ParticleSeed<2>| {
            (seed.x[0] - centroid[0]).hypot(seed.x[1] - centroid[1])
        };
        if let Some(nearest) =
            seeds.iter_mut().min_by(|a, b| distance(a).total_cmp(&distance(b)))
        {
            nearest.volume += area;
        }
    }
    Ok(seeds)
}

fn seed(
    x: [f64; 2],
    half_length: [f64; 2],
    volume: f64,
    density: f64,
    law: usize,
) -> ParticleSeed<2> {
    ParticleSeed { x, half_length, volume, density, law }
}

#[cfg(test)]
mod tests {
    use super::*;
    use igimp_shape::Axis;

    fn grid() -> Grid<2> {
        Grid::new([Axis::uniform(0.0, 1.0, 12).unwrap(), Axis::uniform(0.0, 0.5, 10).unwrap()])
    }

    #[test]
    fn volume_and_first_moment_of_a_slope_are_exact() {
        let polygon = [[0.0, 0.0], [11.3, 0.0], [9.7, 1.1], [4.2, 4.6], [0.0, 4.6]];
        let (area, centroid) = area_and_centroid(&polygon);
        let seeds = fill_polygon(&grid(), &polygon, 3, 1.0, 0).unwrap();
        let volume: f64 = seeds.iter().map(|seed| seed.volume).sum();
        assert!((volume - area).abs() < 1e-12 * area);
        for axis in 0..2 {
            let moment: f64 = seeds.iter().map(|seed| seed.volume * seed.x[axis]).sum();
            assert!((moment / volume - centroid[axis]).abs() < 1e-3);
        }
    }

    #[test]
    fn whole_parts_tile_the_cells() {
        let seeds =
            fill_polygon(&grid(), &[[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]], 2, 1.0, 0)
                .unwrap();
        assert_eq!(seeds.len(), 16);
        assert_eq!(seeds[0].x, [0.25, 0.125]);
        assert_eq!(seeds[0].half_length, [0.25, 0.125]);
    }

    #[test]
    fn a_polygon_off_the_grid_or_without_area_is_refused() {
        let outside = fill_polygon(&grid(), &[[0.0, 0.0], [13.0, 0.0], [0.0, 1.0]], 2, 1.0, 0);
        assert!(matches!(outside, Err(CaseError::OutsideGrid { corner: [13.0, 0.0] })));
        let flat = fill_polygon(&grid(), &[[0.0, 0.0], [2.0, 0.0], [1.0, 0.0]], 2, 1.0, 0);
        assert!(matches!(flat, Err(CaseError::EmptyBody)));
    }
}
