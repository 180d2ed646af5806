//! Permeability of a cell that several soils share, or whose soil varies (theory, eqs. 85 and 85e).

use crate::basis::Point;
use crate::basis::{apply, dot};

/// The tensor of a laminate of the soils of a cell: exact for layers however the grid lies to them; none for one soil that does
/// not vary.
pub(crate) fn laminate<const D: usize>(
    points: &[Point<D>],
    tensors: &[[[f64; D]; D]],
) -> Option<[[f64; D]; D]> {
    let first = points.first()?.soil;
    let is_one = points.iter().all(|point| point.soil == first);
    let normal = match is_one {
        true if points.iter().all(|point| is_same(point.scale, 1.0)) => return None,
        true => ascent(points),
        false => across(points, first),
    };
    let volume: f64 = points.iter().map(|point| point.volume).sum();
    let mut along = [[0.0; D]; D];
    let (mut lead, mut resistance) = ([0.0; D], 0.0);
    for point in points {
        let tensor = &tensors[point.soil];
        let share = point.volume / volume;
        let tensor = tensor.map(|row| row.map(|own| point.scale * own));
        let pull = apply(&tensor, &normal);
        let through = dot(&pull, &normal);
        resistance += share / through;
        for row in 0..D {
            lead[row] += share * pull[row] / through;
            for column in 0..D {
                along[row][column] +=
                    share * (tensor[row][column] - pull[row] * pull[column] / through);
            }
        }
    }
    for row in 0..D {
        for column in 0..D {
            along[row][column] += lead[row] * lead[column] / resistance;
        }
    }
    Some(along)
}

/// The direction in which the permeability of one soil grows; upwards where it does not.
fn ascent<const D: usize>(points: &[Point<D>]) -> [f64; D] {
    let middle = |weight: &dyn Fn(&Point<D>) -> f64| -> [f64; D] {
        let all: f64 = points.iter().map(weight).sum();
        std::array::from_fn(|axis| {
            let own = points.iter().map(|point| weight(point) * point.x[axis]);
            own.sum::<f64>() / all
        })
    };
    apart(
        middle(&|point| point.volume),
        middle(&|point| point.volume * point.scale),
    )
}

/// The direction from the middle of one soil to that of the others; upwards where they have the same.
fn across<const D: usize>(points: &[Point<D>], first: usize) -> [f64; D] {
    let middle = |is_first: bool| -> [f64; D] {
        let own = || {
            points
                .iter()
                .filter(|point| (point.soil == first) == is_first)
        };
        let volume: f64 = own().map(|point| point.volume).sum();
        std::array::from_fn(|axis| {
            own().map(|point| point.volume * point.x[axis]).sum::<f64>() / volume
        })
    };
    apart(middle(true), middle(false))
}

/// The direction from one place to another; upwards where they are the same.
fn apart<const D: usize>(from: [f64; D], to: [f64; D]) -> [f64; D] {
    let apart: [f64; D] = std::array::from_fn(|axis| to[axis] - from[axis]);
    let length = dot(&apart, &apart).sqrt();
    let size = dot(&from, &from).sqrt() + dot(&to, &to).sqrt();
    if length <= 1e-9 * size {
        let mut up = [0.0; D];
        up[D - 1] = 1.0;
        return up;
    }
    apart.map(|own| own / length)
}

fn is_same(a: f64, b: f64) -> bool {
    (a - b).abs() <= 1e-12 * b
}
