//! Slopes whose factor of safety is known: undrained and drained ones with bounds by limit analysis,
//! and layered ones from the literature; each with a second opinion by hand calculation.

mod picture;
pub(crate) mod problems;
pub(crate) mod section;

use std::fmt::Write as _;
use std::path::Path;

use igimp_cases::CaseError;
use igimp_cases::check::Band;
use igimp_cases::table::Table;
use rayon::prelude::*;

use crate::limit_equilibrium::{bishop, rotation, sliding};
use crate::oracle::OracleKind;
use crate::reference::{slope_limit_load_bounds, slope_safety_bounds};
use crate::runs::Computed;
use crate::slopes::problems::{Opinion, Problem, drained, published, undrained, weak_layer_edges};
use crate::slopes::section::Variant;
use crate::study::{Level, Run, Study};

/// What the book says of the study.
const ABOUT: &str = "Slopes of undrained and drained soil, homogeneous and in layers, whose factor of safety is bounded by limit analysis or published; strength is reduced on up to three meshes, and every slope has a second opinion by hand calculation.";
/// What is measured.
const QUANTITY: &str = "factor of safety [-]";
/// What is extrapolated: the factor falls with the cell at about first order.
const EXTRAPOLATED: &str = "factor of safety, 2 F(h) − F(2h) [-]";
/// By how much an upper bound of rigid blocks may lie above the factor of safety \[-\].
const BLOCKS: f64 = 0.05;

/// A search for the factor of safety of one slope.
#[derive(Clone, Copy)]
struct Search {
    problem: usize,
    variant: Variant,
}

/// What a search found.
pub(crate) struct Found {
    /// Largest factor found stable, smallest found failed \[-\].
    interval: [f64; 2],
    computed: Computed,
}

impl Found {
    fn factor(&self) -> f64 {
        0.5 * (self.interval[0] + self.interval[1])
    }
}

/// What is known of a slope: by its oracle, and by hand.
pub(crate) struct Known {
    /// Least and greatest value \[-\].
    pub(crate) interval: [f64; 2],
    /// The hand calculation \[-\].
    pub(crate) opinion: f64,
}

/// Runs the study.
pub(crate) fn study(level: Level, out: &Path) -> Result<Study, CaseError> {
    let mut study = Study::new("slopes", ABOUT, out)?;
    let mut problems = undrained(&slope_limit_load_bounds().rows());
    problems.extend(drained(&slope_safety_bounds().rows()));
    problems.extend(published());
    let searches = searches(&problems, level);
    let known = problems.par_iter().map(second_opinion).collect::<Vec<_>>();
    let found = searches
        .par_iter()
        .map(|search| problems[search.problem].find(search.variant))
        .collect::<Result<Vec<_>, _>>()?;
    for (search, found) in searches.iter().zip(&found) {
        let (problem, known) = (&problems[search.problem], &known[search.problem]);
        report(&mut study, problem, known, search.variant, found)?;
    }
    extrapolate(&mut study, &problems, &known, &searches, &found);
    summary(&mut study, &problems, &known, &searches, &found)?;
    let points: Vec<_> = searches
        .iter()
        .zip(&found)
        .map(|(search, found)| (search.problem, search.variant, found.factor()))
        .collect();
    picture::write(&study.folder, &known, &points)?;
    Ok(study)
}

/// What is run at a level.
fn searches(problems: &[Problem], level: Level) -> Vec<Search> {
    let variant = |cells, bbar, associated| Variant {
        cells,
        bbar,
        associated,
    };
    let mut searches = Vec::new();
    for (k, problem) in problems.iter().enumerate() {
        let mut search = |variant| {
            searches.push(Search {
                problem: k,
                variant,
            });
        };
        // Values of slices know no flow rule: ψ = 0 is run where bounds are known.
        let drained = problem.oracle.kind == OracleKind::LimitAnalysis
            && problem.section.layers[0].friction > 0.0;
        for (place, &cells) in problem.meshes.iter().enumerate() {
            if level == Level::Full || (place == 0 && level >= problem.level) {
                search(variant(cells, true, true));
            }
            if level == Level::Full && drained && cells <= 20 {
                search(variant(cells, true, false));
            }
        }
        if level >= Level::Default && problem.locks {
            search(variant(problem.meshes[0], false, true));
        }
    }
    searches
}

impl Problem {
    /// Searches for the factor of safety.
    fn find(&self, variant: Variant) -> Result<Found, CaseError> {
        let bracket = self.bracket;
        let computed = Computed::new(self.section.case(variant, bracket)?)?;
        let safety = computed.safety();
        let end = |which: fn(&_) -> Option<f64>| safety.and_then(which).unwrap_or(f64::NAN);
        Ok(Found {
            interval: [end(|safety| safety.stable), end(|safety| safety.failed)],
            computed,
        })
    }
}

/// The hand calculation of a slope, and what is known with it.
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
    let run = Run::sum(
        name.clone(),
        &found
            .computed
            .trials
            .iter()
            .map(|trial| Run::new("", &trial.report, trial.elapsed))
            .collect::<Vec<_>>()
            .iter()
            .collect::<Vec<_>>(),
    );
    let run = study.run(run);
    let [lower, upper] = known.interval;
    let expected = problem.oracle.says(0.5 * (lower + upper));
    if !variant.bbar {
        let band = Band::AtLeast(1.02 * upper);
        study.control(run, QUANTITY, expected, band, found.factor());
    } else if variant.associated {
        let share = problem.excess * (10.0 / f64::from(variant.cells)).powf(2.0 / 3.0);
        let band = Band::Between(0.98 * lower, (1.0 + share) * upper);
        study.check(run, QUANTITY, expected, band, found.factor());
    }
    let limit = problem.section.failure_displacement();
    let mut trials = Table::new(
        slug(&name),
        &[
            "SRF_[-]",
            "displacement/limit_[-]",
            "stands_(1)_or_failed_(0)",
        ],
    );
    for trial in found.computed.trials.iter().map(|trial| &trial.summary) {
        // Past failure displacements hang on round-off.
        let displacement = if trial.stable {
            trial.displacement / limit
        } else {
            1.0
        };
        trials.push(vec![
            trial.srf,
            displacement,
            f64::from(u8::from(trial.stable)),
        ]);
    }
    study.table(trials)
}

/// First-order extrapolation from the two finest meshes of each homogeneous slope. Coarse cells do not
/// see the thin ends of layers, so that layered ones have no order.
fn extrapolate(
    study: &mut Study,
    problems: &[Problem],
    known: &[Known],
    searches: &[Search],
    found: &[Found],
) {
    let homogeneous = |problem: &Problem| problem.section.layers.len() == 1;
    let chosen = problems.iter().enumerate();
    for (k, problem) in chosen.filter(|(_, problem)| homogeneous(problem)) {
        let on = |cells| {
            let variant = Variant {
                cells,
                bbar: true,
                associated: true,
            };
            let place = searches
                .iter()
                .position(|s| s.problem == k && s.variant == variant);
            place.map(|place| (place, found[place].factor()))
        };
        let finest = problem.meshes[problem.meshes.len() - 1];
        if let (Some((_, coarse)), Some((place, fine))) = (on(finest / 2), on(finest)) {
            let [lower, upper] = known[k].interval;
            let expected = problem.oracle.says(0.5 * (lower + upper));
            let band = Band::Between(0.98 * lower, 1.02 * upper);
            study.check(place, EXTRAPOLATED, expected, band, 2.0 * fine - coarse);
        }
    }
}

/// All factors in one table, as CSV and for the reader of the report.
fn summary(
    study: &mut Study,
    problems: &[Problem],
    known: &[Known],
    searches: &[Search],
    found: &[Found],
) -> Result<(), CaseError> {
    let mut table = Table::new(
        "factors_of_safety",
        &[
            "slope",
            "cells_over_H",
            "bbar",
            "psi=phi",
            "known_from_[-]",
            "known_to_[-]",
            "by_hand_[-]",
            "stands_at_[-]",
            "fails_at_[-]",
        ],
    );
    let mut note = String::from("factors of safety: known; by hand; computed\n");
    for (search, found) in searches.iter().zip(found) {
        let (problem, known) = (&problems[search.problem], &known[search.problem]);
        let ([lower, upper], [stable, failed]) = (known.interval, found.interval);
        let Variant {
            cells,
            bbar,
            associated,
        } = search.variant;
        table.push(vec![
            search.problem as f64 + 1.0,
            f64::from(cells),
            f64::from(u8::from(bbar)),
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
            search.problem + 1,
            label(problem, search.variant, &found.computed),
            known.opinion,
        );
    }
    study.notes.push(note);
    table.write_csv(&study.folder)
}

/// Slope, method, mesh and flow rule in words.
fn label(problem: &Problem, variant: Variant, computed: &Computed) -> String {
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
