//! Sums over the nodes: partition of unity, linear reproduction, constant gradients.

use std::array;

use igimp_shape::{Basis, Gimp, Grid, Linear, Scratch, Support, supports};
use proptest::prelude::*;

use crate::strategies::{Direction, SMALLEST_CELL, any_direction};

/// One direction: every identity that the products inherit.
fn check_direction(particle: &Direction) -> Result<(), TestCaseError> {
    let Direction {
        axis,
        x,
        half_length,
    } = particle;
    let (lower, upper) = particle.domain();
    let magnitude = axis.start().abs().max(axis.end().abs());
    for (basis, middle) in [(&Linear as &dyn Basis, *x), (&Gimp, 0.5 * (lower + upper))] {
        let mut weights = Vec::new();
        basis
            .axis_weights(axis, *x, *half_length, &mut weights)
            .unwrap();

        prop_assert!(weights.len() >= 2);
        prop_assert!(
            weights
                .windows(2)
                .all(|pair| pair[1].node == pair[0].node + 1)
        );
        prop_assert!(
            weights
                .iter()
                .all(|weight| weight.value >= 0.0 && weight.centre > 0.0)
        );

        let (mut unity, mut centre_unity, mut point) = (0.0, 0.0, 0.0);
        let (mut slope_sum, mut slope_of_x) = (0.0, 0.0);
        for weight in &weights {
            let node_x = axis.nodes()[weight.node];
            unity += weight.value;
            centre_unity += weight.centre;
            point += weight.value * node_x;
            slope_sum += weight.slope;
            slope_of_x += weight.slope * (node_x - x);
        }
        let name = basis.name();
        prop_assert!(f64::abs(unity - 1.0) < 1e-15, "{name}: unity {unity:e}");
        prop_assert!(
            f64::abs(centre_unity - 1.0) < 1e-15,
            "{name}: centre {centre_unity:e}"
        );
        prop_assert!(
            f64::abs(point - middle) < 1e-14 * magnitude,
            "{name}: {point} {middle}"
        );
        prop_assert!(
            f64::abs(slope_sum) < 1e-15 / SMALLEST_CELL,
            "{name}: {slope_sum:e}"
        );
        prop_assert!(f64::abs(slope_of_x - 1.0) < 1e-14, "{name}: {slope_of_x:e}");
    }
    Ok(())
}

/// `D` directions: rigid motions and uniform gradients, from either gradient.
fn check_product<const D: usize>(directions: [Direction; D]) -> Result<(), TestCaseError> {
    let x = array::from_fn(|d| directions[d].x);
    let half_length = array::from_fn(|d| directions[d].half_length);
    let grid = Grid::new(directions.map(|direction| direction.axis));
    for basis in [&Linear as &dyn Basis, &Gimp] {
        let (mut scratch, mut list) = (Scratch::default(), Vec::new());
        supports(&grid, basis, &x, &half_length, &mut scratch, &mut list).unwrap();

        prop_assert!(list.windows(2).all(|pair| pair[0].node < pair[1].node));
        let unity: f64 = list.iter().map(|support| support.value).sum();
        prop_assert!((unity - 1.0).abs() < 1e-14, "{unity:e}");
        check_gradient(&grid, &x, &list, |support| support.grad)?;
        check_gradient(&grid, &x, &list, |support| support.grad_bar)?;
    }
    Ok(())
}

/// $`\sum \nabla S_i = 0`$ and $`\sum x_i \otimes \nabla S_i = I`$, the latter about the particle so
/// that its round-off is relative to a cell.
fn check_gradient<const D: usize>(
    grid: &Grid<D>,
    x: &[f64; D],
    list: &[Support<D>],
    gradient: fn(&Support<D>) -> [f64; D],
) -> Result<(), TestCaseError> {
    let mut sum = [0.0; D];
    let mut tensor = [[0.0; D]; D];
    for support in list {
        let (grad, position) = (gradient(support), grid.node_position(support.node));
        for b in 0..D {
            sum[b] += grad[b];
            for a in 0..D {
                tensor[a][b] += (position[a] - x[a]) * grad[b];
            }
        }
    }
    for b in 0..D {
        prop_assert!(f64::abs(sum[b]) < 1e-14 / SMALLEST_CELL, "{sum:?}");
        for a in 0..D {
            let identity = f64::from(u8::from(a == b));
            prop_assert!(f64::abs(tensor[a][b] - identity) < 1e-13, "{tensor:?}");
        }
    }
    Ok(())
}

proptest! {
    #[test]
    fn hold_in_one_direction(particle in any_direction()) {
        check_direction(&particle)?;
    }

    #[test]
    fn hold_in_2d(particle in [any_direction(), any_direction()]) {
        check_product(particle)?;
    }

    #[test]
    fn hold_in_3d(particle in [any_direction(), any_direction(), any_direction()]) {
        check_product(particle)?;
    }
}
