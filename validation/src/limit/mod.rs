//! The factor of safety as the limit of a path of equilibria: held against bounds, against the search by trials, and
//! against itself for other tolerances, stiffnesses and steps.

mod davis;
mod dilation;
mod rigid;
mod sand;
mod spread;
mod strengths;

use std::fmt::Write as _;
use std::path::Path as Folder;

use igimp_assembly::Locking;
use igimp_cases::CaseError;
use igimp_model::check::Band;
use igimp_results::ending::PathEnd;
use igimp_results::summary::{PathPoint, PathSummary, StageSummary};
use igimp_text::short;
use rayon::prelude::*;

use crate::harness::oracle::{Oracle, OracleKind};
use crate::harness::reference::{slope_limit_load_bounds, slope_safety_bounds};
use crate::harness::study::{Level, RunRecord, Study};
use crate::limit_equilibrium::section::{Path, Search, Variant};
use crate::runs::Computed;
use crate::slopes::problems::{Asked, Problem, drained, published, undrained};

/// The book's description of the study.
const ABOUT: &str = "The slopes with bounds by limit analysis, searched for along the path of equilibria, the strength reduction factor an unknown: against the bounds, against the search by trials, and against itself for other tolerances, stiffnesses and effort, with all searches of the shipped cases; its changes with the strengths against reruns, its rise with dilation, and associated flow on Davis's strengths beside it.";
/// The measured quantity.
const QUANTITY: &str = "factor of safety [-]";
/// Elastic constants and the solver enter no limit load.
const LIMIT_THEOREMS: Oracle = Oracle {
    kind: OracleKind::Theory,
    source: "theorems of limit analysis",
    locator: "the limit load of a given geometry depends on strength alone; band: the rise that ends a path and a doubling more",
};
/// Work that is dissipated.
const BALANCE: Oracle = Oracle {
    kind: OracleKind::Theory,
    source: "balance of work",
    locator: "stresses of a mechanism stay, so all of the work is dissipated",
};
/// The other way to the same number.
const TRIALS: Oracle = Oracle {
    kind: OracleKind::IndependentProgram,
    source: "search by trials, each of which finds equilibrium or not",
    locator: "the same load path by steps of the factor: a factor at which equilibrium was found is below the limit",
};
/// Largest spread of a factor of safety over settings of the solver, as a share of it \[-\].
const SPREAD: f64 = 3e-3;
/// The slope whose settings are varied.
const VARIED: &str = "4.5 m high, 2:1";

/// A search along a path, or by trials.
struct Sought<'p> {
    problem: &'p Problem,
    associated: bool,
    cells: u32,
}

/// The result of a search.
struct Found {
    factor: f64,
    stage: StageSummary,
    /// Corrections, those of steps that were cut too.
    corrections: usize,
    seconds: f64,
}

impl Found {
    fn of(computed: &Computed<2>) -> Self {
        let stages = &computed.run.summary.stages;
        let nothing = StageSummary::default();
        Self::of_stage(computed, stages.last().unwrap_or(&nothing))
    }

    /// The result of one of its stages. Corrections of steps that were cut count those of all stages.
    fn of_stage<const D: usize>(computed: &Computed<D>, stage: &StageSummary) -> Self {
        let ends = stage
            .safety
            .as_ref()
            .and_then(|found| Some([found.stable?, found.failed?]));
        let reports = computed.trials.iter().map(|trial| &trial.report);
        let failures = reports
            .chain([&computed.report])
            .flat_map(|report| &report.failures);
        let lost: usize = failures
            .map(|error| error.residuals.len().saturating_sub(1))
            .sum();
        Self {
            factor: ends.map_or(f64::NAN, |[stable, failed]| 0.5 * (stable + failed)),
            corrections: stage.iterations + lost,
            seconds: computed.elapsed.as_secs_f64(),
            stage: stage.clone(),
        }
    }

    fn path(&self) -> Option<&PathSummary> {
        self.stage.safety.as_ref()?.path.as_ref()
    }

    fn record(&self, variant: String) -> RunRecord {
        let path = self.path();
        RunRecord {
            variant,
            outcome: path.map_or_else(String::new, |path| path.end.sentence().to_owned()),
            steps: self.stage.steps,
            iterations: self.stage.iterations,
            cuts: self.stage.cuts,
            seconds: self.seconds,
            at_round_off: self.stage.at_round_off,
            phases: [0.0; 5],
            stopped_by: None,
            residuals: Vec::new(),
        }
    }
}

impl Sought<'_> {
    /// The search with settings of the case.
    fn find(
        &self,
        search: Search,
        along_path: bool,
        settings: &[String],
    ) -> Result<Found, CaseError> {
        let stage = match search.path {
            Path::Reduce => 1,
            Path::Gravity => 0,
        };
        let mut overrides = settings.to_vec();
        if along_path {
            overrides.push(format!("stages.{stage}.search=\"continuation\""));
        }
        let variant = Variant {
            cells: self.cells,
            locking: Locking::SharedStrain,
            associated: self.associated,
        };
        let case = self
            .problem
            .section
            .case_with(variant, search, &overrides)?;
        Ok(Found::of(&Computed::new(case)?))
    }

    fn name(&self) -> String {
        let flow = if self.associated { "" } else { ", ψ = 0" };
        format!("{}{flow}, H/{}", self.problem.section.name, self.cells)
    }

    fn asked(&self) -> Asked {
        let without = self.problem.without_dilation.filter(|_| !self.associated);
        without.unwrap_or(self.problem.asked)
    }
}

/// Runs the study.
pub(crate) fn study(level: Level, out: &Folder) -> Result<Study, CaseError> {
    let mut study = Study::new("limit", ABOUT, out)?;
    let mut problems = undrained(&slope_limit_load_bounds().rows());
    problems.extend(drained(&slope_safety_bounds().rows()));
    problems.extend(published());
    // Those that a grid of ten cells sees, with cohesion enough for its cells.
    problems.retain(|problem| problem.known.is_some() && problem.levels[0] < Level::Full);
    problems.retain(|problem| {
        problem
            .section
            .layers
            .iter()
            .all(|layer| layer.cohesion > 3.0)
    });
    let sought = sought(&problems, level);
    let both = sought
        .par_iter()
        .map(|case| {
            let search = case.problem.search;
            let by_path = case.find(search, true, &[])?;
            Ok((by_path, case.find(search, false, &[])?))
        })
        .collect::<Result<Vec<_>, CaseError>>()?;
    let mut note = "along the path: F; mechanism at displacement [m]; corrections against trials; F by trials\n".to_owned();
    for (case, (path, trials)) in sought.iter().zip(&both) {
        against_bounds(&mut study, case, path);
        // Gravity raised anew at every factor is another load path.
        if case.problem.search.path == Path::Reduce {
            against_trials(&mut study, case, path, trials);
        }
        let mechanism = path.path().and_then(|path| path.mechanism);
        let at = |point: PathPoint| format!("{:.4} at {}", point.factor, short(point.displacement));
        let _ = writeln!(
            note,
            "  {}: {:.4}; {}; {} / {}; {:.4}",
            case.name(),
            path.factor,
            mechanism.map_or_else(String::new, at),
            path.corrections,
            trials.corrections,
            trials.factor,
        );
    }
    let sum = |of: fn(&(Found, Found)) -> usize| both.iter().map(of).sum::<usize>();
    let (of_paths, of_trials) = (
        sum(|(path, _)| path.corrections),
        sum(|(_, trials)| trials.corrections),
    );
    let _ = writeln!(
        note,
        "  all corrections: {of_paths} along paths, {of_trials} by trials, a ratio of {:.2}",
        of_paths as f64 / of_trials as f64
    );
    study.notes.push(note);
    if level >= Level::Default {
        spread::of_one_slope(&mut study, &problems)?;
        spread::of_shipped(&mut study, level)?;
        strengths::against_reruns(&mut study, &problems)?;
        dilation::raises_to_associated(&mut study, level)?;
        rigid::carries_as_displaced(&mut study)?;
        sand::slides_along_its_face(&mut study, level)?;
        davis::beside_dilation(&mut study, level)?;
    }
    Ok(study)
}

/// The searches of a level.
fn sought(problems: &[Problem], level: Level) -> Vec<Sought<'_>> {
    let mut all = Vec::new();
    for problem in problems {
        for (mesh, &cells) in problem.meshes.iter().enumerate() {
            let is_wanted = match level {
                Level::Quick => mesh == 0 && problem.section.name == VARIED,
                Level::Default => mesh == 0,
                Level::Full => true,
            };
            if !is_wanted {
                continue;
            }
            for associated in [true, false] {
                if associated || problem.without_dilation.is_some() {
                    all.push(Sought {
                        problem,
                        associated,
                        cells,
                    });
                }
            }
        }
    }
    all
}

/// A factor against the known bounds, and its mechanism against the balance of work.
fn against_bounds(study: &mut Study, case: &Sought<'_>, found: &Found) {
    let Some([low, high]) = case.problem.known else {
        return;
    };
    let asked = case.asked();
    let mesh = case
        .problem
        .meshes
        .iter()
        .position(|&cells| cells == case.cells);
    let above = asked.above[mesh.unwrap_or(0).min(1)];
    let run = study.run(found.record(case.name()));
    study.check(
        run,
        QUANTITY,
        case.problem.oracle.says(0.5 * (low + high)),
        Band::Between((1.0 - asked.below) * low, (1.0 + above) * high),
        found.factor,
    );
    let last = found.path().and_then(|path| path.points.last());
    let at_limit = found.path().is_some_and(|path| path.end == PathEnd::Limit);
    if at_limit {
        study.check(
            run,
            "share of the work that the last step dissipates [-]",
            BALANCE.says(1.0),
            Band::Between(0.99, 1.0),
            last.map_or(f64::NAN, |point| point.dissipated),
        );
    }
}

/// A factor against the largest one at which a search by trials found equilibrium.
fn against_trials(study: &mut Study, case: &Sought<'_>, path: &Found, trials: &Found) {
    let stable = trials.stage.safety.as_ref().and_then(|found| found.stable);
    let failed = path.stage.safety.as_ref().and_then(|found| found.failed);
    let run = study.run(trials.record(format!("{}, by trials", case.name())));
    study.check(
        run,
        "upper end of the interval along the path over the largest that stands by trials [-]",
        TRIALS.says(1.0),
        Band::AtLeast(1.0 - SPREAD),
        failed.unwrap_or(f64::NAN) / stable.unwrap_or(f64::NAN),
    );
}
