//! The three-range formulas of GIMP (theory, eq. 4) on a uniform axis, $`l_p \le h/2`$, away from walls.

use igimp_shape::{Axis, Basis, Gimp};
use proptest::prelude::*;

/// $`(S, S', \bar S)`$ at $`r = x_p - x_i`$.
fn closed_form(r: f64, h: f64, l: f64) -> (f64, f64, f64) {
    let a = r.abs();
    let reach = h + l - a;
    if a < l {
        (1.0 - (r * r + l * l) / (2.0 * h * l), -r / (h * l), 0.5)
    } else if a < h - l {
        (1.0 - a / h, -r.signum() / h, 0.5)
    } else if reach > 0.0 {
        (
            reach * reach / (4.0 * h * l),
            -r.signum() * reach / (2.0 * h * l),
            reach / (4.0 * l),
        )
    } else {
        (0.0, 0.0, 0.0)
    }
}

proptest! {
    #[test]
    fn agrees(
        start in -2.0..2.0,
        h in 0.5..2.0,
        x_local in 0.5..4.5,
        l_local in prop_oneof![0.05..0.5, Just(0.25), Just(0.5)],
    ) {
        let axis = Axis::uniform(start, h, 5).unwrap();
        let (x, l) = (start + x_local * h, l_local * h);
        let mut weights = Vec::new();
        Gimp.axis_weights(&axis, x, l, &mut weights).unwrap();

        let mut listed = weights.iter().peekable();
        for (node, node_x) in axis.nodes().iter().enumerate() {
            let (value, slope, centre) = closed_form(x - node_x, h, l);
            let seen = listed.next_if(|weight| weight.node == node).copied().unwrap_or_default();
            // The formulas divide the round-off of r by l.
            prop_assert!((seen.value - value).abs() < 1e-14 * h / l, "{seen:?} {value}");
            prop_assert!((seen.slope - slope).abs() < 1e-14 / l, "{seen:?} {slope}");
            prop_assert!((seen.centre - centre).abs() < 1e-14 * h / l, "{seen:?} {centre}");
        }
        prop_assert!(listed.next().is_none());
    }
}
