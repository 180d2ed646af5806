//! Quantities as text, such as `"25 kPa"`: a number or a fraction, and a unit.

mod measure;
pub(crate) mod units;

use std::fmt::{self, Display, Formatter};

use thiserror::Error;

use units::Unit;

pub use measure::Powers;
pub use units::Dimension;

/// A quantity in SI units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quantity {
    /// Value in the SI unit of its dimension.
    pub value: f64,
    /// Its dimension; none: a plain number.
    pub dimension: Option<Dimension>,
}

/// The fault in the text of a quantity.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum QuantityError {
    /// It does not begin with a number.
    #[error("`{text}` does not begin with a number")]
    NoNumber {
        /// The text.
        text: String,
    },
    /// There is no unit.
    #[error("`{text}` has no unit")]
    NoUnit {
        /// The text.
        text: String,
    },
    /// The unit is not known.
    #[error("unknown unit `{unit}`")]
    UnknownUnit {
        /// The unit as written.
        unit: String,
        /// The number before it.
        number: f64,
    },
    /// The unit measures something else.
    #[error("wrong kind of unit: expected {} such as {}", expected.name(), expected.usual_unit())]
    WrongKind {
        /// The expected dimension.
        expected: Dimension,
        /// The dimension of the unit.
        found: Dimension,
        /// Value in SI units of what was found.
        value: f64,
        /// The text.
        text: String,
        /// The unit as written.
        unit: String,
    },
    /// The number is infinite or not a number.
    #[error("`{text}` is not a finite number")]
    NotFinite {
        /// The text.
        text: String,
    },
}

impl QuantityError {
    /// The remedy, with an example.
    pub fn help(&self, expected: Option<Dimension>) -> String {
        let example = expected.unwrap_or(Dimension::Stress).example();
        match self {
            Self::NoNumber { text } if text.contains(',') => {
                format!("write a decimal point, and a unit, like \"{example}\"")
            }
            Self::NoNumber { .. } | Self::NoUnit { .. } => {
                format!("write a number, a space and a unit in quotes, like \"{example}\"")
            }
            Self::UnknownUnit { unit, .. } if unit.starts_with(',') => {
                format!("write a decimal point, not a comma, like \"{example}\"")
            }
            Self::UnknownUnit { unit, .. } => {
                let expected = expected.unwrap_or(Dimension::Stress);
                if let Some(near) = Unit::nearest(unit, expected) {
                    return format!("did you mean `{near}`?");
                }
                let units: Vec<_> = expected.units().collect();
                format!("units of {}: {}", expected.name(), units.join(", "))
            }
            Self::WrongKind {
                expected: Dimension::UnitWeight,
                found: Dimension::MassDensity,
                value,
                text,
                ..
            } => format!(
                "this is a mass density; multiply by 9.81 m/s2: {text} -> \"{} kN/m3\"",
                super::text::number(value * 9.81 / 1e3)
            ),
            Self::WrongKind {
                expected: Dimension::ForcePerLength,
                found: Dimension::Force,
                text,
                unit,
                ..
            } if matches!(unit.as_str(), "lbf" | "kip") => {
                format!("plane strain is per length: forces are per foot run, \"{text}/ft\"")
            }
            Self::WrongKind {
                expected: Dimension::ForcePerLength,
                found: Dimension::Force,
                text,
                ..
            } => format!("plane strain is one metre thick: forces are per metre run, \"{text}/m\""),
            Self::WrongKind { unit, found, .. } => {
                format!("`{unit}` measures {}; write \"{example}\"", found.name())
            }
            Self::NotFinite { .. } => format!("write a number, like \"{example}\""),
        }
    }
}

impl Quantity {
    /// Reads a quantity of any dimension, or a plain number.
    ///
    /// # Errors
    /// [`QuantityError`].
    pub fn parse(text: &str) -> Result<Self, QuantityError> {
        let trimmed = text.trim();
        let (number, unit) = split(trimmed).ok_or_else(|| QuantityError::NoNumber {
            text: clip(trimmed),
        })?;
        let finite = |value: f64| {
            if value.is_finite() {
                Ok(value)
            } else {
                Err(QuantityError::NotFinite {
                    text: clip(trimmed),
                })
            }
        };
        let number = finite(number)?;
        if unit.is_empty() {
            return Ok(Self {
                value: number,
                dimension: None,
            });
        }
        let found = Unit::find(unit).ok_or_else(|| QuantityError::UnknownUnit {
            unit: clip(unit),
            number,
        })?;
        Ok(Self {
            value: finite(found.to_si(number))?,
            dimension: Some(found.dimension),
        })
    }

    /// Reads a quantity of one dimension; the value is in SI units.
    ///
    /// # Errors
    /// [`QuantityError`].
    pub fn parse_as(text: &str, expected: Dimension) -> Result<f64, QuantityError> {
        let quantity = Self::parse(text)?;
        match quantity.dimension {
            Some(found) if found == expected => Ok(quantity.value),
            Some(found) => {
                let trimmed = text.trim();
                let unit = split(trimmed).map_or("", |(_, unit)| unit);
                Err(QuantityError::WrongKind {
                    expected,
                    found,
                    value: quantity.value,
                    text: clip(trimmed),
                    unit: clip(unit),
                })
            }
            None => Err(QuantityError::NoUnit {
                text: clip(text.trim()),
            }),
        }
    }
}

/// The value and its SI unit, such as `25000 Pa`: reads back to the same bits.
impl Display for Quantity {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.value)?;
        match self.dimension {
            Some(dimension) => write!(f, " {}", dimension.si_unit()),
            None => Ok(()),
        }
    }
}

/// The unit of a quantity as text, with plain digits for powers, and its value in SI units; `None` for a plain number.
pub fn unit_of(text: &str) -> Option<(&'static str, f64)> {
    let (_, unit) = split(text.trim())?;
    let found = Unit::find(unit)?;
    Some((found.symbol, found.to_si(1.0)))
}

/// Text for a message, not longer than is readable.
fn clip(text: &str) -> String {
    super::text::clip(text, 40)
}

/// The number (or fraction) at the start of a text, and the rest.
pub fn split(text: &str) -> Option<(f64, &str)> {
    let (numerator, rest) = leading_number(text)?;
    let after = rest.trim_start();
    if let Some(below) = after.strip_prefix('/')
        && let Some((denominator, rest)) = leading_number(below.trim_start())
    {
        return Some((numerator / denominator, rest.trim()));
    }
    Some((numerator, rest.trim()))
}

fn leading_number(text: &str) -> Option<(f64, &str)> {
    let bytes = text.as_bytes();
    let digits = |mut at: usize| {
        while at < bytes.len() && (bytes[at].is_ascii_digit() || bytes[at] == b'_') {
            at += 1;
        }
        at
    };
    let signed = |at: usize| at + usize::from(matches!(bytes.get(at), Some(b'+' | b'-')));
    let start = signed(0);
    let whole = digits(start);
    let mut end = whole;
    if bytes.get(end) == Some(&b'.') {
        end = digits(end + 1);
    }
    if end - start <= usize::from(end > whole) {
        return special(text);
    }
    if matches!(bytes.get(end), Some(b'e' | b'E')) {
        let exponent = signed(end + 1);
        if digits(exponent) > exponent {
            end = digits(exponent);
        }
    }
    let number = text[..end].replace('_', "").parse().ok()?;
    Some((number, &text[end..]))
}

/// `inf` and `nan`, so that they are refused by name.
fn special(text: &str) -> Option<(f64, &str)> {
    let unsigned = text.trim_start_matches(['+', '-']);
    let word: String = unsigned
        .chars()
        .take_while(char::is_ascii_alphabetic)
        .collect();
    matches!(word.to_lowercase().as_str(), "inf" | "infinity" | "nan")
        .then(|| (f64::NAN, &unsigned[word.len()..]))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn si(text: &str) -> (f64, Option<Dimension>) {
        let quantity = Quantity::parse(text).unwrap();
        (quantity.value, quantity.dimension)
    }

    #[test]
    fn quantities_are_read_to_the_last_digit() {
        use Dimension::{
            Acceleration, Angle, Area, ForcePerLength, Length, MassDensity, Stress, UnitWeight,
        };
        for (text, value, dimension) in [
            ("25 kPa", 25e3, Some(Stress)),
            ("25kPa", 25e3, Some(Stress)),
            ("1e5 kPa", 1e8, Some(Stress)),
            ("1 GPa", 1e9, Some(Stress)),
            ("2.5e-1 MN/m²", 250e3, Some(Stress)),
            ("3 kN/m^2", 3e3, Some(Stress)),
            ("0.5 N/mm2", 500e3, Some(Stress)),
            ("18 kN/m3", 18e3, Some(UnitWeight)),
            ("18 kN/m³", 18e3, Some(UnitWeight)),
            ("18 kN / m^3", 18e3, Some(UnitWeight)),
            ("2000 kg/m3", 2000.0, Some(MassDensity)),
            ("1.8 t/m3", 1800.0, Some(MassDensity)),
            ("3 mm", 0.003, Some(Length)),
            ("30 cm", 0.3, Some(Length)),
            ("-2 m", -2.0, Some(Length)),
            (" .5 m ", 0.5, Some(Length)),
            ("1_000 m", 1000.0, Some(Length)),
            ("1.2 km", 1200.0, Some(Length)),
            ("1/9 m", 1.0 / 9.0, Some(Length)),
            ("2 / 17 m", 2.0 / 17.0, Some(Length)),
            ("180 deg", std::f64::consts::PI, Some(Angle)),
            ("0.5 rad", 0.5, Some(Angle)),
            ("90°", std::f64::consts::FRAC_PI_2, Some(Angle)),
            ("9.81 m/s²", 9.81, Some(Acceleration)),
            ("100 kN/m", 100e3, Some(ForcePerLength)),
            ("2 m2", 2.0, Some(Area)),
            ("7", 7.0, None),
        ] {
            assert_eq!(si(text), (value, dimension), "{text}");
        }
    }

    /// GOAL: customary units of the United States have their exact factors.
    ///
    /// Outside values: the foot is 0.3048 m, the pound 0.45359237 kg, standard gravity 9.80665 m/s² (NIST SP 811,
    /// appendix B: psi 6.894757e3 Pa, psf 47.88026 Pa, lbf/ft 14.59390 N/m, pcf 157.0875 N/m³); water weighs 62.4 pcf or 9.80 kN/m³.
    #[test]
    fn customary_units_have_their_exact_factors() {
        use Dimension::{
            Acceleration, Area, Force, ForcePerLength, Length, MomentPerLength, Stress,
            StressGradient, UnitWeight, UnitWeightGradient,
        };
        for (text, value, dimension) in [
            ("1 ft", 0.3048, Length),
            ("3 ft", 0.9144, Length),
            ("12 in", 0.3048, Length),
            ("1 yd", 0.9144, Length),
            ("2.5 ft", 0.762, Length),
            ("1 ft2", 0.092_903_04, Area),
            ("1 lbf", 4.448_221_615_260_5, Force),
        ] {
            assert_eq!(si(text), (value, Some(dimension)), "{text}");
        }
        for (text, value, dimension) in [
            ("1 psi", 6.894_757e3, Stress),
            ("1 ksi", 6.894_757e6, Stress),
            ("1 lbf/in²", 6.894_757e3, Stress),
            ("1 psf", 47.880_26, Stress),
            ("1 lbf/ft^2", 47.880_26, Stress),
            ("1 ksf", 4.788_026e4, Stress),
            ("1 kip/ft2", 4.788_026e4, Stress),
            ("1 tsf", 9.576_052e4, Stress),
            ("62.4 pcf", 9.802_26e3, UnitWeight),
            ("1 lbf/ft3", 157.087_5, UnitWeight),
            ("0.0624 kcf", 9.802_26e3, UnitWeight),
            ("0.0624 kip/ft3", 9.802_26e3, UnitWeight),
            ("1 pci", 2.714_471e5, UnitWeight),
            ("10 psf/ft", 1570.875, StressGradient),
            ("0.01 ksf/ft", 1570.875, StressGradient),
            ("1 psi/ft", 2.262_059e4, StressGradient),
            ("10 lbf/ft2/ft", 1570.875, StressGradient),
            ("1 pcf/ft", 515.378_8, UnitWeightGradient),
            ("1 lbf/ft3/ft", 515.378_8, UnitWeightGradient),
            ("32.174049 ft/s2", 9.806_65, Acceleration),
            ("386.0886 in/s2", 9.806_65, Acceleration),
            ("1 lbf/ft", 14.593_90, ForcePerLength),
            ("1 plf", 14.593_90, ForcePerLength),
            ("1 kip/ft", 1.459_390e4, ForcePerLength),
            ("1 klf", 1.459_390e4, ForcePerLength),
            ("1 lbf/in", 175.126_8, ForcePerLength),
            ("1 kip-ft/ft", 4.448_222e3, MomentPerLength),
            ("1 lbf-ft/ft", 4.448_222, MomentPerLength),
        ] {
            let (found, kind) = si(text);
            assert_eq!(kind, Some(dimension), "{text}");
            assert!((found / value - 1.0).abs() < 3e-7, "{text}: {found}");
        }
    }

    #[test]
    fn nonsense_is_refused_without_panic() {
        for text in [
            "",
            " ",
            "-",
            ".",
            "e5",
            "m",
            "1/",
            "/2 m",
            "1e",
            "1e999 m",
            "1/0 m",
            "0/0 m",
            "nan m",
            "inf",
            "1 2 m",
            "1,5 m",
            "12 kPaa",
            "5 ´",
            "\u{0}",
            "1e5e5 m",
            "--1 m",
            "1__ \u{301}",
        ] {
            let error = Quantity::parse_as(text, Dimension::Length).unwrap_err();
            assert!(!error.to_string().is_empty());
            assert!(!error.help(Some(Dimension::Length)).is_empty());
        }
    }

    #[test]
    fn a_wrong_unit_is_explained() {
        let explain = |text, dimension| {
            let error = Quantity::parse_as(text, dimension).unwrap_err();
            format!("{error}\n{}", error.help(Some(dimension)))
        };
        assert_eq!(
            explain("2000 kg/m3", Dimension::UnitWeight),
            "wrong kind of unit: expected a unit weight such as kN/m3\n\
             this is a mass density; multiply by 9.81 m/s2: 2000 kg/m3 -> \"19.62 kN/m3\""
        );
        assert_eq!(
            explain("2 m", Dimension::Stress),
            "wrong kind of unit: expected a stress such as kPa\n\
             `m` measures a length; write \"25 kPa\""
        );
        assert_eq!(
            explain("20 kn/m3", Dimension::UnitWeight),
            "unknown unit `kn/m3`\ndid you mean `kN/m3`?"
        );
        assert_eq!(
            explain("1,5 m", Dimension::Length),
            "unknown unit `,5 m`\nwrite a decimal point, not a comma, like \"2 m\""
        );
        assert_eq!(
            explain("50 kN", Dimension::ForcePerLength),
            "wrong kind of unit: expected a force per length such as kN/m\n\
             plane strain is one metre thick: forces are per metre run, \"50 kN/m\""
        );
        assert_eq!(
            explain("5 kip", Dimension::ForcePerLength),
            "wrong kind of unit: expected a force per length such as kN/m\n\
             plane strain is per length: forces are per foot run, \"5 kip/ft\""
        );
        assert_eq!(
            explain("120 lb/ft3", Dimension::UnitWeight),
            "unknown unit `lb/ft3`\ndid you mean `lbf/ft3`?"
        );
    }
}
