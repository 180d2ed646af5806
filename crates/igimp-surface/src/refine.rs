//! Triangles: polygons cut into them, and those that are too large divided.

use std::collections::BTreeMap;

use crate::SurfaceError;
use crate::vectors::{minus, norm};

/// Divides the edges of triangles until none is longer than a length; triangles that share an edge share its
/// middle. Returns the triangles with the number of the one that they come from.
pub(crate) fn divided(
    points: &mut Vec<[f64; 3]>,
    triangles: Vec<[usize; 3]>,
    longest: f64,
) -> Vec<([usize; 3], usize)> {
    let mut all: Vec<([usize; 3], usize)> = triangles.into_iter().zip(0..).collect();
    loop {
        let mut middles: BTreeMap<(usize, usize), usize> = BTreeMap::new();
        for (corners, _) in &all {
            for k in 0..3 {
                let (a, b) = (corners[k], corners[(k + 1) % 3]);
                let key = (a.min(b), a.max(b));
                let (p, q) = (points[key.0], points[key.1]);
                if norm(&minus(&p, &q)) > longest {
                    middles.entry(key).or_insert_with(|| {
                        points.push(std::array::from_fn(|axis| 0.5 * (p[axis] + q[axis])));
                        points.len() - 1
                    });
                }
            }
        }
        if middles.is_empty() {
            return all;
        }
        let mut next = Vec::with_capacity(2 * all.len());
        for (corners, of) in all {
            let middle = |k: usize| {
                let (a, b) = (corners[k], corners[(k + 1) % 3]);
                middles.get(&(a.min(b), a.max(b))).copied()
            };
            let parts = parts(points, corners, [middle(0), middle(1), middle(2)]);
            next.extend(parts.into_iter().map(|part| (part, of)));
        }
        all = next;
    }
}

/// The parts of a triangle some of whose edges (from the corner of the same number) have a middle.
fn parts(points: &[[f64; 3]], corners: [usize; 3], middles: [Option<usize>; 3]) -> Vec<[usize; 3]> {
    let turned = |by: usize| {
        let at = |k: usize| corners[(k + by) % 3];
        [at(0), at(1), at(2)]
    };
    match middles {
        [None, None, None] => vec![corners],
        [Some(p), Some(q), Some(r)] => {
            let [a, b, c] = corners;
            vec![[a, p, r], [p, b, q], [r, q, c], [p, q, r]]
        }
        [Some(_), None, None] | [None, Some(_), None] | [None, None, Some(_)] => {
            let by = middles.iter().position(Option::is_some).unwrap_or(0);
            let [a, b, c] = turned(by);
            let p = middles[by].unwrap_or(a);
            vec![[a, p, c], [p, b, c]]
        }
        _ => {
            // Edges ab and bc have middles, ca has none; the quadrilateral is cut along its shorter diagonal.
            let none = middles.iter().position(Option::is_none).unwrap_or(0);
            let [a, b, c] = turned(none + 1);
            let p = middles[(none + 1) % 3].unwrap_or(a);
            let q = middles[(none + 2) % 3].unwrap_or(b);
            let length = |a: usize, b: usize| norm(&minus(&points[a], &points[b]));
            let mut out = vec![[p, b, q]];
            if length(a, q) <= length(p, c) {
                out.extend([[a, p, q], [a, q, c]]);
            } else {
                out.extend([[a, p, c], [p, q, c]]);
            }
            out
        }
    }
}

/// A polygon with its corners anticlockwise, cut into triangles.
pub(crate) fn triangulated(corners: &[[f64; 2]]) -> Result<Vec<[usize; 3]>, SurfaceError> {
    let mut left: Vec<usize> = (0..corners.len()).collect();
    let mut out = Vec::new();
    let turn = |a: usize, b: usize, c: usize| {
        let [a, b, c] = [a, b, c].map(|k| corners[k]);
        (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
    };
    while left.len() > 3 {
        let n = left.len();
        let is_ear = |k: &usize| {
            let [a, b, c] = [left[(k + n - 1) % n], left[*k], left[(k + 1) % n]];
            let others = left.iter().filter(|other| ![a, b, c].contains(other));
            turn(a, b, c) > 0.0
                && others
                    .into_iter()
                    .all(|&p| turn(a, b, p) < 0.0 || turn(b, c, p) < 0.0 || turn(c, a, p) < 0.0)
        };
        // Of all ears the least sharp one.
        let sharpness = |k: usize| {
            let [a, b, c] = [left[(k + n - 1) % n], left[k], left[(k + 1) % n]];
            let edge = |a: usize, b: usize| {
                (corners[a][0] - corners[b][0]).hypot(corners[a][1] - corners[b][1])
            };
            turn(a, b, c) / edge(a, b).max(edge(b, c)).max(edge(c, a)).powi(2)
        };
        let ear = (0..n)
            .filter(is_ear)
            .max_by(|&a, &b| sharpness(a).total_cmp(&sharpness(b)).then(b.cmp(&a)));
        let ear = ear.ok_or(SurfaceError::Crossing)?;
        out.push([left[(ear + n - 1) % n], left[ear], left[(ear + 1) % n]]);
        left.remove(ear);
    }
    let [a, b, c] = [left[0], left[1], left[2]];
    if turn(a, b, c) > 0.0 {
        out.push([a, b, c]);
    }
    Ok(out)
}
