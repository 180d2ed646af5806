//! Motion in time, below the case files and above: modes of bars, bodies that turn, slide and roll, layers that are shaken, deposits at
//! rest.

mod bar;
mod deposits;
mod disc;
mod layers;
mod revolution;
mod rolling;
mod slump;

use std::path::Path;

use igimp_assembly::{
    Method, ParticleSeed, Particles, SharedLaw, StepConditions, TimeScheme, TimeStep,
};
use igimp_cases::CaseError;
use igimp_material::{Elasticity, HenckyElastic};
use igimp_solver::{Body, MarchSettings, Observer};

use crate::continuum::laboratory::run;
use crate::harness::study::{Level, RunRecord, Study};

/// The book's description of the study.
const ABOUT: &str = "Motion in time by the schemes of the program: the first mode of a bar step by step, a disc that turns once, a block that slides and bodies that roll down an incline, waves in layers over rock that is shaken, and what clay and sand leave when they have spread and rest, columns of revolution among them, and a cylinder that breathes.";
/// Young's modulus and Poisson's ratio of bodies of unit density.
const YOUNG: f64 = 100.0;
const POISSON: f64 = 0.3;

/// How a body moves in time: by equal steps.
#[derive(Clone, Copy, Debug)]
struct Steps {
    scheme: TimeScheme,
    /// Share of the mass that is lumped \[-\].
    lumped: f64,
    /// How long one takes \[time\].
    duration: f64,
    count: usize,
    tolerance: f64,
}

impl Steps {
    /// Steps of a consistent mass that begin a motion.
    fn of(scheme: TimeScheme, duration: f64, count: usize) -> Self {
        Self {
            scheme,
            lumped: 0.0,
            duration,
            count,
            tolerance: 1e-11,
        }
    }
}

/// Moves a body under conditions that follow from those of a body at rest and the times of a step.
fn moved<const D: usize>(
    variant: &str,
    body: &mut Body<D>,
    method: &Method,
    steps: Steps,
    conditions: &dyn Fn(f64, f64) -> Result<StepConditions<D>, igimp_assembly::AssemblyError>,
    observer: &mut dyn Observer<D>,
) -> RunRecord {
    let whole = steps.duration * steps.count as f64;
    let load_path = |from: f64, to: f64| {
        conditions(from * whole, to * whole)?.with_time(Some(TimeStep {
            duration: steps.duration,
            scheme: steps.scheme,
            lumped: steps.lumped,
            is_first: from == 0.0,
            must_resolve: false,
        }))
    };
    let mut settings = MarchSettings::steps(steps.count);
    settings.cuts = 0;
    settings.newton.tolerance = steps.tolerance;
    run(variant, body, method, &settings, &load_path, observer).0
}

/// A bar along the first axis, of two particles of unit density in each of `cells` unit cells.
fn bar(cells: usize) -> Vec<ParticleSeed<1>> {
    (0..2 * cells)
        .map(|k| ParticleSeed {
            x: [0.25 + 0.5 * k as f64],
            half_length: [0.25],
            volume: 0.5,
            density: 1.0,
            law: 0,
            centroid: [0.0],
        })
        .collect()
}

/// Particles that begin with a velocity by their place.
fn moving<const D: usize>(
    seeds: &[ParticleSeed<D>],
    velocity: impl Fn(&[f64; D]) -> [f64; D],
) -> Result<Body<D>, CaseError> {
    let particles = Particles::new(seeds)?;
    let velocities = particles.x.iter().map(velocity).collect();
    Ok(Body::new(particles.with_velocities(velocities)?))
}

/// Elastic soil.
fn elastic() -> Result<SharedLaw, CaseError> {
    Ok(std::sync::Arc::new(HenckyElastic::new(Elasticity::new(
        YOUNG, POISSON,
    )?)))
}

/// The speed of compression waves in bars that are held across \[length/time\].
fn compression() -> f64 {
    (YOUNG * (1.0 - POISSON) / ((1.0 + POISSON) * (1.0 - 2.0 * POISSON))).sqrt()
}

/// Runs the study.
pub(crate) fn study(level: Level, out: &Path) -> Result<Study, CaseError> {
    let mut study = Study::new("motion", ABOUT, out)?;
    bar::hold(&mut study)?;
    disc::hold(&mut study, level)?;
    layers::hold(&mut study)?;
    rolling::hold(&mut study, level)?;
    slump::hold(&mut study, level)?;
    deposits::hold(&mut study, level)?;
    revolution::hold(&mut study, level)?;
    Ok(study)
}
