//! The place of a facet that is nearest to a point.

use crate::vectors::{dot, minus, norm};

/// Shares of the corners of a facet in its place nearest to a point, and whether the point lies beyond
/// its edge.
pub(crate) fn closest<const D: usize>(x: &[f64; D], corners: &[[f64; D]; D]) -> ([f64; D], bool) {
    let mut shares = [0.0; D];
    match D {
        2 => {
            let along = minus(&corners[1], &corners[0]);
            let t = dot(&minus(x, &corners[0]), &along) / dot(&along, &along);
            let inside = t.clamp(0.0, 1.0);
            shares[0] = 1.0 - inside;
            shares[1] = inside;
            (shares, (t - inside).abs() > 1e-9)
        }
        3 => {
            let (a, b) = (
                minus(&corners[1], &corners[0]),
                minus(&corners[2], &corners[0]),
            );
            let p = minus(x, &corners[0]);
            let (aa, ab, bb) = (dot(&a, &a), dot(&a, &b), dot(&b, &b));
            let (pa, pb) = (dot(&p, &a), dot(&p, &b));
            let det = aa * bb - ab * ab;
            let (v, w) = ((bb * pa - ab * pb) / det, (aa * pb - ab * pa) / det);
            if v >= -1e-9 && w >= -1e-9 && v + w <= 1.0 + 1e-9 {
                let (v, w) = (v.max(0.0), w.max(0.0));
                shares[0] = (1.0 - v - w).max(0.0);
                shares[1] = v;
                shares[2] = w;
                return (shares, false);
            }
            let mut least = f64::INFINITY;
            for k in 0..3 {
                let (first, last) = (k, (k + 1) % 3);
                let along = minus(&corners[last], &corners[first]);
                let t = dot(&minus(x, &corners[first]), &along) / dot(&along, &along);
                let t = t.clamp(0.0, 1.0);
                let mut on_edge = [0.0; D];
                on_edge[first] = 1.0 - t;
                on_edge[last] = t;
                let length = norm(&minus(x, &combine(corners, &on_edge)));
                if length < least {
                    least = length;
                    shares = on_edge;
                }
            }
            (shares, true)
        }
        _ => unreachable!("bodies stand in the plane or in space"),
    }
}

/// The point with these shares of corners.
pub(crate) fn combine<const D: usize>(corners: &[[f64; D]; D], shares: &[f64; D]) -> [f64; D] {
    std::array::from_fn(|axis| (0..D).map(|k| shares[k] * corners[k][axis]).sum())
}
