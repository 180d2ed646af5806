//! Factors of safety of slices between smooth ends: those of the plane.

use std::path::Path;

use igimp_assembly::Locking;
use igimp_cases::CaseError;
use igimp_model::check::Band;
use igimp_results::tables::table::Table;
use rayon::prelude::*;

use crate::harness::oracle::{Oracle, OracleKind};
use crate::harness::study::{Level, RunRecord, Study};
use crate::limit_equilibrium::section::{Ends, Path as Way, Search, Section, Variant, YOUNG};
use crate::runs::Computed;

/// The book's description of the study.
const ABOUT: &str = "The factor of safety of slices in space between smooth ends is that of the plane on the same mesh: a vertical cut in undrained clay, and the first example of Griffiths and Lane.";
const PLANE: Oracle = Oracle {
    kind: OracleKind::Theory,
    source: "plane strain is a part of space",
    locator: "factor of safety in plane strain on the same mesh",
};

/// A slope and the cells over its height.
struct Slope {
    section: Section,
    cells: u32,
    least: Level,
    search: Search,
}

fn slopes() -> Vec<Slope> {
    let search = |bracket| Search {
        bracket,
        path: Way::Reduce,
        steps: 5,
        young: YOUNG,
    };
    // About F = 1.3 of γH/c = 3.78.
    let cut = || Section::homogeneous("vertical cut", (0.0, 2.0), (69.0, 0.0), [10.0, 20.0]);
    let hill = || {
        Section::homogeneous(
            "Griffiths and Lane 1",
            (2.0, 1.0),
            (10.0, 20.0),
            [12.0, 0.0],
        )
    };
    let of = |section, cells, least, bracket| Slope {
        section,
        cells,
        least,
        search: search(bracket),
    };
    vec![
        of(cut(), 5, Level::Quick, [1.2, 1.6]),
        of(hill(), 5, Level::Quick, [1.2, 1.6]),
        of(cut(), 10, Level::Default, [1.2, 1.6]),
        of(hill(), 10, Level::Default, [1.2, 1.6]),
    ]
}

/// The interval of the factor of safety \[-\], and all trials as one run.
pub(super) fn interval<const D: usize>(
    name: &str,
    computed: &Computed<D>,
) -> (RunRecord, [f64; 2]) {
    let trials = computed.trials.iter();
    let runs: Vec<RunRecord> = trials
        .map(|trial| RunRecord::new("", &trial.report, trial.elapsed))
        .collect();
    let safety = computed.safety();
    let end = |which: fn(&_) -> Option<f64>| safety.and_then(which).unwrap_or(f64::NAN);
    (
        RunRecord::sum(name, &runs.iter().collect::<Vec<_>>()),
        [end(|safety| safety.stable), end(|safety| safety.failed)],
    )
}

/// The middle of an interval.
pub(super) fn middle(interval: [f64; 2]) -> f64 {
    0.5 * (interval[0] + interval[1])
}

/// Runs the study.
pub(crate) fn study(level: Level, out: &Path) -> Result<Study, CaseError> {
    let mut study = Study::new("space-safety", ABOUT, out)?;
    let slopes: Vec<Slope> = slopes()
        .into_iter()
        .filter(|slope| slope.least <= level)
        .collect();
    let done = slopes
        .par_iter()
        .map(|slope| {
            let variant = Variant {
                cells: slope.cells,
                locking: Locking::SharedStrain,
                associated: true,
            };
            let ends = Ends {
                length: slope.section.height / f64::from(slope.cells),
                cells: 1,
                is_rough: false,
            };
            let Slope {
                section, search, ..
            } = slope;
            let plane = Computed::new(section.case(variant, *search)?)?;
            let space = Computed::new(section.case_in_space(variant, *search, ends, &[])?)?;
            Ok((plane, space))
        })
        .collect::<Result<Vec<_>, CaseError>>()?;
    let mut table = Table::new(
        "factors_of_safety",
        &["slope", "cells_over_H", "plane_[-]", "slice_[-]"],
    );
    for (place, (slope, (plane, space))) in slopes.iter().zip(done).enumerate() {
        let name = format!("{}, h = H/{}", slope.section.name, slope.cells);
        let (_, flat) = interval("", &plane);
        let (record, found) = interval(&name, &space);
        let run = study.run(record);
        study.check(
            run,
            "factor of safety of a slice [-]",
            PLANE.says(middle(flat)),
            Band::Relative(0.01),
            middle(found),
        );
        table.push(vec![
            place as f64 + 1.0,
            f64::from(slope.cells),
            middle(flat),
            middle(found),
        ]);
    }
    table.write_csv(&study.folder)?;
    Ok(study)
}
