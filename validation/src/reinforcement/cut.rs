//! A vertical cut held by nails, against limit analysis.

use std::path::Path;

use igimp_cases::CaseError;
use igimp_model::check::Band;
use igimp_results::mesh_study::Convergence;
use igimp_results::tables::table::Table;
use rayon::prelude::*;

use super::circle::{Cut, Nail};
use crate::harness::oracle::{Oracle, OracleKind};
use crate::harness::study::coverage::{self, Known, on_cells};
use crate::harness::study::{Level, RunRecord, Study};
use crate::runs::{Computed, mesh, shipped_case};

/// The book's description of the study.
const ABOUT: &str = "The shipped cut of 5 m in undrained clay on rock, γH/c_u = 4, held by three rows of nails and a facing, and the same cut without them. Factors of safety on two meshes are extrapolated to no width of the cell. Reinforcement that pulls weakens no soil, so the lower bound without nails holds; circles through the nails, least over all of them, give the upper bound.";
const BOUNDS: Oracle = Oracle {
    kind: OracleKind::LimitAnalysis,
    source: "limit theorems: finite-element lower bound of the cut without nails, 3.759; circles through the nails",
    locator: "lower and upper bound of F",
};
const WITHOUT: Oracle = Oracle {
    kind: OracleKind::LimitAnalysis,
    source: "finite-element limit analysis of the vertical cut in undrained clay",
    locator: "γH/c_u = 3.759 to 3.795",
};
/// γH/c_u at which a cut without nails falls.
const NUMBER: [f64; 2] = [3.759, 3.795];
/// γH/c_u of this cut.
const LOADED: f64 = 4.0;

/// The cut as the case has it.
fn cut() -> Cut {
    let nail = |level: f64| Nail {
        head: [10.0, level],
        end: [5.0, level - 0.5],
        capacity: 30.0,
        plate: 20.0,
        bond: 20.0,
    };
    Cut {
        face: 10.0,
        height: 5.0,
        unit_weight: 20.0,
        strength: 25.0,
        nails: [4.25, 2.75, 1.25].map(nail).into(),
    }
}

/// A search on a mesh.
struct Search {
    has_nails: bool,
    /// Size of the cells \[m\].
    cell: f64,
}

impl Search {
    fn run(&self) -> Result<Computed<2>, CaseError> {
        let cell = self.cell;
        let mut overrides = mesh(cell, [11.0, 5.0 + 2.0 * cell]);
        if !self.has_nails {
            overrides.push("curves=[]".to_owned());
            overrides.push("reinforcement=[]".to_owned());
            // The cut that stands without nails.
            overrides.push("case.gravity=\"8 m/s2\"".to_owned());
            overrides.push("materials.clay.unit_weight=\"16 kN/m3\"".to_owned());
        }
        overrides.push("stages.factor of safety.tolerance=0.004".to_owned());
        Computed::new(shipped_case("nailed_cut", overrides)?)
    }

    fn nails(&self) -> &'static str {
        if self.has_nails { "nails" } else { "no nails" }
    }

    /// Least and greatest factor of safety that is known, and from where.
    fn bounds(&self, upper: f64) -> (f64, f64, Oracle) {
        if self.has_nails {
            (NUMBER[0] / LOADED, upper, BOUNDS)
        } else {
            let [low, high] = NUMBER.map(|number| number / (0.8 * LOADED));
            (low, high, WITHOUT)
        }
    }
}

/// The trials of a search as one run.
fn trials(name: String, result: &Computed<2>) -> RunRecord {
    let trials: Vec<RunRecord> = (result.trials.iter())
        .map(|trial| RunRecord::new("", &trial.report, trial.elapsed))
        .collect();
    RunRecord::sum(name, &trials.iter().collect::<Vec<_>>())
}

/// Runs the study.
pub(crate) fn study(level: Level, out: &Path) -> Result<Study, CaseError> {
    let mut study = Study::new("reinforcement-cut", ABOUT, out)?;
    let cells: &[f64] = if level == Level::Full {
        &[0.5, 0.25, 0.125]
    } else {
        &[0.5, 0.25]
    };
    let searches: Vec<Search> = [true, false]
        .into_iter()
        .flat_map(|has_nails| cells.iter().map(move |&cell| Search { has_nails, cell }))
        .collect();
    let results = searches
        .par_iter()
        .map(Search::run)
        .collect::<Result<Vec<_>, _>>()?;
    let upper = cut().upper_bound();
    let header = [
        "nails",
        "h_[m]",
        "F_[-]",
        "lower_bound_[-]",
        "upper_bound_[-]",
    ];
    let mut table = Table::new("factors_of_safety", &header);
    let meshes = cells.len();
    for (group, computed) in std::iter::zip(searches.chunks(meshes), results.chunks(meshes)) {
        let mut before: Option<[f64; 2]> = None;
        for (search, result) in std::iter::zip(group, computed) {
            let nails = search.nails();
            let name = format!("{nails}, h = {} m", search.cell);
            let run = study.run(trials(name, result));
            let found = result
                .safety()
                .and_then(|safety| Some((safety.stable?, safety.failed?)));
            let found = found.map_or(f64::NAN, |(stable, failed)| 0.5 * (stable + failed));
            let (low, high, oracle) = search.bounds(upper);
            table.push(vec![
                f64::from(u8::from(search.has_nails)),
                search.cell,
                found,
                low,
                high,
            ]);
            let narrow = search.cell;
            if let Some([wide, coarse]) = before {
                let convergence = if search.has_nails {
                    Convergence::CONTACT
                } else {
                    Convergence::SOIL
                };
                let truth = [low, high];
                let known = Known { convergence, truth };
                let values = [on_cells(wide, coarse), on_cells(narrow, found)];
                let estimate =
                    study.extrapolate(format!("cut, {nails}, h = {narrow} m"), known, &values);
                study.check(
                    run,
                    format!("F, h = {wide} and {narrow} m extrapolated to h = 0 [-]"),
                    oracle.says(0.5 * (low + high)),
                    Band::Between(0.985 * low, 1.015 * high),
                    coverage::value(estimate),
                );
            }
            before = Some([narrow, found]);
        }
    }
    table.write_csv(&study.folder)?;
    Ok(study)
}
