//! Particles from regions: every cell is cut into equal parts, and a part that the region's boundary
//! crosses takes its clipped volume. The domains tile the cells, and the volume of the body is
//! exact.

mod nearest;

use std::ops::Range;

use igimp_assembly::ParticleSeed;
use igimp_shape::Grid;

use crate::error::SeedError;
use crate::polygon::{Polygon, area_and_centroid, clip_to_strip};
use crate::region::{Cover, Part, Region};
use nearest::Nearest;

/// Clipped parts smaller than this share of a whole part join the nearest particle of their cell, or else of the body \[-\].
const SLIVER: f64 = 0.1;

/// The centroid of the soil of a particle lies no further out in its domain: soil that joined it may lie beyond \[-\].
const OUTERMOST: f64 = 0.95;

/// Soil whose volume differs from that of a box by less than so much of its part is that box \[-\].
const BOX: f64 = 1e-9;

/// Volumes and distances whose ratio is so near to 1 are equal: round-off does not say which part counts, nor which particle takes
/// its soil \[-\].
const TIE: f64 = 1e-9;

/// A region may reach off the grid by so much of the grid: lines are multiples of a rounded cell \[-\].
const ROUND_OFF: f64 = 1e-9;

/// The part of a polygon within a part of a cell.
#[derive(Clone, Debug)]
pub struct Piece {
    /// Place of its particle among those of the body.
    pub particle: usize,
    /// Its corners.
    pub polygon: Polygon,
}

/// Fills a region with `per_direction`^D particles per grid cell.
///
/// # Errors
/// [`SeedError::OutsideGrid`] when the region reaches off the grid, and [`SeedError::EmptyBody`] when
/// it has no volume.
pub fn fill<const D: usize>(
    grid: &Grid<D>,
    region: &(impl Region<D> + ?Sized),
    per_direction: usize,
    density: f64,
    law: usize,
) -> Result<Vec<ParticleSeed<D>>, SeedError> {
    let parts = Parts::around(grid, region, per_direction)?;
    if let Some(found) = parts.by_columns(region) {
        let cover = |cell: usize, _, _| found[cell].0;
        let within = |cell: usize, part: usize, _, _| (found[cell].1[part], ());
        let (seeds, _) = parts.filled(density, law, cover, within)?;
        return Ok(seeds);
    }
    // Most of the work of cutting a polygon is done once for every column of parts.
    let strips = parts.columns(|[from, to]| region.strip(from, to));
    let along_first = parts.cells[0].len();
    let within = |cell: usize, part: usize, from, to| {
        let strip = cell % along_first * per_direction + part % per_direction;
        let part = match &strips[strip] {
            Some(strip) => strip.within(from, to),
            None => region.within(from, to),
        };
        (part, ())
    };
    let cover = |_, from, to| region.cover(from, to);
    let (seeds, _) = parts.filled(density, law, cover, within)?;
    Ok(seeds)
}

/// Fills a polygon with `per_direction`² particles per grid cell.
///
/// # Errors
/// [`SeedError::OutsideGrid`] when a corner of the polygon lies off the grid, and
/// [`SeedError::EmptyBody`] when the polygon has no area.
pub fn fill_polygon(
    grid: &Grid<2>,
    polygon: &[[f64; 2]],
    per_direction: usize,
    density: f64,
    law: usize,
) -> Result<Vec<ParticleSeed<2>>, SeedError> {
    fill(grid, polygon, per_direction, density, law)
}

/// The same, with the pieces of the polygon: one for each particle in their order, then the slivers,
/// each with the particle that it joined. Together they are the polygon.
///
/// # Errors
/// As [`fill_polygon`].
pub fn fill_in_pieces(
    grid: &Grid<2>,
    polygon: &[[f64; 2]],
    per_direction: usize,
    density: f64,
    law: usize,
) -> Result<(Vec<ParticleSeed<2>>, Vec<Piece>), SeedError> {
    let parts = Parts::around(grid, polygon, per_direction)?;
    let columns = parts.columns(|[from, to]| clip_to_strip(polygon, 0, from, to));
    let along_first = parts.cells[0].len();
    let within = |cell: usize, number: usize, from: [f64; 2], to: [f64; 2]| {
        let column = cell % along_first * per_direction + number % per_direction;
        let clipped = clip_to_strip(&columns[column], 1, from[1], to[1]);
        (part(&clipped), clipped)
    };
    let (seeds, pieces) = parts.filled(density, law, |_, _, _| Cover::Cut, within)?;
    let piece = |(particle, polygon)| Piece { particle, polygon };
    Ok((seeds, pieces.into_iter().map(piece).collect()))
}

fn part(clipped: &[[f64; 2]]) -> Part<2> {
    let (area, centroid) = area_and_centroid(clipped);
    Part {
        volume: area.abs(),
        centroid,
    }
}

/// Particles, and the data of parts with the particle that each went to.
type Filled<const D: usize, K> = (Vec<ParticleSeed<D>>, Vec<(usize, K)>);

/// The parts of the cells around a region.
#[derive(Debug)]
struct Parts<const D: usize> {
    per_direction: usize,
    /// By direction, the cells: lower end, and size of a part.
    cells: [Vec<[f64; 2]>; D],
    /// By direction, the end of the last cell.
    end: [f64; D],
}

impl<const D: usize> Parts<D> {
    fn around(
        grid: &Grid<D>,
        region: &(impl Region<D> + ?Sized),
        per_direction: usize,
    ) -> Result<Self, SeedError> {
        let (start, end) = grid.bounds();
        let slack: [f64; D] = std::array::from_fn(|axis| ROUND_OFF * (end[axis] - start[axis]));
        let from = std::array::from_fn(|axis| start[axis] - slack[axis]);
        let to = std::array::from_fn(|axis| end[axis] + slack[axis]);
        if let Some(corner) = region.beyond(from, to) {
            let corner = corner.to_vec();
            return Err(SeedError::OutsideGrid { corner });
        }
        // The lowest and the highest cell that it reaches into.
        let (lower, upper) = region.bounds();
        let last_of_all = std::array::from_fn(|axis| grid.axes[axis].cell_count() - 1);
        let first = grid.cell_at(&lower).unwrap_or([0; D]);
        let last = grid.cell_at(&upper).unwrap_or(last_of_all);
        let cells = std::array::from_fn(|axis| {
            let ax = &grid.axes[axis];
            let cell = |cell| [ax.nodes()[cell], ax.spacing(cell) / per_direction as f64];
            (first[axis]..=last[axis]).map(cell).collect()
        });
        let end = std::array::from_fn(|axis| grid.axes[axis].nodes()[last[axis] + 1]);
        Ok(Self {
            per_direction,
            cells,
            end,
        })
    }

    /// Lower and upper end of a part, counted from the first cell.
    fn ends(&self, axis: usize, part: usize) -> [f64; 2] {
        let [lower, size] = self.cells[axis][part / self.per_direction];
        let from = lower + (part % self.per_direction) as f64 * size;
        [from, from + size]
    }

    /// Clipping result by column of parts along the first axis.
    fn columns<T>(&self, make: impl Fn([f64; 2]) -> T) -> Vec<T> {
        let count = self.cells[0].len() * self.per_direction;
        (0..count).map(|part| make(self.ends(0, part))).collect()
    }

    /// Lower and upper corner of a cell.
    fn cell(&self, place: [usize; D]) -> ([f64; D], [f64; D]) {
        let end = |axis: usize| {
            let next = self.cells[axis].get(place[axis] + 1);
            next.map_or(self.end[axis], |[lower, _]| *lower)
        };
        (
            std::array::from_fn(|axis| self.cells[axis][place[axis]][0]),
            std::array::from_fn(end),
        )
    }

    /// The cover of each cell by a region that stands in columns, and the parts of cut cells; `None` for another
    /// region. Every column of parts is cut once.
    fn by_columns(&self, region: &(impl Region<D> + ?Sized)) -> Option<Vec<(Cover, Vec<Part<D>>)>> {
        let counts: [usize; D] = std::array::from_fn(|axis| self.cells[axis].len());
        let in_cell = [self.per_direction; D];
        let in_plan = |counts: &[usize; D]| counts[..D - 1].iter().product::<usize>();
        let (cells, parts) = (in_plan(&counts), in_plan(&in_cell));
        let mut found = vec![(Cover::Nothing, Vec::new()); cells * counts[D - 1]];
        for cell in 0..cells {
            let place = place_of(cell, counts);
            let columns = (0..parts).map(|part| {
                let step = place_of(part, in_cell);
                let ends: [[f64; 2]; D] = std::array::from_fn(|axis| {
                    self.ends(axis, place[axis] * self.per_direction + step[axis])
                });
                region.column(ends.map(|[from, _]| from), ends.map(|[_, to]| to))
            });
            let columns: Vec<_> = columns.collect::<Option<_>>()?;
            for level in 0..counts[D - 1] {
                let ends = |step: usize| self.ends(D - 1, level * self.per_direction + step);
                let whole = [ends(0)[0], ends(self.per_direction - 1)[1]];
                let covers = columns.iter().map(|column| column.cover(whole));
                let both = |a, b| if a == b { a } else { Cover::Cut };
                let cover = covers.reduce(both).unwrap_or(Cover::Nothing);
                let slot = &mut found[level * cells + cell];
                slot.0 = cover;
                if cover == Cover::Cut {
                    let steps = (0..self.per_direction).map(ends);
                    let cut = steps
                        .flat_map(|ends| columns.iter().map(move |column| column.within(ends)));
                    slot.1.extend(cut);
                }
            }
        }
        Some(found)
    }

    /// Fills the parts: particles in the order of the cells, then of the parts of a cell, and whatever
    /// `within` hands out with each part that is not empty, with the particle that the part went to. Cells and their
    /// parts are numbered, the first direction fastest.
    fn filled<K: Default>(
        &self,
        density: f64,
        law: usize,
        cover: impl Fn(usize, [f64; D], [f64; D]) -> Cover,
        within: impl Fn(usize, usize, [f64; D], [f64; D]) -> (Part<D>, K),
    ) -> Result<Filled<D, K>, SeedError> {
        let counts: [usize; D] = std::array::from_fn(|axis| self.cells[axis].len());
        let in_cell = [self.per_direction; D];
        let mut seeds: Vec<ParticleSeed<D>> = Vec::new();
        let (mut kept, mut slivers) = (Vec::new(), Vec::new());
        let mut first = vec![0];
        for number in 0..counts.iter().product() {
            let cell = place_of(number, counts);
            let (lower, upper) = self.cell(cell);
            let cover = cover(number, lower, upper);
            for part in 0..in_cell.iter().product() {
                if cover == Cover::Nothing {
                    break;
                }
                let step = place_of(part, in_cell);
                let place: [usize; D] =
                    std::array::from_fn(|axis| cell[axis] * self.per_direction + step[axis]);
                let ends: [[f64; 2]; D] = std::array::from_fn(|axis| self.ends(axis, place[axis]));
                let (from, to) = (ends.map(|[from, _]| from), ends.map(|[_, to]| to));
                let size: [f64; D] = std::array::from_fn(|axis| self.cells[axis][cell[axis]][1]);
                let (piece, keep) = if cover == Cover::Whole {
                    (Part::whole(from, to), K::default())
                } else {
                    within(number, part, from, to)
                };
                if piece.volume >= (1.0 - TIE) * SLIVER * size.iter().product::<f64>() {
                    kept.push((seeds.len(), keep));
                    let (x, half_length) = domain(from, size, &piece);
                    seeds.push(ParticleSeed {
                        x,
                        half_length,
                        volume: piece.volume,
                        density,
                        law,
                        centroid: within_domain(x, half_length, piece.centroid),
                    });
                } else if piece.volume > 0.0 {
                    slivers.push((number, piece, keep));
                }
            }
            first.push(seeds.len());
        }
        if seeds.is_empty() {
            return Err(SeedError::EmptyBody);
        }
        if !slivers.is_empty() {
            let x: Vec<[f64; D]> = seeds.iter().map(|seed| seed.x).collect();
            let nearest = Nearest::new(self, &x, &first);
            for (cell, sliver, keep) in slivers {
                let particle = nearest_within(first[cell]..first[cell + 1], &x, sliver.centroid)
                    .unwrap_or_else(|| nearest.to(sliver.centroid));
                let seed = &mut seeds[particle];
                let volume = seed.volume + sliver.volume;
                let together = std::array::from_fn(|axis| {
                    let at = seed.x[axis] + seed.centroid[axis] * seed.half_length[axis];
                    (seed.volume * at + sliver.volume * sliver.centroid[axis]) / volume
                });
                seed.centroid = within_domain(seed.x, seed.half_length, together);
                seed.volume = volume;
                kept.push((particle, keep));
            }
        }
        Ok((seeds, kept))
    }
}

/// Middle and half-lengths of the domain of the soil in a part: the soil itself where it is a box that fills the part up to
/// one side of each axis, as a face along an axis leaves it, and the whole part otherwise (theory, eq. 44c).
fn domain<const D: usize>(from: [f64; D], size: [f64; D], soil: &Part<D>) -> ([f64; D], [f64; D]) {
    let middle: [f64; D] = std::array::from_fn(|axis| from[axis] + 0.5 * size[axis]);
    let left: [f64; D] =
        std::array::from_fn(|axis| size[axis] - 2.0 * (soil.centroid[axis] - middle[axis]).abs());
    let volume: f64 = left.iter().product();
    let whole: f64 = size.iter().product();
    let is_box = (volume - soil.volume).abs() < BOX * whole;
    if is_box && volume < (1.0 - BOX) * whole {
        return (soil.centroid, left.map(|length| 0.5 * length));
    }
    (middle, size.map(|size| 0.5 * size))
}

/// Of a range of particles the nearest to a point; of several the first.
fn nearest_within<const D: usize>(
    particles: Range<usize>,
    x: &[[f64; D]],
    point: [f64; D],
) -> Option<usize> {
    let square = |particle: usize| -> f64 {
        let apart = std::iter::zip(x[particle], point);
        apart.map(|(a, b)| (a - b) * (a - b)).sum()
    };
    let least = particles.clone().map(square).reduce(f64::min)?;
    particles
        .into_iter()
        .find(|&particle| square(particle) <= (1.0 + TIE) * least)
}

/// A centroid within a domain, from its middle, over half-lengths \[-\].
fn within_domain<const D: usize>(
    x: [f64; D],
    half_length: [f64; D],
    centroid: [f64; D],
) -> [f64; D] {
    std::array::from_fn(|axis| {
        let place = (centroid[axis] - x[axis]) / half_length[axis];
        if place.abs() < ROUND_OFF {
            0.0
        } else {
            place.clamp(-OUTERMOST, OUTERMOST)
        }
    })
}

/// The place of a number in a box of so many, the first direction fastest.
fn place_of<const D: usize>(number: usize, counts: [usize; D]) -> [usize; D] {
    let mut rest = number;
    counts.map(|count| {
        let place = rest % count;
        rest /= count;
        place
    })
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

    /// GOAL: particles know where their soil is.
    /// ORACLE: the centroid of the polygon; what joins a particle may lie beyond its domain, and is then taken at its edge.
    #[test]
    fn centroids_of_the_soil_are_those_of_the_polygon() {
        let polygon = [[0.0, 0.0], [11.3, 0.0], [9.7, 1.1], [4.2, 4.6], [0.0, 4.6]];
        let (area, centroid) = area_and_centroid(&polygon);
        let seeds = fill_polygon(&grid(), &polygon, 3, 1.0, 0).unwrap();
        for axis in 0..2 {
            let place = |seed: &ParticleSeed<2>| {
                seed.x[axis] + seed.centroid[axis] * seed.half_length[axis]
            };
            let moment: f64 = seeds.iter().map(|seed| seed.volume * place(seed)).sum();
            assert!((moment / area - centroid[axis]).abs() < 1e-5, "{moment}");
        }
        assert!(seeds.iter().any(|seed| seed.centroid[0] < 0.0));
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
        let sum = |particle: usize| {
            let all = pieces
                .iter()
                .filter(move |piece| piece.particle == particle);
            all.map(|piece| area_and_centroid(&piece.polygon).0)
                .sum::<f64>()
        };
        for (particle, seed) in seeds.iter().enumerate() {
            assert!((sum(particle) - seed.volume).abs() < 1e-12, "{particle}");
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

    /// GOAL: a body and its mirror image hold mirrored particles, also where a part of it is a tenth of a whole one but for round-off.
    /// ORACLE: the reflection, of slopes that rise by eight over ten from places all over a cell, and of others.
    #[test]
    fn mirrored_slopes_hold_mirrored_particles() {
        let axes = [40, 14].map(|count| Axis::uniform(0.0, 1.0, count).unwrap());
        let grid = Grid::<2>::new(axes);
        let runs = [10.0, 8.0, 16.0, 12.0, 4.0, 20.0];
        for (number, run) in (0..120).zip(runs.into_iter().cycle()) {
            let toe = [
                26.0 + 0.05 * f64::from(number),
                4.0 + 0.1 * f64::from(number / 6 % 10),
            ];
            let crest = [toe[0] - run, toe[1] + 8.0];
            let slope = [
                [0.0, 0.0],
                [40.0, 0.0],
                [40.0, toe[1]],
                toe,
                crest,
                [0.0, crest[1]],
            ];
            let mirrored: Vec<_> = slope.iter().rev().map(|[x, y]| [40.0 - x, *y]).collect();
            for per_direction in [2, 3] {
                let filled = |slope: &[[f64; 2]]| fill_polygon(&grid, slope, per_direction, 1.0, 0);
                let seeds = filled(&slope).unwrap();
                let other = filled(&mirrored).unwrap();
                assert_eq!(seeds.len(), other.len(), "{toe:?} {run} {per_direction}");
                for seed in &seeds {
                    let image = [40.0 - seed.x[0], seed.x[1]];
                    let near = |a: f64, b: f64| (a - b).abs() < 1e-9;
                    let is_image = |found: &ParticleSeed<2>| {
                        near(found.x[0], image[0])
                            && near(found.x[1], image[1])
                            && near(found.volume, seed.volume)
                            && near(found.centroid[0], -seed.centroid[0])
                            && near(found.centroid[1], seed.centroid[1])
                    };
                    assert!(
                        other.iter().any(is_image),
                        "{toe:?} {run} {per_direction}: {seed:?}"
                    );
                }
            }
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
            Err(SeedError::OutsideGrid {
                corner
            }) if corner == [13.0, 0.0]
        ));
        let flat = fill_polygon(&grid(), &[[0.0, 0.0], [2.0, 0.0], [1.0, 0.0]], 2, 1.0, 0);
        assert!(matches!(flat, Err(SeedError::EmptyBody)));
    }
}
