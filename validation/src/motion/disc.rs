//! A disc that turns once: the loss of its angular momentum.

use std::f64::consts::PI;

use igimp_assembly::{
    Constraints, Method, ParticleSeed, Remedy, StepConditions, StepLoads, TimeScheme,
};
use igimp_cases::CaseError;
use igimp_model::check::Band;
use igimp_solver::Body;

use super::{Steps, elastic, moved, moving};
use crate::continuum::laboratory::{grid_of, unobserved};
use crate::harness::oracle::{Oracle, OracleKind};
use crate::harness::study::{Level, Study};

const CONSERVED: Oracle = Oracle {
    kind: OracleKind::Theory,
    source: "conservation of angular momentum",
    locator: "nothing turns a free disc; a method of second order in cell and step loses by their square",
};

/// A disc of radius 1 about (2, 2) that turns by 1 rad in a unit of time, in cells of a size.
fn disc(cell: f64) -> Result<Body<2>, CaseError> {
    let along = (8.0 / cell).round() as usize;
    let places = (0..along * along).map(|k| {
        let place = [k % along, k / along];
        place.map(|k| (0.5 * k as f64 + 0.25) * cell)
    });
    let seeds: Vec<_> = places
        .filter(|x| (x[0] - 2.0).hypot(x[1] - 2.0) < 1.0)
        .map(|x| ParticleSeed {
            x,
            half_length: [0.25 * cell; 2],
            volume: 0.25 * cell * cell,
            density: 1.0,
            law: 0,
            centroid: [0.0; 2],
        })
        .collect();
    moving(&seeds, |x| [-(x[1] - 2.0), x[0] - 2.0])
}

fn angular_momentum(body: &Body<2>) -> f64 {
    let both = std::iter::zip(&body.particles.x, &body.particles.velocity);
    both.zip(&body.particles.mass)
        .map(|((x, v), m)| m * ((x[0] - 2.0) * v[1] - (x[1] - 2.0) * v[0]))
        .sum()
}

/// The run of a disc that turns once, and the share that it loses \[-\].
fn turned(
    study: &mut Study,
    cell: f64,
    lumped: f64,
    (scheme, name): (TimeScheme, &str),
) -> Result<(usize, f64), CaseError> {
    let mut body = disc(cell)?;
    let before = angular_momentum(&body);
    let count = (24.0 / cell).round() as usize;
    let grid = grid_of(cell, [(4.0 / cell).round() as usize; 2])?;
    let constraints = Constraints::free(&grid);
    let loads = StepLoads::gravity([0.0; 2]);
    let still = StepConditions::new(grid, constraints, loads, vec![elastic()?])?;
    let mut method = Method::igimp();
    method.small_cuts.below = 0.2;
    method.small_cuts.remedy = Remedy::Extrapolate;
    let steps = Steps {
        lumped,
        tolerance: 1e-9,
        ..Steps::of(scheme, 2.0 * PI / count as f64, count)
    };
    let variant = format!(
        "disc of {:.0} cells, {name}, lumped share {lumped}",
        2.0 / cell
    );
    let conditions = |_: f64, _: f64| Ok(still.clone());
    let run = moved(
        &variant,
        &mut body,
        &method,
        steps,
        &conditions,
        &mut unobserved,
    );
    let run = study.run_to_end(run);
    Ok((run, 1.0 - angular_momentum(&body) / before))
}

/// Holds the loss against zero, and its order against two.
pub(super) fn hold(study: &mut Study, level: Level) -> Result<(), CaseError> {
    let alpha = (TimeScheme::GeneralisedAlpha, "generalised-α");
    let (_, coarse) = turned(study, 0.25, 0.0, alpha)?;
    let (run, fine) = turned(study, 0.125, 0.0, alpha)?;
    let quantity = "share of angular momentum that is lost in a turn [-]";
    let band = Band::Between(-5e-4, 5e-4);
    study.check(run, quantity, CONSERVED.says(0.0), band, fine);
    let order = (coarse / fine).log2();
    let quantity = "order of the loss, from 8 cells to 16 [-]";
    let band = Band::AtLeast(1.8);
    study.check(run, quantity, CONSERVED.says(2.0), band, order);
    let (run, lost) = turned(study, 0.25, 1.0, alpha)?;
    let quantity = "share of angular momentum that is lost in a turn [-]";
    let band = Band::AtLeast(0.5);
    study.control(run, quantity, CONSERVED.says(0.0), band, lost);
    if level == Level::Full {
        let euler = (TimeScheme::BackwardEuler, "backward Euler");
        let (_, coarse) = turned(study, 0.25, 0.0, euler)?;
        let (run, fine) = turned(study, 0.125, 0.0, euler)?;
        let order = (coarse / fine).log2();
        let quantity = "order of the loss, from 8 cells to 16 [-]";
        let band = Band::Between(0.5, 1.2);
        study.check(run, quantity, CONSERVED.says(1.0), band, order);
    }
    Ok(())
}
