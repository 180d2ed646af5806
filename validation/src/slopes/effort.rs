//! What shared strain costs: corrections and cuts of Newton's method over all slopes, beside those of
//! B-bar on the same meshes.

use std::fmt::Write as _;

use igimp_assembly::Locking;
use igimp_cases::CaseError;
use igimp_cases::check::Band;
use igimp_cases::table::Table;

use super::section::Variant;
use super::{Found, Slopes};
use crate::oracle::{Oracle, OracleKind};
use crate::study::{RunRecord, Study};

/// Shared strain must not make Newton's method worse.
const AS_BBAR: Oracle = Oracle {
    kind: OracleKind::IndependentProgram,
    source: "B-bar on the same meshes",
    locator: "the search of every slope, by the same bracket and steps",
};

/// Counts both over the slopes that were run with both.
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
    let [mut shared, mut bbar] = [const { Vec::new() }; 2];
    let mut failed = [0, 0];
    for (place, problem) in slopes.problems.iter().enumerate() {
        let cells = problem.meshes[0];
        let of = |locking| {
            let variant = Variant {
                cells,
                locking,
                associated: true,
            };
            slopes.of(place, variant)
        };
        let (Some(of_shared), Some(of_bbar)) = (of(Locking::SharedStrain), of(Locking::BBar))
        else {
            continue;
        };
        let both = [of_shared, of_bbar];
        let [a, b] = both.map(|found| found.run(String::new()));
        let fails = both.map(Found::failed_trials);
        failed = [0, 1].map(|which| failed[which] + fails[which]);
        let _ = writeln!(
            note,
            "  {:>2} H/{cells:<3} {:>5} {:>6} {:>4} {:>4}; {:>5} {:>6} {:>4} {:>4}",
            place + 1,
            a.steps,
            a.iterations,
            a.cuts,
            fails[0],
            b.steps,
            b.iterations,
            b.cuts,
            fails[1],
        );
        let of = |run: &RunRecord, fails| [run.steps, run.iterations, run.cuts, fails];
        let counts = [of(&a, fails[0]), of(&b, fails[1])];
        let mut row = vec![place as f64 + 1.0, f64::from(cells)];
        row.extend(counts.as_flattened().iter().map(|&count| count as f64));
        table.push(row);
        shared.push(a);
        bbar.push(b);
    }
    let sum =
        |name: &str, runs: &[RunRecord]| RunRecord::sum(name, &runs.iter().collect::<Vec<_>>());
    let (a, b) = (sum("shared strain, all slopes", &shared), sum("", &bbar));
    let _ = writeln!(
        note,
        "  all       {:>5} {:>6} {:>4} {:>4}; {:>5} {:>6} {:>4} {:>4}",
        a.steps, a.iterations, a.cuts, failed[0], b.steps, b.iterations, b.cuts, failed[1],
    );
    // A search by gravity fails as often as its bracket has it, and a trial that fails is cut until it
    // cannot be cut further: the sums tell of the bracket too.
    let in_a_step = |run: &RunRecord| run.iterations as f64 / run.steps as f64;
    let corrections = in_a_step(&a) / in_a_step(&b);
    let run = study.run(a);
    study.check(
        run,
        "corrections in a step over those with B-bar [-]",
        AS_BBAR.says(1.0),
        Band::AtMost(1.15),
        corrections,
    );
    study.notes.push(note);
    table.write_csv(&study.folder)
}
