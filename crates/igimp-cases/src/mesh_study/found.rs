//! The results of the runs of a study, side by side.

use igimp_model::{Case, CheckValue, Curve, Driven, Quantity, StageKind, meshes};
use igimp_results::mesh_study::known::{of_check, of_stage};
use igimp_results::mesh_study::{Computed, Convergence, ResultKind, StudyResult, estimate};
use igimp_results::summary::{CheckRow, StageOutcome, StageSummary, Standing, Summary};
use igimp_text::short;

use crate::fallen;

/// A value of a run.
#[derive(Clone, Copy, Debug)]
struct Found {
    value: f64,
    /// Half the width of the interval in which a search left it; 0 where nothing was searched for.
    half_width: f64,
    /// Whether the run ended before it came to the place of the value.
    ended_early: bool,
}

impl Found {
    /// A value that was computed.
    fn computed(value: f64) -> Self {
        Self::within(value, 0.0)
    }

    /// The middle of an interval.
    fn within(value: f64, half_width: f64) -> Self {
        Self {
            value,
            half_width,
            ended_early: false,
        }
    }

    /// The value that a run had reached when it ended early.
    fn on_the_way(value: f64) -> Self {
        Self {
            ended_early: true,
            ..Self::computed(value)
        }
    }
}

/// Factors of safety, limit loads and checks of a case on its meshes, from the summaries of their runs;
/// none for a mesh that has no run.
pub fn study<const D: usize>(case: &Case<D>, runs: &[Option<&Summary>]) -> Vec<StudyResult> {
    let parts = meshes::refinements(case);
    let mut results = Vec::new();
    let mut add = |name: String, kind, known, found: Vec<Option<Found>>, unit| {
        let finite = |found: Option<Found>| found.filter(|found| found.value.is_finite());
        let found: Vec<Option<Found>> = found.into_iter().map(finite).collect();
        if found.iter().any(Option::is_some) {
            let result = result(name, kind, known, &found, &parts);
            results.push(StudyResult { unit, ..result });
        }
    };
    for number in 0..case.stages.len() {
        if let Some((name, kind, known)) = of_stage(case, number) {
            let found = runs.iter().map(|run| at_stage(case, (*run)?, number));
            add(name, kind, known, found.collect(), None);
        }
    }
    let longest = runs.iter().flatten().max_by_key(|run| run.checks.len());
    for (number, row) in longest
        .map_or(&[][..], |run| &run.checks)
        .iter()
        .enumerate()
    {
        let name = &row.check.quantity;
        let found = runs.iter().map(|run| {
            let run = (*run)?;
            let row = nth(&run.checks, name, occurrence(longest?, number))?;
            Some(at_check(case, run, row))
        });
        let known = of_check(case, name);
        let (name, unit) = (name.clone(), row.check.unit.clone());
        add(name, ResultKind::Check, known, found.collect(), unit);
    }
    results
}

/// The checks of a study: each row of the run `of` with the value that the case asks for, and not a number where no run
/// came to it.
pub(crate) fn check_rows<const D: usize>(
    case: &Case<D>,
    of: &Summary,
    results: &[StudyResult],
) -> Vec<CheckRow> {
    let parts = meshes::refinements(case);
    let checks: Vec<&StudyResult> = results
        .iter()
        .filter(|result| result.kind == ResultKind::Check)
        .collect();
    let row = |(number, row): (usize, &CheckRow)| {
        let name = &row.check.quantity;
        let mut named = checks.iter().filter(|result| result.name == *name);
        let result = named.nth(occurrence(of, number));
        let asked = case.checks.iter().find(|check| check.name == *name);
        let mut check = row.check.clone();
        // Values of runs that ended early are held against nothing.
        check.measured = match asked.map_or(CheckValue::Computed, |check| check.value) {
            CheckValue::Computed => {
                let finest = result.and_then(|result| result.finest());
                if let (Some(result), Some((mesh, _))) = (result, finest)
                    && (mesh + 1..parts.len()).any(|finer| result.ended_early(finer))
                {
                    check.variant = format!("on the mesh {}", meshes::label(parts[mesh]));
                }
                finest.map(|(_, value)| value)
            }
            CheckValue::Extrapolated => {
                "extrapolated from the meshes".clone_into(&mut check.variant);
                result.and_then(|result| Some(result.estimate?.value))
            }
        }
        .unwrap_or(f64::NAN);
        let standing = match row.standing {
            Standing::NotReached if !check.measured.is_nan() => Standing::Held,
            standing => standing,
        };
        CheckRow {
            pass: check.passes(),
            check,
            standing,
        }
    };
    of.checks.iter().enumerate().map(row).collect()
}

/// Warnings about the results: values that do not converge as expected, and runs that ended early.
pub(crate) fn remarks<const D: usize>(case: &Case<D>, results: &[StudyResult]) -> Vec<String> {
    let labels: Vec<String> = (meshes::refinements(case).into_iter())
        .map(meshes::label)
        .collect();
    let mut remarks = Vec::new();
    // A check of a result that is told by itself says nothing more.
    let is_twice = |result: &&StudyResult| {
        result.kind == ResultKind::Check
            && results.iter().any(|other| {
                other.kind != ResultKind::Check
                    && other.values == result.values
                    && other.estimate == result.estimate
            })
    };
    let once = results.iter().filter(|result| !is_twice(result));
    for result in once.map(StudyResult::as_printed) {
        for (mesh, label) in labels.iter().enumerate() {
            if let (Some(value), true) = (result.values[mesh], result.ended_early(mesh)) {
                remarks.push(format!(
                    "{}: on the mesh {label} the run ended early, at {}: that is no result, and it is neither \
                     extrapolated nor held in a check",
                    result.name,
                    short(value)
                ));
            }
        }
        let remark = result.estimate.and_then(|found| found.order.remark());
        remarks.extend(remark.map(|remark| format!("{}: {remark}", result.name)));
    }
    remarks
}

fn result(
    name: String,
    kind: ResultKind,
    known: Convergence,
    found: &[Option<Found>],
    parts: &[usize],
) -> StudyResult {
    let points: Vec<Computed> = std::iter::zip(found, parts)
        .filter_map(|(found, &parts)| {
            let found = found.filter(|found| !found.ended_early)?;
            Some(Computed {
                h: 1.0 / parts as f64,
                value: found.value,
                half_width: found.half_width,
            })
        })
        .collect();
    let each = || found.iter();
    StudyResult {
        name,
        kind,
        values: each().map(|found| found.map(|found| found.value)).collect(),
        half_widths: each()
            .map(|found| found.map_or(0.0, |found| found.half_width))
            .collect(),
        early: each()
            .map(|found| found.is_some_and(|found| found.ended_early))
            .collect(),
        estimate: estimate(&points, known),
        unit: None,
    }
}

/// The result of a run at a stage, by the kind of the stage.
fn at_stage<const D: usize>(case: &Case<D>, run: &Summary, number: usize) -> Option<Found> {
    let (stage, summary) = (&case.stages[number], run.stages.get(number)?);
    let found = match &stage.kind {
        StageKind::StrengthReduction(_) => interval(summary),
        StageKind::Displacement { .. } => summary.peak_resistance.map(Found::computed),
        kind => {
            let reached = shares_of(run);
            let driven = Driven::of(kind, |driven| driven.before(case, number, &reached))?;
            limit(case, run, number, driven)
        }
    }?;
    Some(Found {
        ended_early: found.ended_early || has_ended_early(case, run, number),
        ..found
    })
}

/// Whether a stage ended before its end as the case asks, or stands on one that did.
fn has_ended_early<const D: usize>(case: &Case<D>, run: &Summary, number: usize) -> bool {
    let summary = run.stages.get(number);
    summary.is_none_or(|stage| !stage.came_to_its_end()) || stands_on_less(case, run, number)
}

/// Whether a stage began with a body that an earlier one did not bring to its end. A search of a factor of safety leaves
/// the body as it found it, and one that answers a body that fell raises gravity anew.
fn stands_on_less<const D: usize>(case: &Case<D>, run: &Summary, number: usize) -> bool {
    if fallen::answered(case, &run.stages, number).is_some() {
        return false;
    }
    case.stages[number].start_from.is_some_and(|before| {
        if let StageKind::StrengthReduction(_) = case.stages[before].kind {
            stands_on_less(case, run, before)
        } else {
            has_ended_early(case, run, before)
        }
    })
}

/// Middle of the interval of a factor of safety, and half its width (theory, eq. 40g); the largest factor that stands
/// where none failed, or where the search was given up.
fn interval(stage: &StageSummary) -> Option<Found> {
    let safety = stage.safety.as_ref()?;
    let stable = safety.stable?;
    Some(match safety.failed {
        Some(failed) if stage.came_to_its_end() => {
            Found::within(0.5 * (stable + failed), 0.5 * (failed - stable).abs())
        }
        _ => Found::on_the_way(stable),
    })
}

/// The load at which a stage ended before its end. The smallest step that was tried lies beyond it: it
/// counts to either side (theory, eq. 40g).
fn limit<const D: usize>(
    case: &Case<D>,
    run: &Summary,
    number: usize,
    of: Driven,
) -> Option<Found> {
    let (stage, summary) = (&case.stages[number], run.stages.get(number)?);
    if !stage.stop_when.no_equilibrium {
        return None;
    }
    let shares = shares_of(run);
    let reached = of.after(case, number, &shares);
    if summary.outcome != StageOutcome::Stopped || summary.lost {
        return Some(Found::on_the_way(reached));
    }
    let driven = Driven::of(&stage.kind, |driven| driven.before(case, number, &shares));
    let path = summary.path.as_ref().filter(|_| driven == Some(of));
    if let Some(path) = path {
        return Some(match crate::limit::interval(path) {
            (Some(near), Some(far)) => Found::within(0.5 * (near + far), 0.5 * (far - near).abs()),
            _ => Found::on_the_way(reached),
        });
    }
    let from = of.before(case, number, &shares);
    let solver = &case.solver;
    // A displacement is passed in a planned step.
    let cuts = match stage.stop_when.displacement {
        Some(_) => 0,
        None => i32::try_from(solver.cuts).ok()?,
    };
    let smallest = solver.cut_factor.powi(cuts) / stage.steps as f64;
    let whole = (of.aim(&stage.kind)? - from).abs();
    Some(Found::within(reached, smallest * whole))
}

/// The shares of its stages that a run reached \[-\].
fn shares_of(run: &Summary) -> impl Fn(usize) -> f64 {
    |number| run.stages.get(number).map_or(0.0, |stage| stage.reached)
}

/// A check of a run: with the interval of the search that it looks at, and whether the run came to it.
fn at_check<const D: usize>(case: &Case<D>, run: &Summary, row: &CheckRow) -> Found {
    let (name, measured) = (&row.check.quantity, row.check.measured);
    let Some(check) = case.checks.iter().find(|check| check.name == *name) else {
        let at_place = |curve: &&Curve| name.starts_with(&format!("{} at ", curve.name));
        let ended_early = match case.curves.iter().find(at_place) {
            // A curve that came to the place is right there, whatever came after.
            Some(curve) => curve
                .stage
                .is_some_and(|stage| stands_on_less(case, run, stage)),
            None => run.stages.iter().any(|stage| !stage.came_to_its_end()),
        };
        return Found {
            ended_early,
            ..Found::computed(measured)
        };
    };
    let number = check.stage.unwrap_or(case.stages.len().saturating_sub(1));
    let stage = run.stages.get(number);
    let found = match check.of {
        Quantity::FactorOfSafety => stage.and_then(interval),
        of => Driven::recorded_by(of).and_then(|driven| limit(case, run, number, driven)),
    };
    Found {
        value: measured,
        half_width: found.map_or(0.0, |found| found.half_width) / check.divide_by.abs(),
        ended_early: has_ended_early(case, run, number)
            || found.is_some_and(|found| found.ended_early),
    }
}

/// How many rows of the same name stand before a row.
fn occurrence(run: &Summary, number: usize) -> usize {
    let name = &run.checks[number].check.quantity;
    let before = &run.checks[..number];
    before
        .iter()
        .filter(|row| row.check.quantity == *name)
        .count()
}

fn nth<'a>(rows: &'a [CheckRow], name: &str, place: usize) -> Option<&'a CheckRow> {
    let mut named = rows.iter().filter(|row| row.check.quantity == name);
    named.nth(place)
}
