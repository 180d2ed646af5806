//! Hardening Soil: its parameters from what a file states.

use igimp_material::{HardeningSoil, HardeningSoilParameters};
use igimp_model::Strength;
use igimp_schema::diagnostic::Problems;
use igimp_schema::schema::materials::HardeningSoil as Keys;
use igimp_schema::text::number;
use igimp_schema::tree::read::At;

/// The law of a table.
pub(super) fn strength(own: &Keys, problems: &mut Problems) -> Option<Strength> {
    let parameters = HardeningSoilParameters {
        cohesion: *own.cohesion,
        friction_angle: *own.friction,
        dilation_angle: *own.dilation,
        secant: *own.e50,
        unloading: own.eur.as_ref().map_or(3.0 * *own.e50, |own| **own),
        oedometer: own.eoed.as_ref().map_or(*own.e50, |own| **own),
        poisson: *own.poisson,
        power: *own.power,
        reference_pressure: *own.reference_pressure,
        failure_ratio: *own.failure_ratio,
        k0_normal: (own.k0_normal.as_ref()).map_or(1.0 - own.friction.sin(), |own| **own),
        overconsolidation: *own.ocr,
    };
    let wrong = out_of_range(own, &parameters);
    for (value, message, help) in &wrong {
        problems.error(value.place, message.clone()).help(*help);
    }
    if !wrong.is_empty() {
        return None;
    }
    if HardeningSoil::new(parameters).is_err() {
        let stated = own.eoed.as_ref().or(own.k0_normal.as_ref());
        let message = format!(
            "no cap gives an oedometer modulus of {} MPa at a ratio of stresses of {} beside `e50` = {} MPa",
            number(1e-6 * parameters.oedometer),
            number(parameters.k0_normal),
            number(1e-6 * parameters.secant)
        );
        problems
            .error(stated.unwrap_or(&own.e50).place, message)
            .help("eoed is about e50 in sand and half of it in clay; k0_normal about 1 - sin(friction)");
        return None;
    }
    Some(Strength::HardeningSoil(parameters))
}

/// The values that no soil has, with what to say.
fn out_of_range<'a>(
    own: &'a Keys,
    parameters: &HardeningSoilParameters,
) -> Vec<(&'a At<f64>, String, &'static str)> {
    let HardeningSoilParameters {
        secant,
        unloading,
        failure_ratio,
        ..
    } = *parameters;
    let mut wrong = Vec::new();
    let mut check = |holds: bool, value: &'a At<f64>, message: &str, help: &'static str| {
        if !holds {
            wrong.push((value, message.to_owned(), help));
        }
    };
    let degrees = own.friction.to_degrees();
    check(
        (1.0..80.0).contains(&degrees),
        &own.friction,
        "the friction angle is 1 deg to 80 deg",
        "sands have 28 deg to 45 deg",
    );
    check(
        *own.dilation <= own.friction.min(30_f64.to_radians()),
        &own.dilation,
        "the dilation angle is no larger than the friction angle and than 30 deg",
        "dense sand has about friction - 30 deg, loose sand and clay 0 deg",
    );
    check(
        *own.poisson < 0.5,
        &own.poisson,
        "Poisson's ratio of unloading must be below 0.5",
        "0.2 is usual; drainage = \"undrained\" keeps the volume",
    );
    check(
        *own.power <= 1.0,
        &own.power,
        "`power` is at most 1",
        "sand has about 0.5, soft clay 1",
    );
    check(
        *own.failure_ratio < 1.0,
        &own.failure_ratio,
        "`failure_ratio` is below 1",
        "0.9 is usual",
    );
    check(
        *own.ocr >= 1.0,
        &own.ocr,
        "`ocr` is 1 or more",
        "normally consolidated soil has ocr = 1.0",
    );
    if let Some(ratio) = &own.k0_normal {
        check(
            **ratio < 1.0,
            ratio,
            "`k0_normal` is below 1",
            "1 - sin(friction) is usual",
        );
    }
    check(
        *own.failure_ratio >= 1.0 || unloading > 2.0 * secant / (2.0 - failure_ratio),
        own.eur.as_ref().unwrap_or(&own.e50),
        "`eur` has to be larger than 2 e50/(2 - failure_ratio), the initial stiffness of the hyperbola",
        "soils have three to five times e50",
    );
    wrong
}
