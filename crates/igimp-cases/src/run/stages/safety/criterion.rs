//! The displacement at which a body counts as failed when the case states none.

use igimp_assembly::Geometry;
use igimp_model::Stage;

use crate::run::model::{Model, displacement_scale};
use crate::run::state::State;

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
