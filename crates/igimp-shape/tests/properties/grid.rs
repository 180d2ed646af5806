//! Grids: numbering there and back, and the cell of a point, on axes of all kinds: uniform, graded,
//! far from the origin, and with cells that differ by decades.

use std::array;

use igimp_shape::{Axis, Grid, ShapeError};
use proptest::prelude::*;

use crate::strategies;

/// Axes of the other properties, and rougher ones: cells that grow geometrically, a far origin.
fn axis() -> impl Strategy<Value = Axis> {
    let geometric = (-1e6..1e6, 1e-3..1e3, 0.2_f64..5.0, 1_usize..12).prop_map(
        |(start, size, ratio, cells): (f64, f64, f64, usize)| {
            let mut nodes = vec![start];
            for k in 0..cells {
                nodes.push(nodes[k] + size * ratio.powi(k as i32));
            }
            // Cells that drown in the origin are not wanted here.
            let least = 1e-9
                * nodes
                    .iter()
                    .fold(1.0, |most: f64, node| most.max(node.abs()));
            nodes.dedup_by(|next, previous| *next - *previous < least);
            nodes.push(nodes[nodes.len() - 1] + size.max(least) * 2.0);
            Axis::from_nodes(nodes).unwrap()
        },
    );
    prop_oneof![2 => strategies::axis(), 1 => geometric]
}

/// A share of the way from the first to the last node, often on a node or one bit beside it.
fn point(axis: &Axis, share: f64, near: usize) -> f64 {
    let node = axis.nodes()[near / 4 % axis.node_count()];
    match near % 4 {
        0 => node,
        1 => node.next_up(),
        2 => node.next_down(),
        _ => axis.start() + share * (axis.end() - axis.start()),
    }
}

/// Places and running numbers are a bijection, and both tell the same geometry.
fn numbering<const D: usize>(axes: [Axis; D]) -> Result<(), TestCaseError> {
    let grid = Grid::new(axes);
    let nodes: usize = grid.axes.iter().map(|axis| axis.nodes().len()).product();
    prop_assert_eq!(grid.node_count(), nodes);
    let mut volume = 0.0;
    for node in 0..grid.node_count() {
        let place = grid.node_place(node);
        prop_assert_eq!(grid.node_index(place), node);
        let x = grid.node_position(node);
        prop_assert!(grid.contains(&x));
        // A node belongs to the cell of its place, and the last ones to the last cell.
        let cell: [usize; D] = array::from_fn(|d| place[d].min(grid.axes[d].cell_count() - 1));
        prop_assert_eq!(grid.cell_at(&x), Some(cell));
    }
    for cell in 0..grid.cell_count() {
        let place = grid.cell_place(cell);
        prop_assert_eq!(grid.cell_index(place), cell);
        let size = grid.cell_size(place);
        prop_assert!(size.iter().all(|size| *size > 0.0));
        let lower = grid.node_position(grid.node_index(place));
        let centre = array::from_fn(|d| lower[d] + 0.5 * size[d]);
        prop_assert_eq!(grid.cell_at(&centre), Some(place));
        volume += size.iter().product::<f64>();
    }
    // Cells tile the grid.
    let (lower, upper) = grid.bounds();
    let whole: f64 = (0..D).map(|d| upper[d] - lower[d]).product();
    let far = (0..D).map(|d| lower[d].abs().max(upper[d].abs()) / (upper[d] - lower[d]));
    let tolerance = 1e-15 * (10.0 + far.sum::<f64>()) * grid.cell_count() as f64;
    prop_assert!(
        (volume - whole).abs() <= tolerance * whole,
        "{volume} {whole}"
    );
    Ok(())
}

/// The cell of a point is the one that a search through all cells finds, and there is none outside.
fn location<const D: usize>(
    axes: [Axis; D],
    share: [f64; D],
    near: [usize; D],
) -> Result<(), TestCaseError> {
    let grid = Grid::new(axes);
    let x: [f64; D] = array::from_fn(|d| point(&grid.axes[d], share[d], near[d]));
    let within = |place: [usize; D]| {
        (0..D).all(|d| {
            let nodes = grid.axes[d].nodes();
            let is_last = place[d] + 2 == nodes.len();
            let below_end = x[d] < nodes[place[d] + 1] || is_last && x[d] <= nodes[place[d] + 1];
            nodes[place[d]] <= x[d] && below_end
        })
    };
    let found: Vec<_> = (0..grid.cell_count())
        .map(|cell| grid.cell_place(cell))
        .filter(|&place| within(place))
        .collect();
    prop_assert!(found.len() <= 1, "{x:?} is in the cells {found:?}");
    prop_assert_eq!(grid.cell_at(&x), found.first().copied());
    prop_assert_eq!(grid.contains(&x), !found.is_empty());
    Ok(())
}

proptest! {
    #[test]
    fn numbers_and_places_in_1d(axes in [axis()]) {
        numbering(axes)?;
    }

    #[test]
    fn numbers_and_places_in_2d(axes in [axis(), axis()]) {
        numbering(axes)?;
    }

    #[test]
    fn numbers_and_places_in_3d(axes in [axis(), axis(), axis()]) {
        numbering(axes)?;
    }

    #[test]
    fn cells_of_points_in_1d(axes in [axis()], share in 0.0..1.0, near in 0_usize..64) {
        location(axes, [share], [near])?;
    }

    #[test]
    fn cells_of_points_in_2d(
        axes in [axis(), axis()],
        share in [0.0..1.0, 0.0..1.0],
        near in [0_usize..64, 0_usize..64],
    ) {
        location(axes, share, near)?;
    }

    /// An axis is its nodes: made from them again it is the same, and evenly spaced ones are the
    /// same as uniform ones.
    #[test]
    fn an_axis_is_its_nodes(axis in axis(), start in -10.0..10.0, spacing in 0.1..3.0, cells in 1_usize..20) {
        prop_assert_eq!(&Axis::from_nodes(axis.nodes().to_vec()).unwrap(), &axis);
        let uniform = Axis::uniform(start, spacing, cells).unwrap();
        prop_assert_eq!(&Axis::from_nodes(uniform.nodes().to_vec()).unwrap(), &uniform);
        let sizes: f64 = (0..axis.cell_count()).map(|cell| axis.spacing(cell)).sum();
        let far = axis.start().abs().max(axis.end().abs());
        prop_assert!((sizes - (axis.end() - axis.start())).abs() <= 1e-15 * 20.0 * far);
    }

    /// Nodes out of order or not finite are refused, wherever they are.
    #[test]
    fn a_wrong_node_is_named(axis in axis(), at in 0_usize..64, kind in 0_usize..3) {
        let mut nodes = axis.nodes().to_vec();
        let at = at % nodes.len();
        nodes[at] = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY][kind];
        let error = Axis::from_nodes(nodes.clone()).unwrap_err();
        let is_named = matches!(error, ShapeError::NotFinite { index, .. } if index == at);
        prop_assert!(is_named, "{}", error);
        let mut nodes = axis.nodes().to_vec();
        nodes.swap(at, (at + 1) % axis.node_count());
        let error = Axis::from_nodes(nodes).unwrap_err();
        let is_named = matches!(error, ShapeError::NotIncreasing { .. });
        prop_assert!(is_named, "{}", error);
    }
}
