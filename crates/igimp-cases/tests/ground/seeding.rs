//! GOAL: particles seeded from any polygon have its volume, and their domains tile the cells that it
//! reaches into.
//! BODY: random polygons without crossing edges, which the reader of case files refuses: stars about a
//! centre, concave ones and needles among them, and triangles with corners on nodes; on random graded
//! grids.
//! ORACLE: the shoelace formula; a count of the parts of each cell; the rule of seeding done word by word,
//! without columns and without a search, to the bit.

use std::collections::BTreeSet;
use std::f64::consts::TAU;
use std::ops::Range;

use igimp_geometry::SeedError;
use igimp_geometry::polygon::{area_and_centroid, clip_to_box};
use igimp_geometry::seed::fill_polygon;
use igimp_shape::{Axis, Grid};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

fn axis() -> impl Strategy<Value = Axis> {
    let sizes = prop::collection::vec(0.2..1.5, 1..=7);
    let uniform = (-5.0..5.0, 0.1..1.0, 1_usize..=9)
        .prop_map(|(start, size, cells)| Axis::uniform(start, size, cells).unwrap());
    let graded = (-5.0..5.0, sizes).prop_map(|(start, sizes)| {
        let mut nodes = vec![start];
        for size in sizes {
            nodes.push(nodes[nodes.len() - 1] + size);
        }
        Axis::from_nodes(nodes).unwrap()
    });
    prop_oneof![uniform, graded]
}

/// A polygon on a grid, and how finely it is filled.
#[derive(Clone, Debug)]
struct Sample {
    grid: Grid<2>,
    polygon: Vec<[f64; 2]>,
    per_direction: usize,
}

/// Corner k of n stands at the angle of (k + shift) / n turns about the centre. With shifts below
/// 0.45 no two neighbours are half a turn apart, so that edges do not cross; nor do those of a
/// triangle, wherever its corners are moved.
fn sample() -> impl Strategy<Value = Sample> {
    let corner = (0.0..0.45, 0.02..1.0);
    (
        [axis(), axis()],
        prop::collection::vec(corner, 3..=9),
        [0.1..0.9, 0.1..0.9],
        prop::bool::weighted(0.3),
        1_usize..=4,
    )
        .prop_map(placed)
}

/// A random grid, corners with shift and reach, centre, whether corners are moved onto nodes, and
/// particles per direction.
type Parts = ([Axis; 2], Vec<(f64, f64)>, [f64; 2], bool, usize);

fn placed((axes, mut corners, centre, on_nodes, per_direction): Parts) -> Sample {
    let grid = Grid::new(axes);
    if on_nodes {
        corners.truncate(3);
    }
    let count = corners.len() as f64;
    let corner = |(k, (shift, reach)): (usize, (f64, f64))| {
        let angle = TAU * (k as f64 + shift) / count;
        let way = [angle.cos(), angle.sin()];
        std::array::from_fn(|d| {
            let axis = &grid.axes[d];
            let share = centre[d] + reach * way[d] * centre[d].min(1.0 - centre[d]);
            let x = axis.start() + share * (axis.end() - axis.start());
            let x = x.clamp(axis.start(), axis.end());
            let next = axis.nodes().iter().find(|&&node| node >= x);
            next.copied().filter(|_| on_nodes).unwrap_or(x)
        })
    };
    let polygon = corners.into_iter().enumerate().map(corner).collect();
    Sample {
        grid,
        polygon,
        per_direction,
    }
}

/// Twice the area that the edges enclose, counted with their sense, by the shoelace formula.
fn shoelace(polygon: &[[f64; 2]]) -> f64 {
    let next = polygon.iter().cycle().skip(1);
    let cross = |(p, q): (&[f64; 2], &[f64; 2])| (p[0] - q[0]) * (p[1] + q[1]);
    0.5 * std::iter::zip(polygon, next).map(cross).sum::<f64>()
}

fn check(sample: &Sample) -> Result<(), TestCaseError> {
    let Sample {
        grid,
        polygon,
        per_direction,
    } = sample;
    let (lower, upper) = grid.bounds();
    let whole = (upper[0] - lower[0]) * (upper[1] - lower[1]);
    let far: f64 = lower
        .iter()
        .chain(&upper)
        .fold(1.0, |most, x| most.max(x.abs()));
    let area = shoelace(polygon).abs();
    let seeds = match fill_polygon(grid, polygon, *per_direction, 2.0, 3) {
        Ok(seeds) => seeds,
        Err(SeedError::EmptyBody) => {
            // All parts are slivers of less than a tenth.
            prop_assert!(area < 0.1 * whole, "{area} of {whole}");
            return Ok(());
        }
        Err(error) => return Err(TestCaseError::fail(error.to_string())),
    };
    let volume: f64 = seeds.iter().map(|seed| seed.volume).sum();
    let round_off = 1e-13 * far * far;
    prop_assert!((volume - area).abs() <= round_off, "{volume} {area}");
    let mut taken = BTreeSet::new();
    for seed in &seeds {
        let cell = grid.cell_at(&seed.x).unwrap();
        let size = grid.cell_size(cell);
        let corner = grid.node_position(grid.node_index(cell));
        let mut part = [0; 2];
        for d in 0..2 {
            // The domain is a whole part of its cell: parts of equal size, each at its place.
            let edge = size[d] / *per_direction as f64;
            prop_assert!((2.0 * seed.half_length[d] - edge).abs() <= 1e-14 * size[d]);
            let place = (seed.x[d] - corner[d]) / edge - 0.5;
            prop_assert!(
                (place - place.round()).abs() <= 1e-13 * far / edge,
                "{place}"
            );
            prop_assert!(place.round() >= 0.0 && place.round() < *per_direction as f64);
            part[d] = place.round() as usize;
        }
        prop_assert!(taken.insert((cell, part)), "two particles share a part");
        prop_assert!(seed.volume > 0.0);
        prop_assert!(seed.density.to_bits() == 2.0_f64.to_bits() && seed.law == 3);
    }
    // The sense of the corners and where they begin make no difference but for round-off.
    let mut turned: Vec<_> = polygon.iter().rev().copied().collect();
    turned.rotate_left(1);
    let again = fill_polygon(grid, &turned, *per_direction, 2.0, 3).unwrap();
    let sum: f64 = again.iter().map(|seed| seed.volume).sum();
    prop_assert!((sum - area).abs() <= round_off, "{sum} {area}");
    Ok(())
}

/// The rule word by word: every part clips the whole polygon, every sliver looks at all particles of its cell, or else of the
/// polygon.
fn check_by_rule(sample: &Sample) -> Result<(), TestCaseError> {
    let (grid, per_direction) = (&sample.grid, sample.per_direction);
    let (mut expected, mut slivers, mut first) = (Vec::new(), Vec::new(), Vec::new());
    for cell in 0..grid.cell_count() {
        let place = grid.cell_place(cell);
        let lower = grid.node_position(grid.node_index(place));
        let size = grid.cell_size(place).map(|h| h / per_direction as f64);
        first.push(expected.len());
        for part in 0..per_direction * per_direction {
            let step = [part % per_direction, part / per_direction];
            let from: [f64; 2] = std::array::from_fn(|d| lower[d] + step[d] as f64 * size[d]);
            let to = std::array::from_fn(|d| from[d] + size[d]);
            let (area, centroid) = area_and_centroid(&clip_to_box(&sample.polygon, from, to));
            if area.abs() >= 0.1 * (size[0] * size[1]) {
                let x: [f64; 2] = std::array::from_fn(|d| from[d] + 0.5 * size[d]);
                expected.push((x, area.abs()));
            } else if area != 0.0 {
                slivers.push((area.abs(), centroid, cell));
            }
        }
    }
    first.push(expected.len());
    for (area, centroid, cell) in slivers {
        let distance = |x: [f64; 2]| (x[0] - centroid[0]).hypot(x[1] - centroid[1]);
        let nearest = |particles: Range<usize>| {
            particles.min_by(|&a, &b| distance(expected[a].0).total_cmp(&distance(expected[b].0)))
        };
        let of_cell = nearest(first[cell]..first[cell + 1]);
        if let Some(nearest) = of_cell.or_else(|| nearest(0..expected.len())) {
            expected[nearest].1 += area;
        }
    }
    let seeds = fill_polygon(grid, &sample.polygon, per_direction, 2.0, 3).unwrap_or_default();
    let found: Vec<_> = seeds.iter().map(|seed| (seed.x, seed.volume)).collect();
    prop_assert_eq!(found, expected, "not the same bits");
    Ok(())
}

/// A polygon that is all of the grid fills every part of every cell with its whole volume.
fn fills(grid: &Grid<2>, per_direction: usize) -> Result<(), TestCaseError> {
    let ([x0, y0], [x1, y1]) = grid.bounds();
    let polygon = [[x0, y0], [x1, y0], [x1, y1], [x0, y1]];
    let seeds = fill_polygon(grid, &polygon, per_direction, 1.0, 0).unwrap();
    prop_assert_eq!(
        seeds.len(),
        grid.cell_count() * per_direction * per_direction
    );
    for seed in &seeds {
        let domain = 4.0 * seed.half_length[0] * seed.half_length[1];
        prop_assert!((seed.volume - domain).abs() <= 1e-12 * domain, "{seed:?}");
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 400,
        failure_persistence: None,
        rng_seed: RngSeed::Fixed(20_261_121),
        ..ProptestConfig::default()
    })]

    #[test]
    fn polygons_are_filled(sample in sample()) {
        check(&sample)?;
        check_by_rule(&sample)?;
    }

    #[test]
    fn the_whole_grid_is_filled(axes in [axis(), axis()], per_direction in 1_usize..=4) {
        fills(&Grid::new(axes), per_direction)?;
    }
}
