//! Hardening Soil: its parameters from what a file states.

use igimp_material::{HardeningSoil, HardeningSoilParameters};
use igimp_model::{Strength, jaky};
use igimp_schema::schema::materials::HardeningSoil as Keys;
use igimp_schema::text::number;

use super::parameters::{
    ANGLE, ANGLE_OR_NONE, Limit, NUMBER, NUMBER_OR_NONE, OCR, Parameters, STRESS, STRESS_OR_NONE,
};

const FRICTION: Limit = (
    |angle| (1.0..80.0).contains(&angle.to_degrees()),
    "the friction angle must be 1 deg to 80 deg",
    "sands have 28 deg to 45 deg",
);
const POISSON: Limit = (
    |value| value < 0.5,
    "Poisson's ratio of unloading must be below 0.5",
    "0.2 is usual; drainage = \"undrained\" keeps the volume",
);
const POWER: Limit = (
    |value| value <= 1.0,
    "`power` must be at most 1",
    "sand has about 0.5, soft clay 1",
);
const FAILURE_RATIO: Limit = (
    |value| value < 1.0,
    "`failure_ratio` must be below 1",
    "0.9 is usual",
);
const K0_NORMAL: Limit = (
    |value| value < 1.0,
    "`k0_normal` must be below 1",
    "1 - sin(friction) is usual",
);

/// The law of a table.
pub(super) fn strength<const D: usize>(
    soil: &Keys,
    read: &mut Parameters<'_, '_, D>,
) -> Option<Strength> {
    let before = read.problems.errors();
    let cohesion = read.read("cohesion", &soil.cohesion, STRESS_OR_NONE, None);
    let friction = read.read("friction", &soil.friction, ANGLE, Some(FRICTION));
    let dilation = read.read("dilation", &soil.dilation, ANGLE_OR_NONE, None);
    let secant = read.read("e50", &soil.e50, STRESS, None);
    let mut modulus = |key, stated: &Option<_>, times: f64| {
        if let Some(stated) = stated {
            return read.read(key, stated, STRESS, None);
        }
        read.follow(key, "e50", |value| times * value);
        secant.map(|e50| e50.times(times))
    };
    let unloading = modulus("eur", &soil.eur, 3.0);
    let oedometer = modulus("eoed", &soil.eoed, 1.0);
    let poisson = read.read("poisson", &soil.poisson, NUMBER_OR_NONE, Some(POISSON));
    let power = read.read("power", &soil.power, NUMBER_OR_NONE, Some(POWER));
    let failure_ratio = &soil.failure_ratio;
    let failure_ratio = read.read("failure_ratio", failure_ratio, NUMBER, Some(FAILURE_RATIO));
    let ocr = read.read("ocr", &soil.ocr, NUMBER, Some(OCR));
    let k0_normal = match &soil.k0_normal {
        Some(at) => read.read("k0_normal", at, NUMBER, Some(K0_NORMAL))?.most,
        None => jaky(friction?.most),
    };
    let parameters = HardeningSoilParameters {
        cohesion: cohesion?.most,
        friction_angle: friction?.most,
        dilation_angle: dilation?.most,
        secant: secant?.most,
        unloading: unloading?.most,
        oedometer: oedometer?.most,
        poisson: poisson?.most,
        power: power?.most,
        reference_pressure: *soil.reference_pressure,
        failure_ratio: failure_ratio?.most,
        k0_normal,
        overconsolidation: ocr?.most,
    };
    is_possible(soil, &parameters, (before, read)).map(|()| Strength::HardeningSoil(parameters))
}

/// Refuses values that go with no others of this soil.
fn is_possible<const D: usize>(
    soil: &Keys,
    parameters: &HardeningSoilParameters,
    (before, read): (usize, &mut Parameters<'_, '_, D>),
) -> Option<()> {
    if parameters.dilation_angle > parameters.friction_angle.min(30_f64.to_radians()) {
        read.problems
            .error(
                soil.dilation.place,
                "the dilation angle is no larger than the friction angle and than 30 deg",
            )
            .help("dense sand has about friction - 30 deg, loose sand and clay 0 deg");
    }
    if parameters.unloading <= 2.0 * parameters.secant / (2.0 - parameters.failure_ratio) {
        read.problems
            .error(
                soil.eur.as_ref().unwrap_or(&soil.e50).place,
                "`eur` has to be larger than 2 e50/(2 - failure_ratio), the initial stiffness of the hyperbola",
            )
            .help("soils have three to five times e50");
    }
    if read.problems.errors() > before {
        return None;
    }
    if HardeningSoil::new(*parameters).is_err() {
        let stated = soil.eoed.as_ref().or(soil.k0_normal.as_ref());
        let message = format!(
            "no cap gives an oedometer modulus of {} MPa at a ratio of stresses of {} beside `e50` = {} MPa",
            number(1e-6 * parameters.oedometer),
            number(parameters.k0_normal),
            number(1e-6 * parameters.secant)
        );
        read.problems
            .error(stated.unwrap_or(&soil.e50).place, message)
            .help("eoed is about e50 in sand and half of it in clay; k0_normal about 1 - sin(friction)");
        return None;
    }
    Some(())
}
