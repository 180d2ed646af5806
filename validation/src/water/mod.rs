//! Slopes with water in their pores: factors of safety between bounds, and identities that hold to round-off.

mod problems;
mod undrained;

use std::fmt::Write as _;
use std::path::Path;

use igimp_assembly::Locking;
use igimp_cases::CaseError;
use igimp_model::check::Band;
use igimp_model::{Case, PoreSource, WaterCondition};
use igimp_results::mesh_study::{Computed as OnMesh, Convergence};
use igimp_results::tables::table::Table;
use rayon::prelude::*;

use crate::harness::oracle::{Oracle, OracleKind};
use crate::harness::study::coverage::Known;
use crate::harness::study::{Level, RunRecord, Study};
use crate::limit_equilibrium::section::{Section, Variant};
use crate::runs::Computed;
use problems::Problem;

/// The book's description of the study.
const ABOUT: &str = "Slopes with water: submerged, drawn down, with r_u and with phreatic lines, ψ = φ, on the given geometry with shared strain. Factors of safety on two meshes are extrapolated to no width of the cell. A submerged slope is that of buoyant weight, at any level of the water, to round-off.";
const ARCHIMEDES: Oracle = Oracle {
    kind: OracleKind::Exact,
    source: "Archimedes",
    locator: "water that stands everywhere leaves γ_sat − γ_w of the weight, at any level",
};
/// The measured quantity.
const QUANTITY: &str = "factor of safety, extrapolated from two meshes [-]";

impl Problem {
    fn case(&self, cells: u32) -> Result<Case<2>, CaseError> {
        let variant = Variant {
            cells,
            locking: Locking::SharedStrain,
            associated: true,
        };
        let mut case = self.section.case(variant, self.search)?;
        for (material, unit_weight) in std::iter::zip(&mut case.materials, &self.unit_weights) {
            material.unit_weight = 1e3 * unit_weight;
        }
        case.water_unit_weight = 1e3 * self.water_unit_weight;
        case.water = vec![given(self.water.clone())];
        Ok(case)
    }
}

/// A condition for all bodies.
fn given(source: PoreSource) -> WaterCondition {
    WaterCondition {
        name: "water".to_owned(),
        source,
        bodies: Vec::new(),
        carried: false,
    }
}

/// The result of a search on one mesh.
struct Found {
    computed: Computed<2>,
    interval: [f64; 2],
}

impl Found {
    fn of(case: Case<2>) -> Result<Self, CaseError> {
        let computed = Computed::new(case)?;
        let safety = computed.safety();
        let end = |which: fn(&_) -> Option<f64>| safety.and_then(which).unwrap_or(f64::NAN);
        let interval = [end(|safety| safety.stable), end(|safety| safety.failed)];
        Ok(Self { computed, interval })
    }

    fn factor(&self) -> f64 {
        0.5 * (self.interval[0] + self.interval[1])
    }

    fn run(&self, name: String) -> RunRecord {
        let trials = self.computed.trials.iter();
        let runs: Vec<RunRecord> = trials
            .map(|trial| RunRecord::new("", &trial.report, trial.elapsed))
            .collect();
        RunRecord::sum(name, &runs.iter().collect::<Vec<_>>())
    }
}

/// Runs the study.
pub(crate) fn study(level: Level, out: &Path) -> Result<Study, CaseError> {
    let mut study = Study::new("water", ABOUT, out)?;
    submerged(&mut study)?;
    undrained::report(&mut study, level)?;
    let problems: Vec<Problem> = problems::all()
        .into_iter()
        .filter(|problem| problem.level <= level)
        .collect();
    let searches: Vec<(usize, u32)> = (0..problems.len())
        .flat_map(|k| problems[k].meshes.map(|cells| (k, cells)))
        .collect();
    let found = searches
        .par_iter()
        .map(|&(problem, cells)| Found::of(problems[problem].case(cells)?))
        .collect::<Result<Vec<_>, _>>()?;
    let mut table = Table::new(
        "factors_of_safety",
        &[
            "lower_bound_[-]",
            "upper_bound_[-]",
            "coarse_[-]",
            "fine_[-]",
            "extrapolated_[-]",
            "uncertainty_[-]",
        ],
    );
    let (mut factors, mut sums) = (Vec::new(), Vec::new());
    let mut note = String::from("bounds; coarse, fine; extrapolated\n");
    for (problem, found) in std::iter::zip(&problems, found.chunks(2)) {
        let values = [0, 1].map(|mesh| OnMesh {
            h: f64::from(problem.meshes[mesh]).recip(),
            value: found[mesh].factor(),
            half_width: 0.5 * (found[mesh].interval[1] - found[mesh].interval[0]),
        });
        let name = &problem.section.name;
        let both = [0, 1].map(|mesh| found[mesh].run(String::new()));
        let sum = RunRecord::sum(name.clone(), &[&both[0], &both[1]]);
        let run = study.run(sum.clone());
        let known = Known {
            convergence: Convergence::SOIL,
            truth: problem.known,
        };
        let (value, uncertainty) = study
            .extrapolate(format!("{} {name}", problem.group), known, &values)
            .map_or((f64::NAN, f64::NAN), |found| {
                (found.value, found.uncertainty)
            });
        let [lower, upper] = problem.known;
        let expected = problem.oracle.says(0.5 * (lower + upper));
        let beyond = problem.beyond;
        let band = Band::Between((1.0 - beyond) * lower, (1.0 + beyond) * upper);
        study.check(run, QUANTITY, expected, band, value);
        let [coarse, fine] = [&found[0], &found[1]].map(Found::factor);
        factors.push(value);
        sums.push(sum);
        table.push(vec![lower, upper, coarse, fine, value, uncertainty]);
        let _ = writeln!(
            note,
            "  {:<10} {name:<48} {lower:.3} … {upper:.3}; {coarse:.4}, {fine:.4}; {value:.4} ± {uncertainty:.4}",
            problem.group,
        );
    }
    if level == Level::Full {
        minimum_lies_inside(&mut study, &problems, &factors, &sums);
    }
    study.notes.push(note);
    table.write_csv(&study.folder)?;
    Ok(study)
}

/// In a slow drawdown the factor falls before it rises again, by as much at least as the bounds on both sides of it ask.
fn minimum_lies_inside(
    study: &mut Study,
    problems: &[Problem],
    factors: &[f64],
    sums: &[RunRecord],
) {
    for depth in ["D = 1", "D = 1.5"] {
        let places: Vec<usize> = (0..problems.len())
            .filter(|&k| {
                let Problem { group, section, .. } = &problems[k];
                *group == "drawdown" && section.name.ends_with(depth)
            })
            .collect();
        let [first, inside @ .., last] = &places[..] else {
            continue;
        };
        // The least of some values inside over the lesser of others at the ends.
        let over = |inner: &dyn Fn(usize) -> f64, outer: &dyn Fn(usize) -> f64| {
            let least = inside.iter().map(|&k| inner(k));
            least.fold(f64::INFINITY, f64::min) / outer(*first).min(outer(*last))
        };
        let [lower, upper] = [0, 1].map(|end| move |k: usize| problems[k].known[end]);
        let middle = |k: usize| 0.5 * (lower(k) + upper(k));
        let runs: Vec<&RunRecord> = places.iter().map(|&k| &sums[k]).collect();
        let run = study.run(RunRecord::sum(format!("slow drawdown, {depth}"), &runs));
        let quantity = "least factor inside over the lesser one of the ends [-]";
        let expected = problems::MINIMUM.says(over(&middle, &middle));
        let band = Band::AtMost(over(&upper, &lower));
        let measured = over(&|k| factors[k], &|k| factors[k]);
        study.check(run, quantity, expected, band, measured);
    }
}

/// A slope under water against the dry one of buoyant weight.
fn submerged(study: &mut Study) -> Result<(), CaseError> {
    let section = Section::homogeneous("submerged", (2.0, 1.0), (10.0, 20.0), [12.0, 0.0]);
    let with = |water: Option<f64>| -> Result<Found, CaseError> {
        let search = crate::limit_equilibrium::section::Search {
            bracket: [1.0, 2.0],
            path: crate::limit_equilibrium::section::Path::Reduce,
            steps: 10,
            young: crate::limit_equilibrium::section::YOUNG,
        };
        let variant = Variant {
            cells: 10,
            locking: Locking::SharedStrain,
            associated: true,
        };
        let mut case = section.case(variant, search)?;
        case.solver.tolerance = 1e-12;
        match water {
            Some(level) => case.water = vec![given(PoreSource::Table(vec![[0.0, level]]))],
            None => case.materials[0].unit_weight -= case.water_unit_weight,
        }
        Found::of(case)
    };
    let buoyant = with(None)?;
    for level in [10.0, 25.0] {
        let wet = with(Some(level))?;
        let run = study.run(wet.run(format!("water {} m above the crest", level - 10.0)));
        let course = |found: &Found| -> Vec<[f64; 2]> {
            let trials = found.computed.trials.iter();
            trials
                .flat_map(|trial| trial.summary.course.clone())
                .collect()
        };
        let (one, other) = (course(&wet), course(&buoyant));
        let pairs = std::iter::zip(&one, &other);
        let difference = pairs
            .map(|(a, b)| (a[0] - b[0]).abs().max((a[1] / b[1] - 1.0).abs()))
            .fold(
                if one.len() == other.len() {
                    0.0
                } else {
                    f64::NAN
                },
                f64::max,
            );
        let exact = ARCHIMEDES.says(0.0);
        let quantity = "displacements at reduced strength over those of buoyant weight, less 1 [-]";
        study.check(run, quantity, exact, Band::AtMost(1e-8), difference);
        let factors = (wet.factor() - buoyant.factor()).abs();
        let quantity = "factor of safety less that of buoyant weight [-]";
        study.check(run, quantity, exact, Band::AtMost(1e-12), factors);
    }
    Ok(())
}
