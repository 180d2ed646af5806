//! A smooth rigid wedge pushed deep into rigid-plastic soil.

use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Arc;

use igimp_assembly::{Interface, Method, Particles, RigidMotion, SharedLaw};
use igimp_cases::CaseError;
use igimp_cases::check::Band;
use igimp_cases::table::Table;
use igimp_material::{Elasticity, Tresca};
use igimp_solver::{Accepted, Body, MarchSettings};
use rayon::prelude::*;

use super::{Ground, force, graded, polygon, weightless};
use crate::laboratory::run;
use crate::oracle::{Oracle, OracleKind};
use crate::study::{Level, RunRecord, Study};

/// What the book says of the study.
const ABOUT: &str = "A smooth rigid wedge is pushed into weightless Tresca soil with E/s_u = 1000. The motion is self-similar: the force over the depth and the height of the lip are those of Hill, Lee and Tupper.";
const HILL: Oracle = Oracle {
    kind: OracleKind::Exact,
    source: "Hill, Lee and Tupper 1947, indentation by a smooth wedge",
    locator: "cos(2β − ψ) = cos ψ/(1 + sin ψ), p = 2 s_u (1 + ψ)",
};
/// Young's modulus over undrained strength \[-\].
const YOUNG: f64 = 1e3;
/// Depth at the end.
const DEPTH: f64 = 1.0;

/// Semi-angle in degrees, P/(s_u c), height of the lip over depth.
const TABLE: [(f64, f64, f64); 3] = [
    (15.0, 1.417_32, 0.2079),
    (30.0, 4.027_60, 0.3388),
    (45.0, 8.942_77, 0.4196),
];

/// Pushes half a wedge; depth, P/(s_u c) and height of the lip over depth by step.
fn push(degrees: f64, cells: usize) -> Result<(RunRecord, Table), CaseError> {
    let h = DEPTH / cells as f64;
    let tangent = degrees.to_radians().tan();
    let reach = (2.5 * DEPTH / h).round() * h;
    let ground = Ground::new(
        graded(h, [0.0, reach], [0.0, 5.0 * DEPTH], 1.2),
        graded(h, [-2.0 * DEPTH, 0.0], [-4.0 * DEPTH, 0.0], 1.2),
        cells / 2 + 3,
        2,
    )?;
    let mut body = Body::new(Particles::new(&ground.seeds)?);
    let tall = 2.0 * DEPTH;
    let corners = [[0.0, 0.0], [tall * tangent, tall], [-tall * tangent, tall]];
    body.rigid = vec![polygon(&corners, 2.0 * h, &Interface::smooth(), [0.0; 2])];
    let law: SharedLaw = Arc::new(Tresca::new(Elasticity::new(YOUNG, 0.49)?, 1.0)?);
    let constraints = ground.held()?;
    let load_path = |from: f64, to: f64| {
        let motion = RigidMotion::displaced([0.0, -DEPTH * (to - from)]);
        weightless(&ground.grid, &constraints, &law, motion)
    };
    let mut curve = Table::new(
        format!("force_{degrees}_{cells}"),
        &["depth_[-]", "P_[s_u c]", "lip_[c]"],
    );
    let mut observe = |accepted: &Accepted<'_, 2>| {
        let depth = DEPTH * accepted.report.to;
        let particles = &accepted.body.particles;
        let tops = (0..particles.len()).map(|p| particles.x[p][1] + particles.half_length[p][1]);
        let lip = tops.fold(0.0, f64::max);
        curve.push(vec![depth, -2.0 * force(accepted)[1] / depth, lip / depth]);
        ControlFlow::Continue(())
    };
    let (run, _) = run(
        format!("β = {degrees}°, c/h = {cells}"),
        &mut body,
        &Method::shared_strain(),
        &MarchSettings::steps(4 * cells),
        &load_path,
        &mut observe,
    );
    Ok((run, curve))
}

/// Runs the study.
pub(crate) fn study(level: Level, out: &Path) -> Result<Study, CaseError> {
    let mut study = Study::new("contact-wedge", ABOUT, out)?;
    let meshes: &[usize] = match level {
        Level::Quick => &[8],
        Level::Default => &[16],
        Level::Full => &[16, 24],
    };
    let mut jobs = Vec::new();
    for &cells in meshes {
        jobs.extend(TABLE.map(|row| (row, cells)));
    }
    let done = jobs
        .par_iter()
        .map(|((degrees, ..), cells)| push(*degrees, *cells))
        .collect::<Result<Vec<_>, CaseError>>()?;
    for (((_, force, lip), _), (record, curve)) in jobs.iter().zip(done) {
        let run = study.run_to_end(record);
        // The depth is known to a cell: the last half of the push tells.
        let late: Vec<&Vec<f64>> = curve
            .rows
            .iter()
            .filter(|row| row[0] > 0.5 * DEPTH)
            .collect();
        let mean = |k: usize| late.iter().map(|row| row[k]).sum::<f64>() / late.len() as f64;
        study.check(
            run,
            "P/(s_u c), mean beyond half of the depth [-]",
            HILL.says(*force),
            Band::Relative(0.03),
            mean(1),
        );
        study.check(
            run,
            "height of the lip / c, likewise [-]",
            HILL.says(*lip),
            Band::Relative(0.05),
            mean(2),
        );
        curve.write_csv(&study.folder)?;
    }
    Ok(study)
}
