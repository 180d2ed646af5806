//! Results that are held against outside values.

use igimp_model::check::{Band, PrintedUnit};
use igimp_model::{CaseCheck, CheckTime, CheckValue, Load, Quantity, Stage, StageKind};
use igimp_schema::diagnostic::Problems;
use igimp_schema::quantity::Powers;
use igimp_schema::schema::Measured;
use igimp_schema::schema::outputs::{self as keys, CheckedValue, Moment};
use igimp_schema::text::clip;
use igimp_schema::tree::Wrong;
use igimp_schema::tree::read::At;

use super::quantities::{divisor, quantity, unit_of};
use crate::build::AllNames;

/// A check; `is_whole` says whether forces are of whole bodies, not per metre run.
pub(crate) fn check<const D: usize>(
    check: &At<keys::Check>,
    is_whole: bool,
    names: &AllNames,
    loads: &[Option<Load<D>>],
    stages: &[Option<Stage>],
    problems: &mut Problems,
) -> Option<CaseCheck> {
    let name = clip(&check.name, 40);
    let of = quantity(&check.of, names, loads, problems);
    let divide_by = divisor(&check.divide_by, problems);
    let subject = format!("check `{name}` looks at");
    let stage = names
        .stages
        .find_optional(check.stage.as_ref(), &subject, problems);
    let stage = match (stage, of) {
        (Ok(stage), Some(Quantity::FactorOfSafety)) => {
            if *check.at == Moment::Peak {
                problems
                    .error(check.at.place, "a factor of safety has no peak")
                    .help("leave `at` out: it is known at the end of its stage");
            }
            search(check, stage, stages, problems).map(Some)
        }
        (stage, _) => stage,
    };
    let (expected, band) = band(check, problems)?;
    of?;
    units_are_those_of(check, unit_of(D, is_whole, &check.of), problems)?;
    Some(CaseCheck {
        name: check.name.value.clone(),
        of: of?,
        divide_by: divide_by?,
        stage: stage.ok()?,
        at: match *check.at {
            Moment::Peak => CheckTime::Peak,
            Moment::End => CheckTime::End,
        },
        value: match *check.value.value {
            CheckedValue::Extrapolated => CheckValue::Extrapolated,
            CheckedValue::Computed => CheckValue::Computed,
        },
        expected,
        band,
        unit: unit_of_band(check),
        source: check.source.value.clone(),
    })
}

/// The unit in which accepted values are written: that of the first of several.
fn unit_of_band(check: &keys::Check) -> Option<PrintedUnit> {
    let between = check.between.as_ref().map(|bounds| bounds.value[0]);
    let single = [&check.at_most, &check.at_least, &check.expected];
    let single = single.into_iter().flatten().map(|bound| bound.value);
    let (name, in_si) = between.into_iter().chain(single).next()?.unit?;
    Some(PrintedUnit {
        name: name.to_owned(),
        in_si,
    })
}

/// Refuses bounds that measure something else than the quantity, in an SI unit, over its divisors. A plain divisor may stand
/// for any unit: a plain bound then does too.
fn units_are_those_of(check: &At<keys::Check>, unit: &str, problems: &mut Problems) -> Option<()> {
    let divisors = check.divide_by.iter().map(|item| item.value.dimension);
    let measured = divisors.fold(Powers::of_unit(unit), |of, divisor| {
        of.over(Powers::of(divisor))
    });
    let is_plain = |divisor: &At<Measured>| divisor.value.dimension.is_none();
    let of_any_unit = check.divide_by.iter().any(is_plain);
    let both = check
        .between
        .iter()
        .flat_map(|bounds| bounds.iter().map(|value| (*value, bounds.place)));
    let single = [&check.expected, &check.at_most, &check.at_least];
    let single = single
        .into_iter()
        .flatten()
        .map(|bound| (bound.value, bound.place));
    for (bound, place) in single.chain(both) {
        let stated = Powers::of(bound.dimension);
        if stated == measured || (bound.dimension.is_none() && of_any_unit) {
            continue;
        }
        let problem = problems.error(
            place,
            format!("the check is of {measured}, and this is {stated}"),
        );
        if measured == Powers::default() {
            problem
                .help("write a plain number, or leave out what takes the unit away in divide_by");
        } else if let Some(dimension) = measured.dimension() {
            problem.help(format!(
                "write a quantity like \"{}\", or a plain number with divide_by = [..., \"1 {}\"]",
                dimension.example(),
                dimension.usual_unit()
            ));
        } else {
            problem.help("write divide_by so that a plain number is left, and plain numbers here");
        }
        return None;
    }
    Some(())
}

/// The strength reduction whose factor of safety is meant.
fn search(
    check: &keys::Check,
    stage: Option<usize>,
    stages: &[Option<Stage>],
    problems: &mut Problems,
) -> Result<usize, Wrong> {
    if stages.iter().any(Option::is_none) {
        return Err(Wrong);
    }
    let searches = |index: &usize| {
        let stage = stages.get(*index).and_then(Option::as_ref);
        stage.is_some_and(|stage| matches!(stage.kind, StageKind::StrengthReduction(_)))
    };
    if let Some(stage) = stage {
        if searches(&stage) {
            return Ok(stage);
        }
        problems
            .error(
                check.stage.as_ref().map(|stage| stage.place),
                "this stage does not search for a factor of safety",
            )
            .help("name a stage of type strength-reduction");
        return Err(Wrong);
    }
    let last = (0..stages.len()).rev().find(searches);
    if last.is_none() {
        problems
            .error(check.of.place, "no stage finds a factor of safety")
            .help("add a stage of type strength-reduction");
    }
    last.ok_or(Wrong)
}

/// The expected value, and its band.
fn band(check: &At<keys::Check>, problems: &mut Problems) -> Option<(f64, Band)> {
    let expected = check.expected.as_ref().map(|stated| stated.value.value);
    let bands = (
        check.tolerance.as_ref(),
        check.between.as_ref(),
        check.at_most.as_ref(),
        check.at_least.as_ref(),
    );
    match bands {
        (Some(tolerance), None, None, None) => match expected {
            Some(expected) if expected != 0.0 => Some((expected, Band::Relative(**tolerance))),
            Some(_) => {
                problems
                    .error(
                        tolerance.place,
                        "a relative tolerance around 0 accepts nothing else",
                    )
                    .help("write between = [-1e-3, 1e-3]");
                None
            }
            None => {
                problems
                    .error(
                        tolerance.place,
                        "the tolerance is relative to `expected`, which is missing",
                    )
                    .help("add expected = 1.35");
                None
            }
        },
        (None, Some(between), None, None) => {
            let [low, high] = between.map(|bound| bound.value);
            if low > high {
                problems
                    .error(between.place, "`between` is not in ascending order")
                    .help("write the smaller value first");
                return None;
            }
            let middle = 0.5 * (low + high);
            Some((expected.unwrap_or(middle), Band::Between(low, high)))
        }
        (None, None, Some(most), None) => {
            let most = most.value.value;
            Some((expected.unwrap_or(most), Band::AtMost(most)))
        }
        (None, None, None, Some(least)) => {
            let least = least.value.value;
            Some((expected.unwrap_or(least), Band::AtLeast(least)))
        }
        (tolerance, between, most, least) => {
            let given = [
                tolerance.map(|_| "tolerance"),
                between.map(|_| "between"),
                most.map(|_| "at_most"),
                least.map(|_| "at_least"),
            ];
            let given: Vec<&str> = given.into_iter().flatten().collect();
            let message = if given.is_empty() {
                "the check does not say what is accepted".to_owned()
            } else {
                format!("the check has several bands: {}", given.join(", "))
            };
            problems
                .error(check.place, message)
                .help("write one of tolerance = 0.05, between = [1.3, 1.4], at_most and at_least");
            None
        }
    }
}
