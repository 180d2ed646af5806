//! Results that are held against outside values.

use igimp_model::check::Band;
use igimp_model::{CaseCheck, CheckTime, CheckValue, Load, Quantity, Stage, StageKind};
use igimp_schema::diagnostic::Problems;
use igimp_schema::text::clip;
use igimp_schema::tree::{Node, Wrong};

use super::quantities::{divisor, quantity};
use crate::build::AllNames;

/// The checks.
pub(crate) fn checks<const D: usize>(
    tree: &Node,
    names: &AllNames,
    loads: &[Option<Load<D>>],
    stages: &[Option<Stage>],
    problems: &mut Problems,
) -> Vec<Option<CaseCheck>> {
    let items = tree.items_at("checks").iter();
    items
        .map(|node| {
            let name = clip(node.text_at("name").unwrap_or("?"), 40);
            let of = node
                .get("of")
                .and_then(|of| quantity(of, names, loads, problems));
            let divide_by = divisor(node, problems);
            let who = format!("check `{name}` looks at");
            let stage = names.stages.find_optional(node, "stage", &who, problems);
            let stage = match (stage, of) {
                (Ok(stage), Some(Quantity::FactorOfSafety)) => {
                    if node.text_at("at") == Some("peak") {
                        problems
                            .error(node.place_at("at"), "a factor of safety has no peak")
                            .help("leave `at` out: it is known at the end of its stage");
                    }
                    search(node, stage, stages, problems).map(Some)
                }
                (stage, _) => stage,
            };
            let band = band(node, problems);
            let (expected, band) = band?;
            Some(CaseCheck {
                name: node.text_at("name")?.to_owned(),
                of: of?,
                divide_by: divide_by?,
                stage: stage.ok()?,
                at: match node.text_at("at")? {
                    "peak" => CheckTime::Peak,
                    _ => CheckTime::End,
                },
                value: match node.text_at("value")? {
                    "extrapolated" => CheckValue::Extrapolated,
                    _ => CheckValue::Computed,
                },
                expected,
                band,
                source: node.text_at("source")?.to_owned(),
            })
        })
        .collect()
}

/// The strength reduction whose factor of safety is meant.
fn search(
    node: &Node,
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
                node.place_at("stage"),
                "this stage does not search for a factor of safety",
            )
            .help("name a stage of type strength-reduction");
        return Err(Wrong);
    }
    let last = (0..stages.len()).rev().find(searches);
    if last.is_none() {
        problems
            .error(node.place_at("of"), "no stage finds a factor of safety")
            .help("add a stage of type strength-reduction");
    }
    last.ok_or(Wrong)
}

/// What is expected, and the band around it.
fn band(node: &Node, problems: &mut Problems) -> Option<(f64, Band)> {
    const BANDS: [&str; 4] = ["tolerance", "between", "at_most", "at_least"];
    let given: Vec<&str> = BANDS
        .into_iter()
        .filter(|band| node.get(band).is_some())
        .collect();
    let expected = node.optional_number("expected").ok()?;
    let &[form] = given.as_slice() else {
        let message = if given.is_empty() {
            "the check does not say what is accepted".to_owned()
        } else {
            format!("the check has several bands: {}", given.join(", "))
        };
        problems
            .error(node.place, message)
            .help("write one of tolerance = 0.05, between = [1.3, 1.4], at_most and at_least");
        return None;
    };
    let value = node.get(form)?;
    match form {
        "tolerance" => {
            let tolerance = value.number()?;
            match expected {
                Some(expected) if expected != 0.0 => Some((expected, Band::Relative(tolerance))),
                Some(_) => {
                    problems
                        .error(
                            value.place,
                            "a relative tolerance around 0 accepts nothing else",
                        )
                        .help("write between = [-1e-3, 1e-3]");
                    None
                }
                None => {
                    problems
                        .error(
                            value.place,
                            "the tolerance is relative to `expected`, which is missing",
                        )
                        .help("add expected = 1.35");
                    None
                }
            }
        }
        "between" => {
            let [low, high] = value.pair()?;
            if low > high {
                problems
                    .error(value.place, "`between` is not in ascending order")
                    .help("write the smaller value first");
                return None;
            }
            Some((
                expected.unwrap_or(0.5 * (low + high)),
                Band::Between(low, high),
            ))
        }
        "at_most" => {
            let limit = value.number()?;
            Some((expected.unwrap_or(limit), Band::AtMost(limit)))
        }
        _ => {
            let limit = value.number()?;
            Some((expected.unwrap_or(limit), Band::AtLeast(limit)))
        }
    }
}
