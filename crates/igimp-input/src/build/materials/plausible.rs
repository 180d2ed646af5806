//! Warnings about constant values outside the range of soil, rock and structures: mostly a slip of the unit, of a thousand
//! or of rad for deg. Values that vary in space are not looked at.

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

const PLAUSIBLE: [Plausible; 5] = [
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
];

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
}
