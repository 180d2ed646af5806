//! The start of a run: on the grid of its case, or on all meshes of its study.

use igimp_model::Case;

use crate::CaseError;
use crate::run::engine::one_mesh;
use crate::run::{AtomicBool, Entered, Event, Listener, Run, Start, Target, study};

/// Runs a case. With a target everything is written as it is computed.
///
/// A case with a [`mesh_study`](Case::mesh_study) of several meshes is run on each of them, and the
/// [`Summary`](igimp_results::summary::Summary) has their results together; the rest of the [`Run`] is that of the finest mesh that
/// came to its end.
///
/// Want of equilibrium is a result ([`Run::failure`]), and so is an interruption: when `interrupt`
/// becomes true the run ends after its step, with everything saved. Nobody else writes into the results
/// folder meanwhile, and its files are replaced as far as [`Target::replace`] allows.
///
/// # Errors
/// [`CaseError`] for a case that cannot be set up, and for files that cannot be written or read.
pub fn run<const D: usize>(
    case: &Case<D>,
    target: Option<&Target>,
    start: Start,
    listener: &mut dyn Listener<D>,
    interrupt: &AtomicBool,
) -> Result<Run<D>, CaseError> {
    let _entered = target
        .map(|target| Entered::new(case, target, start))
        .transpose()?;
    run_entered(case, target, start, listener, interrupt)
}

/// Runs a case whose results folder was entered.
pub(crate) fn run_entered<const D: usize>(
    case: &Case<D>,
    target: Option<&Target>,
    start: Start,
    listener: &mut dyn Listener<D>,
    interrupt: &AtomicBool,
) -> Result<Run<D>, CaseError> {
    if case.mesh_study.meshes > 1 {
        return study::run(case, target, start, listener, interrupt);
    }
    one_mesh(case, target, start, listener, interrupt)
}

/// Runs a case from its beginning and keeps its results in memory.
///
/// # Errors
/// [`CaseError`] for a case that cannot be set up.
pub fn in_memory<const D: usize>(case: &Case<D>) -> Result<Run<D>, CaseError> {
    let never = AtomicBool::new(false);
    run(
        case,
        None,
        Start::Afresh,
        &mut |_: &Event<'_, D>| {},
        &never,
    )
}
