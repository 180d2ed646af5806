//! The study of the mesh error.

use igimp_model::{Case, StageKind, meshes};
use igimp_schema::diagnostic::Problems;
use igimp_schema::schema::Root;
use igimp_schema::schema::outputs::CheckedValue;
use igimp_schema::text::{clip, count};
use igimp_schema::tree::Node;
use igimp_schema::tree::read::At;

use crate::build::grid::MOST;

/// Checks the refined grid, and whether a study can be made and has something to study.
pub(crate) fn check<const D: usize>(
    tree: &Node,
    meshes: &At<usize>,
    case: &Case<D>,
    problems: &mut Problems,
) {
    let place = meshes.place;
    if case.mesh_study.meshes < 2 {
        // A grid that is too large as it is was reported before.
        let grid = Root::<D>::grid(tree).ok();
        if let Some(Ok(refine)) = grid.map(|grid| grid.value.refine)
            && *refine > 1
            && is_too_large(case, 1)
        {
            problems
                .error(
                    refine.place,
                    "the refined grid would have too many cells or particles",
                )
                .help(format!("at most {} are possible", count(MOST)));
        }
        one_mesh_only::<D>(tree, problems);
        return;
    }
    let finest = meshes::refinements(case).pop().unwrap_or(1);
    if is_too_large(case, finest) {
        problems
            .error(
                place,
                format!(
                    "the finest mesh, {}, would have too many cells or particles",
                    meshes::label(finest)
                ),
            )
            .help(format!(
                "at most {} are possible: fewer meshes, or larger cells",
                count(MOST)
            ));
    }
    for difference in meshes::differences(case) {
        problems.warning(place, difference).help(
            "let the edge lie on a line of the grid or in the middle of a cell, and boxes end on lines",
        );
    }
    let has_result = !case.checks.is_empty()
        || case.stages.iter().any(|stage| {
            stage.stop_when.no_equilibrium
                || matches!(
                    stage.kind,
                    StageKind::StrengthReduction(_) | StageKind::Displacement { .. }
                )
        });
    if !has_result {
        problems
            .warning(place, "the mesh study has nothing to compare")
            .help("add a check, a strength reduction or a stage with stop_when = { no_equilibrium = true }");
    }
}

/// Warns of checks that need more than one mesh.
fn one_mesh_only<const D: usize>(tree: &Node, problems: &mut Problems) {
    let checks = Root::<D>::checks(tree).map_or_else(|_| Vec::new(), |checks| checks.value);
    for check in checks.into_iter().flatten() {
        if *check.value.value == CheckedValue::Extrapolated {
            problems
                .warning(
                    check.value.value.place,
                    format!(
                        "check `{}` asks for an extrapolated value, and there is one mesh: the value \
                         of this mesh is held against it",
                        clip(&check.name, 40)
                    ),
                )
                .help("write mesh_study = { meshes = 2 }, or run with --meshes 2");
        }
    }
}

/// Whether a mesh has more cells or particles than are possible.
fn is_too_large<const D: usize>(case: &Case<D>, parts: usize) -> bool {
    let finer = (parts * parts) as f64;
    let cells: f64 = case
        .grid
        .cells()
        .iter()
        .map(|&cells| cells as f64)
        .product();
    let domain: f64 = std::iter::zip(case.grid.upper(), case.grid.lower())
        .map(|(upper, lower)| upper - lower)
        .product();
    let particles: f64 = case
        .bodies
        .iter()
        .map(|body| {
            let share = body.region.volume() / domain;
            share * cells * body.per_direction.pow(D as u32) as f64
        })
        .sum();
    finer * cells.max(particles) > MOST
}
