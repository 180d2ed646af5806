//! What the runs of a study found, side by side.

use super::{Computed, ResultKind, StudyResult, estimate, plan};
use crate::case::{Case, CheckValue, Quantity, Stage, StageKind};
use crate::summary::{CheckRow, StageOutcome, StageSummary, Summary};

/// A value and half the width of the interval in which a search left it.
type Found = (f64, f64);

/// Factors of safety, limit loads and checks of a case on its meshes, from the summaries of their runs;
/// none for a mesh that has no run.
pub fn study<const D: usize>(case: &Case<D>, runs: &[Option<&Summary>]) -> Vec<StudyResult> {
    let parts = plan::refinements(case);
    let mut results = Vec::new();
    let mut add = |name: String, kind, found: Vec<Option<Found>>| {
        let finite = |found: Option<Found>| found.filter(|(value, _)| value.is_finite());
        let found: Vec<Option<Found>> = found.into_iter().map(finite).collect();
        if found.iter().any(Option::is_some) {
            results.push(result(name, kind, &found, &parts));
        }
    };
    for number in 0..case.stages.len() {
        if let Some((name, kind)) = of_stage(case, number) {
            let found = runs.iter().map(|run| at_stage(case, (*run)?, number));
            add(name, kind, found.collect());
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
            let measured = nth(&run.checks, name, occurrence(longest?, number))?;
            Some((measured.check.measured, width_of_check(case, run, name)))
        });
        add(name.clone(), ResultKind::Check, found.collect());
    }
    results
}

/// The checks of a study: each row of the run `of` with the value that the case asks for.
pub(crate) fn check_rows<const D: usize>(
    case: &Case<D>,
    of: &Summary,
    results: &[StudyResult],
) -> Vec<CheckRow> {
    let checks: Vec<&StudyResult> = results
        .iter()
        .filter(|result| result.kind == ResultKind::Check)
        .collect();
    let row = |(number, row): (usize, &CheckRow)| {
        let name = &row.check.quantity;
        let mut own = checks.iter().filter(|result| result.name == *name);
        let result = own.nth(occurrence(of, number));
        let asked = case.checks.iter().find(|check| check.name == *name);
        let mut check = row.check.clone();
        check.measured = match asked.map_or(CheckValue::Computed, |check| check.value) {
            CheckValue::Computed => result.and_then(|result| result.finest()),
            CheckValue::Extrapolated => {
                "extrapolated from the meshes".clone_into(&mut check.variant);
                result.and_then(|result| Some(result.estimate?.value))
            }
        }
        .unwrap_or(f64::NAN);
        CheckRow {
            pass: check.passes(),
            check,
        }
    };
    of.checks.iter().enumerate().map(row).collect()
}

fn result(name: String, kind: ResultKind, found: &[Option<Found>], parts: &[usize]) -> StudyResult {
    let points: Vec<Computed> = std::iter::zip(found, parts)
        .filter_map(|(found, &parts)| {
            let (value, half_width) = (*found)?;
            Some(Computed {
                h: 1.0 / parts as f64,
                value,
                half_width,
            })
        })
        .collect();
    StudyResult {
        name,
        kind,
        values: found
            .iter()
            .map(|found| found.map(|found| found.0))
            .collect(),
        half_widths: found
            .iter()
            .map(|found| found.map_or(0.0, |found| found.1))
            .collect(),
        estimate: estimate(&points),
    }
}

/// The result that a stage is made for, if it is made for one.
fn of_stage<const D: usize>(case: &Case<D>, number: usize) -> Option<(String, ResultKind)> {
    let stage = &case.stages[number];
    let name = &stage.name;
    let searches = |stage: &&Stage| matches!(stage.kind, StageKind::StrengthReduction(_));
    match &stage.kind {
        StageKind::StrengthReduction(_) => {
            let only = case.stages.iter().filter(searches).count() == 1;
            let of = if only {
                String::new()
            } else {
                format!(", \"{name}\"")
            };
            Some((
                format!("factor of safety{of} [-]"),
                ResultKind::FactorOfSafety,
            ))
        }
        StageKind::Gravity { horizontal, .. } if stage.stop_when.no_equilibrium => Some((
            match horizontal {
                Some(_) => format!("horizontal acceleration at the end of \"{name}\" [-]"),
                None => format!("gravity at the end of \"{name}\" [-]"),
            },
            ResultKind::LimitLoad,
        )),
        StageKind::Load { .. } if stage.stop_when.no_equilibrium => Some((
            format!("load factor at the end of \"{name}\" [-]"),
            ResultKind::LimitLoad,
        )),
        StageKind::Displacement { .. } => Some((
            format!("largest resistance in \"{name}\" [N/m]"),
            ResultKind::LimitLoad,
        )),
        _ => None,
    }
}

/// What a run found at a stage of that kind.
fn at_stage<const D: usize>(case: &Case<D>, run: &Summary, number: usize) -> Option<Found> {
    let (stage, summary) = (&case.stages[number], run.stages.get(number)?);
    match &stage.kind {
        StageKind::StrengthReduction(_) => interval(summary),
        StageKind::Displacement { .. } => Some((summary.peak_resistance?, 0.0)),
        StageKind::Gravity {
            horizontal: Some(_),
            ..
        } => limit(case, run, number, Quantity::HorizontalFactor),
        StageKind::Gravity { .. } => limit(case, run, number, Quantity::GravityFactor),
        StageKind::Load { loads, .. } => {
            limit(case, run, number, Quantity::LoadFactor(*loads.first()?))
        }
        StageKind::K0 | StageKind::Rigid(_) | StageKind::Construction(_) | StageKind::RunOut(_) => {
            None
        }
    }
}

/// Middle of the interval of a factor of safety, and half its width (theory, eq. 40g).
fn interval(stage: &StageSummary) -> Option<Found> {
    let safety = stage.safety.as_ref()?;
    let (stable, failed) = (safety.stable?, safety.failed?);
    Some((0.5 * (stable + failed), 0.5 * (failed - stable).abs()))
}

/// The load at which a stage ended before its end. The smallest step that was tried lies beyond it: it
/// counts to either side (theory, eq. 40g).
fn limit<const D: usize>(
    case: &Case<D>,
    run: &Summary,
    number: usize,
    of: Quantity,
) -> Option<Found> {
    let (stage, summary) = (&case.stages[number], run.stages.get(number)?);
    if !stage.stop_when.no_equilibrium || summary.outcome != StageOutcome::Stopped {
        return None;
    }
    if let Some((Some(low), Some(high))) = summary.path.as_ref().map(crate::run::limit::interval) {
        return Some((0.5 * (low + high), 0.5 * (high - low)));
    }
    let from = stage
        .start_from
        .map_or(0.0, |before| at_end(case, run, before, of));
    let solver = &case.solver;
    // A displacement is passed in a planned step.
    let cuts = match stage.stop_when.displacement {
        Some(_) => 0,
        None => i32::try_from(solver.cuts).ok()?,
    };
    let smallest = solver.cut_factor.powi(cuts) / stage.steps as f64;
    let whole = (aim(&stage.kind, of)? - from).abs();
    Some((at_end(case, run, number, of), smallest * whole))
}

/// A multiple of gravity, an acceleration or a load factor at the end of a stage of a run.
fn at_end<const D: usize>(case: &Case<D>, run: &Summary, number: usize, of: Quantity) -> f64 {
    let stage = &case.stages[number];
    let from = stage
        .start_from
        .map_or(0.0, |before| at_end(case, run, before, of));
    let reached = run.stages.get(number).map_or(0.0, |stage| stage.reached);
    aim(&stage.kind, of).map_or(from, |to| from + reached * (to - from))
}

/// Where a stage takes a multiple of gravity, an acceleration or a load factor, if it changes it.
fn aim(kind: &StageKind, of: Quantity) -> Option<f64> {
    match (kind, of) {
        (StageKind::Gravity { factor, .. }, Quantity::GravityFactor) => Some(*factor),
        (StageKind::Gravity { horizontal, .. }, Quantity::HorizontalFactor) => *horizontal,
        (StageKind::K0, Quantity::GravityFactor) => Some(1.0),
        (StageKind::Load { loads, factor }, Quantity::LoadFactor(load)) => {
            loads.contains(&load).then_some(*factor)
        }
        _ => None,
    }
}

/// Half the width of the interval in which a search left the value of a check.
fn width_of_check<const D: usize>(case: &Case<D>, run: &Summary, name: &str) -> f64 {
    let Some(check) = case.checks.iter().find(|check| check.name == name) else {
        return 0.0;
    };
    let stage = check.stage.unwrap_or(case.stages.len().saturating_sub(1));
    let found = match check.of {
        Quantity::FactorOfSafety => run.stages.get(stage).and_then(interval),
        Quantity::GravityFactor | Quantity::HorizontalFactor | Quantity::LoadFactor(_) => {
            limit(case, run, stage, check.of)
        }
        _ => None,
    };
    found.map_or(0.0, |(_, width)| width / check.divide_by.abs())
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
    let mut own = rows.iter().filter(|row| row.check.quantity == name);
    own.nth(place)
}
