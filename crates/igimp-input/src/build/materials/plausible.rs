//! Warnings about values of a material that do not go together: a strength that no strain reaches, a K₀ beyond it.
//! Ranges of single values are a table of `igimp-schema`.

use igimp_model::Strength;
use igimp_schema::diagnostic::Problems;
use igimp_schema::source::Place;
use igimp_schema::text::{clip, number};
use igimp_schema::tree::read::At;

use super::profiles::Property;

/// Young's modulus of soil over its undrained strength or its cohesion, at least \[-\].
const LEAST_STIFFNESS: f64 = 10.0;

/// Warns of soil that would have to be strained by tenths before it yields: by the greatest values where they vary.
pub(super) fn check_stiffness(
    name: &str,
    (young, place): (&Property, Option<Place>),
    (key, strength): (&str, &Property),
    problems: &mut Problems,
) {
    let (stiff, strong) = (young.constant, strength.constant);
    let Some(place) = place.filter(|_| stiff < LEAST_STIFFNESS * strong) else {
        return;
    };
    let stated = |prop: &Property| {
        let to = if prop.profile.is_some() { "up to" } else { "=" };
        format!("{to} {} kPa", number(prop.constant / 1e3))
    };
    let message = format!(
        "`{}` has young {}, {} times its {key} {}: it hardly yields",
        clip(name, 40),
        stated(young),
        number(stiff / strong),
        stated(strength)
    );
    problems
        .warning(place, message)
        .help("soil has 50 to 1000 times its strength; the unit of young may be meant to be MPa");
}

/// Warns of a K₀ at which soil is beyond its strength under half of the weight \[Pa\] at the bottom of its bodies, so that water below
/// a table is no matter. Strength that varies is not looked at.
pub(super) fn check_k0(
    name: &str,
    k0: &At<f64>,
    (strength, weight): (Strength, f64),
    problems: &mut Problems,
) {
    let (cohesion, friction_angle) = match strength {
        Strength::MohrCoulomb {
            cohesion,
            friction_angle,
            ..
        } => (cohesion, friction_angle),
        Strength::Tresca { undrained_strength } => (undrained_strength, 0.0),
        _ => return,
    };
    let upright = 0.5 * weight;
    let level = **k0 * upright;
    let (sin, cos) = friction_angle.sin_cos();
    let resistance = cohesion * cos + 0.5 * (upright + level) * sin;
    if 0.5 * (level - upright).abs() <= 1.001 * resistance {
        return;
    }
    let ends = [(1.0 - sin) / (1.0 + sin), (1.0 + sin) / (1.0 - sin)];
    let help = if friction_angle > 0.0 {
        format!(
            "soil without cohesion has {} to {}; k0 = \"jaky\" is {}",
            number(ends[0]),
            number(ends[1]),
            number(1.0 - sin)
        )
    } else {
        "undrained clay has stresses that differ by twice its cu at most: k0 closer to 1".to_owned()
    };
    let message = format!(
        "`{}` with k0 = {} is beyond its strength: {} kPa upright and {} kPa level in its lower half",
        clip(name, 40),
        number(**k0),
        number(upright / 1e3),
        number(level / 1e3)
    );
    problems.warning(k0.place, message).help(help);
}
