//! The mesh error of every slope with bounds: what two meshes say of the factor on cells of no size.

use std::fmt::Write as _;

use igimp_assembly::Locking;
use igimp_cases::CaseError;
use igimp_model::check::Band;
use igimp_results::mesh_study::{Computed, Convergence, estimate};
use igimp_results::tables::table::Table;

use super::{Found, Slopes};
use crate::harness::oracle::{Oracle, OracleKind};
use crate::harness::study::coverage::Known;
use crate::harness::study::{RunRecord, Study};
use crate::limit_equilibrium::section::Variant;

/// What is extrapolated.
const EXTRAPOLATED: &str = "factor of safety, extrapolated from two meshes [-]";
/// How far the extrapolated factor may lie beyond the bounds \[-\].
const BEYOND: f64 = 0.015;
/// What the stated uncertainty promises.
const UNCERTAINTY: Oracle = Oracle {
    kind: OracleKind::LimitAnalysis,
    source: "lower and upper bounds of all slopes that have both",
    locator: "extrapolated value and uncertainty overlap the bounds in nine of ten",
};

/// Extrapolates each slope that has bounds and was run on both meshes, with ψ = φ and ψ = 0.
pub(super) fn report(study: &mut Study, slopes: &Slopes) -> Result<(), CaseError> {
    let mut table = Table::new(
        "mesh_error",
        &[
            "slope",
            "psi=phi",
            "known_from_[-]",
            "known_to_[-]",
            "coarse_[-]",
            "fine_[-]",
            "extrapolated_[-]",
            "uncertainty_[-]",
            "covers_the_bounds",
        ],
    );
    let mut note = String::from("mesh error: known; coarse, fine; extrapolated\n");
    let mut runs = Vec::new();
    let mut covered = 0_usize;
    let with_bounds = slopes.problems.iter().enumerate();
    for (place, problem) in
        with_bounds.filter(|(_, p)| p.oracle.kind == OracleKind::LimitAnalysis && p.known.is_some())
    {
        for associated in [true, false] {
            let on = |mesh: usize| {
                let variant = Variant {
                    cells: problem.meshes[mesh],
                    locking: Locking::SharedStrain,
                    associated,
                };
                slopes.of(place, variant)
            };
            let (Some(coarse), Some(fine)) = (on(0), on(1)) else {
                continue;
            };
            let flow = if associated { "" } else { ", ψ = 0" };
            let name = format!("{}{flow}, two meshes", problem.section.name);
            let truth = slopes.known[place].interval;
            let [lower, upper] = truth;
            let values = values([coarse, fine], &problem.meshes);
            let known = Known {
                convergence: Convergence::SOIL,
                truth,
            };
            // ψ = 0 knows no bounds of its own.
            let found = if associated {
                study.extrapolate(name.clone(), known, &values)
            } else {
                estimate(&values, known.convergence)
            };
            let Some(found) = found else { continue };
            let covers = found.value - found.uncertainty <= upper
                && found.value + found.uncertainty >= lower;
            let both = [coarse, fine].map(|found| found.run(String::new()));
            let both = RunRecord::sum(name.clone(), &[&both[0], &both[1]]);
            let run = study.run(both.clone());
            if associated {
                covered += usize::from(covers);
                runs.push(both);
                let expected = problem.oracle.says(0.5 * (lower + upper));
                let band = Band::Between((1.0 - BEYOND) * lower, (1.0 + BEYOND) * upper);
                study.check(run, EXTRAPOLATED, expected, band, found.value);
            }
            table.push(vec![
                place as f64 + 1.0,
                f64::from(u8::from(associated)),
                lower,
                upper,
                coarse.factor(),
                fine.factor(),
                found.value,
                found.uncertainty,
                f64::from(u8::from(covers)),
            ]);
            let _ = writeln!(
                note,
                "  {:>2} {name:<48} {lower:.3} … {upper:.3}; {:.4}, {:.4}; {:.4} ± {:.4}",
                place + 1,
                coarse.factor(),
                fine.factor(),
                found.value,
                found.uncertainty,
            );
        }
    }
    if runs.is_empty() {
        return Ok(());
    }
    let counted = runs.len();
    let all = format!("all {counted} slopes with bounds");
    let run = study.run(RunRecord::sum(all, &runs.iter().collect::<Vec<_>>()));
    study.check(
        run,
        "share of slopes whose bounds the uncertainty reaches [-]",
        UNCERTAINTY.says(1.0),
        Band::AtLeast(0.9),
        covered as f64 / counted as f64,
    );
    study.notes.push(note);
    Ok(table.write_csv(&study.folder)?)
}

/// The factors on a coarse and a fine mesh.
fn values(found: [&Found; 2], meshes: &[u32]) -> [Computed; 2] {
    [0, 1].map(|mesh| Computed {
        h: f64::from(meshes[mesh]).recip(),
        value: found[mesh].factor(),
        half_width: found[mesh].half_width(),
    })
}
