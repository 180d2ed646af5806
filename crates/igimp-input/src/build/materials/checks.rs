//! Demands of materials on the grid, the stages and the solver.

use igimp_linear::SolverKind;
use igimp_model::{Case, Material, Softens, Stage, StageKind};
use igimp_schema::diagnostic::Problems;
use igimp_schema::text::{clip, number};

/// Refuses strength that varies and softens so fast that stress snaps back where soil is soft beside its strength.
fn check_where_soft<const D: usize>(
    case: &Case<D>,
    (index, cell): (usize, f64),
    problems: &mut Problems,
) {
    let material = &case.materials[index];
    let varies = material.profiles.strength.is_some() || material.profiles.young.is_some();
    let Some(mut curves) = material.softening.filter(|_| varies) else {
        return;
    };
    let least = case.least_stiffness_over_strength(index);
    if least >= 1.0 {
        return;
    }
    for curve in [
        &mut curves.cohesive,
        &mut curves.friction,
        &mut curves.dilation,
    ] {
        // To the law strains are those of the soil times this.
        *curve = curve.map(|softens| Softens {
            strain: softens.strain * least,
            ..softens
        });
    }
    let asked = Material {
        softening: Some(curves),
        ..material.clone()
    };
    if asked.possible(cell).is_err() {
        let message = format!(
            "the material `{}` is not possible: where its `young` over its strength is {} of what it is where both are greatest, strength falls faster than elastic stress does, and stress snaps back within the point",
            clip(&material.name, 40),
            number(least)
        );
        problems
            .error(None, message)
            .help("a larger `strain` of its softening, or layers with a material each");
    }
}

/// Refuses parameters that make no law at a place, and strength that softens so fast, on the cells of a case, that stress snaps back.
pub(crate) fn check_on_cells<const D: usize>(case: &Case<D>, problems: &mut Problems) {
    let cell = case.grid.smallest_cell()[D - 1];
    if problems.errors() == 0
        && let Err(error) = case.check_laws(cell)
    {
        problems
            .error(None, format!("{error}: {}", error.source))
            .help("other values there, or layers with a material each");
    }
    for (index, material) in case.materials.iter().enumerate() {
        check_where_soft(case, (index, cell), problems);
        let Some(curves) = material.softening.filter(|soft| soft.band_width.is_some()) else {
            continue;
        };
        if let Err(why) = material.possible(cell) {
            let message = format!(
                "the material `{}` is not possible on cells of {} m, where its strains are times {}{why}",
                clip(&material.name, 40),
                number(cell),
                number(curves.strain_ratio(cell))
            );
            problems
                .error(None, message)
                .help("smaller cells, or a larger `band_width` or `strain` of its softening");
        }
    }
}

/// Refuses strength that sees the ground around where that is not solved for, and warns of cells that do not resolve its bands.
pub(crate) fn check_lengths<const D: usize>(case: &Case<D>, problems: &mut Problems) {
    let cell = (0..D)
        .map(|axis| case.grid.smallest_cell()[axis])
        .fold(0.0, f64::max);
    for material in &case.materials {
        let Some(nonlocal) = material.softening.and_then(|soft| soft.nonlocal) else {
            continue;
        };
        let name = clip(&material.name, 40);
        let takes_time = |stage: &&Stage| {
            stage.consolidation.is_some() || matches!(stage.kind, StageKind::Dynamic(_))
        };
        let refused = if D == 3 {
            Some("in plane strain, and this case is in space".to_owned())
        } else if let Some(stage) = case.stages.iter().find(takes_time) {
            let stage = clip(&stage.name, 40);
            Some(format!(
                "in stages without time, and stage `{stage}` takes time"
            ))
        } else if case.solver.linear == SolverKind::Multigrid {
            Some("by direct solvers, and solver.linear is \"multigrid\"".to_owned())
        } else {
            None
        };
        if let Some(why) = refused {
            problems
                .error(
                    None,
                    format!("softening of `{name}` over a length is solved for {why}"),
                )
                .help("write `band_width` in place of `length`: strains are scaled to the cells");
        } else if cell > 0.5 * nonlocal.length * (1.0 + 1e-9) {
            let message = format!(
                "cells of {} m do not resolve the bands of `{name}`, whose softening has a length of {} m",
                number(cell),
                number(nonlocal.length)
            );
            problems
                .warning(None, message)
                .help("cells of half the length or less, or `band_width` in place of `length`");
        }
    }
}

/// Refuses strength that goes with the rate of strain where no stage takes time.
pub(crate) fn check_rates<const D: usize>(case: &Case<D>, problems: &mut Problems) {
    let takes_time = |stage: &Stage| {
        stage.consolidation.is_some() || matches!(stage.kind, StageKind::Dynamic(_))
    };
    if case.stages.iter().any(takes_time) {
        return;
    }
    for material in case.materials.iter().filter(|soil| soil.goes_with_rate()) {
        let message = format!(
            "the strength of `{}` goes with the rate of strain, and no stage takes time",
            clip(&material.name, 40)
        );
        problems.error(None, message).help(
            "give the stage that shears it consolidation = { duration = \"100 s\" }, make it a dynamic one, or remove `rate`",
        );
    }
}
