//! Numbers for the parts of the yield surface, the same in every file and every version.

use igimp_material::Regime;

/// Every regime at the place of its code.
const BY_CODE: [Regime; 10] = [
    Regime::Elastic,
    Regime::Smooth,
    Regime::RightEdge,
    Regime::LeftEdge,
    Regime::Apex,
    Regime::Tension,
    Regime::TensionShear,
    Regime::TensionEdge,
    Regime::TensionCorner,
    Regime::TensionApex,
];

/// The number of a regime: 0 elastic, 1 smooth part, 2 right edge, 3 left edge, 4 apex,
/// 5 tension plane, 6 tension–shear edge, 7 tension edge, 8 tension corner, 9 tension apex.
pub fn code(regime: Regime) -> u8 {
    match regime {
        Regime::Elastic => 0,
        Regime::Smooth => 1,
        Regime::RightEdge => 2,
        Regime::LeftEdge => 3,
        Regime::Apex => 4,
        Regime::Tension => 5,
        Regime::TensionShear => 6,
        Regime::TensionEdge => 7,
        Regime::TensionCorner => 8,
        Regime::TensionApex => 9,
    }
}

/// The regime of a number, if there is one.
pub fn from_code(code: u8) -> Option<Regime> {
    BY_CODE.get(usize::from(code)).copied()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_and_regimes_match() {
        for number in 0..=u8::MAX {
            let regime = from_code(number);
            assert_eq!(regime.map(code), (number < 10).then_some(number));
        }
    }
}
