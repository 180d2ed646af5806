//! What materials ask of the grid, the stages and the solver.

use igimp_linear::SolverKind;
use igimp_model::{BodyPart, Case, Material, Profile, Softens, Stage, StageKind};
use igimp_schema::diagnostic::Problems;
use igimp_schema::text::{clip, number};

use super::profiles::Extent;

/// Parts between the least and the greatest friction at whose ends a law is looked at.
const PARTS: u32 = 16;

/// Why a material has no law on cells of a height \[m\], as the end of a sentence; where friction varies it has to have one from the
/// least of it to the greatest: stress snaps back first where φ is near 20°.
pub(crate) fn possible(material: &Material, cell: f64) -> Result<(), String> {
    let law = (material.law_on(cell)).map_err(|error| format!(": {error}"))?;
    let (Some(least), Some(greatest)) = (
        material.profiles.friction.as_ref().and_then(Profile::least),
        (material.strength.friction_angle()).filter(|own| *own > 0.0),
    ) else {
        return Ok(());
    };
    for part in 0..PARTS {
        let share = f64::from(part) / f64::from(PARTS);
        let friction = least + share * (greatest.tan() - least);
        // A law that is made anew, as one that is reduced is, looks at its curves.
        (law.at_friction(friction / greatest.tan()))
            .and_then(|law| law.map(|law| law.reduced(1.0)).transpose())
            .map_err(|error| {
                let degrees = number(friction.atan().to_degrees());
                format!(" where its friction is {degrees} deg: {error}")
            })?;
    }
    Ok(())
}

/// The least of the stiffness of soil over its strength, beside that of its material \[-\]: there a curve over plastic strain is
/// nearest to snap-back. 1 where neither varies, and of soil that is in no body.
fn least_stiffness_over_strength<const D: usize>(case: &Case<D>, index: usize) -> f64 {
    let material = &case.materials[index];
    let ground = case.ground();
    let bodies: Vec<Option<BodyPart<D>>> = case.bodies.iter().cloned().map(Some).collect();
    let extent = Extent {
        name: &material.name,
        material: index,
        bodies: &bodies,
        ground: &ground,
    };
    let over = |place: &[f64; D]| {
        let ratios = material.ratios_at(place, &ground);
        ratios.stiffness / ratios.strength
    };
    (extent.places().iter().map(over)).fold(1.0, f64::min)
}

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
    let least = least_stiffness_over_strength(case, index);
    if least >= 1.0 {
        return;
    }
    for curve in [
        &mut curves.cohesive,
        &mut curves.friction,
        &mut curves.dilation,
    ] {
        // To the law strains are those of the soil times this.
        *curve = curve.map(|own| Softens {
            strain: own.strain * least,
            ..own
        });
    }
    let asked = Material {
        softening: Some(curves),
        ..material.clone()
    };
    if possible(&asked, cell).is_err() {
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

/// Refuses strength that softens so fast, on the cells of a case, that stress snaps back.
pub(crate) fn check_on_cells<const D: usize>(case: &Case<D>, problems: &mut Problems) {
    let cell = case.grid.smallest_cell()[D - 1];
    for (index, material) in case.materials.iter().enumerate() {
        check_where_soft(case, (index, cell), problems);
        let Some(curves) = material.softening.filter(|own| own.band_width.is_some()) else {
            continue;
        };
        if let Err(why) = possible(material, cell) {
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
        let Some(own) = material.softening.and_then(|own| own.nonlocal) else {
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
        } else if cell > 0.5 * own.length * (1.0 + 1e-9) {
            let message = format!(
                "cells of {} m do not resolve the bands of `{name}`, whose softening has a length of {} m",
                number(cell),
                number(own.length)
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
    for material in case.materials.iter().filter(|own| own.goes_with_rate()) {
        let message = format!(
            "the strength of `{}` goes with the rate of strain, and no stage takes time",
            clip(&material.name, 40)
        );
        problems.error(None, message).help(
            "give the stage that shears it consolidation = { duration = \"100 s\" }, make it a dynamic one, or remove `rate`",
        );
    }
}
