//! Strength that goes with plastic strain, direction and rate: its curves from what a file states.

use igimp_material::{Decay, Directions, RateEffect};
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
    (strength, friction_varies): (Option<Strength>, bool),
    problems: &mut Problems,
) -> Result<Option<StrengthCurves>, Wrong> {
    match model {
        Model::VonMises(Ok(own)) => undrained(&own.strength, problems),
        Model::Tresca(Ok(own)) => undrained(&own.strength, problems),
        Model::MohrCoulomb(Ok(own)) => {
            let stated = own.softening.as_ref().map_err(|_| Wrong)?;
            match stated {
                Some(own) => frictional(name, own, (strength, friction_varies), problems).map(Some),
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
    Ok(StrengthCurves {
        cohesive: Some(of_strength(&own.cu)),
        band_width: own.band_width.as_ref().map(|own| **own),
        ..StrengthCurves::default()
    })
}

fn frictional(
    name: &str,
    own: &At<FrictionalSoftening>,
    (strength, friction_varies): (Option<Strength>, bool),
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
    if let (Some(friction), true) = (&own.friction, friction_varies) {
        problems
            .error(
                friction.place,
                "friction that softens has to be one angle, and friction varies here",
            )
            .help("friction = \"25 deg\", or soften cohesion and dilation alone");
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
    Ok(StrengthCurves {
        cohesive: own.cohesion.as_ref().map(of_strength),
        friction: own.friction.as_ref().map(of_angle),
        dilation: own.dilation.as_ref().map(of_angle),
        band_width: own.band_width.as_ref().map(|own| **own),
        ..StrengthCurves::default()
    })
}
