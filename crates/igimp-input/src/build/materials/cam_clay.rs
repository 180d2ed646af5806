//! Modified Cam-clay: its parameters from what a file states.

use igimp_material::{CamClayParameters, ConstitutiveModel, ModifiedCamClay, ShearStiffness};
use igimp_model::Strength;
use igimp_schema::diagnostic::Problems;
use igimp_schema::schema::materials::CamClay;
use igimp_schema::text::number;
use igimp_schema::tree::read::At;

/// M of a friction angle of 90°, in triaxial compression \[-\]: along q = M p the stress at the sides is zero.
const STEEPEST: f64 = 3.0;

/// The law of a table, with slopes of natural volumetric strain.
pub(super) fn strength(own: &CamClay, problems: &mut Problems) -> Option<Strength> {
    let volume = 1.0 + own.void_ratio.as_ref().map_or(0.0, |own| **own);
    if *own.kappa >= *own.lambda {
        problems
            .error(own.kappa.place, "`kappa` has to be smaller than `lambda`")
            .help("clay swells by a fifth to a tenth of what it was compressed by");
        return None;
    }
    if *own.ocr < 1.0 {
        problems
            .error(own.ocr.place, "`ocr` is 1 or more")
            .help("normally consolidated clay has ocr = 1.0");
        return None;
    }
    Some(Strength::ModifiedCamClay(CamClayParameters {
        compression: *own.lambda / volume,
        swelling: *own.kappa / volume,
        critical_ratio: critical_ratio(own, problems)?,
        shear: shear(own, problems)?,
        overconsolidation: *own.ocr,
        reference_pressure: *own.reference_pressure,
    }))
}

/// Young's modulus and Poisson's ratio at the reference pressure.
pub(super) fn stiffness(own: CamClayParameters) -> Option<[f64; 2]> {
    let law = ModifiedCamClay::new(own).ok()?;
    let bound = law.stiffness_bound();
    Some([bound.young(), bound.poisson()])
}

/// M, as it is or from the friction angle at the critical state.
fn critical_ratio(own: &CamClay, problems: &mut Problems) -> Option<f64> {
    match (&own.friction, &own.critical_ratio) {
        (None, Some(ratio)) if **ratio < STEEPEST => Some(**ratio),
        (None, Some(ratio)) => {
            let message = format!(
                "`critical_ratio` is below 3, and here it is {}: no friction angle has more in triaxial compression",
                number(**ratio)
            );
            problems
                .error(ratio.place, message)
                .help("M = 6 sin(friction)/(3 - sin(friction)): clay has 0.7 to 1.4");
            None
        }
        (Some(friction), None) if friction.to_degrees() < 89.0 => {
            Some(6.0 * friction.sin() / (3.0 - friction.sin()))
        }
        (Some(friction), None) => {
            problems
                .error(friction.place, "the friction angle must be below 90 deg")
                .help("clay has 18 deg to 35 deg");
            None
        }
        (Some(_), Some(second)) => {
            both(second, "friction", "critical_ratio", problems);
            None
        }
        (None, None) => {
            problems
                .error(
                    own.lambda.place,
                    "neither `friction` nor `critical_ratio` is given",
                )
                .help("add friction = \"25 deg\", the angle at the critical state");
            None
        }
    }
}

/// The shear modulus, a share of the pressure or a constant.
fn shear(own: &CamClay, problems: &mut Problems) -> Option<ShearStiffness> {
    match (&own.poisson, &own.shear) {
        (Some(poisson), None) if **poisson < 0.5 => Some(ShearStiffness::Poisson(**poisson)),
        (Some(poisson), None) => {
            let message = format!(
                "Poisson's ratio of the skeleton must be below 0.5, but is {}",
                number(**poisson)
            );
            problems
                .error(poisson.place, message)
                .help("clay has 0.2 to 0.35; drainage = \"undrained\" keeps the volume");
            None
        }
        (None, Some(shear)) => Some(ShearStiffness::Constant(**shear)),
        (Some(_), Some(second)) => {
            both(second, "poisson", "shear", problems);
            None
        }
        (None, None) => {
            problems
                .error(own.kappa.place, "neither `poisson` nor `shear` is given")
                .help("add poisson = 0.25: shear stiffness grows with pressure, as the bulk modulus does");
            None
        }
    }
}

fn both<T>(second: &At<T>, one: &str, other: &str, problems: &mut Problems) {
    problems
        .error(
            second.place,
            format!("both `{one}` and `{other}` are given"),
        )
        .help("keep one of them");
}
