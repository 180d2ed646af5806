//! Permeability of a cell that several soils share, or whose soil varies (theory, eqs. 85 and 85e).

use igimp_shape::matrices::apply;

use crate::basis::{Point, dot};

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
        false => across(points, first).unwrap_or_else(|| flattest(points, first)),
    };
    let volume: f64 = points.iter().map(|point| point.volume).sum();
    let mut along = [[0.0; D]; D];
    let (mut lead, mut resistance) = ([0.0; D], 0.0);
    for point in points {
        let tensor = &tensors[point.soil];
        let share = point.volume / volume;
        let tensor = tensor.map(|row| row.map(|k| point.scale * k));
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
            let terms = points.iter().map(|point| weight(point) * point.x[axis]);
            terms.sum::<f64>() / all
        })
    };
    let (of_volume, of_scale) = (
        middle(&|point| point.volume),
        middle(&|point| point.volume * point.scale),
    );
    direction(points, of_volume, of_scale).unwrap_or_else(up)
}

/// The direction from the middle of one soil to that of the others; none where they have the same.
fn across<const D: usize>(points: &[Point<D>], first: usize) -> Option<[f64; D]> {
    let middle = |is_first: bool| -> [f64; D] {
        let side = || points.iter().filter(|p| (p.soil == first) == is_first);
        let volume: f64 = side().map(|point| point.volume).sum();
        std::array::from_fn(|axis| side().map(|p| p.volume * p.x[axis]).sum::<f64>() / volume)
    };
    direction(points, middle(true), middle(false))
}

/// The direction in which one soil lies in the midst of others: that of the largest difference of their second moments, as of a wall in the
/// middle of its cell; upwards where there is none.
fn flattest<const D: usize>(points: &[Point<D>], first: usize) -> [f64; D] {
    let middle: [f64; D] = {
        let volume: f64 = points.iter().map(|point| point.volume).sum();
        std::array::from_fn(|a| points.iter().map(|p| p.volume * p.x[a]).sum::<f64>() / volume)
    };
    let moment = |is_first: bool, a: usize, b: usize| {
        let side = || points.iter().filter(|p| (p.soil == first) == is_first);
        let volume: f64 = side().map(|point| point.volume).sum();
        let sum: f64 = side()
            .map(|point| point.volume * (point.x[a] - middle[a]) * (point.x[b] - middle[b]))
            .sum();
        sum / volume
    };
    let difference: [[f64; D]; D] =
        std::array::from_fn(|a| std::array::from_fn(|b| moment(true, a, b) - moment(false, a, b)));
    let size: f64 = (0..D)
        .map(|a| moment(true, a, a) + moment(false, a, a))
        .sum();
    let largest = |row: &[f64; D]| row.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
    let Some(mut normal) = (difference.into_iter())
        .filter(|row| largest(row) > 1e-9 * size)
        .max_by(|a, b| largest(a).total_cmp(&largest(b)))
    else {
        return up();
    };
    // The eigenvector of the largest eigenvalue by magnitude.
    for _ in 0..POWERS {
        let next = apply(&difference, &apply(&difference, &normal));
        let length = dot(&next, &next).sqrt();
        normal = next.map(|x| x / length);
    }
    normal
}

/// How often a matrix is applied to find its largest eigenvalue: those of a wall are far apart.
const POWERS: usize = 40;

fn up<const D: usize>() -> [f64; D] {
    let mut up = [0.0; D];
    up[D - 1] = 1.0;
    up
}

/// The direction from one place to another within a cell of these points; none where they are the same.
fn direction<const D: usize>(
    points: &[Point<D>],
    from: [f64; D],
    to: [f64; D],
) -> Option<[f64; D]> {
    let apart: [f64; D] = std::array::from_fn(|axis| to[axis] - from[axis]);
    let length = dot(&apart, &apart).sqrt();
    let size = (points.iter())
        .flat_map(|point| (0..D).map(|axis| (point.x[axis] - from[axis]).abs()))
        .fold(0.0, f64::max);
    (length > 1e-9 * size).then(|| apart.map(|x| x / length))
}

fn is_same(a: f64, b: f64) -> bool {
    (a - b).abs() <= 1e-12 * b
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};

    use super::*;

    /// GOAL: a thin wall in the middle of its cell resists across, whichever way it stands.
    /// ORACLE: permeabilities in series across, side by side along; the soils have one middle.
    #[test]
    fn a_wall_in_the_middle_of_its_cell() {
        for angle in [0.0, 0.5, FRAC_PI_4, 1.2, FRAC_PI_2] {
            let (sin, cos) = angle.sin_cos();
            // Squares of a disc about the middle, whose wall takes a fifth of the way across.
            let points: Vec<Point<2>> = (0..1600)
                .filter_map(|k| {
                    let x = [k % 40, k / 40].map(|k| (f64::from(k) + 0.5) / 20.0 - 1.0);
                    let inside = x[0].hypot(x[1]) < 1.0;
                    let soil = usize::from((x[0] * cos + x[1] * sin).abs() < 0.2);
                    inside.then_some(Point {
                        x,
                        volume: 1.0,
                        soil,
                        body_soil: soil,
                        region: None,
                        scale: 1.0,
                    })
                })
                .collect();
            let even = |k: f64| [[k, 0.0], [0.0, k]];
            let tensor = laminate(&points, &[even(1.0), even(1e-4)]).unwrap();
            let walls = points.iter().filter(|point| point.soil == 1).count() as f64;
            let share = walls / points.len() as f64;
            let series = 1.0 / (share / 1e-4 + 1.0 - share);
            let beside = share * 1e-4 + 1.0 - share;
            let across = dot(&apply(&tensor, &[cos, sin]), &[cos, sin]);
            let along = dot(&apply(&tensor, &[-sin, cos]), &[-sin, cos]);
            assert!(
                (across / series - 1.0).abs() < 0.05,
                "{angle}: {across} {series}"
            );
            assert!(
                (along / beside - 1.0).abs() < 0.01,
                "{angle}: {along} {beside}"
            );
        }
    }
}
