//! Holds results of a run against the references of its case.

use igimp_model::check::{Band, Check};
use igimp_model::{Case, CaseCheck, CheckTime, Quantity, Reference, ReferenceValues};
use igimp_results::summary::{CheckRow, NEEDLESS, StageOutcome, StageSummary, Standing};
use igimp_results::tables::table::Table;

use super::moment::Moment;
use super::records::Records;
use super::sections::before_fields;

/// The checks that the case asks for at the end of a stage. On a stage that did not come to its end none is held but
/// those of a factor of safety that was found before.
pub(crate) fn at_end_of_stage<const D: usize>(
    case: &Case<D>,
    records: &Records,
    moment: &Moment<'_, D>,
    is_reached: bool,
) -> Vec<CheckRow> {
    let found = |k: usize, check: &CaseCheck| match check.at {
        CheckTime::End => records.quantity(case, check.of, moment),
        CheckTime::Peak => records.peaks[k],
    };
    of_stage(case, moment.stage, is_reached, &found)
}

/// The checks of a stage that the run did not come to.
pub(crate) fn beyond<const D: usize>(
    case: &Case<D>,
    records: &Records,
    stage: usize,
) -> Vec<CheckRow> {
    let found = |_: usize, check: &CaseCheck| match check.of {
        Quantity::FactorOfSafety => records.factor_of_safety,
        _ => f64::NAN,
    };
    let mut rows = of_stage(case, stage, false, &found);
    let nothing = vec![Table::new("", &[]); case.sections.len()];
    let of_sections = of_sections(case, stage, &nothing, false);
    rows.extend(of_sections.into_iter().map(|(_, row)| row));
    rows
}

/// The checks of quantities at the end of a stage, without values.
pub(super) fn not_held<const D: usize>(case: &Case<D>, stage: usize) -> Vec<CheckRow> {
    of_stage(case, stage, false, &|_, _| f64::NAN)
}

/// A check held against the value of an earlier row, of which its band may be another one; as it is without one.
pub(super) fn held_again(row: CheckRow, earlier: Option<&CheckRow>) -> CheckRow {
    let Some(earlier) = earlier else {
        return row;
    };
    let check = Check {
        measured: earlier.check.measured,
        ..row.check
    };
    if !earlier.is_reached() {
        return CheckRow::not_reached(check);
    }
    CheckRow {
        standing: earlier.standing,
        ..CheckRow::held(check)
    }
}

/// The checks of quantities that the case asks for at a stage, with their numbers.
pub(super) fn asked<const D: usize>(
    case: &Case<D>,
    stage: usize,
) -> impl Iterator<Item = (usize, &CaseCheck)> {
    let last = case.stages.len() - 1;
    let of_stage = move |check: &CaseCheck| check.stage.unwrap_or(last) == stage;
    let checks = case.checks.iter().enumerate();
    checks.filter(move |(_, check)| of_stage(check))
}

/// The checks of a stage with the values that were found.
fn of_stage<const D: usize>(
    case: &Case<D>,
    stage: usize,
    is_reached: bool,
    found: &dyn Fn(usize, &CaseCheck) -> f64,
) -> Vec<CheckRow> {
    asked(case, stage)
        .map(|(k, check)| {
            let value = found(k, check);
            let is_factor = check.of == Quantity::FactorOfSafety;
            let check = Check {
                case: case.title.clone(),
                variant: case.method.label(),
                quantity: check.name.clone(),
                expected: check.expected,
                source: check.source.clone(),
                band: check.band,
                measured: value / check.divide_by,
                unit: check.unit.clone(),
            };
            let is_known = is_factor && value.is_finite();
            if !(is_reached || is_known) {
                return CheckRow::not_reached(check);
            }
            let mut row = CheckRow::held(check);
            if is_factor && value > NEEDLESS {
                row.standing = Standing::NothingFails;
            }
            row
        })
        .collect()
}

/// The checks of curves against their references. A curve that was not recorded misses its own, and the end of one whose
/// stage did not come to its end is held against nothing; so is one without the rows of stages before the first that `since` tells.
pub(crate) fn of_curves<const D: usize>(
    case: &Case<D>,
    tables: &[Table],
    stages: &[StageSummary],
    since: &[usize],
) -> Vec<CheckRow> {
    let mut rows = Vec::new();
    for (k, (curve, table)) in case.curves.iter().zip(tables).enumerate() {
        let Some(reference) = &curve.reference else {
            continue;
        };
        // A run that is taken up reads its rows from files.
        let points = table.as_written().points(0, 1);
        let held = against(case, &curve.name, &points, reference);
        let ran = |stage: usize| stages.get(stage).is_some_and(is_reached);
        let came_to_end = match curve.stage {
            Some(stage) => ran(stage),
            None => (0..case.stages.len()).all(ran),
        };
        let is_of_end = matches!(reference.values, ReferenceValues::Level { at: None, .. });
        let since = since.get(k).copied().unwrap_or(0);
        let is_whole = since <= curve.stage.unwrap_or(0) || (is_of_end && curve.stage.is_none());
        if (is_of_end && !came_to_end) || !is_whole {
            rows.extend(held.into_iter().map(|row| CheckRow::not_reached(row.check)));
        } else {
            rows.extend(held);
        }
    }
    rows
}

/// Whether a stage came so far that its checks are held: it found equilibrium up to its end, or to one that its case plans.
pub(crate) fn is_reached(stage: &StageSummary) -> bool {
    stage.outcome != StageOutcome::NotConverged
}

/// The checks of fields along sections at the end of a stage, with the numbers of those; `tables` are those of the sections.
pub(crate) fn of_sections<const D: usize>(
    case: &Case<D>,
    stage: usize,
    tables: &[Table],
    is_reached: bool,
) -> Vec<(usize, CheckRow)> {
    let mut rows = Vec::new();
    for (k, (section, table)) in case.sections.iter().zip(tables).enumerate() {
        for held in section.references_at(case, stage) {
            let Some(recorded) = section.record.iter().position(|&field| field == held.of) else {
                continue;
            };
            let name = format!("{}, {}", section.name, held.of.name());
            let points = table.points(0, before_fields::<D>() + recorded);
            let checks = against(case, &name, &points, &held.reference).into_iter();
            let row = |row: CheckRow| {
                if is_reached {
                    row
                } else {
                    CheckRow::not_reached(row.check)
                }
            };
            rows.extend(checks.map(|check| (k, row(check))));
        }
    }
    rows
}

/// Points held against a reference; nothing where it is drawn only.
fn against<const D: usize>(
    case: &Case<D>,
    name: &str,
    points: &[[f64; 2]],
    reference: &Reference,
) -> Vec<CheckRow> {
    let Some(tolerance) = reference.tolerance else {
        return Vec::new();
    };
    let check = |quantity: String, expected: f64, measured: f64| {
        CheckRow::held(Check {
            case: case.title.clone(),
            variant: case.method.label(),
            quantity,
            expected,
            source: reference.label.clone(),
            band: Band::Relative(tolerance),
            measured,
            unit: None,
        })
    };
    match &reference.values {
        ReferenceValues::Level { y, at: None } => {
            let last = points.last().map_or(f64::NAN, |point| point[1]);
            vec![check(format!("{name}, end"), *y, last)]
        }
        ReferenceValues::Level { y, at: Some(x) } => {
            let measured = at(points, *x).unwrap_or(f64::NAN);
            vec![check(format!("{name} at {x}"), *y, measured)]
        }
        ReferenceValues::Points(expected) => {
            let held =
                |&[x, y]: &[f64; 2]| Some(check(format!("{name} at {x}"), y, at(points, x)?));
            let rows: Vec<CheckRow> = expected.iter().filter_map(held).collect();
            match expected.first() {
                // Points beyond the curve hold nothing, but a curve that comes to none of them misses them.
                Some([x, y]) if rows.is_empty() => {
                    vec![check(format!("{name} at {x}"), *y, f64::NAN)]
                }
                _ => rows,
            }
        }
    }
}

/// The ordinate of a curve where it first passes an abscissa, linear between points.
pub(crate) fn at(points: &[[f64; 2]], x: f64) -> Option<f64> {
    let near = 1e-9 * x.abs().max(1e-12);
    if let Some(point) = points.iter().find(|point| (point[0] - x).abs() <= near) {
        return Some(point[1]);
    }
    points
        .windows(2)
        .find(|pair| (pair[0][0] - x) * (pair[1][0] - x) < 0.0)
        .map(|pair| {
            let t = (x - pair[0][0]) / (pair[1][0] - pair[0][0]);
            pair[0][1] + t * (pair[1][1] - pair[0][1])
        })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture::case;

    /// GOAL: a reference of points is missed by a curve that comes to none of them, as a level is at such a place.
    /// ORACLE: by hand: one row that is not a number and not met; of points that it comes to, one each.
    #[test]
    fn a_curve_that_comes_to_no_point_of_its_reference_misses_it() {
        let case = case();
        let rows = |values: ReferenceValues, tolerance: Option<f64>| {
            let reference = Reference {
                label: "by hand".into(),
                values,
                tolerance,
            };
            against(&case, "c", &[[0.0, 0.0], [1.0, 2.0]], &reference)
        };
        let points = |points: &[[f64; 2]]| ReferenceValues::Points(points.to_vec());
        let level = ReferenceValues::Level {
            y: 4.0,
            at: Some(2.0),
        };
        for values in [points(&[[2.0, 4.0], [3.0, 6.0]]), level] {
            let [row] = &rows(values, Some(0.1))[..] else {
                panic!("one row");
            };
            assert!(!row.pass && row.check.measured.is_nan());
            assert_eq!(row.check.quantity, "c at 2");
        }
        let met = rows(points(&[[0.5, 1.0], [1.0, 2.0], [3.0, 6.0]]), Some(0.1));
        assert!(met.len() == 2 && met.iter().all(|row| row.pass));
        assert!(rows(points(&[[2.0, 4.0]]), None).is_empty());
    }

    #[test]
    fn a_curve_is_read_where_it_first_passes() {
        let curve = [[0.0, 1.0], [2.0, 3.0], [1.0, 10.0]];
        assert_eq!(at(&curve, 1.0), Some(10.0));
        assert_eq!(at(&curve, 0.5), Some(1.5));
        assert_eq!(at(&curve, 2.0), Some(3.0));
        assert_eq!(at(&curve, 2.1), None);
    }
}
