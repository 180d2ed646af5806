//! Particles from polygons: every cell is cut into equal parts, and a part that the polygon's edge
//! crosses takes its clipped volume. The domains tile the cells, and the volume of the body is
//! exact.

use igimp_assembly::ParticleSeed;
use igimp_shape::Grid;

use crate::case::Region;
use crate::error::CaseError;
use crate::polygon::{Polygon, area_and_centroid, bounding_box, clip_to_box};

/// Clipped parts smaller than this share of a whole part join the body's nearest particle \[-\].
const SLIVER: f64 = 0.1;

/// A corner may lie off the grid by so much of the grid: lines are multiples of a rounded cell \[-\].
const ROUND_OFF: f64 = 1e-9;

/// The part of a polygon within a part of a cell.
#[derive(Clone, Debug)]
pub(crate) struct Piece {
    /// Place of its particle among those of the body.
    pub(crate) particle: usize,
    /// Its corners.
    pub(crate) polygon: Polygon,
}

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
    let (seeds, _) = fill_in_pieces(grid, polygon, per_direction, density, law)?;
    Ok(seeds)
}

/// Fills a region with `per_direction`^D particles per grid cell.
///
/// # Errors
/// [`CaseError::OutsideGrid`] when the region reaches off the grid, and [`CaseError::EmptyBody`] when nothing of it is on
/// the grid.
pub fn fill<const D: usize>(
    grid: &Grid<D>,
    region: &dyn Region<D>,
    per_direction: usize,
    density: f64,
    law: usize,
) -> Result<Vec<ParticleSeed<D>>, CaseError> {
    let _ = (grid, region, per_direction, density, law);
    Err(CaseError::EmptyBody)
}

/// The same, with the pieces of the polygon: one for each particle in their order, then the slivers,
/// each with the particle that it joined. Together they are the polygon.
pub(crate) fn fill_in_pieces(
    grid: &Grid<2>,
    polygon: &[[f64; 2]],
    per_direction: usize,
    density: f64,
    law: usize,
) -> Result<(Vec<ParticleSeed<2>>, Vec<Piece>), CaseError> {
    let is_off = |corner: &&[f64; 2]| {
        std::iter::zip(&grid.axes, *corner).any(|(axis, &x)| {
            let slack = ROUND_OFF * (axis.end() - axis.start());
            x.is_nan() || x < axis.start() - slack || x > axis.end() + slack
        })
    };
    if let Some(&corner) = polygon.iter().find(is_off) {
        return Err(CaseError::OutsideGrid {
            corner: corner.to_vec(),
        });
    }
    let mut seeds: Vec<ParticleSeed<2>> = Vec::new();
    let mut pieces = Vec::new();
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
            let clipped = clip_to_box(polygon, from, to);
            let (signed, centroid) = area_and_centroid(&clipped);
            let (area, whole) = (signed.abs(), size[0] * size[1]);
            if area >= SLIVER * whole {
                pieces.push(Piece {
                    particle: seeds.len(),
                    polygon: clipped,
                });
                seeds.push(ParticleSeed {
                    x: centre,
                    half_length: size.map(|size| 0.5 * size),
                    volume: area,
                    density,
                    law,
                });
            } else if area > 0.0 {
                slivers.push((area, centroid, clipped));
            }
        }
    }
    if seeds.is_empty() {
        return Err(CaseError::EmptyBody);
    }
    for (area, centroid, polygon) in slivers {
        let distance =
            |seed: &ParticleSeed<2>| (seed.x[0] - centroid[0]).hypot(seed.x[1] - centroid[1]);
        let nearest =
            (0..seeds.len()).min_by(|&a, &b| distance(&seeds[a]).total_cmp(&distance(&seeds[b])));
        if let Some(particle) = nearest {
            seeds[particle].volume += area;
            pieces.push(Piece { particle, polygon });
        }
    }
    Ok((seeds, pieces))
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
    fn pieces_make_up_the_polygon() {
        let polygon = [[0.0, 0.0], [11.3, 0.0], [9.7, 1.1], [4.2, 4.6], [0.0, 4.6]];
        let (whole, _) = area_and_centroid(&polygon);
        let (seeds, pieces) = fill_in_pieces(&grid(), &polygon, 2, 1.0, 0).unwrap();
        let area: f64 = pieces
            .iter()
            .map(|piece| area_and_centroid(&piece.polygon).0)
            .sum();
        assert!((area - whole).abs() < 1e-12 * whole);
        let own = |particle: usize| {
            let own = pieces
                .iter()
                .filter(move |piece| piece.particle == particle);
            own.map(|piece| area_and_centroid(&piece.polygon).0)
                .sum::<f64>()
        };
        for (particle, seed) in seeds.iter().enumerate() {
            assert!((own(particle) - seed.volume).abs() < 1e-12, "{particle}");
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

    /// 68 cells of the number nearest to 2/27 end before the number nearest to 136/27.
    #[test]
    fn the_end_of_the_domain_may_be_rounded() {
        let axis = || Axis::uniform(0.0, 2.0 / 27.0, 68).unwrap();
        let (grid, end) = (Grid::new([axis(), axis()]), 136.0 / 27.0);
        assert!(axis().end() < end);
        let block = [[0.0, 0.0], [end, 0.0], [end, end], [0.0, end]];
        let seeds = fill_polygon(&grid, &block, 2, 1.0, 0).unwrap();
        let volume: f64 = seeds.iter().map(|seed| seed.volume).sum();
        assert_eq!(seeds.len(), 4 * 68 * 68);
        assert!((volume - end * end).abs() < 1e-12 * volume, "{volume}");
    }

    #[test]
    fn a_polygon_off_the_grid_or_without_area_is_refused() {
        let outside = fill_polygon(&grid(), &[[0.0, 0.0], [13.0, 0.0], [0.0, 1.0]], 2, 1.0, 0);
        assert!(matches!(
            outside,
            Err(CaseError::OutsideGrid { corner }) if corner == [13.0, 0.0]
        ));
        let flat = fill_polygon(&grid(), &[[0.0, 0.0], [2.0, 0.0], [1.0, 0.0]], 2, 1.0, 0);
        assert!(matches!(flat, Err(CaseError::EmptyBody)));
    }
}
