//! Particles from polygons: every cell is cut into equal parts, and a part that the polygon's edge
//! crosses takes its clipped volume. The domains tile the cells, and the volume of the body is
//! exact.

use igimp_assembly::ParticleSeed;
use igimp_shape::Grid;

use crate::error::CaseError;
use crate::polygon::{area_and_centroid, bounding_box, clip_to_box};

/// Clipped parts smaller than this share of a whole part join the body's nearest particle \[-\].
const SLIVER: f64 = 0.1;

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
    let (first, last) = cells_around(grid, polygon);
    let columns = last[0] + 1 - first[0];
    for cell in 0..columns * (last[1] + 1 - first[1]) {
        let place = [first[0] + cell % columns, first[1] + cell / columns];
        let lower = grid.node_position(grid.node_index(place));
        let size = grid
            .cell_size(place)
            .map(|size| size / per_direction as f64);
        for part in 0..per_direction * per_direction {
            let step = [part % per_direction, part / per_direction];
            let from: [f64; 2] =
                std::array::from_fn(|axis| lower[axis] + step[axis] as f64 * size[axis]);
            let centre: [f64; 2] = std::array::from_fn(|axis| from[axis] + 0.5 * size[axis]);
            let to = std::array::from_fn(|axis| from[axis] + size[axis]);
            let (signed, centroid) = area_and_centroid(&clip_to_box(polygon, from, to));
            let (area, whole) = (signed.abs(), size[0] * size[1]);
            if area >= SLIVER * whole {
                seeds.push(ParticleSeed {
                    x: centre,
                    half_length: size.map(|size| 0.5 * size),
                    volume: area,
                    density,
                    law,
                });
            } else if area > 0.0 {
                slivers.push((area, centroid));
            }
        }
    }
    if seeds.is_empty() {
        return Err(CaseError::EmptyBody);
    }
    for (area, centroid) in slivers {
        let distance =
            |seed: &ParticleSeed<2>| (seed.x[0] - centroid[0]).hypot(seed.x[1] - centroid[1]);
        if let Some(nearest) = seeds
            .iter_mut()
            .min_by(|a, b| distance(a).total_cmp(&distance(b)))
        {
            nearest.volume += area;
        }
    }
    Ok(seeds)
}

/// The lowest and the highest cell that a polygon on the grid reaches into.
fn cells_around(grid: &Grid<2>, polygon: &[[f64; 2]]) -> ([usize; 2], [usize; 2]) {
    let (lower, upper) = bounding_box(polygon);
    let last = [0, 1].map(|axis| grid.axes[axis].cell_count() - 1);
    (
        grid.cell_at(&lower).unwrap_or([0; 2]),
        grid.cell_at(&upper).unwrap_or(last),
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use igimp_shape::Axis;

    fn grid() -> Grid<2> {
        Grid::new([
            Axis::uniform(0.0, 1.0, 12).unwrap(),
            Axis::uniform(0.0, 0.5, 10).unwrap(),
        ])
    }

    #[test]
    fn volume_of_a_slope_is_exact() {
        let polygon = [[0.0, 0.0], [11.3, 0.0], [9.7, 1.1], [4.2, 4.6], [0.0, 4.6]];
        let (area, centroid) = area_and_centroid(&polygon);
        let seeds = fill_polygon(&grid(), &polygon, 3, 1.0, 0).unwrap();
        let volume: f64 = seeds.iter().map(|seed| seed.volume).sum();
        assert!((volume - area).abs() < 1e-12 * area);
        for axis in 0..2 {
            let moment: f64 = seeds.iter().map(|seed| seed.volume * seed.x[axis]).sum();
            assert!((moment / volume - centroid[axis]).abs() < 5e-3);
        }
    }

    #[test]
    fn whole_parts_tile_the_cells() {
        let seeds = fill_polygon(
            &grid(),
            &[[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]],
            2,
            1.0,
            0,
        )
        .unwrap();
        assert_eq!(seeds.len(), 16);
        for axis in 0..2 {
            let quarter = [0.25, 0.125][axis];
            assert!((seeds[0].x[axis] - quarter).abs() < 1e-15);
            assert!((seeds[0].half_length[axis] - quarter).abs() < 1e-15);
        }
    }

    #[test]
    fn a_polygon_off_the_grid_or_without_area_is_refused() {
        let outside = fill_polygon(&grid(), &[[0.0, 0.0], [13.0, 0.0], [0.0, 1.0]], 2, 1.0, 0);
        assert!(matches!(
            outside,
            Err(CaseError::OutsideGrid {
                corner: [13.0, 0.0]
            })
        ));
        let flat = fill_polygon(&grid(), &[[0.0, 0.0], [2.0, 0.0], [1.0, 0.0]], 2, 1.0, 0);
        assert!(matches!(flat, Err(CaseError::EmptyBody)));
    }
}
