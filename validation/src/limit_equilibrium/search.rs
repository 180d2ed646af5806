//! The search for the weakest slip line: a grid that is drawn together around the best place.

/// Points in each direction of the first grid.
const COARSE: usize = 21;
/// Points in each direction of the grids that follow.
const FINE: usize = 7;
/// Number of grids that follow, each a little more than half as wide.
const ROUNDS: usize = 14;

/// The least value of a function over a box, and where it is; infinite values are no candidates.
pub(crate) fn least(
    value: impl Fn([f64; 3]) -> f64,
    lower: [f64; 3],
    upper: [f64; 3],
) -> (f64, [f64; 3]) {
    let mut best = (f64::INFINITY, lower);
    let (mut from, mut to) = (lower, upper);
    for round in 0..=ROUNDS {
        let points = if round == 0 { COARSE } else { FINE };
        for k in 0..points.pow(3) {
            let place = [k % points, k / points % points, k / points / points];
            let at = std::array::from_fn(|axis| {
                let share = place[axis] as f64 / (points - 1) as f64;
                from[axis] + share * (to[axis] - from[axis])
            });
            let found = value(at);
            if found < best.0 {
                best = (found, at);
            }
        }
        let width = if round == 0 {
            2.0 / (COARSE - 1) as f64
        } else {
            0.3
        };
        for axis in 0..3 {
            let half = width * (to[axis] - from[axis]);
            from[axis] = (best.1[axis] - half).max(lower[axis]);
            to[axis] = (best.1[axis] + half).min(upper[axis]);
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_bottom_of_a_bowl_is_found() {
        let bowl = |x: [f64; 3]| (x[0] - 0.3).powi(2) + (x[1] + 2.0).powi(2) + (x[2] - 7.1).abs();
        let (value, at) = least(bowl, [-5.0; 3], [10.0; 3]);
        assert!(value < 1e-3, "{value} at {at:?}");
    }
}
