//! The strip with two deep notches: fully plastic flow that is constrained in all directions, the
//! problem with which locking was found.

use std::f64::consts::PI;
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Arc;

use igimp_assembly::{
    Constraints, Locking, Method, Particles, SharedLaw, StepConditions, StepLoads,
};
use igimp_cases::CaseError;
use igimp_figures::{CurvePlot, ReferenceLine, ReferenceValue, Series};
use igimp_material::{Elasticity, VonMises};
use igimp_model::check::Band;
use igimp_results::mesh_study::Convergence;
use igimp_results::tables::table::Table;
use igimp_shape::{Axis, Grid, ShapeError};
use igimp_solver::{Accepted, Body, MarchSettings};
use rayon::prelude::*;

use crate::continuum::laboratory::{filled, run};
use crate::harness::oracle::{Oracle, OracleKind};
use crate::harness::study::coverage::{self, Known, on_cells};
use crate::harness::study::{Level, RunRecord, Study};

/// The book's description of the study.
const ABOUT: &str = "A strip with two deep notches is pulled until its net section flows. Von Mises soil under full constraint: the limit is Prandtl's. With B-bar the force levels off there, without B-bar it rises for ever.";
/// Net stress at the limit.
const PRANDTL: Oracle = Oracle {
    kind: OracleKind::Exact,
    source: "Prandtl's field between deep notches; Nagtegaal, Parks and Rice 1974",
    locator: "net stress (2 + π)/√3 σ_y, plane strain",
};
/// Half the net section \[length\].
const LIGAMENT: f64 = 1.0;
/// Half the width and half the length of the strip over half the net section \[-\].
const SIZE: f64 = 10.0;
/// Young's modulus over the yield stress \[-\].
const YOUNG: f64 = 6e4;
/// Elongation of half the strip at the end over half the net section \[-\].
const PULL: f64 = 0.0025;
/// Steps of a run.
const STEPS: usize = 25;

/// Pulls a quarter; the curve has elongation and net stress over σ_y. Cells along the ligament are a
/// whole number and a half, so that the tip of the notch is in the middle of a cell.
fn pull(cells: usize, method: &Method) -> Result<(RunRecord, Table), CaseError> {
    let h = LIGAMENT / (cells as f64 + 0.5);
    let axis = graded(h, SIZE * LIGAMENT)?;
    let strip = Grid::new([axis.clone(), axis.clone()]);
    let mut body = Body::new(Particles::new(&filled(&strip, 2))?);
    let mut nodes = axis.nodes().to_vec();
    let count = axis.cell_count();
    nodes.push(axis.end() + axis.spacing(count - 1));
    let grid = Grid::new([axis, Axis::from_nodes(nodes)?]);
    let law: SharedLaw = Arc::new(VonMises::from_yield_stress(
        Elasticity::new(YOUNG, 0.3)?,
        1.0,
    )?);
    let load_path = |from: f64, to: f64| {
        let mut constraints = Constraints::free(&grid);
        constraints.fix_wall(&grid, 0, false, 0)?;
        for column in 0..=cells {
            constraints.prescribe(grid.node_index([column, 0]), 1, 0.0)?;
        }
        for column in 0..=count {
            for row in [count, count + 1] {
                let node = grid.node_index([column, row]);
                constraints.prescribe(node, 1, (to - from) * PULL)?;
            }
        }
        StepConditions::new(
            grid.clone(),
            constraints,
            StepLoads::gravity([0.0; 2]),
            vec![Arc::clone(&law)],
        )
    };
    let shared = match method.locking {
        Locking::SharedStrain => "_shared",
        Locking::None | Locking::BBar => "",
    };
    let mut curve = Table::new(
        format!("net_stress_{cells}.5{shared}"),
        &["elongation_[-]", "net_stress_[σ_y]"],
    );
    curve.push(vec![0.0; 2]);
    let mut observe = |accepted: &Accepted<'_, 2>| {
        let force: f64 = (0..=cells)
            .map(|column| -accepted.forces.reactions[grid.node_index([column, 0])][1])
            .sum();
        curve.push(vec![PULL * accepted.report.to, force / LIGAMENT]);
        ControlFlow::Continue(())
    };
    let variant = format!("{}, c/h = {cells}.5", method.label());
    let settings = MarchSettings::steps(STEPS);
    let (run, _) = run(
        variant,
        &mut body,
        method,
        &settings,
        &load_path,
        &mut observe,
    );
    Ok((run, curve))
}

/// Nodes from 0 to `end`: equal cells up to 2.5 times the ligament, growing by 15 % beyond.
fn graded(h: f64, end: f64) -> Result<Axis, ShapeError> {
    let mut nodes = vec![0.0];
    let mut size = h;
    while let Some(&last) = nodes.last() {
        if last >= end {
            break;
        }
        if last > 2.5 * LIGAMENT {
            size *= 1.15;
        }
        nodes.push(last + size);
    }
    Axis::from_nodes(nodes)
}

/// Runs the study.
pub(crate) fn study(level: Level, out: &Path) -> Result<Study, CaseError> {
    let mut study = Study::new("notched-strip", ABOUT, out)?;
    let meshes: &[usize] = match level {
        Level::Quick => &[2, 4],
        Level::Default => &[2, 4, 8],
        Level::Full => &[2, 4, 8, 16],
    };
    let mut jobs: Vec<(usize, Method)> = meshes
        .iter()
        .map(|&cells| (cells, Method::igimp_bbar()))
        .collect();
    jobs.push((4, Method::igimp()));
    if level > Level::Quick {
        jobs.extend([4, 8].map(|cells| (cells, Method::shared_strain())));
    }
    let done = jobs
        .par_iter()
        .map(|(cells, method)| pull(*cells, method))
        .collect::<Result<Vec<_>, CaseError>>()?;
    let limit = (2.0 + PI) / 3.0_f64.sqrt();
    let mut ends: Vec<[f64; 2]> = Vec::new();
    let mut shown = Vec::new();
    for ((cells, method), (run, curve)) in jobs.iter().zip(done) {
        let run = study.run_to_end(run);
        let end = curve.rows.last().map_or(f64::NAN, |row| row[1]);
        let quantity = format!("net stress / σ_y at E u/(σ_y c) = {} [-]", PULL * YOUNG);
        let expected = PRANDTL.says(limit);
        let label = format!("{}, c/h = {cells}.5", method.label());
        shown.push(Series::line(label, scaled(&curve)));
        if method.locking == Locking::None {
            let quantity = format!("{quantity}, must find no limit");
            study.control(run, quantity, expected, Band::AtLeast(1.05 * limit), end);
        } else {
            let size = 1.0 / (*cells as f64 + 0.5);
            // The tip is blurred over a cell: about a quarter of one is missing, and more of it where
            // strain is shared.
            if *cells > 2 && method.locking == Locking::BBar {
                let band = Band::Relative(if *cells < 8 { 0.06 } else { 0.04 });
                study.check(run, quantity, expected, band, end);
            }
            if let Some(&[coarse, before]) = ends.last().filter(|[coarse, _]| size < *coarse) {
                let known = Known {
                    convergence: Convergence::FOOTING,
                    truth: [limit; 2],
                };
                let values = [on_cells(coarse, before), on_cells(size, end)];
                let name = format!("notched strip, {}", study.runs[run].variant);
                let extrapolated = coverage::value(study.extrapolate(name, known, &values));
                let quantity = format!(
                    "net stress / σ_y, c/h = {}.5 and {cells}.5 extrapolated to h = 0 [-]",
                    cells / 2
                );
                study.check(run, quantity, expected, Band::Relative(0.02), extrapolated);
            }
            ends.push([size, end]);
            if study.runs[run].cuts == 0 {
                study.table(curve)?;
            } else {
                curve.write_csv(&study.folder)?;
            }
        }
    }
    CurvePlot {
        title: "Strip with deep notches".into(),
        x_label: "E u / (σ_{y} c)".into(),
        y_label: "net stress / σ_{y}".into(),
        series: shown,
        lines: vec![ReferenceLine {
            label: "(2 + π)/√3".into(),
            at: ReferenceValue::Y(limit),
        }],
        ..CurvePlot::default()
    }
    .write(&study.folder.join("net_stress"))?;
    Ok(study)
}

/// A curve over the elastic measure of elongation.
fn scaled(curve: &Table) -> Vec<[f64; 2]> {
    let rows = curve.rows.iter();
    rows.map(|row| [row[0] * YOUNG, row[1]]).collect()
}
