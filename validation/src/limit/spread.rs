//! The spread of a factor of safety over settings that are no part of the answer: tolerance, corrections and steps of the solver,
//! stiffness.

use std::fmt::Write as _;

use igimp_assembly::Geometry;
use igimp_cases::CaseError;
use igimp_input::shipped::SHIPPED;
use igimp_model::check::Band;
use igimp_model::{AnyCase, Case, SearchMethod, StageKind};
use rayon::prelude::*;

use super::{Found, LIMIT_THEOREMS, SPREAD, Sought, VARIED};
use crate::harness::study::{Level, RunRecord, Study};
use crate::limit_equilibrium::section::{Search, YOUNG};
use crate::runs::Computed;
use crate::slopes::problems::Problem;

/// Cases that take longest.
const DEAR: [&str; 7] = [
    "dam_drawdown",
    "dam_seepage",
    "embankment_lifts",
    "excavation",
    "landslide_3d",
    "layered_slope",
    "nailed_cut",
];

/// Cases whose stiffness is part of the answer: pores store by it, water leaves by it, and strain that softens goes with it.
const STIFFNESS_COUNTS: [&str; 3] = ["rapid_drawdown", "embankment_time", "sensitive_slope"];

/// How often steps of the stages before a search may be cut: nails in soft soil go slack and taut again as the weight is
/// raised, which takes more than the five cuts of a case.
const CUTS: u32 = 12;

/// A setting other than that of the case file.
#[derive(Clone, Copy, Debug)]
enum Setting {
    AsGiven,
    /// Most corrections of a step.
    Corrections(usize),
    /// Steps of all other stages, over those of the file.
    Steps(f64),
    Tolerance(f64),
    /// Young's modulus of the softest soil \[Pa\]; the others keep their ratio to it.
    Young(f64),
}

/// The varied settings.
const SETTINGS: [Setting; 15] = [
    Setting::AsGiven,
    Setting::Corrections(10),
    Setting::Corrections(15),
    Setting::Corrections(25),
    Setting::Corrections(40),
    Setting::Steps(0.5),
    Setting::Steps(2.0),
    Setting::Steps(4.0),
    Setting::Tolerance(1e-4),
    Setting::Tolerance(1e-5),
    Setting::Tolerance(1e-7),
    Setting::Young(1e7),
    Setting::Young(1e8),
    Setting::Young(1e9),
    Setting::Young(1e10),
];

impl Setting {
    fn apply<const D: usize>(self, case: &mut Case<D>) {
        match self {
            Self::AsGiven => {}
            Self::Corrections(most) => case.solver.max_iterations = most,
            Self::Steps(by) => {
                for stage in &mut case.stages {
                    stage.steps = ((stage.steps as f64 * by).round() as usize).max(1);
                }
            }
            Self::Tolerance(tolerance) => case.solver.tolerance = tolerance,
            Self::Young(young) => {
                let moduli = case.materials.iter().map(|material| material.young);
                let softest = moduli.fold(f64::INFINITY, f64::min);
                for material in &mut case.materials {
                    material.young *= young / softest;
                }
            }
        }
    }
}

/// All searches of the shipped cases, on the given geometry.
pub(super) fn of_shipped(study: &mut Study, level: Level) -> Result<(), CaseError> {
    let mut note = "searches of the shipped cases, over 15 settings: case, stage; least F, largest F, spread [%]; corrections as \
                    given\n"
        .to_owned();
    for shipped in SHIPPED {
        let is_dear = level < Level::Full && DEAR.contains(&shipped.name);
        if is_dear || STIFFNESS_COUNTS.contains(&shipped.name) {
            continue;
        }
        match shipped.case_file::<String>([])?.any_case() {
            AnyCase::Plane(case) => of_case(study, shipped.name, case, &mut note)?,
            AnyCase::Space(case) => of_case(study, shipped.name, case, &mut note)?,
        }
    }
    study.notes.push(note);
    Ok(())
}

/// The searches of one case, if it has any.
fn of_case<const D: usize>(
    study: &mut Study,
    name: &str,
    case: &Case<D>,
    note: &mut String,
) -> Result<(), CaseError> {
    let Some(case) = searched(case) else {
        return Ok(());
    };
    let found = SETTINGS
        .par_iter()
        .map(|setting| {
            let mut case = case.clone();
            setting.apply(&mut case);
            let computed = Computed::new(case)?;
            let stages = computed.run.summary.stages.iter();
            Ok(stages
                .filter(|stage| stage.safety.is_some())
                .map(|stage| Found::of_stage(&computed, stage))
                .collect::<Vec<_>>())
        })
        .collect::<Result<Vec<_>, CaseError>>()?;
    for (k, first) in found[0].iter().enumerate() {
        let factors: Vec<f64> = (found.iter())
            .map(|stages| stages.get(k).map_or(f64::NAN, |found| found.factor))
            .collect();
        let records: Vec<RunRecord> = (found.iter())
            .filter_map(|stages| Some(stages.get(k)?.record(String::new())))
            .collect();
        let stage = &first.stage.name;
        let name = format!("{name}, {stage}, 15 settings");
        let record = RunRecord::sum(name, &records.iter().collect::<Vec<_>>());
        let [least, most, spread] = check(study, record, &factors);
        let _ = writeln!(
            note,
            "  {}, {stage}; {least:.4}, {most:.4}, {:.3}; {}",
            case.title,
            100.0 * spread,
            first.stage.iterations
        );
    }
    Ok(())
}

/// A case up to its last search, each along the path of equilibria of the given geometry; none without a search.
fn searched<const D: usize>(case: &Case<D>) -> Option<Case<D>> {
    let mut case = case.clone();
    let is_search = |kind: &StageKind| matches!(kind, StageKind::StrengthReduction(_));
    let last = case
        .stages
        .iter()
        .rposition(|stage| is_search(&stage.kind))?;
    case.stages.truncate(last + 1);
    case.curves.clear();
    case.checks.clear();
    case.solver.cuts = CUTS;
    for stage in &mut case.stages {
        if let StageKind::StrengthReduction(reduction) = &mut stage.kind {
            stage.geometry = Geometry::Given;
            reduction.search = SearchMethod::Continuation;
            reduction.factors.clear();
            reduction.failure_displacement = None;
        }
    }
    Some(case)
}

/// The least and the largest factor and their spread, which is held against the theorem.
fn check(study: &mut Study, record: RunRecord, factors: &[f64]) -> [f64; 3] {
    let least = factors.iter().copied().fold(f64::INFINITY, f64::min);
    let most = factors.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let spread = if factors.iter().all(|factor| factor.is_finite()) {
        most / least - 1.0
    } else {
        f64::NAN
    };
    let run = study.run(record);
    study.check(
        run,
        "spread of the factor of safety [-]",
        LIMIT_THEOREMS.says(0.0),
        Band::AtMost(SPREAD),
        spread,
    );
    [least, most, spread]
}

/// One slope with other tolerances, stiffnesses and numbers of corrections.
pub(super) fn of_one_slope(study: &mut Study, problems: &[Problem]) -> Result<(), CaseError> {
    let Some(problem) = problems.iter().find(|p| p.section.name == VARIED) else {
        return Ok(());
    };
    let mut variants: Vec<(f64, Vec<String>)> = Vec::new();
    for tolerance in ["1e-3", "1e-4", "1e-5", "1e-6", "1e-7"] {
        variants.push((YOUNG, vec![format!("solver.tolerance={tolerance}")]));
    }
    for young in [1e4, 1e6, 1e7] {
        variants.push((young, Vec::new()));
    }
    for corrections in [10, 15, 25, 40] {
        variants.push((YOUNG, vec![format!("solver.max_iterations={corrections}")]));
    }
    let mut note =
        format!("{VARIED}, along the path: flow; E [kPa], setting; F; mechanism; corrections\n");
    for associated in [true, false] {
        let sought = Sought {
            problem,
            associated,
            cells: problem.meshes[0],
        };
        let found = variants
            .par_iter()
            .map(|(young, set)| {
                sought.find(
                    Search {
                        young: *young,
                        ..problem.search
                    },
                    true,
                    set,
                )
            })
            .collect::<Result<Vec<_>, CaseError>>()?;
        let flow = if associated { "ψ = φ" } else { "ψ = 0" };
        for ((young, set), found) in variants.iter().zip(&found) {
            let mechanism = found.path().and_then(|path| path.mechanism);
            let _ = writeln!(
                note,
                "  {flow}; {young}, {}; {:.4}; {:.4}; {}",
                set.join(", "),
                found.factor,
                mechanism.map_or(f64::NAN, |point| point.factor),
                found.corrections,
            );
        }
        let name = format!(
            "{VARIED}, {flow}, tolerance 1e-3 to 1e-7, E 10 MPa to 10 GPa, 10 to 40 corrections"
        );
        let factors: Vec<f64> = found.iter().map(|found| found.factor).collect();
        let records: Vec<RunRecord> = found
            .iter()
            .map(|found| found.record(String::new()))
            .collect();
        let record = RunRecord::sum(name, &records.iter().collect::<Vec<_>>());
        check(study, record, &factors);
    }
    study.notes.push(note);
    Ok(())
}
