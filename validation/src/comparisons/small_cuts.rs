//! Remedies for small cuts: tying, dropping, ghost penalty, soft ground, none; on the column, a block
//! whose sides slide over the cells, the stiff slope at collapse and the soft slope.

pub(crate) mod sliding_block;

use igimp_assembly::{CutVolume, Remedy, SmallCuts};
use igimp_cases::CaseError;
use igimp_model::Case;
use igimp_model::check::Band;

use crate::column::{self, ColumnResult};
use crate::comparisons::benchmarks::{
    Results, Variant, corrections, corrections_of_trials, cuts, drained_slope, factor_of_safety,
    largest_displacement, reached, soft_slope, written,
};
use crate::harness::oracle::{Oracle, OracleKind};
use crate::harness::study::{Level, Study};
use crate::runs::Computed;
use crate::von_mises_slope::{BOUNDS, Collapse, bounds, limit, slope_to_collapse};

/// The stress error of the column.
const COLUMN: Oracle = Oracle {
    kind: OracleKind::IndependentProgram,
    source: "independent iGIMP program, set-up of Charlton et al. 2017",
    locator: "validation/reference/column_stress_error.csv, 128 cells",
};
/// The displacement of the soft slope.
const SOFT_SLOPE: Oracle = Oracle {
    kind: OracleKind::IndependentProgram,
    source: "independent iGIMP + B-bar program",
    locator: "same slope, E = 1 MPa: 0.74 m",
};
const fn cut(below: f64, remedy: Remedy, ghost_penalty: f64) -> SmallCuts {
    SmallCuts {
        below,
        of: CutVolume::Cell,
        remedy,
        ghost_penalty,
    }
}

const TIE: SmallCuts = cut(1e-4, Remedy::Tie, 0.0);
const TIE_MORE: SmallCuts = cut(1e-2, Remedy::Tie, 0.0);
const DROP_LESS: SmallCuts = cut(1e-6, Remedy::Drop, 0.0);
const DROP: SmallCuts = cut(1e-4, Remedy::Drop, 0.0);
const DROP_MORE: SmallCuts = cut(1e-2, Remedy::Drop, 0.0);
const GHOST_LESS: SmallCuts = cut(0.0, Remedy::Tie, 1e-4);
const GHOST: SmallCuts = cut(0.0, Remedy::Tie, 1e-3);
const GHOST_MORE: SmallCuts = cut(0.0, Remedy::Tie, 1e-2);
pub(super) const NONE: SmallCuts = cut(0.0, Remedy::Tie, 0.0);

/// The variants; the default first.
pub(super) const VARIANTS: [Variant; 9] = [
    variant("tie 1e-4", |case| case.method.small_cuts = TIE),
    variant("tie 1e-2", |case| case.method.small_cuts = TIE_MORE),
    variant("drop 1e-6", |case| case.method.small_cuts = DROP_LESS),
    variant("drop 1e-4", |case| case.method.small_cuts = DROP),
    variant("drop 1e-2", |case| case.method.small_cuts = DROP_MORE),
    variant("ghost 1e-4", |case| case.method.small_cuts = GHOST_LESS),
    variant("ghost 1e-3", |case| case.method.small_cuts = GHOST),
    variant("ghost 1e-2", |case| case.method.small_cuts = GHOST_MORE),
    variant("none", |case| case.method.small_cuts = NONE),
];
/// Their remedies.
pub(super) const REMEDIES: [SmallCuts; 9] = [
    TIE, TIE_MORE, DROP_LESS, DROP, DROP_MORE, GHOST_LESS, GHOST, GHOST_MORE, NONE,
];
/// Places of variants that checks look at.
pub(super) const TIED: usize = 0;
pub(super) const DROPPED: usize = 3;
const DROPPED_MOST: usize = 4;

const fn variant(label: &'static str, change: fn(&mut Case<2>)) -> Variant {
    Variant {
        label,
        slug: label,
        change,
    }
}

/// The comparison: column and block always, slopes at the full level.
pub(super) fn compare(study: &mut Study, level: Level) -> Result<(), CaseError> {
    column(study)?;
    sliding_block::settling(study)?;
    sliding_block::sinking(study)?;
    if level == Level::Full {
        stiff(study)?;
        soft(study)?;
        drained(study)?;
    }
    Ok(())
}

/// The column of 1 MPa.
fn column(study: &mut Study) -> Result<(), CaseError> {
    let results = Results::compute(&VARIANTS, "cells", &[64, 128], |cells| {
        column::case(cells, "1 MPa", ("gimp", true))
    })?;
    let error = |computed: &Computed<2>| ColumnResult::new(computed).stress_error;
    let quantity = "stress error [-]";
    let (expected, bench) = (COLUMN.says(2.324e-4), "column, 128 cells, E = 1 MPa");
    let run = results.record(study, bench, TIED, 128);
    let measured = error(results.at(TIED, 128));
    study.check(run, quantity, expected, Band::Relative(0.03), measured);
    let run = results.record(study, bench, DROPPED, 128);
    let band = Band::AtLeast(1.5 * 2.324e-4);
    study.control(
        run,
        quantity,
        expected,
        band,
        error(results.at(DROPPED, 128)),
    );
    study.table(results.table(
        "small_cuts_column",
        &[
            ("error_[-]", &error),
            ("corrections_per_step_[-]", &corrections),
            ("cuts_[-]", &cuts),
        ],
    ))
}

/// The factor of safety of the drained slope, E/c = 1e4.
fn drained(study: &mut Study) -> Result<(), CaseError> {
    let results = Results::compute(&VARIANTS, "cell_[m]", &[1], |_| drained_slope())?;
    written(
        study,
        &results.table(
            "small_cuts_drained_slope",
            &[
                ("factor_of_safety_[-]", &factor_of_safety),
                ("corrections_[-]", &corrections_of_trials),
            ],
        ),
    )
}

/// The collapse load of the stiff slope, D = 2, E/c_u = 2222: all remedies with h = 1 m, the default and
/// dropping at the same threshold with h = 0.5 m.
fn stiff(study: &mut Study) -> Result<(), CaseError> {
    let collapse = |cells: usize| {
        slope_to_collapse(&Collapse {
            depth_factor: 2.0,
            bbar: true,
            cell: 1.0 / cells as f64,
        })
    };
    let measured = |computed: &Computed<2>| limit(computed).unwrap_or(f64::INFINITY);
    let factor = |computed: &Computed<2>| 1.6 * reached(computed);
    let [lower, upper] = bounds(2.0);
    let expected = BOUNDS.says(0.5 * (lower + upper));
    let quantity = "γH/c_u at collapse [-]";
    let pair = [
        variant("tie 1e-4", |case| case.method.small_cuts = TIE),
        variant("drop 1e-4", |case| case.method.small_cuts = DROP),
    ];
    let coarse = Results::compute(&VARIANTS, "cells_per_m", &[1], collapse)?;
    let fine = Results::compute(&pair, "cells_per_m", &[2], collapse)?;
    for (results, cells) in [(&coarse, 1), (&fine, 2)] {
        let name = format!("stiff slope, D = 2, h = {} m", 1.0 / cells as f64);
        let run = results.record(study, &name, TIED, cells);
        let band = Band::Between(0.98 * lower, 1.02 * upper);
        study.check(
            run,
            quantity,
            expected,
            band,
            measured(results.at(TIED, cells)),
        );
        if cells == 1 {
            let run = results.record(study, &name, DROPPED_MOST, cells);
            let band = Band::AtLeast(1.02 * upper);
            study.control(
                run,
                quantity,
                expected,
                band,
                measured(results.at(DROPPED_MOST, cells)),
            );
        }
        written(
            study,
            &results.table(
                &format!("small_cuts_stiff_slope_{cells}_per_m"),
                &[
                    ("gamma_H/c_u_[-]", &measured),
                    ("gravity_factor_reached_[-]", &factor),
                    ("displacement_[m]", &largest_displacement),
                    ("corrections_per_step_[-]", &corrections),
                    ("cuts_[-]", &cuts),
                ],
            ),
        )?;
    }
    Ok(())
}

/// The soft slope, whose particles cross cells.
fn soft(study: &mut Study) -> Result<(), CaseError> {
    let results = Results::compute(&VARIANTS, "steps", &[10], |steps| {
        soft_slope(1.0, 1.0, steps)
    })?;
    let quantity = "largest displacement [m]";
    for (k, name) in [
        (TIED, "soft slope, h = 1 m"),
        (DROPPED_MOST, "soft slope, h = 1 m"),
    ] {
        let run = results.record(study, name, k, 10);
        let measured = largest_displacement(results.at(k, 10));
        if k == TIED {
            study.check(
                run,
                quantity,
                SOFT_SLOPE.says(0.74),
                Band::Relative(0.02),
                measured,
            );
        } else {
            study.control(
                run,
                quantity,
                SOFT_SLOPE.says(0.74),
                Band::AtMost(0.6),
                measured,
            );
        }
    }
    written(
        study,
        &results.table(
            "small_cuts_soft_slope",
            &[
                ("gravity_factor_reached_[-]", &reached),
                ("displacement_[m]", &largest_displacement),
                ("corrections_per_step_[-]", &corrections),
                ("cuts_[-]", &cuts),
            ],
        ),
    )
}
