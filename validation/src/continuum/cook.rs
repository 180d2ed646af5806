//! Cook's membrane: a clamped, tapered panel under shear, from compressible to nearly
//! incompressible.

use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Arc;

use igimp_assembly::{
    Constraints, Kinematics, LoadPoint, Locking, Method, Particles, SharedLaw, StepConditions,
    StepLoads,
};
use igimp_cases::CaseError;
use igimp_figures::{
    CurvePlot, LineStyle, ReferenceLine, ReferenceValue, Scale, Series, SeriesStyle,
};
use igimp_geometry::seed::fill_polygon;
use igimp_material::{Elasticity, HenckyElastic};
use igimp_model::check::Band;
use igimp_results::tables::table::Table;
use igimp_solver::{Accepted, Body, MarchSettings};
use igimp_text::short;
use rayon::prelude::*;

use crate::continuum::laboratory::{grid_of, run};
use crate::harness::oracle::{Oracle, OracleKind};
use crate::harness::study::{Level, RunRecord, Study};

/// The book's description of the study.
const ABOUT: &str = "Cook's tapered panel in plane strain, clamped on the left and sheared on the right, at ν = 1/3, 0.49 and 0.4999. The rise of its corner under refinement: with B-bar it does not care about ν, without it locks.";
/// The rise of the corner.
const MIXED_ELEMENTS: Oracle = Oracle {
    kind: OracleKind::IndependentProgram,
    source: "Cook's panel (Cook 1974) by mixed finite elements",
    locator: "quadratic displacement and linear pressure, refined to four digits",
};
/// Poisson's ratios with names for files and the rise of the corner.
const RATIOS: [(f64, &str, f64); 3] = [
    (1.0 / 3.0, "0.33", 32.25),
    (0.49, "0.49", 28.02),
    (0.4999, "0.4999", 27.68),
];
/// Particles in a cell along one direction.
const POINTS: usize = 2;
/// Width of the panel \[length\].
const WIDTH: f64 = 48.0;
/// The panel; its left side is clamped and its right side loaded.
const PANEL: [[f64; 2]; 4] = [[0.0, 0.0], [48.0, 44.0], [48.0, 60.0], [0.0, 44.0]];
/// Young's modulus \[force/length²\].
const YOUNG: f64 = 70.0;
/// Traction upwards on the right side \[force/length²\].
const TRACTION: f64 = 6.25;
/// Share of the load that is applied; displacements are divided by it, the problem being linear.
const SHARE: f64 = 1e-3;

/// The upward displacement of the upper right corner in small strain \[length\].
fn corner(poisson: f64, method: &Method, cells: usize) -> Result<(RunRecord, f64), CaseError> {
    let h = WIDTH / cells as f64;
    let top = (60.0 / h).round() as usize;
    let grid = grid_of(h, [cells + 1, top + 1])?;
    let particles = Particles::new(&fill_polygon(&grid, &PANEL, POINTS, 1.0, 0)?)?;
    let mut body = Body {
        particles,
        load_points: LoadPoint::along_edge(PANEL[1], PANEL[2], [0.0, TRACTION], 4 * cells, 0),
        rigid: Vec::new(),
        reinforcement: Vec::new(),
        free_fields: Vec::new(),
    };
    let law: SharedLaw = Arc::new(HenckyElastic::new(Elasticity::new(YOUNG, poisson)?));
    let mut constraints = Constraints::free(&grid);
    constraints.fix_wall(&grid, 0, false, 0)?;
    constraints.fix_wall(&grid, 0, false, 1)?;
    let method = Method {
        kinematics: Kinematics::SmallStrain,
        ..method.clone()
    };
    let load_path = |_from: f64, to: f64| {
        StepConditions::new(
            grid.clone(),
            constraints.clone(),
            StepLoads {
                factors: vec![to * SHARE],
                ..StepLoads::gravity([0.0; 2])
            },
            vec![Arc::clone(&law)],
        )
    };
    let mut rise = f64::NAN;
    let mut observe = |accepted: &Accepted<'_, 2>| {
        rise = accepted.forces.u[grid.node_index([cells, top])][1] / SHARE;
        ControlFlow::Continue(())
    };
    let variant = format!("{}, ν = {poisson:.4}, {cells} cells", method.label());
    let settings = MarchSettings::steps(1);
    let (run, _) = run(
        variant,
        &mut body,
        &method,
        &settings,
        &load_path,
        &mut observe,
    );
    Ok((run, rise))
}

/// Runs the study.
pub(crate) fn study(level: Level, out: &Path) -> Result<Study, CaseError> {
    let mut study = Study::new("cook", ABOUT, out)?;
    let meshes: &[usize] = match level {
        Level::Quick => &[6, 12, 24, 48],
        Level::Default => &[6, 12, 24, 48, 96],
        Level::Full => &[6, 12, 24, 48, 96, 192],
    };
    for (poisson, name, reference) in RATIOS {
        let mut series = Vec::new();
        for method in [Method::igimp(), Method::igimp_bbar()] {
            series.push((
                method.label(),
                refine(&mut study, poisson, reference, &method, meshes)?,
            ));
        }
        picture(&mut study, poisson, name, reference, &series)?;
    }
    Ok(study)
}

/// Runs all meshes and checks the finer ones; the control is a mesh of 24 cells without B-bar.
fn refine(
    study: &mut Study,
    poisson: f64,
    reference: f64,
    method: &Method,
    meshes: &[usize],
) -> Result<Vec<[f64; 2]>, CaseError> {
    let solved = meshes
        .par_iter()
        .map(|&cells| corner(poisson, method, cells))
        .collect::<Result<Vec<_>, CaseError>>()?;
    let runs: Vec<&RunRecord> = solved.iter().map(|(run, _)| run).collect();
    let variant = format!("{}, ν = {}", method.label(), short(poisson));
    let run = study.run(RunRecord::sum(variant, &runs));
    let points: Vec<[f64; 2]> = std::iter::zip(meshes, &solved)
        .map(|(&cells, &(_, rise))| [cells as f64, rise])
        .collect();
    let expected = MIXED_ELEMENTS.says(reference);
    for &[cells, rise] in &points {
        let quantity = format!("u_y of the corner, {cells} cells [-]");
        if method.locking == Locking::BBar && cells >= 48.0 {
            let band = Band::Relative(if cells > 48.0 { 0.003 } else { 0.007 });
            study.check(run, quantity, expected, band, rise);
        } else if method.locking == Locking::None && poisson > 0.499 && (cells - 24.0).abs() < 0.5 {
            let quantity = format!("{quantity}, must lock");
            study.control(run, quantity, expected, Band::AtMost(0.7 * reference), rise);
        }
    }
    Ok(points)
}

/// Table and picture of one Poisson's ratio.
fn picture(
    study: &mut Study,
    poisson: f64,
    name: &str,
    reference: f64,
    series: &[(String, Vec<[f64; 2]>)],
) -> Result<(), CaseError> {
    let mut table = Table::new(
        format!("corner_{name}_{}_meshes", series[0].1.len()),
        &["cells", "iGIMP_u_y_[-]", "iGIMP+B-bar_u_y_[-]"],
    );
    for (plain, bar) in std::iter::zip(&series[0].1, &series[1].1) {
        table.push(vec![plain[0], plain[1], bar[1]]);
    }
    let style = SeriesStyle::LineAndMarkers(LineStyle::Solid);
    CurvePlot {
        title: format!("Cook's membrane, ν = {}", short(poisson)),
        x_label: "cells over the width".into(),
        y_label: "u_{y} of the upper right corner".into(),
        x_scale: Scale::Log,
        series: series
            .iter()
            .map(|(label, points)| Series::new(label, points.clone(), style))
            .collect(),
        lines: vec![ReferenceLine {
            label: format!("mixed elements {reference}"),
            at: ReferenceValue::Y(reference),
        }],
        ..CurvePlot::default()
    }
    .write(&study.folder.join(format!("corner_{name}")))?;
    study.table(table)
}
