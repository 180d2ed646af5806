//! Cook's membrane: a clamped, tapered panel under shear, from compressible to nearly
//! incompressible.

use std::path::Path;
use std::sync::Arc;

use igimp_assembly::{
    Constraints, Kinematics, LoadPoint, Method, Particles, SharedLaw, StepConditions, StepLoads,
};
use igimp_cases::CaseError;
use igimp_cases::check::Band;
use igimp_cases::figures::{
    CurvePlot, LineStyle, ReferenceLine, ReferenceValue, Scale, Series, SeriesStyle,
};
use igimp_cases::seed::fill_polygon;
use igimp_cases::table::Table;
use igimp_material::{Elasticity, HenckyElastic};
use igimp_solver::{Accepted, Body, MarchSettings};
use rayon::prelude::*;
use std::ops::ControlFlow;

use crate::laboratory::{grid_of, run};
use crate::oracle::{Oracle, OracleKind};
use crate::study::{Level, Run, Study};

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
fn corner(
    poisson: f64,
    method: &Method,
    cells: usize,
    points: usize,
) -> Result<(Run, f64), CaseError> {
    let h = WIDTH / cells as f64;
    let top = (60.0 / h).round() as usize;
    let grid = grid_of(h, [cells + 1, top + 1])?;
    let particles = Particles::new(&fill_polygon(&grid, &PANEL, points, 1.0, 0)?)?;
    let mut body = Body {
        particles,
        load_points: LoadPoint::along_edge(PANEL[1], PANEL[2], [0.0, TRACTION], 4 * cells, 0),
    };
    let law: SharedLaw = Arc::new(HenckyElastic::new(Elasticity::new(YOUNG, poisson)?));
    let mut constraints = Constraints::free(&grid);
    constraints.fix_wall(&grid, 0, false, 0);
    constraints.fix_wall(&grid, 0, false, 1);
    let method = Method {
        kinematics: Kinematics::SmallStrain,
        ..method.clone()
    };
    let program = |_from: f64, to: f64| {
        Ok(StepConditions {
            grid: grid.clone(),
            constraints: constraints.clone(),
            loads: StepLoads {
                factors: vec![to * SHARE],
                ..StepLoads::gravity([0.0; 2])
            },
            laws: vec![Arc::clone(&law)],
        })
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
        &program,
        &mut observe,
    );
    Ok((run, rise))
}

pub(crate) fn study(level: Level, out: &Path) -> Result<Study, CaseError> {
    let mut study = Study::new("cook", "", out)?;
    for method in [Method::igimp_bbar(), Method::igimp()] {
        for points in [2, 3, 4] {
            for (poisson, exact) in [(1.0 / 3.0, 32.25), (0.49, 28.02), (0.4999, 27.68)] {
                for cells in [6, 12, 24, 48, 96] {
                    let (run, rise) = corner(poisson, &method, cells, points)?;
                    eprintln!(
                        "{} points {points}: {rise:.3} {exact} {:+.2} % iterations {} {:.2} s {}",
                        run.variant,
                        100.0 * (rise / exact - 1.0),
                        run.iterations,
                        run.seconds,
                        run.outcome
                    );
                }
            }
        }
    }
    let _ = level;
    Ok(study)
}
