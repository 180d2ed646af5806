//! Independent oracle: means over the domain by Gauss quadrature, cell by cell.
//!
//! Within a cell the tent functions are linear per direction, so two Gauss points per direction
//! are exact. Nothing is shared with the crate but the node coordinates.

use std::array;

use igimp_shape::{Axis, Gimp, Grid, Linear, Scratch, Support, supports};
use proptest::prelude::*;

use crate::strategies::{Direction, SMALLEST_CELL, direction};

/// Tent function of a node and its slope at `x`, which is not on a node.
fn tent(axis: &Axis, node: usize, x: f64) -> (f64, f64) {
    let nodes = axis.nodes();
    let height = nodes[node];
    let neighbour = if x < height {
        node.checked_sub(1)
    } else {
        Some(node + 1)
    };
    match neighbour.and_then(|neighbour| nodes.get(neighbour)) {
        Some(&foot) if (x - foot) * (height - foot) > 0.0 => {
            ((x - foot) / (height - foot), (height - foot).recip())
        }
        _ => (0.0, 0.0),
    }
}

/// Value and gradient of the grid's tent function of a node.
fn tent_product<const D: usize>(grid: &Grid<D>, node: usize, x: [f64; D]) -> (f64, [f64; D]) {
    let place = grid.node_place(node);
    let tents: [_; D] = array::from_fn(|d| tent(&grid.axes[d], place[d], x[d]));
    let gradient = array::from_fn(|d| {
        (0..D)
            .map(|e| if e == d { tents[e].1 } else { tents[e].0 })
            .product()
    });
    (tents.iter().map(|tent| tent.0).product(), gradient)
}

/// Means over the box from `lower` to `upper` for every node of the grid.
fn means<const D: usize>(grid: &Grid<D>, lower: [f64; D], upper: [f64; D]) -> Vec<Support<D>> {
    let mut all: Vec<_> = (0..grid.node_count())
        .map(|node| Support {
            node,
            value: 0.0,
            grad: [0.0; D],
            grad_bar: [0.0; D],
        })
        .collect();
    for cell in 0..grid.cell_count() {
        let place = grid.cell_place(cell);
        let faces = |side: usize| array::from_fn(|d| grid.axes[d].nodes()[place[d] + side]);
        let (left, right): ([f64; D], [f64; D]) = (faces(0), faces(1));
        let from: [f64; D] = array::from_fn(|d| lower[d].max(left[d]));
        let to: [f64; D] = array::from_fn(|d| upper[d].min(right[d]));
        if (0..D).any(|d| to[d] <= from[d]) {
            continue;
        }
        let fraction: f64 = (0..D)
            .map(|d| (to[d] - from[d]) / (upper[d] - lower[d]))
            .product();
        let centre = array::from_fn(|d| 0.5 * (left[d] + right[d]));
        for support in &mut all {
            for corner in 0..1 << D {
                let point = array::from_fn(|d| {
                    let side = if corner >> d & 1 == 0 { -1.0 } else { 1.0 };
                    0.5 * ((from[d] + to[d]) + side * (to[d] - from[d]) / 3_f64.sqrt())
                });
                let weight = fraction / f64::from(1 << D);
                let (value, grad) = tent_product(grid, support.node, point);
                support.value += weight * value;
                for d in 0..D {
                    support.grad[d] += weight * grad[d];
                }
            }
            let (_, centre_grad) = tent_product(grid, support.node, centre);
            for d in 0..D {
                support.grad_bar[d] += fraction * centre_grad[d];
            }
        }
    }
    all
}

/// Supports that are not listed are zero; the others agree with the oracle.
fn compare<const D: usize>(
    expected: &[Support<D>],
    list: &[Support<D>],
) -> Result<(), TestCaseError> {
    let mut listed = list.iter().peekable();
    for expected in expected {
        let absent = Support {
            node: expected.node,
            value: 0.0,
            grad: [0.0; D],
            grad_bar: [0.0; D],
        };
        let seen = listed
            .next_if(|support| support.node == expected.node)
            .unwrap_or(&absent);
        prop_assert!(
            (seen.value - expected.value).abs() < 1e-14,
            "{seen:?} {expected:?}"
        );
        for d in 0..D {
            let grad_error = (seen.grad[d] - expected.grad[d]).abs();
            let grad_bar_error = (seen.grad_bar[d] - expected.grad_bar[d]).abs();
            let tolerance = 1e-14 / SMALLEST_CELL;
            prop_assert!(
                grad_error.max(grad_bar_error) < tolerance,
                "{seen:?} {expected:?}"
            );
        }
    }
    prop_assert!(listed.next().is_none());
    Ok(())
}

fn check<const D: usize>(directions: [Direction; D]) -> Result<(), TestCaseError> {
    let x = array::from_fn(|d| directions[d].x);
    let half_length = array::from_fn(|d| directions[d].half_length);
    let lower = array::from_fn(|d| directions[d].domain().0);
    let upper = array::from_fn(|d| directions[d].domain().1);
    let grid = Grid::new(directions.map(|direction| direction.axis));
    let (mut scratch, mut list) = (Scratch::default(), Vec::new());

    supports(&grid, &Gimp, &x, &half_length, &mut scratch, &mut list).unwrap();
    compare(&means(&grid, lower, upper), &list)?;

    // The linear basis: the tent functions themselves, and their gradient at the cell's centre.
    let place = grid.cell_at(&x).unwrap();
    if (0..D).all(|d| x[d] > grid.axes[d].nodes()[place[d]] && x[d] < grid.axes[d].end()) {
        let centre =
            array::from_fn(|d| grid.axes[d].nodes()[place[d]] + 0.5 * grid.cell_size(place)[d]);
        let expected: Vec<_> = (0..grid.node_count())
            .map(|node| {
                let (value, grad) = tent_product(&grid, node, x);
                let (_, grad_bar) = tent_product(&grid, node, centre);
                Support {
                    node,
                    value,
                    grad,
                    grad_bar,
                }
            })
            .collect();
        supports(&grid, &Linear, &x, &half_length, &mut scratch, &mut list).unwrap();
        compare(&expected, &list)?;
    }
    Ok(())
}

proptest! {
    #[test]
    fn agrees_in_1d(particle in [direction()]) {
        check(particle)?;
    }

    #[test]
    fn agrees_in_2d(particle in [direction(), direction()]) {
        check(particle)?;
    }

    #[test]
    fn agrees_in_3d(particle in [direction(), direction(), direction()]) {
        check(particle)?;
    }
}
