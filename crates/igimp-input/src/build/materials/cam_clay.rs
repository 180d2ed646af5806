//! Modified Cam-clay: its parameters from what a file states.

use igimp_material::{CamClayParameters, ShearStiffness};
use igimp_model::{Strength, critical_ratio_of};
use igimp_schema::schema::materials::CamClay;
use igimp_schema::source::Place;

use super::parameters::{ANGLE, Limit, NUMBER, NUMBER_OR_NONE, OCR, Parameters, STRESS, Stated};
use super::profiles::Terms;

/// M of a friction angle of 90° is 3, in triaxial compression: along q = M p the stress at the sides is zero.
const CRITICAL_RATIO: Limit = (
    |value| value < 3.0,
    "`critical_ratio` must be below 3",
    "M = 6 sin(friction)/(3 - sin(friction)), which no angle makes 3: clay has 0.7 to 1.4",
);
const FRICTION: Limit = (
    |angle| angle.to_degrees() < 89.0,
    "the friction angle must be below 90 deg",
    "clay has 18 deg to 35 deg",
);
const POISSON: Limit = (
    |value| value < 0.5,
    "Poisson's ratio of the skeleton must be below 0.5",
    "clay has 0.2 to 0.35; drainage = \"undrained\" keeps the volume",
);

/// The law of a table, with slopes of natural volumetric strain.
pub(super) fn strength<const D: usize>(
    clay: &CamClay,
    read: &mut Parameters<'_, '_, D>,
) -> Option<Strength> {
    let volume = 1.0 + clay.void_ratio.as_ref().map_or(0.0, |ratio| **ratio);
    let compression = read.read("lambda", &clay.lambda, NUMBER, None);
    let swelling = read.read("kappa", &clay.kappa, NUMBER, None);
    for key in ["lambda", "kappa"] {
        read.scale(key, |value| value / volume);
    }
    if let (Some(lambda), Some(kappa)) = (compression, swelling)
        && kappa.most >= lambda.most
    {
        read.problems
            .error(kappa.place, "`kappa` has to be smaller than `lambda`")
            .help("clay swells by a fifth to a tenth of what it was compressed by");
        return None;
    }
    let ocr = read.read("ocr", &clay.ocr, NUMBER, Some(OCR));
    let help = "add friction = \"25 deg\", the angle at the critical state";
    let critical = [
        ("friction", &clay.friction, ANGLE, Some(FRICTION)),
        (
            "critical_ratio",
            &clay.critical_ratio,
            NUMBER,
            Some(CRITICAL_RATIO),
        ),
    ];
    let critical_ratio = match one_of(critical, (clay.lambda.place, help), read)? {
        ("friction", angle) => critical_ratio_of(angle),
        (_, ratio) => ratio,
    };
    let help = "add poisson = 0.25: shear stiffness grows with pressure, as the bulk modulus does";
    let shear = [
        ("poisson", &clay.poisson, NUMBER_OR_NONE, Some(POISSON)),
        ("shear", &clay.shear, STRESS, None),
    ];
    let shear = match one_of(shear, (clay.kappa.place, help), read)? {
        ("poisson", ratio) => ShearStiffness::Poisson(ratio),
        (_, modulus) => ShearStiffness::Constant(modulus),
    };
    Some(Strength::ModifiedCamClay(CamClayParameters {
        compression: compression?.most / volume,
        swelling: swelling?.most / volume,
        critical_ratio,
        shear,
        overconsolidation: ocr?.most,
        reference_pressure: *clay.reference_pressure,
    }))
}

/// The one of two keys that is stated, and its value.
fn one_of<const D: usize>(
    keys: [(&'static str, &Option<Stated>, Terms, Option<Limit>); 2],
    (place, help): (Place, &str),
    read: &mut Parameters<'_, '_, D>,
) -> Option<(&'static str, f64)> {
    let [(one, first, ..), (other, second, ..)] = keys;
    if let (Some(_), Some(second)) = (first, second) {
        let message = format!("both `{one}` and `{other}` are given");
        read.problems
            .error(second.place, message)
            .help("keep one of them");
        return None;
    }
    for (key, stated, terms, limit) in keys {
        if let Some(stated) = stated {
            return Some((key, read.read(key, stated, terms, limit)?.most));
        }
    }
    let message = format!("neither `{one}` nor `{other}` is given");
    read.problems.error(place, message).help(help);
    None
}
