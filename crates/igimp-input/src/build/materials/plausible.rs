//! Warnings about constant values outside the range of soil, rock and structures: mostly a slip of the unit, of a thousand
//! or of rad for deg. Values that vary in space are not looked at.

use igimp_model::Strength;
use igimp_schema::diagnostic::Problems;
use igimp_schema::text::{clip, number};
use igimp_schema::tree::read::At;

/// A key with the values that soil, rock and structures have.
struct Plausible {
    key: &'static str,
    /// Smallest and largest, in SI units.
    between: [f64; 2],
    /// What SI values are divided by in print, and the unit after that.
    unit: (f64, &'static str),
    help: &'static str,
}

const PLAUSIBLE: [Plausible; 6] = [
    Plausible {
        key: "unit_weight",
        between: [0.2e3, 200e3],
        unit: (1e3, "kN/m3"),
        help: "soil has 14 to 24 kN/m3; the unit may be meant to be kN/m3",
    },
    Plausible {
        key: "young",
        between: [1e3, 500e9],
        unit: (1e6, "MPa"),
        help: "soil has 1 to 500 MPa, rock up to 100 GPa, steel 210 GPa",
    },
    Plausible {
        key: "cohesion",
        between: [1.0, 5e6],
        unit: (1e3, "kPa"),
        help: "soil has 0 to 100 kPa; the unit may be meant to be kPa",
    },
    Plausible {
        key: "cu",
        between: [1.0, 5e6],
        unit: (1e3, "kPa"),
        help: "clay has 5 to 500 kPa; the unit may be meant to be kPa",
    },
    Plausible {
        key: "friction",
        between: [1.0_f64.to_radians(), 70.0_f64.to_radians()],
        unit: (1.0_f64.to_radians(), "deg"),
        help: "soil has 15 to 45 deg; 0.35 rad are 20 deg",
    },
    Plausible {
        key: "permeability",
        between: [1e-16, 0.1],
        unit: (1.0, "m/s"),
        help: "clay has 1e-11 to 1e-8 m/s, sand 1e-6 to 1e-3, gravel up to 0.1",
    },
];

/// Young's modulus of soil over its undrained strength or its cohesion, at least \[-\].
const LEAST_STIFFNESS: f64 = 10.0;

/// Checks the constants of a material, with their keys; zero is plausible for all of them.
pub(super) fn check(name: &str, constants: &[(&str, At<f64>)], problems: &mut Problems) {
    for plausible in &PLAUSIBLE {
        let stated = constants.iter().find(|(key, _)| *key == plausible.key);
        let Some((_, own)) = stated.filter(|(_, own)| **own > 0.0) else {
            continue;
        };
        let ([least, most], value) = (plausible.between, **own);
        if value < least || value > most {
            let (scale, unit) = plausible.unit;
            problems
                .warning(
                    own.place,
                    format!(
                        "`{}` has {} = {} {unit}, outside the range of soil, rock and structures",
                        clip(name, 40),
                        plausible.key,
                        number(value / scale)
                    ),
                )
                .help(plausible.help);
        }
    }
    check_stiffness(name, constants, problems);
}

/// Warns of soil that would have to be strained by tenths before it yields.
fn check_stiffness(name: &str, constants: &[(&str, At<f64>)], problems: &mut Problems) {
    let of = |key: &str| constants.iter().find(|(own, _)| *own == key);
    let strength = of("cu").or_else(|| of("cohesion"));
    let (Some((_, young)), Some((key, strength))) = (of("young"), strength) else {
        return;
    };
    if **young >= LEAST_STIFFNESS * **strength {
        return;
    }
    let message = format!(
        "`{}` has young = {} kPa, {} times its {key} = {} kPa: it hardly yields",
        clip(name, 40),
        number(**young / 1e3),
        number(**young / **strength),
        number(**strength / 1e3)
    );
    problems
        .warning(young.place, message)
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
