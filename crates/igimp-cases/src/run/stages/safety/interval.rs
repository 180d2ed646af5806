//! Which factor a search tries next.

/// The search goes no further down than this factor \[-\]: with a hundred times its strength a body
/// that falls is one that no strength holds.
const LEAST_FACTOR: f64 = 0.01;

/// The factor to try next between the largest stable and the smallest failed one, at most a stride
/// above the stable one, or beyond; none when the interval is narrow enough.
pub(super) fn next_factor(
    (stable, failed): (Option<f64>, Option<f64>),
    (low, high): (f64, f64),
    tolerance: f64,
    stride: f64,
) -> Option<f64> {
    match (stable, failed) {
        (Some(stable), Some(failed)) if failed - stable <= tolerance * (1.0 + 1e-9) => None,
        (Some(stable), Some(failed)) => Some((stable + stride).min(0.5 * (stable + failed))),
        (Some(stable), None) if stable < low => Some(low),
        (Some(stable), None) if stable < high => Some(high),
        (Some(stable), None) => Some(stable + (high - low)),
        (None, Some(failed)) if failed <= LEAST_FACTOR => None,
        (None, Some(failed)) if low < failed => Some(low),
        (None, Some(failed)) => Some((0.5 * failed).max(LEAST_FACTOR)),
        (None, None) => Some(1.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run::stages::safety::MOST_TRIALS;

    /// The interval and the number of trials for a body that stands below `limit`.
    fn search(limit: f64, bracket: (f64, f64)) -> (Option<f64>, Option<f64>, usize) {
        let (mut stable, mut failed, mut made) = (None, None, 0);
        while let Some(srf) = next_factor((stable, failed), bracket, 0.01, f64::INFINITY) {
            if srf < limit {
                stable = Some(srf);
            } else {
                failed = Some(srf);
            }
            made += 1;
            if made == MOST_TRIALS {
                break;
            }
        }
        (stable, failed, made)
    }

    #[test]
    fn the_interval_holds_the_factor() {
        for limit in [0.2, 0.99, 1.0001, 1.38, 1.99, 5.0] {
            for bracket in [(1.0, 2.0), (1.3, 1.5)] {
                let (stable, failed, made) = search(limit, bracket);
                let (stable, failed) = (stable.unwrap(), failed.unwrap());
                assert!(stable < limit && limit <= failed && failed - stable <= 0.0101);
                assert!(made < 30, "{limit}: {made}");
            }
        }
    }

    #[test]
    fn a_factor_within_the_bracket_is_sought_within_it() {
        let next = |stable| next_factor((stable, None), (1.0, 1.6), 0.01, f64::INFINITY);
        assert_eq!(next(Some(0.8)), Some(1.0));
        assert_eq!(next(Some(1.4)), Some(1.6));
        assert_eq!(next(Some(1.6)), Some(1.6 + (1.6 - 1.0)));
    }

    #[test]
    fn a_search_without_an_end_ends() {
        let (_, failed, made) = search(f64::INFINITY, (1.0, 2.0));
        assert_eq!((failed, made), (None, MOST_TRIALS));
        let (stable, failed, made) = search(0.0, (1.0, 2.0));
        assert_eq!((stable, failed), (None, Some(LEAST_FACTOR)));
        assert!(made < 10, "{made}");
    }
}
