//! What is known of a step that found no equilibrium, and what may help.

pub(super) mod advice;
pub(crate) mod message;

use igimp_assembly::Particles;
use igimp_material::Regime;
use igimp_model::{Case, RigidMove, StageKind};
use igimp_results::ending::PathEnd;
use igimp_results::summary::StageSummary;
use igimp_solver::{StepError, StepFailure};

use super::Failure;
use super::session::Session;
use super::stages::dynamic::most_cuts;
use super::state::State;
use advice::Seen;

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
    path_is_lost || is_driven || matches!(failure, StepFailure::Linear(_))
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
    let particles = &state.body.particles;
    let around = error
        .worst
        .map(|(x, _)| around(case, particles, std::array::from_fn(|axis| x[axis])));
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

/// Particles within a cell of a place: how many, how many yield, how many of them at an apex or a
/// corner in tension; and the material of most of them.
fn around<const D: usize>(
    case: &Case<D>,
    particles: &Particles<D>,
    place: [f64; D],
) -> ([usize; 3], Option<String>) {
    let mut counts = [0; 3];
    let mut by_material = vec![0_usize; case.materials.len()];
    let reach = case.grid.cell_at(place);
    for (particle, x) in particles.x.iter().enumerate() {
        let near = (0..D).all(|axis| (x[axis] - place[axis]).abs() <= reach[axis]);
        if !near {
            continue;
        }
        let regime = particles.regime[particle];
        let at_tip = matches!(
            regime,
            Regime::Apex | Regime::TensionApex | Regime::TensionEdge | Regime::TensionCorner
        );
        counts[0] += 1;
        counts[1] += usize::from(regime.is_plastic());
        counts[2] += usize::from(at_tip);
        by_material[case.number_of_material(particles.law[particle])] += 1;
    }
    let most = by_material
        .iter()
        .enumerate()
        .max_by_key(|(_, count)| **count)
        .filter(|(_, count)| **count > 0)
        .map(|(material, _)| case.materials[material].name.clone());
    (counts, most)
}
