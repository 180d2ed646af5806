//! Constant pressure through a contact.

use std::path::Path;
use std::sync::Arc;

use igimp_assembly::{
    Constraints, Interface, Method, ParticleSeed, Particles, RigidMotion, SharedLaw,
};
use igimp_cases::CaseError;
use igimp_geometry::seed::fill_polygon;
use igimp_material::{Elasticity, HenckyElastic};
use igimp_model::check::Band;
use igimp_results::tables::table::Table;
use igimp_shape::{Axis, Grid};
use igimp_solver::{Body, MarchSettings};

use super::{polygon, weightless};
use crate::continuum::laboratory::{run, unobserved};
use crate::harness::oracle::{Oracle, OracleKind};
use crate::harness::study::{RunRecord, Study};

/// The book's description of the study.
const ABOUT: &str = "A smooth plate presses an elastic block evenly. With its surface anywhere in its cell the stress is exact; below a plate that is turned against the grid, the stepped edge of the particles leaves an error that falls with the cell.";
const UNIFORM: Oracle = Oracle {
    kind: OracleKind::Exact,
    source: "uniform compression, ν = 0",
    locator: "σ is the same everywhere, and the pressure is −σ",
};
const ORDER: Oracle = Oracle {
    kind: OracleKind::Theory,
    source: "stepped boundary of particle domains",
    locator: "a strip of cells of error O(1): the root mean square falls as √h",
};

/// Largest relative deviations of stress and of contact pressure from uniform ones in a block with its
/// surface `offset` cells above a line of the grid and its sides as far from others.
fn square(offset: f64) -> Result<(RunRecord, [f64; 2]), CaseError> {
    let grid = Grid::new([Axis::uniform(0.0, 1.0, 9)?, Axis::uniform(0.0, 1.0, 7)?]);
    let (width, height) = (6.0 + offset, 4.0 + offset);
    let half = [width / 24.0, height / 16.0];
    let mut seeds = Vec::new();
    for place in 0..96_usize {
        let (column, row) = (place % 12, place / 12);
        seeds.push(ParticleSeed {
            x: [
                1.0 + offset + half[0] * (2 * column + 1) as f64,
                half[1] * (2 * row + 1) as f64,
            ],
            half_length: half,
            volume: 4.0 * half[0] * half[1],
            density: 1.0,
            law: 0,
            centroid: [0.0; _],
        });
    }
    let mut body = Body::new(Particles::new(&seeds)?);
    let corners = [[-5.0, 0.0], [5.0, 0.0], [5.0, 1.0], [-5.0, 1.0]];
    body.rigid = vec![polygon(&corners, 2.0, &Interface::smooth(), [4.3, height])];
    let mut constraints = Constraints::free(&grid);
    constraints.fix_wall(&grid, 1, false, 1)?;
    constraints.prescribe(grid.node_index([4, 0]), 0, 0.0)?;
    let law: SharedLaw = Arc::new(HenckyElastic::new(Elasticity::new(100.0, 0.0)?));
    let load_path = |from: f64, to: f64| {
        let motion = RigidMotion::displaced([0.0, -0.04 * (to - from)]);
        weightless(&grid, &constraints, &law, motion)
    };
    let mut settings = MarchSettings::steps(4);
    settings.newton.tolerance = 1e-12;
    let (run, _) = run(
        format!("{offset} h off the lines of the grid"),
        &mut body,
        &Method::igimp(),
        &settings,
        &load_path,
        &mut unobserved,
    );
    let sigma = &body.particles.sigma;
    let mean = sigma.iter().map(|sigma| sigma[1][1]).sum::<f64>() / sigma.len() as f64;
    let stress = sigma
        .iter()
        .flat_map(|sigma| [sigma[1][1] - mean, sigma[0][0], sigma[0][1]])
        .map(|off| (off / mean).abs())
        .fold(0.0, f64::max);
    let nodes = body.rigid[0].contact.knots.iter();
    let pressure = nodes
        .filter(|node| node.is_closed)
        .map(|node| (node.pressure / -mean - 1.0).abs())
        .fold(0.0, f64::max);
    Ok((run, [stress, pressure]))
}

/// Root mean square of the deviation of stress below a plate that is turned by an angle \[rad\], over the
/// pressure; and that of the mean stress. All sides move towards a corner, so that the exact stress is
/// equal in all directions of the plane.
fn turned(angle: f64, cells: usize) -> Result<(RunRecord, [f64; 2]), CaseError> {
    let h = 1.0 / cells as f64;
    let grid = Grid::new([
        Axis::uniform(0.0, h, cells)?,
        Axis::uniform(0.0, h, 2 * cells)?,
    ]);
    let slope = angle.tan();
    let outline = [[0.0, 0.0], [1.0, 0.0], [1.0, 0.5 + slope], [0.0, 0.5]];
    let seeds = fill_polygon(&grid, &outline, 3, 1.0, 0)?;
    let mut body = Body::new(Particles::new(&seeds)?);
    let corners = [[-2.0, 0.0], [2.0, 0.0], [2.0, 0.5], [-2.0, 0.5]];
    let mut plate = polygon(&corners, h, &Interface::smooth(), [0.0, 0.5]);
    plate.pose = plate.pose.moved(&[0.0; 2], &[angle, 0.0, 0.0]);
    body.rigid = vec![plate];
    let strain = 1e-3;
    let law: SharedLaw = Arc::new(HenckyElastic::new(Elasticity::new(100.0, 0.0)?));
    let load_path = |from: f64, to: f64| {
        let by = (to - from) * strain;
        let mut constraints = Constraints::free(&grid);
        constraints.fix_wall(&grid, 0, false, 0)?;
        constraints.fix_wall(&grid, 1, false, 1)?;
        for row in 0..grid.axes[1].node_count() {
            constraints.prescribe(grid.node_index([cells, row]), 0, -by)?;
        }
        let motion = RigidMotion::displaced([0.0, -0.5 * by]);
        weightless(&grid, &constraints, &law, motion)
    };
    let (run, _) = run(
        format!("turned by {:.0}°, h = 1/{cells}", angle.to_degrees()),
        &mut body,
        &Method::igimp(),
        &MarchSettings::steps(4),
        &load_path,
        &mut unobserved,
    );
    let exact = 100.0 * (1.0 - strain).ln() / (1.0 - strain).powi(2);
    let (mut square, mut mean, mut volume) = (0.0, 0.0, 0.0);
    for (particle, sigma) in body.particles.sigma.iter().enumerate() {
        let volume0 = body.particles.volume0[particle];
        for off in [sigma[0][0] - exact, sigma[1][1] - exact, sigma[0][1]] {
            square += volume0 * off * off;
        }
        mean += volume0 * 0.5 * (sigma[0][0] + sigma[1][1]);
        volume += volume0;
    }
    let rms = (square / volume).sqrt() / exact.abs();
    Ok((run, [rms, (mean / volume / exact - 1.0).abs()]))
}

/// Runs the study.
pub(crate) fn study(out: &Path) -> Result<Study, CaseError> {
    let mut study = Study::new("contact-patch", ABOUT, out)?;
    for offset in [0.0, 0.2, 0.37, 0.5, 0.62, 0.81] {
        let (record, [stress, pressure]) = square(offset)?;
        let run = study.run_to_end(record);
        let none = UNIFORM.says(0.0);
        let quantity = "largest deviation of stress over the pressure [-]";
        study.check(run, quantity, none, Band::AtMost(1e-9), stress);
        let quantity = "largest deviation of contact pressure [-]";
        study.check(run, quantity, none, Band::AtMost(1e-9), pressure);
    }
    let meshes: &[usize] = &[8, 16, 32];
    for degrees in [15.0_f64, 30.0, 42.0] {
        let mut errors = Table::new(
            format!("turned_by_{degrees}_degrees"),
            &["cells", "rms_of_stress_[-]", "mean_stress_[-]"],
        );
        let mut last = 0;
        for &cells in meshes {
            let (record, [rms, mean]) = turned(degrees.to_radians(), cells)?;
            last = study.run_to_end(record);
            errors.push(vec![cells as f64, rms, mean]);
        }
        let (first, end) = (&errors.rows[0], &errors.rows[meshes.len() - 1]);
        let order = (first[1] / end[1]).ln() / (end[0] / first[0]).ln();
        let quantity = format!("order of the root mean square of stress at {degrees}° [-]");
        study.check(last, quantity, ORDER.says(0.5), Band::AtLeast(0.4), order);
        errors.write_csv(&study.folder)?;
    }
    Ok(study)
}
