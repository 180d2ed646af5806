//! The displacement at which a body counts as failed when the case states none.

use igimp_assembly::Geometry;

use crate::run::model::Model;
use crate::run::state::State;
use igimp_model::Stage;

/// The displacement γH²/E at which a body of moving geometry counts as failed when the case states none
/// \[m\] (theory, eq. 32a), with means over the volume: the mean unit weight and the mean of 1/E. None on
/// a given geometry, which needs none, and for bodies without weight.
pub(super) fn default_limit<const D: usize>(
    model: &Model<'_, D>,
    stage: &Stage,
    state: &State<D>,
) -> Option<f64> {
    if stage.geometry == Geometry::Given {
        return None;
    }
    displacement_scale(model, state)
}

/// The displacement γH²/E \[m\] (theory, eq. 32a); none for bodies without weight.
pub(crate) fn displacement_scale<const D: usize>(
    model: &Model<'_, D>,
    state: &State<D>,
) -> Option<f64> {
    let particles = &state.body.particles;
    let weight = particles.mass.iter().sum::<f64>() * model.case.gravity;
    let volume: f64 = particles.volume0.iter().sum();
    let soft: f64 = (particles.volume0.iter().enumerate())
        .map(|(particle, volume)| volume / particles.young(particle, &model.laws))
        .sum();
    let scale = weight / volume * height(state).powi(2) * soft / volume;
    (scale > 0.0).then_some(scale)
}

/// Height of the bodies \[m\].
pub(super) fn height<const D: usize>(state: &State<D>) -> f64 {
    let particles = &state.body.particles;
    let levels = || {
        let edges = particles.x.iter().zip(&particles.half_length);
        let up = D - 1;
        edges.flat_map(move |(x, half_length)| [x[up] - half_length[up], x[up] + half_length[up]])
    };
    levels().fold(f64::NEG_INFINITY, f64::max) - levels().fold(f64::INFINITY, f64::min)
}
