//! The motion that a stage without inertia takes from a body.

use igimp_model::StageKind;
use igimp_text::short;

use crate::run::output::moment::kinetic_energy;
use crate::run::session::Session;
use crate::run::state::State;

/// Kinetic energy above this share of the largest one is told of \[-\].
const MOVES: f64 = 1e-3;

/// The fall of a body, in cells, whose energy is that of round-off \[-\]: displacements of statics are known to no more digits.
const ROUND_OFF: f64 = 1e-10;

/// Takes the motion from a state with which a stage without inertia begins, and tells of it. A search leaves the state as it
/// finds it, and its trials begin at rest.
pub(crate) fn still<const D: usize>(
    session: &mut Session<'_, D>,
    number: usize,
    state: &mut State<D>,
) {
    match session.model.case.stages[number].kind {
        StageKind::Dynamic(_) => {}
        StageKind::StrengthReduction(_) => {
            if let Some(text) = lost(session, state) {
                session.warn_of_stage(
                    number,
                    &format!("{text}: the search takes it for at rest, and the next motion goes on with it"),
                );
            }
        }
        _ => {
            if let Some(text) = lost(session, state) {
                session.warn_of_stage(
                    number,
                    &format!("{text}: a stage without inertia stops it; let it come to rest before, by at_rest"),
                );
            }
            state.rest();
        }
    }
}

/// That a state moves, in words, if it does.
fn lost<const D: usize>(session: &Session<'_, D>, state: &State<D>) -> Option<String> {
    let energies = session.summary.stages.iter();
    let energies = energies.filter_map(|stage| stage.energy.as_ref());
    let most = energies.fold(0.0, |most: f64, energy| most.max(energy.most_kinetic));
    let (particles, rigid) = (&state.body.particles, &state.body.rigid);
    let share = kinetic_energy(particles, rigid) / most;
    let case = session.model.case;
    let cell = case
        .grid
        .smallest_cell()
        .into_iter()
        .fold(f64::INFINITY, f64::min);
    let mass =
        particles.mass.iter().sum::<f64>() + rigid.iter().map(|body| body.motion.mass).sum::<f64>();
    let round_off = ROUND_OFF * mass * case.gravity * cell;
    (most > round_off && share > MOVES).then(|| {
        format!(
            "the body moves as it begins, with {} % of the largest kinetic energy so far",
            short(100.0 * share)
        )
    })
}
