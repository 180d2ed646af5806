//! The benchmark's footing with contact in place of prescribed nodes: pushed one width deep, its side free.

use std::path::Path;

use igimp_cases::CaseError;
use igimp_model::check::Band;
use igimp_results::mesh_study::Convergence;
use igimp_results::tables::table::Table;
use rayon::prelude::*;

use crate::footing::SEQUENTIAL;
use crate::harness::oracle::{Oracle, OracleKind};
use crate::harness::reference::{footing_sequential_limit_analysis, interpolate};
use crate::harness::study::coverage::{self, Known, on_cells};
use crate::harness::study::{Level, RunRecord, Study};
use crate::runs::{Computed, shipped_case};

/// The book's description of the study.
const ABOUT: &str = "The footing of the benchmark in stiffer soil (E/s_u = 300, contact that lets go, rough base, smooth side), pushed one width deep, against sequential limit analysis. N is the mean over a twentieth of the width on either side. With its edge at three quarters of a cell the footing acts as wide as it is on every mesh; with its edge in the middle of a cell it acts wider by a share of the cell, and two meshes are extrapolated.";
/// The effort of Newton's method.
const QUADRATIC: Oracle = Oracle {
    kind: OracleKind::Theory,
    source: "consistent tangent: quadratic convergence",
    locator: "at most 9 corrections a step and 15 cuts to 1 B",
};
/// Depths at which N is read, in widths.
const DEPTHS: [f64; 3] = [0.2, 0.5, 1.0];
/// Half of the interval that N is averaged over, in widths.
const AROUND: f64 = 0.05;

/// One push.
#[derive(Clone, Copy)]
struct Push {
    /// Cells over twice the width: even with the edge in the middle of a cell, 4 k + 3 with the edge at
    /// three quarters.
    cells_per_two_widths: u32,
    steps: u32,
    /// How deep, in widths \[-\].
    depth: f64,
}

impl Push {
    /// Cells over the width B/h.
    fn cells_per_width(&self) -> f64 {
        0.5 * f64::from(self.cells_per_two_widths)
    }

    fn has_edge_mid_cell(&self) -> bool {
        self.cells_per_two_widths % 4 == 2
    }

    /// The benchmark's footing on at least five widths of stiffer soil.
    fn run(&self) -> Result<Computed<2>, CaseError> {
        let twice = self.cells_per_two_widths;
        let place = |cells: u32| format!("{} m", 2.0 * f64::from(cells) / f64::from(twice));
        let ground = (5 * twice).div_ceil(2);
        let (wide, high) = (place(ground), place(ground + twice.div_ceil(2)));
        Computed::new(shipped_case(
            "footing",
            vec![
                format!("grid.cell=\"{}\"", place(1)),
                format!("grid.domain={{ x = [\"0 m\", \"{wide}\"], y = [\"0 m\", \"{high}\"] }}"),
                format!(
                    "bodies.soil.polygon=[[\"0 m\", \"0 m\"], [\"{wide}\", \"0 m\"], [\"{wide}\", \"{wide}\"], [\"0 m\", \"{wide}\"]]"
                ),
                format!("rigid.footing.from=[\"-0.5 m\", \"{wide}\"]"),
                format!("rigid.footing.to=[\"0.5 m\", \"{high}\"]"),
                "materials.clay.young=\"300 kPa\"".to_owned(),
                format!(
                    "stages=[{{ name = \"push\", type = \"rigid\", bodies = [{{ body = \"footing\", y = \"-{} m\" }}], steps = {} }}]",
                    self.depth, self.steps
                ),
                "checks=[]".to_owned(),
            ],
        )?)
    }
}

/// The mean of N around a depth, and that of limit analysis at the same depths.
fn mean(curve: &[[f64; 2]], sequential: &[[f64; 2]], depth: f64) -> [f64; 2] {
    let near = curve
        .iter()
        .filter(|point| (point[0] - depth).abs() <= AROUND);
    let near: Vec<[f64; 2]> = near
        .map(|point| [point[1], interpolate(sequential, point[0])])
        .collect();
    [0, 1].map(|k| near.iter().map(|pair| pair[k]).sum::<f64>() / near.len() as f64)
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
            .filter(|other| (other[0] - point[0]).abs() <= 0.5 * cell);
        let near: Vec<f64> = near.map(|other| other[1]).collect();
        let mean = near.iter().sum::<f64>() / near.len() as f64;
        (point[1] / mean - 1.0).powi(2)
    });
    let off: Vec<f64> = off.collect();
    (off.iter().sum::<f64>() / off.len() as f64).sqrt()
}

/// The pushes of a level.
fn pushes(level: Level) -> Vec<Push> {
    let to = |depth, cells_per_two_widths, steps| Push {
        cells_per_two_widths,
        steps,
        depth,
    };
    let mut pushes = vec![to(0.25, 19, 25)];
    if level != Level::Quick {
        pushes.push(to(1.0, 19, 100));
    }
    if level == Level::Full {
        pushes.extend([to(1.0, 27, 140), to(1.0, 18, 100), to(1.0, 26, 170)]);
    }
    pushes
}

/// Runs the study.
pub(crate) fn study(level: Level, out: &Path) -> Result<Study, CaseError> {
    let mut study = Study::new("contact-footing", ABOUT, out)?;
    let pushes = pushes(level);
    let results = pushes
        .par_iter()
        .map(Push::run)
        .collect::<Result<Vec<_>, _>>()?;
    let sequential = footing_sequential_limit_analysis().points("w_over_B", "N");
    let mut mid_cell: Vec<MidCell> = Vec::new();
    for (push, result) in pushes.iter().zip(&results) {
        let cells = push.cells_per_width();
        let curve = result.curve("resistance").points(0, 1);
        let label = format!("contact, B/h = {cells}, to {} B", push.depth);
        let run = study.run_to_end(RunRecord::new(label, &result.report, result.elapsed));
        for depth in DEPTHS.into_iter().filter(|&depth| depth <= push.depth) {
            let [found, expected] = mean(&curve, &sequential, depth);
            if push.has_edge_mid_cell() {
                study.notes.push(format!(
                    "contact-footing, B/h = {cells}, edge mid-cell: N around {depth} B is {found:.2}, {:+.1} %; the extrapolation is checked",
                    100.0 * (found / expected - 1.0)
                ));
            } else {
                let quantity = format!("N around {depth} B [-]");
                let band = Band::Relative(0.03);
                study.check(run, quantity, SEQUENTIAL.says(expected), band, found);
            }
        }
        if push.depth >= 1.0 {
            let quantity = "wiggle of N over a cell of penetration, rms [-]";
            let band = Band::AtMost(0.02);
            let wiggle = wiggle(&curve, 1.0 / cells);
            study.check(run, quantity, SEQUENTIAL.says(0.0), band, wiggle);
            let quantity = "corrections a step, mean [-]";
            let steps = result.report.steps.len() as f64;
            let corrections = result.report.iterations() as f64 / steps;
            let band = Band::AtMost(9.0);
            study.check(run, quantity, QUADRATIC.says(9.0), band, corrections);
            let quantity = "cut steps [-]";
            let band = Band::AtMost(15.0);
            let cuts = result.report.failures.len() as f64;
            study.check(run, quantity, QUADRATIC.says(15.0), band, cuts);
        }
        let mut table = Table::new(
            format!("resistance_{cells}_to_{}", push.depth),
            &["penetration_w/B_[-]", "resistance_N_[-]_compression_+"],
        );
        for point in &curve {
            table.push(point.to_vec());
        }
        study.table(table)?;
        if push.has_edge_mid_cell() {
            mid_cell.push((run, cells, curve));
        }
    }
    if let [coarse, fine] = &mid_cell[..] {
        extrapolated(&mut study, [coarse, fine], &sequential);
    }
    Ok(study)
}

/// A push with the edge in the middle of a cell: its run, cells over the width, and curve.
type MidCell = (usize, f64, Vec<[f64; 2]>);

/// The resistance on two meshes with the edge in the middle of a cell, extrapolated to cells of no size.
fn extrapolated(study: &mut Study, meshes: [&MidCell; 2], sequential: &[[f64; 2]]) {
    let [(_, a, coarse), (run, b, fine)] = meshes;
    for depth in DEPTHS {
        let ([coarse, _], [fine, expected]) = (
            mean(coarse, sequential, depth),
            mean(fine, sequential, depth),
        );
        let values = [on_cells(1.0 / a, coarse), on_cells(1.0 / b, fine)];
        let known = Known {
            convergence: Convergence::CONTACT,
            truth: [expected; 2],
        };
        let estimate = study.extrapolate(format!("contact footing at {depth} B"), known, &values);
        study.check(
            *run,
            format!("N around {depth} B, B/h = {a} and {b} extrapolated [-]"),
            SEQUENTIAL.says(expected),
            Band::Between(0.97 * expected, 1.02 * expected),
            coverage::value(estimate),
        );
    }
}
