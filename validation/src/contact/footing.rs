//! The benchmark's footing with contact in place of prescribed nodes: pushed one width deep, its side free.

use std::path::Path;

use igimp_cases::CaseError;
use igimp_cases::check::Band;
use igimp_cases::table::Table;
use rayon::prelude::*;

use crate::footing::SEQUENTIAL;
use crate::oracle::{Oracle, OracleKind};
use crate::reference::{footing_sequential_limit_analysis, interpolate};
use crate::runs::{Computed, mesh, shipped_case};
use crate::study::{Level, RunRecord, Study};

/// What the book says of the study.
const ABOUT: &str = "The footing of the benchmark with contact that lets go (E/s_u = 300, rough base, smooth side), pushed one width deep, against sequential limit analysis. N is the mean over a twentieth of the width on either side.";
/// What separates contact from a bond.
const BOND: Oracle = Oracle {
    kind: OracleKind::LimitAnalysis,
    source: "sequential limit analysis, the band that the bonded footing misses",
    locator: "docs/src/footing-contact.md: 7.5 at 1 B where the soil sticks",
};
/// Depths at which N is read, in widths.
const DEPTHS: [f64; 3] = [0.2, 0.5, 1.0];
/// Half of the interval that N is averaged over, in widths.
const AROUND: f64 = 0.05;

/// One push.
struct Push {
    cells_per_width: u32,
    steps: u32,
    /// How deep, in widths \[-\].
    depth: f64,
    /// Accepted deviation from limit analysis \[-\].
    band: f64,
}

/// Pushes the footing of the template one width deep.
fn push(push: &Push) -> Result<Computed, CaseError> {
    let mut overrides = mesh(1.0 / f64::from(push.cells_per_width), [5.0, 6.0]);
    overrides.extend([
        "grid.locking=b-bar".to_owned(),
        "bodies=[{ name = \"soil\", material = \"clay\", points_per_cell = 9, polygon = [[\"0 m\", \"0 m\"], [\"5 m\", \"0 m\"], [\"5 m\", \"5 m\"], [\"0 m\", \"5 m\"]] }]".to_owned(),
        "rigid.footing.from=[\"-0.5 m\", \"5 m\"]".to_owned(),
        "rigid.footing.to=[\"0.5 m\", \"6 m\"]".to_owned(),
        format!(
            "stages=[{{ name = \"push\", type = \"rigid\", bodies = [{{ body = \"footing\", y = \"-{} m\" }}], steps = {} }}]",
            push.depth, push.steps
        ),
        "checks=[]".to_owned(),
    ]);
    Computed::new(shipped_case("contact-footing", overrides)?)
}

/// The mean of N around a depth, and that of limit analysis at the same depths.
fn mean(curve: &[[f64; 2]], sequential: &[[f64; 2]], depth: f64) -> [f64; 2] {
    let near = curve
        .iter()
        .filter(|point| (point[0] - depth).abs() <= AROUND);
    let near: Vec<[f64; 2]> = near
        .map(|point| [point[1], interpolate(sequential, point[0])])
        .collect();
    [0, 1].map(|k| near.iter().map(|own| own[k]).sum::<f64>() / near.len() as f64)
}

/// The distance between N and its mean over a cell of penetration, over that mean, beyond a depth of
/// three tenths of the width: root of the mean square.
fn wiggle(curve: &[[f64; 2]], cell: f64) -> f64 {
    let deep = curve
        .iter()
        .filter(|point| point[0] > 0.3 && point[0] < 1.0 - 0.5 * cell);
    let off = deep.map(|point| {
        let near = curve
            .iter()
            .filter(|own| (own[0] - point[0]).abs() <= 0.5 * cell);
        let near: Vec<f64> = near.map(|own| own[1]).collect();
        let mean = near.iter().sum::<f64>() / near.len() as f64;
        (point[1] / mean - 1.0).powi(2)
    });
    let off: Vec<f64> = off.collect();
    (off.iter().sum::<f64>() / off.len() as f64).sqrt()
}

/// Runs the study.
pub(crate) fn study(level: Level, out: &Path) -> Result<Study, CaseError> {
    let mut study = Study::new("contact-footing", ABOUT, out)?;
    let to = |depth, cells_per_width, steps, band| Push {
        cells_per_width,
        steps,
        depth,
        band,
    };
    let mut pushes = vec![to(0.25, 9, 25, 0.05)];
    if level != Level::Quick {
        pushes.push(to(1.0, 9, 100, 0.05));
    }
    if level == Level::Full {
        pushes.push(to(1.0, 13, 170, 0.03));
    }
    let results = pushes.par_iter().map(push).collect::<Result<Vec<_>, _>>()?;
    let sequential = footing_sequential_limit_analysis().points("w_over_B", "N");
    let curves: Vec<Vec<[f64; 2]>> = results
        .iter()
        .map(|result| result.curve("resistance").points(0, 1))
        .collect();
    let mut last = 0;
    for ((push, result), curve) in pushes.iter().zip(&results).zip(&curves) {
        let cells = push.cells_per_width;
        let label = format!("contact, B/h = {cells}, to {} B", push.depth);
        let run = study.run_to_end(RunRecord::new(label, &result.report, result.elapsed));
        last = run;
        for depth in DEPTHS.into_iter().filter(|&depth| depth <= push.depth) {
            let [found, expected] = mean(curve, &sequential, depth);
            let quantity = format!("N around {depth} B [-]");
            let band = Band::Relative(push.band);
            study.check(run, quantity, SEQUENTIAL.says(expected), band, found);
        }
        if push.depth >= 1.0 {
            let [found, expected] = mean(curve, &sequential, 1.0);
            let quantity = "N around 1 B is not that of the bond [-]";
            let band = Band::AtMost(1.05 * expected);
            study.check(run, quantity, BOND.says(expected), band, found);
            let cell = 1.0 / f64::from(cells);
            let quantity = "wiggle of N over a cell of penetration, rms [-]";
            let steady = SEQUENTIAL.says(0.0);
            let band = Band::AtMost(0.02);
            study.check(run, quantity, steady, band, wiggle(curve, cell));
        }
        let cuts = result.report.failures.len();
        let corrections = result.report.iterations() as f64 / result.report.steps.len() as f64;
        study.notes.push(format!(
            "B/h = {cells}, to {} B: {} steps, {cuts} cuts, {corrections:.2} corrections a step",
            push.depth,
            result.report.steps.len(),
        ));
        let mut table = Table::new(
            format!("resistance_{cells}_to_{}", push.depth),
            &["penetration_w/B_[-]", "resistance_N_[-]_compression_+"],
        );
        for point in curve {
            table.push(point.to_vec());
        }
        study.table(table)?;
    }
    if let [_, coarse, fine] = &curves[..] {
        let [a, b] = [pushes[1].cells_per_width, pushes[2].cells_per_width].map(f64::from);
        for depth in DEPTHS {
            let ([coarse, _], [fine, expected]) = (
                mean(coarse, &sequential, depth),
                mean(fine, &sequential, depth),
            );
            study.check(
                last,
                format!("N around {depth} B, extrapolated [-]"),
                SEQUENTIAL.says(expected),
                Band::Between(0.97 * expected, 1.02 * expected),
                fine + (fine - coarse) * a / (b - a),
            );
        }
    }
    Ok(study)
}
