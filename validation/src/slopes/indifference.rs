//! A limit load of a given geometry must not depend on the stiffness of the soil, nor on the steps.

use std::fmt::Write as _;

use igimp_assembly::Locking;
use igimp_cases::CaseError;
use igimp_model::check::Band;
use rayon::prelude::*;

use super::Found;
use super::problems::Problem;
use crate::harness::oracle::{Oracle, OracleKind};
use crate::harness::study::{RunRecord, Study};
use crate::limit_equilibrium::section::{Search, TOLERANCE, Variant};
use crate::runs::Computed;

/// Elastic constants enter no limit load.
const LIMIT_THEOREMS: Oracle = Oracle {
    kind: OracleKind::Theory,
    source: "theorems of limit analysis",
    locator: "the limit load of a given geometry depends on strength alone; band: width of the search",
};
/// The slope that is varied.
const SLOPE: &str = "4.5 m high, 2:1";
/// Young's moduli \[kPa\].
const STIFFNESSES: [f64; 4] = [1e4, 1e5, 1e6, 1e7];
/// Steps through the bracket.
const STEPS: [u32; 3] = [5, 10, 20];

/// Searches on the coarse mesh with each stiffness and each number of steps.
pub(super) fn report(study: &mut Study, problems: &[Problem]) -> Result<(), CaseError> {
    let Some(problem) = problems
        .iter()
        .find(|problem| problem.section.name == SLOPE)
    else {
        return Ok(());
    };
    let usual = problem.search;
    let stiffnesses = STIFFNESSES.map(|young| Search { young, ..usual });
    let steps = STEPS.map(|steps| Search { steps, ..usual });
    let variant = Variant {
        cells: problem.meshes[0],
        locking: Locking::SharedStrain,
        associated: true,
    };
    let mut note = format!("{SLOPE}: E [kPa], steps; computed\n");
    for (span, searches) in [
        ("E of 10 MPa to 10 GPa", &stiffnesses[..]),
        ("5 to 20 steps", &steps[..]),
    ] {
        let found = searches
            .par_iter()
            .map(|&search| {
                let case = problem.section.case(variant, search)?;
                Ok(Found::of(Computed::new(case)?))
            })
            .collect::<Result<Vec<_>, CaseError>>()?;
        for (search, found) in searches.iter().zip(&found) {
            let [stable, failed] = found.interval;
            let _ = writeln!(
                note,
                "  {:>8} {:>2}; {stable:.4} ≤ F < {failed:.4}",
                search.young, search.steps,
            );
        }
        let factors = || found.iter().map(Found::factor);
        let least = factors().fold(f64::INFINITY, f64::min);
        let most = factors().fold(f64::NEG_INFINITY, f64::max);
        let runs: Vec<RunRecord> = found.iter().map(|found| found.run(String::new())).collect();
        let run = RunRecord::sum(format!("{SLOPE}, {span}"), &runs.iter().collect::<Vec<_>>());
        let run = study.run(run);
        study.check(
            run,
            "factor of safety, greatest less least [-]",
            LIMIT_THEOREMS.says(0.0),
            Band::AtMost(TOLERANCE),
            most - least,
        );
    }
    study.notes.push(note);
    Ok(())
}
