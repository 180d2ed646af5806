//! The limit of a path of equilibria: numbers only (theory, eqs. 33e and 33f).

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

/// A factor that has gone back by this share is told as that \[-\]: less is not seen in four digits.
const GONE_BACK: f64 = 1e-4;

/// The way of a factor in its stage: where it begins, and to which side it goes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Course {
    /// The factor at the beginning of the stage \[-\].
    from: f64,
    /// 1 of a factor that rises, −1 of one that falls.
    side: f64,
}

impl Course {
    /// A factor that rises from zero.
    pub(crate) const RISING: Self = Self {
        from: 0.0,
        side: 1.0,
    };

    /// The way from a factor to another.
    pub(crate) fn between(from: f64, to: f64) -> Self {
        let side = if to < from { -1.0 } else { 1.0 };
        Self { from, side }
    }

    /// The way that a path went.
    fn of(path: &PathSummary) -> Self {
        (path.points.last()).map_or(Self::RISING, |last| Self::between(path.from, last.factor))
    }

    /// How much further a factor is on the way than another \[-\].
    fn beyond(self, factor: f64, other: f64) -> f64 {
        self.side * (factor - other)
    }

    /// The scale of changes of the factor: its size, or its way so far where it passes zero \[-\].
    fn scale(self, factor: f64) -> f64 {
        factor.abs().max((factor - self.from).abs())
    }

    /// The equilibrium that is furthest on the way.
    fn furthest(self, points: &[PathPoint]) -> Option<PathPoint> {
        let order = |a: &PathPoint, b: &PathPoint| self.beyond(a.factor, b.factor).total_cmp(&0.0);
        points.iter().copied().max_by(order)
    }

    /// Whether a factor has gone back behind another by more than a share of it.
    fn is_behind(self, factor: f64, other: f64, share: f64) -> bool {
        self.beyond(other, factor) > share * self.scale(other)
    }
}

/// The equilibrium of the largest factor of a path that is lost behind it: the factor has fallen since.
pub(crate) fn lost_past(points: &[PathPoint]) -> Option<PathPoint> {
    let last = points.last()?;
    let largest = Course::RISING.furthest(points)?;
    Course::RISING
        .is_behind(last.factor, largest.factor, FALLEN_AND_LOST)
        .then_some(largest)
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

/// The end of the path at its last point, if it ends there: why, and the equilibrium with its factor. `limit` is a
/// displacement at which the body counts as failed \[m\].
pub(crate) fn end(
    points: &[PathPoint],
    course: Course,
    limit: Option<f64>,
) -> Option<(PathEnd, PathPoint)> {
    let last = points.last()?;
    if let Some(limit) = limit.filter(|&limit| last.displacement > limit) {
        return Some((PathEnd::Displacement, at_displacement(points, limit)?));
    }
    let furthest = course.furthest(points)?;
    if course.is_behind(last.factor, furthest.factor, FALLEN) {
        return Some((PathEnd::Fallen, furthest));
    }
    let begun = mechanism(points)?.work;
    let ends_at = |work: f64| {
        let changed = change(points, course, work).filter(|_| work >= 2.0 * begun)?;
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

/// The change of the factor in the doubling of the work that ends at `work`, as a share of it: the largest less the least of
/// the doubling \[-\]. None before the work has doubled once.
fn change(points: &[PathPoint], course: Course, work: f64) -> Option<f64> {
    let ends = [at_work(points, 0.5 * work)?, at_work(points, work)?];
    let within = points
        .iter()
        .filter(|point| point.work > 0.5 * work && point.work < work);
    let factors = ends.iter().chain(within).map(|point| point.factor);
    let none = (f64::INFINITY, f64::NEG_INFINITY);
    let (least, most) = factors.fold(none, |(least, most), factor| {
        (least.min(factor), most.max(factor))
    });
    Some((most - least) / course.scale(least).min(course.scale(most)))
}

/// How far the factor goes on its way in the doubling of the work that ends at a point, as a share of it \[-\]. None before
/// the work has doubled once.
pub(crate) fn rise(points: &[PathPoint], course: Course, at: &PathPoint) -> Option<f64> {
    let half = at_work(points, 0.5 * at.work)?;
    Some(course.beyond(at.factor, half.factor) / course.scale(half.factor))
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
pub(crate) fn knee(points: &[PathPoint], course: Course) -> Option<PathPoint> {
    let rises =
        |a: &PathPoint, b: &PathPoint| course.beyond(b.factor, a.factor) / (b.work / a.work).log2();
    let falls = points.windows(3).map(|three| {
        let [a, b, c] = [&three[0], &three[1], &three[2]];
        (rises(a, b) - rises(b, c), *b)
    });
    let finite = falls.filter(|(fall, _)| fall.is_finite());
    let knee = finite.max_by(|(a, _), (b, _)| a.total_cmp(b))?;
    Some(knee.1)
}

/// The furthest equilibrium of a path up to the one that tells the factor.
fn furthest_up_to(path: &PathSummary, limit: &PathPoint) -> PathPoint {
    let course = Course::of(path);
    let up_to = path.points.iter().filter(|point| point.work <= limit.work);
    up_to.fold(*limit, |most, point| {
        if course.beyond(point.factor, most.factor) > 0.0 {
            *point
        } else {
            most
        }
    })
}

/// The furthest equilibrium of a path up to the one that tells the factor, where the factor has gone back from it since.
pub(crate) fn gone_back_from(path: &PathSummary, limit: &PathPoint) -> Option<PathPoint> {
    let most = furthest_up_to(path, limit);
    Course::of(path)
        .is_behind(limit.factor, most.factor, GONE_BACK)
        .then_some(most)
}

/// By how much a peak between equilibria may lie above the largest of them, as a share of it \[-\]: a path that bends one way lies below
/// the chords beside, carried on.
fn above_peak(points: &[PathPoint], course: Course) -> f64 {
    let order = |a: &usize, b: &usize| {
        course
            .beyond(points[*a].factor, points[*b].factor)
            .total_cmp(&0.0)
    };
    let Some(at) = (0..points.len()).max_by(order) else {
        return 0.0;
    };
    let (Some(before), Some(after)) = (at.checked_sub(1).map(|k| points[k]), points.get(at + 1))
    else {
        return 0.0;
    };
    let peak = points[at];
    let [rise, fall] = [before, *after].map(|point| course.beyond(peak.factor, point.factor));
    let (to, from) = (peak.work - before.work, after.work - peak.work);
    let above = if to > 0.0 && from > 0.0 {
        (rise * from / to).max(fall * to / from)
    } else {
        // A step without work has no chord: the peak is known to the step that came to it.
        rise
    };
    above / course.scale(peak.factor)
}

/// The interval of the factor that a path tells: from the furthest up to the equilibrium that tells it, to where it would
/// go in another doubling of the work, both wider by what the residual leaves in doubt (theory, eq. 33f). Of a factor that
/// falls the first is the larger one.
pub(crate) fn interval(path: &PathSummary) -> (Option<f64>, Option<f64>) {
    let Some(last) = path.points.last() else {
        return (None, None);
    };
    let Some(limit) = path.limit else {
        return (Some(last.factor), None);
    };
    let course = Course::of(path);
    let factor = furthest_up_to(path, &limit).factor;
    let doubts = path.points.iter().map(|point| point.in_doubt);
    let doubt = doubts.fold(0.0, f64::max);
    let rise = match path.end {
        PathEnd::Displacement => 0.0,
        PathEnd::Fallen => above_peak(&path.points, course),
        _ => path.rise.unwrap_or(0.0).max(0.0),
    };
    let factor = if path.end == PathEnd::Displacement {
        limit.factor
    } else {
        factor
    };
    let unit = course.side * course.scale(factor);
    (
        Some(factor - unit * doubt),
        Some(factor + unit * (doubt + rise)),
    )
}

#[cfg(test)]
#[path = "limit_tests.rs"]
mod tests;
