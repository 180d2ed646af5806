//! Permeability of a cell that several soils share (theory, eq. 85).

use crate::basis::{apply, dot};
use crate::ground::Point;

/// The tensor of a laminate of the soils of a cell: exact for layers however the grid lies to them; none for one soil.
pub(crate) fn laminate<const D: usize>(
    points: &[Point<D>],
    tensors: &[[[f64; D]; D]],
) -> Option<[[f64; D]; D]> {
    let first = points.first()?.soil;
    if points.iter().all(|point| point.soil == first) {
        return None;
    }
    let normal = across(points, first);
    let volume: f64 = points.iter().map(|point| point.volume).sum();
    let mut along = [[0.0; D]; D];
    let (mut lead, mut resistance) = ([0.0; D], 0.0);
    for point in points {
        let tensor = &tensors[point.soil];
        let share = point.volume / volume;
        let pull = apply(tensor, &normal);
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
    let [from, to] = [middle(true), middle(false)];
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
