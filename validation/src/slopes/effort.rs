//! The cost of shared strain: corrections and cuts of Newton's method over all slopes, beside those of
//! B-bar on the same meshes.

use std::fmt::Write as _;

use igimp_assembly::Locking;
use igimp_cases::CaseError;
use igimp_model::check::Band;
use igimp_results::tables::table::Table;
use rayon::prelude::*;

use super::problems::Problem;
use super::{Found, Slopes};
use crate::harness::oracle::{Oracle, OracleKind};
use crate::harness::study::{RunRecord, Study};
use crate::limit_equilibrium::section::{Search, Variant};
use crate::runs::Computed;

/// Shared strain must not make Newton's method worse.
const AS_BBAR: Oracle = Oracle {
    kind: OracleKind::IndependentProgram,
    source: "B-bar on the same meshes",
    locator: "the search of every slope on its coarser mesh, from a bracket of the same width around the factor found",
};

/// Half the width of the bracket that both searches are given, around the factor that each found \[-\].
const AROUND: f64 = 0.02;

/// The searches of a slope with shared strain and with B-bar.
struct Both {
    slope: usize,
    cells: u32,
    found: [Found; 2],
}

/// Searches both ways, each from a bracket around its own factor of safety: how many trials fail then
/// hangs on the width of the bracket, the same for both, and not on where a factor lies in it.
fn searches(slopes: &Slopes) -> Result<Vec<Both>, CaseError> {
    let both = |(slope, problem): (usize, &Problem)| {
        let cells = problem.meshes[0];
        let search = |locking| {
            let variant = Variant {
                cells,
                locking,
                associated: true,
            };
            let factor = slopes.of(slope, variant)?.factor();
            let search = Search {
                bracket: [factor - AROUND, factor + AROUND],
                ..problem.search
            };
            let case = problem.section.case(variant, search);
            Some(case.and_then(Computed::new).map(Found::of))
        };
        let found = [Locking::SharedStrain, Locking::BBar].map(search);
        let [Some(shared), Some(bbar)] = found else {
            return None;
        };
        Some(shared.and_then(|shared| {
            Ok(Both {
                slope,
                cells,
                found: [shared, bbar?],
            })
        }))
    };
    slopes
        .problems
        .par_iter()
        .enumerate()
        .filter_map(both)
        .collect()
}

/// Counts both over the slopes.
pub(super) fn report(study: &mut Study, slopes: &Slopes) -> Result<(), CaseError> {
    let mut table = Table::new(
        "effort",
        &[
            "slope",
            "cells_over_H",
            "steps_shared",
            "corrections_shared",
            "cuts_shared",
            "failed_trials_shared",
            "steps_b-bar",
            "corrections_b-bar",
            "cuts_b-bar",
            "failed_trials_b-bar",
        ],
    );
    let mut note = String::from(
        "effort: slope, mesh; shared strain: steps, corrections, cuts, failed trials; B-bar: the same\n",
    );
    let mut line = |name: &str, counts: [[usize; 4]; 2]| {
        let [[s, c, u, f], [t, d, v, g]] = counts;
        let _ = writeln!(
            note,
            "  {name:<9} {s:>5} {c:>6} {u:>4} {f:>4}; {t:>5} {d:>6} {v:>4} {g:>4}"
        );
    };
    let mut runs = [const { Vec::new() }; 2];
    let mut failed = [0, 0];
    let of = |run: &RunRecord, fails| [run.steps, run.iterations, run.cuts, fails];
    for Both {
        slope,
        cells,
        found,
    } in searches(slopes)?
    {
        let records = found.each_ref().map(|found| found.run(String::new()));
        let fails = found.each_ref().map(Found::failed_trials);
        let counts = [of(&records[0], fails[0]), of(&records[1], fails[1])];
        line(&format!("{:>2} H/{cells}", slope + 1), counts);
        let mut row = vec![slope as f64 + 1.0, f64::from(cells)];
        row.extend(counts.as_flattened().iter().map(|&count| count as f64));
        table.push(row);
        for (which, run) in records.into_iter().enumerate() {
            failed[which] += fails[which];
            runs[which].push(run);
        }
    }
    let sum =
        |name: &str, runs: &[RunRecord]| RunRecord::sum(name, &runs.iter().collect::<Vec<_>>());
    let [shared, bbar] = [
        sum("shared strain, all slopes", &runs[0]),
        sum("", &runs[1]),
    ];
    line("all", [of(&shared, failed[0]), of(&bbar, failed[1])]);
    let in_a_step = |run: &RunRecord| run.iterations as f64 / run.steps as f64;
    let corrections = in_a_step(&shared) / in_a_step(&bbar);
    let run = study.run(shared);
    study.check(
        run,
        "corrections in a step over those with B-bar [-]",
        AS_BBAR.says(1.0),
        Band::AtMost(1.15),
        corrections,
    );
    study.notes.push(note);
    Ok(table.write_csv(&study.folder)?)
}
