//! Remedies for small cuts: tying, dropping, ghost penalty, soft ground, none; on the column, a block
//! whose sides slide over the cells, the stiff slope at collapse and the soft slope.

use igimp_assembly::{Method, Remedy, SmallCuts};
use igimp_cases::CaseError;
use igimp_cases::case::Case;
use igimp_cases::check::Band;
use igimp_cases::figures::{CurvePlot, LineStyle, Scale, Series, SeriesStyle};
use igimp_cases::table::Table;
use rayon::prelude::*;

use crate::column::{self, ColumnResult};
use crate::comparisons::benchmarks::{
    Results, Variant, corrections, cuts, largest_displacement, reached, soft_slope,
};
use crate::comparisons::block::{Beside, Settled, settle};
use crate::oracle::{Oracle, OracleKind};
use crate::runs::Computed;
use crate::study::{Level, Run, Study};
use crate::von_mises_slope::{BOUNDS, Collapse, bounds, limit, slope_to_collapse};

/// The stress error of the column.
const COLUMN: Oracle = Oracle {
    kind: OracleKind::IndependentProgram,
    source: "independent iGIMP program, set-up of Charlton et al. 2017",
    locator: "validation/reference/column_stress_error.csv, 128 cells",
};
/// The settlement of the block.
const SETTLEMENT: Oracle = Oracle {
    kind: OracleKind::Exact,
    source: "elastic block on a smooth base under its own weight, small strain",
    locator: "mean settlement γH²(1 − ν²)/(3E)",
};

const fn cut(below: f64, remedy: Remedy, ghost_penalty: f64) -> SmallCuts {
    SmallCuts {
        below,
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
const NONE: SmallCuts = cut(0.0, Remedy::Tie, 0.0);

/// The variants; the default first.
const VARIANTS: [Variant; 9] = [
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
/// Places of variants that checks look at.
const TIED: usize = 0;
const DROPPED: usize = 3;

const fn variant(label: &'static str, change: fn(&mut Case)) -> Variant {
    Variant {
        label,
        slug: label,
        change,
    }
}

/// The comparison: column and block always, slopes at the full level.
pub(super) fn compare(study: &mut Study, level: Level) -> Result<(), CaseError> {
    column(study)?;
    block(study)?;
    if level == Level::Full {
        stiff(study)?;
        soft(study)?;
    }
    Ok(())
}

/// The column of 1 MPa.
fn column(study: &mut Study) -> Result<(), CaseError> {
    let results = Results::compute(&VARIANTS, "cells", &[32, 64, 128], |cells| {
        column::case(cells, "1 MPa", ("gimp", true))
    })?;
    let error = |computed: &Computed| ColumnResult::new(computed).stress_error;
    let quantity = "stress error [-]";
    let (expected, bench) = (COLUMN.says(2.324e-4), "column, 128 cells, E = 1 MPa");
    let run = results.record(study, bench, (TIED, 128));
    let measured = error(results.at(TIED, 128));
    study.check(run, quantity, expected, Band::Relative(0.03), measured);
    let run = results.record(study, bench, (DROPPED, 128));
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

/// By how much the sides of the block reach into the next cells \[cells\].
const OFFSETS: [f64; 16] = [
    0.0, 1e-6, 1e-5, 1e-4, 1e-3, 3e-3, 0.01, 0.02, 0.05, 0.1, 0.2, 0.3, 0.5, 0.7, 0.9, 1.0,
];

/// A block whose upper and right sides reach any distance into the next cells.
fn block(study: &mut Study) -> Result<(), CaseError> {
    let remedies: [(&str, SmallCuts, Beside); 10] = [
        ("tie 1e-4", TIE, Beside::Air),
        ("tie 1e-2", TIE_MORE, Beside::Air),
        ("drop 1e-6", DROP_LESS, Beside::Air),
        ("drop 1e-4", DROP, Beside::Air),
        ("drop 1e-2", DROP_MORE, Beside::Air),
        ("ghost 1e-4", GHOST_LESS, Beside::Air),
        ("ghost 1e-3", GHOST, Beside::Air),
        ("ghost 1e-2", GHOST_MORE, Beside::Air),
        ("none", NONE, Beside::Air),
        ("soft ground", NONE, Beside::SoftGround),
    ];
    let jobs: Vec<_> = remedies
        .iter()
        .flat_map(|remedy| OFFSETS.iter().map(move |&offset| (remedy, offset)))
        .collect();
    let settled = jobs
        .par_iter()
        .map(|((_, small_cuts, beside), offset)| {
            let method = Method {
                small_cuts: *small_cuts,
                ..Method::default()
            };
            settle(&method, *offset, *beside)
        })
        .collect::<Result<Vec<_>, CaseError>>()?;
    let by_remedy: Vec<&[Settled]> = settled.chunks(OFFSETS.len()).collect();

    let farthest = |settled: &[Settled]| {
        settled.iter().fold(0.0, |most: f64, one| {
            let error = (one.settlement - 1.0).abs();
            if error.is_nan() {
                f64::INFINITY
            } else {
                most.max(error)
            }
        })
    };
    let quantity = "largest error of the settlement over all offsets [-]";
    for place in [TIED, 4] {
        let own = by_remedy[place];
        let runs: Vec<Run> = own
            .iter()
            .map(|one| Run::new("", &one.report, one.elapsed))
            .collect();
        let name = format!("{}: block, offsets 0 to 1", remedies[place].0);
        let run = study.run(Run::sum(name, &runs.iter().collect::<Vec<_>>()));
        let expected = SETTLEMENT.says(0.0);
        if place == TIED {
            study.check(run, quantity, expected, Band::AtMost(0.03), farthest(own));
        } else {
            study.control(run, quantity, expected, Band::AtLeast(0.1), farthest(own));
        }
    }
    type Of = fn(&Settled) -> f64;
    let tables: [(&str, Of); 3] = [
        ("settlement", |one| one.settlement),
        ("condition", |one| one.condition.min(1e16)),
        ("node_over_particle", |one| one.node_over_particle),
    ];
    for (name, of) in tables {
        let mut header = vec!["offset_[cells]".to_owned()];
        header.extend(remedies.iter().map(|(remedy, ..)| format!("{remedy}_[-]")));
        let header: Vec<&str> = header.iter().map(String::as_str).collect();
        let mut table = Table::new(format!("small_cuts_block_{name}"), &header);
        for (k, &offset) in OFFSETS.iter().enumerate() {
            let mut row = vec![offset];
            row.extend(by_remedy.iter().map(|own| of(&own[k])));
            table.push(row);
        }
        study.table(table)?;
    }
    let series = |of: Of| {
        let lines = remedies.iter().zip(&by_remedy);
        lines
            .map(|((name, ..), own)| {
                let points = OFFSETS.iter().zip(*own);
                let points = points.map(|(&offset, one)| [offset, of(one)]).collect();
                Series::new(*name, points, SeriesStyle::LineAndMarkers(LineStyle::Solid))
            })
            .collect()
    };
    CurvePlot {
        title: "Block settling under its own weight".into(),
        x_label: "reach of its sides into the next cells [cells]".into(),
        y_label: "mean settlement / exact".into(),
        x_scale: Scale::Log,
        y_range: Some((0.9, 1.05)),
        series: series(|one| one.settlement),
        ..CurvePlot::default()
    }
    .write(&study.folder.join("small_cuts_block_settlement"))?;
    CurvePlot {
        title: "Block settling under its own weight".into(),
        x_label: "reach of its sides into the next cells [cells]".into(),
        y_label: "condition number of the tangent".into(),
        x_scale: Scale::Log,
        y_scale: Scale::Log,
        series: series(|one| one.condition.min(1e16)),
        ..CurvePlot::default()
    }
    .write(&study.folder.join("small_cuts_block_condition"))?;
    Ok(())
}

/// The collapse load of the stiff slope, D = 2, h = 1 m, E/c_u = 2222.
fn stiff(study: &mut Study) -> Result<(), CaseError> {
    let results = Results::compute(&VARIANTS, "steps", &[64], |steps| {
        let mut case = slope_to_collapse(&Collapse {
            depth_factor: 2.0,
            bbar: true,
            cell: 1.0,
        })?;
        case.stages[0].steps = steps;
        Ok(case)
    })?;
    let measured = |computed: &Computed| limit(computed).unwrap_or(f64::INFINITY);
    let [lower, upper] = bounds(2.0);
    let run = results.record(study, "stiff slope, D = 2, h = 1 m", (TIED, 64));
    study.check(
        run,
        "γH/c_u at collapse [-]",
        BOUNDS.says(0.5 * (lower + upper)),
        Band::Between(0.98 * lower, 1.02 * upper),
        measured(results.at(TIED, 64)),
    );
    let factor = |computed: &Computed| 1.6 * reached(computed);
    study.table(results.table(
        "small_cuts_stiff_slope",
        &[
            ("gamma_H/c_u_[-]", &measured),
            ("gravity_factor_reached_[-]", &factor),
            ("displacement_[m]", &largest_displacement),
            ("corrections_per_step_[-]", &corrections),
            ("cuts_[-]", &cuts),
        ],
    ))
}

/// The soft slope, whose particles cross cells.
fn soft(study: &mut Study) -> Result<(), CaseError> {
    let results = Results::compute(&VARIANTS, "steps", &[10], |steps| {
        soft_slope(1.0, 1.0, steps)
    })?;
    study.table(results.table(
        "small_cuts_soft_slope",
        &[
            ("gravity_factor_reached_[-]", &reached),
            ("displacement_[m]", &largest_displacement),
            ("corrections_per_step_[-]", &corrections),
            ("cuts_[-]", &cuts),
        ],
    ))
}
