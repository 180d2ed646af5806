//! What a path of equilibria says of its limit: numbers only (theory, eqs. 33e and 33f).

use igimp_results::ending::PathEnd;
use igimp_results::summary::{PathPoint, PathSummary};
use igimp_solver::{MECHANISM, StepReport};

/// The factor rises no longer where it changes by less than this share in a doubling of the work \[-\].
const FLAT: f64 = 1e-3;

/// Work up to which a mechanism whose factor still rises is followed, over that at which it began \[-\].
const FOLLOWED: f64 = 4.0;

/// A mechanism whose factor changes by more than this share in a doubling of the work is followed further \[-\]: the skin of
/// a slope may slide long before the slope does.
const STEEP: f64 = 1e-2;

/// A factor that has fallen by this share below the largest one is past a limit \[-\].
const FALLEN: f64 = 0.03;

/// The same where the path is lost behind it \[-\].
const FALLEN_AND_LOST: f64 = 0.01;

/// The equilibrium of the largest factor of a path that is lost behind it: the factor has fallen since.
pub(crate) fn lost_past(points: &[PathPoint]) -> Option<PathPoint> {
    let last = points.last()?;
    let largest = (points.iter().copied()).max_by(|a, b| a.factor.total_cmp(&b.factor))?;
    (last.factor < (1.0 - FALLEN_AND_LOST) * largest.factor).then_some(largest)
}

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

/// What ends the path at its last point, if anything does: why, and the equilibrium that tells the factor. `limit` is a
/// displacement at which the body counts as failed \[m\].
pub(crate) fn end(points: &[PathPoint], limit: Option<f64>) -> Option<(PathEnd, PathPoint)> {
    let last = points.last()?;
    if let Some(limit) = limit.filter(|&limit| last.displacement > limit) {
        return Some((PathEnd::Displacement, at_displacement(points, limit)?));
    }
    let largest = points
        .iter()
        .copied()
        .max_by(|a, b| a.factor.total_cmp(&b.factor))?;
    if last.factor < (1.0 - FALLEN) * largest.factor {
        return Some((PathEnd::Fallen, largest));
    }
    let begun = mechanism(points)?.work;
    let ends_at = |work: f64| {
        let changed = change(points, work).filter(|_| work >= 2.0 * begun)?;
        if changed <= FLAT {
            Some(PathEnd::Limit)
        } else if work >= FOLLOWED * begun && changed <= STEEP {
            Some(PathEnd::StillRising)
        } else {
            None
        }
    };
    ends_at(last.work)?;
    // Between the last two equilibria, so that the answer does not go by steps.
    let mut before = points[points.len().checked_sub(2)?].work;
    let mut after = last.work;
    if ends_at(before).is_some() {
        after = before;
    }
    while after > (1.0 + 1e-12) * before {
        let middle = (before * after).sqrt();
        if ends_at(middle).is_some() {
            after = middle;
        } else {
            before = middle;
        }
    }
    Some((ends_at(after)?, at_work(points, after)?))
}

/// The change of the factor in the doubling of the work that ends at `work`, as a share of it: the largest over the least of
/// the doubling, less 1 \[-\]. None before the work has doubled once.
fn change(points: &[PathPoint], work: f64) -> Option<f64> {
    let ends = [at_work(points, 0.5 * work)?, at_work(points, work)?];
    let within = points
        .iter()
        .filter(|point| point.work > 0.5 * work && point.work < work);
    let factors = ends.iter().chain(within).map(|point| point.factor);
    let (least, most) = factors.fold((f64::INFINITY, 0.0_f64), |(least, most), factor| {
        (least.min(factor), most.max(factor))
    });
    Some(most / least - 1.0)
}

/// The rise of the factor in the doubling of the work that ends at a point, as a share of it \[-\]. None before the work
/// has doubled once.
pub(crate) fn rise(points: &[PathPoint], at: &PathPoint) -> Option<f64> {
    let half = at_work(points, 0.5 * at.work)?;
    Some(at.factor / half.factor - 1.0)
}

/// The point at which so much work was done, interpolated over the logarithm of the work.
fn at_work(points: &[PathPoint], work: f64) -> Option<PathPoint> {
    let after = points.iter().position(|point| point.work >= work)?;
    let (a, b) = (points.get(after.checked_sub(1)?)?, &points[after]);
    let share = (work / a.work).ln() / (b.work / a.work).ln();
    (a.work > 0.0).then(|| between(a, b, share))
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
    Some(PathPoint {
        displacement,
        ..between(&before, &after, share)
    })
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

/// The interval of the factor that a path tells: from the largest up to the equilibrium that tells it, to where it would
/// rise in another doubling of the work, both wider by what the residual leaves in doubt (theory, eq. 33f).
pub(crate) fn interval(path: &PathSummary) -> (Option<f64>, Option<f64>) {
    let Some(last) = path.points.last() else {
        return (None, None);
    };
    let Some(limit) = path.limit else {
        return (Some(last.factor), None);
    };
    let up_to = path.points.iter().filter(|point| point.work <= limit.work);
    let factor = up_to.fold(limit.factor, |most, point| most.max(point.factor));
    let doubts = path.points.iter().map(|point| point.in_doubt);
    let doubt = doubts.fold(0.0, f64::max);
    let rise = match path.end {
        PathEnd::Displacement | PathEnd::Fallen => 0.0,
        _ => path.rise.unwrap_or(0.0).max(0.0),
    };
    let factor = if path.end == PathEnd::Displacement {
        limit.factor
    } else {
        factor
    };
    (
        Some(factor * (1.0 - doubt)),
        Some(factor * (1.0 + doubt + rise)),
    )
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

    /// λ = 1.5 − 0.5/ω at works 1, 2, 4, ...
    fn rises_to_a_limit(dissipated: f64) -> Vec<PathPoint> {
        (0..12)
            .map(|k| {
                let work = 2.0_f64.powi(k);
                point(1.5 - 0.5 / work, work, work, dissipated)
            })
            .collect()
    }

    fn first_end(points: &[PathPoint]) -> Option<(usize, PathEnd, PathPoint)> {
        (1..=points.len()).find_map(|n| {
            let (end, limit) = end(&points[..n], None)?;
            Some((n, end, limit))
        })
    }

    /// GOAL: a path ends where it is a mechanism and flat, and not where it is one of the two.
    /// ORACLE: λ rises by 0.5/ω over λ in the doubling to ω, by hand: by 1.3e-3 in that to 256, and by 6.5e-4 in that to 512.
    #[test]
    fn a_limit_is_flat_and_a_mechanism() {
        let mut points = rises_to_a_limit(0.995);
        for point in &mut points[..8] {
            point.dissipated = 0.5;
        }
        points[7].dissipated = 0.99 - 1e-9;
        let (n, end, limit) = first_end(&points).unwrap();
        assert_eq!((n, end), (10, PathEnd::Limit));
        assert!(limit.work > 256.0 && limit.work < 512.0, "{}", limit.work);
        assert_eq!(
            first_end(&rises_to_a_limit(0.98)).map(|found| found.1),
            None
        );
        let found = rise(&points[..6], &points[5]).unwrap();
        let exact = (1.5 - 0.5 / 32.0) / (1.5 - 0.5 / 16.0) - 1.0;
        assert!((found - exact).abs() < 1e-14);
    }

    /// GOAL: the equilibrium that tells the factor does not go by steps.
    /// ORACLE: the same path with twice as many points; interpolation errs by the curvature of a doubling.
    #[test]
    fn other_steps_tell_the_same_factor() {
        let path = |per_doubling: i32| -> Vec<PathPoint> {
            (0..16 * per_doubling)
                .map(|k| {
                    let work = 2.0_f64.powf(f64::from(k) / f64::from(per_doubling));
                    point(1.5 - 0.05 / work, work, work, 1.0 - 0.1 / work)
                })
                .collect()
        };
        let factors = [1, 2, 5].map(|per| first_end(&path(per)).unwrap().2.factor);
        for factor in factors {
            assert!((factor / factors[2] - 1.0).abs() < 2e-4, "{factors:?}");
        }
    }

    #[test]
    fn a_factor_that_rises_on_and_one_that_falls_are_told_apart() {
        let rising: Vec<PathPoint> = (0..14)
            .map(|k| {
                let work = 2.0_f64.powi(k);
                let dissipated = if k < 3 { 0.985 } else { 0.995 };
                point(1.0 + 0.005 * f64::from(k), work, work, dissipated)
            })
            .collect();
        // 0.99 is passed at the middle of ω = 4 and 8: four times that is 2^4.5.
        let (n, found, limit) = first_end(&rising).unwrap();
        assert_eq!((n, found), (6, PathEnd::StillRising));
        assert!(
            (limit.work - 2.0_f64.powf(4.5)).abs() < 1e-6,
            "{}",
            limit.work
        );
        assert!((limit.factor - 1.0225).abs() < 1e-9);
        let (found, limit) = end(&rising[..6], Some(20.0)).unwrap();
        assert_eq!(found, PathEnd::Displacement);
        assert!((limit.displacement - 20.0).abs() < 1e-9);
        // A mechanism of the skin: its factor rises by 2 % in a doubling.
        let steep: Vec<PathPoint> = (0..14)
            .map(|k| {
                let work = 2.0_f64.powi(k);
                point(1.0 + 0.02 * f64::from(k), work, work, 0.995)
            })
            .collect();
        assert_eq!(first_end(&steep).map(|found| found.1), None);
        let mut fallen = steep[..6].to_vec();
        fallen.push(point(1.05, 64.0, 40.0, 0.9));
        let (found, limit) = end(&fallen, None).unwrap();
        assert_eq!((found, limit.factor), (PathEnd::Fallen, 1.1));
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
