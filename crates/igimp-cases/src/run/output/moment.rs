//! A moment of a run that is recorded, and where it stands in the histories.

use igimp_assembly::{Particles, Reinforcement, RigidBody};
use igimp_model::Case;
use igimp_results::fields;
use igimp_results::summary::EnergySummary;
use igimp_shape::Grid;
use igimp_solver::Accepted;

use crate::run::state::Controls;

/// A state that is recorded: the end of a step, or of a trial in a strength reduction.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Moment<'a, const D: usize> {
    /// Number of the stage, from 0.
    pub(crate) stage: usize,
    /// Number of the step (or trial) in its stage, from 1; 0 before the first.
    pub number: usize,
    /// Share of the stage that is done \[-\].
    pub(crate) progress: f64,
    /// The grid of the step that led to it, or of the next one.
    pub(crate) grid: &'a Grid<D>,
    /// The particles.
    pub(crate) particles: &'a Particles<D>,
    /// The rigid bodies that are there.
    pub(crate) rigid: &'a [RigidBody<D>],
    /// The reinforcement that is there.
    pub(crate) reinforcement: &'a [Reinforcement<D>],
    /// The controls that act on them.
    pub(crate) controls: &'a Controls,
    /// Resistance of the footing \[N/m\].
    pub(crate) resistance: f64,
    /// Share of particles that yield \[-\].
    pub(crate) plastic_share: f64,
    /// Where the work of its stage went so far, of a stage that takes time.
    pub(crate) energy: Option<&'a EnergySummary>,
}

impl<const D: usize> Moment<'_, D> {
    /// The first columns of histories: the values of [`moment_columns`].
    pub(crate) fn row(&self, case: &Case<D>) -> Vec<f64> {
        let time = case.takes_time().then_some(self.controls.time);
        let place = [self.stage as f64 + 1.0, self.number as f64, self.progress];
        place.into_iter().chain(time).collect()
    }

    /// Length of the largest particle displacement \[m\].
    pub(crate) fn largest_displacement(&self) -> f64 {
        largest_displacement(self.particles)
    }
}

/// Kinetic energy of soil and rigid bodies \[J/m; J in space\].
pub(crate) fn kinetic_energy<const D: usize>(
    particles: &Particles<D>,
    rigid: &[RigidBody<D>],
) -> f64 {
    let soil = std::iter::zip(&particles.mass, &particles.velocity)
        .map(|(mass, velocity)| 0.5 * mass * fields::length(velocity).powi(2));
    soil.sum::<f64>() + rigid.iter().map(RigidBody::kinetic_energy).sum::<f64>()
}

/// Length of the largest particle displacement \[m\].
pub(crate) fn largest_displacement<const D: usize>(particles: &Particles<D>) -> f64 {
    particles
        .displacement
        .iter()
        .map(fields::length)
        .fold(0.0, f64::max)
}

/// An accepted step as a stage sees it.
pub(crate) struct AcceptedStep<'a, const D: usize> {
    /// The step in the solver's terms.
    pub(crate) accepted: &'a Accepted<'a, D>,
    /// The controls that act on the body now.
    pub(crate) controls: &'a Controls,
    /// Resistance of the footing \[N/m\].
    pub(crate) resistance: f64,
    /// Whether the user wants the run to end here.
    pub(crate) interrupted: bool,
}

impl<'a, const D: usize> AcceptedStep<'a, D> {
    /// The step as a moment to be recorded.
    pub(crate) fn moment(&self, stage: usize, number: usize) -> Moment<'a, D> {
        Moment {
            stage,
            number,
            progress: self.accepted.report.to,
            grid: &self.accepted.conditions.grid,
            particles: &self.accepted.body.particles,
            rigid: &self.accepted.body.rigid,
            reinforcement: &self.accepted.body.reinforcement,
            controls: self.controls,
            resistance: self.resistance,
            plastic_share: self.accepted.report.plastic_share,
            energy: None,
        }
    }
}

/// The first columns of histories: stage, step, share of the stage, and the time where a stage takes some.
pub(crate) fn moment_columns<const D: usize>(case: &Case<D>) -> impl Iterator<Item = String> {
    let time = case.takes_time().then_some("time_[s]");
    let place = ["stage", "step", "progress_[-]"];
    place.into_iter().chain(time).map(str::to_owned)
}
