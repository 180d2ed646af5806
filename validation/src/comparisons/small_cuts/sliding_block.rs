//! Remedies for small cuts on a block whose sides reach any distance into the next cells: how it settles
//! under its own weight, and its support when its base is let down.

use igimp_assembly::{Method, SmallCuts};
use igimp_cases::CaseError;
use igimp_figures::{CurvePlot, LineStyle, Scale, Series, SeriesStyle};
use igimp_model::check::Band;
use igimp_results::tables::table::Table;
use rayon::prelude::*;

use crate::comparisons::benchmarks::written;
use crate::comparisons::block::{Beside, Settled, let_down, settle};
use crate::comparisons::small_cuts::{DROPPED, NONE, REMEDIES, TIED, VARIANTS};
use crate::harness::oracle::{Oracle, OracleKind};
use crate::harness::study::{RunRecord, Study};

/// The force on the base of the block.
const EQUILIBRIUM: Oracle = Oracle {
    kind: OracleKind::Exact,
    source: "vertical equilibrium of a block on its base",
    locator: "force on the base = weight",
};

/// By how much the sides of the block reach into the next cells \[cells\].
const OFFSETS: [f64; 16] = [
    0.0, 1e-6, 1e-5, 1e-4, 1e-3, 3e-3, 0.01, 0.02, 0.05, 0.1, 0.2, 0.3, 0.5, 0.7, 0.9, 1.0,
];

/// Condition numbers and ratios beyond this are known to be no less \[-\].
const MOST: f64 = 1e10;

/// How a quantity of a settled block is read.
type Of = fn(&Settled) -> f64;

/// A block whose upper and right sides reach any distance into the next cells, under its own weight.
pub(crate) fn settling(study: &mut Study) -> Result<(), CaseError> {
    let mut remedies: Vec<(&str, SmallCuts, Beside)> = VARIANTS
        .iter()
        .zip(REMEDIES)
        .map(|(variant, remedy)| (variant.label, remedy, Beside::Air))
        .collect();
    remedies.push(("soft ground", NONE, Beside::SoftGround));
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

    let tables: [(&str, Of); 3] = [
        ("settlement", |one| one.settlement),
        ("condition", |one| one.condition.min(MOST)),
        ("node_over_particle", |one| one.node_over_particle.min(MOST)),
    ];
    for (name, of) in tables {
        let mut header = vec!["offset_[cells]".to_owned()];
        header.extend(remedies.iter().map(|(remedy, ..)| format!("{remedy}_[-]")));
        let header: Vec<&str> = header.iter().map(String::as_str).collect();
        let mut table = Table::new(format!("small_cuts_block_{name}"), &header);
        for (k, &offset) in OFFSETS.iter().enumerate() {
            let mut row = vec![offset];
            row.extend(by_remedy.iter().map(|blocks| of(&blocks[k])));
            table.push(row);
        }
        // Without a remedy the others hang on round-off.
        if name == "condition" {
            study.table(table)?;
        } else {
            written(study, &table)?;
        }
    }
    let drawn = ["tie 1e-4", "tie 1e-2", "ghost 1e-3", "none", "soft ground"];
    let series = |of: Of| {
        let lines = remedies.iter().zip(&by_remedy);
        lines
            .filter(|((name, ..), _)| drawn.contains(name))
            .map(|((name, ..), blocks)| {
                let points = OFFSETS.iter().zip(*blocks).skip(1);
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
        series: series(|one| one.condition.min(MOST)),
        ..CurvePlot::default()
    }
    .write(&study.folder.join("small_cuts_block_condition"))?;
    Ok(())
}

/// The same block with its base let down: does anything else hold it up?
pub(crate) fn sinking(study: &mut Study) -> Result<(), CaseError> {
    let offsets = &OFFSETS[1..];
    let mut header = vec!["offset_[cells]".to_owned()];
    header.extend(
        VARIANTS
            .iter()
            .map(|variant| format!("{}_[-]", variant.label)),
    );
    let header: Vec<&str> = header.iter().map(String::as_str).collect();
    let mut table = Table::new("small_cuts_block_let_down", &header);
    let mut rows = vec![Vec::new(); offsets.len()];
    for (k, (variant, small_cuts)) in VARIANTS.iter().zip(REMEDIES).enumerate() {
        let method = Method {
            small_cuts,
            ..Method::default()
        };
        let found = offsets
            .par_iter()
            .map(|&offset| let_down(&method, offset))
            .collect::<Result<Vec<_>, _>>()?;
        for (row, (force, ..)) in rows.iter_mut().zip(&found) {
            row.push(*force);
        }
        if k != TIED && k != DROPPED {
            continue;
        }
        let farthest = found.iter().fold(0.0, |most: f64, (force, ..)| {
            let error = (force - 1.0).abs();
            if error.is_nan() {
                f64::INFINITY
            } else {
                most.max(error)
            }
        });
        let runs: Vec<RunRecord> = found
            .iter()
            .map(|(_, report, elapsed)| RunRecord::new("", report, *elapsed))
            .collect();
        let name = format!("{}: block let down, offsets 1e-6 to 1", variant.label);
        let run = study.run(RunRecord::sum(name, &runs.iter().collect::<Vec<_>>()));
        let quantity = "force on the base / weight, largest error over all offsets [-]";
        let expected = EQUILIBRIUM.says(0.0);
        if k == TIED {
            study.check(run, quantity, expected, Band::AtMost(1e-6), farthest);
        } else {
            study.control(run, quantity, expected, Band::AtLeast(0.01), farthest);
        }
    }
    for (&offset, row) in offsets.iter().zip(rows) {
        table.push([vec![offset], row].concat());
    }
    let drawn = [TIED, 2, DROPPED, 4, 6].map(|k| {
        let style = SeriesStyle::LineAndMarkers(LineStyle::Solid);
        let points = table.points(0, k + 1);
        // Round-off is drawn as such.
        let error = |force: f64| (force - 1.0).abs().max(1e-14);
        let points = points.into_iter().map(|[x, force]| [x, error(force)]);
        Series::new(VARIANTS[k].label, points.collect(), style)
    });
    CurvePlot {
        title: "Stiff block, base let down by a quarter of a cell".into(),
        x_label: "reach of its sides into the next cells [cells]".into(),
        y_label: "|force on the base / weight − 1|".into(),
        x_scale: Scale::Log,
        y_scale: Scale::Log,
        series: drawn.into(),
        ..CurvePlot::default()
    }
    .write(&study.folder.join("small_cuts_block_let_down"))?;
    written(study, &table)
}
