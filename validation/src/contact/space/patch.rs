//! Constant pressure through a contact in space.

use std::sync::Arc;

use igimp_assembly::{
    Constraints, Interface, Method, ParticleSeed, Particles, RigidBody, RigidMotion, SharedLaw,
    Surface,
};
use igimp_cases::CaseError;
use igimp_material::{Elasticity, HenckyElastic};
use igimp_model::check::Band;
use igimp_results::tables::table::Table;
use igimp_shape::{Axis, Grid};
use igimp_solver::{Body, MarchSettings};

use super::super::{closed, weightless};
use crate::continuum::laboratory::{run, unobserved};
use crate::harness::oracle::{Oracle, OracleKind};
use crate::harness::study::{Level, RunRecord, Study};

const UNIFORM: Oracle = Oracle {
    kind: OracleKind::Exact,
    source: "uniform compression, ν = 0",
    locator: "σ is the same everywhere, and the pressure is −σ",
};
const ORDER: Oracle = Oracle {
    kind: OracleKind::Theory,
    source: "stepped boundary of particle domains",
    locator: "a layer of cells of error O(1): the root mean square falls as √h",
};
/// Young's modulus \[stress\].
const YOUNG: f64 = 100.0;
/// Direction in which a turned plate rises, against the first axis \[rad\], and how it is turned about its own axis.
const RISES: f64 = 0.436;
const SPUN: f64 = 0.5;

/// A smooth plate with its middle at the origin of its frame.
fn plate(half: [f64; 3], spacing: f64, origin: [f64; 3]) -> RigidBody<3> {
    let surface = Surface::cuboid(half, 0.0, spacing).expect("the plate has a volume");
    RigidBody::new(surface, vec![Interface::smooth(); 6], origin)
}

/// Largest relative deviations of stress and of contact pressure from uniform ones in a block with its surface
/// `offset` cells above a line of the grid and its sides as far from others, under a plate that is turned about the
/// vertical by an angle \[rad\].
fn level(offset: f64, angle: f64) -> Result<(RunRecord, [f64; 2]), CaseError> {
    let axis = |cells| Axis::uniform(0.0, 1.0, cells);
    let grid = Grid::new([axis(6)?, axis(5)?, axis(6)?]);
    let extent = [3.0 + offset, 2.0 + offset, 3.0 + offset];
    let count = [6_usize, 4, 6];
    let half: [f64; 3] = std::array::from_fn(|a| 0.5 * extent[a] / count[a] as f64);
    let start = [1.0 + offset, 1.0 + offset, 0.0];
    let seeds: Vec<ParticleSeed<3>> = (0..count.iter().product())
        .map(|number: usize| {
            let place = [number % 6, number / 6 % 4, number / 24];
            ParticleSeed {
                x: std::array::from_fn(|a| start[a] + half[a] * (2 * place[a] + 1) as f64),
                half_length: half,
                volume: 8.0 * half.iter().product::<f64>(),
                density: 1.0,
                law: 0,
                centroid: [0.0; _],
            }
        })
        .collect();
    let mut body = Body::new(Particles::new(&seeds)?);
    let mut top = plate([4.0, 4.0, 0.5], 1.5, [2.8, 2.3, extent[2] + 0.5]);
    top.pose = top.pose.moved(&[0.0; 3], &[0.0, 0.0, angle]);
    body.rigid = vec![top];
    let mut constraints = Constraints::free(&grid);
    for axis in 0..3 {
        constraints.fix_wall(&grid, 2, false, axis)?;
    }
    let law: SharedLaw = Arc::new(HenckyElastic::new(Elasticity::new(YOUNG, 0.0)?));
    let load_path = |from: f64, to: f64| {
        let motion = RigidMotion::displaced([0.0, 0.0, -0.04 * (to - from)]);
        weightless(&grid, &constraints, &law, motion)
    };
    let mut settings = MarchSettings::steps(2);
    settings.newton.tolerance = 1e-12;
    let (run, _) = run(
        format!("{offset} h off the lines of the grid, plate turned by {angle} about the vertical"),
        &mut body,
        &Method::igimp(),
        &settings,
        &load_path,
        &mut unobserved,
    );
    let sigma = &body.particles.sigma;
    let mean = sigma.iter().map(|sigma| sigma[2][2]).sum::<f64>() / sigma.len() as f64;
    let stress = sigma
        .iter()
        .flat_map(|sigma| {
            let [[xx, xy, xz], [_, yy, yz], [_, _, zz]] = *sigma;
            [zz - mean, xx, yy, xy, xz, yz]
        })
        .map(|off| (off / mean).abs())
        .fold(0.0, f64::max);
    let pressure = closed(&body.rigid)
        .iter()
        .map(|(_, node)| (node.pressure / -mean - 1.0).abs())
        .fold(0.0, f64::max);
    Ok((run, [stress, pressure]))
}

/// Root mean square of the deviation of stress below a plate that is turned by an angle \[rad\] against the
/// vertical, over the pressure; and that of the mean stress. All sides move towards a corner, so that the exact
/// stress is equal in all directions.
fn turned(angle: f64, cells: usize) -> Result<(RunRecord, [f64; 2]), CaseError> {
    let h = 1.0 / cells as f64;
    let grid = Grid::new([
        Axis::uniform(0.0, h, cells)?,
        Axis::uniform(0.0, h, cells)?,
        Axis::uniform(0.0, h, 2 * cells)?,
    ]);
    let (rise, (sin, cos)) = (angle.tan(), RISES.sin_cos());
    let height = |x: f64, y: f64| 0.4 + rise * (cos * x + sin * y);
    let (part, mut seeds) = (0.5 * h, Vec::new());
    for column in 0..4 * cells * cells {
        let [x, y] = [column % (2 * cells), column / (2 * cells)].map(|k| part * (k as f64 + 0.5));
        let count = (height(x, y) / part).round();
        let size = height(x, y) / count;
        seeds.extend((0..count as usize).map(|k| ParticleSeed {
            x: [x, y, size * (k as f64 + 0.5)],
            half_length: [0.5 * part, 0.5 * part, 0.5 * size],
            volume: part * part * size,
            density: 1.0,
            law: 0,
            centroid: [0.0; _],
        }));
    }
    let mut body = Body::new(Particles::new(&seeds)?);
    let normal = [-angle.sin() * cos, -angle.sin() * sin, angle.cos()];
    let middle = [0.5, 0.5, height(0.5, 0.5)];
    let origin = std::array::from_fn(|a| middle[a] + 0.25 * normal[a]);
    let mut top = plate([2.0, 2.0, 0.25], h, origin);
    let about = [angle * sin, -angle * cos, 0.0];
    top.pose = top.pose.moved(&[0.0; 3], &[0.0, 0.0, SPUN]);
    top.pose = top.pose.moved(&[0.0; 3], &about);
    body.rigid = vec![top];
    let strain = 1e-3;
    let law: SharedLaw = Arc::new(HenckyElastic::new(Elasticity::new(YOUNG, 0.0)?));
    let load_path = |from: f64, to: f64| {
        let by = (to - from) * strain;
        let mut constraints = Constraints::free(&grid);
        for axis in 0..3 {
            constraints.fix_wall(&grid, axis, false, axis)?;
        }
        for node in 0..grid.node_count() {
            let place = grid.node_place(node);
            for axis in (0..2).filter(|&axis| place[axis] == cells) {
                constraints.prescribe(node, axis, -by)?;
            }
        }
        let motion = RigidMotion::displaced([0.0, 0.0, -height(0.0, 0.0) * by]);
        weightless(&grid, &constraints, &law, motion)
    };
    let (run, _) = run(
        format!(
            "turned by {:.0}° against the vertical, h = 1/{cells}",
            angle.to_degrees()
        ),
        &mut body,
        &Method::igimp(),
        &MarchSettings::steps(2),
        &load_path,
        &mut unobserved,
    );
    let exact = YOUNG * (1.0 - strain).ln() / (1.0 - strain).powi(3);
    let (mut square, mut mean, mut volume) = (0.0, 0.0, 0.0);
    for (particle, sigma) in body.particles.sigma.iter().enumerate() {
        let volume0 = body.particles.volume0[particle];
        for a in 0..3 {
            for b in a..3 {
                let off = sigma[a][b] - if a == b { exact } else { 0.0 };
                square += volume0 * off * off;
            }
            mean += volume0 * sigma[a][a] / 3.0;
        }
        volume += volume0;
    }
    let rms = (square / volume).sqrt() / exact.abs();
    Ok((run, [rms, (mean / volume / exact - 1.0).abs()]))
}

/// Both checks.
pub(super) fn check(study: &mut Study, effort: Level) -> Result<(), CaseError> {
    for (offset, angle) in [
        (0.0, 0.0),
        (0.0, 0.7),
        (0.37, 0.0),
        (0.37, 0.3),
        (0.81, 1.2),
    ] {
        let (record, [stress, pressure]) = level(offset, angle)?;
        let run = study.run_to_end(record);
        let none = UNIFORM.says(0.0);
        let quantity = "largest deviation of stress over the pressure [-]";
        study.check(run, quantity, none, Band::AtMost(1e-9), stress);
        let quantity = "largest deviation of contact pressure [-]";
        study.check(run, quantity, none, Band::AtMost(1e-9), pressure);
    }
    let meshes: &[usize] = if effort == Level::Full {
        &[4, 8, 16]
    } else {
        &[4, 8]
    };
    for degrees in [15.0_f64, 30.0, 42.0] {
        let mut errors = Table::new(
            format!("turned_by_{degrees}_degrees"),
            &["cells", "rms_of_stress_[-]", "mean_stress_[-]"],
        );
        for &cells in meshes {
            let (record, [rms, mean]) = turned(degrees.to_radians(), cells)?;
            let run = study.run_to_end(record);
            errors.push(vec![cells as f64, rms, mean]);
            if let [first, .., end] = &errors.rows[..] {
                let order = (first[1] / end[1]).ln() / (end[0] / first[0]).ln();
                let quantity = format!("order of the root mean square of stress at {degrees}° [-]");
                study.check(run, quantity, ORDER.says(0.5), Band::AtLeast(0.4), order);
            }
        }
        errors.write_csv(&study.folder)?;
    }
    Ok(())
}
