//! What a path of equilibria says of its limit: numbers only (theory, eqs. 33e and 33f).

use igimp_solver::StepReport;

use crate::summary::{PathEnd, PathPoint, PathSummary};

/// A step whose work is dissipated by this share moves the body as a mechanism \[-\].
pub(crate) const MECHANISM: f64 = 0.99;

/// The factor rises no longer where it rises by less than this share in a doubling of the work \[-\].
const FLAT: f64 = 1e-3;

/// A factor that has fallen by this share below the largest one is past a limit \[-\].
const FALLEN: f64 = 0.01;

/// Displacement at which a factor that still rises is given up, over γH²/E \[-\].
const FAR: f64 = 100.0;

/// The equilibrium that a step came to: at a factor, after so much work since the beginning, and at a displacement.
pub(crate) fn point(report: &StepReport, factor: f64, work: f64, displacement: f64) -> PathPoint {
    let share = (report.work.as_ref()).map(|work| work.dissipated_share(report.gross_work));
    PathPoint {
        factor,
        work,
        displacement,
        dissipated: share.filter(|share| share.is_finite()).unwrap_or(0.0),
        plastic_share: report.plastic_share,
        iterations: report.iterations,
        in_doubt: report.factor_in_doubt,
    }
}

/// The rise of the factor in the last doubling of the work, as a share of it \[-\]: the factor at half of the work is
/// interpolated over the logarithm of the work. None before the work has doubled once.
pub(crate) fn rise(points: &[PathPoint]) -> Option<f64> {
    let last = points.last()?;
    let half = 0.5 * last.work;
    let after = points.iter().position(|point| point.work >= half)?;
    let (a, b) = (points.get(after.checked_sub(1)?)?, &points[after]);
    let share = (half / a.work).ln() / (b.work / a.work).ln();
    let then = a.factor + share * (b.factor - a.factor);
    (a.work > 0.0).then_some(last.factor / then - 1.0)
}

/// What ends the path at its last point, if anything does. `scale` is γH²/E \[m\], `limit` a displacement at which
/// the body counts as failed \[m\].
pub(crate) fn end(points: &[PathPoint], scale: Option<f64>, limit: Option<f64>) -> Option<PathEnd> {
    let last = points.last()?;
    if limit.is_some_and(|limit| last.displacement > limit) {
        return Some(PathEnd::Displacement);
    }
    let largest = points.iter().map(|point| point.factor).fold(0.0, f64::max);
    if last.factor < (1.0 - FALLEN) * largest {
        return Some(PathEnd::Fallen);
    }
    if last.dissipated >= MECHANISM && rise(points).is_some_and(|rise| rise <= FLAT) {
        return Some(PathEnd::Limit);
    }
    let far = scale.is_some_and(|scale| last.displacement > FAR * scale);
    (far && last.dissipated >= MECHANISM).then_some(PathEnd::StillRising)
}

/// The point from which on the body moves as a mechanism, to the end of the path, interpolated between equilibria.
pub(crate) fn mechanism(points: &[PathPoint]) -> Option<PathPoint> {
    let last_before = points
        .iter()
        .rposition(|point| point.dissipated < MECHANISM);
    let first = last_before.map_or(0, |before| before + 1);
    let after = *points.get(first)?;
    let Some(before) = first.checked_sub(1).map(|k| points[k]) else {
        return Some(after);
    };
    let share = (MECHANISM - before.dissipated) / (after.dissipated - before.dissipated);
    Some(between(&before, &after, share))
}

/// The point at which a displacement was passed, interpolated between equilibria.
pub(crate) fn at_displacement(points: &[PathPoint], displacement: f64) -> Option<PathPoint> {
    let first = (points.iter()).position(|point| point.displacement >= displacement)?;
    let after = points[first];
    let before = match first.checked_sub(1) {
        Some(k) => points[k],
        None => return Some(after),
    };
    let share = (displacement - before.displacement) / (after.displacement - before.displacement);
    Some(between(&before, &after, share))
}

/// A point between two: linear in the share, the work and the displacement in their logarithms.
fn between(a: &PathPoint, b: &PathPoint, share: f64) -> PathPoint {
    let share = share.clamp(0.0, 1.0);
    let linear = |a: f64, b: f64| a + share * (b - a);
    let logarithmic = |a: f64, b: f64| {
        if a > 0.0 && b > 0.0 {
            linear(a.ln(), b.ln()).exp()
        } else {
            linear(a, b)
        }
    };
    PathPoint {
        factor: linear(a.factor, b.factor),
        work: logarithmic(a.work, b.work),
        displacement: logarithmic(a.displacement, b.displacement),
        dissipated: linear(a.dissipated, b.dissipated),
        ..*b
    }
}

/// The knee of a path: the point at which the rise of the factor over doublings of the work falls most.
pub(crate) fn knee(points: &[PathPoint]) -> Option<PathPoint> {
    let rises = |a: &PathPoint, b: &PathPoint| (b.factor - a.factor) / (b.work / a.work).log2();
    let falls = points.windows(3).map(|three| {
        let [a, b, c] = [&three[0], &three[1], &three[2]];
        (rises(a, b) - rises(b, c), *b)
    });
    let finite = falls.filter(|(fall, _)| fall.is_finite());
    let knee = finite.max_by(|(a, _), (b, _)| a.total_cmp(b))?;
    Some(knee.1)
}

/// The interval of the factor at the limit of a path: from the equilibrium that tells it to where it would rise in another doubling of
/// the work, both wider by what the residual leaves in doubt (theory, eq. 33f).
pub(crate) fn interval(path: &PathSummary, limit: Option<f64>) -> (Option<f64>, Option<f64>) {
    let Some(last) = path.points.last() else {
        return (None, None);
    };
    let largest = path
        .points
        .iter()
        .map(|point| point.factor)
        .fold(0.0, f64::max);
    let doubt = path
        .points
        .iter()
        .map(|point| point.in_doubt)
        .fold(0.0, f64::max);
    let rise = path.rise.unwrap_or(0.0).max(0.0);
    let around = |factor: f64, above: f64| {
        (
            Some(factor * (1.0 - doubt)),
            Some(factor * (1.0 + doubt + above)),
        )
    };
    match path.end {
        PathEnd::Limit | PathEnd::Fallen => around(largest, rise),
        PathEnd::StillRising => {
            let mechanism = path.mechanism.map_or(last.factor, |point| point.factor);
            around(mechanism, 0.0)
        }
        PathEnd::Displacement => {
            let limit = limit.unwrap_or(f64::INFINITY);
            let at = at_displacement(&path.points, limit).unwrap_or(*last);
            around(at.factor, 0.0)
        }
        PathEnd::Lost => (Some(last.factor), None),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn point(factor: f64, work: f64, displacement: f64, dissipated: f64) -> PathPoint {
        PathPoint {
            factor,
            work,
            displacement,
            dissipated,
            ..PathPoint::default()
        }
    }

    /// GOAL: λ = 1.5 − 0.5/ω ends where it is flat and a mechanism, and not where it is one of the two.
    /// ORACLE: a rise of 0.5/ω over λ in the doubling to ω, by hand: flat from ω = 333 on.
    #[test]
    fn a_limit_is_flat_and_a_mechanism() {
        let path = |dissipated: f64| -> Vec<PathPoint> {
            (0..12)
                .map(|k| {
                    let work = 2.0_f64.powi(k);
                    point(1.5 - 0.5 / work, work, work, dissipated)
                })
                .collect()
        };
        let ends = |points: &[PathPoint]| {
            (1..=points.len()).find(|&n| end(&points[..n], None, None).is_some())
        };
        let found = ends(&path(0.995)).unwrap();
        let work = path(0.995)[found - 1].work;
        assert!((work - 512.0).abs() < 1e-9, "{work}");
        assert_eq!(end(&path(0.995)[..found], None, None), Some(PathEnd::Limit));
        assert_eq!(ends(&path(0.98)), None);
        let rise = rise(&path(0.995)[..6]).unwrap();
        let last = 1.5 - 0.5 / 32.0;
        let half = 1.5 - 0.5 / 16.0;
        assert!((rise - (last / half - 1.0)).abs() < 1e-14);
    }

    #[test]
    fn a_factor_that_rises_on_and_one_that_falls_are_told_apart() {
        let rising: Vec<PathPoint> = (0..14)
            .map(|k| {
                point(
                    1.0 + 0.02 * f64::from(k),
                    2.0_f64.powi(k),
                    2.0_f64.powi(k),
                    0.995,
                )
            })
            .collect();
        assert_eq!(end(&rising, Some(1.0), None), Some(PathEnd::StillRising));
        assert_eq!(end(&rising[..6], Some(1.0), None), None);
        assert_eq!(
            end(&rising[..6], Some(1.0), Some(20.0)),
            Some(PathEnd::Displacement)
        );
        let mut fallen = rising[..6].to_vec();
        fallen.push(point(1.05, 64.0, 40.0, 0.9));
        assert_eq!(end(&fallen, Some(1.0), None), Some(PathEnd::Fallen));
    }

    #[test]
    fn points_between_are_interpolated() {
        let points = [
            point(1.0, 1.0, 0.01, 0.9),
            point(1.2, 2.0, 0.02, 0.98),
            point(1.25, 4.0, 0.08, 1.0),
        ];
        let mut early = points.to_vec();
        early.insert(0, point(0.9, 0.5, 0.001, 0.995));
        assert_eq!(mechanism(&early), mechanism(&points));
        assert_eq!(mechanism(&points[..2]), None);
        let found = mechanism(&points).unwrap();
        assert!((found.factor - 1.225).abs() < 1e-12);
        assert!((found.displacement - 0.04).abs() < 1e-12);
        let found = at_displacement(&points, 0.05).unwrap();
        assert!((found.factor - 1.225).abs() < 1e-12);
        assert!(at_displacement(&points, 0.1).is_none());
        assert!((knee(&points).unwrap().factor - 1.2).abs() < 1e-12);
    }
}
