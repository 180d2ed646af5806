//! Remarks on the path of equilibria of a search.

use igimp_results::ending::PathEnd;
use igimp_results::summary::{PathPoint, PathSummary};
use igimp_text::short;

use crate::limit;

/// A path goes no further than this factor \[-\]: with a thousandth of its strength a body that stands is one that needs none.
pub(super) const MOST_FACTOR: f64 = 1000.0;

/// A mechanism whose factor lies this share below that of the limit is worth a remark \[-\].
const APART: f64 = 5e-3;

/// Remarks on a path.
pub(super) fn of(path: &PathSummary) -> Vec<String> {
    let mut remarks = Vec::new();
    let Some(last) = path.points.last() else {
        remarks.push(
            "no equilibrium was found, whatever the strength: this tells nothing of the factor of safety".to_owned(),
        );
        return remarks;
    };
    if last.factor < 1.0 {
        remarks.push(
            "the body does not stand at full strength: the factor of safety is below 1".to_owned(),
        );
    }
    if last.factor >= MOST_FACTOR && path.limit.is_none() {
        remarks.push(format!(
            "nothing fails: the body still stands with a thousandth of its strength, at a factor of {}, and no larger one was tried; \
             what `materials` names decides nothing here",
            short(last.factor)
        ));
        return remarks;
    }
    let Some(mechanism) = path.mechanism else {
        return remarks;
    };
    let text =
        |point: &PathPoint| format!("{:.4} at {} m", point.factor, short(point.displacement));
    let limit = path.limit.unwrap_or(*last);
    if path.end == PathEnd::StillRising {
        let since = match limit::gone_back_from(path, &limit) {
            Some(largest) => format!(
                "the factor has fallen since on the given geometry: the value reported is the largest, {}, and after four times the work it is {}",
                text(&largest),
                text(&limit)
            ),
            None => format!(
                "the factor still rises on the given geometry: the value reported is that after four times the work, {}, and the last \
                 doubling of the work brought {} %",
                text(&limit),
                short(100.0 * path.rise.unwrap_or(0.0))
            ),
        };
        remarks.push(format!(
            "the body moves as a mechanism from {} on, and {since}",
            text(&mechanism)
        ));
    } else if limit.factor > (1.0 + APART) * mechanism.factor {
        remarks.push(format!(
            "the body moves as a mechanism from {} on, and the factor rises no longer from {}",
            text(&mechanism),
            text(&limit)
        ));
    }
    remarks
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::limit::{Course, rise};

    /// A path at works 1, 2, 4, ..., a mechanism throughout, that ends four times past its first equilibrium.
    fn path(factors: [f64; 4]) -> PathSummary {
        let points: Vec<PathPoint> = std::iter::zip(0.., factors)
            .map(|(k, factor)| PathPoint {
                factor,
                work: 2.0_f64.powi(k),
                displacement: 0.01 * 2.0_f64.powi(k),
                dissipated: 0.995,
                ..PathPoint::default()
            })
            .collect();
        PathSummary {
            end: PathEnd::StillRising,
            mechanism: points.first().copied(),
            limit: points.last().copied(),
            rise: rise(&points, Course::RISING, &points[3]),
            points,
            ..PathSummary::default()
        }
    }

    /// GOAL: the remark says which equilibrium is reported, and whether the factor rose or fell to the last one.
    /// ORACLE: the interval of the same path: the largest factor of the way is told, by hand 1.05 rising and 1.02 falling.
    #[test]
    fn a_factor_that_falls_is_not_said_to_rise() {
        let rising = path([1.01, 1.02, 1.035, 1.05]);
        let lines = of(&rising);
        assert_eq!(limit::interval(&rising).0, Some(1.05));
        assert!(lines[0].contains("the factor still rises"), "{lines:?}");
        assert!(lines[0].contains("four times the work, 1.0500 at 0.08 m"));
        // It falls by 1.5 % and rises by 0.2 % in the last doubling.
        let falling = path([1.02, 1.01, 1.005, 1.007]);
        let lines = of(&falling);
        assert_eq!(limit::interval(&falling).0, Some(1.02));
        assert!(!lines[0].contains("rises"), "{lines:?}");
        assert!(
            lines[0].contains("the value reported is the largest, 1.0200 at 0.01 m, and after four times the work it is 1.0070 at 0.08 m"),
            "{lines:?}"
        );
    }
}
