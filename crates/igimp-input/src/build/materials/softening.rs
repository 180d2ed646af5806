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
        Model::VonMises(Ok(own)) => undrained(&own.strength, problems),
        Model::Tresca(Ok(own)) => undrained(&own.strength, problems),
        Model::MohrCoulomb(Ok(own)) => {
            let stated = own.softening.as_ref().map_err(|_| Wrong)?;
            match stated {
                Some(own) => frictional(name, own, strength, problems).map(Some),
                None => Ok(None),
            }
        }
        _ => Ok(None),
    }
}

/// What an undrained strength goes with; none where it stays.
fn undrained(own: &Undrained, problems: &mut Problems) -> Result<Option<StrengthCurves>, Wrong> {
    let softening = own.softening.as_ref().map_err(|_| Wrong)?;
    let anisotropy = own.anisotropy.as_ref().map_err(|_| Wrong)?;
    let rate = own.rate.as_ref().map_err(|_| Wrong)?;
    if softening.is_none() && anisotropy.is_none() && rate.is_none() {
        return Ok(None);
    }
    let curves = match softening {
        Some(own) => of_undrained(own, problems)?,
        None => StrengthCurves::default(),
    };
    let directions = anisotropy.as_ref().map(|own| Directions {
        simple_shear: *own.simple_shear,
        passive: *own.passive,
    });
    if let (Some(own), Some(_)) = (rate, curves.nonlocal) {
        problems
            .error(
                own.place,
                "`rate` does not go with the `length` of `softening`",
            )
            .help("scale by the `band_width` in place of a `length`, or remove `rate`");
        return Err(Wrong);
    }
    let rate = rate.as_ref().map(|own| RateEffect {
        per_log_cycle: *own.per_log_cycle,
        reference: *own.reference,
    });
    Ok(Some(StrengthCurves {
        directions,
        rate,
        ..curves
    }))
}

/// Whether soil that is sheared far dilates no more.
pub(super) fn ends_dilation(model: &Model) -> bool {
    let Model::MohrCoulomb(Ok(own)) = model else {
        return false;
    };
    let stated = own.softening.as_ref().ok().and_then(Option::as_ref);
    let dilation = stated.and_then(|own| own.dilation.as_ref());
    dilation.is_some_and(|own| *own.residual == 0.0)
}

fn decay(own: keys::Decay) -> Decay {
    match own {
        keys::Decay::Linear => Decay::Linear,
        keys::Decay::Exponential => Decay::Exponential,
    }
}

fn of_strength(own: &At<StrengthCurve>) -> Softens {
    Softens {
        residual: *own.residual,
        strain: *own.strain,
        decay: decay(*own.curve),
    }
}

fn of_angle(own: &At<AngleCurve>) -> Softens {
    Softens {
        residual: *own.residual,
        strain: *own.strain,
        decay: decay(*own.curve),
    }
}

fn of_undrained(
    own: &At<UndrainedSoftening>,
    problems: &mut Problems,
) -> Result<StrengthCurves, Wrong> {
    if *own.cu.residual == 0.0 {
        problems
            .error(
                own.cu.residual.place,
                "soil by total stress has no strength left",
            )
            .help("remoulded clay keeps 1/sensitivity, like residual = 0.1");
        return Err(Wrong);
    }
    let softens = *own.cu.residual < 1.0;
    let lengths = [&own.band_width, &own.length, &own.over_nonlocal];
    Ok(StrengthCurves {
        cohesive: Some(of_strength(&own.cu)),
        band_width: own.band_width.as_ref().map(|own| **own),
        nonlocal: nonlocal(lengths, softens, problems)?,
        ..StrengthCurves::default()
    })
}

fn frictional(
    name: &str,
    own: &At<FrictionalSoftening>,
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
            .error(own.place, "flow = \"davis\" does not go with `softening`")
            .help(
                "leave `flow` out: strengths of Davis are of one dilation angle, which ends here",
            );
        return Err(Wrong);
    }
    if own.cohesion.is_none() && own.friction.is_none() && own.dilation.is_none() {
        problems
            .error(
                own.place,
                format!("nothing of `{}` softens", clip(name, 40)),
            )
            .help("cohesion = { residual = 0.2, strain = 0.1 }, `friction`, or `dilation`");
        return Err(Wrong);
    }
    for (key, angle) in [("friction", &own.friction), ("dilation", &own.dilation)] {
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
        && let Some(friction) = &own.friction
    {
        problems
            .error(
                friction.place,
                format!("`{}` has no friction that could go", clip(name, 40)),
            )
            .help("remove it, or give the soil `friction`");
        return Err(Wrong);
    }
    let cohesion_softens = (own.cohesion.as_ref()).is_none_or(|own| *own.residual <= 1.0);
    let friction_softens =
        (own.friction.as_ref()).is_none_or(|own| *own.residual <= friction_angle);
    let lengths = [&own.band_width, &own.length, &own.over_nonlocal];
    let nonlocal = nonlocal(lengths, cohesion_softens && friction_softens, problems)?;
    Ok(StrengthCurves {
        nonlocal,
        cohesive: own.cohesion.as_ref().map(of_strength),
        friction: own.friction.as_ref().map(of_angle),
        dilation: own.dilation.as_ref().map(of_angle),
        band_width: own.band_width.as_ref().map(|own| **own),
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
                over_nonlocal: share.as_ref().map_or(OVER_NONLOCAL, |own| **own),
            }));
        }
    };
    problems.error(place, message).help(help);
    Err(Wrong)
}
