//! Slopes whose factor of safety is known: undrained and drained ones with bounds by limit analysis,
//! and layered ones from the literature; each with a second opinion by hand calculation.

mod effort;
mod indifference;
mod mesh_error;
mod picture;
pub(crate) mod problems;

use std::fmt::Write as _;
use std::path::Path;

use igimp_assembly::Locking;
use igimp_cases::CaseError;
use igimp_model::check::Band;
use igimp_results::tables::table::Table;
use rayon::prelude::*;

use crate::harness::reference::{slope_limit_load_bounds, slope_safety_bounds};
use crate::harness::study::{Level, RunRecord, Study};
use crate::limit_equilibrium::section::{Variant, YOUNG};
use crate::limit_equilibrium::{bishop, rotation, sliding};
use crate::runs::Computed;
use crate::slopes::problems::{
    Asked, Opinion, Problem, drained, published, undrained, weak_layer_edges,
};

/// The book's description of the study.
const ABOUT: &str = "Slopes of undrained and drained soil, homogeneous and in layers, whose factor of safety is bounded by limit analysis or published; the factor of safety of the given geometry is searched for on two meshes, with its mesh error, and every slope has a second opinion by hand calculation.";
/// The measured quantity.
const QUANTITY: &str = "factor of safety [-]";
/// The measured quantity of soil that locks.
const STANDS: &str = "largest factor that stands [-]";
/// By how much an upper bound of rigid blocks may lie above the factor of safety \[-\].
const BLOCKS: f64 = 0.05;

/// A search for the factor of safety of one slope.
#[derive(Clone, Copy)]
struct Sought {
    problem: usize,
    variant: Variant,
}

/// The result of a search.
pub(crate) struct Found {
    /// Largest factor found stable, smallest found failed \[-\].
    interval: [f64; 2],
    computed: Computed<2>,
}

impl Found {
    pub(crate) fn factor(&self) -> f64 {
        0.5 * (self.interval[0] + self.interval[1])
    }

    pub(crate) fn half_width(&self) -> f64 {
        0.5 * (self.interval[1] - self.interval[0])
    }

    /// How many trials failed.
    fn failed_trials(&self) -> usize {
        let trials = self.computed.trials.iter();
        trials.filter(|trial| !trial.summary.stable).count()
    }

    /// All trials as one run.
    pub(crate) fn run(&self, name: String) -> RunRecord {
        let trials = self.computed.trials.iter();
        let runs: Vec<RunRecord> = trials
            .map(|trial| RunRecord::new("", &trial.report, trial.elapsed))
            .collect();
        RunRecord::sum(name, &runs.iter().collect::<Vec<_>>())
    }
}

/// The known factors of a slope: by its oracle, and by hand.
pub(crate) struct Known {
    /// Least and greatest value \[-\].
    pub(crate) interval: [f64; 2],
    /// The hand calculation \[-\].
    pub(crate) opinion: f64,
}

/// All slopes, their known factors and their results.
struct Slopes {
    problems: Vec<Problem>,
    known: Vec<Known>,
    sought: Vec<Sought>,
    found: Vec<Found>,
}

impl Slopes {
    /// The result for a variant of a slope, if that was run.
    fn of(&self, problem: usize, variant: Variant) -> Option<&Found> {
        let mut sought = self.sought.iter();
        let place = sought.position(|s| s.problem == problem && s.variant == variant)?;
        Some(&self.found[place])
    }
}

/// Runs the study.
pub(crate) fn study(level: Level, out: &Path) -> Result<Study, CaseError> {
    let mut study = Study::new("slopes", ABOUT, out)?;
    let mut problems = undrained(&slope_limit_load_bounds().rows());
    problems.extend(drained(&slope_safety_bounds().rows()));
    problems.extend(published());
    let sought = sought(&problems, level);
    let known = problems.par_iter().map(second_opinion).collect::<Vec<_>>();
    let found = sought
        .par_iter()
        .map(|sought| problems[sought.problem].find(sought.variant))
        .collect::<Result<Vec<_>, _>>()?;
    let slopes = Slopes {
        problems,
        known,
        sought,
        found,
    };
    for (sought, found) in slopes.sought.iter().zip(&slopes.found) {
        let problem = &slopes.problems[sought.problem];
        let known = &slopes.known[sought.problem];
        report(&mut study, problem, known, sought.variant, found)?;
    }
    mesh_error::report(&mut study, &slopes)?;
    if level >= Level::Default {
        indifference::report(&mut study, &slopes.problems)?;
    }
    if level == Level::Full {
        effort::report(&mut study, &slopes)?;
    }
    summary(&mut study, &slopes)?;
    let found = slopes.sought.iter().zip(&slopes.found);
    let points: Vec<_> = found
        .map(|(sought, found)| (sought.problem, sought.variant, found.factor()))
        .collect();
    picture::write(&study.folder, &slopes.known, &points)?;
    Ok(study)
}

/// The runs of a level.
fn sought(problems: &[Problem], level: Level) -> Vec<Sought> {
    let variant = |cells, locking, associated| Variant {
        cells,
        locking,
        associated,
    };
    let mut all = Vec::new();
    for (problem, slope) in problems.iter().enumerate() {
        let mut seek = |variant| all.push(Sought { problem, variant });
        for (&cells, &least) in slope.meshes.iter().zip(&slope.levels) {
            if level < least {
                continue;
            }
            seek(variant(cells, Locking::SharedStrain, true));
            if level >= Level::Default && slope.without_dilation.is_some() {
                seek(variant(cells, Locking::SharedStrain, false));
            }
            let is_coarse = cells == slope.meshes[0];
            if level == Level::Full && is_coarse {
                seek(variant(cells, Locking::BBar, true));
            }
            if level >= Level::Default && is_coarse && slope.locks {
                seek(variant(cells, Locking::None, true));
            }
        }
    }
    all
}

impl Problem {
    /// Searches for the factor of safety.
    fn find(&self, variant: Variant) -> Result<Found, CaseError> {
        let case = self.section.case(variant, self.search)?;
        Ok(Found::of(Computed::new(case)?))
    }

    /// The claim on a variant.
    fn asked(&self, variant: Variant) -> Option<Asked> {
        match (variant.locking, variant.associated) {
            (Locking::SharedStrain, true) => Some(self.asked),
            (Locking::SharedStrain, false) => self.without_dilation,
            _ => None,
        }
    }
}

impl Found {
    pub(crate) fn of(computed: Computed<2>) -> Self {
        let safety = computed.safety();
        let end = |which: fn(&_) -> Option<f64>| safety.and_then(which).unwrap_or(f64::NAN);
        Self {
            interval: [end(|safety| safety.stable), end(|safety| safety.failed)],
            computed,
        }
    }
}

/// The hand calculation of a slope, and its known factor.
fn second_opinion(problem: &Problem) -> Known {
    let section = &problem.section;
    let opinion = match problem.opinion {
        Opinion::Rotation => rotation::upper_bound(section),
        Opinion::Bishop => bishop::factor_of_safety(section),
        Opinion::Sliding => {
            let slide = sliding::upper_bound(section, weak_layer_edges());
            rotation::upper_bound(section).min(slide)
        }
    };
    Known {
        interval: problem.known.unwrap_or([(1.0 - BLOCKS) * opinion, opinion]),
        opinion,
    }
}

/// Checks one search and keeps its trials.
fn report(
    study: &mut Study,
    problem: &Problem,
    known: &Known,
    variant: Variant,
    found: &Found,
) -> Result<(), CaseError> {
    let name = label(problem, variant, &found.computed);
    let run = study.run(found.run(name.clone()));
    let [lower, upper] = known.interval;
    let expected = problem.oracle.says(0.5 * (lower + upper));
    if variant.locking == Locking::None {
        let band = Band::AtLeast(1.02 * upper);
        // Soil that locks carries any load on a given geometry: there is a factor that stands, and
        // often none that fails.
        study.control(run, STANDS, expected, band, found.interval[0]);
    } else if let Some(asked) = problem.asked(variant) {
        let above = asked.above[usize::from(variant.cells != problem.meshes[0])];
        let band = Band::Between((1.0 - asked.below) * lower, (1.0 + above) * upper);
        study.check(run, QUANTITY, expected, band, found.factor());
    }
    let scale = YOUNG / (problem.section.unit_weight * problem.section.height.powi(2));
    let mut trials = Table::new(
        slug(&name),
        &[
            "SRF_[-]",
            "E_displacement/(gamma_H2)_[-]",
            "stands_(1)_or_failed_(0)",
        ],
    );
    for trial in found.computed.trials.iter().map(|trial| &trial.summary) {
        for &[srf, displacement] in &trial.course {
            trials.push(vec![srf, displacement * scale, 1.0]);
        }
        let stands = f64::from(u8::from(trial.stable));
        if !trial.stable {
            // Past failure displacements hang on round-off.
            trials.push(vec![trial.srf, f64::NAN, stands]);
        } else if trial.course.is_empty() {
            trials.push(vec![trial.srf, trial.displacement * scale, stands]);
        }
    }
    study.table(trials)
}

/// All factors in one table, as CSV and for the reader of the report.
fn summary(study: &mut Study, slopes: &Slopes) -> Result<(), CaseError> {
    let mut table = Table::new(
        "factors_of_safety",
        &[
            "slope",
            "cells_over_H",
            "none_(0)_b-bar_(1)_shared_strain_(2)",
            "psi=phi",
            "known_from_[-]",
            "known_to_[-]",
            "by_hand_[-]",
            "stands_at_[-]",
            "fails_at_[-]",
        ],
    );
    let mut note = String::from("factors of safety: known; by hand; computed\n");
    for (sought, found) in slopes.sought.iter().zip(&slopes.found) {
        let problem = &slopes.problems[sought.problem];
        let known = &slopes.known[sought.problem];
        let ([lower, upper], [stable, failed]) = (known.interval, found.interval);
        let Variant {
            cells,
            locking,
            associated,
        } = sought.variant;
        let cure = match locking {
            Locking::None => 0.0,
            Locking::BBar => 1.0,
            Locking::SharedStrain => 2.0,
        };
        table.push(vec![
            sought.problem as f64 + 1.0,
            f64::from(cells),
            cure,
            f64::from(u8::from(associated)),
            lower,
            upper,
            known.opinion,
            stable,
            failed,
        ]);
        let _ = writeln!(
            note,
            "  {:>2} {:<64} {lower:.3} … {upper:.3}; {:.3}; {stable:.3} ≤ F < {failed:.3}",
            sought.problem + 1,
            label(problem, sought.variant, &found.computed),
            known.opinion,
        );
    }
    study.notes.push(note);
    Ok(table.write_csv(&study.folder)?)
}

/// Slope, method, mesh and flow rule in words.
fn label(problem: &Problem, variant: Variant, computed: &Computed<2>) -> String {
    let drained = problem.section.layers.iter().any(|l| l.friction > 0.0);
    let flow = match (drained, variant.associated) {
        (false, _) => "",
        (true, true) => ", ψ = φ",
        (true, false) => ", ψ = 0",
    };
    format!(
        "{}, {}, h = H/{}{flow}",
        problem.section.name,
        computed.method(),
        variant.cells,
    )
}

/// A label as a file name.
fn slug(label: &str) -> String {
    let plain = label
        .replace('ψ', "psi")
        .replace('φ', "phi")
        .replace('°', "");
    let words: Vec<String> = plain
        .split(|c: char| !c.is_ascii_alphanumeric() && c != '.')
        .filter(|word| !word.is_empty())
        .map(str::to_lowercase)
        .collect();
    words.join("_")
}
