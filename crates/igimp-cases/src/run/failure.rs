//! The message of a step that found no equilibrium, and its remedies.

pub(super) mod advice;
pub(crate) mod message;

use igimp_linear::LinearSolverError;
use igimp_material::Regime;
use igimp_model::{Field, RigidMove, StageKind};
use igimp_results::ending::PathEnd;
use igimp_results::fields;
use igimp_results::summary::StageSummary;
use igimp_solver::{StepError, StepFailure};

use super::model::Model;
use super::session::Session;
use super::stages::dynamic::most_cuts;
use super::state::State;
use super::{Failure, NearWorst};
use advice::Seen;

/// Share of its shear strength from which on a particle counts as close to failure \[-\].
const AT_STRENGTH: f64 = 0.9;

/// Whether a stage that found no equilibrium ended in a way that tells no limit: its path was lost, its linear system
/// could not be solved, or nothing but a motion was driven, which has an equilibrium at any load.
pub(crate) fn tells_no_limit(
    kind: &StageKind,
    failure: &StepFailure,
    summary: &StageSummary,
) -> bool {
    let path_is_lost = (summary.path.as_ref()).is_some_and(|path| path.end == PathEnd::Lost);
    let is_driven = match kind {
        StageKind::Displacement { .. } => true,
        StageKind::Rigid(moves) => {
            moves.iter().any(RigidMove::is_moved) && !moves.iter().any(RigidMove::is_loaded)
        }
        _ => false,
    };
    path_is_lost
        || is_driven
        || matches!(
            failure,
            StepFailure::Linear(_) | StepFailure::Singular { .. }
        )
}

/// Whether a stage ended where it began as nothing holds the ground or a body: its supports are wanting, and no load is a limit.
pub(crate) fn is_without_hold(failure: &StepFailure, summary: &StageSummary) -> bool {
    let is_singular = matches!(
        failure,
        StepFailure::Singular { .. } | StepFailure::NotHeld { .. }
    );
    is_singular && summary.reached == 0.0
}

/// Describes the step that ended a stage.
pub(crate) fn describe<const D: usize>(
    session: &Session<'_, D>,
    number: usize,
    state: &State<D>,
    summary: &StageSummary,
    error: StepError,
) -> Failure {
    let case = session.model.case;
    let stage = &case.stages[number];
    let around = error
        .worst
        .map(|(x, _)| around(session.model, state, std::array::from_fn(|axis| x[axis])));
    let near_worst = around.as_ref().map(|(counts, _)| *counts);
    let peak = summary.peak_resistance.filter(|peak| *peak > 0.0);
    let seen = Seen {
        near_worst,
        fallen: peak.map_or(0.0, |peak| 1.0 - session.last_resistance / peak),
    };
    Failure {
        stage: stage.name.clone(),
        step: match stage.kind {
            StageKind::StrengthReduction(_) => summary.steps + 1,
            _ => (error.from * stage.steps as f64).floor() as usize + 1,
        },
        steps: stage.steps,
        cuts: most_cuts(case, &stage.kind),
        smallest: (error.to - error.from) * stage.steps as f64,
        max_iterations: case.solver.max_iterations,
        near_worst,
        material: around.and_then(|(_, material)| material),
        suggestions: advice::advice(case, number, &error, seen),
        saved: Vec::new(),
        error,
    }
}

/// A uniform collapse, in words.
pub(crate) const COLLAPSE: &str = "the soil comes to its strength all at once";

/// Whether a linear system could not be solved because soil came to its strength: the system of the step's start was solved,
/// and soil around the worst node was close to failure.
pub(crate) fn is_loss_of_strength(error: &StepError, near: Option<&NearWorst>) -> bool {
    let is_singular = matches!(
        &*error.failure,
        StepFailure::Linear(
            LinearSolverError::Singular { .. }
                | LinearSolverError::NotPositiveDefinite { .. }
                | LinearSolverError::Inaccurate { .. }
        ) | StepFailure::Singular { .. }
    );
    is_singular && error.residuals.len() > 1 && near.is_some_and(NearWorst::is_at_strength)
}

/// Particles within a cell of a place, and the material of most of them.
fn around<const D: usize>(
    model: &Model<'_, D>,
    state: &State<D>,
    place: [f64; D],
) -> (NearWorst, Option<String>) {
    let (case, particles) = (model.case, &state.body.particles);
    let laws = model.laws_reduced_by(&state.controls.srf);
    let laws = laws.as_ref().map_or(&[][..], |laws| &laws[..]);
    let mut near = NearWorst::default();
    let mut by_material = vec![0_usize; case.materials.len()];
    let reach = case.grid.cell_at(place);
    for (particle, x) in particles.x.iter().enumerate() {
        if !(0..D).all(|axis| (x[axis] - place[axis]).abs() <= reach[axis]) {
            continue;
        }
        let regime = particles.regime[particle];
        let at_tip = matches!(
            regime,
            Regime::Apex | Regime::TensionApex | Regime::TensionEdge | Regime::TensionCorner
        );
        let used = fields::value(Field::Utilisation, particles, particle, laws);
        near.points += 1;
        near.yielding += usize::from(regime.is_plastic());
        near.apex += usize::from(at_tip);
        near.at_strength += usize::from(used >= AT_STRENGTH);
        by_material[case.number_of_material(particles.law[particle])] += 1;
    }
    let most = by_material
        .iter()
        .enumerate()
        .max_by_key(|(_, count)| **count)
        .filter(|(_, count)| **count > 0)
        .map(|(material, _)| case.materials[material].name.clone());
    (near, most)
}
