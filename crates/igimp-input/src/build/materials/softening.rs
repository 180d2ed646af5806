//! Strength that goes with plastic strain, direction and rate: its curves from what a file states.

use igimp_material::{Decay, Directions, Nonlocal, RateEffect};
use igimp_model::{Flow, Softens, Strength, StrengthCurves};
use igimp_schema::diagnostic::Problems;
use igimp_schema::schema::materials::{
    self as keys, AngleCurve, FrictionalSoftening, Model, StrengthCurve, Undrained,
    UndrainedSoftening,
};
use igimp_schema::text::{clip, number};
use igimp_schema::tree::Wrong;
use igimp_schema::tree::read::At;

/// The curves of a material; none where its strength stays.
pub(super) fn curves(
    name: &str,
    model: &Model,
    strength: Option<Strength>,
    problems: &mut Problems,
) -> Result<Option<StrengthCurves>, Wrong> {
    match model {
        Model::VonMises(Ok(law)) => undrained(&law.strength, problems),
        Model::Tresca(Ok(law)) => undrained(&law.strength, problems),
        Model::MohrCoulomb(Ok(law)) => {
            let stated = law.softening.as_ref().map_err(|_| Wrong)?;
            match stated {
                Some(table) => frictional(name, table, strength, problems).map(Some),
                None => Ok(None),
            }
        }
        _ => Ok(None),
    }
}

/// The curves of an undrained strength; none where it stays.
fn undrained(law: &Undrained, problems: &mut Problems) -> Result<Option<StrengthCurves>, Wrong> {
    let softening = law.softening.as_ref().map_err(|_| Wrong)?;
    let anisotropy = law.anisotropy.as_ref().map_err(|_| Wrong)?;
    let rate = law.rate.as_ref().map_err(|_| Wrong)?;
    if softening.is_none() && anisotropy.is_none() && rate.is_none() {
        return Ok(None);
    }
    let curves = match softening {
        Some(table) => of_undrained(table, problems)?,
        None => StrengthCurves::default(),
    };
    let directions = anisotropy.as_ref().map(|table| Directions {
        simple_shear: *table.simple_shear,
        passive: *table.passive,
    });
    if let (Some(stated), Some(_)) = (rate, curves.nonlocal) {
        problems
            .error(
                stated.place,
                "`rate` does not go with the `length` of `softening`",
            )
            .help("scale by the `band_width` in place of a `length`, or remove `rate`");
        return Err(Wrong);
    }
    let rate = rate.as_ref().map(|rate| RateEffect {
        per_log_cycle: *rate.per_log_cycle,
        reference: *rate.reference,
    });
    Ok(Some(StrengthCurves {
        directions,
        rate,
        ..curves
    }))
}

/// Whether soil that is sheared far dilates no more.
pub(super) fn ends_dilation(model: &Model) -> bool {
    let Model::MohrCoulomb(Ok(law)) = model else {
        return false;
    };
    let stated = law.softening.as_ref().ok().and_then(Option::as_ref);
    let dilation = stated.and_then(|table| table.dilation.as_ref());
    dilation.is_some_and(|curve| *curve.residual == 0.0)
}

fn decay(curve: keys::Decay) -> Decay {
    match curve {
        keys::Decay::Linear => Decay::Linear,
        keys::Decay::Exponential => Decay::Exponential,
    }
}

fn of_strength(table: &At<StrengthCurve>) -> Softens {
    Softens {
        residual: *table.residual,
        strain: *table.strain,
        decay: decay(*table.curve),
    }
}

fn of_angle(table: &At<AngleCurve>) -> Softens {
    Softens {
        residual: *table.residual,
        strain: *table.strain,
        decay: decay(*table.curve),
    }
}

fn of_undrained(
    table: &At<UndrainedSoftening>,
    problems: &mut Problems,
) -> Result<StrengthCurves, Wrong> {
    if *table.cu.residual == 0.0 {
        problems
            .error(
                table.cu.residual.place,
                "soil by total stress has no strength left",
            )
            .help("remoulded clay keeps 1/sensitivity, like residual = 0.1");
        return Err(Wrong);
    }
    let softens = *table.cu.residual < 1.0;
    let lengths = [&table.band_width, &table.length, &table.over_nonlocal];
    Ok(StrengthCurves {
        cohesive: Some(of_strength(&table.cu)),
        band_width: table.band_width.as_ref().map(|width| **width),
        nonlocal: nonlocal(lengths, softens, problems)?,
        ..StrengthCurves::default()
    })
}

fn frictional(
    name: &str,
    table: &At<FrictionalSoftening>,
    strength: Option<Strength>,
    problems: &mut Problems,
) -> Result<StrengthCurves, Wrong> {
    let Some(Strength::MohrCoulomb {
        friction_angle,
        flow,
        ..
    }) = strength
    else {
        return Err(Wrong);
    };
    if flow == Flow::Davis {
        problems
            .error(table.place, "flow = \"davis\" does not go with `softening`")
            .help(
                "leave `flow` out: strengths of Davis are of one dilation angle, which ends here",
            );
        return Err(Wrong);
    }
    if table.cohesion.is_none() && table.friction.is_none() && table.dilation.is_none() {
        problems
            .error(
                table.place,
                format!("nothing of `{}` softens", clip(name, 40)),
            )
            .help("cohesion = { residual = 0.2, strain = 0.1 }, `friction`, or `dilation`");
        return Err(Wrong);
    }
    for (key, angle) in [("friction", &table.friction), ("dilation", &table.dilation)] {
        if let Some(angle) = angle
            && angle.residual.to_degrees() > 89.0
        {
            let message = format!(
                "a residual {key} angle of {} deg",
                number(angle.residual.to_degrees())
            );
            problems
                .error(angle.residual.place, message)
                .help("soils have 10 deg to 40 deg of friction, and no dilation in the end");
            return Err(Wrong);
        }
    }
    if friction_angle == 0.0
        && let Some(friction) = &table.friction
    {
        problems
            .error(
                friction.place,
                format!("`{}` has no friction that could go", clip(name, 40)),
            )
            .help("remove it, or give the soil `friction`");
        return Err(Wrong);
    }
    let cohesion_softens = (table.cohesion.as_ref()).is_none_or(|curve| *curve.residual <= 1.0);
    let friction_softens =
        (table.friction.as_ref()).is_none_or(|curve| *curve.residual <= friction_angle);
    let lengths = [&table.band_width, &table.length, &table.over_nonlocal];
    let nonlocal = nonlocal(lengths, cohesion_softens && friction_softens, problems)?;
    Ok(StrengthCurves {
        nonlocal,
        cohesive: table.cohesion.as_ref().map(of_strength),
        friction: table.friction.as_ref().map(of_angle),
        dilation: table.dilation.as_ref().map(of_angle),
        band_width: table.band_width.as_ref().map(|width| **width),
        ..StrengthCurves::default()
    })
}

/// Share of the nonlocal strain where a file states none \[-\].
const OVER_NONLOCAL: f64 = 2.0;

/// How strength that softens or not sees the ground around, by the keys `band_width`, `length` and `over_nonlocal`.
fn nonlocal(
    [width, length, share]: [&Option<At<f64>>; 3],
    softens: bool,
    problems: &mut Problems,
) -> Result<Option<Nonlocal>, Wrong> {
    let (place, message, help) = match (length, width, share) {
        (None, _, None) => return Ok(None),
        (None, _, Some(share)) => (
            share.place,
            "`over_nonlocal` is stated without a `length`".to_owned(),
            "length = \"0.2 m\", over which plastic strain is spread, or remove it",
        ),
        (Some(length), Some(_), _) => (
            length.place,
            "`length` and `band_width` do not go together".to_owned(),
            "keep `band_width` to scale strains to the cells, or `length` to give bands a width on fine cells",
        ),
        (Some(_), None, Some(share)) if **share <= 1.0 => (
            share.place,
            format!(
                "with over_nonlocal = {} slip gathers in one row of cells",
                number(**share)
            ),
            "more than 1: bands are 4.7 times the length wide with 2, and 3.1 times with 1.5",
        ),
        (Some(length), None, _) if !softens => (
            length.place,
            "strength that hardens needs no `length`".to_owned(),
            "remove it: bands of shear form where strength falls",
        ),
        (Some(length), None, share) => {
            return Ok(Some(Nonlocal {
                length: **length,
                over_nonlocal: share.as_ref().map_or(OVER_NONLOCAL, |share| **share),
            }));
        }
    };
    problems.error(place, message).help(help);
    Err(Wrong)
}
