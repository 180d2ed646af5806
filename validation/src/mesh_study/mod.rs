//! The stated error of a study of meshes: along the path of equilibria on slopes whose factor is bounded, at a place
//! in ground at rest, and of drawn values whose limit and order are known.

mod drawn;

use std::fmt::Write as _;
use std::path::Path as Folder;

use igimp_assembly::Locking;
use igimp_cases::CaseError;
use igimp_cases::run::in_memory;
use igimp_model::check::Band;
use igimp_results::mesh_study::{Computed, Convergence, ResultKind, StudyResult};
use igimp_results::summary::Summary;
use igimp_text::short;
use rayon::prelude::*;

use crate::harness::oracle::{Oracle, OracleKind};
use crate::harness::reference::{slope_limit_load_bounds, slope_safety_bounds};
use crate::harness::study::coverage::{Extrapolated, Known, counted};
use crate::harness::study::{Level, RunRecord, Study};
use crate::limit_equilibrium::section::{Path, Variant};
use crate::runs::shipped_case;
use crate::slopes::problems::{Problem, acads_1a, drained, published, undrained};

/// The book's description of the study.
const ABOUT: &str = "What a study of two meshes says of its own error: slopes whose factor of safety is bounded, searched for along the path of equilibria as case files do it; stress at a place in ground at rest that is no particle's; and drawn values of known limit and order. How often the truth lies within the uncertainty, and how wide that is.";
/// The promise of a stated uncertainty.
const PROMISE: Oracle = Oracle {
    kind: OracleKind::LimitAnalysis,
    source: "lower and upper bounds of the slopes",
    locator: "value and uncertainty meet the bounds in 95 %; the uncertainty is from end to end 2 % wide, half of them less",
};
/// ACADS problem 1(a), by limit analysis.
const ACADS_1A: [f64; 2] = [0.976, 0.985];
/// Stress of ground at rest.
const WEIGHT: Oracle = Oracle {
    kind: OracleKind::Exact,
    source: "weight above",
    locator: "σ_v = γ z",
};
/// How far an extrapolated factor may lie beyond its bounds \[-\].
const BEYOND: f64 = 0.01;

/// Runs the study.
pub(crate) fn study(level: Level, out: &Folder) -> Result<Study, CaseError> {
    let mut study = Study::new("mesh-study", ABOUT, out)?;
    slopes(&mut study, level)?;
    at_a_place(&mut study)?;
    drawn::report(&mut study)?;
    Ok(study)
}

/// The slopes of a level. ACADS 1(c), in layers, and that of Dawson et al., whose path is lost on the fine mesh, are of the full one.
fn problems(level: Level) -> Vec<Problem> {
    let mut problems = undrained(&slope_limit_load_bounds().rows());
    problems.extend(drained(&slope_safety_bounds().rows()));
    let is_full = level == Level::Full;
    problems.retain(|problem| is_full || problem.section.name != "Dawson et al.");
    problems.extend(published().into_iter().filter_map(|mut problem| {
        let is_simple = problem.section.name == acads_1a().name;
        if is_simple {
            problem.known = Some(ACADS_1A);
        }
        (problem.known.is_some() && (is_simple || is_full)).then_some(problem)
    }));
    if level == Level::Quick {
        problems.retain(|problem| problem.section.name == "Griffiths and Lane 1");
    }
    problems
}

/// Two meshes of every slope, as a user asks for them.
fn slopes(study: &mut Study, level: Level) -> Result<(), CaseError> {
    let problems = problems(level);
    let runs = problems
        .par_iter()
        .map(|problem| {
            let stage = match problem.search.path {
                Path::Reduce => 1,
                Path::Gravity => 0,
            };
            let overrides = [
                format!("stages.{stage}.search=\"continuation\""),
                "mesh_study.meshes=2".to_owned(),
            ];
            let variant = Variant {
                cells: problem.meshes[0],
                locking: Locking::SharedStrain,
                associated: true,
            };
            let case = (problem.section).case_with(variant, problem.search, &overrides)?;
            Ok(in_memory(&case)?.summary)
        })
        .collect::<Result<Vec<_>, CaseError>>()?;
    let mut note = "mesh study of slopes: known; on the meshes; extrapolated\n".to_owned();
    let mut records = Vec::new();
    for (problem, summary) in std::iter::zip(&problems, &runs) {
        if let (Some(found), Some(truth)) =
            (result(summary, ResultKind::FactorOfSafety), problem.known)
        {
            let record = record(format!("{}, along the path", problem.section.name), summary);
            note += &of_slope(study, problem, found, truth, record.clone());
            records.push(record);
        }
    }
    let (count, covered, width) = counted(study.extrapolated.iter());
    let _ = writeln!(
        note,
        "  within the uncertainty: {covered} of {count}; median width {} %",
        short(100.0 * width)
    );
    study.notes.push(note);
    // Fewer slopes have another share and another median: the page has those of all of them.
    if level != Level::Full {
        return Ok(());
    }
    let all = RunRecord::sum(
        format!("all {count} slopes"),
        &records.iter().collect::<Vec<_>>(),
    );
    let run = study.run(all);
    study.check(
        run,
        "share of slopes whose bounds the uncertainty meets [-]",
        PROMISE.says(1.0),
        Band::AtLeast(0.95),
        covered as f64 / count as f64,
    );
    study.check(
        run,
        "median width of the uncertainty over the value [-]",
        PROMISE.says(0.0),
        Band::AtMost(0.02),
        width,
    );
    Ok(())
}

/// Holds the result for a slope against its known bounds, and states it in a line.
fn of_slope(
    study: &mut Study,
    problem: &Problem,
    found: &StudyResult,
    truth: [f64; 2],
    record: RunRecord,
) -> String {
    let name = record.variant.clone();
    let run = study.run(record);
    let printed: Vec<String> = (found.values.iter().enumerate())
        .map(|(mesh, value)| {
            let early = if found.ended_early(mesh) {
                " (early)"
            } else {
                ""
            };
            value.map_or_else(|| "-".to_owned(), |value| format!("{value:.4}{early}"))
        })
        .collect();
    let [lower, upper] = truth;
    let says = found.estimate.map(|estimate| {
        let on_mesh = |(mesh, value): (usize, &Option<f64>)| {
            Some(Computed {
                h: 0.5_f64.powi(mesh as i32),
                value: (*value)?,
                half_width: found.half_widths[mesh],
            })
        };
        study.extrapolated.push(Extrapolated {
            name,
            known: Known {
                convergence: Convergence::SOIL,
                truth,
            },
            values: found
                .values
                .iter()
                .enumerate()
                .filter_map(on_mesh)
                .collect(),
            estimate,
        });
        study.check(
            run,
            "factor of safety, extrapolated from two meshes [-]",
            problem.oracle.says(0.5 * (lower + upper)),
            Band::Between((1.0 - BEYOND) * lower, (1.0 + BEYOND) * upper),
            estimate.value,
        );
        format!("{:.4} ± {:.4}", estimate.value, estimate.uncertainty)
    });
    format!(
        "  {}: {lower:.3} … {upper:.3}; {}; {}\n",
        problem.section.name,
        printed.join(", "),
        says.unwrap_or_else(|| "nothing is said".to_owned())
    )
}

/// Vertical stress in ground at rest at a place beside the particles of all meshes, by three of them.
fn at_a_place(study: &mut Study) -> Result<(), CaseError> {
    // 18 kN/m³ × 1.7 m, off the centre of any particle.
    let expected = 18.0 * 1.7;
    let case = shipped_case(
        "k0_ground",
        vec![
            "mesh_study.meshes=3".to_owned(),
            "sections=[]".to_owned(),
            "monitors=[{ name = \"place\", point = [\"5.07 m\", \"10.3 m\"], record = [\"sigma_yy\"] }]".to_owned(),
            "checks=[{ name = \"vertical stress\", of = \"place.sigma_yy\", divide_by = [\"1 kPa\"], value = \"extrapolated\", \
             expected = 30.6, tolerance = 1e-6, source = \"exact\" }]"
                .to_owned(),
        ],
    )?;
    let summary = in_memory(&case)?.summary;
    let found = result(&summary, ResultKind::Check).and_then(|found| found.estimate);
    let run = study.run(record(
        "ground at rest, place off all particles".to_owned(),
        &summary,
    ));
    study.check(
        run,
        "vertical stress at a place, extrapolated from three meshes [kPa]",
        WEIGHT.says(expected),
        Band::Relative(1e-6),
        found.map_or(f64::NAN, |found| found.value),
    );
    study.check(
        run,
        "its uncertainty over its value [-]",
        WEIGHT.says(0.0),
        Band::AtMost(1e-6),
        found.map_or(f64::NAN, |found| found.uncertainty / found.value),
    );
    Ok(())
}

/// The first result of a kind.
fn result(summary: &Summary, kind: ResultKind) -> Option<&StudyResult> {
    let results = &summary.mesh_study.as_ref()?.results;
    results.iter().find(|result| result.kind == kind)
}

/// How the runs on all meshes went.
fn record(variant: String, summary: &Summary) -> RunRecord {
    let stages = &summary.stages;
    let meshes = summary.mesh_study.as_ref().map(|study| &study.meshes[..]);
    RunRecord {
        variant,
        outcome: "the finest mesh that came to its end".to_owned(),
        steps: meshes.map_or(0, |meshes| meshes.iter().map(|mesh| mesh.steps).sum()),
        iterations: stages.iter().map(|stage| stage.iterations).sum(),
        cuts: stages.iter().map(|stage| stage.cuts).sum(),
        seconds: summary.seconds,
        at_round_off: stages.iter().map(|stage| stage.at_round_off).sum(),
        phases: [0.0; 5],
        stopped_by: None,
        residuals: Vec::new(),
    }
}
