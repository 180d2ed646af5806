//! A check: a computed quantity held against an outside value within a band.

use std::fmt;

use igimp_text::short;
use serde::{Deserialize, Deserializer, Serialize};

/// The band that a computed value must satisfy.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Band {
    /// Within this share of the expected value \[-\].
    Relative(f64),
    /// Between two values.
    Between(f64, f64),
    /// Not above.
    AtMost(f64),
    /// Not below.
    AtLeast(f64),
}

impl Band {
    /// Whether a value lies in the band around `expected`; a value that is not a number does not.
    pub fn holds(&self, expected: f64, measured: f64) -> bool {
        match *self {
            Self::Relative(share) => (measured - expected).abs() <= share * expected.abs(),
            Self::Between(low, high) => low <= measured && measured <= high,
            Self::AtMost(limit) => measured <= limit,
            Self::AtLeast(limit) => measured >= limit,
        }
    }
}

impl fmt::Display for Band {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Relative(share) => write!(f, "± {} %", short(100.0 * share)),
            Self::Between(low, high) => write!(f, "{} … {}", short(low), short(high)),
            Self::AtMost(limit) => write!(f, "≤ {}", short(limit)),
            Self::AtLeast(limit) => write!(f, "≥ {}", short(limit)),
        }
    }
}

/// A unit in which numbers are printed that are kept in SI units.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PrintedUnit {
    /// Its name, such as `kPa`.
    pub name: String,
    /// Its value in the SI unit, such as 1000.
    pub in_si: f64,
}

impl PrintedUnit {
    /// A number in SI units as it is printed: in this unit, with its name.
    pub fn printed(&self, value: f64) -> String {
        format!("{} {}", short(value / self.in_si), self.name)
    }
}

/// A computed quantity and the outside value it is held against.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Check {
    /// Case, such as `column`.
    pub case: String,
    /// Variant of method, mesh and parameters.
    pub variant: String,
    /// The measured quantity, with unit.
    pub quantity: String,
    /// The outside value, in the unit that `quantity` names.
    pub expected: f64,
    /// Where it comes from.
    pub source: String,
    /// The accepted band.
    pub band: Band,
    /// The computed value, in the same unit; NaN is `null` in JSON.
    #[serde(deserialize_with = "or_not_a_number")]
    pub measured: f64,
    /// The unit in which the case states the band; none: plain numbers. Numbers here are in SI units all the same.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub unit: Option<PrintedUnit>,
}

impl Check {
    /// Whether the band is met.
    pub fn passes(&self) -> bool {
        self.band.holds(self.expected, self.measured)
    }

    /// A value of this check as it is printed, in the unit of the case; a dash for one that is not a number.
    pub fn printed(&self, value: f64) -> String {
        match &self.unit {
            _ if value.is_nan() => "-".to_owned(),
            Some(unit) => unit.printed(value),
            None => short(value),
        }
    }

    /// The band as it is printed, in the unit of the case.
    pub fn printed_band(&self) -> String {
        let Some(PrintedUnit { name, in_si }) = &self.unit else {
            return self.band.to_string();
        };
        let band = match self.band {
            Band::Relative(_) => return self.band.to_string(),
            Band::Between(low, high) => Band::Between(low / in_si, high / in_si),
            Band::AtMost(limit) => Band::AtMost(limit / in_si),
            Band::AtLeast(limit) => Band::AtLeast(limit / in_si),
        };
        format!("{band} {name}")
    }
}

/// A number; NaN for `null` in JSON.
///
/// # Errors
/// For anything but a number or `null`.
pub fn or_not_a_number<'de, D: Deserializer<'de>>(deserializer: D) -> Result<f64, D::Error> {
    Ok(Option::deserialize(deserializer)?.unwrap_or(f64::NAN))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// GOAL: a check is printed in the unit of its case, and a value that is not a number is no number of it.
    /// ORACLE: by hand, with a pound-force per square foot of 47.88026 Pa (NIST SP 811).
    #[test]
    fn a_check_is_printed_in_its_unit() {
        let unit = Some(PrintedUnit {
            name: "psf".to_owned(),
            in_si: 47.88026,
        });
        let mut check = Check {
            case: String::new(),
            variant: String::new(),
            quantity: "q".to_owned(),
            expected: 4788.026,
            source: String::new(),
            band: Band::Between(4309.2234, 5266.8286),
            measured: f64::NAN,
            unit,
        };
        assert_eq!(check.printed(check.expected), "100 psf");
        assert_eq!(check.printed(check.measured), "-");
        assert_eq!(check.printed_band(), "90 … 110 psf");
        check.band = Band::AtMost(5266.8286);
        assert_eq!(check.printed_band(), "≤ 110 psf");
        check.band = Band::AtLeast(4309.2234);
        assert_eq!(check.printed_band(), "≥ 90 psf");
        check.band = Band::Relative(0.05);
        assert_eq!(check.printed_band(), "± 5 %");
        check.unit = None;
        assert_eq!(check.printed(check.expected), "4788");
    }

    #[test]
    fn a_value_that_is_not_a_number_never_passes() {
        for band in [
            Band::Relative(1.0),
            Band::Between(-1e9, 1e9),
            Band::AtMost(1e9),
            Band::AtLeast(-1e9),
        ] {
            assert!(!band.holds(1.0, f64::NAN), "{band}");
        }
    }
}
