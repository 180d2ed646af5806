//! The text at the end of a run.

use std::fmt::Write as _;
use std::path::Path;

use igimp_results::mesh_study::{MeshSummary, StudyResult, StudySummary};
use igimp_results::summary::{CheckRow, PathPoint, SafetySummary, StrengthShares, Summary};
use igimp_text::{count, on_a_line, short};

use super::{lines, table};

/// Stages and checks of a run; no times, so that two runs give equal texts.
pub fn stages_and_checks(summary: &Summary) -> String {
    let rows: Vec<Vec<String>> = summary
        .stages
        .iter()
        .map(|stage| {
            let found = stage.safety.as_ref().map(explain).unwrap_or_default();
            vec![
                stage.name.clone(),
                stage.kind.clone(),
                format!("{} steps", stage.steps),
                lines::outcome(stage) + &found,
            ]
        })
        .collect();
    let mut text = match summary.mesh_study.as_ref() {
        Some(study) => {
            let shown = study.shown().map_or_else(String::new, MeshSummary::label);
            let meshes = table(&study.meshes.iter().map(mesh).collect::<Vec<_>>());
            format!("meshes\n{meshes}stages ({shown})\n")
        }
        None => "stages\n".to_owned(),
    };
    text += &table(&rows);
    let at_round_off: usize = summary.stages.iter().map(|stage| stage.at_round_off).sum();
    if at_round_off > 0 {
        let _ = writeln!(
            text,
            "  {at_round_off} steps were accepted above the tolerance, at round-off"
        );
    }
    if let Some(study) = &summary.mesh_study {
        let _ = write!(text, "mesh error\n{}", mesh_error(study));
    }
    if !summary.checks.is_empty() {
        let _ = write!(text, "checks\n{}", checks(&summary.checks));
    }
    text
}

/// A mesh of a study: its size, and how its run ended.
fn mesh(mesh: &MeshSummary) -> Vec<String> {
    vec![
        mesh.label(),
        mesh.folder.clone(),
        format!("{} particles", count(mesh.size.particles)),
        format!("{} cells", count(mesh.size.cells)),
        mesh.ending.to_string(),
    ]
}

/// The results of a study: the values on all meshes, and their extrapolation.
fn mesh_error(study: &StudySummary) -> String {
    let rows: Vec<Vec<String>> = study
        .results
        .iter()
        .map(StudyResult::as_printed)
        .map(|result| {
            let mut row = vec![on_a_line(&result.name).into_owned()];
            row.extend(study.meshes.iter().enumerate().map(|(number, mesh)| {
                let value = result.values[number].map_or_else(|| "-".to_owned(), short);
                let early = if result.ended_early(number) {
                    " (ended early)"
                } else {
                    ""
                };
                format!("{} {value}{early}", mesh.label())
            }));
            row.extend(result.refusal(&study.meshes));
            row.extend(result.estimate.iter().flat_map(|found| {
                [
                    format!("{} {}", found.lead(), found.sentence()),
                    format!("(order {})", found.order.sentence()),
                ]
            }));
            row
        })
        .collect();
    table(&rows)
}

/// The last line: where the results are, and the time taken.
pub fn results(summary: &Summary, folder: &Path) -> String {
    format!("results in {} ({:.1} s)", folder.display(), summary.seconds)
}

/// Checks as a table, with the source of each expected value.
pub fn checks(rows: &[CheckRow]) -> String {
    let rows: Vec<Vec<String>> = rows
        .iter()
        .map(|row| {
            let check = &row.check;
            vec![
                match row.verdict() {
                    "met" => "met".to_owned(),
                    other => other.to_uppercase(),
                },
                on_a_line(&check.quantity).into_owned(),
                row.measured(),
                format!("expected {}", check.printed(check.expected)),
                check.printed_band(),
                format!("({})", on_a_line(&check.source)),
            ]
        })
        .collect();
    table(&rows)
}

/// The basis of a factor of safety: criterion, materials, share of the mass that moves.
fn explain(safety: &SafetySummary) -> String {
    let mut parts = Vec::new();
    if !safety.criterion.is_empty() {
        parts.push(format!("fails when {}", safety.criterion));
    }
    if !safety.materials.is_empty() {
        parts.push(format!("materials {}", safety.materials.join(", ")));
    }
    if !safety.excluded.is_empty() {
        parts.push(format!("without {}", safety.excluded.join(", ")));
    }
    if let Some(share) = safety.moving_mass {
        let percent = 100.0 * share;
        let rounded = if percent >= 1.0 {
            format!("{percent:.0}")
        } else {
            short(percent)
        };
        parts.push(format!("{rounded} % of the mass moves"));
    }
    if let Some(path) = &safety.path {
        let at = |name: &str, point: &PathPoint| {
            format!(
                "{name} {:.3} at {} m",
                point.factor,
                short(point.displacement)
            )
        };
        parts.extend(path.knee.as_ref().map(|knee| at("knee", knee)));
        parts.extend(
            path.mechanism
                .as_ref()
                .map(|found| at("mechanism from", found)),
        );
        parts.extend(path.shares.as_ref().and_then(largest_share));
        let scale = path.displacement_scale;
        parts.extend(scale.map(|scale| format!("γH²/E = {} m", short(scale))));
    }
    if parts.is_empty() {
        String::new()
    } else {
        format!(" ({})", parts.join("; "))
    }
}

/// The strength that the factor of safety changes most with, by ∂ ln F/∂ ln of it, which may be above 1.
fn largest_share(shares: &StrengthShares) -> Option<String> {
    let strengths = shares.strengths();
    let largest = strengths.max_by(|a, b| a.2.abs().total_cmp(&b.2.abs()));
    largest.map(|(name, kind, share)| format!("1 % of {kind} of {name} changes F by {share:.2} %"))
}

#[cfg(test)]
mod tests {
    use igimp_model::check::{Band, Check, PrintedUnit};
    use igimp_results::mesh_study::ResultKind;
    use igimp_results::summary::{StageOutcome, StageSummary, Standing};

    use super::*;

    #[test]
    fn the_verdict_is_short() {
        let stage = |name: &str, kind: &str| StageSummary {
            name: name.into(),
            kind: kind.into(),
            steps: 10,
            ..StageSummary::default()
        };
        let summary = Summary {
            stages: vec![
                stage("initial stresses", "gravity"),
                StageSummary {
                    safety: Some(SafetySummary {
                        stable: Some(1.366),
                        failed: Some(1.375),
                        criterion: "no equilibrium is found".into(),
                        materials: vec!["clay".into()],
                        excluded: vec!["rock".into()],
                        moving_mass: Some(0.342),
                        ..SafetySummary::default()
                    }),
                    ..stage("factor of safety", "strength-reduction")
                },
                StageSummary {
                    outcome: StageOutcome::Stopped,
                    reason: "displacement reached 0.5 m".into(),
                    ..stage("load", "load")
                },
            ],
            checks: vec![CheckRow {
                check: Check {
                    case: "slope".into(),
                    variant: "iGIMP".into(),
                    quantity: "F [-]".into(),
                    expected: 1.38,
                    source: "Griffiths and Lane 1999".into(),
                    band: Band::Relative(0.02),
                    measured: 1.371,
                    unit: None,
                },
                pass: true,
                standing: Standing::Held,
            }],
            seconds: 12.34,
            ..Summary::default()
        };
        let text = stages_and_checks(&summary) + &results(&summary, Path::new("results/slope"));
        insta::assert_snapshot!(text, @r#"
        stages
          initial stresses  gravity             10 steps  completed
          factor of safety  strength-reduction  10 steps  1.366 <= F < 1.375 (fails when no equilibrium is found; materials clay; without rock; 34 % of the mass moves)
          load              load                10 steps  stopped: displacement reached 0.5 m
        checks
          met  F [-]  1.371  expected 1.38  ± 2 %  (Griffiths and Lane 1999)
        results in results/slope (12.3 s)
        "#);
    }

    /// GOAL: a check that was not reached is told apart from one that is met or missed, and a factor beyond all numbers is no number.
    /// ORACLE: by hand.
    #[test]
    fn verdicts_of_checks_are_printed() {
        let check = |measured: f64| Check {
            case: String::new(),
            variant: String::new(),
            quantity: "F".into(),
            expected: 1.5,
            source: "s".into(),
            band: Band::AtLeast(1.5),
            measured,
            unit: None,
        };
        let nothing_fails = CheckRow {
            standing: Standing::NothingFails,
            ..CheckRow::held(check(1.6e8))
        };
        let rows = [
            CheckRow::held(check(1.4)),
            CheckRow::not_reached(check(1.6)),
            CheckRow::not_reached(check(f64::NAN)),
            nothing_fails,
        ];
        insta::assert_snapshot!(checks(&rows), @r#"
          MISSED       F  1.4     expected 1.5  ≥ 1.5  (s)
          NOT REACHED  F  1.6     expected 1.5  ≥ 1.5  (s)
          NOT REACHED  F  -       expected 1.5  ≥ 1.5  (s)
          met          F  > 1000  expected 1.5  ≥ 1.5  (s)
        "#);
    }

    /// GOAL: checks and their values on meshes are printed in the unit of the case. ORACLE: by hand: 1 mm is 0.001 m.
    #[test]
    fn checks_are_printed_in_the_unit_of_the_case() {
        let unit = Some(PrintedUnit {
            name: "mm".into(),
            in_si: 1e-3,
        });
        let check = Check {
            case: String::new(),
            variant: String::new(),
            quantity: "settlement".into(),
            expected: 0.0125,
            source: "s".into(),
            band: Band::AtMost(0.0125),
            measured: 0.0123,
            unit: unit.clone(),
        };
        insta::assert_snapshot!(checks(&[CheckRow::held(check)]), @"  met  settlement  12.3 mm  expected 12.5 mm  ≤ 12.5 mm  (s)");
        let mesh = |parts: usize| MeshSummary {
            parts,
            ..MeshSummary::default()
        };
        let study = StudySummary {
            meshes: vec![mesh(1), mesh(2)],
            results: vec![StudyResult {
                name: "settlement".into(),
                kind: ResultKind::Check,
                values: vec![Some(0.0123), Some(0.0121)],
                half_widths: vec![0.0; 2],
                early: vec![false, true],
                estimate: None,
                unit,
            }],
        };
        insta::assert_snapshot!(mesh_error(&study), @"  settlement [mm]  h 12.3  h/2 12.1 (ended early)  nothing is extrapolated: the run on the mesh h/2 ended early");
    }
}
